//! Records a finished run again from its trajectory: another colour, another range of strain, or the recording that
//! the run was told not to write.

use super::folder::{RECORDING, SCENE};
use super::replay::{Replay, Selection};
use crate::base::error::{Error, Result};
use crate::observe::recording::{Recording, RecordingOptions, check_viewer};
use crate::scene::{self, spec::ColourBy};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// What to record, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordOptions {
    /// Snapshots to record.
    pub selection: Selection,
    /// Quantity that colours; `None`: that of the scene.
    pub colour: Option<ColourBy>,
    /// The file; `None`: that of the run.
    pub out: Option<PathBuf>,
    /// Replace it.
    pub overwrite: bool,
    /// Address of a viewer to stream to as well.
    pub live: Option<String>,
}

/// Records the run in the folder `run` again. Returns the file.
///
/// # Errors
/// [`Error::Input`] when there is no trajectory, the file exists or nothing is selected; otherwise what reading the
/// run and writing the recording say.
pub fn record(run: &Path, options: &RecordOptions, stop: &AtomicBool) -> Result<PathBuf> {
    let replay = Replay::open(run, &options.selection)?;
    let file = options.out.clone().unwrap_or_else(|| run.join(RECORDING));
    if file.exists() && !options.overwrite {
        return Err(Error::input(
            format!("{} exists", file.display()),
            "give --overwrite to replace it, or another file with --out",
        ));
    }
    if let Some(viewer) = &options.live {
        check_viewer(viewer)?;
    }
    let mut scene = scene::load(&run.join(SCENE).to_string_lossy(), &[])?.spec;
    if let Some(colour) = options.colour {
        scene.output.colour = colour;
    }
    let mut recording = Recording::new(&file, RecordingOptions { live: options.live.clone(), scene })?;
    replay.show(&mut recording, stop)?;
    Ok(file)
}
