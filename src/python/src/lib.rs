//! strandsnap for Python: a thin layer over the library, as the command line is one. The package `strandsnap` beside this
//! crate shows what is here to users.

mod arrays;
mod calibrate;
mod error;
mod frame;
mod options;
mod results;
mod run;
mod scene;
mod study;
mod watch;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

/// The module `strandsnap._core`.
#[pymodule]
mod _core {
    #[pymodule_export]
    use super::calibrate::{Calibration, py_calibrate};
    #[pymodule_export]
    use super::results::PyRun;
    #[pymodule_export]
    use super::run::{py_run, resume};
    #[pymodule_export]
    use super::scene::{PyScene, scenes};
    #[pymodule_export]
    use super::study::{PyStudy, StudyResults, studies};
    #[pymodule_export]
    use super::{built_in, main};

    /// Its version.
    #[pymodule_export]
    #[allow(non_upper_case_globals, reason = "it is called so in Python")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
    /// Whether pictures can be drawn.
    #[pymodule_export]
    const HAS_FRAMES: bool = cfg!(feature = "frames");
    /// Whether recordings can be written.
    #[pymodule_export]
    const HAS_RECORDING: bool = cfg!(feature = "recording");
}

/// Tells the library which file it is in: results that are kept name the build that made them.
#[pyfunction]
fn built_in(file: PathBuf) {
    strandsnap::run::build::is_in(file);
}

/// The command line: gives the exit code, or ends the process with it.
#[pyfunction]
fn main(starts: Vec<String>, arguments: Vec<OsString>, py: Python) -> PyResult<u8> {
    // It listens for signals, and remembers how it was called, as long as the process lives.
    static BEGUN: AtomicBool = AtomicBool::new(false);
    if BEGUN.swap(true, Ordering::Relaxed) {
        return Err(PyRuntimeError::new_err("the command line runs once in a process; start another one"));
    }
    Ok(py.detach(|| strandsnap::cli::main_within(starts, arguments)))
}
