//! Tangential force of a contact under constant normal force and growing tangential displacement.
//!
//! Source: Mindlin, J. Appl. Mech. 16 (1949) 259; Mindlin & Deresiewicz, J. Appl. Mech. 20 (1953) 327.

/// A contact held at constant normal force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Held {
    /// Effective shear modulus G* = [Σ(2 − ν)/G]⁻¹ (Pa).
    pub shear_modulus: f64,
    /// Contact radius a (m).
    pub radius: f64,
    /// Normal force F_n (N).
    pub normal_force: f64,
    /// Friction coefficient μ (-).
    pub friction: f64,
}

impl Held {
    /// No-slip stiffness k_t = 8 G* a (N/m).
    pub fn stiffness(&self) -> f64 {
        8.0 * self.shear_modulus * self.radius
    }

    /// Displacement at which the whole contact slides, δ_c = 3 μ F_n/(2 k_t) (m).
    pub fn sliding_displacement(&self) -> f64 {
        1.5 * self.friction * self.normal_force / self.stiffness()
    }

    /// Force of the law `mindlin` at displacement `slip` δ_t ≥ 0 (m), min(k_t δ_t, μ F_n) (N).
    pub fn no_slip_force(&self, slip: f64) -> f64 {
        (self.stiffness() * slip).min(self.friction * self.normal_force)
    }

    /// Force of the law `mindlin-deresiewicz` on first loading to `slip` δ_t ≥ 0 (m),
    /// μ F_n [1 − (1 − δ_t/δ_c)^(3/2)] (N).
    pub fn partial_slip_force(&self, slip: f64) -> f64 {
        let left = (1.0 - slip / self.sliding_displacement()).max(0.0);
        self.friction * self.normal_force * (1.0 - left.powf(1.5))
    }
}

/// Effective shear modulus of two bodies of one material, G* = G/(2 (2 − ν)) (Pa), from `shear` G (Pa) and
/// `poisson` ν (-).
pub fn effective_shear_modulus(shear: f64, poisson: f64) -> f64 {
    shear / (2.0 * (2.0 - poisson))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact() -> Held {
        Held { shear_modulus: effective_shear_modulus(43e9, 0.34), radius: 4e-6, normal_force: 0.1, friction: 0.2 }
    }

    #[test]
    fn both_laws_start_with_the_same_stiffness_and_end_at_the_friction_limit() {
        let held = contact();
        let slip = 1e-9 * held.sliding_displacement();
        assert!((held.no_slip_force(slip) / slip / held.stiffness() - 1.0).abs() < 1e-12);
        assert!((held.partial_slip_force(slip) / slip / held.stiffness() - 1.0).abs() < 1e-6);
        let far = 3.0 * held.sliding_displacement();
        let limit = held.friction * held.normal_force;
        assert_eq!(held.no_slip_force(far), limit);
        assert_eq!(held.partial_slip_force(far), limit);
    }

    /// Half way to sliding, worked by hand: 1 − 0.5^1.5 = 0.646447 of the limit; the no-slip law is at 0.75 of it.
    #[test]
    fn half_way_to_sliding() {
        let held = contact();
        let slip = 0.5 * held.sliding_displacement();
        assert!((held.partial_slip_force(slip) / 0.02 - 0.646_446_6).abs() < 1e-6);
        assert!((held.no_slip_force(slip) / 0.02 - 0.75).abs() < 1e-12);
    }

    /// The paper's form 2(1 − ν)/(2 − ν) dF_n/dδ with dF_n/dδ = 2 E* a is the same stiffness for equal materials.
    #[test]
    fn agrees_with_the_form_built_from_the_normal_stiffness() {
        let (young, poisson) = (115e9, 0.34);
        let shear = young / (2.0 * (1.0 + poisson));
        let radius = 4e-6;
        let normal = 2.0 * (young / (2.0 * (1.0 - poisson * poisson))) * radius;
        let tangential = 2.0 * (1.0 - poisson) / (2.0 - poisson) * normal;
        let direct = 8.0 * effective_shear_modulus(shear, poisson) * radius;
        assert!((tangential / direct - 1.0).abs() < 1e-12);
    }
}
