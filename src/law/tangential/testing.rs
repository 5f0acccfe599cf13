//! What the tests of the tangential laws share: a pair of balls and random walks of normal force and slip.

use glam::DVec3;
use proptest::prelude::*;

use super::{TangentialInput, TangentialLaw};
use crate::law::contact::thornton::{Thornton, ThorntonState};
use crate::law::contact::{NormalLaw, NormalResponse};

const EFFECTIVE_MODULUS: f64 = 65e9;
const RADIUS: f64 = 0.1e-3;

/// A Hertzian contact under `normal_force` (N) without slip.
pub fn ball_on_ball(normal_force: f64) -> TangentialInput {
    let radius = (0.75 * normal_force * RADIUS / EFFECTIVE_MODULUS).cbrt();
    TangentialInput::at_rest(normal_force, radius)
}

/// One step of a walk.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Overlap in units of the greatest one (-).
    overlap: f64,
    /// Slip in units of the slip that would slide a fully loaded contact (-).
    slip: [f64; 2],
    /// Turn of the normal (rad).
    tilt: [f64; 2],
}

/// Random walks: jumps and small steps of the overlap, slips that are small, large or absent.
pub fn walk() -> impl Strategy<Value = Vec<Step>> {
    let size = prop_oneof![Just(0.0f64), Just(0.03), Just(0.3), Just(3.0)];
    let step = (size.clone(), size, -0.2..1.0f64, [-1.0..1.0f64, -1.0..1.0], [-0.02..0.02f64, -0.02..0.02]);
    (any::<bool>(), prop::collection::vec(step, 2..80)).prop_map(|(on_a_line, steps)| {
        let mut overlap: f64 = 0.5;
        let walked = steps.into_iter().map(|(jump, size, target, direction, tilt)| {
            overlap += (target - overlap) * jump.min(1.0);
            let [along, across] = direction.map(|x| x * size);
            // On one line reloading and its return to the virgin curve are far more frequent.
            if on_a_line {
                Step { overlap, slip: [along, 0.0], tilt: [0.0; 2] }
            } else {
                Step { overlap, slip: [along, across], tilt }
            }
        });
        walked.collect()
    })
}

/// Runs a law along a walk, once on a Hertzian and once on a dented contact, and checks at every step that the
/// pull lies in the tangent plane and below the cap, and that friction and stored energy are never negative.
pub fn check_walk<L: TangentialLaw>(law: &L, friction: f64, shear: f64, steps: &[Step]) -> Result<(), TestCaseError> {
    for limiting_pressure in [1e12, 250e6] {
        let normal_law = Thornton { effective_modulus: EFFECTIVE_MODULUS, limiting_pressure };
        let greatest = 1e-6;
        let top: NormalResponse = normal_law.response(&mut ThorntonState::default(), RADIUS, greatest);
        let sliding = 1.5 * friction * top.force / (8.0 * shear * top.radius);
        let rounding = 1e-12 * friction * top.force * sliding;
        let (mut dent, mut state, mut normal) = (ThorntonState::default(), L::history(|_| 0.0), DVec3::Z);
        for step in steps {
            normal = (normal + DVec3::new(step.tilt[0], step.tilt[1], 0.0)).normalize();
            let contact = normal_law.response(&mut dent, RADIUS, step.overlap * greatest);
            let (u, v) = normal.any_orthonormal_pair();
            let slip = (u * step.slip[0] + v * step.slip[1]) * sliding;
            let input = TangentialInput {
                normal: normal.into(),
                slip: slip.into(),
                ..TangentialInput::at_rest(contact.force, contact.radius)
            };
            let response = law.response(&mut state, &input);
            let pull = DVec3::from(response.pull);
            let cap = friction * contact.force;
            prop_assert!(pull.length() <= cap * (1.0 + 1e-9), "past the cap");
            prop_assert!(pull.dot(normal).abs() <= 1e-9 * cap, "out of the plane");
            let (work, stored) = (response.friction_work, law.elastic_energy(&state));
            prop_assert!(work >= -rounding, "creates {:e} of {:e}", -work, rounding * 1e12);
            prop_assert!(stored >= 0.0, "stores {stored:e}");
        }
    }
    Ok(())
}
