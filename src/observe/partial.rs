//! Files that are only whole at the end of a run are written under another name until then, so that an unfinished
//! one never looks whole.

use crate::base::error::{Error, Result};
use crate::base::regular;
use std::fs::File;
use std::path::{Path, PathBuf};

/// The name under which `file` is written until it is whole: `recording.rrd.partial`.
pub fn name(file: &Path) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(".partial");
    name.into()
}

/// Creates `file` under its partial name.
///
/// # Errors
/// [`Error::Input`] where a device, a pipe, a link or a folder has one of the two names; [`Error::Io`].
pub fn create(file: &Path) -> Result<File> {
    let growing = name(file);
    regular::replaceable(file)?;
    regular::replaceable(&growing)?;
    File::create(&growing).map_err(|e| Error::io("cannot write", growing, e))
}

/// Gives the finished file its final name.
///
/// # Errors
/// [`Error::Io`] when it cannot be renamed.
pub fn complete(file: &Path) -> Result<()> {
    std::fs::rename(name(file), file).map_err(|e| Error::io("cannot write", file, e))
}
