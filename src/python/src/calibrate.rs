//! `calibrate`.

use crate::arrays::Growth;
use crate::error::OrRaise;
use crate::options::{device, positive, seeds};
use crate::run::Calls;
use crate::scene::PyScene;
use crate::watch::{Teller, watch};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use strandsnap::base::regular;
use strandsnap::observe::column::Column;
use strandsnap::reference::published::{self, CALIBRATED_ON};
use strandsnap::run::folder;
use strandsnap::run::lock::Lock;
use strandsnap::study::calibrate::{self, Found, Iteration, Target, default_seeds};
use strandsnap::study::runner::{CaseRunner, CaseStore, cores};

/// Fits the hardening (Voce: saturation and linear part) and the rupture strain of a pulled scene to one tensile test, in the
/// mean over `seeds` (how many, or a list; without them 8 where bonds scatter).
///
/// `strength` (MPa) and `elongation` (%) are those of the test, by default the reference experiment of the shipped scene
/// ka4; each is met within `tolerance` (%). Runs are kept in the folder `out`, by default out/calibration/NAME, and not made
/// again unless `fresh`; `jobs` are made at a time. `progress` is as for `run`, of each setting that is tried.
#[pyfunction]
#[pyo3(name = "calibrate", signature = (
    scene, strength=None, elongation=None, *, tolerance=1.0, seeds=None, jobs=None, device="cpu", out=None, fresh=false,
    progress=None
))]
#[expect(clippy::too_many_arguments, reason = "they are keywords")]
pub fn py_calibrate(
    py: Python,
    scene: &PyScene,
    strength: Option<f64>,
    elongation: Option<f64>,
    tolerance: f64,
    seeds: Option<&Bound<PyAny>>,
    jobs: Option<usize>,
    device: &str,
    out: Option<PathBuf>,
    fresh: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Calibration> {
    let scene = &scene.scene;
    let experiment = &published::find(CALIBRATED_ON).expect("it comes with the program").experiment;
    let target = Target {
        strength: within("strength", "MPa", strength.unwrap_or(experiment.tensile_strength_mpa), 1e6)?,
        elongation: within("elongation", "%", elongation.unwrap_or(experiment.fracture_elongation_percent), 1e3)?,
        tolerance: within("tolerance", "%", tolerance, 100.0)? / 100.0,
    };
    let seeds = match seeds {
        Some(_) => self::seeds(seeds)?,
        None => default_seeds(scene),
    };
    let out = out.unwrap_or_else(|| folder::calibration(&scene.spec.name));
    let device = self::device(device)?;
    let jobs = positive("jobs", jobs)?.unwrap_or_else(cores);
    let calls = Calls::new(py, &scene.spec.name, progress, None)?;
    let stop = AtomicBool::new(false);
    let work = |teller: &Teller<f64>| {
        regular::make_folder(&out)?;
        let _lock = Lock::take(&out)?;
        let store = CaseStore::open(&out, fresh)?.on(&device);
        let tell = |progress: &strandsnap::study::runner::Progress| teller.tell(progress.share);
        let runner = CaseRunner { jobs, threads: None, budget: None, stop: &stop, tell: &tell };
        let calibration = calibrate::Calibration { scene, seeds: &seeds, store: &store, runner: &runner };
        let mut tried = Vec::new();
        let best = calibrate::calibrate(&calibration, &target, &mut |_, one| tried.push(one.clone()))?;
        let found = Found { scene: &scene.spec.name, seeds: &seeds, target: &target, iterations: &tried, best: &best };
        let file = found.write("strandsnap.calibrate in Python", &out)?;
        Ok((best, tried, file))
    };
    let ended = watch(py, &stop, None, work, |py, share| calls.share(py, share));
    calls.close(py)?;
    let (best, tried, file) = ended.or_raised()?.or_raise(py)?;
    Ok(Calibration { set: best.setting.overrides().to_vec(), trials: trials(py, &tried)?, file })
}

fn within(name: &str, unit: &str, number: f64, most: f64) -> PyResult<f64> {
    if (1e-3..=most).contains(&number) {
        return Ok(number);
    }
    let what = format!("{name} is {number} {unit}; it is from 0.001 to {most} {unit}");
    Err(pyo3::exceptions::PyValueError::new_err(what))
}

fn trials(py: Python, tried: &[Iteration]) -> PyResult<Py<PyDict>> {
    let columns: Vec<Column<Iteration>> = vec![
        Column::in_files("seeds", |one: &Iteration| one.strength.count),
        Column::in_files("saturation_mpa", |one: &Iteration| one.setting.saturation),
        Column::in_files("linear_mpa", |one: &Iteration| one.setting.linear),
        Column::in_files("rupture_strain_percent", |one: &Iteration| one.setting.rupture_strain),
        Column::in_files("strength_mpa", |one: &Iteration| one.strength.mean),
        Column::in_files("strength_error_percent", |one: &Iteration| 100.0 * one.error[0]),
        Column::in_files("elongation_percent", |one: &Iteration| one.elongation.mean),
        Column::in_files("elongation_error_percent", |one: &Iteration| 100.0 * one.error[1]),
        Column::in_files("kept", |one: &Iteration| one.kept),
    ];
    let mut growth = Growth::new(&columns);
    tried.iter().for_each(|one| growth.push(&columns, one));
    growth.into_dict(py).map(Bound::unbind)
}

/// What a calibration found.
#[pyclass(frozen, module = "strandsnap", name = "Calibration")]
pub struct Calibration {
    set: Vec<String>,
    trials: Py<PyDict>,
    file: PathBuf,
}

#[pymethods]
impl Calibration {
    /// What reproduces the test: for `Scene(…, set=calibration.set)`.
    #[getter]
    fn set(&self) -> Vec<String> {
        self.set.clone()
    }

    /// Setting by setting, a dict of numpy arrays; the last one met the test.
    #[getter]
    fn trials(&self, py: Python) -> Py<PyDict> {
        self.trials.clone_ref(py)
    }

    /// `calibration.json`.
    #[getter]
    fn file(&self) -> PathBuf {
        self.file.clone()
    }

    fn __repr__(&self) -> String {
        format!("<strandsnap.Calibration {}>", self.set.join(", "))
    }
}
