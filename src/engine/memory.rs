//! What a run keeps in memory, stage by stage: from the arrays as they are, so that `strandsnap plan` and the bench follow
//! the code.

use super::bytes::{Bytes, NUMBER, VECTOR, behind, behind_all};
use super::neighbours::Neighbours;
use super::state::State;
use super::step_view::StepView;

/// Memory of a run by stage; the sum of `kept` is nearly all that it holds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct StageBytes {
    /// The body before loading, which measuring and drawing need.
    pub assembly: Bytes,
    /// Motion of particles: kick, drift, gather.
    pub integrate: Bytes,
    /// Spins, torques and inertias; moved together with the rest by `integrate`.
    pub rotations: Bytes,
    /// Bonds and rupture.
    pub bonds: Bytes,
    /// Contacts.
    pub contacts: Bytes,
    /// Neighbour search.
    pub neighbours: Bytes,
    /// Bound on the time step.
    pub time_step: Bytes,
}

impl StageBytes {
    /// Names, in order, and what each keeps.
    pub fn stages(&self) -> [(&'static str, Bytes); 7] {
        [
            ("assembly", self.assembly),
            ("motion", self.integrate),
            ("rotations", self.rotations),
            ("bonds", self.bonds),
            ("contacts", self.contacts),
            ("neighbours", self.neighbours),
            ("time step", self.time_step),
        ]
    }

    /// All that is kept (bytes).
    pub fn kept(&self) -> usize {
        self.stages().iter().map(|(_, bytes)| bytes.kept).sum()
    }

    /// Of a run as it is now; `time_step` is what the bound on the time step keeps (bytes).
    pub fn of(view: &StepView, time_step: usize) -> Self {
        let (state, a) = (view.state, view.assembly);
        let assembly = [&a.position, &a.velocity, &a.spin].map(behind_all).iter().sum::<usize>()
            + [&a.radius, &a.mass, &a.inertia, &a.rest_length].map(behind).iter().sum::<usize>()
            + behind(&a.wire_of);
        let mut bonds = view.bonds.map_or(Bytes::default(), |b| b.bytes());
        bonds.kept += behind(&state.bond.data) + behind(&state.whole);
        let mut contacts = view.contacts.map_or(Bytes::default(), |c| c.bytes(state.len()));
        contacts.kept += behind_all(&state.contact_force) + behind_all(&state.contact_torque);
        contacts.kept += view.rigid.map_or(0, |rigid| rigid.bytes().kept);
        Self {
            assembly: Bytes { kept: assembly, moved: 0 },
            integrate: Bytes { kept: motion(state), moved: state.len() * moved_per_particle(view) },
            rotations: Bytes { kept: rotations(state), moved: 0 },
            bonds,
            contacts,
            neighbours: Bytes { kept: view.neighbours.map_or(0, Neighbours::bytes), moved: 0 },
            time_step: Bytes { kept: time_step, moved: 0 },
        }
    }
}

/// What kick, drift and gather move for each particle (bytes).
fn moved_per_particle(view: &StepView) -> usize {
    let (turn, contacts) = (view.plan.rotations, view.contacts.is_some());
    // Velocity in and out, force, inverse mass; and the same for spins.
    let kick = (3 * VECTOR + NUMBER) * if turn { 2 } else { 1 };
    // Position in and out, velocity; the position at the last search.
    let drift = 3 * VECTOR + if contacts { VECTOR } else { 0 };
    // What the bonds do, what contacts do, and the sums.
    let sums = if turn { 2 } else { 1 };
    let gather = state_actions(view.state) + sums * VECTOR * if contacts { 2 } else { 1 };
    kick + drift + gather
}

/// What bonds leave for each particle (bytes).
fn state_actions(state: &State) -> usize {
    if state.bond.data.is_empty() { 0 } else { state.bond.fields() * NUMBER }
}

/// Everything that moves a particle along (bytes).
fn motion(s: &State) -> usize {
    [&s.x, &s.v, &s.force].map(behind_all).iter().sum::<usize>()
        + [&s.radius, &s.thinned, &s.radius0, &s.mass, &s.inverse_mass].map(behind).iter().sum::<usize>()
        + behind(&s.hold)
        + behind(&s.fixed)
}

/// Everything that turns it (bytes).
fn rotations(s: &State) -> usize {
    behind_all(&s.w) + behind_all(&s.torque) + behind(&s.inertia) + behind(&s.inverse_inertia)
}
