//! The table of cases.

mod geometry;
mod loads;
mod materials;
mod scenes;
mod steps;

use super::case::StabilityCase;

/// Every case.
pub fn cases() -> Vec<StabilityCase> {
    [steps::cases(), materials::cases(), geometry::cases(), loads::cases()].concat()
}
