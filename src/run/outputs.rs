//! What a run writes besides tables. The one place of this floor that knows which features were built.

use super::RunOptions;
use super::folder::{self, OutFolder};
use crate::base::error::{Error, Result};
use crate::observe::Observer;
use crate::observe::trajectory::TrajectoryWriter;
use crate::scene::spec::Spec;

/// Whether this program can draw frames.
pub const HAS_RENDER: bool = cfg!(feature = "render");
/// Whether this program can write recordings.
pub const HAS_RECORD: bool = cfg!(feature = "record");

/// The error for something that was left out when the program was built.
pub fn built_without(what: &str, feature: &str, instead: &str) -> Error {
    Error::Missing {
        what: format!("this program was built without {what} (feature `{feature}`)"),
        help: Some(format!("build it with `cargo build --release`, or {instead}")),
    }
}

/// Checks, before the simulation, that what was asked for can be had on this machine.
///
/// # Errors
/// [`Error::Missing`]: no graphics adapter, nobody listening, or a feature that was not built.
pub(super) fn check(options: &RunOptions) -> Result<()> {
    if options.frames {
        check_frames()?;
    }
    if options.recording || options.live.is_some() {
        check_recording(options.live.as_deref())?;
    }
    Ok(())
}

/// The observers that write the trajectory and, if asked for, recording and frames.
///
/// # Errors
/// [`Error::Io`] when a file cannot be created, [`Error::Missing`] as in [`check`].
pub(super) fn open(options: &RunOptions, spec: &Spec, folder: &OutFolder) -> Result<Vec<Box<dyn Observer>>> {
    let mut observers: Vec<Box<dyn Observer>> =
        vec![Box::new(TrajectoryWriter::new(&folder.file(folder::TRAJECTORY))?)];
    if options.recording {
        observers.push(recording(options, spec, folder)?);
    }
    if options.frames {
        observers.push(frames(spec, folder)?);
    }
    Ok(observers)
}

#[cfg(feature = "render")]
fn check_frames() -> Result<()> {
    crate::render::check()
}

#[cfg(not(feature = "render"))]
fn check_frames() -> Result<()> {
    Err(built_without("frames", "render", "leave them out with --no-frames"))
}

#[cfg(feature = "render")]
fn frames(spec: &Spec, folder: &OutFolder) -> Result<Box<dyn Observer>> {
    use crate::render::{FrameOptions, FrameWriter};
    let options = FrameOptions { size: spec.output.frame_size, colour: spec.output.colour, ..FrameOptions::default() };
    Ok(Box::new(FrameWriter::new(&folder.file(folder::FRAMES), options)?))
}

#[cfg(not(feature = "render"))]
fn frames(_spec: &Spec, _folder: &OutFolder) -> Result<Box<dyn Observer>> {
    Err(built_without("frames", "render", "leave them out with --no-frames"))
}

#[cfg(feature = "record")]
fn check_recording(live: Option<&str>) -> Result<()> {
    live.map_or(Ok(()), crate::observe::recording::check_viewer)
}

#[cfg(not(feature = "record"))]
fn check_recording(_live: Option<&str>) -> Result<()> {
    Err(built_without("recordings", "record", "leave them out with --no-recording and without --live"))
}

#[cfg(feature = "record")]
fn recording(options: &RunOptions, spec: &Spec, folder: &OutFolder) -> Result<Box<dyn Observer>> {
    use crate::observe::recording::{Recording, RecordingOptions};
    let wanted = RecordingOptions { live: options.live.clone(), scene: spec.clone() };
    Ok(Box::new(Recording::new(&folder.file(folder::RECORDING), wanted)?))
}

#[cfg(not(feature = "record"))]
fn recording(_: &RunOptions, _: &Spec, _: &OutFolder) -> Result<Box<dyn Observer>> {
    Err(built_without("recordings", "record", "leave them out with --no-recording and without --live"))
}
