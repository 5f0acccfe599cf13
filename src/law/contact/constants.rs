//! Elastic and inertial constants of a pair, from the constants of its two bodies.

/// Effective modulus E* = [(1 − ν₁²)/E₁ + (1 − ν₂²)/E₂]⁻¹ (Pa) (Hertz 1882; Johnson, Contact Mechanics, eq. 4.21).
///
/// `e1`, `e2`: Young's moduli (Pa); `nu1`, `nu2`: Poisson's ratios (-).
pub fn effective_modulus(e1: f64, nu1: f64, e2: f64, nu2: f64) -> f64 {
    1.0 / ((1.0 - nu1 * nu1) / e1 + (1.0 - nu2 * nu2) / e2)
}

/// Effective shear modulus G* = [(2 − ν₁)/G₁ + (2 − ν₂)/G₂]⁻¹ (Pa) (Mindlin 1949).
///
/// `g1`, `g2`: shear moduli (Pa); `nu1`, `nu2`: Poisson's ratios (-).
pub fn effective_shear_modulus(g1: f64, nu1: f64, g2: f64, nu2: f64) -> f64 {
    1.0 / ((2.0 - nu1) / g1 + (2.0 - nu2) / g2)
}

/// Reduced radius R* = [1/R₁ + 1/R₂]⁻¹ (m); a flat body has the radius infinity.
pub fn reduced_radius(r1: f64, r2: f64) -> f64 {
    1.0 / (1.0 / r1 + 1.0 / r2)
}

/// Reduced mass m* = [1/m₁ + 1/m₂]⁻¹ (kg); a body that is held has the mass infinity.
pub fn reduced_mass(m1: f64, m2: f64) -> f64 {
    1.0 / (1.0 / m1 + 1.0 / m2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, expected: f64) {
        assert!((value / expected - 1.0).abs() < 1e-14, "{value} is not {expected}");
    }

    #[test]
    fn equal_bodies_halve() {
        let (e, nu) = (115e9, 0.34);
        let g = e / (2.0 * (1.0 + nu));
        close(effective_modulus(e, nu, e, nu), e / (2.0 * (1.0 - nu * nu)));
        close(effective_shear_modulus(g, nu, g, nu), g / (2.0 * (2.0 - nu)));
        close(reduced_radius(0.2, 0.2), 0.1);
        close(reduced_mass(0.2, 0.2), 0.1);
    }

    #[test]
    fn unequal_bodies_by_hand() {
        // (1 − 0.09)/200 + (1 − 0.16)/70 = 0.00455 + 0.012 = 0.01655
        close(effective_modulus(200.0, 0.3, 70.0, 0.4), 1.0 / 0.01655);
        // 1.7/80 + 1.6/25 = 0.02125 + 0.064 = 0.08525
        close(effective_shear_modulus(80.0, 0.3, 25.0, 0.4), 1.0 / 0.08525);
        close(reduced_radius(1.0, 3.0), 0.75);
    }

    #[test]
    fn flat_rigid_and_held_bodies_drop_out() {
        close(reduced_radius(0.3, f64::INFINITY), 0.3);
        close(reduced_mass(f64::INFINITY, 0.3), 0.3);
        close(effective_modulus(100.0, 0.0, f64::INFINITY, 0.3), 100.0);
    }

    #[test]
    fn the_two_forms_of_the_tangential_stiffness_agree_for_equal_materials() {
        let (e, nu, a) = (115e9, 0.34, 1e-5);
        let g = e / (2.0 * (1.0 + nu));
        let normal_slope = 2.0 * effective_modulus(e, nu, e, nu) * a;
        let from_poisson = 2.0 * (1.0 - nu) / (2.0 - nu) * normal_slope;
        close(8.0 * effective_shear_modulus(g, nu, g, nu) * a, from_poisson);
    }
}
