//! Stiffness of an open-coiled helical spring of round wire, for small displacements.
//!
//! Source: Love, *A Treatise on the Mathematical Theory of Elasticity*, 4th ed. 1927, §271; Timoshenko, *Strength of
//! Materials* II, 3rd ed. 1956, section 56 (open-coiled springs, ends held or free to turn). Curvature of the wire
//! within its section is left out: it stiffens the spring by 3/16 (d/D)² (Ancker & Goodier, J. Appl. Mech. 25 (1958)
//! 466), and beam elements do not have it.

use crate::reference::beam::{RoundBar, shear_coefficient};
use glam::DVec3;
use std::f64::consts::TAU;

/// A helical spring; `wire.length` is the length of its wire.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// Wire.
    pub wire: RoundBar,
    /// Radius R of the helix (m).
    pub radius: f64,
    /// Pitch h (m).
    pub pitch: f64,
}

/// Compliances of one section per length: 1/EA, 1/κGA, 1/EI, 1/GJ.
struct Compliance {
    axial: f64,
    shear: f64,
    bend: f64,
    twist: f64,
}

impl Spring {
    /// Number of turns n (-).
    pub fn turns(&self) -> f64 {
        self.wire.length / (TAU * self.radius).hypot(self.pitch)
    }

    /// Stiffness of the close-coiled spring, G d⁴/(8 D³ n) (N/m).
    pub fn close_coiled(&self) -> f64 {
        let diameter = 2.0 * self.radius;
        self.wire.shear_modulus() * self.wire.diameter.powi(4) / (8.0 * diameter.powi(3) * self.turns())
    }

    fn compliance(&self) -> Compliance {
        let w = &self.wire;
        Compliance {
            axial: 1.0 / (w.young * w.area()),
            shear: 1.0 / (shear_coefficient(w.poisson) * w.shear_modulus() * w.area()),
            bend: 1.0 / (w.young * w.second_moment()),
            twist: 1.0 / (w.shear_modulus() * w.polar_moment()),
        }
    }

    /// Sine and cosine of the angle between wire and cross-section, tan = h/(2πR).
    fn rise(&self) -> (f64, f64) {
        let turn = (TAU * self.radius).hypot(self.pitch);
        (self.pitch / turn, TAU * self.radius / turn)
    }

    /// Stiffness of many turns under a force along the axis, ends free to turn about it (N/m): torque F R cos α and
    /// bending moment F R sin α everywhere, with axial force F sin α and shear F cos α.
    pub fn central_free(&self) -> f64 {
        let (c, (s, k)) = (self.compliance(), self.rise());
        let arm2 = self.radius.powi(2);
        let per_length = arm2 * (k * k * c.twist + s * s * c.bend) + s * s * c.axial + k * k * c.shear;
        1.0 / (self.wire.length * per_length)
    }

    /// The same with ends that cannot turn (N/m): the couple M about the axis that keeps them is there too, torque
    /// F R cos α + M sin α and bending moment F R sin α − M cos α.
    pub fn central_held(&self) -> f64 {
        let (c, (s, k)) = (self.compliance(), self.rise());
        let turning = s * s * c.twist + k * k * c.bend;
        let mixed = self.radius * s * k * (c.twist - c.bend);
        1.0 / (1.0 / self.central_free() - self.wire.length * mixed * mixed / turning)
    }

    /// Stiffness with one end clamped and the other moved along the axis without any other displacement or rotation
    /// (N/m); with `free`, it may turn about the axis as a rigid body.
    ///
    /// The 6 × 6 compliance at the axis is Castigliano's, ∫ of the section's compliances along the wire (Simpson). It
    /// counts the lateral forces and couples that clamps add to the central force of [`Spring::central_held`].
    pub fn clamped(&self, free: bool) -> f64 {
        let kept: &[usize] = if free { &[0, 1, 2, 3, 4] } else { &[0, 1, 2, 3, 4, 5] };
        let full = self.end_compliance();
        let mut rows: Vec<Vec<f64>> = kept.iter().map(|i| kept.iter().map(|j| full[*i][*j]).collect()).collect();
        // Unit displacement along z: the force there is the stiffness.
        let mut load: Vec<f64> = kept.iter().map(|i| if *i == 2 { 1.0 } else { 0.0 }).collect();
        solve(&mut rows, &mut load);
        load[2]
    }

