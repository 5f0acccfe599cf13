//! Isotropic hardening: true yield stress σ_y over equivalent plastic strain p.
//!
//! | form | equation | source |
//! | --- | --- | --- |
//! | `voce` | σ₀ + Q(1 − e^(−bp)) + Hp | Voce 1948, linear term added |
//! | `swift` | K(ε₀ + p)^n | Swift 1952 |
//! | `ludwik` | σ₀ + K p^n | Ludwik 1909 |
//! | `table` | straight lines between points, last slope kept | – |

use crate::base::lanes::Real;

/// Hardening law with its parameters.
#[derive(Debug, Clone, PartialEq)]
pub enum Hardening {
    /// σ₀ + Q(1 − e^(−bp)) + Hp.
    Voce {
        /// σ₀ (Pa).
        yield_stress: f64,
        /// Q (Pa).
        saturation: f64,
        /// b (-).
        rate: f64,
        /// H (Pa).
        linear: f64,
    },
    /// K(ε₀ + p)^n.
    Swift {
        /// K (Pa).
        strength: f64,
        /// ε₀ (-).
        prestrain: f64,
        /// n (-).
        exponent: f64,
    },
    /// σ₀ + K p^n.
    Ludwik {
        /// σ₀ (Pa).
        yield_stress: f64,
        /// K (Pa).
        strength: f64,
        /// n (-).
        exponent: f64,
    },
    /// Points of (true plastic strain (-), true stress (Pa)), strain increasing from 0.
    Table(Vec<[f64; 2]>),
}

impl Hardening {
    /// (σ_y (Pa), dσ_y/dp (Pa)) at equivalent plastic strain `p` (-).
    #[inline(always)]
    pub fn evaluate<R: Real>(&self, p: R) -> (R, R) {
        match self {
            Hardening::Voce { yield_stress, saturation, rate, linear } => {
                let decay = (p * -rate).exp();
                let stress = p.splat(1.0) - decay;
                (stress * *saturation + *yield_stress + p * *linear, decay * (saturation * rate) + *linear)
            }
            Hardening::Swift { strength, prestrain, exponent } => {
                let strain = p + *prestrain;
                let stress = strain.powf(*exponent) * *strength;
                (stress, stress * *exponent / strain)
            }
            Hardening::Ludwik { yield_stress, strength, exponent } => {
                // The slope of p^n is infinite at p = 0; the secant over the first 1e-8 stands in for it there.
                let p_slope = p.simd_max(p.splat(1e-8));
                let least = p.simd_max(p.splat(f64::MIN_POSITIVE));
                (
                    least.powf(*exponent) * *strength + *yield_stress,
                    p_slope.powf(exponent - 1.0) * (exponent * strength),
                )
            }
            Hardening::Table(points) => {
                if let [[_, stress]] = points[..] {
                    return (p.splat(stress), p.splat(0.0));
                }
                let [[p0, s0], [p1, s1]] = p.rows_around(points);
                let slope = (s1 - s0) / (p1 - p0);
                (s0 + slope * (p - p0), slope)
            }
        }
    }

    /// σ_y (Pa) at `p` (-).
    pub fn stress(&self, p: f64) -> f64 {
        self.evaluate(p).0
    }

    /// The least plastic strain below `limit` (-) at which uniform straining stops being stable, dσ_y/dp ≤ σ_y
    /// (Considère 1885), or `None`.
    pub fn considere(&self, limit: f64) -> Option<f64> {
        const STEPS: usize = 2000;
        (0..=STEPS).map(|k| limit * k as f64 / STEPS as f64).find(|p| {
            let (stress, slope) = self.evaluate(*p);
            slope <= stress
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_derivatives() {
        let laws = [
            Hardening::Voce { yield_stress: 90e6, saturation: 190e6, rate: 12.0, linear: 450e6 },
            Hardening::Swift { strength: 500e6, prestrain: 0.01, exponent: 0.3 },
            Hardening::Ludwik { yield_stress: 90e6, strength: 400e6, exponent: 0.5 },
            Hardening::Table(vec![[0.0, 90e6], [0.1, 250e6], [0.3, 400e6]]),
        ];
        for law in laws {
            for p in [0.02, 0.15, 0.4] {
                let h = 1e-6;
                let numeric = (law.stress(p + h) - law.stress(p - h)) / (2.0 * h);
                let slope = law.evaluate(p).1;
                assert!((slope / numeric - 1.0).abs() < 1e-5, "{law:?} {p}");
            }
        }
    }

    #[test]
    fn considere_finds_where_the_slope_meets_the_stress() {
        // Swift: n/(ε₀+p) = 1 at p = n − ε₀.
        let law = Hardening::Swift { strength: 500e6, prestrain: 0.01, exponent: 0.2 };
        assert!((law.considere(0.5).unwrap() - 0.19).abs() < 1e-3);
        assert_eq!(law.considere(0.15), None);
    }

    #[test]
    fn the_table_is_met_at_its_points_and_keeps_its_last_slope() {
        let law = Hardening::Table(vec![[0.0, 90e6], [0.1, 150e6], [0.3, 210e6]]);
        for (p, stress) in [(0.0, 90e6), (0.05, 120e6), (0.1, 150e6), (0.2, 180e6), (0.3, 210e6), (0.4, 240e6)] {
            assert!((law.stress(p) - stress).abs() < 1.0, "{p}");
        }
    }

    #[test]
    fn the_formulas_begin_at_the_yield_stress() {
        let voce = Hardening::Voce { yield_stress: 90e6, saturation: 200e6, rate: 8.0, linear: 300e6 };
        assert_eq!(voce.stress(0.0), 90e6);
        let far = voce.stress(10.0);
        assert!((far - (290e6 + 3000e6)).abs() < 1.0, "{far}");
        let swift = Hardening::Swift { strength: 400e6, prestrain: 0.01, exponent: 0.5 };
        assert!((swift.stress(0.0) - 40e6).abs() < 1e-6);
        let ludwik = Hardening::Ludwik { yield_stress: 90e6, strength: 292e6, exponent: 0.31 };
        assert_eq!(ludwik.stress(1.0), 382e6);
    }
}
