//! What a case of verification is.

use super::comparison::Comparison;
use super::support::Context;
use crate::base::error::Result;

/// A case: one claim about the engine that a closed form decides.
pub struct VerificationCase {
    /// What the user calls it.
    pub name: &'static str,
    /// The claim in one line.
    pub about: &'static str,
    /// Where the equation comes from.
    pub source: &'static str,
    /// Runs what the case needs and compares.
    pub run: fn(&Context) -> Result<Vec<Comparison>>,
}
