//! Bonds between neighbours along a wire.
//!
//! | name | equation | source |
//! | --- | --- | --- |
//! | `elastic` | axial EA ln(l/l₀), Timoshenko shear, bending EI/l, torsion GJ/l, linear | Potyondy & Cundall 2004; Timoshenko |
//! | `elasto-plastic` | the same with (N/N_p)² + \|M\|/M_p + (T/T_p)² + (V/V_p)² ≤ 1, associative, isotropic hardening | section plasticity; hardening in [`hardening`] |
//!
//! Rupture criteria stand in [`rupture`], apart from the laws, so that their costs add instead of multiplying.

pub mod elastic;
pub mod elasto_plastic;
pub mod hardening;
pub mod rupture;

use std::f64::consts::PI;

/// What a bond law knows of the material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moduli {
    /// Young's modulus E [Pa].
    pub young: f64,
    /// Shear modulus G [Pa].
    pub shear: f64,
    /// Timoshenko shear coefficient of a round section κ = 6(1+ν)/(7+6ν) [-] (Cowper 1966).
    pub kappa: f64,
    /// 1/E [1/Pa].
    pub compliance: f64,
    /// EI over GJ of a round section, E/(2G) [-].
    pub bend_over_twist: f64,
}

impl Moduli {
    /// From Young's modulus [Pa] and Poisson's ratio [-].
    pub fn new(young: f64, poisson: f64) -> Self {
        let shear = young / (2.0 * (1.0 + poisson));
        Self {
            young,
            shear,
            kappa: 6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson),
            compliance: 1.0 / young,
            bend_over_twist: young / (2.0 * shear),
        }
    }
}

/// Undeformed shape of a bond.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BondShape {
    /// Stress-free length l₀ [m].
    pub rest_length: f64,
    /// Radius of the section r₀ [m].
    pub radius: f64,
    /// 1/l₀ [1/m] and 1/r₀ [1/m]: divisions are what a bond spends its time on.
    pub inverse_length: f64,
    /// See `inverse_length`.
    pub inverse_radius: f64,
}

impl BondShape {
    /// A bond of stress-free length [m] and radius [m].
    pub fn new(rest_length: f64, radius: f64) -> Self {
        Self { rest_length, radius, inverse_length: 1.0 / rest_length, inverse_radius: 1.0 / radius }
    }
}

/// Deformation of a bond over one step, in its co-rotating frame (n, e₁, e₂).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BondIncrement {
    /// Total log strain ln(l/l₀) at the end of the step [-].
    pub log_strain: f64,
    /// Length l at the end of the step [m].
    pub length: f64,
    /// Increment of the relative shear displacement along e₁, e₂ [m].
    pub shear: [f64; 2],
    /// Increment of the relative rotation about e₁, e₂ [rad].
    pub bend: [f64; 2],
    /// Increment of the relative rotation about n [rad].
    pub twist: f64,
}

/// Internal forces of a bond in its co-rotating frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BondForce {
    /// Axial force N, tension positive [N].
    pub axial: f64,
    /// Shear force V along e₁, e₂ [N].
    pub shear: [f64; 2],
    /// Bending moment M about e₁, e₂ [N m].
    pub bend: [f64; 2],
    /// Torque T about n [N m].
    pub twist: f64,
}

/// Length of a 2-vector; forces are far from the ends of the number range, so no scaling is needed.
#[inline(always)]
fn size(v: [f64; 2]) -> f64 {
    (v[0] * v[0] + v[1] * v[1]).sqrt()
}

impl BondForce {
    /// |V| [N].
    pub fn shear_size(&self) -> f64 {
        size(self.shear)
    }

    /// |M| [N m].
    pub fn bend_size(&self) -> f64 {
        size(self.bend)
    }
}

/// Stiffness of a bond per mode.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BondStiffness {
    /// Axial EA/l [N/m].
    pub axial: f64,
    /// Timoshenko shear 12EI/(l³(1+Φ)) [N/m].
    pub shear: f64,
    /// Bending EI/l [N m/rad].
    pub bend: f64,
    /// Torsion GJ/l [N m/rad].
    pub twist: f64,
}

