//! `Run`: the results in a folder.

use crate::arrays::{Growth, Numbers, array};
use crate::error::OrRaise;
use crate::scene::PyScene;
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use strandsnap::base::error::{Error, Result};
use strandsnap::base::regular;
use strandsnap::base::units::percent;
use strandsnap::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use strandsnap::observe::Observer;
use strandsnap::observe::column::Column;
use strandsnap::observe::peaks::Peaks;
use strandsnap::observe::tables::{self, WireRow, Wires};
use strandsnap::run::folder::{SCENE, SUMMARY};
use strandsnap::run::identity;
use strandsnap::run::replay::{Replay, Selection};
use strandsnap::scene;

/// The results of a run, from its folder.
///
/// Tables are dicts of numpy arrays, named as the columns of the CSV files with the unit at the end of each name; their
/// numbers are those of the engine, of which the CSV files show nine digits. A count that some row lacks is a float with NaN
/// there. They are read once, when they are first asked for.
#[pyclass(frozen, module = "strandsnap", name = "Run")]
pub struct PyRun {
    folder: PathBuf,
    tables: PyOnceLock<Tables>,
}

/// What is told of a whole run.
struct Tables {
    curve: Py<PyDict>,
    wires: Py<PyDict>,
    ruptures: Py<PyDict>,
    snapshots: Py<PyDict>,
    /// Strain of each snapshot (%).
    strains: Vec<f64>,
}

impl PyRun {
    /// That in a folder, which was written just now.
    pub fn of(folder: &Path) -> Self {
        Self { folder: folder.into(), tables: PyOnceLock::new() }
    }

    fn tables(&self, py: Python) -> PyResult<&Tables> {
        self.tables.get_or_try_init(py, || {
            let told = py.detach(|| Told::of(&self.folder)).or_raise(py)?;
            let dict = |growth: Growth| growth.into_dict(py).map(Bound::unbind);
            Ok(Tables {
                curve: dict(told.curve.1)?,
                wires: dict(told.wires)?,
                ruptures: dict(told.ruptures.1)?,
                snapshots: dict(told.snapshots)?,
                strains: told.strains,
            })
        })
    }

    /// The number of the snapshot that is nearest to a strain (%), or has this number; of neither, the last.
    pub fn number(&self, py: Python, strain: Option<f64>, index: Option<isize>) -> PyResult<usize> {
        let strains = &self.tables(py)?.strains;
        let count = strains.len();
        match (strain, index) {
            (Some(_), Some(_)) => Err(PyValueError::new_err("give a strain or an index, not both")),
            (None, index) => {
                let index = index.unwrap_or(-1);
                let number = if index < 0 { index + count as isize } else { index };
                usize::try_from(number).ok().filter(|number| *number < count).ok_or_else(|| {
                    PyIndexError::new_err(format!("there are {count} snapshots, and none with the index {index}"))
                })
            }
            (Some(strain), None) => {
                let [least, greatest] = [f64::min, f64::max].map(|of| strains.iter().copied().fold(f64::NAN, of));
                // Half of the last digit that people are shown.
                if !(least - 0.005..=greatest + 0.005).contains(&strain) {
                    let what = format!("a strain of {strain} %: the snapshots go from {least:.2} to {greatest:.2} %");
                    return Err(PyValueError::new_err(what));
                }
                let off = |k: &usize| (strains[*k] - strain).abs();
                Ok((0..count).min_by(|a, b| off(a).total_cmp(&off(b))).expect("a run has a snapshot"))
            }
        }
    }

    /// Its folder.
    pub fn path(&self) -> &Path {
        &self.folder
    }
}

#[pymethods]
impl PyRun {
    /// Opens the run in a folder, such as out/ka4; one that was stopped or killed will do. Files that were changed since the
    /// run, or are another's, are refused unless `anyway`.
    #[new]
    #[pyo3(signature = (folder, *, anyway=false))]
    fn new(py: Python, folder: PathBuf, anyway: bool) -> PyResult<Self> {
        let check = || {
            // Names the folder that holds no run at once.
            Replay::open(&folder, &Selection::default())?;
            identity::check(&folder, anyway).map(drop)
        };
        py.detach(check).or_raise(py)?;
        Ok(Self::of(&folder))
    }

