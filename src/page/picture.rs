//! Frames as they stand on the page: found in the run's folder, made smaller, as JPEG in text.

use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::run::folder::{FRAMES, is_undrawn};
use crate::run::identity;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use image::imageops::FilterType;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Where `strandsnap render RUN` draws.
const RENDER: &str = "render";
/// Pictures are shown no wider than this (px).
const WIDEST: u32 = 1280;
/// Of the JPEG (%): the small print of a frame stays sharp, and fifty of them stay below 10 MB.
const QUALITY: u8 = 75;

/// The numbered pictures of a run, one per snapshot.
#[derive(Debug, Default)]
pub struct Pictures {
    /// How many there are.
    pub found: usize,
    /// They are not all that the run was to draw.
    pub unfinished: bool,
    by_number: BTreeMap<usize, PathBuf>,
}

/// A picture as the page holds it.
pub struct Embedded {
    /// `data:` address of a JPEG.
    pub address: String,
    /// Width and height (px).
    pub size: [u32; 2],
}

impl Pictures {
    /// The pictures that the run drew, or else those that were drawn again of every one of its snapshots.
    ///
    /// # Errors
    /// [`Error::Io`] when a folder cannot be read.
    pub fn find(run: &Path, snapshots: usize) -> Result<Self> {
        let drawn = identity::pictures(&run.join(FRAMES))?;
        // Number n is snapshot n for what the run drew; for what was drawn again only when nothing was left out.
        let again = identity::pictures(&run.join(RENDER))?;
        let complete = again.len() == snapshots;
        let unfinished = is_undrawn(&run.join(FRAMES));
        let by_number = if complete && (drawn.is_empty() || unfinished) { again } else { drawn };
        Ok(Self { found: by_number.len(), unfinished: unfinished && by_number.len() < snapshots, by_number })
    }

    /// The picture of a snapshot.
    pub fn of(&self, snapshot: usize) -> Option<PathBuf> {
        self.by_number.get(&snapshot).cloned()
    }
}

/// Reads a picture and makes it small enough for a page.
///
/// # Errors
/// [`Error::Io`] when it cannot be read; [`Error::Input`] when it is damaged.
pub fn embed(path: &Path) -> Result<Embedded> {
    let bytes = regular::read(path, regular::LONGEST_TABLE)?;
    let damaged = |e: image::ImageError| {
        Error::input(format!("{} is damaged: {e}", path.display()), "draw the frames again with `strandsnap render`")
    };
    let mut picture = image::load_from_memory(&bytes).map_err(damaged)?;
    if picture.width() > WIDEST {
        picture = picture.resize(WIDEST, u32::MAX, FilterType::Triangle);
    }
    let mut jpeg = Vec::new();
    JpegEncoder::new_with_quality(&mut jpeg, QUALITY).encode_image(&picture.to_rgb8()).map_err(damaged)?;
    let address = format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg));
    Ok(Embedded { address, size: [picture.width(), picture.height()] })
}
