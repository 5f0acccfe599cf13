//! Checks a run's folder: what must hold between all files that a run writes, and between them and physics.
//!
//! [`Folder`] reads every file; [`INVARIANTS`] lists what must hold. A new one is a function in the file of its kind and a
//! row in that table.

mod anew;
mod breaks;
mod details;
mod drive;
mod files;
mod finding;
mod folder;
mod invariant;
mod law;
mod limits;
mod maker;
mod mechanics;
mod page;
mod page_words;
mod pictures;
#[cfg(feature = "record")]
mod recording;
pub mod report;
mod rows;
mod shares;
mod tables;

pub use finding::{Deviation, InvariantOutcome};
pub use folder::Folder;
pub use invariant::Invariant;

use crate::base::error::Result;
use std::path::Path;

/// All invariants, by kind.
pub const INVARIANTS: &[Invariant] = &[
    // Tables by themselves
    rows::FINITE,
    rows::TIME,
    rows::TIME_STEP,
    drive::STRAIN,
    drive::WAY,
    rows::FORCE,
    // One file against another
    files::OWN,
    anew::TABLES,
    anew::SUMMARY,
    anew::BODIES,
    files::CURVE,
    files::SNAPSHOTS,
    files::LAYERS,
    files::WIRES,
    files::RUPTURES,
    files::SUMMARY,
    files::STRENGTH,
    shares::SHARES,
    files::RECORDING,
    page::PAGE,
    page_words::WORDS,
    pictures::PICTURES,
    pictures::ANIMATION,
    pictures::NAMED,
    details::DETAILS,
    // Breaks
    breaks::COUNTS,
    breaks::ROWS,
    breaks::SILENT,
    breaks::SILENT_WIRES,
    // Physics
    law::BONDS,
    law::WIRES,
    law::RUPTURES,
    mechanics::GRIP,
    mechanics::WORK,
    mechanics::LEDGER,
    mechanics::STIFFNESS,
    mechanics::STRAND_THEORY,
];

/// An invariant, and what became of it.
pub struct InvariantCheck {
    /// The invariant.
    pub invariant: &'static Invariant,
    /// Whether it holds.
    pub outcome: InvariantOutcome,
}

/// Checks the run in the folder `run`.
///
/// # Errors
/// [`crate::base::error::Error::Input`] when it is no folder of a whole run, or a file in it cannot be understood.
pub fn check(run: &Path) -> Result<Vec<InvariantCheck>> {
    let folder = Folder::read(run)?;
    Ok(INVARIANTS.iter().map(|invariant| InvariantCheck { invariant, outcome: (invariant.check)(&folder) }).collect())
}
