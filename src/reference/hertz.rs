//! Elastic collision of two spheres under Hertz's law F = (4/3) E* √R* δ^(3/2).
//!
//! Source: Hertz 1882; Johnson, *Contact Mechanics*, 1985, section 11.4.

use crate::base::bisect::bisect;
use crate::reference::elliptic;
use std::f64::consts::PI;

/// The pair's effective values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Effective modulus E* = [Σ(1 − ν²)/E]⁻¹ (Pa).
    pub modulus: f64,
    /// Effective radius R* = [Σ1/R]⁻¹ (m).
    pub radius: f64,
    /// Effective mass m* = [Σ1/m]⁻¹ (kg).
    pub mass: f64,
}

impl Pair {
    /// Two equal spheres of radius `radius` (m), `young` (Pa), `poisson` (-) and `density` (kg/m³).
    pub fn equal_spheres(radius: f64, young: f64, poisson: f64, density: f64) -> Self {
        Self {
            modulus: young / (2.0 * (1.0 - poisson * poisson)),
            radius: radius / 2.0,
            mass: 0.5 * density * 4.0 / 3.0 * PI * radius.powi(3),
        }
    }

    /// Two spheres, each of radius (m), Young's modulus (Pa), Poisson's ratio (-) and density (kg/m³).
    pub fn spheres(both: [[f64; 4]; 2]) -> Self {
        let sum = |of: &dyn Fn([f64; 4]) -> f64| 1.0 / both.into_iter().map(of).sum::<f64>();
        Self {
            modulus: sum(&|[_, young, poisson, _]| (1.0 - poisson * poisson) / young),
            radius: sum(&|[radius, ..]| 1.0 / radius),
            mass: sum(&|[radius, _, _, density]| 1.0 / (density * 4.0 / 3.0 * PI * radius.powi(3))),
        }
    }

    /// Normal force at overlap `overlap` δ ≥ 0 (m), (4/3) E* √R* δ^(3/2) (N).
    pub fn force(&self, overlap: f64) -> f64 {
        4.0 / 3.0 * self.modulus * self.radius.sqrt() * overlap.powf(1.5)
    }

    /// Greatest overlap when meeting at relative speed `speed` v (m/s),
    /// (15 m* v²/(16 E* √R*))^(2/5) (m).
    pub fn greatest_overlap(&self, speed: f64) -> f64 {
        (15.0 * self.mass * speed.powi(2) / (16.0 * self.modulus * self.radius.sqrt())).powf(0.4)
    }

    /// Duration of the contact at relative speed `speed` v (m/s), 2.868 (m*²/(R* E*² v))^(1/5) (s).
    pub fn contact_time(&self, speed: f64) -> f64 {
        contact_time_factor() * (self.mass.powi(2) / (self.radius * self.modulus.powi(2) * speed)).powf(0.2)
    }
}

/// Factor on the force (4/3) E* √R_e δ^(3/2), R_e = √(R′R″), that Hertz's elliptical contact gives for relative radii of
/// curvature of ratio `ratio` R′/R″ ≥ 1 (-): F₂^(−3/2).
///
/// With e² = 1 − (b/a)² from R′/R″ = [(a/b)² E(e) − K(e)]/[K(e) − E(e)],
/// F₁³ = 4/(π e²) (b/a)^(3/2) {[(a/b)² E − K][K − E]}^(1/2) and F₂ = (2/π) (b/a)^(1/2) K/F₁
/// (Johnson 1985, equations 4.25 and 4.26).
pub fn elliptical_factor(ratio: f64) -> f64 {
    if ratio <= 1.0 + 1e-9 {
        return 1.0;
    }
    let parts = |slim: f64| {
        let e2 = 1.0 - slim * slim;
        let (k, e) = (elliptic::first(PI / 2.0, e2.sqrt()), elliptic::second(PI / 2.0, e2.sqrt()));
        (e2, k, e / (slim * slim) - k, k - e)
    };
    let [low, high] = bisect(1e-6, 1.0 - 1e-9, 0.0, |slim| {
        let (_, _, above, below) = parts(slim);
        above / below > ratio
    });
    let slim: f64 = 0.5 * (low + high);
    let (e2, k, above, below) = parts(slim);
    let f1 = (4.0 / (PI * e2) * slim.powf(1.5) * (above * below).sqrt()).cbrt();
    (2.0 / PI * slim.sqrt() * k / f1).powf(-1.5)
}

/// The 2.868 of the contact time: 2 (15/16)^(2/5) ∫₀¹ dx/√(1 − x^(5/2)) (-), where the integral is
/// √π Γ(7/5)/Γ(9/10) (Johnson 1985, section 11.4).
fn contact_time_factor() -> f64 {
    const INTEGRAL: f64 = 1.471_637_592_162_353;
    2.0 * (15.0_f64 / 16.0).powf(0.4) * INTEGRAL
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair() -> Pair {
        Pair::equal_spheres(0.195e-3, 115e9, 0.34, 8940.0)
    }

    /// Johnson's approximation of F₂ (Greenwood 1985, as quoted there): 1 − [(R′/R″)^0.0684 − 1]^1.531.
    #[test]
    fn elliptical_contacts_are_stiffer_than_circular_ones() {
        assert_eq!(elliptical_factor(1.0), 1.0);
        for ratio in [1.5f64, 2.0, 5.0] {
            let approximate = 1.0 - (ratio.powf(0.0684) - 1.0).powf(1.531);
            let exact = elliptical_factor(ratio).powf(-2.0 / 3.0);
            assert!((exact - approximate).abs() < 4e-3, "{ratio}: {exact} {approximate}");
        }
    }

    /// Substituting x = 1 − s² takes the root's singularity out of the integrand, which the midpoint rule then
    /// integrates: an independent check of the constant.
    #[test]
    fn contact_time_factor_is_the_integral() {
        let n = 20_000;
        let integral: f64 = (0..n)
            .map(|i| {
                let s = (i as f64 + 0.5) / n as f64;
                let x = 1.0 - s * s;
                2.0 * s / (1.0 - x.powf(2.5)).sqrt() / n as f64
            })
            .sum();
        let factor = 2.0 * (15.0_f64 / 16.0).powf(0.4) * integral;
        assert!((contact_time_factor() - factor).abs() < 1e-8);
        assert!((contact_time_factor() - 2.868).abs() < 5e-4);
    }

    /// At the greatest overlap the work against the force, ∫F dδ = (8/15) E* √R* δ^(5/2), is the kinetic energy.
    #[test]
    fn greatest_overlap_stores_the_kinetic_energy() {
        let (pair, speed) = (pair(), 0.5);
        let overlap = pair.greatest_overlap(speed);
        let stored = 0.4 * pair.force(overlap) * overlap;
        assert!((stored / (0.5 * pair.mass * speed * speed) - 1.0).abs() < 1e-12);
    }

    /// m* δ'' = −F integrated in fine steps from contact to separation.
    #[test]
    fn contact_time_agrees_with_the_equation_of_motion() {
        let (pair, speed) = (pair(), 0.5);
        let expected = pair.contact_time(speed);
        let dt = expected / 20_000.0;
        let (mut overlap, mut rate, mut time) = (0.0_f64, speed, 0.0);
        while overlap >= 0.0 {
            rate -= 0.5 * dt * pair.force(overlap) / pair.mass;
            overlap += dt * rate;
            if overlap > 0.0 {
                rate -= 0.5 * dt * pair.force(overlap) / pair.mass;
            }
            time += dt;
        }
        assert!((time / expected - 1.0).abs() < 3e-4, "{time} {expected}");
    }
}
