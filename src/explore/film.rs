//! The film of a camera path, drawn picture by picture.

use super::path::Path as CameraPath;
use super::shared::Shared;
use crate::base::error::{Error, Result};
use crate::render::animation::Film;
use crate::render::canvas::Fonts;
use crate::render::caption::{Scale, caption};
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};

/// A film that is being made.
pub(super) struct Maker<W: Write + Seek> {
    path: CameraPath,
    size: [u32; 2],
    film: Film<W>,
    /// What messages call it.
    name: PathBuf,
    fonts: Fonts,
    drawn: usize,
}

/// Checks that a path can be filmed at a size.
///
/// # Errors
/// [`Error::Input`] that says what is wrong.
pub(super) fn check(shared: &Shared, path: &CameraPath, size: [u32; 2]) -> Result<()> {
    path.check(&shared.run.record())?;
    path.views.iter().try_for_each(|view| super::draw::check_size(size, view.supersampling))
}

impl<W: Write + Seek> Maker<W> {
    /// Begins the film of a path that [`check`] has let through.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be written.
    pub fn begin(path: CameraPath, size: [u32; 2], out: W, name: &Path) -> Result<Self> {
        let film = Film::begin(out, path.pictures()).map_err(|e| Error::io("cannot write", name, e))?;
        Ok(Self { path, size, film, name: name.into(), fonts: Fonts::embedded(), drawn: 0 })
    }

    /// How many pictures the film will have.
    pub fn pictures(&self) -> usize {
        self.path.pictures()
    }

    /// How many it has.
    pub fn drawn(&self) -> usize {
        self.drawn
    }

    /// Draws the next picture; whether there was one to draw.
    ///
    /// # Errors
    /// [`Error::Missing`] when the adapter is lost, [`Error::Io`] when the film cannot be written.
    pub fn draw_next(&mut self, shared: &Shared) -> Result<bool> {
        if self.drawn == self.pictures() {
            return Ok(false);
        }
        let view = self.path.view(&shared.run.record(), self.drawn);
        let image = shared.draw(&view, self.size)?.image;
        let scale = Scale { pixels_per_mm: f64::from(self.size[1]) / view.height };
        let picture = caption(image, &self.fonts, &view.theme.style(), &shared.captions(&view), scale);
        let added = self.film.add(picture, self.path.shown(self.drawn));
        added.map_err(|e| Error::io("cannot write", &self.name, e))?;
        self.drawn += 1;
        Ok(true)
    }

    /// Bytes so far.
    pub fn bytes(&self) -> u64 {
        self.film.bytes()
    }

    /// The whole film.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be written.
    pub fn end(self) -> Result<W> {
        self.film.end().map_err(|e| Error::io("cannot write", self.name, e))
    }
}
