//! Floor 0: units, vectors, numbers by the register and formulas that are recorded, seeded randomness, errors, findings and their words, regular files, ticks of axes. Imports nothing of this crate.

pub mod bisect;
pub mod digest;
pub mod error;
pub mod finding;
pub mod lanes;
pub mod lay;
pub mod random;
pub mod recorder;
pub mod regular;
pub mod ticks;
pub mod triple;
pub mod units;
pub mod vectors;
pub mod wording;
pub mod worst;
