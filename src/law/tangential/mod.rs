//! Tangential contact laws.
//!
//! | name | equation | source |
//! | --- | --- | --- |
//! | `none` | no tangential force | – |
//! | `mindlin` | ΔF = 8 G* a Δδ, capped at μ F_n | Mindlin 1949 |
//! | `mindlin-deresiewicz` | ΔF = 8 G* a θ Δδ + (−1)^k μ (1 − θ) ΔF_n | Mindlin & Deresiewicz 1953 |

mod curve;
mod memory;
pub mod mindlin;
pub mod mindlin_deresiewicz;
pub mod none;
#[cfg(test)]
mod testing;

use crate::base::lanes::Real;
use crate::base::triple::Triple;

/// What a tangential law is told about one contact, or about several, at one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentialInput<R = f64> {
    /// Unit normal now.
    pub normal: Triple<R>,
    /// Increment of the relative tangential displacement since the last step, in the tangent plane (m).
    pub slip: Triple<R>,
    /// Normal force now (N).
    pub normal_force: R,
    /// Contact radius a now (m).
    pub radius: R,
    /// 1/a (1/m); any number where a is 0.
    pub inverse_radius: R,
}

impl TangentialInput {
    /// Under a normal force (N) on a contact radius (m), without slip.
    pub fn at_rest(normal_force: f64, radius: f64) -> Self {
        let (normal, slip) = (Triple { x: 0.0, y: 0.0, z: 1.0 }, Triple::default());
        Self { normal, slip, normal_force, radius, inverse_radius: 1.0 / radius }
    }
}

/// What a tangential law answers.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TangentialResponse<R = f64> {
    /// The pull that resists further displacement, in the tangent plane (N): it grows along `slip`, so the body whose
    /// displacement is counted positive feels minus this.
    pub pull: Triple<R>,
    /// Tangent stiffness k_t = 8 G* a (N/m).
    pub stiffness: R,
    /// Energy dissipated since the last call (J): mean pull · slip − change of elastic energy.
    pub friction_work: R,
}

/// A tangential law, for one contact or for several at once; constants (G*, μ) live in the law.
pub trait TangentialLaw: Copy + Send + Sync + 'static {
    /// History that one contact carries; `()` stores nothing.
    type State<R: Real>: Copy + Send + Sync;

    /// How many numbers the history is; all are 0 where nothing touches.
    const HISTORY: usize;

    /// Whether the law ever gives a force (false lets the engine skip the kinematics).
    const ACTIVE: bool;

    /// The history from its numbers.
    fn history<R: Real>(numbers: impl Fn(usize) -> R) -> Self::State<R>;

    /// The numbers of a history, each with its index.
    fn each_number<R: Real>(state: &Self::State<R>, put: impl FnMut(usize, R));

    /// Response; turns the stored pull into the present tangent plane first. `normal_force` 0 resets the state and
    /// returns the energy that was stored as friction work.
    fn response<R: Real>(&self, state: &mut Self::State<R>, input: &TangentialInput<R>) -> TangentialResponse<R>;

    /// Elastic energy stored in the tangential spring (J).
    fn elastic_energy(&self, state: &Self::State<f64>) -> f64;
}

/// Turns a stored tangential vector into the plane normal to `normal`, keeping its length.
#[inline(always)]
pub fn turn<R: Real>(stored: Triple<R>, normal: Triple<R>) -> Triple<R> {
    let flat = stored - normal * stored.dot(normal);
    let (before, after) = (stored.length_squared(), flat.length_squared());
    let both = before * after;
    // √(before/after) in one root, where the plane has turned: a plane at rest leaves the vector as it is, to the bit.
    // One so small that the product of squares leaves the number range keeps what is flat of it; one along the normal
    // has no direction left, and flat is zero.
    let turned = before.simd_gt(after * (1.0 + 4.0 * f64::EPSILON)) & both.simd_gt(both.splat(1e-290));
    flat * R::select(turned, before * both.inverse_sqrt(), both.splat(1.0))
}

/// `vector` scaled back to the length `cap` where it is longer.
#[inline(always)]
pub(crate) fn held_to<R: Real>(vector: Triple<R>, cap: R) -> Triple<R> {
    let square = vector.length_squared();
    vector * R::select(square.simd_gt(cap * cap), cap * square.inverse_sqrt(), cap.splat(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from_array)
    }

    proptest! {
        #[test]
        fn turning_keeps_the_length_and_lands_in_the_plane(stored in vector(), normal in vector()) {
            prop_assume!(normal.length() > 1e-3 && stored.cross(normal.normalize()).length() > 1e-3);
            let turned = DVec3::from(turn(stored.into(), normal.normalize().into()));
            prop_assert!((turned.length() - stored.length()).abs() < 1e-12);
            prop_assert!(turned.dot(normal.normalize()).abs() < 1e-12 * (1.0 + stored.length() * 1e3));
        }
    }

    /// What is saved of a contact is its whole history, number by number.
    fn numbers_come_back<L: TangentialLaw>() {
        let state = L::history(|k| 1.5 + k as f64);
        let mut seen = Vec::new();
        L::each_number(&state, |k, number| seen.push((k, number)));
        let expected: Vec<(usize, f64)> = (0..L::HISTORY).map(|k| (k, 1.5 + k as f64)).collect();
        assert_eq!(seen, expected);
    }

    #[test]
    fn a_history_is_its_numbers() {
        numbers_come_back::<none::Frictionless>();
        numbers_come_back::<mindlin::Mindlin>();
        numbers_come_back::<mindlin_deresiewicz::MindlinDeresiewicz>();
    }

    #[test]
    fn a_vector_along_the_normal_has_no_direction_left() {
        assert_eq!(turn(DVec3::Z.into(), DVec3::Z.into()), Triple::default());
    }
}
