//! The numbered pictures as one animation: GIF or animated PNG, which loop, or a film.
//!
//! It is made of the pictures when the last one is written: then their number is known, which an animated PNG states
//! at its beginning, and one palette can be chosen for all of them, which a GIF needs to be free of flicker.

mod apng;
mod film;
mod gif;
mod palette;
mod pictures;

pub use film::Film;
pub use pictures::Still;

use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::observe::animation::{Animation, Format};
use crate::observe::partial;
use pictures::Pictures;
use std::io::{BufWriter, Write};
use std::sync::atomic::AtomicBool;

/// Makes the animation of `stills` unless `stop` is set meanwhile; nothing when there are none. Returns its size (bytes).
///
/// # Errors
/// [`Error::Interrupted`] when it was stopped, and nothing is left of it; [`Error::Io`] when a picture cannot be read or the file not be written; [`Error::Input`] for a file name with another
/// ending.
pub fn write(animation: &Animation, stills: &[Still], stop: &AtomicBool) -> Result<u64> {
    if stills.is_empty() {
        return Ok(0);
    }
    let growing = partial::name(&animation.file);
    let refuse = |e| Error::io("cannot write", &growing, e);
    if let Some(folder) = animation.file.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        regular::make_folder(folder)?;
    }
    let mut out = BufWriter::new(partial::create(&animation.file)?);
    let pictures = Pictures { stills, width: animation.width, stop };
    let written = match animation.format()? {
        Format::Gif => gif::write(&pictures, &mut out, &refuse),
        Format::Apng => apng::write(&pictures, &mut out, &refuse),
        Format::Film => film::write(&pictures, &mut out, &refuse),
    };
    if matches!(written, Err(Error::Interrupted)) {
        std::fs::remove_file(&growing).map_err(refuse)?;
    }
    written?;
    out.flush().map_err(refuse)?;
    let bytes = out.get_ref().metadata().map_err(refuse)?.len();
    partial::complete(&animation.file)?;
    Ok(bytes)
}
