//! Viscous damping as a fraction of the critical one, and the coefficient of restitution that it gives.

use crate::base::bisect::bisect;

/// Coefficient c = 2 ξ √(m k) (N s/m) of a dashpot beside a spring (linear oscillator; ξ = 1 is critical).
///
/// `fraction` ξ (-); `mass` (kg), for a contact the reduced mass m*; `stiffness` (N/m), for a contact the present
/// dF/dδ (Tsuji, Tanaka & Ishida 1992). With a moment of inertia (kg m²) and a stiffness in (N m/rad) it answers a
/// rotational coefficient (N m s/rad).
#[inline(always)]
pub fn viscous_coefficient(fraction: f64, mass: f64, stiffness: f64) -> f64 {
    2.0 * fraction * (mass * stiffness).sqrt()
}

/// Coefficient of restitution e (-), speed of parting over speed of approach, of an oscillator with the damping ratio
/// `ratio` ζ (-) whose bodies part when they no longer push, without a pull.
///
/// e = exp(−2ζ acos ζ/√(1 − ζ²)), with acosh and √(ζ² − 1) beyond critical (Schwager & Pöschel 2007, Granular Matter 9, 465,
/// their β/ω₀ = ζ and angles drawn together). It holds for a Hertzian contact too: see [`hertzian_fraction`].
pub fn restitution(ratio: f64) -> f64 {
    let rest = 1.0 - ratio * ratio;
    let angle = if rest.abs() < 1e-12 {
        1.0
    } else if rest > 0.0 {
        ratio.acos() / rest.sqrt()
    } else {
        ratio.acosh() / (-rest).sqrt()
    };
    (-2.0 * ratio * angle).exp()
}

/// Damping ratio ζ (-) that gives the coefficient of restitution `coefficient` e (-), 0 < e ≤ 1: [`restitution`] solved by
/// bisection.
pub fn ratio_of_restitution(coefficient: f64) -> f64 {
    if coefficient >= 1.0 {
        return 0.0;
    }
    // Beyond critical e ≤ (ζ + √(ζ² − 1))⁻² ≤ (2ζ − 1)⁻², so that the root lies below.
    bisect(0.0, 1.0 + 0.5 / coefficient.sqrt(), 0.0, |ratio| restitution(ratio) > coefficient)[0]
}

/// Fraction ξ (-) of [`viscous_coefficient`] at which a Hertzian contact has the damping ratio `ratio` ζ (-).
///
/// With F = K δ^(3/2) and c = 2ξ√(m* dF/dδ), the variable x = (4/5) δ^(5/4) over the time dτ = δ^(1/4) dt obeys a linear
/// oscillator of ω² = (5/4) K/m* and ζ = √(6/5) ξ. A contact of constant stiffness has ζ = ξ.
pub fn hertzian_fraction(ratio: f64) -> f64 {
    ratio / HERTZIAN
}

/// ζ/ξ of a Hertzian contact (-): √(6/5).
pub const HERTZIAN: f64 = 1.095_445_115_010_332_2;

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
