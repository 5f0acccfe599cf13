//! What the user may change of a study.

use crate::scene::quality::Quality;

/// What the user may change of a study.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Changes {
    /// Accuracy against run time; `None`: as the study says.
    pub quality: Option<Quality>,
    /// Further `--set` options of every case.
    pub set: Vec<String>,
    /// Seeds instead of the study's; empty for those.
    pub seeds: Vec<u64>,
}
