//! A finished run in files that other programs open: Parquet for tables, VTK for ParaView, LAMMPS and extended XYZ for OVITO.
//!
//! Everything is read from the run's trajectory, without simulating. One file per format; each is an
//! [`Observer`] that is shown the run again. `assets/results/files.md` says what the
//! files hold, in which units, and how programs open them.

mod body;
mod lammps;
#[cfg(feature = "export")]
mod parquet;
#[cfg(feature = "export")]
pub mod parquet_table;
mod staged;
mod target;
#[cfg(feature = "export")]
mod vtk;
mod xyz;

use crate::base::error::{Error, Result};
use crate::base::finding::StopReason;
use crate::observe::Observer;
use crate::observe::summary::RunSummary;
pub use crate::run::exported::Format;
use crate::run::folder::OutFolder;
use crate::run::identity;
use crate::run::outputs::built_without;
use crate::run::replay::{Replay, Selection};
use staged::Staged;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use target::Target;

/// What to export, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportOptions {
    /// The kind of files.
    pub format: Format,
    /// Snapshots to export. Its range of strain holds for the series of wires too; the tables are always whole.
    pub selection: Selection,
    /// The folder; `None`: one in that of the run, named by the format.
    pub out: Option<PathBuf>,
    /// Replace what an earlier export wrote there.
    pub overwrite: bool,
    /// Export also what the run's files do not agree about.
    pub anyway: bool,
}

/// What was exported.
#[derive(Debug)]
pub struct Exported {
    /// The folder.
    pub folder: PathBuf,
    /// Number of files in it.
    pub files: usize,
    /// Their size (bytes).
    pub bytes: u64,
    /// Snapshots in them.
    pub snapshots: usize,
    /// Why the trajectory ends before its run did, if so.
    pub cut_off: Option<String>,
}

/// Exports the run in the folder `run`, or of the trajectory `run`. Nothing has its name before all is whole.
///
/// # Errors
/// [`Error::Input`] when there is no trajectory, nothing is selected, files of the run do not agree, or the folder is not
/// empty; [`Error::Interrupted`] when `stop` was set, with nothing written; [`Error::Io`]; [`Error::Missing`] for a format
/// that was not built.
pub fn export(run: &Path, options: &ExportOptions, stop: &AtomicBool) -> Result<Exported> {
    let doubts = identity::check(run, options.anyway)?;
    let replay = Replay::open(run, &options.selection)?.doubting(&doubts);
    let beside = if run.is_dir() { run } else { run.parent().unwrap_or(Path::new("")) };
    let out = options.out.clone().unwrap_or_else(|| beside.join(options.format.word()));
    OutFolder::check(&out, options.overwrite)?;
    let staged = Staged::open(&out)?;
    let target =
        Target { folder: staged.path().to_owned(), run: replay.origin().run, strain: options.selection.strain };
    let mut writer = writer(options.format, target)?;
    let snapshots = replay.show(&mut *writer, stop).map_err(|error| staged.by_own_name(error))?;
    drop(writer);
    if stop.load(Ordering::Relaxed) {
        return Err(Error::Interrupted);
    }
    let (files, bytes) = staged.complete(options.format)?;
    Ok(Exported { folder: out, files, bytes, snapshots, cut_off: replay.cut_off().map(ToString::to_string) })
}

/// What a run that has ended has made of `output.also`.
#[derive(Debug, Default)]
pub struct Also {
    /// What was made.
    pub made: Vec<Exported>,
    /// Commands that make the rest, where it was stopped before.
    pub left: Vec<String>,
}

/// Makes the files that `output.also` asks for of the run in the folder `run`, where it and its pictures have come to their end
/// by its `summary`, in place of earlier ones.
///
/// # Errors
/// As for [`export`], but that what `stop` leaves out is no error.
pub fn also(run: &Path, summary: &RunSummary, formats: &[Format], stop: &AtomicBool) -> Result<Also> {
    let undrawn = summary.cost.frames.is_some_and(|frames| frames.unfinished());
    let mut also = Also::default();
    if summary.stopped == StopReason::Interrupted || undrawn {
        return Ok(also);
    }
    for format in formats {
        let (selection, out, overwrite, anyway) = (Selection::default(), None, true, false);
        match export(run, &ExportOptions { format: *format, selection, out, overwrite, anyway }, stop) {
            Ok(made) => also.made.push(made),
            Err(Error::Interrupted) => {
                also.left.push(format!("strandsnap export {} --format {}", run.display(), format.word()));
            }
            Err(error) => return Err(error),
        }
    }
    Ok(also)
}

/// Checks that this program can write these formats, and that they have room in the folder `run`, for what would find out only
/// after a long run.
///
/// # Errors
/// [`Error::Missing`] for a format that was not built; [`Error::Input`] where something else than a folder has its name.
pub fn check_also(run: &Path, formats: &[Format]) -> Result<()> {
    formats.iter().try_for_each(|format| {
        check(*format)?;
        let folder = run.join(format.word());
        if folder.is_dir() || std::fs::symlink_metadata(&folder).is_err() {
            return Ok(());
        }
        Err(Error::input(
            format!("{} is not a folder, and output.also writes into it", folder.display()),
            format!("move it away, or leave {} out of output.also", format.word()),
        ))
    })
}

/// Checks that this program can write a format.
///
/// # Errors
/// [`Error::Missing`] when it was not built.
pub fn check(format: Format) -> Result<()> {
    match format {
        Format::Parquet | Format::Vtk if !cfg!(feature = "export") => Err(not_built()),
        Format::Parquet | Format::Vtk | Format::Lammps | Format::Xyz => Ok(()),
    }
}

fn not_built() -> Error {
    built_without("this format", "export", "export to lammps or xyz, which need nothing more")
}

#[cfg(feature = "export")]
fn writer(format: Format, target: Target) -> Result<Box<dyn Observer>> {
    Ok(match format {
        Format::Parquet => Box::new(parquet::Writer::new(target)),
        Format::Vtk => Box::new(vtk::Writer::new(target)),
        Format::Lammps => Box::new(lammps::Writer::new(target)),
        Format::Xyz => Box::new(xyz::Writer::new(target)),
    })
}

#[cfg(not(feature = "export"))]
fn writer(format: Format, target: Target) -> Result<Box<dyn Observer>> {
    match format {
        Format::Parquet | Format::Vtk => Err(not_built()),
        Format::Lammps => Ok(Box::new(lammps::Writer::new(target))),
        Format::Xyz => Ok(Box::new(xyz::Writer::new(target))),
    }
}
