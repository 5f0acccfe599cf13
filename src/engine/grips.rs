//! Grips, holds and applied loads: prescribed motion, the reactions to it, and the work done.

mod schedule;

use super::loading_rate::{self, LoadingRate, Rule};
use super::motion::{Kicked, Rigid, affine_share, prescribed, sped_up};
use super::neighbours::Stretch;
use super::saved::{Reader, Unfit, Writer};
use super::state::State;
use super::straight::{StraightGrip, runs};
use super::view::Load;
use crate::base::error::{Error, Result};
use crate::base::triple::Triple;
use crate::base::vectors::Vectors;
use crate::scene::spec::{BodyPart, DriveSpec, GripKind, GripSpec, HoldSpec, Spec, Table};
use crate::strand::assembly::Assembly;
use crate::strand::held::Gripped;
use glam::{DVec2, DVec3};
use pulp::Arch;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::ops::Range;

/// Time over which a jaw's clamp pressure rises (s); short against a pull, long against a wire's ringing.
const CLAMP_RISE: f64 = 50e-6;

/// What a group of particles must do.
#[derive(Debug, Clone)]
enum Kind {
    /// Moves as one rigid body along and about z.
    Rigid,
    /// Moves along and about z; radially free under a clamp force per particle (N).
    Jaw { clamp: f64 },
    /// Components prescribed one by one, and loads per particle.
    Components(HoldSpec),
}

/// A group of particles with one motion.
#[derive(Debug, Clone)]
struct Group {
    particles: Vec<u32>,
    /// The same as runs of neighbours.
    runs: Vec<Range<usize>>,
    kind: Kind,
    /// Whether the drive moves this group.
    driven: bool,
}

/// Reactions on the two grips at the last step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Reaction {
    /// Force on the lower and upper grip, tension positive (N).
    pub force: [f64; 2],
    /// Torque about z on the upper grip (N m).
    pub torque: f64,
}

/// All holds of a run.
#[derive(Clone)]
pub struct Holds {
    groups: Vec<Group>,
    grip: Option<GripSpec>,
    /// Axis of the grips in the xy plane (m).
    axis: DVec2,
    /// Gauge before loading and displacement of the upper grip.
    pub stretch: Stretch,
    /// Length between the last particles held in one grip and in the other, mean over the held wires (m): particles do
    /// not lie just where the grips end, and strain is what this length does.
    free_length: f64,
    /// Spin of the upper grip about z (rad/s).
    spin: f64,
    /// Speed of an adaptive pull.
    pub(super) loading_rate: Option<LoadingRate>,
    /// Reactions of the last step.
    pub reaction: Reaction,
    /// By how much the upper grip has turned about z (rad).
    pub angle: f64,
    /// What each of the scene's holds did to its particles in the last step, where the scene asks for it; empty elsewhere.
    reactions: Vec<[DVec3; 2]>,
    /// Work done so far (J).
    pub work: f64,
}

impl Holds {
    /// Finds the particles of each hold and marks them in `state`.
    ///
    /// # Errors
    /// When a jaw has no wire of the outermost layer in it.
    pub fn new(spec: &Spec, assembly: &Assembly, state: &mut State) -> Result<Self> {
        let mut holds = Self {
            groups: Vec::new(),
            grip: spec.grip.clone(),
            axis: DVec2::ZERO,
            stretch: Stretch::default(),
            free_length: 0.0,
            spin: spec.grip.as_ref().map_or(0.0, |g| g.rotation_rate),
            loading_rate: None,
            reaction: Reaction::default(),
            angle: 0.0,
            reactions: Vec::new(),
            work: 0.0,
        };
        if let Some(grip) = &spec.grip {
            holds.add_grips(grip, assembly)?;
            if grip.rotation_rate != 0.0 || grip.free_rotation {
                state.turned = Vectors::zeros(state.len());
            }
        }
        let bodies = assembly.bodies();
        for hold in &spec.holds {
            let body = bodies[hold.body].clone();
            let particles = match hold.part {
                BodyPart::Start => body.start..body.start + 1,
                BodyPart::End => body.end - 1..body.end,
                BodyPart::All => body,
            };
            let particles: Vec<u32> = particles.map(|p| p as u32).collect();
            let kind = Kind::Components(hold.clone());
            holds.groups.push(Group { runs: runs(&particles), particles, kind, driven: false });
        }
        if spec.output.tables.contains(&Table::Holds) {
            holds.reactions = vec![[DVec3::ZERO; 2]; spec.holds.len()];
        }
        holds.mark(state);
        holds.start_velocities(state);
        let inertia = loading_rate::inertia(state, |z| holds.share(z));
        holds.loading_rate = Rule::new(spec, inertia, holds.free_length).map(LoadingRate::new);
        holds.work = holds.kinetic(state);
        Ok(holds)
    }

