//! Elastic contact of two spheres: F = (4/3) E* √R* δ^(3/2) (Hertz 1882; Johnson, Contact Mechanics, eq. 4.23).

use super::{NormalLaw, NormalResponse};
use crate::base::lanes::Real;

/// Hertz's law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hertz {
    /// Effective modulus E* of the pair (Pa).
    pub effective_modulus: f64,
}

/// Response on a Hertzian curve of effective modulus E* (Pa) at overlap δ ≥ 0 (m), from the square of the contact radius
/// a² = R δ (m²): F = (4/3) E* a δ, dF/dδ = 2 E* a. Thornton's unloading curves have this form too.
#[inline(always)]
pub(super) fn hertzian<R: Real>(effective_modulus: f64, radius_squared: R, overlap: R) -> NormalResponse<R> {
    let inverse_radius = radius_squared.inverse_sqrt();
    let radius = radius_squared * inverse_radius;
    NormalResponse {
        force: radius * (4.0 / 3.0 * effective_modulus) * overlap,
        stiffness: radius * (2.0 * effective_modulus),
        radius,
        inverse_radius,
        plastic_work: overlap.splat(0.0),
    }
}

/// Energy under a Hertzian curve: (8/15) E* √R δ^(5/2) = (2/5) F δ (J).
#[inline(always)]
pub(super) fn hertzian_energy(effective_modulus: f64, radius: f64, overlap: f64) -> f64 {
    0.4 * overlap * hertzian(effective_modulus, radius * overlap, overlap).force
}

impl NormalLaw for Hertz {
    type State<R: Real> = ();

    const HISTORY: usize = 0;

    #[inline(always)]
    fn history<R: Real>(_: impl Fn(usize) -> R) {}

    #[inline(always)]
    fn each_number<R: Real>((): &(), _: impl FnMut(usize, R)) {}

    #[inline(always)]
    fn response<R: Real>(&self, (): &mut (), reduced_radius: R, overlap: R) -> NormalResponse<R> {
        let overlap = overlap.simd_max(overlap.splat(0.0));
        hertzian(self.effective_modulus, reduced_radius * overlap, overlap)
    }

    #[inline(always)]
    fn limiting_pressure(&self) -> f64 {
        f64::INFINITY
    }

    fn effective_modulus(&self) -> f64 {
        self.effective_modulus
    }

    #[inline(always)]
    fn elastic_energy(&self, (): &(), reduced_radius: f64, overlap: f64) -> f64 {
        hertzian_energy(self.effective_modulus, reduced_radius, overlap.max(0.0))
    }

    #[inline(always)]
    fn greatest_stiffness(&self, (): &(), reduced_radius: f64, overlap: f64) -> f64 {
        let overlap = overlap.max(0.0);
        hertzian(self.effective_modulus, reduced_radius * overlap, overlap).stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Hertz = Hertz { effective_modulus: 65e9 };
    const RADIUS: f64 = 0.1e-3;

    fn at(overlap: f64) -> NormalResponse {
        LAW.response(&mut (), RADIUS, overlap)
    }

    #[test]
    fn force_is_the_slope_of_the_energy_and_stiffness_that_of_the_force() {
        for overlap in [1e-10, 3e-9, 2e-7, 1e-5] {
            let h = overlap * 1e-4;
            let energy = |d| LAW.elastic_energy(&(), RADIUS, d);
            let slope = (energy(overlap + h) - energy(overlap - h)) / (2.0 * h);
            assert!((slope / at(overlap).force - 1.0).abs() < 1e-7, "at {overlap}");
            let slope = (at(overlap + h).force - at(overlap - h).force) / (2.0 * h);
            assert!((slope / at(overlap).stiffness - 1.0).abs() < 1e-7, "at {overlap}");
        }
    }

    #[test]
    fn the_force_is_hertz_formula() {
        let expected = 4.0 / 3.0 * 65e9 * RADIUS.sqrt() * 1e-6f64.powf(1.5);
        assert!((at(1e-6).force / expected - 1.0).abs() < 1e-14);
        assert!((at(1e-6).radius / 1e-5 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn bodies_apart_feel_nothing() {
        for overlap in [0.0, -1e-6] {
            let answer = at(overlap);
            assert_eq!([answer.force, answer.stiffness, answer.radius, answer.plastic_work], [0.0; 4]);
        }
        assert_eq!(LAW.elastic_energy(&(), RADIUS, -1e-6), 0.0);
    }

    /// Contact time 2.868 (m*²/(R* E*² v))^(1/5) and δ_max = (15 m* v²/(16 E* √R*))^(2/5) (Johnson, 11.4).
    #[test]
    fn two_spheres_rebound_elastically_in_hertz_time() {
        let (mass, speed) = (1e-7f64, 0.2f64);
        let expected = 2.868 * (mass * mass / (RADIUS * 65e9f64.powi(2) * speed)).powf(0.2);
        let deepest = (15.0 * mass * speed * speed / (16.0 * 65e9 * RADIUS.sqrt())).powf(0.4);
        let dt = expected / 20_000.0;
        let (mut x, mut v, mut time, mut most) = (0.0, speed, 0.0, 0.0f64);
        let mut force = 0.0;
        loop {
            v -= 0.5 * dt * force / mass;
            x += dt * v;
            force = at(x).force;
            v -= 0.5 * dt * force / mass;
            time += dt;
            most = most.max(x);
            if x <= 0.0 {
                break;
            }
        }
        assert!((time / expected - 1.0).abs() < 5e-4, "{time} is not {expected}");
        assert!((most / deepest - 1.0).abs() < 1e-6, "{most} is not {deepest}");
        assert!((v / speed + 1.0).abs() < 1e-6, "rebounds at {v}");
    }
}
