//! All rigid bodies of a run, chunk of particles by chunk.

use super::body::Body;
use super::stage::{Outcome, RigidBodies};
use super::touch::{self, Act, Meets, Near, Touch};
use crate::engine::bytes::{Bytes, behind};
use crate::engine::contact::wires::chains::Chains;
use crate::engine::contact::wires::curve::Around;
use crate::engine::saved::{Reader, Unfit, Writer};
use crate::engine::state::{CHUNK, ChunkSums, Deepest, State};
use crate::engine::team::Team;
use crate::engine::time_step::Element;
use crate::engine::view::BodyState;
use crate::law::contact::NormalLaw;
use crate::law::contact::line::LineStiffness;
use crate::law::tangential::TangentialLaw;
use glam::DVec3;

/// Rigid bodies with normal law `N` and tangential law `T`.
pub(super) struct Rigids<N: NormalLaw, T: TangentialLaw> {
    pub bodies: Vec<Body<N, T>>,
    pub line: LineStiffness,
    pub chains: Chains,
    /// Whether wires are smooth.
    pub smooth: bool,
    /// Number of the material of each particle; empty with one material.
    pub material_of: Vec<u32>,
    /// Whether damping is to give a coefficient of restitution.
    pub restitution: bool,
    /// Viscous damping, fraction of critical (-).
    pub damping: f64,
    /// Gap beyond which a contact is forgotten (m).
    pub skin: f64,
    /// By how much a gap may close while no particle moves further than 1 and the body stands still (-).
    pub closing: f64,
    /// The deepest contact so far.
    pub deepest: Deepest,
    /// Per chunk of particles.
    pub parts: Vec<Part<N, T>>,
}

/// Contacts of one chunk of particles.
pub(super) struct Part<N: NormalLaw, T: TangentialLaw> {
    /// With each body.
    near: Vec<Near<N, T>>,
    /// What bodies do to stretches and balls at this step.
    acts: Vec<Act>,
    sums: ChunkSums,
    passed: Option<[usize; 2]>,
}

impl<N: NormalLaw, T: TangentialLaw> Part<N, T> {
    /// Of a chunk among `bodies` bodies.
    pub fn new(bodies: usize) -> Self {
        let near = || Near { quiet_until: 0.0, touches: Vec::new(), load: [DVec3::ZERO; 2] };
        let near = (0..bodies).map(|_| near()).collect();
        Self { near, acts: Vec::new(), sums: ChunkSums::default(), passed: None }
    }
}

impl<N: NormalLaw, T: TangentialLaw> Rigids<N, T> {
    fn touches(&self) -> impl Iterator<Item = (&Body<N, T>, &Touch<N, T>)> {
        let all = self.parts.iter().flat_map(|part| self.bodies.iter().zip(&part.near));
        all.flat_map(|(body, near)| near.touches.iter().map(move |touch| (body, touch)))
            .filter(|(_, touch)| touch.history.touching())
    }

    /// What contacts need to know.
    fn meets<'a>(&'a self, state: &'a State) -> Meets<'a> {
        Meets {
            state,
            chains: &self.chains,
            line: &self.line,
            smooth: self.smooth,
            material_of: &self.material_of,
            restitution: self.restitution,
            damping: self.damping,
            skin: self.skin,
            closing: self.closing,
        }
    }
}

/// Adds the vector to that of a particle.
fn add(rows: [&mut [f64]; 3], particle: usize, vector: DVec3) {
    rows.into_iter().zip(vector.to_array()).for_each(|(row, value)| row[particle] += value);
}

impl<N: NormalLaw, T: TangentialLaw> RigidBodies for Rigids<N, T> {
    fn compute(&mut self, state: &mut State, team: &Team) -> Outcome {
        let before: Vec<[DVec3; 2]> = self.bodies.iter().map(|body| body.load).collect();
        self.bodies.iter_mut().for_each(|body| body.move_to(state.time, state.dt));
        let (deepest, mut parts) = (self.deepest, std::mem::take(&mut self.parts));
        let (this, seen) = (&*self, &*state);
        let quiet = |part: &Part<N, T>| {
            this.bodies.iter().zip(&part.near).all(|(body, near)| body.quiet(near.quiet_until, seen))
        };
        let meets = this.meets(seen);
        let look = |chunk: usize, part: &mut Part<N, T>| {
            let particles = chunk * CHUNK..seen.len().min((chunk + 1) * CHUNK);
            part.acts.clear();
            (part.sums, part.passed) = (ChunkSums::beyond(deepest), None);
            for (number, (body, near)) in this.bodies.iter().zip(&mut part.near).enumerate() {
                near.load = [DVec3::ZERO; 2];
                if !body.quiet(near.quiet_until, seen) {
                    let (acts, sums) = (&mut part.acts, &mut part.sums);
                    let passed = touch::look(&meets, body, number, particles.clone(), near, acts, sums);
                    part.passed = part.passed.or(passed.map(|particle| [particle, number]));
                }
            }
        };
        if parts.iter().all(quiet) {
            parts.iter_mut().enumerate().for_each(|(chunk, part)| look(chunk, part));
        } else {
            team.for_each(parts.iter_mut(), look);
        }
        self.parts = parts;
        self.add_up(state, &before)
    }

