//! Contact stage for spheres: every particle is a ball of its wire's diameter.

use super::bytes::{Bytes, NUMBER, VECTOR, behind};
use super::contacts::Contacts;
use super::neighbours::PairList;
use super::pair::{History, Laws, Meeting, elastic_energy, foreseen_stiffness, part, touch};
use super::state::{CHUNK, Deepest, Partial, State};
use super::time_step::Stiffness;
use crate::law::contact::NormalLaw;
use crate::law::contact::constants::reduced_radius;
use crate::law::damping::viscous_coefficient;
use crate::law::tangential::TangentialLaw;
use glam::DVec3;
use rayon::prelude::*;

/// A candidate pair with its history.
#[derive(Debug, Clone, Copy)]
struct Contact<N, T> {
    i: u32,
    j: u32,
    history: History<N, T>,
}

/// What a contact does at this step, apart from its history so that gathering reads little; zero when nothing touches.
#[derive(Debug, Clone, Copy, Default)]
struct Action {
    /// Force on the first particle [N]; the second feels minus this.
    force: DVec3,
    /// n × friction: torque per lever arm on either particle [N].
    twist: DVec3,
    /// How far the contact point lies inside either radius [m].
    sunk: f64,
}

/// Contacts between spheres with normal law `N` and tangential law `T`.
pub struct SphereContacts<N: NormalLaw, T: TangentialLaw> {
    laws: Laws<N, T>,
    contacts: Vec<Contact<N::State, T::State>>,
    actions: Vec<Action>,
    /// The list before a rebuild; kept for its memory.
    old: Vec<Contact<N::State, T::State>>,
    /// For each particle the contacts that it is in: index << 1 | 1 when it is the second of the pair.
    of_particle: Vec<u32>,
    start: Vec<u32>,
    partial: Vec<Partial>,
    /// The deepest contact so far.
    deepest: Deepest,
}

impl<N: NormalLaw, T: TangentialLaw> SphereContacts<N, T> {
    /// Without contacts yet.
    pub fn new(laws: Laws<N, T>) -> Self {
        Self {
            laws,
            contacts: Vec::new(),
            actions: Vec::new(),
            old: Vec::new(),
            of_particle: Vec::new(),
            start: Vec::new(),
            partial: Vec::new(),
            deepest: Deepest::default(),
        }
    }

    fn index_particles(&mut self, n: usize) {
        self.start.clear();
        self.start.resize(n + 1, 0);
        for c in &self.contacts {
            self.start[c.i as usize + 1] += 1;
            self.start[c.j as usize + 1] += 1;
        }
        for p in 0..n {
            self.start[p + 1] += self.start[p];
        }
        self.of_particle.clear();
        self.of_particle.resize(2 * self.contacts.len(), 0);
        let mut next = self.start.clone();
        for (k, c) in self.contacts.iter().enumerate() {
            for (particle, side) in [(c.i, 0), (c.j, 1)] {
                self.of_particle[next[particle as usize] as usize] = (k as u32) << 1 | side;
                next[particle as usize] += 1;
            }
        }
    }

    /// Adds up each particle's contacts in the order of the list.
    fn gather(&self, state: &mut State) {
        let (actions, start, of_particle) = (&self.actions, &self.start, &self.of_particle);
        let radius = &state.radius;
        let f = &mut state.contact_force;
        let t = &mut state.contact_torque;
        (
            f.x.par_chunks_mut(CHUNK),
            f.y.par_chunks_mut(CHUNK),
            f.z.par_chunks_mut(CHUNK),
            t.x.par_chunks_mut(CHUNK),
            t.y.par_chunks_mut(CHUNK),
            t.z.par_chunks_mut(CHUNK),
        )
            .into_par_iter()
            .with_max_len(1)
            .enumerate()
            .for_each(|(chunk, (fx, fy, fz, tx, ty, tz))| {
                for k in 0..fx.len() {
                    let p = chunk * CHUNK + k;
                    let (mut force, mut torque) = (DVec3::ZERO, DVec3::ZERO);
                    for entry in &of_particle[start[p] as usize..start[p + 1] as usize] {
                        let action = &actions[(entry >> 1) as usize];
                        let sign = if entry & 1 == 0 { 1.0 } else { -1.0 };
                        force += action.force * sign;
                        torque += action.twist * (radius[p] - action.sunk);
                    }
                    (fx[k], fy[k], fz[k]) = force.into();
                    (tx[k], ty[k], tz[k]) = torque.into();
                }
            });
    }
}

impl<N: NormalLaw, T: TangentialLaw> Contacts for SphereContacts<N, T> {
    fn rebuild(&mut self, list: &PairList, state: &State) -> Partial {
        std::mem::swap(&mut self.contacts, &mut self.old);
        self.contacts.clear();
        let mut lost = Partial::default();
        let mut k = 0;
        for (i, j) in list.pairs.iter().copied() {
            while k < self.old.len() && (self.old[k].i, self.old[k].j) < (i, j) {
                part::<N, T>(&self.laws, &mut self.old[k].history, 0.0, &mut lost);
                k += 1;
            }
            if k < self.old.len() && (self.old[k].i, self.old[k].j) == (i, j) {
                self.contacts.push(self.old[k]);
                k += 1;
            } else {
                self.contacts.push(fresh(i, j, state));
            }
        }
        for c in &mut self.old[k..] {
            part::<N, T>(&self.laws, &mut c.history, 0.0, &mut lost);
        }
        self.actions.clear();
        self.actions.resize(self.contacts.len(), Action::default());
        self.partial.clear();
        self.partial.resize(self.contacts.len().div_ceil(CHUNK), Partial::default());
        self.index_particles(state.len());
        lost
    }