    /// Displacements and rotations of the end, reduced to the axis, per unit force and couple there.
    fn end_compliance(&self) -> [[f64; 6]; 6] {
        let steps = 400 * self.turns().ceil() as usize;
        let angle = TAU * self.turns();
        let (c, (s, k)) = (self.compliance(), self.rise());
        let height = self.pitch * self.turns();
        let mut sum = [[0.0; 6]; 6];
        for i in 0..=steps {
            let part = i as f64 / steps as f64;
            let simpson = if i == 0 || i == steps { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
            let weight = simpson / 3.0 * self.wire.length / steps as f64;
            let (sine, cosine) = (angle * part).sin_cos();
            let tangent = DVec3::new(-k * sine, k * cosine, s);
            let arm = DVec3::new(-self.radius * cosine, -self.radius * sine, height * (1.0 - part));
            let sections: Vec<[DVec3; 2]> = (0..6)
                .map(|column| {
                    let unit = DVec3::AXES[column % 3];
                    if column < 3 { [unit, arm.cross(unit)] } else { [DVec3::ZERO, unit] }
                })
                .collect();
            let soft = |v: DVec3, along: f64, across: f64| {
                let part = tangent * v.dot(tangent);
                part * along + (v - part) * across
            };
            for row in 0..6 {
                let [force, moment] = sections[row];
                let strain = [soft(force, c.axial, c.shear), soft(moment, c.twist, c.bend)];
                for column in 0..6 {
                    let [f, m] = sections[column];
                    sum[row][column] += weight * (strain[0].dot(f) + strain[1].dot(m));
                }
            }
        }
        sum
    }
}

/// Solves a symmetric positive definite system in place by elimination.
fn solve(rows: &mut [Vec<f64>], load: &mut [f64]) {
    let n = load.len();
    for pivot in 0..n {
        let (above, below) = rows.split_at_mut(pivot + 1);
        let above = &above[pivot];
        for (k, row) in below.iter_mut().enumerate() {
            let factor = row[pivot] / above[pivot];
            row.iter_mut().zip(above).skip(pivot).for_each(|(value, above)| *value -= factor * above);
            load[pivot + 1 + k] -= factor * load[pivot];
        }
    }
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|column| rows[row][column] * load[column]).sum();
        load[row] = (load[row] - known) / rows[row][row];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spring(turns: f64, pitch: f64) -> Spring {
        let radius = 2e-3;
        let length = turns * (TAU * radius).hypot(pitch);
        let wire = RoundBar { length, diameter: 0.2e-3, young: 115e9, poisson: 0.34, density: 8960.0 };
        Spring { wire, radius, pitch }
    }

    #[test]
    fn a_close_coiled_thin_spring_has_the_textbook_stiffness() {
        let spring = spring(10.0, 0.05e-3);
        assert!((spring.turns() - 10.0).abs() < 1e-12);
        assert!((spring.central_free() / spring.close_coiled() - 1.0).abs() < 2e-3);
        assert!(spring.central_held() >= spring.central_free());
    }

    /// What clamps add falls with the number of turns.
    #[test]
    fn many_turns_are_under_a_central_force() {
        let off = |turns: f64, free: bool| {
            let s = spring(turns, 1e-3);
            s.clamped(free) / if free { s.central_free() } else { s.central_held() } - 1.0
        };
        for free in [false, true] {
            let (few, many) = (off(4.0, free), off(32.0, free));
            assert!(few > many && many > 0.0 && many < 0.02, "{free}: {few} {many}");
        }
    }

    /// A straight rod is a helix of infinite pitch.
    #[test]
    fn a_steep_helix_is_a_bar() {
        let bar = RoundBar { length: 0.1, diameter: 1e-3, young: 115e9, poisson: 0.34, density: 8960.0 };
        let spring = Spring { wire: bar, radius: 1e-9, pitch: 0.1 };
        assert!((spring.clamped(false) * bar.length / (bar.young * bar.area()) - 1.0).abs() < 1e-6);
    }
}
