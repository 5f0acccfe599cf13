//! Floor 0: units, vectors, seeded randomness, errors. Imports nothing of this crate.

pub mod error;
pub mod lanes;
pub mod random;
pub mod units;
pub mod vectors;