    fn elastic_energy(&self) -> f64 {
        let stored = |(body, touch): (&Body<N, T>, &Touch<N, T>)| {
            touch.energy + body.law(self.material(touch.i)).tangential.elastic_energy(&touch.history.tangential)
        };
        self.touches().map(stored).sum()
    }

    fn add_normal_forces(&self, onto: &mut [f64]) {
        self.touches().for_each(|(_, touch)| onto[touch.i as usize] += touch.history.normal_force);
    }

    fn active(&self) -> usize {
        self.touches().count()
    }

    fn elements(&self, state: &State, chunk: usize, horizon: f64, each: &mut dyn FnMut(Element)) {
        let meets = self.meets(state);
        let Some(part) = self.parts.get(chunk) else { return };
        for (body, near) in self.bodies.iter().zip(&part.near) {
            let touching = near.touches.iter().filter(|touch| touch.history.touching());
            touching.filter_map(|touch| meets.element(body, touch, horizon)).for_each(&mut *each);
        }
    }

    fn bodies(&self) -> Vec<BodyState> {
        self.bodies.iter().map(Body::state).collect()
    }

    fn fastest(&self, time: f64) -> f64 {
        self.bodies.iter().map(|body| body.speed_from(time)).fold(0.0, f64::max)
    }

    fn bytes(&self) -> Bytes {
        let of = |near: &Near<N, T>| {
            behind(&near.touches) + near.touches.iter().map(|touch| behind(&touch.dents)).sum::<usize>()
        };
        let parts = self.parts.iter().map(|part| behind(&part.acts) + part.near.iter().map(of).sum::<usize>());
        Bytes { kept: parts.sum::<usize>() + self.chains.bytes() + behind(&self.material_of), moved: 0 }
    }

    fn save(&self, out: &mut Writer) {
        out.put(&self.bodies.iter().map(Body::saved).collect::<Vec<_>>());
        let near = || self.parts.iter().flat_map(|part| &part.near);
        out.put(&near().map(|near| near.quiet_until).collect::<Vec<f64>>());
        out.put(&near().map(|near| &near.touches).collect::<Vec<_>>());
        out.put(&self.deepest);
    }

    fn restore(&mut self, from: &mut Reader, state: &State) -> Result<(), Unfit> {
        let mut bodies: Vec<_> = self.bodies.iter().map(Body::saved).collect();
        from.take_into(&mut bodies)?;
        self.bodies.iter_mut().zip(bodies).for_each(|(body, saved)| body.take_up(saved));
        let count = self.parts.len() * self.bodies.len();
        let (mut quiet, mut touches) = (vec![0.0; count], (0..count).map(|_| Vec::new()).collect::<Vec<_>>());
        from.take_into(&mut quiet)?;
        from.take_into::<Vec<Touch<N, T>>>(&mut touches)?;
        if touches.iter().flatten().any(|touch| touch.i as usize >= state.len()) {
            return Err(Unfit("its contacts with rigid bodies are those of other particles".into()));
        }
        let near = self.parts.iter_mut().flat_map(|part| &mut part.near);
        for ((near, quiet_until), touches) in near.zip(quiet).zip(touches) {
            (near.quiet_until, near.touches) = (quiet_until, touches);
        }
        self.deepest = from.take()?;
        Ok(())
    }
}

impl<N: NormalLaw, T: TangentialLaw> Rigids<N, T> {
    fn material(&self, particle: u32) -> usize {
        self.material_of.get(particle as usize).map_or(0, |material| *material as usize)
    }

    /// Adds what bodies do to the particles, and the work of the bodies, whose loads were `before` the step (N, N m).
    fn add_up(&mut self, state: &mut State, before: &[[DVec3; 2]]) -> Outcome {
        let mut outcome = Outcome { sums: ChunkSums::beyond(self.deepest), ..Outcome::default() };
        self.bodies.iter_mut().for_each(|body| body.load = [DVec3::ZERO; 2]);
        for part in &self.parts {
            outcome.sums.add(&part.sums);
            outcome.passed = outcome.passed.or(part.passed);
            for (body, near) in self.bodies.iter_mut().zip(&part.near) {
                body.load.iter_mut().zip(near.load).for_each(|(sum, load)| *sum += load);
            }
            for act in &part.acts {
                let i = act.i as usize;
                match act.ball {
                    true => add(state.force.rows_mut(), i, act.force[0]),
                    false => {
                        let around = Around::new(&state.x, state, &self.chains, i);
                        let force = &mut state.force;
                        around.spread(i, &act.force, &mut |node, f| add(force.rows_mut(), node, f));
                    }
                }
                if T::ACTIVE {
                    add(state.torque.rows_mut(), i, act.twist);
                }
            }
        }
        self.deepest = outcome.sums.deepest;
        outcome.work = self.bodies.iter().zip(before).map(|(body, before)| body.work(before)).sum();
        outcome
    }
}
