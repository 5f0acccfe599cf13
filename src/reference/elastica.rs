//! Large deflection of a slender, inextensible cantilever under a transverse force at its tip that keeps its direction.
//!
//! Source: Bisshopp & Drucker, Q. Appl. Math. 3 (1945) 272.

use crate::base::bisect::bisect;
use crate::reference::elliptic::{first, second};
use std::f64::consts::{FRAC_PI_2, SQRT_2};

/// Where the tip of the cantilever is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tip {
    /// Deflection along the force over the length, δ/L (-).
    pub deflection: f64,
    /// Distance from the clamp across the force over the length, 1 − Δ/L (-).
    pub reach: f64,
    /// Slope φ₀ (rad).
    pub slope: f64,
}

/// Tip under the load P L²/(E I) = `load` > 0 (-).
///
/// With p² = (1 + sin φ₀)/2 and sin θ₁ = 1/(p√2): √load = F(π/2, p) − F(θ₁, p), from which φ₀ follows;
/// δ/L = 1 − 2 [E(π/2, p) − E(θ₁, p)]/√load and 1 − Δ/L = √(2 sin φ₀/load).
pub fn tip(load: f64) -> Tip {
    let root = load.sqrt();
    let parts = |slope: f64| {
        let modulus = (0.5 * (1.0 + slope.sin())).sqrt();
        (modulus, (1.0 / (modulus * SQRT_2)).min(1.0).asin())
    };
    let excess = |slope: f64| {
        let (p, start) = parts(slope);
        first(FRAC_PI_2, p) - first(start, p) - root
    };
    let [low, high] = bisect(0.0, FRAC_PI_2 - 1e-12, 0.0, |slope| excess(slope) < 0.0);
    let slope = 0.5 * (low + high);
    let (p, start) = parts(slope);
    Tip {
        deflection: 1.0 - 2.0 * (second(FRAC_PI_2, p) - second(start, p)) / root,
        reach: (2.0 * slope.sin() / load).sqrt(),
        slope,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mattiasson, Int. J. Numer. Meth. Eng. 17 (1981) 145, table 1.
    #[test]
    fn tabulated_values() {
        let table = [
            (1.0, 0.30172, 0.05643, 0.46135),
            (2.0, 0.49346, 0.16064, 0.78175),
            (5.0, 0.71379, 0.38763, 1.21537),
            (10.0, 0.81061, 0.55500, 1.43029),
        ];
        for (load, deflection, shortening, slope) in table {
            let tip = tip(load);
            assert!((tip.deflection - deflection).abs() < 6e-6, "{load}: {tip:?}");
            assert!((1.0 - tip.reach - shortening).abs() < 6e-6, "{load}: {tip:?}");
            assert!((tip.slope - slope).abs() < 6e-6, "{load}: {tip:?}");
        }
    }

    #[test]
    fn small_loads_bend_it_as_linear_theory_says() {
        let tip = tip(1e-3);
        assert!((tip.deflection / (1e-3 / 3.0) - 1.0).abs() < 1e-6);
        assert!((tip.slope / (1e-3 / 2.0) - 1.0).abs() < 1e-6);
    }
}
