//! Tangential contact laws.
//!
//! | name | equation | source |
//! | --- | --- | --- |
//! | `none` | no tangential force | – |
//! | `mindlin` | ΔF = 8 G* a Δδ, capped at μ F_n | Mindlin 1949 |
//! | `mindlin-deresiewicz` | ΔF = 8 G* a θ Δδ + (−1)^k μ (1 − θ) ΔF_n | Mindlin & Deresiewicz 1953 |

mod curve;
pub mod mindlin;
pub mod mindlin_deresiewicz;
pub mod none;
#[cfg(test)]
mod testing;

use glam::DVec3;

/// What a tangential law is told about one contact at one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentialInput {
    /// Unit normal now.
    pub normal: DVec3,
    /// Increment of the relative tangential displacement since the last step, in the tangent plane [m].
    pub slip: DVec3,
    /// Normal force now [N].
    pub normal_force: f64,
    /// Contact radius a now [m].
    pub radius: f64,
}

/// What a tangential law answers.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TangentialResponse {
    /// The pull that resists further displacement, in the tangent plane [N]: it grows along `slip`, so the body whose
    /// displacement is counted positive feels minus this.
    pub pull: DVec3,
    /// Tangent stiffness k_t = 8 G* a [N/m].
    pub stiffness: f64,
    /// Energy dissipated since the last call [J]: mean pull · slip − change of elastic energy.
    pub friction_work: f64,
}

/// A tangential law; constants (G*, μ) live in the law.
pub trait TangentialLaw: Copy + Send + Sync + 'static {
    /// History that one contact carries; `()` stores nothing.
    type State: Copy + Default + Send + Sync + PartialEq + std::fmt::Debug + 'static;

    /// Whether the law ever gives a force (false lets the engine skip the kinematics).
    const ACTIVE: bool;

    /// Response; turns the stored pull into the present tangent plane first. `normal_force` 0 resets the state and
    /// returns the energy that was stored as friction work.
    fn response(&self, state: &mut Self::State, input: &TangentialInput) -> TangentialResponse;

    /// Elastic energy stored in the tangential spring [J].
    fn elastic_energy(&self, state: &Self::State) -> f64;
}

/// Turns a stored tangential vector into the plane normal to `normal`, keeping its length.
#[inline(always)]
pub fn turn(stored: DVec3, normal: DVec3) -> DVec3 {
    let flat = stored - normal * stored.dot(normal);
    let (before, after) = (stored.length_squared(), flat.length_squared());
    if after > 0.0 { flat * (before / after).sqrt() } else { DVec3::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from_array)
    }

    proptest! {
        #[test]
        fn turning_keeps_the_length_and_lands_in_the_plane(stored in vector(), normal in vector()) {
            prop_assume!(normal.length() > 1e-3 && stored.cross(normal.normalize()).length() > 1e-3);
            let turned = turn(stored, normal.normalize());
            prop_assert!((turned.length() - stored.length()).abs() < 1e-12);
            prop_assert!(turned.dot(normal.normalize()).abs() < 1e-12 * (1.0 + stored.length() * 1e3));
        }
    }

    #[test]
    fn a_vector_along_the_normal_has_no_direction_left() {
        assert_eq!(turn(DVec3::Z, DVec3::Z), DVec3::ZERO);
    }
}