    /// Its folder.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.folder.clone()
    }

    /// The scene that was run.
    #[getter]
    fn scene(&self, py: Python) -> PyResult<PyScene> {
        let file = self.folder.join(SCENE);
        scene::load(&file.to_string_lossy(), &[]).map(PyScene::of).or_raise(py)
    }

    /// What the run found (`summary.json`): strength in MPa, elongation in %, order of breaks, warnings, cost. The names say
    /// the units. A run that was killed has none.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let text = regular::text(&self.folder.join(SUMMARY), regular::LONGEST_TABLE).or_raise(py)?;
        py.import("json")?.call_method1("loads", (text,))
    }

    /// The stress-strain curve, a row per sample: `strain_percent`, `stress_mpa`, `stress_LAYER_mpa`, grip forces (N), torque
    /// (N mm), energies (J), counts of what is broken or touches.
    #[getter]
    fn curve(&self, py: Python) -> PyResult<Py<PyDict>> {
        self.tables(py).map(|tables| tables.curve.clone_ref(py))
    }

    /// A row per wire, from wire 1: layer, diameter (mm), greatest stress (MPa) and the strain then (%), first rupture.
    #[getter]
    fn wires(&self, py: Python) -> PyResult<Py<PyDict>> {
        self.tables(py).map(|tables| tables.wires.clone_ref(py))
    }

    /// A row per broken bond, in their order: wire and bond from 1, strain (%), place (mm), cause, stress (MPa).
    #[getter]
    fn ruptures(&self, py: Python) -> PyResult<Py<PyDict>> {
        self.tables(py).map(|tables| tables.ruptures.clone_ref(py))
    }

    /// The rows of the curve at which every particle was kept: what `positions`, `snapshot` and `frame` choose from.
    #[getter]
    fn snapshots(&self, py: Python) -> PyResult<Py<PyDict>> {
        self.tables(py).map(|tables| tables.snapshots.clone_ref(py))
    }

    /// Centres of all particles (m), float32 of shape (n, 3), in the snapshot whose strain (%) is nearest to `strain`, or that
    /// has this `index` in `snapshots`; of neither, in the last. Wire by wire, along each wire; free spheres follow.
    #[pyo3(signature = (strain=None, *, index=None))]
    fn positions<'py>(
        &self,
        py: Python<'py>,
        strain: Option<f64>,
        index: Option<isize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (_, snapshot) = self.find(py, strain, index)?;
        positions(py, snapshot.position)
    }

    /// All that was kept of every particle in a snapshot, chosen as by `positions`: `position_m`, `radius_m`, `speed_m_s`,
    /// `contact_pressure_pa`, `wire` (from 1; 0 for a free sphere), and of the bond from each particle to the next
    /// `bond_state` (0 whole, 1 yielding, 2 broken, 3 none), `bond_stress_pa`, `plastic_strain` and `utilisation` (share of
    /// the limit at which it breaks), both plain numbers.
    #[pyo3(signature = (strain=None, *, index=None))]
    fn snapshot<'py>(
        &self,
        py: Python<'py>,
        strain: Option<f64>,
        index: Option<isize>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (info, snapshot) = self.find(py, strain, index)?;
        let all = PyDict::new(py);
        let mut wire = vec![0; info.particles];
        for (number, of) in info.wires.iter().enumerate() {
            wire[of.particles()].fill(number as i64 + 1);
        }
        let n = [info.particles];
        all.set_item("wire", array(py, Numbers::Count(wire), &n)?)?;
        all.set_item("position_m", positions(py, snapshot.position)?)?;
        let state = snapshot.bond_state.iter().map(|state| *state as u8).collect();
        all.set_item("bond_state", array(py, Numbers::Byte(state), &n)?)?;
        let columns = [
            ("radius_m", snapshot.radius),
            ("speed_m_s", snapshot.speed),
            ("contact_pressure_pa", snapshot.contact_pressure),
            ("bond_stress_pa", snapshot.bond_stress),
            ("plastic_strain", snapshot.plastic_strain),
            ("utilisation", snapshot.utilisation),
        ];
        for (name, numbers) in columns {
            all.set_item(name, array(py, Numbers::Single(numbers), &n)?)?;
        }
        Ok(all)
    }

    /// A picture of the run, as `strandsnap render` draws it: a `Frame`, uint8 of shape (height, width, 3), that shows itself
    /// in a notebook. The snapshot is chosen as by `positions`. `view` is one panel or a list of them, `colour` and `theme`
    /// are the words of the command line, sizes are in pixels, angles in degrees, `focus_z` in mm; what is not given is as the
    /// scene says. It needs the feature `frames` in the build of this package, and a graphics driver; else it raises
    /// `MissingError`.
    #[pyo3(signature = (
        strain=None, *, index=None, view=None, colour=None, theme=None, width=None, height=None, azimuth=None,
        elevation=None, zoom=None, focus_z=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    fn frame<'py>(
        &self,
        py: Python<'py>,
        strain: Option<f64>,
        index: Option<isize>,
        view: Option<&Bound<'py, PyAny>>,
        colour: Option<&str>,
        theme: Option<&str>,
        width: Option<u32>,
        height: Option<u32>,
        azimuth: Option<f64>,
        elevation: Option<f64>,
        zoom: Option<f64>,
        focus_z: Option<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let look = crate::frame::Look { colour, theme, width, height, azimuth, elevation, zoom, focus_z };
        crate::frame::frame(py, self, (strain, index), view, &look)
    }

    fn __repr__(&self) -> String {
        format!("<strandsnap.Run in {}>", self.folder.display())
    }
}

