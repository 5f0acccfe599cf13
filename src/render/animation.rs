//! The numbered pictures as one animation: GIF or animated PNG, which loop, or a film.
//!
//! It is made of the pictures when the last one is written: then their number is known, which an animated PNG states
//! at its beginning, and one palette can be chosen for all of them, which a GIF needs to be free of flicker.

mod apng;
mod film;
mod gif;
mod palette;
mod pictures;

pub use pictures::Still;

use crate::base::error::{Error, Result};
use crate::observe::animation::{Animation, Format};
use crate::observe::partial;
use pictures::Pictures;
use std::io::{BufWriter, Write};

/// Makes the animation of `stills`; nothing when there are none. Returns its size (bytes).
///
/// # Errors
/// [`Error::Io`] when a picture cannot be read or the file not be written; [`Error::Input`] for a file name with another
/// ending.
pub fn write(animation: &Animation, stills: &[Still]) -> Result<u64> {
    if stills.is_empty() {
        return Ok(0);
    }
    let growing = partial::name(&animation.file);
    let refuse = |e| Error::io("cannot write", &growing, e);
    let mut out = BufWriter::new(partial::create(&animation.file)?);
    let pictures = Pictures { stills, width: animation.width };
    match animation.format()? {
        Format::Gif => gif::write(&pictures, &mut out, &refuse)?,
        Format::Apng => apng::write(&pictures, &mut out, &refuse)?,
        Format::Film => film::write(&pictures, &mut out, &refuse)?,
    }
    out.flush().map_err(refuse)?;
    let bytes = out.get_ref().metadata().map_err(refuse)?.len();
    partial::complete(&animation.file)?;
    Ok(bytes)
}
