//! Plastic limits of a round section, the engineering curve of a wire in uniform tension, Considère's strain.
//!
//! Source: Lubliner, *Plasticity Theory*, 1990, chapter 4; Considère, Ann. Ponts et Chaussées 9 (1885) 574.

use crate::base::bisect::bisect;
use std::f64::consts::PI;

/// A round section of one yield stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Radius r (m).
    pub radius: f64,
    /// Yield stress σ_y (Pa).
    pub yield_stress: f64,
}

impl Section {
    /// Axial force at yield, N_p = σ_y π r² (N).
    pub fn plastic_force(&self) -> f64 {
        self.yield_stress * PI * self.radius.powi(2)
    }

    /// Fully plastic bending moment, M_p = (4/3) σ_y r³ (N m).
    pub fn plastic_moment(&self) -> f64 {
        4.0 / 3.0 * self.yield_stress * self.radius.powi(3)
    }

    /// Bending moment at first yield, M_e = (π/4) σ_y r³ (N m).
    pub fn first_yield_moment(&self) -> f64 {
        PI / 4.0 * self.yield_stress * self.radius.powi(3)
    }

    /// Bending moment (N m) at `share` ≥ 0 times the curvature of first yield, elastic–perfectly plastic fibres.
    ///
    /// Fibres beyond s r from the neutral axis, s = 1/share, have yielded: integrating the stress over the section gives
    /// M = 4 σ_y r³ [(asin s − s√(1−s²)(1−2s²))/(8s) + (1−s²)^(3/2)/3], (π/4)σ_y r³ at s = 1 and (4/3)σ_y r³ at s → 0.
    pub fn moment_at(&self, share: f64) -> f64 {
        if share <= 1.0 {
            return share * self.first_yield_moment();
        }
        let s = 1.0 / share;
        let rest = 1.0 - s * s;
        let core = (s.asin() - s * rest.sqrt() * (1.0 - 2.0 * s * s)) / (8.0 * s);
        4.0 * self.yield_stress * self.radius.powi(3) * (core + rest.powf(1.5) / 3.0)
    }

    /// Fully plastic torque, T_p = (2π/3)(σ_y/√3) r³ (N m) (von Mises).
    pub fn plastic_torque(&self) -> f64 {
        2.0 * PI / 3.0 * self.yield_stress / 3.0_f64.sqrt() * self.radius.powi(3)
    }
}

/// What a perfectly plastic section carries when it is under a constant axial force and is bent and twisted on and on,
/// by the yield surface (N/N_p)² + |M|/M_p + (T/T_p)² = 1 with the associated flow rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flow {
    /// Bending moment M (N m).
    pub moment: f64,
    /// Torque T (N m).
    pub torque: f64,
    /// Plastic elongation per bending angle (m/rad); per angle of twist where it is only twisted.
    pub elongation: f64,
}

impl Section {
    /// Plastic flow under `axial` N (N) with `twist` ≥ 0 radians of torsion per radian of bending (-); infinite
    /// where it is only twisted.
    ///
    /// Normality: u′ : θ′ : φ′ = 2N/N_p² : 1/M_p : 2T/T_p². So T = T_p² φ′/(2 M_p θ′) while that leaves room for a
    /// moment, and the moment is what the surface leaves.
    pub fn flow(&self, axial: f64, twist: f64) -> Flow {
        let (n_p, m_p, t_p) = (self.plastic_force(), self.plastic_moment(), self.plastic_torque());
        let left = 1.0 - (axial / n_p).powi(2);
        let along = 2.0 * axial / n_p.powi(2);
        let wanted = 0.5 * twist * t_p / m_p;
        if wanted * wanted >= left {
            let torque = t_p * left.sqrt();
            return Flow { moment: 0.0, torque, elongation: along / (2.0 * torque / t_p.powi(2)) };
        }
        let (moment, torque, elongation) = (m_p * (left - wanted * wanted), t_p * wanted, along * m_p);
        Flow { moment, torque, elongation }
    }

    /// Bending moment (N m) at which every fibre yields in tension or compression under `axial` N ≥ 0 (N): the exact
    /// limit of a round section, N/N_p = (2/π)(θ + sin θ cos θ), M/M_p = cos³θ.
    pub fn exact_moment(&self, axial: f64) -> f64 {
        let share = axial / self.plastic_force();
        let angle = root(0.0, PI / 2.0, |t| 2.0 / PI * (t + t.sin() * t.cos()) - share);
        self.plastic_moment() * angle.cos().powi(3)
    }
}

