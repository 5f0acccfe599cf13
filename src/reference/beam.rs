//! Straight elastic bars and beams of round section.

use std::f64::consts::PI;

/// First root of cos x cosh x = −1: the clamped–free beam's first mode (-).
///
/// Source: Timoshenko, *Vibration Problems in Engineering*, 3rd ed. 1955, section 53.
pub const CLAMPED_FREE_ROOT: f64 = 1.875_104_068_711_961;

/// A straight round bar of one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundBar {
    /// Length L (m).
    pub length: f64,
    /// Diameter d (m).
    pub diameter: f64,
    /// Young's modulus E (Pa).
    pub young: f64,
    /// Poisson's ratio ν (-).
    pub poisson: f64,
    /// Density ρ (kg/m³).
    pub density: f64,
}

impl RoundBar {
    /// Cross-section A = π d²/4 (m²).
    pub fn area(&self) -> f64 {
        PI * self.diameter.powi(2) / 4.0
    }

    /// Second moment of area I = π d⁴/64 (m⁴).
    pub fn second_moment(&self) -> f64 {
        PI * self.diameter.powi(4) / 64.0
    }

    /// Polar moment J = 2 I (m⁴).
    pub fn polar_moment(&self) -> f64 {
        2.0 * self.second_moment()
    }

    /// Shear modulus G = E/(2(1 + ν)) (Pa).
    pub fn shear_modulus(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// Deflection of the loaded tip of a cantilever, P L³/(3 E I) + P L/(κ G A) (m), for a transverse force `force`
    /// P (N).
    ///
    /// Source: Timoshenko & Gere, *Mechanics of Materials*, beams with shear deformation; κ of [`shear_coefficient`].
    pub fn cantilever_tip(&self, force: f64) -> f64 {
        let bending = force * self.length.powi(3) / (3.0 * self.young * self.second_moment());
        let shear_stiffness = shear_coefficient(self.poisson) * self.shear_modulus() * self.area();
        bending + force * self.length / shear_stiffness
    }

    /// Deflection in the middle between two supports `span` L (m) apart, F L³/(48 E I) + F L/(4 κ G A) (m), for a force
    /// `force` F (N) there.
    ///
    /// Source: Timoshenko & Gere, *Mechanics of Materials*, beams with shear deformation; κ of [`shear_coefficient`].
    pub fn three_point_deflection(&self, span: f64, force: f64) -> f64 {
        // Each half is a cantilever that is held in the middle and carries half of the force at its support.
        Self { length: 0.5 * span, ..*self }.cantilever_tip(0.5 * force)
    }

    /// Rotation of the end of a bar under torque `torque` T (N m), T L/(G J) (rad) (Saint-Venant).
    pub fn twist(&self, torque: f64) -> f64 {
        torque * self.length / (self.shear_modulus() * self.polar_moment())
    }

    /// Speed of axial waves in a thin bar, √(E/ρ) (m/s).
    pub fn axial_wave_speed(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    /// First bending frequency of a cantilever without shear and rotary inertia,
    /// ω₁ = 1.8751² √(E I/(ρ A))/L² (rad/s) (Euler–Bernoulli; see [`CLAMPED_FREE_ROOT`]).
    pub fn first_bending_frequency(&self) -> f64 {
        let rigidity = self.young * self.second_moment() / (self.density * self.area());
        CLAMPED_FREE_ROOT.powi(2) * rigidity.sqrt() / self.length.powi(2)
    }

    /// Buckling load of a clamped–free column, π² E I/(4 L²) (N) (Euler 1744).
    pub fn buckling_load(&self) -> f64 {
        PI.powi(2) * self.young * self.second_moment() / (4.0 * self.length.powi(2))
    }
}

/// Shear coefficient of a solid round section, κ = 6(1 + ν)/(7 + 6ν) (-).
///
/// Source: Cowper, J. Appl. Mech. 33 (1966) 335.
pub fn shear_coefficient(poisson: f64) -> f64 {
    6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steel_rod() -> RoundBar {
        RoundBar { length: 1.0, diameter: 0.02, young: 200e9, poisson: 0.3, density: 7800.0 }
    }

    /// A tall order for typing errors: each value worked by hand from I = 7.853982e-9 m⁴, A = 3.141593e-4 m².
    #[test]
    fn values_worked_by_hand() {
        let rod = steel_rod();
        let near = |value: f64, expected: f64| {
            assert!((value / expected - 1.0).abs() < 1e-5, "{value} against {expected}");
        };
        near(rod.cantilever_tip(10.0), 2.122066e-3 + 4.670087e-7);
        near(rod.three_point_deflection(1.0, 10.0), 1.326291e-4 + 1.167522e-7);
        near(rod.twist(5.0), 4.138029e-3);
        near(rod.axial_wave_speed(), 5063.697);
        near(rod.first_bending_frequency(), 3.516015 * 25.318483);
        near(rod.buckling_load(), 3875.785);
        near(shear_coefficient(0.0), 6.0 / 7.0);
    }

    /// The root of the frequency equation is a root.
    #[test]
    fn clamped_free_root_satisfies_its_equation() {
        let x = CLAMPED_FREE_ROOT;
        assert!((x.cos() * x.cosh() + 1.0).abs() < 1e-13);
    }
}
