//! First modes of bars and cantilevers, and how much of them a wire's motion holds.

use crate::engine::Engine;
use crate::reference::beam::CLAMPED_FREE_ROOT;
use std::f64::consts::FRAC_PI_2;

/// Share of the mode `shape(z/L)` in the first wire's `motion` of each particle, weighed with the masses.
pub fn project(engine: &Engine, motion: impl Fn(usize) -> f64, shape: impl Fn(f64) -> f64) -> f64 {
    let a = engine.assembly();
    let last = a.wires[0].len - 1;
    (0..=last).map(|i| a.mass[i] * motion(i) * shape(i as f64 / last as f64)).sum()
}

/// First axial mode of a bar held at its start, at `s` = z/L, and of a chain.
pub fn first_axial_mode(s: f64) -> f64 {
    (FRAC_PI_2 * s).sin()
}

/// First bending mode of a cantilever at `s` = z/L (Timoshenko, Vibration Problems in Engineering, section 53).
pub fn first_bending_mode(s: f64) -> f64 {
    let x = CLAMPED_FREE_ROOT * s;
    x.cosh() - x.cos() - ratio() * (x.sinh() - x.sin())
}

/// Curvature of [`first_bending_mode`] in units of its root squared over the length squared.
pub fn first_bending_curvature(s: f64) -> f64 {
    let x = CLAMPED_FREE_ROOT * s;
    x.cosh() + x.cos() - ratio() * (x.sinh() + x.sin())
}

fn ratio() -> f64 {
    let b = CLAMPED_FREE_ROOT;
    (b.sinh() - b.sin()) / (b.cosh() + b.cos())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A clamped start, a free end, and the curvature as the second derivative.
    #[test]
    fn bending_mode_satisfies_its_ends() {
        let b = CLAMPED_FREE_ROOT;
        assert_eq!(first_bending_mode(0.0), 0.0);
        assert!(first_bending_curvature(1.0).abs() < 1e-12);
        let (s, h) = (0.4, 1e-4);
        let f = first_bending_mode;
        let second = (f(s + h) - 2.0 * f(s) + f(s - h)) / (h * h * b * b);
        assert!((second / first_bending_curvature(s) - 1.0).abs() < 1e-6);
    }
}