/// One point of a uniform tension test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TensionPoint {
    /// True plastic strain p (-).
    pub plastic_strain: f64,
    /// True stress σ_y(p) (Pa).
    pub true_stress: f64,
    /// True (logarithmic) strain ε = p + σ/E (-).
    pub true_strain: f64,
    /// Engineering strain e^ε − 1 (-).
    pub engineering_strain: f64,
    /// Engineering stress σ e^(−p), force over initial area (Pa).
    pub engineering_stress: f64,
}

/// The point of uniform tension at true plastic strain `plastic_strain` p (-) with true stress `stress` σ_y(p) (Pa)
/// and Young's modulus `young` E (Pa).
///
/// The area is A₀ e^(−p): plastic flow keeps the volume, elastic contraction is left out, as in the bonds (physics
/// page, section 3). Counting the elastic strain too, σ e^(−ε), is lower by the factor e^(−σ/E), 0.3 % for copper.
pub fn tension_point(plastic_strain: f64, stress: f64, young: f64) -> TensionPoint {
    let true_strain = plastic_strain + stress / young;
    TensionPoint {
        plastic_strain,
        true_stress: stress,
        true_strain,
        engineering_strain: true_strain.exp_m1(),
        engineering_stress: stress * (-plastic_strain).exp(),
    }
}

/// The point of uniform tension at engineering strain `strain` (-), for a hardening law `stress` σ_y(p) (Pa) that does
/// not fall; below yield the wire is elastic (p = 0, σ = E ε).
pub fn tension_at(strain: f64, stress: impl Fn(f64) -> f64, young: f64) -> TensionPoint {
    let true_strain = strain.ln_1p();
    if young * true_strain <= stress(0.0) {
        return tension_point(0.0, young * true_strain, young);
    }
    // p + σ(p)/E grows with p, so the root is bracketed by 0 and ε.
    let p = root(0.0, true_strain, |p| p + stress(p) / young - true_strain);
    tension_point(p, stress(p), young)
}

/// Least plastic strain (-) in `0..=limit` at which dσ/dp has fallen to σ, so that the tension force stops growing and
/// a neck can form; `None` when the wire strains uniformly up to `limit`.
///
/// `stress` is σ_y(p) (Pa), `slope` its derivative (Pa). With the area A₀ e^(−p) the force σ A₀ e^(−p) peaks where
/// dσ/dp = σ (Considère 1885).
pub fn considere_strain(stress: impl Fn(f64) -> f64, slope: impl Fn(f64) -> f64, limit: f64) -> Option<f64> {
    // A law may harden anew, so the first crossing is looked for in pieces before it is refined.
    const PIECES: usize = 4000;
    let excess = |p: f64| slope(p) - stress(p);
    if excess(0.0) <= 0.0 {
        return Some(0.0);
    }
    let at = |i: usize| limit * i as f64 / PIECES as f64;
    (0..PIECES).find(|&i| excess(at(i + 1)) <= 0.0).map(|i| root(at(i), at(i + 1), excess))
}

