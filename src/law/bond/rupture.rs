//! Rupture criteria and the scatter of rupture values.
//!
//! | name | breaks when | source |
//! | --- | --- | --- |
//! | `plastic-strain` | p ≥ p_f | ductile failure at a limit of equivalent plastic strain |
//! | `beam-stress` | N/A + β\|M\|r/I ≥ σ_c or \|V\|/A + β\|T\|r/J ≥ τ_c | Potyondy & Cundall 2004 |
//! | `fibre-strain` | axial + bending strain of the outermost fibre ≥ ε_f | beam theory |

use super::{BondForce, Section};
use crate::base::lanes::Real;
use std::f64::consts::LN_2;

/// Beam-stress criterion of Potyondy & Cundall 2004; compression never breaks a bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamStress {
    /// σ_c (Pa).
    pub tensile: f64,
    /// τ_c (Pa).
    pub shear: f64,
    /// β, share of moments and torque that counts (-).
    pub moment_share: f64,
}

impl BeamStress {
    /// (tensile stress over σ_c, shear stress over τ_c) at the outermost fibre (-); breaks at 1.
    pub fn utilisation<R: Real>(&self, force: &BondForce<R>, section: &Section<R>) -> [R; 2] {
        let zero = force.axial.splat(0.0);
        let tension = (force.axial / section.area
            + force.bend_size() * self.moment_share * section.radius / section.inertia)
            / zero.splat(self.tensile);
        let shear = (force.shear_size() / section.area
            + force.twist.abs() * self.moment_share * section.radius / section.polar())
            / zero.splat(self.shear);
        [R::select(force.axial.simd_gt(zero), tension, zero), shear]
    }
}

/// Strain of the outermost fibre: axial strain plus r times the whole curvature (-).
///
/// `axial` is engineering strain l/l₀ − 1, `curvature` counts from a straight wire (1/m), `radius` in m.
pub fn fibre_strain(axial: f64, curvature: f64, radius: f64) -> f64 {
    axial + radius * curvature
}

/// Weibull factor on the rupture value of one bond (-) (Weibull 1951, weakest link).
///
/// `uniform` is in (0, 1); `modulus` m may be infinite (factor 1); `bonds_per_100_mm` is how many bonds of this length
/// make 100 mm. Normalised so that the weakest of those has median factor 1: the median 100 mm wire breaks at the
/// stated value whatever the spacing.
pub fn weibull_factor(uniform: f64, modulus: f64, bonds_per_100_mm: f64) -> f64 {
    if modulus.is_infinite() {
        return 1.0;
    }
    // −ln(1 − u) is exponential with mean 1; the least of n of them has median ln 2 / n.
    (-(-uniform).ln_1p() * bonds_per_100_mm / LN_2).powf(1.0 / modulus)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;

    #[test]
    fn median_wire_of_100_mm_breaks_at_the_stated_value() {
        for (modulus, bonds) in [(12.0, 256), (30.0, 64)] {
            let mut weakest: Vec<f64> = (0..2001)
                .map(|wire| {
                    (0..bonds)
                        .map(|b| weibull_factor(uniform(3, wire, b), modulus, bonds as f64))
                        .fold(f64::MAX, f64::min)
                })
                .collect();
            weakest.sort_by(f64::total_cmp);
            let median = weakest[1000];
            assert!((median - 1.0).abs() < 3.0 / (modulus * 2001f64.sqrt()), "{modulus} {median}");
        }
    }

    /// Half of the wires of one bond break by 1, three quarters by 2^(1/m); a bond that is one of n is n^(1/m) as strong.
    #[test]
    fn a_bond_follows_weibulls_distribution() {
        for (uniform, modulus, bonds, factor) in
            [(0.5, 3.0, 1.0, 1.0), (0.75, 10.0, 1.0, 2f64.powf(0.1)), (0.5, 3.0, 8.0, 2.0), (0.75, 4.0, 8.0, 2.0)]
        {
            let found = weibull_factor(uniform, modulus, bonds);
            assert!((found / factor - 1.0).abs() < 1e-14, "{found} instead of {factor}");
        }
        assert_eq!(weibull_factor(0.75, f64::INFINITY, 8.0), 1.0);
    }

    #[test]
    fn compression_never_breaks_a_bond() {
        let criterion = BeamStress { tensile: 1e6, shear: 1e9, moment_share: 1.0 };
        let section = Section::round(0.2e-3);
        let force = BondForce { axial: -1e4, bend: [1.0, 0.0], ..Default::default() };
        assert_eq!(criterion.utilisation(&force, &section)[0], 0.0);
    }

    /// By hand for r = 0.2 mm: A = 1.256637e-7 m², I = 1.256637e-15 m⁴, J = 2.513274e-15 m⁴. N/A and |M|r/I are
    /// 15.91549 MPa each; |V|/A is 39.78874 MPa and |T|r/J 31.83099 MPa.
    #[test]
    fn stresses_are_those_of_the_outermost_fibre() {
        let criterion = BeamStress { tensile: 100e6, shear: 200e6, moment_share: 0.5 };
        let force = BondForce { axial: 2.0, shear: [3.0, -4.0], bend: [-0.6e-4, 0.8e-4], twist: -4e-4 };
        let [tension, shear] = criterion.utilisation(&force, &Section::round(0.2e-3));
        assert!((tension - 0.238_732_4).abs() < 1e-7, "{tension}");
        assert!((shear - 0.278_521_2).abs() < 1e-7, "{shear}");
    }

    #[test]
    fn the_outermost_fibre_of_a_bent_bond_is_strained_by_r_over_the_radius_of_bending() {
        assert!((fibre_strain(0.01, 1.0 / 0.02, 0.2e-3) - 0.02).abs() < 1e-15);
    }
}
