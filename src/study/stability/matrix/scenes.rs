//! Scenes that cases start from.

use crate::study::stability::case::Base;

/// The smallest strand that has everything.
pub const SEVEN: Base = Base::Text(include_str!("../../../../assets/scenes/stability/seven-wires.toml"));
/// One wire between two grips.
pub const WIRE: Base = Base::Text(include_str!("../../../../assets/scenes/stability/wire.toml"));
/// A slender clamped wire that buckles.
pub const COLUMN: Base = Base::Text(include_str!("../../../../assets/scenes/stability/column.toml"));
/// A wire that rests on another.
pub const REST: Base = Base::Text(include_str!("../../../../assets/scenes/stability/rest.toml"));
/// Particles beside others of a million times their mass.
pub const LIGHT_ON_HEAVY: Base = Base::Text(include_str!("../../../../assets/scenes/stability/light-on-heavy.toml"));

/// Length in mm as scenes write it.
pub fn mm(value: f64) -> String {
    format!("\"{value} mm\"")
}
