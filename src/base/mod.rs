//! Floor 0: units, vectors, seeded randomness, errors, ticks of axes. Imports nothing of this crate.

pub mod error;
pub mod lanes;
pub mod lay;
pub mod random;
pub mod ticks;
pub mod triple;
pub mod units;
pub mod vectors;
