//! `Study` and what it found.

use crate::arrays::Taken;
use crate::error::{OrRaise, raise};
use crate::options::{device, overrides, positive, quality, seeds};
use crate::run::Calls;
use crate::watch::{Teller, watch};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use strandsnap::base::error::{Error, Result};
use strandsnap::base::regular;
use strandsnap::export::{self, Format};
use strandsnap::run::lock::Lock;
use strandsnap::run::{DeviceChoice, folder};
use strandsnap::study::runner::{CaseRunner, CaseStore, all_outputs, cores};
use strandsnap::study::sweep::definition::STUDIES;
use strandsnap::study::sweep::report::{self, Findings};
use strandsnap::study::sweep::{self, CaseResult, Changes, Definition, Gathered};
use strandsnap::study::tensile::TensileOutcome;

/// A scene that is varied: which cases there are. Each is a run that is kept in the study's folder under a name that follows
/// from its scene and seed, so that what is interrupted goes on, and cases can be run one by one on many machines.
#[pyclass(frozen, module = "strandsnap", name = "Study")]
pub struct PyStudy {
    definition: Definition,
}

#[pymethods]
impl PyStudy {
    /// Reads a study that comes with the program, by its name, or a TOML file, by its path. `set` and other keywords change
    /// the scene of every case as they do for `Scene`; `quality` is draft, standard or fine; `seeds` how many, or a list.
    #[new]
    #[pyo3(signature = (source, set=None, *, quality=None, seeds=None, **keys))]
    fn new(
        py: Python,
        source: PathBuf,
        set: Option<&Bound<PyAny>>,
        quality: Option<&str>,
        seeds: Option<&Bound<PyAny>>,
        keys: Option<&Bound<PyDict>>,
    ) -> PyResult<Self> {
        let changes = changes(set, quality, seeds, keys)?;
        let definition = py.detach(|| Definition::load(&source.to_string_lossy(), &changes)).or_raise(py)?;
        Ok(Self { definition })
    }

