//! The elastica of a compressed column, clamped at its foot and free at its tip, far beyond buckling.
//!
//! With the tip's slope α and k = sin(α/2): P/P_cr = (2K/π)², height/L = 2E/K − 1, deflection/L = 2k/K, where K and E are
//! the complete elliptic integrals (Euler 1744; Timoshenko & Gere, *Theory of Elastic Stability*, section 2.7).

use super::elliptic;
use crate::base::bisect::bisect;
use std::f64::consts::FRAC_PI_2;

/// A buckled clamped–free column, in terms of its length and of Euler's load π²EI/(4L²).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Load over Euler's load (-).
    pub load: f64,
    /// Shortening over length (-).
    pub shortening: f64,
    /// Sideways deflection of the tip over length (-).
    pub deflection: f64,
}

impl Column {
    /// The column with k = sin(α/2), α the slope of its tip (-), 0 ≤ k < 1.
    fn with_modulus(k: f64) -> Self {
        let (first, second) = (elliptic::first(FRAC_PI_2, k), elliptic::second(FRAC_PI_2, k));
        Self { load: (first / FRAC_PI_2).powi(2), shortening: 2.0 - 2.0 * second / first, deflection: 2.0 * k / first }
    }

    /// The column whose tip has come down by `shortening` of its length (-), 0 to 1.
    pub fn shortened(shortening: f64) -> Self {
        let [modulus, _] = bisect(0.0, 1.0 - 1e-12, 0.0, |k| Self::with_modulus(k).shortening < shortening);
        Self::with_modulus(modulus)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(value: f64, expected: f64) {
        assert!((value - expected).abs() < 5e-5 * expected.abs().max(1.0), "{value} against {expected}");
    }

    /// Timoshenko & Gere, table 2-4: α = 20°, 60°, 120°.
    #[test]
    fn the_table_of_timoshenko_and_gere() {
        for (angle, load, height, deflection) in
            [(20.0_f64, 1.015, 0.970, 0.220), (60.0, 1.152, 0.741, 0.593), (120.0, 1.884, 0.123, 0.803)]
        {
            let column = Column::with_modulus((0.5 * angle.to_radians()).sin());
            assert!((column.load - load).abs() < 2e-3, "{column:?}");
            assert!((1.0 - column.shortening - height).abs() < 2e-3, "{column:?}");
            assert!((column.deflection - deflection).abs() < 2e-3, "{column:?}");
        }
    }

    #[test]
    fn shortening_is_found_again() {
        for shortening in [0.001, 0.05, 0.3, 0.8] {
            near(Column::shortened(shortening).shortening, shortening);
        }
    }
}