/// A bond law. Stateless: forces and history come in and go out.
pub trait BondLaw: Clone + Send + Sync + 'static {
    /// History beyond the forces; `()` stores nothing.
    type State: Copy + Send + Sync + PartialEq + std::fmt::Debug + 'static;

    /// History of a bond that was never loaded.
    fn initial(&self) -> Self::State;

    /// Advances forces and history over one step; returns the plastic work of the step [J].
    fn response(&self, shape: &BondShape, force: &mut BondForce, state: &mut Self::State, step: &BondIncrement) -> f64;

    /// The axial part alone, for bonds that never bend, shear or twist; same bits as [`BondLaw::response`] there.
    fn axial_response(
        &self,
        shape: &BondShape,
        force: &mut BondForce,
        state: &mut Self::State,
        step: &BondIncrement,
    ) -> f64;

    /// Elastic stiffness now.
    fn stiffness(&self, shape: &BondShape, state: &Self::State) -> BondStiffness;

    /// Stored elastic energy [J].
    fn elastic_energy(&self, shape: &BondShape, force: &BondForce, state: &Self::State) -> f64;

    /// Section now, thinned by plastic stretch.
    fn section(&self, shape: &BondShape, state: &Self::State) -> Section;

    /// Equivalent plastic strain p [-]; 0 for elastic laws.
    fn plastic_strain(&self, state: &Self::State) -> f64;

    /// Factor on the undeformed radius, e^(−ε_p/2) [-].
    fn thinning(&self, state: &Self::State) -> f64;
}

/// A round section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Radius r [m].
    pub radius: f64,
    /// Area A = πr² [m²].
    pub area: f64,
    /// Second moment I = πr⁴/4 [m⁴].
    pub inertia: f64,
}

impl Section {
    /// Round section of radius `radius` [m].
    #[inline(always)]
    pub fn round(radius: f64) -> Self {
        let r2 = radius * radius;
        Self { radius, area: PI * r2, inertia: 0.25 * PI * r2 * r2 }
    }

    /// Polar moment J = 2I [m⁴].
    #[inline(always)]
    pub fn polar(&self) -> f64 {
        2.0 * self.inertia
    }

    /// Beam stiffnesses over a length given by its inverse [1/m] (Timoshenko).
    #[inline(always)]
    pub fn stiffness(&self, moduli: &Moduli, inverse_length: f64) -> BondStiffness {
        let bend = moduli.young * self.inertia * inverse_length;
        // 12EI/(l³(1+Φ)) with Φ = 12EI/(κGAl²), written with one division.
        let rigid = moduli.kappa * moduli.shear * self.area;
        let twelve = 12.0 * bend * inverse_length;
        BondStiffness {
            axial: moduli.young * self.area * inverse_length,
            shear: twelve * rigid * inverse_length / (rigid + twelve),
            bend,
            twist: moduli.shear * self.polar() * inverse_length,
        }
    }
}

/// Half the sum of squares over stiffness: elastic energy of the linear modes [J].
#[inline(always)]
pub(crate) fn transverse_energy(force: &BondForce, k: &BondStiffness) -> f64 {
    let shear = force.shear[0] * force.shear[0] + force.shear[1] * force.shear[1];
    let bend = force.bend[0] * force.bend[0] + force.bend[1] * force.bend[1];
    0.5 * (shear / k.shear + bend / k.bend + force.twist * force.twist / k.twist)
}

/// Adds the elastic increments of shear, bending and torsion to `force`.
#[inline(always)]
pub(crate) fn add_transverse(force: &mut BondForce, k: &BondStiffness, step: &BondIncrement) {
    for axis in 0..2 {
        force.shear[axis] += k.shear * step.shear[axis];
        force.bend[axis] += k.bend * step.bend[axis];
    }
    force.twist += k.twist * step.twist;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shear_stiffness_is_timoshenkos() {
        let moduli = Moduli::new(115e9, 0.34);
        let (section, l) = (Section::round(0.195e-3), 0.39e-3);
        let phi = 12.0 * moduli.young * section.inertia / (moduli.kappa * moduli.shear * section.area * l * l);
        let expected = 12.0 * moduli.young * section.inertia / (l.powi(3) * (1.0 + phi));
        let k = section.stiffness(&moduli, 1.0 / l).shear;
        assert!((k / expected - 1.0).abs() < 1e-12, "{k} {expected}");
    }
}