    /// Reads a study from TOML text. `name` is shown in errors, and its stem names the study; a base scene that is a path is
    /// taken from `folder`.
    #[staticmethod]
    #[pyo3(signature = (text, set=None, *, name="study.toml", folder=None, quality=None, seeds=None, **keys))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    fn from_text(
        py: Python,
        text: &str,
        set: Option<&Bound<PyAny>>,
        name: &str,
        folder: Option<PathBuf>,
        quality: Option<&str>,
        seeds: Option<&Bound<PyAny>>,
        keys: Option<&Bound<PyDict>>,
    ) -> PyResult<Self> {
        let changes = changes(set, quality, seeds, keys)?;
        let folder = folder.unwrap_or_else(|| Path::new(".").into());
        let definition = py.detach(|| Definition::parse(text, name, &folder, &changes)).or_raise(py)?;
        Ok(Self { definition })
    }

    /// Its name, after which its folder is called.
    #[getter]
    fn name(&self) -> &str {
        &self.definition.name
    }

    /// What it asks, in a sentence.
    #[getter]
    fn about(&self) -> &str {
        &self.definition.about
    }

    /// The names of its cases, in their order; their numbers count from 1.
    #[getter]
    fn cases(&self) -> Vec<String> {
        let cases = self.definition.cases().into_iter();
        cases.map(|(point, seed)| self.definition.case_name(point, seed)).collect()
    }

    /// The folder of its results where none is given.
    #[getter]
    fn folder(&self) -> PathBuf {
        folder::study(&self.definition.name)
    }

    /// The numbers of the cases that are not kept in the folder `out` yet.
    #[pyo3(signature = (out=None, *, device="cpu"))]
    fn missing(&self, py: Python, out: Option<PathBuf>, device: &str) -> PyResult<Vec<usize>> {
        let (out, device) = self.place(out, device)?;
        Ok(py.detach(|| {
            let gathered = Gathered::read(&self.definition, &CaseStore::of(&out).on(&device));
            gathered.cases.iter().filter(|case| case.outcome.is_none()).map(|case| case.number).collect()
        }))
    }

    /// Runs the cases that are missing in the folder `out`, `jobs` at a time on one thread each (without it, one per core),
    /// and gathers all. `fresh` runs those again that are kept; `parquet` writes the tables as Parquet
    /// too; `progress` is as for `run`.
    #[pyo3(signature = (out=None, *, jobs=None, device="cpu", fresh=false, parquet=false, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    fn run(
        &self,
        py: Python,
        out: Option<PathBuf>,
        jobs: Option<usize>,
        device: &str,
        fresh: bool,
        parquet: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<StudyResults> {
        check(py, parquet)?;
        let (out, device) = self.place(out, device)?;
        let jobs = positive("jobs", jobs)?.unwrap_or_else(cores);
        let calls = Calls::new(py, &self.definition.name, progress, None)?;
        let stop = AtomicBool::new(false);
        let work = |teller: &Teller<f64>| {
            regular::make_folder(&out)?;
            let _lock = Lock::take(&out)?;
            let store = CaseStore::open(&out, fresh)?.on(&device);
            let tell = |progress: &strandsnap::study::runner::Progress| teller.tell(progress.share);
            let runner = CaseRunner { jobs, threads: None, budget: None, stop: &stop, tell: &tell };
            let costs = sweep::costs(&self.definition, &Gathered::read(&self.definition, &store), &|_| {})?;
            all_outputs(sweep::run(&self.definition, &costs, &store, &runner)?).map(drop)
        };
        let ended = watch(py, &stop, None, work, |py, share| calls.share(py, share));
        calls.close(py)?;
        ended.or_raised()?.or_raise(py)?;
        self.gather(py, &out, &device, parquet)
    }

    /// Runs the case with this number alone, or finds it kept; other processes may run other cases into the same folder.
    /// Gives what became of it: "ran" or "failed".
    #[pyo3(signature = (number, out=None, *, device="cpu"))]
    fn run_case(&self, py: Python, number: usize, out: Option<PathBuf>, device: &str) -> PyResult<&'static str> {
        let (out, device) = self.place(out, device)?;
        let stop = AtomicBool::new(false);
        let work = |_: &Teller<()>| {
            regular::make_folder(&out)?;
            let _lock = Lock::share(&out)?;
            let store = CaseStore::open(&out, false)?.on(&device);
            let (point, seed) = sweep::numbered(&self.definition, number)?;
            let case = self.definition.case((point, seed), 1.0, &store);
            let runner = CaseRunner { jobs: 1, threads: Some(1), budget: None, stop: &stop, tell: &|_| {} };
            match all_outputs(runner.run(&[case])?)?.remove(0).result {
                TensileOutcome::Ran(_) => Ok("ran"),
                TensileOutcome::Failed(_) => Ok("failed"),
                TensileOutcome::Refused(cause) => {
                    let name = self.definition.case_name(point, seed);
                    let help = "the others can be run all the same";
                    Err(Error::input(format!("case {number} ({name}) is refused: {cause}"), help))
                }
            }
        };
        watch(py, &stop, None, work, |_, ()| Ok(())).or_raised()?.or_raise(py)
    }

    /// Gathers the cases that are kept in the folder `out`, and runs nothing.
    #[pyo3(signature = (out=None, *, device="cpu", parquet=false))]
    fn collect(&self, py: Python, out: Option<PathBuf>, device: &str, parquet: bool) -> PyResult<StudyResults> {
        check(py, parquet)?;
        let (out, device) = self.place(out, device)?;
        self.gather(py, &out, &device, parquet)
    }

    fn __len__(&self) -> usize {
        self.definition.cases().len()
    }

    fn __repr__(&self) -> String {
        format!("<strandsnap.Study {}, {} cases: {}>", self.definition.name, self.__len__(), self.definition.about)
    }
}