/// Root of `f` between `a` and `b`, where it changes sign, to the last bits.
fn root(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let rising = f(b) > f(a);
    let [low, high] = bisect(a, b, 0.0, |x| (f(x) > 0.0) != rising);
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The section's limits are integrals of the stress over it; a fine sum over its points must agree.
    #[test]
    fn limits_are_integrals_over_the_section() {
        let section = Section { radius: 0.195e-3, yield_stress: 90e6 };
        let n = 2000;
        let dr = section.radius / n as f64;
        let sum = |weight: fn(f64) -> f64| -> f64 {
            (0..n).map(|i| weight((i as f64 + 0.5) * dr) * dr * section.yield_stress).sum()
        };
        let near = |value: f64, expected: f64| assert!((value / expected - 1.0).abs() < 1e-6);
        near(section.plastic_force(), sum(|r| 2.0 * PI * r));
        // |y| = r |sin θ|, and ∫|sin θ| dθ over the circle is 4.
        near(section.plastic_moment(), sum(|r| 4.0 * r * r));
        let root3 = 3.0_f64.sqrt();
        near(section.plastic_torque() * root3, sum(|r| 2.0 * PI * r * r));
        near(section.plastic_moment() / section.first_yield_moment(), 16.0 / (3.0 * PI));
    }

    /// The exact limit is an integral too: fibres above the neutral axis −r sin θ pull, those below push.
    #[test]
    fn exact_moment_is_an_integral_over_the_section() {
        let section = Section { radius: 0.2e-3, yield_stress: 100e6 };
        let n = 20_000;
        for sine in [0.0f64, 0.3, 0.7, 0.95] {
            let (mut force, mut moment) = (0.0, 0.0);
            for i in 0..n {
                let y = ((i as f64 + 0.5) / n as f64 * 2.0 - 1.0) * section.radius;
                let area = 2.0 * (section.radius.powi(2) - y * y).sqrt() * 2.0 * section.radius / n as f64;
                let stress = if y > -sine * section.radius { section.yield_stress } else { -section.yield_stress };
                force += area * stress;
                moment += area * stress * y;
            }
            assert!((section.exact_moment(force) - moment).abs() < 2e-4 * section.plastic_moment(), "{sine}");
        }
    }

    /// Plastic flow is normal to the surface: no other state on it does more work on the same flow.
    #[test]
    fn flow_does_the_most_work() {
        let section = Section { radius: 0.2e-3, yield_stress: 100e6 };
        for (share, twist) in [(0.3, 0.0), (0.6, 0.4), (0.5, 3.0)] {
            let axial = share * section.plastic_force();
            let flow = section.flow(axial, twist);
            let work = |n: f64, m: f64, t: f64| n * flow.elongation + m + t * twist;
            let here = work(axial, flow.moment, flow.torque);
            for a in 0..20 {
                for b in 0..20 {
                    let (n, t) = (a as f64 / 20.0, b as f64 / 20.0);
                    let m = 1.0 - n * n - t * t;
                    let other =
                        work(n * section.plastic_force(), m * section.plastic_moment(), t * section.plastic_torque());
                    assert!(m < 0.0 || flow.moment <= 0.0 || other <= here * (1.0 + 1e-12), "{n} {m} {t}");
                }
            }
        }
    }

    /// Half elastic, half plastic, summed over the fibres; and the two ends of the formula.
    #[test]
    fn moment_between_first_yield_and_the_plastic_moment() {
        let section = Section { radius: 0.195e-3, yield_stress: 90e6 };
        let (n, share) = (20_000, 1.7);
        let dy = 1.0 / n as f64;
        let fibre = |y: f64| (share * y).min(1.0) * y * (1.0 - y * y).sqrt() * dy;
        let sum: f64 = (0..n).map(|i| fibre((i as f64 + 0.5) * dy)).sum();
        let expected = 4.0 * section.yield_stress * section.radius.powi(3) * sum;
        assert!((section.moment_at(share) / expected - 1.0).abs() < 1e-6);
        assert!((section.moment_at(1.0 + 1e-9) / section.first_yield_moment() - 1.0).abs() < 1e-8);
        assert!((section.moment_at(1e3) / section.plastic_moment() - 1.0).abs() < 1e-5);
    }

    /// For σ = K p^n the neck starts at p = n.
    #[test]
    fn considere_of_a_power_law_is_its_exponent() {
        let (k, n) = (450e6, 0.31);
        let strain = considere_strain(|p: f64| k * p.powf(n), |p: f64| n * k * p.powf(n - 1.0), 1.0);
        assert!((strain.unwrap() - n).abs() < 1e-12);
        let early = considere_strain(|p: f64| k * p.powf(n), |p| n * k * p.powf(n - 1.0), 0.2);
        assert_eq!(early, None);
    }

    /// The engineering stress of the curve peaks at Considère's strain.
    #[test]
    fn engineering_stress_peaks_at_considere() {
        let stress = |p: f64| 80e6 + 200e6 * (1.0 - (-8.0 * p).exp()) + 150e6 * p;
        let slope = |p: f64| 1600e6 * (-8.0 * p).exp() + 150e6;
        let p = considere_strain(stress, slope, 1.0).unwrap();
        let nominal = |p: f64| tension_point(p, stress(p), 115e9).engineering_stress;
        assert!(nominal(p) > nominal(p - 1e-3) && nominal(p) > nominal(p + 1e-3));
    }

    #[test]
    fn tension_at_inverts_tension_point() {
        let stress = |p: f64| 80e6 + 300e6 * p.sqrt();
        let young = 115e9;
        let point = tension_point(0.2, stress(0.2), young);
        let back = tension_at(point.engineering_strain, stress, young);
        assert!((back.plastic_strain - 0.2).abs() < 1e-12);
        assert!((back.engineering_stress / point.engineering_stress - 1.0).abs() < 1e-12);
        let elastic = tension_at(3e-4, stress, young);
        assert_eq!(elastic.plastic_strain, 0.0);
        assert!((elastic.true_stress - young * 3e-4_f64.ln_1p()).abs() < 1.0);
    }
}
