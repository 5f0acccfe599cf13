//! Elastoplastic collision of two spheres, elastic–perfectly plastic contact with limiting pressure p_y.
//!
//! Source: Thornton, J. Appl. Mech. 64 (1997) 383.

use crate::reference::hertz::Pair;
use std::f64::consts::PI;

/// Overlap at which a contact yields, δ_y = (π p_y/(2 E*))² R* [m], for limiting pressure `pressure` p_y [Pa].
pub fn yield_overlap(pair: &Pair, pressure: f64) -> f64 {
    (PI * pressure / (2.0 * pair.modulus)).powi(2) * pair.radius
}

/// Force at which a contact yields, F_y = π³ R*² p_y³/(6 E*²) [N].
pub fn yield_force(pair: &Pair, pressure: f64) -> f64 {
    PI.powi(3) * pair.radius.powi(2) * pressure.powi(3) / (6.0 * pair.modulus.powi(2))
}

/// Greatest approach speed that stays elastic, V_y = (π/(2 E*))² (8 π R*³/(15 m*))^(1/2) p_y^(5/2) [m/s].
pub fn yield_velocity(pair: &Pair, pressure: f64) -> f64 {
    (PI / (2.0 * pair.modulus)).powi(2)
        * (8.0 * PI * pair.radius.powi(3) / (15.0 * pair.mass)).sqrt()
        * pressure.powf(2.5)
}

/// Coefficient of restitution at V/V_y = `ratio` [-]; 1 up to a ratio of 1.
///
/// e = (6√3/5)^(1/2) (1 − x²/6)^(1/2) [x/(x + 2√(6/5 − x²/5))]^(1/4) with x = V_y/V.
pub fn restitution(ratio: f64) -> f64 {
    if ratio <= 1.0 {
        return 1.0;
    }
    let x = 1.0 / ratio;
    let rebound = x / (x + 2.0 * (1.2 - 0.2 * x * x).sqrt());
    (1.2 * 3.0_f64.sqrt()).sqrt() * (1.0 - x * x / 6.0).sqrt() * rebound.powf(0.25)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values printed in the physics page, section 8.
    #[test]
    fn restitution_at_four_speeds() {
        for (ratio, expected) in [(1.5, 0.971239), (3.0, 0.862740), (10.0, 0.658558), (100.0, 0.374299)] {
            assert!((restitution(ratio) - expected).abs() < 5e-7, "at {ratio}");
        }
    }

    /// Thornton's plastic branch starts at e = 1, so the two branches meet at the yield velocity.
    #[test]
    fn restitution_is_continuous_at_yield() {
        assert!((restitution(1.0 + 1e-12) - 1.0).abs() < 1e-9);
        assert_eq!(restitution(0.5), 1.0);
    }

    /// At V_y Hertz's greatest overlap is the yield overlap, and Hertz's force there is the yield force.
    #[test]
    fn yield_point_lies_on_hertz() {
        let pair = Pair::equal_spheres(0.195e-3, 115e9, 0.34, 8940.0);
        let pressure = 2.8 * 100e6;
        let overlap = yield_overlap(&pair, pressure);
        assert!((pair.force(overlap) / yield_force(&pair, pressure) - 1.0).abs() < 1e-12);
        let greatest = pair.greatest_overlap(yield_velocity(&pair, pressure));
        assert!((greatest / overlap - 1.0).abs() < 1e-12);
    }
}
