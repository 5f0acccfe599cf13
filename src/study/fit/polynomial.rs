//! Constants, lines and parabolas: linear least squares.

use super::scaled::Scaled;
use nalgebra::DMatrix;

/// The `count` coefficients of 1, x, x², … nearest to the points; there are at least as many different x.
pub(super) fn parameters(scaled: &Scaled, count: usize) -> Vec<f64> {
    let powers = DMatrix::from_fn(scaled.u.len(), count, |row, power| scaled.u[row].powi(power as i32));
    let solved = powers.svd(true, true).solve(&scaled.v(), 0.0).expect("both factors were asked for");
    let at = |power: usize| solved.get(power).copied().unwrap_or(0.0);
    // v = p₀ + p₁ u + p₂ u² with u = (x − m)/h, multiplied out.
    let ([middle, half], [mean, height]) = (scaled.x, scaled.y);
    let [p0, p1, p2] = [at(0), at(1) / half, at(2) / (half * half)];
    let all =
        [mean + height * (p0 - p1 * middle + p2 * middle * middle), height * (p1 - 2.0 * p2 * middle), height * p2];
    all[..count].to_vec()
}