impl PyStudy {
    fn place(&self, out: Option<PathBuf>, on: &str) -> PyResult<(PathBuf, DeviceChoice)> {
        Ok((out.unwrap_or_else(|| self.folder()), device(on)?))
    }

    /// Gathers what is there and writes it.
    fn gather(&self, py: Python, out: &Path, device: &DeviceChoice, parquet: bool) -> PyResult<StudyResults> {
        let definition = &self.definition;
        let gathered = || -> Result<_> {
            let gathered = Gathered::read(definition, &CaseStore::of(out).on(device));
            if gathered.ran() == 0 {
                let cause = gathered.cases.iter().find_map(CaseResult::cause);
                let cause = cause.map_or_else(|| "none was run yet".into(), |cause| format!("the first says: {cause}"));
                let help = "run the study, or look at a case with strandsnap.run";
                return Err(Error::input(format!("no case of {} has a result; {cause}", definition.name), help));
            }
            let findings = Findings::new(definition, &gathered)?;
            let command = format!("strandsnap.Study({:?}) in Python", definition.name);
            let files = report::write(definition, &gathered, &findings, &command, out, parquet)?;
            let mut taken = Taken::default();
            report::data(definition, &gathered, &mut taken)?;
            Ok((files, report::to_text(definition, &gathered, &findings), taken, gathered.missing()))
        };
        let (files, text, taken, missing) = py.detach(gathered).map_err(|error| raise(py, &error))?;
        let tables = PyDict::new(py);
        for (name, growth) in taken.0 {
            tables.set_item(name, growth.into_dict(py)?)?;
        }
        Ok(StudyResults { folder: out.into(), files, text, missing, tables: tables.unbind() })
    }
}

/// What a study found. Tables are dicts of numpy arrays, named as the columns of its CSV files.
#[pyclass(frozen, module = "strandsnap", name = "StudyResults")]
pub struct StudyResults {
    folder: PathBuf,
    files: Vec<PathBuf>,
    text: String,
    missing: usize,
    tables: Py<PyDict>,
}

#[pymethods]
impl StudyResults {
    /// The folder of the study.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.folder.clone()
    }

    /// The files that were written: tables, `study.json`, plots, and the page.
    #[getter]
    fn files(&self) -> Vec<PathBuf> {
        self.files.clone()
    }

    /// What the command line prints of it.
    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    /// How many cases were not run yet.
    #[getter]
    fn missing(&self) -> usize {
        self.missing
    }

    /// A row per case (`cases.csv`); units stand in the names, as in "strength [MPa]".
    #[getter]
    fn cases<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.table(py, "cases")
    }

    /// A row per point and quantity (`points.csv`): mean, deviation and interval over seeds, in the `unit` of the row.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.table(py, "points")
    }

    /// A row per point and layer (`breaks.csv`): when and where it broke.
    #[getter]
    fn breaks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.table(py, "breaks")
    }

    fn __repr__(&self) -> String {
        format!("<strandsnap.StudyResults in {}>", self.folder.display())
    }
}

impl StudyResults {
    fn table<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        self.tables.bind(py).as_any().get_item(name)
    }
}

/// Whether tables can be written so.
fn check(py: Python, parquet: bool) -> PyResult<()> {
    if parquet { export::check(Format::Parquet).or_raise(py) } else { Ok(()) }
}

fn changes(
    set: Option<&Bound<PyAny>>,
    preset: Option<&str>,
    listed: Option<&Bound<PyAny>>,
    keys: Option<&Bound<PyDict>>,
) -> PyResult<Changes> {
    Ok(Changes { quality: quality(preset)?, set: overrides(set, keys)?, seeds: seeds(listed)? })
}

/// The studies that come with the program: name and TOML text.
#[pyfunction]
pub fn studies(py: Python) -> PyResult<Bound<PyDict>> {
    let all = PyDict::new(py);
    STUDIES.iter().try_for_each(|(name, text)| all.set_item(name, text))?;
    Ok(all)
}
