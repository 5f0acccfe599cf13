//! What a run writes besides tables. The one place of this floor, besides `devices`, that knows which features were
//! built.

use super::folder::{self, OutFolder, Pictures};
use super::options::RunOptions;
#[cfg(feature = "render")]
use crate::base::digest::Digest;
use crate::base::error::{Error, Result};
use crate::observe::Observer;
use crate::observe::origin::Origin;
use crate::observe::timings::Timings;
use crate::observe::trajectory::TrajectoryWriter;
use crate::scene::spec::Spec;
#[cfg(feature = "render")]
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// Memory for snapshots that wait to be drawn (bytes): some 500 of the main scene's, more than one run has.
#[cfg(feature = "render")]
const WAITING_FRAMES: usize = 256 << 20;

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
    if options.frames || options.animation.is_some() {
        check_frames()?;
    }
    if let Some(animation) = &options.animation {
        animation.check(options.overwrite)?;
    }
    if options.recording || options.live.is_some() {
        check_recording(options.live.as_deref())?;
    }
    Ok(())
}

/// A size for people.
pub fn megabytes(bytes: u64) -> String {
    format!("{:.1} MB", bytes as f64 * 1e-6)
}

/// What writes a run.
pub(super) struct Written {
    /// Trajectory and, if asked for, recording and frames.
    pub observers: Vec<Box<dyn Observer>>,
    /// The frames, if any are drawn.
    pub frames: Option<Frames>,
}

/// Frames that a run draws; their observer is beside it.
pub(super) struct Frames {
    /// Where their time goes.
    timings: Arc<Mutex<Timings>>,
    /// Their folder, marked as unfinished.
    pictures: Pictures,
}

impl Frames {
    /// Where their time has gone.
    pub fn timings(&self) -> Timings {
        *self.timings.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Those that were there already.
    pub fn kept(&self) -> usize {
        self.pictures.whole().len()
    }

    /// Takes the mark off, if the writer has made all that it was told of.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be removed.
    pub fn complete(self) -> Result<()> {
        if self.timings().unfinished() { Ok(()) } else { self.pictures.complete() }
    }
}

/// Opens all that writes a run.
///
/// # Errors
/// [`Error::Io`] when a file cannot be created, [`Error::Missing`] as in [`check`].
pub(super) fn open(options: &RunOptions, spec: &Spec, folder: &OutFolder) -> Result<Written> {
    let mut observers: Vec<Box<dyn Observer>> =
        vec![Box::new(TrajectoryWriter::new(&folder.file(folder::TRAJECTORY), Origin::of(spec))?)];
    if options.recording {
        observers.push(recording(options, spec, folder)?);
    }
    let mut drawn = None;
    if options.frames {
        let (writer, frames) = frames(options, spec, folder, false)?;
        observers.push(writer);
        drawn = Some(frames);
    }
    Ok(Written { observers, frames: drawn })
}

#[cfg(feature = "render")]
fn check_frames() -> Result<()> {
    crate::render::check()
}

#[cfg(not(feature = "render"))]
fn check_frames() -> Result<()> {
    Err(built_without("frames", "render", "leave them out with --no-frames"))
}

/// An observer that draws the frames of a run; where it goes `on`, those that are missing.
///
/// # Errors
/// [`Error::Missing`] as in [`check`]; [`Error::Io`] when the folder cannot be written.
#[cfg(feature = "render")]
pub(super) fn frames(
    options: &RunOptions,
    spec: &Spec,
    folder: &OutFolder,
    on: bool,
) -> Result<(Box<dyn Observer>, Frames)> {
    let at = folder.file(folder::FRAMES);
    let origin = Origin::of(spec);
    let writer = crate::render::FrameWriter::new(&at, &spec.output)?;
    // Another build may draw otherwise.
    let drawn = Digest::of(format!("{} {:?} {}", origin.run, spec.output, super::build::build()));
    let is_whole: &dyn Fn(&Path) -> bool = &crate::render::png::is_whole;
    let pictures = OutFolder::check(&at, true)?;
    let pictures = pictures.open_for_pictures(&drawn, on.then_some(is_whole), Some(&options.outputs()))?;
    let writer = writer.with_origin(origin).with_animation(options.animation.clone()).with_memory(WAITING_FRAMES);
    let writer = writer.without(pictures.whole().clone());
    let timings = writer.shared_timings();
    Ok((Box::new(writer), Frames { timings, pictures }))
}

#[cfg(not(feature = "render"))]
pub(super) fn frames(_: &RunOptions, _: &Spec, _: &OutFolder, _: bool) -> Result<(Box<dyn Observer>, Frames)> {
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