impl PyRun {
    /// The snapshot that is asked for, and the run it is of.
    fn find(&self, py: Python, strain: Option<f64>, index: Option<isize>) -> PyResult<(Arc<RunInfo>, Snapshot)> {
        let number = self.number(py, strain, index)?;
        py.detach(|| Finder::of(&self.folder, number)).or_raise(py)
    }
}

fn positions(py: Python, centres: Vec<[f32; 3]>) -> PyResult<Bound<PyAny>> {
    let shape = [centres.len(), 3];
    array(py, Numbers::Single(centres.into_flattened()), &shape)
}

/// Gathers what a run is told by.
struct Told {
    curve: (Vec<Column<'static, Sample>>, Growth),
    ruptures: (Vec<Column<'static, Rupture>>, Growth),
    gathered: Wires,
    wires: Growth,
    snapshots: Growth,
    strains: Vec<f64>,
}

impl Told {
    fn of(run: &Path) -> Result<Self> {
        let info = Arc::default();
        let mut told = Self {
            curve: (Vec::new(), Growth::default()),
            ruptures: (Vec::new(), Growth::default()),
            gathered: Wires::new(&info),
            wires: Growth::default(),
            snapshots: Growth::default(),
            strains: Vec::new(),
        };
        Replay::open(run, &Selection::default())?.show(&mut told, &AtomicBool::new(false))?;
        Ok(told)
    }
}

impl Observer for Told {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        let (curve, ruptures) = (tables::curve(info), tables::ruptures(info));
        self.snapshots = Growth::new(&curve);
        let growth = Growth::new(&curve);
        self.curve = (curve, growth);
        let growth = Growth::new(&ruptures);
        self.ruptures = (ruptures, growth);
        self.wires = Growth::new::<WireRow>(&tables::wires(info));
        self.gathered = Wires::new(info);
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        let (columns, rows) = &mut self.curve;
        rows.push(columns, sample);
        Ok(())
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        self.snapshots.push(&self.curve.0, &snapshot.sample);
        self.strains.push(percent(snapshot.sample.strain));
        Ok(())
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.gathered.rupture(rupture);
        let (columns, rows) = &mut self.ruptures;
        rows.push(columns, rupture);
        Ok(())
    }

    fn peaks(&mut self, peaks: &Peaks) -> Result<()> {
        self.gathered.peaks(peaks);
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        let columns = tables::wires(self.gathered.info());
        self.gathered.rows().for_each(|row| self.wires.push(&columns, &row));
        Ok(())
    }
}

/// Looks for a snapshot.
struct Finder<'a> {
    left: usize,
    info: Arc<RunInfo>,
    found: Option<Arc<Snapshot>>,
    stop: &'a AtomicBool,
}

impl Finder<'_> {
    fn of(run: &Path, number: usize) -> Result<(Arc<RunInfo>, Snapshot)> {
        let stop = AtomicBool::new(false);
        let mut finder = Finder { left: number, info: Arc::default(), found: None, stop: &stop };
        Replay::open(run, &Selection::default())?.show(&mut finder, &stop)?;
        match finder.found {
            Some(snapshot) => Ok((finder.info, Arc::unwrap_or_clone(snapshot))),
            None => Err(Error::input(
                format!("the run in {} has changed: snapshot {number} is gone", run.display()),
                "open it again",
            )),
        }
    }
}

impl Observer for Finder<'_> {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        self.info = info.clone();
        Ok(())
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        if self.left == 0 && self.found.is_none() {
            self.found = Some(snapshot.clone());
            self.stop.store(true, Ordering::Relaxed);
        }
        self.left = self.left.saturating_sub(1);
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}
