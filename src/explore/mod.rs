//! The floor over studies: an interactive picture of a run (feature `explore`), drawn by [`crate::render`] on the machine
//! where the run lies and steered from a browser.
//!
//! [`Server`] answers one page and its socket at a local address; a `session` is one browser that looks, with a [`View`] of
//! its own; [`record`] holds the run and tells it to the page; [`draw`] draws it with the renderer.

pub mod draw;
mod http;
mod pick;
pub mod record;
mod server;
mod session;
mod shared;
pub mod view;

pub use server::{Options, Server};
pub use view::View;

use crate::base::error::Result;
use std::path::Path;

/// One view of a run as the bytes of a PNG: what the page shows, bit for bit.
///
/// # Errors
/// When the run cannot be read, the view does not fit it, or there is no graphics adapter.
pub fn picture(run: &Path, view: &View, size: [u32; 2]) -> Result<Vec<u8>> {
    let record = record::Record::read(run)?;
    view.check(record.info(), record.states())?;
    let picture = draw::Artist::new(&record)?.draw(&record, view, size)?;
    crate::render::png::encode(&picture.image, None)
}