    /// Puts in how far the drive has come, and what it took.
    pub fn save(&self, out: &mut Writer) {
        out.put(&(self.stretch, self.spin, self.reaction, self.angle, self.work));
        out.put(&self.loading_rate.as_ref().map(LoadingRate::now));
    }

    /// Takes up what [`Self::save`] has put in.
    ///
    /// # Errors
    /// [`Unfit`] when it is of another drive.
    pub fn restore(&mut self, from: &mut Reader) -> Result<(), Unfit> {
        let gauge = self.stretch.gauge;
        (self.stretch, self.spin, self.reaction, self.angle, self.work) = from.take()?;
        let rate: Option<[f64; 4]> = from.take()?;
        if gauge != self.stretch.gauge || rate.is_some() != self.loading_rate.is_some() {
            return Err(Unfit("its grips are others".into()));
        }
        self.loading_rate.iter_mut().zip(rate).for_each(|(rate, now)| rate.resume(now));
        Ok(())
    }

    fn add_grips(&mut self, grip: &GripSpec, assembly: &Assembly) -> Result<()> {
        let z = &assembly.position.z[..assembly.wire_particles];
        let (low, high) = z.iter().fold((f64::MAX, f64::MIN), |(a, b), z| (a.min(*z), b.max(*z)));
        self.stretch.gauge = [low + grip.length, high - grip.length];
        let outer = assembly.layers.len().saturating_sub(1);
        let gripped = Gripped::of(grip, assembly);
        for driven in [false, true] {
            let held = gripped.particles[usize::from(driven)].iter().flatten();
            let particles: Vec<u32> = held.map(|p| *p as u32).collect();
            if particles.is_empty() {
                return Err(nothing_to_hold(&assembly.layers[outer].name, driven));
            }
            let kind = match grip.kind {
                GripKind::All => Kind::Rigid,
                GripKind::Jaw { pressure } => {
                    let radius = assembly.layers[outer].lay_radius + assembly.radius[particles[0] as usize];
                    Kind::Jaw { clamp: pressure * TAU * radius * grip.length / particles.len() as f64 }
                }
            };
            self.groups.push(Group { runs: runs(&particles), particles, kind, driven });
        }
        self.free_length = gripped.free_length();
        Ok(())
    }

    /// Tells the state which components are prescribed, and which particles never move against each other.
    fn mark(&self, state: &mut State) {
        for (g, group) in self.groups.iter().enumerate() {
            let (mask, whole) = match &group.kind {
                Kind::Rigid => (0b11_1111, true),
                Kind::Jaw { .. } => (0b11_1111, false),
                Kind::Components(h) => {
                    let mask = (0..6).fold(0, |m, k| m | u8::from(h.fixed[k]) << k);
                    (mask, mask == 0b11_1111)
                }
            };
            for p in &group.particles {
                state.fixed[*p as usize] |= mask;
                if whole {
                    state.hold[*p as usize] = g as u16 + 1;
                }
            }
        }
    }

