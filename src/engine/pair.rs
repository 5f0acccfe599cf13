//! One touching pair: normal law, friction, damping, thinning. Shared by spheres and capsules.

use super::state::Partial;
use crate::law::contact::NormalLaw;
use crate::law::damping::viscous_coefficient;
use crate::law::tangential::{TangentialInput, TangentialLaw};
use glam::DVec3;

/// The laws of a run.
#[derive(Debug, Clone, Copy)]
pub struct Laws<N, T> {
    /// Normal law.
    pub normal: N,
    /// Tangential law.
    pub tangential: T,
    /// Viscous damping, fraction of critical [-].
    pub damping: f64,
}

/// Where and how two surfaces meet at this step.
#[derive(Debug, Clone, Copy)]
pub struct Meeting {
    /// Unit normal from the first body to the second.
    pub normal: DVec3,
    /// Overlap δ > 0 [m].
    pub overlap: f64,
    /// Sum of the current radii [m].
    pub reach: f64,
    /// Velocity of the second surface relative to the first at the contact point [m/s].
    pub velocity: DVec3,
    /// Reduced mass m* [kg].
    pub mass: f64,
    /// Step [s].
    pub dt: f64,
}

/// What a contact remembers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct History<N, T> {
    /// Reduced radius R* [m], undeformed.
    pub reduced_radius: f64,
    /// Normal law's state.
    pub normal: N,
    /// Tangential law's state.
    pub tangential: T,
    /// Overlap that does not count [m]: two parts of a wire that a bond held until it broke may overlap, or two ends
    /// lie under one particle. It shrinks as they part, and is 0 for everything else.
    pub offset: f64,
    /// Whether the surfaces touched at the last step.
    pub touching: bool,
    /// Overlap [m], sum of radii [m] and elastic normal force [N] at the last step.
    pub overlap: f64,
    reach: f64,
    pub normal_force: f64,
    /// Force of the dashpot at the last step [N].
    viscous: f64,
    /// Tangent stiffnesses at the last step [N/m]: greatest normal, tangential.
    pub stiffness: [f64; 2],
}

impl<N: Default, T: Default> History<N, T> {
    /// A contact that never touched.
    pub fn new(reduced_radius: f64) -> Self {
        Self {
            reduced_radius,
            normal: N::default(),
            tangential: T::default(),
            offset: 0.0,
            touching: false,
            overlap: 0.0,
            reach: 0.0,
            normal_force: 0.0,
            viscous: 0.0,
            stiffness: [0.0; 2],
        }
    }
}

/// Force on the first body [N] and the friction in it (the tangential part, which has a lever arm).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PairForce {
    /// Whole force on the first body; the second feels minus this.
    pub force: DVec3,
    /// Its tangential part.
    pub friction: DVec3,
}

/// Response of a touching pair.
#[inline(always)]
pub fn touch<N: NormalLaw, T: TangentialLaw>(
    laws: &Laws<N, T>,
    history: &mut History<N::State, T::State>,
    meeting: &Meeting,
    partial: &mut Partial,
) -> PairForce {
    let answer = laws.normal.response(&mut history.normal, history.reduced_radius, meeting.overlap);
    partial.plastic += answer.plastic_work;
    let reach_before = if history.touching { history.reach } else { meeting.reach };
    partial.thinning += 0.5 * (history.normal_force + answer.force) * (reach_before - meeting.reach);
    history.touching = true;
    history.overlap = meeting.overlap;
    history.reach = meeting.reach;
    history.normal_force = answer.force;
    history.stiffness[0] =
        laws.normal.greatest_stiffness(&history.normal, history.reduced_radius, meeting.overlap).max(answer.stiffness);

    let approach = meeting.velocity.dot(meeting.normal);
    let across = meeting.velocity - meeting.normal * approach;
    let mut push = answer.force;
    let mut friction = DVec3::ZERO;
    if T::ACTIVE {
        let input = TangentialInput {
            normal: meeting.normal,
            slip: across * meeting.dt,
            normal_force: answer.force,
            radius: answer.radius,
        };
        let pull = laws.tangential.response(&mut history.tangential, &input);
        partial.friction += pull.friction_work;
        history.stiffness[1] = pull.stiffness;
        friction = pull.pull;
    }
    if laws.damping > 0.0 && answer.force > 0.0 {
        // Damping never turns the push into a pull.
        let c = viscous_coefficient(laws.damping, meeting.mass, answer.stiffness);
        let viscous = (-c * approach).max(-answer.force);
        push += viscous;
        partial.damping -= 0.5 * (history.viscous + viscous) * approach * meeting.dt;
        history.viscous = viscous;
    }
    PairForce { force: friction - meeting.normal * push, friction }
}

/// Greatest normal and tangential stiffness [N/m] that a touching pair can reach within `horizon` [s] if it goes on
/// approaching at `approach` [m/s] from `overlap` [m]; `None` when it has parted.
pub fn foreseen_stiffness<N: NormalLaw, T: TangentialLaw>(
    laws: &Laws<N, T>,
    history: &History<N::State, T::State>,
    overlap: f64,
    approach: f64,
    horizon: f64,
) -> Option<[f64; 2]> {
    let deepest = overlap + approach.max(0.0) * horizon;
    if deepest <= 0.0 {
        return None;
    }
    let (mut normal, mut tangential) = (history.normal, history.tangential);
    let answer = laws.normal.response(&mut normal, history.reduced_radius, deepest);
    let stiffness = laws.normal.greatest_stiffness(&normal, history.reduced_radius, deepest).max(answer.stiffness);
    let mut across = 0.0;
    if T::ACTIVE && answer.force > 0.0 {
        let input =
            TangentialInput { normal: DVec3::Z, slip: DVec3::ZERO, normal_force: answer.force, radius: answer.radius };
        across = laws.tangential.response(&mut tangential, &input).stiffness;
    }
    Some([stiffness.max(history.stiffness[0]), across.max(history.stiffness[1])])
}

/// The surfaces are apart: what friction had stored is lost. `overlap` is the geometrical one, negative over a gap [m].
#[inline(always)]
pub fn part<N: NormalLaw, T: TangentialLaw>(
    laws: &Laws<N, T>,
    history: &mut History<N::State, T::State>,
    overlap: f64,
    partial: &mut Partial,
) {
    if history.offset > 0.0 {
        history.offset = history.offset.min(overlap.max(0.0));
    }
    if !history.touching {
        return;
    }
    if T::ACTIVE {
        let input = TangentialInput { normal: DVec3::Z, slip: DVec3::ZERO, normal_force: 0.0, radius: 0.0 };
        partial.friction += laws.tangential.response(&mut history.tangential, &input).friction_work;
    }
    history.touching = false;
    history.normal_force = 0.0;
    history.viscous = 0.0;
    history.overlap = 0.0;
    history.stiffness = [0.0; 2];
}

/// Recoverable energy of the normal force [J].
pub fn normal_energy<N: NormalLaw, T: TangentialLaw>(laws: &Laws<N, T>, history: &History<N::State, T::State>) -> f64 {
    if history.touching {
        laws.normal.elastic_energy(&history.normal, history.reduced_radius, history.overlap)
    } else {
        0.0
    }
}

/// Recoverable energy of a contact [J].
pub fn elastic_energy<N: NormalLaw, T: TangentialLaw>(laws: &Laws<N, T>, history: &History<N::State, T::State>) -> f64 {
    normal_energy(laws, history)
        + if history.touching { laws.tangential.elastic_energy(&history.tangential) } else { 0.0 }
}
