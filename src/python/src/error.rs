//! Errors of the library as exceptions of `strandsnap._errors`, with the text that the command line shows.

use miette::{Diagnostic, MietteHandlerOpts, ReportHandler};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fmt;
use strandsnap::base::error::Error;

/// An error as the command line shows it where standard error is no terminal: without colours.
struct Shown<'a>(&'a Error);

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        MietteHandlerOpts::new().color(false).build().debug(self.0, f)
    }
}

/// The exception of an error.
pub fn raise(py: Python, error: &Error) -> PyErr {
    exception(py, error).unwrap_or_else(|failed| failed)
}

fn exception(py: Python, error: &Error) -> PyResult<PyErr> {
    let class = match error {
        Error::Scene(_) => "SceneError",
        Error::Input { .. } => "InputError",
        Error::Io { .. } => "FileError",
        Error::Missing { .. } => "MissingError",
        Error::Simulation(_) => "SimulationError",
        Error::Interrupted => return Ok(PyKeyboardInterrupt::new_err("interrupted")),
    };
    let about = PyDict::new(py);
    about.set_item("what", error.to_string())?;
    about.set_item("help", error.help().map(|help| help.to_string()))?;
    about.set_item("exit_code", error.exit_code())?;
    match error {
        Error::Scene(scene) => {
            let text = scene.source_code.inner();
            let line = scene.span.map(|span| 1 + text[..span.offset().min(text.len())].matches('\n').count());
            about.set_item("file", scene.source_code.name())?;
            about.set_item("line", line)?;
        }
        Error::Io { path, .. } => about.set_item("file", path.to_string_lossy())?,
        _ => {}
    }
    let class = py.import("strandsnap._errors")?.getattr(class)?;
    Ok(PyErr::from_value(class.call((Shown(error).to_string(),), Some(&about))?))
}

/// Results of the library as those of Python.
pub trait OrRaise<T> {
    /// The value, or the exception of its error.
    fn or_raise(self, py: Python) -> PyResult<T>;
}

impl<T> OrRaise<T> for Result<T, Error> {
    fn or_raise(self, py: Python) -> PyResult<T> {
        self.map_err(|error| raise(py, &error))
    }
}

/// Issues warnings of a run, as the command line prints them.
pub fn warn(py: Python, warnings: &[String]) -> PyResult<()> {
    if warnings.is_empty() {
        return Ok(());
    }
    let category = py.import("strandsnap._errors")?.getattr("RunWarning")?;
    let warn = py.import("warnings")?.getattr("warn")?;
    warnings.iter().try_for_each(|text| warn.call1((text, &category)).map(drop))
}