    /// The affine velocity (and spin) field of the drive, so that nothing is shocked; prescribed velocities.
    fn start_velocities(&self, state: &mut State) {
        if let Some(grip) = &self.grip {
            let speed = match grip.drive {
                DriveSpec::Speed(v) => v,
                DriveSpec::Cyclic { amplitude, frequency } => amplitude * TAU * frequency,
            };
            for p in 0..state.len() {
                let share = self.share(state.x.z[p]);
                let spin = DVec3::Z * (self.spin * share);
                let arm = state.x.get(p) - self.axis.extend(state.x.z[p]);
                state.v.add(p, spin.cross(arm) + DVec3::Z * (speed * share));
                state.w.add(p, spin);
            }
        }
        for group in &self.groups {
            let Kind::Components(hold) = &group.kind else { continue };
            for p in &group.particles {
                let p = *p as usize;
                let v = prescribed(&hold.fixed[..3], hold.velocity.into(), state.v.get(p).into());
                let w = prescribed(&hold.fixed[3..], hold.spin.into(), state.w.get(p).into());
                state.v.set(p, v.into());
                state.w.set(p, w.into());
            }
        }
    }

    /// Share of the upper grip's speed that a place between the grips has in the affine field of the pull (-).
    fn share(&self, z: f64) -> f64 {
        affine_share(z, self.faces())
    }

    /// Places along z between which the pull is affine (m).
    fn faces(&self) -> [f64; 2] {
        let [low, high] = self.stretch.gauge;
        [low, high + self.stretch.displacement]
    }

    /// Grip displacement over the length that is free between the grips (-).
    pub fn strain(&self) -> f64 {
        if self.free_length > 0.0 { self.stretch.displacement / self.free_length } else { 0.0 }
    }

    /// Speed of the upper grip along z now, of a pull at constant or adaptive speed (m/s); 0 of any other drive.
    pub fn speed(&self) -> f64 {
        match (&self.loading_rate, self.grip.as_ref().map(|grip| grip.drive)) {
            (Some(rate), _) => rate.speed,
            (None, Some(DriveSpec::Speed(speed))) => speed,
            _ => 0.0,
        }
    }

    /// Overrides the kicked velocities of held particles; `kicked` is the time that the kick spanned (s).
    pub fn apply(&mut self, state: &mut State, kicked: f64, arch: Arch) {
        if let Some(rate) = &mut self.loading_rate {
            rate.advance(kicked);
        }
        let rise = self.rise(state.time, state.dt);
        if self.grip.as_ref().is_some_and(|grip| grip.free_rotation) {
            self.spin += self.free_torque(state) * kicked;
        }
        self.reaction = Reaction::default();
        let groups = std::mem::take(&mut self.groups);
        let mut number = 0;
        for group in &groups {
            match &group.kind {
                Kind::Rigid if !self.turns(group) => self.straight(group, state, rise, kicked, arch),
                Kind::Rigid => self.rigid(group, state, rise, kicked, None),
                Kind::Jaw { clamp } => {
                    let on = smooth(state.time / CLAMP_RISE) * clamp;
                    self.rigid(group, state, rise, kicked, Some(on));
                }
                Kind::Components(hold) => {
                    let load = self.components(group, hold, state, kicked);
                    if let Some(last) = self.reactions.get_mut(number) {
                        *last = load;
                    }
                    number += 1;
                }
            }
        }
        self.groups = groups;
        if self.speed_change() != 0.0 {
            self.change_speed(state, kicked);
        }
        self.stretch.displacement += rise;
        self.angle += self.spin * state.dt;
    }

    /// Way of the upper grip along z in a step of `dt` (s) from `time` (s) on (m).
    fn rise(&self, time: f64, dt: f64) -> f64 {
        match self.grip.as_ref().map(|grip| grip.drive) {
            None => 0.0,
            Some(DriveSpec::Speed(v)) => self.loading_rate.as_ref().map_or(v, |rate| rate.speed) * dt,
            Some(DriveSpec::Cyclic { amplitude, frequency }) => {
                let at = |t: f64| amplitude * (TAU * frequency * t).sin();
                at(time + dt) - at(time)
            }
        }
    }

    /// Whether a group turns with the drive.
    fn turns(&self, group: &Group) -> bool {
        group.driven && self.spin != 0.0
    }

    /// Change of speed of an adaptive pull in this step (m/s).
    fn speed_change(&self) -> f64 {
        self.loading_rate.as_ref().map_or(0.0, |rate| rate.change)
    }

