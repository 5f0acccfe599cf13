//! The floor between runs and studies: a page for people, one self-contained HTML file that tells what a run found.
//!
//! [`Source`] reads the run's folder; each section is one function in its own file, listed in `SECTIONS`; charts are
//! Plotly figures written as JSON (`figure.rs`) and drawn by the copy of plotly.js in `assets/page`. The page fetches
//! nothing: its own content policy forbids it.

mod abscissa;
mod accuracy;
mod answer;
mod breaks;
mod curve;
pub mod document;
mod energy;
mod figure;
mod picture;
mod quasi_static;
mod scene;
mod section;
mod select;
mod solid;
mod source;
mod states;
mod study;
mod unrolled;
mod wires;

pub use abscissa::Abscissa;
pub use answer::{first_rupture, headline};
pub use section::Section;
pub use source::{Source, trajectory_in};

use crate::base::error::{Error, Result};
use crate::base::regular::check_target;
use crate::observe::files::write_whole;
use crate::run::folder::{self, REPORT};
use crate::run::identity::{self, Doubt};
use std::path::{Path, PathBuf};

/// The sections, in their order on the page. A new one is a file with such a function, and a row here.
const SECTIONS: [fn(&Source) -> Result<Section>; 9] = [
    answer::section,
    curve::section,
    states::section,
    breaks::section,
    wires::section,
    quasi_static::section,
    energy::section,
    accuracy::section,
    scene::section,
];

/// A page that was written.
#[derive(Debug, Clone, PartialEq)]
pub struct Written {
    /// Where it is.
    pub path: PathBuf,
    /// How big it is (bytes).
    pub bytes: usize,
    /// Frames in it, and pictures that the run has.
    pub frames: [usize; 2],
    /// What the folder lacks; also at the top of the page.
    pub notes: Vec<String>,
}

/// Writes the page of the run in folder `run` to `out`, by default `report.html` in that folder. `study` is the folder of
/// a study of error against run time; by default the one of its scene, if there is one. Files that are not of one run are an error; with `anyway` the page says so.
///
/// # Errors
/// [`Error::Input`] when a folder holds no run or no study that can be read, or the file exists and `overwrite` is not
/// set; [`Error::Io`] when the file system refuses.
pub fn write(run: &Path, out: Option<&Path>, study: Option<&Path>, overwrite: bool, anyway: bool) -> Result<Written> {
    let path = out.map_or_else(|| run.join(REPORT), Path::to_path_buf);
    // What stands in the way is said before a long run is read.
    source::check(run)?;
    check_target(&path, overwrite, "--out")?;
    let doubts = identity::check(run, anyway)?;
    let mut source = Source::read(run)?;
    source.notes.extend(doubts.iter().map(doubtful));
    source.accuracy = read_study(study, &source.info.name)?;
    let text = html(&source)?;
    write_whole(&path, &text)?;
    let frames = [source.pictures_shown(), source.pictures.found];
    Ok(Written { path, bytes: text.len(), frames, notes: source.notes })
}

/// What a page says of a file that is not believed.
pub fn doubtful(doubt: &Doubt) -> String {
    format!("This page is of doubtful files: {doubt}.")
}

/// The page as text.
///
/// # Errors
/// [`Error::Io`] or [`Error::Input`] when a picture cannot be read.
pub fn html(source: &Source) -> Result<String> {
    let sections = SECTIONS.iter().map(|build| build(source)).collect::<Result<Vec<_>>>()?;
    Ok(document::document(source, &sections).into_string())
}

fn read_study(given: Option<&Path>, scene: &str) -> Result<Option<study::Study>> {
    let Some(given) = given else { return study::Study::read(&folder::accuracy(scene)) };
    let missing = || {
        Error::input(
            format!("--accuracy {} holds no study", given.display()),
            "give the folder of a study, such as out/accuracy/ka4; `strandsnap accuracy` makes one",
        )
    };
    study::Study::read(given)?.ok_or_else(missing).map(Some)
}
