//! The table of cases.

mod geometry;
mod loads;
mod materials;
mod steps;

use super::case::{Base, StabilityCase};

/// The smallest strand that has everything.
const SEVEN: Base = Base::Text(include_str!("../../../../assets/scenes/stability/seven-wires.toml"));
/// One wire between two grips.
const WIRE: Base = Base::Text(include_str!("../../../../assets/scenes/stability/wire.toml"));
/// A slender clamped wire that buckles.
const COLUMN: Base = Base::Text(include_str!("../../../../assets/scenes/stability/column.toml"));
/// A wire that rests on another.
const REST: Base = Base::Text(include_str!("../../../../assets/scenes/stability/rest.toml"));
/// Particles beside others of a million times their mass.
const LIGHT_ON_HEAVY: Base = Base::Text(include_str!("../../../../assets/scenes/stability/light-on-heavy.toml"));

/// Every case.
pub fn cases() -> Vec<StabilityCase> {
    [steps::cases(), materials::cases(), geometry::cases(), loads::cases()].concat()
}

/// Length in mm as scenes write it.
fn mm(value: f64) -> String {
    format!("\"{value} mm\"")
}