    /// Speeds up or slows down the affine field of an adaptive pull. Held particles are left alone: their grip has moved
    /// them.
    fn change_speed(&mut self, state: &mut State, kicked: f64) {
        let change = self.speed_change();
        for p in (0..state.len()).filter(|p| state.fixed[*p] == 0) {
            let push = self.share(state.x.z[p]) * change;
            let [speed, work] = sped_up(state.v.z[p], push, state.force.z[p], state.mass[p], kicked);
            self.work += work;
            state.v.z[p] = speed;
        }
    }

    /// Torque about z on the driven grip over its inertia (rad/s²).
    fn free_torque(&self, state: &State) -> f64 {
        let (mut torque, mut inertia) = (0.0, 0.0);
        for p in self.groups.iter().filter(|g| g.driven).flat_map(|g| &g.particles) {
            let p = *p as usize;
            let arm = state.x.get(p).truncate() - self.axis;
            torque += arm.perp_dot(state.force.get(p).truncate()) + state.torque.z[p];
            inertia += state.mass[p] * arm.length_squared() + state.inertia[p];
        }
        if inertia > 0.0 { torque / inertia } else { 0.0 }
    }

    /// Velocity along z of a group that moves without turning (m/s).
    fn straight_speed(group: &Group, rise: f64, dt: f64) -> f64 {
        if group.driven { rise / dt } else { 0.0 }
    }

    /// Force of the driven grip on the body: what it takes to speed up the held particles themselves, of `mass` (kg), loads
    /// the drive (N).
    fn force_on_body(&self, force: f64, mass: f64, kicked: f64) -> f64 {
        force - self.speed_change() / kicked * mass
    }

    /// A grip that moves along z without turning; see [`Self::rigid`].
    fn straight(&mut self, group: &Group, state: &mut State, rise: f64, kicked: f64, arch: Arch) {
        let speed = Self::straight_speed(group, rise, state.dt);
        let axis = self.axis.to_array();
        let effort = arch.dispatch(StraightGrip { runs: &group.runs, state, speed, kicked, axis });
        self.work += effort.work;
        if group.driven {
            self.reaction.force[1] = self.force_on_body(effort.force, effort.mass, kicked);
            self.reaction.torque = effort.torque;
        } else {
            self.reaction.force[0] = -effort.force;
        }
    }

    /// How a group that moves along and about z does so in a step of `dt` (s), under a clamp force per particle (N).
    fn rigid_motion(&self, group: &Group, rise: f64, dt: f64, kicked: f64, clamp: Option<f64>) -> Rigid<f64> {
        let (spin, rise) = if group.driven { (self.spin, rise) } else { (0.0, 0.0) };
        let (sin, cos) = (spin * dt).sin_cos();
        let acceleration = if group.driven { self.speed_change() / kicked } else { 0.0 };
        Rigid { chord: [(cos - 1.0) * (1.0 / dt), sin * (1.0 / dt)], speed: rise / dt, spin, clamp, acceleration }
    }

    /// A particle after a kick over `time` (s).
    fn kicked(&self, state: &State, p: usize, time: f64) -> Kicked<f64> {
        Kicked {
            arm: [state.x.x[p] - self.axis.x, state.x.y[p] - self.axis.y],
            v: state.v.get(p).into(),
            w: state.w.get(p).into(),
            force: state.force.get(p).into(),
            torque: state.torque.get(p).into(),
            mass: state.mass[p],
            inertia: state.inertia[p],
            inverse_mass: state.inverse_mass[p],
            inverse_inertia: state.inverse_inertia[p],
            time,
        }
    }

    /// A grip that moves along and about z; under `clamp` its particles are free along the radius.
    fn rigid(&mut self, group: &Group, state: &mut State, rise: f64, kicked: f64, clamp: Option<f64>) {
        let grip = self.rigid_motion(group, rise, state.dt, kicked, clamp);
        let (mut force, mut torque) = (0.0, 0.0);
        for p in group.particles.iter().map(|p| *p as usize) {
            let held = self.kicked(state, p, kicked).rigid(&grip);
            for part in 0..2 {
                self.work += held.work[part];
                torque += held.torque[part];
            }
            force += held.force;
            state.v.set(p, held.v.into());
            state.w.set(p, held.w.into());
        }
        if group.driven {
            self.reaction.force[1] = force;
            self.reaction.torque = torque;
        } else {
            self.reaction.force[0] = -force;
        }
    }

