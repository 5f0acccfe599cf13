//! An engine between two steps, for those who look on: the monitor, and whoever measures, draws or records.

use super::bonds::Bonds;
use super::contact::Contacts;
use super::contact::rigid::RigidBodies;
use super::estimates::negligible_energy;
use super::grips::Holds;
use super::measure::Measures;
use super::neighbours::Neighbours;
use super::state::State;
use super::team::Team;
use super::time_step::Bound;
use super::view::{BodyState, BondState, Energy, Sample, Snapshot};
use crate::base::finding::{Body, Instant, Member};
use crate::scene::plan::Plan;
use crate::scene::spec::Spec;
use crate::strand::assembly::Assembly;

/// All that can be seen of a run in progress.
#[derive(Clone, Copy)]
pub struct StepView<'a> {
    /// The scene.
    pub spec: &'a Spec,
    /// Which stages it runs.
    pub plan: &'a Plan,
    /// The body before loading.
    pub assembly: &'a Assembly,
    /// Particles.
    pub state: &'a State,
    /// Bonds, where there are any.
    pub bonds: Option<&'a dyn Bonds>,
    /// Contacts, where they are computed.
    pub contacts: Option<&'a dyn Contacts>,
    /// Their candidates.
    pub neighbours: Option<&'a Neighbours>,
    /// Rigid bodies, where there are any.
    pub rigid: Option<&'a dyn RigidBodies>,
    /// The threads that work at it.
    pub team: &'a Team,
    /// Grips, holds and loads.
    pub holds: &'a Holds,
    /// Running means.
    pub measures: &'a Measures,
    /// What the stages have booked so far; [`Self::energy`] adds what is stored now.
    pub ledger: &'a Energy,
    /// Bonds broken so far.
    pub ruptures: usize,
    /// The bound on the stable step.
    pub bound: &'a Bound,
    /// Step to take next (s).
    pub time_step: f64,
}

