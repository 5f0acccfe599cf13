//! What an invariant is.

use super::finding::InvariantOutcome;
use super::folder::Folder;

/// What must hold of a run.
pub struct Invariant {
    /// Its name.
    pub name: &'static str,
    /// What it says, in one line.
    pub about: &'static str,
    /// Looks whether it does.
    pub check: fn(&Folder) -> InvariantOutcome,
}
