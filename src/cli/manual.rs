//! `strandsnap completions` and `strandsnap man`: both are made from the command line's own definition.

use super::say::{self, say};
use crate::base::error::{Error, Result};
use crate::base::regular;
use clap::Command;
use clap_complete::Shell;
use std::path::Path;

/// Prints the completions of a shell.
pub fn completions(shell: Shell, command: &mut Command) {
    let mut script = Vec::new();
    clap_complete::generate(shell, command, "strandsnap", &mut script);
    say::print(format_args!("{}", String::from_utf8_lossy(&script)));
}

/// Writes `strandsnap.1` and a page for each command.
///
/// # Errors
/// A file in the place of the folder; when the folder cannot be made or a page cannot be written.
pub fn pages(command: Command, folder: &Path) -> Result<()> {
    regular::make_folder(folder)?;
    clap_mangen::generate_to(command, folder).map_err(|error| Error::io("cannot write into", folder, error))?;
    say!("manual pages are in {}; read one: man -l {}", folder.display(), folder.join("strandsnap.1").display());
    Ok(())
}
