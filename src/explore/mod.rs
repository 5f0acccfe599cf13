//! The floor over studies: an interactive picture of a run (feature `explore`), drawn by [`crate::render`] on the machine
//! where the run lies and steered from a browser.
//!
//! [`Server`] answers one page and its socket at a local address; a `session` is one browser that looks, with a [`View`] of
//! its own; [`record`] holds the run and tells it to the page; [`draw`] draws it with the renderer.

mod control;
pub mod draw;
mod film;
mod http;
pub mod live;
mod path;
mod pick;
pub mod pictures;
pub mod record;
mod server;
mod session;
mod shared;
pub mod view;

pub use path::Path as CameraPath;
pub use server::{Options, Server};
pub use view::View;

use crate::base::error::{Error, Result};
use crate::observe::partial;
use shared::{Pane, Shared};
use std::io::BufWriter;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

fn open(run: &Path, with: Option<&Path>) -> Result<Shared> {
    let other = with.map(Pane::open).transpose()?;
    Shared::new(Pane::open(run)?, other)
}

/// One view of a run, or of two beside each other, as the bytes of a PNG: what the page shows, bit for bit.
///
/// # Errors
/// When the run cannot be read, the view does not fit it, or there is no graphics adapter.
pub fn picture(run: &Path, with: Option<&Path>, view: &View, size: [u32; 2]) -> Result<Vec<u8>> {
    let shared = open(run, with)?;
    shared.check(view)?;
    crate::render::png::encode(&shared.draw(view, size)?.image, None)
}

/// Where a film goes.
pub struct FilmTarget<'a> {
    /// Its file, which is replaced.
    pub file: &'a Path,
    /// Width and height (px).
    pub size: [u32; 2],
    /// Ends it, and nothing is left of it.
    pub stop: &'a AtomicBool,
}

/// The film of a camera path through a run, or through two beside each other: what the page makes, byte for byte. `note` is
/// told how many pictures are done, of how many. Returns its size (bytes).
///
/// # Errors
/// When a run cannot be read, the path does not fit it, or there is no graphics adapter; [`Error::Io`] when the file cannot
/// be written; [`Error::Interrupted`] when it was stopped.
pub fn film(
    run: &Path,
    with: Option<&Path>,
    path: CameraPath,
    target: &FilmTarget,
    note: &mut dyn FnMut(usize, usize),
) -> Result<u64> {
    let shared = open(run, with)?;
    let growing = partial::name(target.file);
    let refuse = |e| Error::io("cannot write", &growing, e);
    film::check(&shared, &path, target.size)?;
    let out = BufWriter::new(partial::create(target.file)?);
    let make = || {
        let mut maker = film::Maker::begin(path, target.size, out, &growing)?;
        while maker.draw_next(&shared)? {
            note(maker.drawn(), maker.pictures());
            if target.stop.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
        }
        let out = maker.end()?.into_inner().map_err(|e| refuse(e.into_error()))?;
        out.metadata().map(|file| file.len()).map_err(refuse)
    };
    let made = make();
    match made {
        Ok(_) => partial::complete(target.file)?,
        // What made it go wrong is what is told.
        Err(_) => drop(std::fs::remove_file(&growing)),
    }
    made
}
