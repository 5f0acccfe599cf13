//! Trajectory of a helical wire around the z axis (physics page, section 2).

use crate::reference::helix as closed_form;
use glam::DVec3;
use std::f64::consts::TAU;

/// A helical centre line; straight when the pitch is infinite, on the axis when the radius is 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Helix {
    /// Lay radius R (m).
    pub radius: f64,
    /// Pitch h (m); infinite when straight.
    pub pitch: f64,
    /// Lay direction s: +1 right (Z), −1 left (S).
    pub lay: f64,
    /// Angle of the wire at z = 0, 2π i/n + φ (rad).
    pub phase: f64,
}

impl Helix {
    /// Angle per length along the axis, s 2π/h (rad/m); 0 when straight.
    pub fn rate(&self) -> f64 {
        self.lay * TAU / self.pitch
    }

    /// Centre at height `z` (m): (R cos θ, R sin θ, z) with θ = s 2π z/h + phase (m).
    pub fn point(&self, z: f64) -> DVec3 {
        let (sin, cos) = (self.rate() * z + self.phase).sin_cos();
        DVec3::new(self.radius * cos, self.radius * sin, z)
    }

    /// Unit tangent at height `z` (m), pointing up.
    pub fn tangent(&self, z: f64) -> DVec3 {
        let (sin, cos) = (self.rate() * z + self.phase).sin_cos();
        let around = self.radius * self.rate();
        DVec3::new(-around * sin, around * cos, 1.0).normalize()
    }

    /// Length of the wire over `length` of the axis (m), L/cos β.
    pub fn arc_length(&self, length: f64) -> f64 {
        closed_form::arc_length(self.radius, self.pitch, length)
    }

    /// Curvature sin²β/R (1/m).
    pub fn curvature(&self) -> f64 {
        closed_form::curvature(self.radius, self.pitch)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outer_wire(lay: f64) -> Helix {
        Helix { radius: 1.165e-3, pitch: 39e-3, lay, phase: 0.7 }
    }

    #[test]
    fn tangent_is_the_derivative_and_leans_by_the_lay_angle() {
        for lay in [1.0, -1.0] {
            let helix = outer_wire(lay);
            let (z, dz) = (0.013, 1e-7);
            let numeric = (helix.point(z + dz) - helix.point(z - dz)).normalize();
            assert!(numeric.distance(helix.tangent(z)) < 1e-8);
            assert!((helix.tangent(z).z - closed_form::lay_angle(helix.radius, helix.pitch).cos()).abs() < 1e-12);
        }
    }

    /// A right-hand (Z) lay turns counter-clockwise seen from above while it rises.
    #[test]
    fn right_lay_is_a_right_hand_screw() {
        let helix = outer_wire(1.0);
        let around = helix.point(0.0).cross(helix.tangent(0.0)).z;
        assert!(around > 0.0);
    }

    #[test]
    fn chords_add_up_to_the_arc_length() {
        let (helix, length, n) = (outer_wire(1.0), 0.12, 100_000);
        let at = |i: usize| helix.point(length * i as f64 / n as f64);
        let chords: f64 = (0..n).map(|i| at(i).distance(at(i + 1))).sum();
        assert!((chords / helix.arc_length(length) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn infinite_pitch_is_a_straight_wire() {
        let helix = Helix { pitch: f64::INFINITY, ..outer_wire(1.0) };
        assert_eq!(helix.tangent(0.02), DVec3::Z);
        assert_eq!(helix.arc_length(0.12), 0.12);
    }
}
