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

use glam::DVec3;

use super::{TangentialInput, TangentialLaw, TangentialResponse, turn};

/// Mindlin's spring with Coulomb's cap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mindlin {
    /// Effective shear modulus G* of the pair [Pa].
    pub shear_modulus_star: f64,
    /// Coefficient of friction μ [-].
    pub friction: f64,
}

/// History of one contact.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MindlinState {
    /// Pull at the last step [N].
    pub pull: DVec3,
    /// Contact radius at the last step [m].
    pub radius: f64,
    /// Normal force at the last step [N].
    pub normal_force: f64,
}

/// `vector` scaled back to the length `cap` where it is longer.
#[inline(always)]
pub(super) fn held_to(vector: DVec3, cap: f64) -> DVec3 {
    let length_squared = vector.length_squared();
    if length_squared > cap * cap { vector * (cap / length_squared.sqrt()) } else { vector }
}

impl TangentialLaw for Mindlin {
    type State = MindlinState;

    const ACTIVE: bool = true;

    #[inline(always)]
    fn response(&self, state: &mut MindlinState, input: &TangentialInput) -> TangentialResponse {
        let energy = self.elastic_energy(state);
        if input.normal_force <= 0.0 || input.radius <= 0.0 {
            *state = MindlinState::default();
            return TangentialResponse { friction_work: energy, ..Default::default() };
        }
        let stiffness = 8.0 * self.shear_modulus_star * input.radius;
        let cap = self.friction * input.normal_force;
        let mut before = turn(state.pull, input.normal);
        if input.radius < state.radius || input.normal_force < state.normal_force {
            before *= (input.radius / state.radius).min(1.0);
        }
        before = held_to(before, cap);
        let pull = held_to(before + input.slip * stiffness, cap);
        *state = MindlinState { pull, radius: input.radius, normal_force: input.normal_force };
        let work = 0.5 * (before + pull).dot(input.slip);
        TangentialResponse { pull, stiffness, friction_work: work - (self.elastic_energy(state) - energy) }
    }

    #[inline(always)]
    fn elastic_energy(&self, state: &MindlinState) -> f64 {
        if state.radius > 0.0 {
            state.pull.length_squared() / (16.0 * self.shear_modulus_star * state.radius)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{ball_on_ball, check_walk, walk};
    use super::*;
    use proptest::prelude::*;

    const LAW: Mindlin = Mindlin { shear_modulus_star: 13e9, friction: 0.2 };

    fn input(slip: f64, normal_force: f64) -> TangentialInput {
        TangentialInput { slip: DVec3::X * slip, ..ball_on_ball(normal_force) }
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
        assert!((response.pull - full * ratio).length() < 1e-14);
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
        let response = LAW.response(&mut state, &input(1e-9, 0.0));
        assert_eq!(response, TangentialResponse { friction_work: stored, ..Default::default() });
        assert_eq!(state, MindlinState::default());
    }

    proptest! {
        #[test]
        fn no_walk_creates_energy_or_passes_the_cap(steps in walk()) {
            check_walk(&LAW, LAW.friction, LAW.shear_modulus_star, &steps)?;
        }
    }
}