impl StepView<'_> {
    /// Strain of the body, smoothed as stress is, so that the two belong together ([`Measures`]) (-).
    pub fn strain(&self) -> f64 {
        self.measures.strain()
    }

    /// Nominal stress, the mean over an eighth of a wave's way along the strand (Pa).
    pub fn stress(&self) -> f64 {
        self.measures.stress()
    }

    /// Greatest speed of a particle now (m/s).
    pub fn fastest(&self) -> f64 {
        self.state.v.iter().map(|v| v.length()).fold(0.0, f64::max)
    }

    /// The body of a particle; numbers from that of particles on are those of rigid bodies.
    pub fn body(&self, particle: usize) -> Body {
        if let Some(rigid) = particle.checked_sub(self.state.len()) {
            return Body::Rigid { body: self.spec.rigids[rigid].name.clone() };
        }
        match self.assembly.wire_of[particle] {
            u32::MAX => Body::Sphere { sphere: particle - self.assembly.wire_particles + 1 },
            wire => {
                let layer = self.assembly.wires[wire as usize].layer;
                Body::Wire { wire: wire as usize + 1, layer: self.assembly.layers[layer].name.clone() }
            }
        }
    }

    /// A particle, or the bond that begins at it, in its body.
    pub fn member(&self, particle: usize) -> Member {
        let wire = self.assembly.wires.get(self.assembly.wire_of[particle] as usize);
        Member { number: wire.map(|wire| particle - wire.first + 1), body: self.body(particle) }
    }

    /// The present moment.
    pub fn instant(&self) -> Instant {
        let [low, high] = self.holds.stretch.gauge;
        Instant { step: self.state.step, time: self.state.time, strain: (high > low).then(|| self.strain()) }
    }

    /// A row of the curve.
    pub fn sample(&self) -> Sample {
        let wire_stress: Vec<f64> = (0..self.assembly.wires.len()).map(|w| self.wire_stress(w)).collect();
        let layer_stress = (0..self.assembly.layers.len())
            .map(|layer| {
                let of_layer = || (0..wire_stress.len()).filter(|w| self.assembly.wires[*w].layer == layer);
                of_layer().map(|w| wire_stress[w]).sum::<f64>() / of_layer().count().max(1) as f64
            })
            .collect();
        Sample {
            step: self.state.step,
            time: self.state.time,
            strain: self.strain(),
            stress: self.stress(),
            grip_force: self.measures.grip_force(),
            torque: self.measures.torque(),
            layer_stress,
            wire_stress,
            wire_pull: self.wire_pull(),
            wires_broken: self.measures.wires_broken(),
            bonds_broken: self.ruptures,
            contacts: self.contacts.map_or(0, |c| c.active()) + self.rigid.map_or(0, |rigid| rigid.active()),
            time_step: self.time_step,
            energy: self.energy(),
            bodies: self.bodies(),
        }
    }

    /// Rigid bodies, as means over the same time as the forces of the grips.
    fn bodies(&self) -> Vec<BodyState> {
        let Some(rigid) = self.rigid else { return Vec::new() };
        self.measures.bodies().unwrap_or_else(|| rigid.bodies())
    }

    /// Nominal axial stress of a wire at mid-gauge (Pa): the mean over its bonds in the middle twentieth of the gauge, of
    /// which those that are broken carry nothing. A wire that broke there reports what its pieces still carry by friction.
    pub fn wire_stress(&self, wire: usize) -> f64 {
        self.measures.wire_force(wire, &self.state.whole) / self.assembly.wires[wire].area()
    }

    /// [`Sample::wire_pull`] (N).
    fn wire_pull(&self) -> Vec<f64> {
        let x = &self.state.x;
        let slope = |slot: usize| {
            let along = x.get(slot + 1) - x.get(slot);
            along.z / along.length()
        };
        let wires = 0..if self.spec.has_several_materials() { self.assembly.wires.len() } else { 0 };
        wires.map(|wire| self.measures.wire_pull(wire, slope)).collect()
    }

    /// The energy ledger now.
    pub fn energy(&self) -> Energy {
        Energy {
            work: self.holds.work_now(self.state),
            kinetic: self.kinetic(),
            elastic_bonds: self.bonds.map_or(0.0, |b| b.elastic_energy(self.state)),
            elastic_contacts: self.contacts.map_or(0.0, |c| c.elastic_energy(self.state))
                + self.rigid.map_or(0.0, |rigid| rigid.elastic_energy()),
            ..*self.ledger
        }
    }

    /// Kinetic energy now (J). Leapfrog's is a product of two velocities half a step apart, which rounding errors in a body
    /// at rest turn round at every step: what is negative by less than a negligible energy is rest.
    fn kinetic(&self) -> f64 {
        let kinetic = self.holds.kinetic(self.state);
        if kinetic < 0.0 && -kinetic <= negligible_energy(self.spec, self.assembly) { 0.0 } else { kinetic }
    }

    /// Every particle, without what a scene asks for besides.
    pub fn snapshot(&self) -> Snapshot {
        let state = self.state;
        let n = state.len();
        let mut bond_state = vec![BondState::Absent; n];
        let mut bond_stress = vec![0.0; n];
        let mut plastic_strain = vec![0.0; n];
        let mut utilisation = vec![0.0; n];
        if let Some(bonds) = self.bonds {
            for slot in (0..n).filter(|s| self.assembly.is_bond(*s)) {
                let p = bonds.plastic_strain(slot);
                plastic_strain[slot] = p as f32;
                bond_stress[slot] = bonds.stress(slot) as f32;
                utilisation[slot] = if state.whole[slot] { bonds.utilisation(slot, state) as f32 } else { 1.0 };
                bond_state[slot] = match (state.whole[slot], p > 0.0) {
                    (false, _) => BondState::Broken,
                    (true, true) => BondState::Yielding,
                    (true, false) => BondState::Whole,
                };
            }
        }
        Snapshot {
            sample: self.sample(),
            position: state.x.iter().map(|x| x.as_vec3().to_array()).collect(),
            radius: state.radius.iter().map(|r| *r as f32).collect(),
            speed: state.v.iter().map(|v| v.length() as f32).collect(),
            bond_state,
            bond_stress,
            plastic_strain,
            utilisation,
            contact_pressure: self.contact_pressure(),
            roll: self.roll(),
            detail: None,
        }
    }

    /// [`Snapshot::roll`] (rad).
    fn roll(&self) -> Vec<f32> {
        let State { x, turned, .. } = self.state;
        let mut roll = Vec::new();
        for wire in self.assembly.wires.iter().filter(|_| !turned.is_empty()) {
            let last = wire.first + wire.len - 1;
            let along = |i: usize| x.get((i + 1).min(last)) - x.get(i.saturating_sub(1).max(wire.first));
            roll.extend((wire.first..=last).map(|i| turned.get(i).dot(along(i).normalize_or_zero()) as f32));
        }
        roll
    }

    /// [`Snapshot::contact_pressure`] (Pa).
    fn contact_pressure(&self) -> Vec<f32> {
        let mut force = vec![0.0; self.state.len()];
        if let Some(contacts) = self.contacts {
            contacts.add_normal_forces(&mut force);
        }
        if let Some(rigid) = self.rigid {
            rigid.add_normal_forces(&mut force);
        }
        force.iter().enumerate().map(|(i, f)| (f / shown_area(self.assembly, i)) as f32).collect()
    }
}

/// Area that particle `i` shows to its neighbours (m²): d a in a wire, π r² for a free sphere.
fn shown_area(a: &Assembly, i: usize) -> f64 {
    let d = 2.0 * a.radius[i];
    if i >= a.wire_particles {
        return std::f64::consts::FRAC_PI_4 * d * d;
    }
    // The last particle of a wire has its bond before it.
    let spacing = if a.is_bond(i) || i == 0 { a.rest_length[i] } else { a.rest_length[i - 1] };
    d * spacing
}
