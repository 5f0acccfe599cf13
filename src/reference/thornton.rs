//! Elastoplastic collision of two spheres, elastic–perfectly plastic contact with limiting pressure p_y.
//!
//! Source: Thornton, J. Appl. Mech. 64 (1997) 383.

use crate::reference::hertz::Pair;
use std::f64::consts::PI;

/// Overlap at which a contact yields, δ_y = (π p_y/(2 E*))² R* (m), for limiting pressure `pressure` p_y (Pa).
pub fn yield_overlap(pair: &Pair, pressure: f64) -> f64 {
    (PI * pressure / (2.0 * pair.modulus)).powi(2) * pair.radius
}

/// Force at which a contact yields, F_y = π³ R*² p_y³/(6 E*²) (N).
pub fn yield_force(pair: &Pair, pressure: f64) -> f64 {
    PI.powi(3) * pair.radius.powi(2) * pressure.powi(3) / (6.0 * pair.modulus.powi(2))
}

/// Greatest approach speed that stays elastic, V_y = (π/(2 E*))² (8 π R*³/(15 m*))^(1/2) p_y^(5/2) (m/s).
pub fn yield_velocity(pair: &Pair, pressure: f64) -> f64 {
    (PI / (2.0 * pair.modulus)).powi(2)
        * (8.0 * PI * pair.radius.powi(3) / (15.0 * pair.mass)).sqrt()
        * pressure.powf(2.5)
}

/// Coefficient of restitution at V/V_y = `ratio` (-); 1 up to a ratio of 1.
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

/// Radius of the dent, R_p = (4E*/3F_m) [(2F_m + F_y)/(2π p_y)]^(3/2) (m), and the overlap that it leaves,
/// δ_p = δ_m − (3F_m/(4E* √R_p))^(2/3) (m), after loading to `force` F_m (N) at `overlap` δ_m (m).
fn dent(pair: &Pair, pressure: f64, overlap: f64, force: f64) -> (f64, f64) {
    let bracket = (2.0 * force + yield_force(pair, pressure)) / (2.0 * PI * pressure);
    let radius = 4.0 * pair.modulus / (3.0 * force) * bracket.powf(1.5);
    (radius, overlap - (3.0 * force / (4.0 * pair.modulus * radius.sqrt())).powf(2.0 / 3.0))
}

/// Force on the plastic line, F_y + π p_y R* (δ − δ_y) (N).
fn plastic_line(pair: &Pair, pressure: f64, overlap: f64) -> f64 {
    yield_force(pair, pressure) + PI * pressure * pair.radius * (overlap - yield_overlap(pair, pressure))
}

/// Force (N) at `overlap` δ (m) of a contact whose greatest overlap so far is `greatest` δ_m ≥ δ (m), however often it
/// was unloaded and loaded again in between: Hertz's curve below yield, the plastic line at δ = δ_m, and below it
/// (4/3) E* √R_p (δ − δ_p)^(3/2).
pub fn force(pair: &Pair, pressure: f64, greatest: f64, overlap: f64) -> f64 {
    if greatest <= yield_overlap(pair, pressure) {
        return pair.force(overlap.max(0.0));
    }
    let (radius, residual) = dent(pair, pressure, greatest, plastic_line(pair, pressure, greatest));
    Pair { radius, ..*pair }.force((overlap - residual).max(0.0))
}

/// Energy that a contact has dissipated when it was loaded to `greatest` δ_m (m), however often (J): the work of loading
/// less what the curve of unloading gives back, (2/5) F_m (δ_m − δ_p).
pub fn dissipated(pair: &Pair, pressure: f64, greatest: f64) -> f64 {
    let (start, start_force) = (yield_overlap(pair, pressure), yield_force(pair, pressure));
    if greatest <= start {
        return 0.0;
    }
    let end = plastic_line(pair, pressure, greatest);
    let (_, residual) = dent(pair, pressure, greatest, end);
    0.4 * start_force * start + 0.5 * (start_force + end) * (greatest - start) - 0.4 * end * (greatest - residual)
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

    /// The loop integral of the force over loading to a depth and back is what is dissipated; a second, deeper loop
    /// adds the difference.
    #[test]
    fn dissipation_is_the_loop_integral() {
        let pair = Pair::equal_spheres(0.195e-3, 115e9, 0.34, 8940.0);
        let (pressure, n) = (2.8 * 100e6, 100_000);
        let unit = yield_overlap(&pair, pressure);
        let (mut work, mut greatest, mut before) = (0.0, 0.0f64, 0.0);
        for depth in [60.0 * unit, 150.0 * unit] {
            let step = depth / n as f64;
            for (i, sign) in (1..=n).map(|i| (i, 1.0)).chain((0..n).rev().map(|i| (i, -1.0))) {
                let overlap = i as f64 * step;
                greatest = greatest.max(overlap);
                let now = force(&pair, pressure, greatest, overlap);
                work += 0.5 * (before + now) * sign * step;
                before = now;
            }
            assert!((work / dissipated(&pair, pressure, depth) - 1.0).abs() < 1e-5, "{depth}");
        }
        assert_eq!(dissipated(&pair, pressure, 0.5 * unit), 0.0);
    }
}
