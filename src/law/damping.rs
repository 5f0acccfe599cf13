//! Viscous damping as a fraction of the critical one.

/// Coefficient c = 2 ξ √(m k) (N s/m) of a dashpot beside a spring (linear oscillator; ξ = 1 is critical).
///
/// `fraction` ξ (-); `mass` (kg), for a contact the reduced mass m*; `stiffness` (N/m), for a contact the present
/// dF/dδ (Tsuji, Tanaka & Ishida 1992). With a moment of inertia (kg m²) and a stiffness in (N m/rad) it answers a
/// rotational coefficient (N m s/rad).
#[inline(always)]
pub fn viscous_coefficient(fraction: f64, mass: f64, stiffness: f64) -> f64 {
    2.0 * fraction * (mass * stiffness).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Logarithmic decrement between two maxima of the damped oscillator: 2πξ/√(1 − ξ²).
    #[test]
    fn an_oscillator_decays_by_the_logarithmic_decrement() {
        let (fraction, mass, stiffness) = (0.1, 0.3, 70.0);
        let c = viscous_coefficient(fraction, mass, stiffness);
        let (mut x, mut v, dt) = (1.0f64, 0.0f64, 1e-5);
        let mut maxima = vec![x];
        while maxima.len() < 3 {
            let before = v;
            v += dt * (-stiffness * x - c * v) / mass;
            x += dt * v;
            if before > 0.0 && v <= 0.0 {
                maxima.push(x);
            }
        }
        let decrement = (maxima[1] / maxima[2]).ln();
        let expected = std::f64::consts::TAU * fraction / (1.0 - fraction * fraction).sqrt();
        assert!((decrement / expected - 1.0).abs() < 1e-3, "{decrement} is not {expected}");
    }

    #[test]
    fn nothing_to_damp_means_no_coefficient() {
        assert_eq!(viscous_coefficient(0.0, 1.0, 1.0), 0.0);
        assert_eq!(viscous_coefficient(0.5, 1.0, 0.0), 0.0);
    }
}
