//! Records a finished run again from its trajectory: another colour, another range of strain, or the recording that
//! the run was told not to write.

use super::folder::{RECORDING, SCENE};
use super::identity;
use super::lock::Lock;
use super::replay::{Replay, Selection};
use crate::base::error::Result;
use crate::base::regular::check_target;
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
    /// Record also what the run's files do not agree about.
    pub anyway: bool,
    /// Address of a viewer to stream to as well.
    pub live: Option<String>,
}

/// Records the run in the folder `run` again. Returns the file.
///
/// # Errors
/// Bad input when there is no trajectory, the file exists or nothing is selected; otherwise what reading the
/// run and writing the recording say.
pub fn record(run: &Path, options: &RecordOptions, stop: &AtomicBool) -> Result<PathBuf> {
    let doubts = identity::check(run, options.anyway)?;
    let replay = Replay::open(run, &options.selection)?.doubting(&doubts);
    let file = options.out.clone().unwrap_or_else(|| run.join(RECORDING));
    check_target(&file, options.overwrite, "--out")?;
    if let Some(viewer) = &options.live {
        check_viewer(viewer)?;
    }
    let mut scene = scene::load(&run.join(SCENE).to_string_lossy(), &[])?.spec;
    if let Some(colour) = options.colour {
        scene.output.colour = colour;
    }
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let _lock = Lock::take(folder)?;
    let mut recording = Recording::new(&file, RecordingOptions { live: options.live.clone(), scene })?;
    replay.show(&mut recording, stop)?;
    Ok(file)
}
