//! No-slip tangential spring with Coulomb's cap: ΔF = 8 G* a Δδ, |F| ≤ μ F_n (Mindlin 1949, J. Appl. Mech. 16, 259).
//!
//! One step is done in the order turn, normal change, slip:
//! 1. the stored pull is turned into the present tangent plane;
//! 2. at normal unloading (F_n or a has become smaller) it is scaled by a/a_prev: the annulus that leaves the contact
//!    drops its share (the rescaling of LAMMPS' `mindlin_rescale`; without it, cycles of the normal force would create
//!    energy, Elata & Berryman 1996). It is then held to the present μ F_n;
//! 3. the slip adds 8 G* a Δδ, held to μ F_n by scaling the vector back.
//!
//! Each of the three gives off energy or keeps it. With U = F²/(2 k_t) and A the pull after 1 and 2:
//! step 2 drops U in every case (k_t falls with a and F with it, or k_t rises at constant F), and for step 3, with
//! F = s (A + k_t Δδ), s ≤ 1, mean pull times slip less the change of U is (1/s − 1) F·(F + A)/(2 k_t) ≥ 0, because
//! |A| ≤ μ F_n = |F| where s < 1. The mean pull is the one over the slip, (A + F)/2.

use super::{TangentialInput, TangentialLaw, TangentialResponse, held_to, turn};
use crate::base::lanes::Real;
use crate::base::triple::Triple;

/// Mindlin's spring with Coulomb's cap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mindlin {
    /// Effective shear modulus G* of the pair (Pa).
    pub shear_modulus_star: f64,
    /// Coefficient of friction μ (-).
    pub friction: f64,
}

/// History of one contact, or of several.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MindlinState<R = f64> {
    /// Pull at the last step (N).
    pub pull: Triple<R>,
    /// 1/a at the last step (1/m); 0 where nothing touched.
    pub inverse_radius: R,
}

impl Mindlin {
    /// F²/(2 k_t) (J).
    #[inline(always)]
    fn stored<R: Real>(&self, state: &MindlinState<R>) -> R {
        state.pull.length_squared() * state.inverse_radius * (1.0 / (16.0 * self.shear_modulus_star))
    }
}

impl TangentialLaw for Mindlin {
    type State<R: Real> = MindlinState<R>;

    const HISTORY: usize = 4;

    const ACTIVE: bool = true;

    #[inline(always)]
    fn history<R: Real>(numbers: impl Fn(usize) -> R) -> MindlinState<R> {
        MindlinState { pull: Triple { x: numbers(0), y: numbers(1), z: numbers(2) }, inverse_radius: numbers(3) }
    }

    #[inline(always)]
    fn each_number<R: Real>(s: &MindlinState<R>, mut put: impl FnMut(usize, R)) {
        put(0, s.pull.x);
        put(1, s.pull.y);
        put(2, s.pull.z);
        put(3, s.inverse_radius);
    }

    #[inline(always)]
    fn response<R: Real>(&self, state: &mut MindlinState<R>, input: &TangentialInput<R>) -> TangentialResponse<R> {
        let (zero, one) = (input.radius.splat(0.0), input.radius.splat(1.0));
        let touches = input.normal_force.simd_gt(zero) & input.radius.simd_gt(zero);
        let energy = self.stored(state);
        let stiffness = input.radius * (8.0 * self.shear_modulus_star);
        let cap = input.normal_force * self.friction;
        // A radius that has not changed must not wear the pull away by rounding.
        let ratio = input.radius * state.inverse_radius;
        let kept = R::select(ratio.simd_gt(one - 1e-14), one, ratio);
        let before = held_to(turn(state.pull, input.normal) * kept, cap);
        let pull = held_to(before + input.slip * stiffness, cap);
        state.pull = Triple::select(touches, pull, Triple::zero(zero));
        state.inverse_radius = R::select(touches, input.inverse_radius, zero);
        let work = (before + pull).dot(input.slip) * 0.5 - (self.stored(state) - energy);
        TangentialResponse {
            pull: state.pull,
            stiffness: R::select(touches, stiffness, zero),
            friction_work: R::select(touches, work, energy),
        }
    }

    #[inline(always)]
    fn elastic_energy(&self, state: &MindlinState) -> f64 {
        self.stored(state)
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{ball_on_ball, check_walk, walk};
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    const LAW: Mindlin = Mindlin { shear_modulus_star: 13e9, friction: 0.2 };

    fn input(slip: f64, normal_force: f64) -> TangentialInput {
        TangentialInput { slip: (DVec3::X * slip).into(), ..ball_on_ball(normal_force) }
    }

    #[test]
    fn under_constant_force_it_is_a_spring_with_a_cap() {
        let stiffness = 8.0 * LAW.shear_modulus_star * ball_on_ball(1.5).radius;
        let step = 0.2 * 1.5 / stiffness / 100.0;
        let mut state = MindlinState::default();
        let mut dissipated = 0.0;
        for i in 1..=300 {
            let response = LAW.response(&mut state, &input(step, 1.5));
            let expected = (stiffness * step * i as f64).min(0.2 * 1.5);
            assert!((response.pull.x - expected).abs() < 1e-12, "step {i}: {}", response.pull.x);
            dissipated += response.friction_work;
        }
        // 100 steps stick, 200 steps slide.
        assert!((dissipated / (0.2 * 1.5 * 200.0 * step) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn normal_unloading_drops_the_pull_with_the_radius() {
        let mut state = MindlinState::default();
        let full = LAW.response(&mut state, &input(1e-9, 1.0)).pull;
        let before = LAW.elastic_energy(&state);
        let response = LAW.response(&mut state, &input(0.0, 0.512));
        let ratio = 0.512f64.cbrt();
        assert!((response.pull - full * ratio).length_squared().sqrt() < 1e-14);
        assert!((response.friction_work - (before - LAW.elastic_energy(&state))).abs() < 1e-24);
        let again = LAW.response(&mut state, &input(0.0, 1.0)).pull;
        assert_eq!(again, response.pull, "normal loading leaves the pull alone");
    }

    #[test]
    fn parting_gives_the_stored_energy_to_friction() {
        let mut state = MindlinState::default();
        LAW.response(&mut state, &input(1e-9, 1.0));
        let stored = LAW.elastic_energy(&state);
        assert!(stored > 0.0);
        // Nothing presses, or on nothing.
        for (force, radius) in [(0.0, 0.0), (0.0, 1e-5), (1.0, 0.0)] {
            let mut state = state;
            let response = LAW.response(&mut state, &TangentialInput::at_rest(force, radius));
            assert_eq!(response, TangentialResponse { friction_work: stored, ..Default::default() });
            assert_eq!(state, MindlinState::default());
        }
    }

    proptest! {
        #[test]
        fn no_walk_creates_energy_or_passes_the_cap(steps in walk()) {
            check_walk(&LAW, LAW.friction, LAW.shear_modulus_star, &steps)?;
        }
    }
}
