//! How close helical wires of one pitch and lay come to each other.
//!
//! Distances are between the helices themselves, minimised exactly. All points of a helix are alike, so the distance
//! between two helices of one pitch is the least distance from one fixed point of the first to the second,
//! D²(u) = R₁² + R₂² − 2 R₁R₂ cos u + ((u − ψ)/k)², with ψ their difference in phase, k = 2π/h, and u the angle between
//! the two points.
//!
//! Its tests stand where it is used, in `strand::lay_radius`, beside the helices themselves.

use super::bisect::bisect;
use std::f64::consts::TAU;

/// Least lay radius (m) at which `wires` equal helical wires of `diameter` (m) and `pitch` (m) do not overlap each other;
/// 0 for a single wire, `None` when they do at every radius (`pitch` ≤ `wires` × `diameter`).
pub fn least_radius_of_layer(wires: usize, diameter: f64, pitch: f64) -> Option<f64> {
    if wires < 2 {
        return Some(0.0);
    }
    // At a great radius wires lie h/n apart, measured along the axis: the most that any radius can give.
    if pitch / wires as f64 <= diameter {
        return None;
    }
    let phase = TAU / wires as f64;
    let rate = TAU / pitch;
    // Parallel wires need d/(2 sin(π/n)); lay only brings them closer, so this bounds the radius from below.
    let mut low = diameter / (2.0 * (0.5 * phase).sin());
    let fits = |radius: f64| distance(radius, radius, phase, rate) >= diameter;
    if fits(low) {
        return Some(low);
    }
    let mut high = 2.0 * low;
    while !fits(high) {
        low = high;
        high *= 2.0;
    }
    // D grows with R for every u, hence so does its minimum: one root.
    let [_, high] = bisect(low, high, 1e-14, |radius| !fits(radius));
    Some(high)
}

/// Least distance (m) between two helices of one pitch and lay around one axis: radii `r1` and `r2` (m), difference in
/// phase `phase` (rad), angle per length `rate` k = 2π/h (rad/m) (0 when straight).
pub fn distance(r1: f64, r2: f64, phase: f64, rate: f64) -> f64 {
    let turns = phase.rem_euclid(TAU);
    let phase = turns.min(TAU - turns);
    let u = if rate == 0.0 { phase } else { closest_angle(r1 * r2 * rate * rate, phase) };
    let across = (r1 - r2).powi(2) + 4.0 * r1 * r2 * (0.5 * u).sin().powi(2);
    let along = if rate == 0.0 { 0.0 } else { (u - phase) / rate };
    across.sqrt().hypot(along)
}

/// The angle u in 0..=ψ at which D² is least, where s sin u + u − ψ = 0 with s = R₁R₂k².
///
/// On 0..=ψ ≤ π this function is concave, not above 0 at 0 and not below 0 at ψ: it has one root, and D² one minimum.
fn closest_angle(s: f64, phase: f64) -> f64 {
    let [low, high] = bisect(0.0, phase, 0.0, |u| s * u.sin() + u - phase < 0.0);
    0.5 * (low + high)
}
