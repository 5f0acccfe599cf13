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
#[cfg(test)]
mod normality;
mod return_mapping;
pub mod rupture;

use crate::base::lanes::Real;
use std::f64::consts::PI;

/// What a bond law knows of the material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moduli {
    /// Young's modulus E (Pa).
    pub young: f64,
    /// Shear modulus G (Pa).
    pub shear: f64,
    /// Timoshenko shear coefficient of a round section κ = 6(1+ν)/(7+6ν) (-) (Cowper 1966).
    pub kappa: f64,
    /// 1/E (1/Pa).
    pub compliance: f64,
    /// EI over GJ of a round section, E/(2G) (-).
    pub bend_over_twist: f64,
}

impl Moduli {
    /// From Young's modulus (Pa) and Poisson's ratio (-).
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

/// Undeformed shape of a bond, or of several.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BondShape<R = f64> {
    /// Stress-free length l₀ (m).
    pub rest_length: R,
    /// Radius of the section r₀ (m).
    pub radius: R,
    /// 1/l₀ (1/m) and 1/r₀ (1/m): divisions are what a bond spends its time on.
    pub inverse_length: R,
    /// See `inverse_length`.
    pub inverse_radius: R,
}

impl BondShape {
    /// A bond of stress-free length (m) and radius (m).
    pub fn new(rest_length: f64, radius: f64) -> Self {
        Self { rest_length, radius, inverse_length: 1.0 / rest_length, inverse_radius: 1.0 / radius }
    }
}

/// Deformation of a bond over one step, in its co-rotating frame (n, e₁, e₂).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BondIncrement<R = f64> {
    /// Total log strain ln(l/l₀) at the end of the step (-).
    pub log_strain: R,
    /// Length l at the end of the step (m).
    pub length: R,
    /// Increment of the relative shear displacement along e₁, e₂ (m).
    pub shear: [R; 2],
    /// Increment of the relative rotation about e₁, e₂ (rad).
    pub bend: [R; 2],
    /// Increment of the relative rotation about n (rad).
    pub twist: R,
}

/// Internal forces of a bond in its co-rotating frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BondForce<R = f64> {
    /// Axial force N, tension positive (N).
    pub axial: R,
    /// Shear force V along e₁, e₂ (N).
    pub shear: [R; 2],
    /// Bending moment M about e₁, e₂ (N m).
    pub bend: [R; 2],
    /// Torque T about n (N m).
    pub twist: R,
}

/// Length of a 2-vector; forces are far from the ends of the number range, so no scaling is needed.
#[inline(always)]
fn size<R: Real>(v: [R; 2]) -> R {
    let square = square(v);
    square * square.inverse_sqrt()
}

/// Square of the length of a 2-vector.
#[inline(always)]
fn square<R: Real>(v: [R; 2]) -> R {
    v[0] * v[0] + v[1] * v[1]
}

#[inline(always)]
fn select_both<R: Real>(mask: R::Mask, yes: [R; 2], no: [R; 2]) -> [R; 2] {
    [R::select(mask, yes[0], no[0]), R::select(mask, yes[1], no[1])]
}

impl<R: Real> BondForce<R> {
    /// |V| (N).
    #[inline(always)]
    pub fn shear_size(&self) -> R {
        size(self.shear)
    }

    /// |M| (N m).
    #[inline(always)]
    pub fn bend_size(&self) -> R {
        size(self.bend)
    }

    /// `yes` where the mask holds, `no` elsewhere.
    #[inline(always)]
    pub fn select(mask: R::Mask, yes: &Self, no: &Self) -> Self {
        Self {
            axial: R::select(mask, yes.axial, no.axial),
            shear: select_both(mask, yes.shear, no.shear),
            bend: select_both(mask, yes.bend, no.bend),
            twist: R::select(mask, yes.twist, no.twist),
        }
    }
}

/// Stiffness of a bond per mode.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BondStiffness<R = f64> {
    /// Axial EA/l (N/m).
    pub axial: R,
    /// Timoshenko shear 12EI/(l³(1+Φ)) (N/m).
    pub shear: R,
    /// Bending EI/l (N m/rad).
    pub bend: R,
    /// Torsion GJ/l (N m/rad).
    pub twist: R,
}

