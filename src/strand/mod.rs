//! Floor 3: geometry. Helices and layers, lay radii, centreline text in and out, discretisation into particles.

pub mod assembly;
