//! Files that are only whole at the end of a run are written under another name until then, so that an unfinished
//! one never looks whole.

use crate::base::error::{Error, Result};
use std::path::{Path, PathBuf};

/// The name under which `file` is written until it is whole: `recording.rrd.partial`.
pub fn name(file: &Path) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(".partial");
    name.into()
}

/// Gives the finished file its final name.
///
/// # Errors
/// [`Error::Io`] when it cannot be renamed.
pub fn complete(file: &Path) -> Result<()> {
    std::fs::rename(name(file), file).map_err(|e| Error::io("cannot write", file, e))
}
