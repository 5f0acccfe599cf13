//! `Scene`.

use crate::error::OrRaise;
use crate::options::{overrides, quality};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};
use strandsnap::base::error::Result;
use strandsnap::scene::{self, builtin, write};

/// What is simulated: wires, how they are laid up, held and pulled, and when it ends.
#[pyclass(frozen, module = "strandsnap", name = "Scene")]
pub struct PyScene {
    /// The scene of the library.
    pub scene: scene::Scene,
    changed: Vec<String>,
}

impl PyScene {
    /// One that was read.
    pub fn of(scene: scene::Scene) -> Self {
        Self { scene, changed: Vec::new() }
    }

    fn made(scene: Result<scene::Scene>, py: Python, preset: Option<&str>, memory: Option<u64>) -> PyResult<Self> {
        let preset = quality(preset)?.unwrap_or_default();
        let made = || {
            let mut scene = scene::Scene { memory, ..scene? };
            let changed = preset.apply(&mut scene)?;
            Ok(Self { scene, changed })
        };
        made().or_raise(py)
    }
}

#[pymethods]
impl PyScene {
    /// Reads a scene that comes with the program, by its name, or a TOML file, by its path.
    ///
    /// `set` changes keys as `--set key=value` does: a dict such as `{"stop.strain": "2 %"}` or a list of `"key=value"`;
    /// `None` removes a key. Other keywords do the same with `__` for the dot: `contact__friction=0.3`. `quality` is draft,
    /// standard or fine, `seed` that of the scatter, `memory` the most that its run may take (bytes).
    #[new]
    #[pyo3(signature = (source, set=None, *, quality=None, seed=None, memory=None, **keys))]
    fn new(
        py: Python,
        source: PathBuf,
        set: Option<&Bound<PyAny>>,
        quality: Option<&str>,
        seed: Option<u64>,
        memory: Option<u64>,
        keys: Option<&Bound<PyDict>>,
    ) -> PyResult<Self> {
        let options = with_seed(overrides(set, keys)?, seed);
        Self::made(scene::load(&source.to_string_lossy(), &options), py, quality, memory)
    }

    /// Reads a scene from TOML text. `name` is shown in errors, and names the scene where the text does not; centreline files
    /// are looked for in `folder`.
    #[staticmethod]
    #[pyo3(signature = (text, set=None, *, name="scene.toml", folder=None, quality=None, seed=None, memory=None, **keys))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    fn from_text(
        py: Python,
        text: &str,
        set: Option<&Bound<PyAny>>,
        name: &str,
        folder: Option<PathBuf>,
        quality: Option<&str>,
        seed: Option<u64>,
        memory: Option<u64>,
        keys: Option<&Bound<PyDict>>,
    ) -> PyResult<Self> {
        let options = with_seed(overrides(set, keys)?, seed);
        let folder = folder.unwrap_or_else(|| Path::new(".").into());
        Self::made(scene::parse(text, name, &folder, &options), py, quality, memory)
    }

    /// Its name, after which the folder of its run is called.
    #[getter]
    fn name(&self) -> &str {
        &self.scene.spec.name
    }

    /// What it shows, in a sentence.
    #[getter]
    fn about(&self) -> &str {
        &self.scene.spec.about
    }

    /// The resolved scene as TOML: running it gives the same bits.
    #[getter]
    fn toml(&self) -> String {
        write::to_toml(&self.scene.spec)
    }

    /// What `quality` has changed, each as `key=value`.
    #[getter]
    fn changed(&self) -> Vec<String> {
        self.changed.clone()
    }

    /// Keys that it gives without effect, in words.
    #[getter]
    fn idle(&self) -> Vec<String> {
        self.scene.idle.iter().map(ToString::to_string).collect()
    }

    fn __repr__(&self) -> String {
        format!("<strandsnap.Scene {}: {}>", self.scene.spec.name, self.scene.spec.about)
    }
}

/// Options with that of a seed, which wins over the others.
fn with_seed(mut options: Vec<String>, seed: Option<u64>) -> Vec<String> {
    options.extend(seed.map(|seed| format!("seed={seed}")));
    options
}

/// The scenes that come with the program: name and TOML text.
#[pyfunction]
pub fn scenes(py: Python) -> PyResult<Bound<PyDict>> {
    let all = PyDict::new(py);
    builtin::list().iter().try_for_each(|(name, text)| all.set_item(name, text))?;
    Ok(all)
}
