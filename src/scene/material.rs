//! Elastic constants, of wires, spheres and rigid bodies alike.

/// Isotropic elastic constants and density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Density (kg/m³).
    pub density: f64,
    /// Young's modulus (Pa).
    pub young: f64,
    /// Poisson's ratio (-).
    pub poisson: f64,
}

impl Material {
    /// Shear modulus E / (2 (1 + ν)) (Pa).
    pub fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }
}
