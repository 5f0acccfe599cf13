//! Floor 3: geometry. Helices and layers, lay radii, centreline text in and out, discretisation into particles.

pub mod assembly;
pub mod caution;
pub mod centrelines;
mod chain;
pub mod discretise;
pub mod error;
pub mod held;
pub mod helix;
pub mod lay_radius;
pub mod overlap;
pub mod resample;
pub mod size;
pub mod surface;
#[cfg(test)]
pub(crate) mod test_specs;
pub mod theory;

pub use discretise::build;
pub use error::{BuildError, BuildErrorKind};