    fn compute(&mut self, state: &mut State) -> Partial {
        let (laws, deepest) = (&self.laws, self.deepest);
        let shared = &*state;
        (self.contacts.par_chunks_mut(CHUNK), self.actions.par_chunks_mut(CHUNK), self.partial.par_iter_mut())
            .into_par_iter()
            .with_max_len(1)
            .for_each(|(contacts, actions, partial)| {
                // The sum stays on this thread's stack: its neighbours in memory belong to other threads.
                let mut sum = Partial::beyond(deepest);
                for (contact, action) in contacts.iter_mut().zip(actions) {
                    *action = sphere_pair(laws, shared, contact, &mut sum);
                }
                *partial = sum;
            });
        self.gather(state);
        let mut sum = Partial::beyond(deepest);
        self.partial.iter().for_each(|p| sum.add(p));
        self.deepest = sum.deepest;
        sum
    }

    fn elastic_energy(&self) -> f64 {
        self.contacts.iter().map(|c| elastic_energy(&self.laws, &c.history)).sum()
    }

    fn add_normal_forces(&self, onto: &mut [f64]) {
        for c in &self.contacts {
            onto[c.i as usize] += c.history.normal_force;
            onto[c.j as usize] += c.history.normal_force;
        }
    }

    fn active(&self) -> usize {
        self.contacts.iter().filter(|c| c.history.touching).count()
    }

    fn candidates(&self) -> usize {
        self.contacts.len()
    }

    fn stiffness(&self, state: &State, horizon: f64, out: &mut Stiffness) {
        for c in self.contacts.iter().filter(|c| c.history.touching) {
            let (i, j) = (c.i as usize, c.j as usize);
            let d = state.x.get(j) - state.x.get(i);
            let distance = d.length();
            let approach = (state.v.get(i) - state.v.get(j)).dot(d) / distance;
            let overlap = state.radius[i] + state.radius[j] - c.history.offset - distance;
            let Some(k) = foreseen_stiffness(&self.laws, &c.history, overlap, approach, horizon) else { continue };
            let mass = state.mass[i] * state.mass[j] / (state.mass[i] + state.mass[j]);
            let viscosity = viscous_coefficient(self.laws.damping, mass, k[0]);
            out.contact([c.i, c.j, 0], [1.0, 1.0, 0.0], k, [state.radius[i], state.radius[j], 0.0], viscosity);
        }
    }

    fn bytes(&self, particles: usize) -> Bytes {
        let (contact, action) = (size_of_val(&self.contacts[..]), size_of_val(&self.actions[..]));
        let lists = behind(&self.of_particle) + behind(&self.start) + behind(&self.partial);
        // x, v, ω, radius and inverse mass in; force and torque out.
        let per_particle = 3 * VECTOR + 2 * NUMBER + 2 * VECTOR;
        Bytes {
            kept: behind(&self.contacts) + behind(&self.old) + behind(&self.actions) + lists,
            // Records in and out, actions out and, through the list of each particle, in twice.
            moved: 2 * contact + 3 * action + size_of_val(&self.of_particle[..]) + particles * per_particle,
        }
    }
}

/// A pair that is new in the list. During a run it was beyond reach until now, or a bond has just broken.
fn fresh<N: Default, S: Default>(i: u32, j: u32, state: &State) -> Contact<N, S> {
    let (a, b) = (i as usize, j as usize);
    let mut history = History::new(reduced_radius(state.radius0[a], state.radius0[b]));
    if state.step > 0 {
        let distance = (state.x.get(b) - state.x.get(a)).length();
        history.offset = (state.radius[a] + state.radius[b] - distance).max(0.0);
    }
    Contact { i, j, history }
}

/// Geometrical overlap [m]; the lever arms of friction end in its middle, so that they add up to the distance.
fn sunk<N, S>(history: &History<N, S>) -> f64 {
    history.overlap + history.offset
}

/// Kinematics and response of one candidate pair.
#[inline(always)]
fn sphere_pair<N: NormalLaw, T: TangentialLaw>(
    laws: &Laws<N, T>,
    state: &State,
    c: &mut Contact<N::State, T::State>,
    partial: &mut Partial,
) -> Action {
    let (i, j) = (c.i as usize, c.j as usize);
    let d = state.x.get(j) - state.x.get(i);
    let touching = state.radius[i] + state.radius[j];
    let reach = touching - c.history.offset;
    let distance2 = d.length_squared();
    if distance2 >= reach * reach {
        if c.history.touching || c.history.offset > 0.0 {
            part::<N, T>(laws, &mut c.history, touching - distance2.sqrt(), partial);
        }
        return Action::default();
    }
    let distance = distance2.sqrt();
    let normal = d * (1.0 / distance);
    let overlap = reach - distance;
    let mut velocity = state.v.get(j) - state.v.get(i);
    if T::ACTIVE {
        let half = 0.5 * (overlap + c.history.offset);
        let arms = state.w.get(i) * (state.radius[i] - half) + state.w.get(j) * (state.radius[j] - half);
        velocity -= arms.cross(normal);
    }
    let mass = 1.0 / (state.inverse_mass[i] + state.inverse_mass[j]);
    let meeting = Meeting { normal, overlap, reach, velocity, mass, dt: state.dt };
    let pair = touch(laws, &mut c.history, &meeting, partial);
    let least = state.radius[i].min(state.radius[j]);
    partial.deepest.meet([c.i, c.j], overlap, least, c.history.reduced_radius, c.history.normal_force);
    Action { force: pair.force, twist: normal.cross(pair.friction), sunk: 0.5 * sunk(&c.history) }
}