/// A bond law. Stateless: forces and history come in and go out, of one bond or of several at once.
pub trait BondLaw: Clone + Send + Sync + 'static {
    /// History beyond the forces; `()` stores nothing.
    type State<R: Real>: Copy;

    /// How many numbers the history is.
    const HISTORY: usize;

    /// The history from its numbers.
    fn history<R: Real>(numbers: impl Fn(usize) -> R) -> Self::State<R>;

    /// The numbers of a history, each with its index.
    fn each_number<R: Real>(state: &Self::State<R>, put: impl FnMut(usize, R));

    /// History of a bond that was never loaded.
    fn initial(&self) -> Self::State<f64>;

    /// Advances forces and history over one step; returns the plastic work of the step (J). Bonds outside `live` are
    /// not there: what becomes of them does not matter.
    fn response<R: Real>(
        &self,
        shape: &BondShape<R>,
        force: &mut BondForce<R>,
        state: &mut Self::State<R>,
        step: &BondIncrement<R>,
        live: R::Mask,
    ) -> R;

    /// The axial part alone, for bonds that never bend, shear or twist; same bits as [`BondLaw::response`] there.
    fn axial_response<R: Real>(
        &self,
        shape: &BondShape<R>,
        force: &mut BondForce<R>,
        state: &mut Self::State<R>,
        step: &BondIncrement<R>,
        live: R::Mask,
    ) -> R;

    /// Elastic stiffness now.
    fn stiffness<R: Real>(&self, shape: &BondShape<R>, state: &Self::State<R>) -> BondStiffness<R>;

    /// Stored elastic energy (J).
    fn elastic_energy(&self, shape: &BondShape, force: &BondForce, state: &Self::State<f64>) -> f64;

    /// Section now, thinned by plastic stretch.
    fn section<R: Real>(&self, shape: &BondShape<R>, state: &Self::State<R>) -> Section<R>;

    /// Equivalent plastic strain p (-); 0 for elastic laws.
    fn plastic_strain<R: Real>(&self, shape: &BondShape<R>, state: &Self::State<R>) -> R;

    /// Factor on the undeformed radius, e^(−ε_p/2) (-).
    fn thinning<R: Real>(&self, shape: &BondShape<R>, state: &Self::State<R>) -> R;
}

/// A round section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section<R = f64> {
    /// Radius r (m).
    pub radius: R,
    /// Area A = πr² (m²).
    pub area: R,
    /// Second moment I = πr⁴/4 (m⁴).
    pub inertia: R,
}

impl<R: Real> Section<R> {
    /// Round section of radius `radius` (m).
    #[inline(always)]
    pub fn round(radius: R) -> Self {
        let r2 = radius * radius;
        Self { radius, area: r2 * PI, inertia: r2 * r2 * (0.25 * PI) }
    }

    /// Polar moment J = 2I (m⁴).
    #[inline(always)]
    pub fn polar(&self) -> R {
        self.inertia * 2.0
    }

    /// Beam stiffnesses over a length given by its inverse (1/m) (Timoshenko).
    #[inline(always)]
    pub fn stiffness(&self, moduli: &Moduli, inverse_length: R) -> BondStiffness<R> {
        let bend = self.inertia * moduli.young * inverse_length;
        // 12EI/(l³(1+Φ)) with Φ = 12EI/(κGAl²), written with one division.
        let rigid = self.area * (moduli.kappa * moduli.shear);
        let twelve = bend * 12.0 * inverse_length;
        BondStiffness {
            axial: self.area * moduli.young * inverse_length,
            shear: twelve * rigid * inverse_length * (rigid + twelve).inverse(),
            bend,
            twist: self.polar() * moduli.shear * inverse_length,
        }
    }
}

/// Half the sum of squares over stiffness: elastic energy of the linear modes (J).
#[inline(always)]
pub(crate) fn transverse_energy(force: &BondForce, k: &BondStiffness) -> f64 {
    0.5 * (square(force.shear) / k.shear + square(force.bend) / k.bend + force.twist * force.twist / k.twist)
}

/// Adds the elastic increments of shear, bending and torsion to `force`.
#[inline(always)]
pub(crate) fn add_transverse<R: Real>(force: &mut BondForce<R>, k: &BondStiffness<R>, step: &BondIncrement<R>) {
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
    fn stiffnesses_are_those_of_a_round_beam() {
        let (e, poisson, r, l) = (115e9, 0.34, 0.195e-3f64, 0.39e-3f64);
        let g = e / (2.0 * (1.0 + poisson));
        let (area, inertia) = (PI * r * r, PI * r.powi(4) / 4.0);
        // Cowper's coefficient 6(1 + ν)/(7 + 6ν) at ν = 0.34.
        let phi = 12.0 * e * inertia / (8.04 / 9.04 * g * area * l * l);
        let expected = BondStiffness {
            axial: e * area / l,
            shear: 12.0 * e * inertia / (l.powi(3) * (1.0 + phi)),
            bend: e * inertia / l,
            twist: g * 2.0 * inertia / l,
        };
        let k = Section::round(r).stiffness(&Moduli::new(e, poisson), 1.0 / l);
        let ratios =
            [k.axial / expected.axial, k.shear / expected.shear, k.bend / expected.bend, k.twist / expected.twist];
        assert!(ratios.iter().all(|ratio| (ratio - 1.0).abs() < 1e-12), "{ratios:?}");
    }

    /// What is saved of a bond is its whole history, number by number.
    #[test]
    fn a_history_is_its_numbers() {
        let state = elasto_plastic::ElastoPlastic::history(|k| 1.5 + k as f64);
        let mut seen = Vec::new();
        elasto_plastic::ElastoPlastic::each_number(&state, |k, number| seen.push((k, number)));
        let expected: Vec<(usize, f64)> =
            (0..elasto_plastic::ElastoPlastic::HISTORY).map(|k| (k, 1.5 + k as f64)).collect();
        assert_eq!(seen, expected);
    }
}