    /// Components held one by one, and loads. Returns the force and the moment about the middle of what is held that did it.
    fn components(&mut self, group: &Group, hold: &HoldSpec, state: &mut State, kicked: f64) -> [DVec3; 2] {
        let load = Self::load(hold, group.particles.len(), state.time).map(Triple::from);
        let motion = [hold.velocity, hold.spin].map(Triple::from);
        let middle =
            group.particles.iter().map(|p| state.x.get(*p as usize)).sum::<DVec3>() / group.particles.len() as f64;
        let (mut force, mut moment) = (DVec3::ZERO, DVec3::ZERO);
        for p in group.particles.iter().map(|p| *p as usize) {
            let held = self.kicked(state, p, kicked).components(&hold.fixed, motion, load);
            held.work.iter().for_each(|work| self.work += work);
            let (v, w) = (DVec3::from(held.v), DVec3::from(held.w));
            // What must have acted beside bonds and contacts.
            let push = (v - state.v.get(p)) * (state.mass[p] / kicked);
            force += push;
            moment += (state.x.get(p) - middle).cross(push) + (w - state.w.get(p)) * (state.inertia[p] / kicked);
            state.v.set(p, v);
            state.w.set(p, w);
        }
        [force, moment]
    }

    /// What each of the scene's holds did to its particles in the last step, about their middle; empty where nobody asks.
    pub fn reactions(&self) -> Vec<Load> {
        self.reactions.iter().map(|load| (*load).into()).collect()
    }

    /// Force (N) and moment (N m) that a hold applies to each of its particles at `time` (s).
    fn load(hold: &HoldSpec, particles: usize, time: f64) -> [DVec3; 2] {
        let share = if hold.ramp > 0.0 { smooth(time / hold.ramp) } else { 1.0 } / particles as f64;
        [hold.force * share, hold.moment * share]
    }

    /// Applied force (N) and moment (N m) of each loaded particle.
    fn loads(&self, time: f64) -> BTreeMap<usize, [DVec3; 2]> {
        let mut loads: BTreeMap<usize, [DVec3; 2]> = BTreeMap::new();
        for group in &self.groups {
            let Kind::Components(hold) = &group.kind else { continue };
            let [force, moment] = Self::load(hold, group.particles.len(), time);
            for p in &group.particles {
                let sum = loads.entry(*p as usize).or_default();
                sum[0] += force;
                sum[1] += moment;
            }
        }
        loads
    }

    /// Kinetic energy at the instant of the positions (J), applied loads counted.
    pub fn kinetic(&self, state: &State) -> f64 {
        let loads = self.loads(state.time);
        state.kinetic(|p| loads.get(&p).copied().unwrap_or_default())
    }

    /// Work up to the instant of the positions (J): `work` lags by half a step.
    pub fn work_now(&self, state: &State) -> f64 {
        let loads = self.loads(state.time);
        let applied: f64 = loads
            .iter()
            .map(|(p, [force, moment])| {
                let (force, moment) = (state.free_part(*p, 0, *force), state.free_part(*p, 3, *moment));
                force.dot(state.v.get(*p)) + moment.dot(state.w.get(*p))
            })
            .sum();
        self.work + 0.5 * state.dt * (applied - state.held_power())
    }
}

fn nothing_to_hold(layer: &str, upper: bool) -> Error {
    let which = if upper { "upper" } else { "lower" };
    Error::input(
        format!("the {which} grip holds nothing: no wire of the outermost layer \"{layer}\" reaches into it"),
        "a jaw drives the outermost layer only: make its wires as long as the body, or grip.length longer",
    )
}

/// Smooth rise from 0 at 0 to 1 at 1, with no slope at either end.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests;
