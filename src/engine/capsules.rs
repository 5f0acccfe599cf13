//! Contact stage for capsules: wires are smooth, each particle rests on the nearest point of the other wire.
//!
//! A contact is a particle of one wire against the swept segment between two bonded particles of another. It is made
//! for the particles of both wires, so each of the two stands for half of the contact between them and carries half the
//! force. A contact walks along the other wire from segment to segment as the particle slides, and keeps its history.
//! A free sphere against a wire, or two free spheres, carry the whole force.

use super::bytes::{Bytes, NUMBER, VECTOR, behind};
use super::contacts::{Contacts, closing};
use super::neighbours::{PairList, apart};
use super::pair::{History, Laws, Meeting, PairForce, elastic_energy, foreseen_stiffness, leave, meet, normal_energy};
use super::spheres::SecondSides;
use super::state::{CHUNK, Deepest, Partial, State};
use super::time_step::Stiffness;
use crate::base::triple::Triple;
use crate::law::contact::NormalLaw;
use crate::law::contact::constants::{reduced_mass, reduced_radius};
use crate::law::contact::geometry::{ClosestOnSegment, closest_on_segment};
use crate::law::damping::viscous_coefficient;
use crate::law::tangential::TangentialLaw;
use crate::strand::assembly::Assembly;
use glam::DVec3;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// A particle against another body near particle `j` of it.
#[derive(Clone, Copy)]
struct Contact<N: NormalLaw, T: TangentialLaw> {
    i: u32,
    /// First particle of the segment touched (j, j + 1), or a free particle.
    j: u32,
    /// Position on the segment, 0 at j, 1 at j + 1 [-].
    t: f64,
    /// Whether j and j + 1 are joined, so that the segment exists.
    segment: bool,
    /// Share of the contact that this one carries: ½ between wires, 1 with free spheres [-].
    share: f64,
    history: History<N, T>,
    /// Overlap at the last step [m].
    overlap: f64,
    /// Sum of the radii at the last step, less the overlap that does not count [m].
    reach: f64,
    /// Nothing can touch until [`State::travel`] has reached this [m].
    quiet_until: f64,
    action: PairForce,
    /// n × friction [N].
    twist: Triple,
    /// Lever arms of the particle and of the segment [m].
    arm: [f64; 2],
}

/// Which particles are joined to which.
struct Chains {
    wire_of: Vec<u32>,
    /// Per wire, the number of bonds within which it cannot touch itself.
    apart: Vec<u32>,
}

impl Chains {
    fn one_wire(&self, a: u32, b: u32) -> bool {
        let wire = self.wire_of[a as usize];
        wire != u32::MAX && wire == self.wire_of[b as usize]
    }

    /// Whether two particles belong to one wire and all bonds between them hold.
    fn one_piece(&self, a: u32, b: u32, state: &State) -> bool {
        let (first, last) = (a.min(b) as usize, a.max(b) as usize);
        self.one_wire(a, b) && state.whole[first..last].iter().all(|w| *w)
    }

    /// Whether segment `k` of the wire of particle `i` belongs to its own surroundings, which it never touches. A
    /// contact of a wire with itself would otherwise walk home along the wire.
    fn beside(&self, i: usize, k: usize, state: &State) -> bool {
        let apart = self.apart[self.wire_of[i] as usize] as usize;
        let between = if k < i { k + 1..i } else { i..k };
        between.len() < apart && state.whole[between].iter().all(|w| *w)
    }
}

/// Contacts between smooth wires with normal law `N` and tangential law `T`.
pub struct CapsuleContacts<N: NormalLaw, T: TangentialLaw> {
    laws: Laws<N, T>,
    chains: Chains,
    contacts: Vec<Contact<N, T>>,
    old: Vec<Contact<N, T>>,
    partial: Vec<Partial>,
    /// The deepest contact so far.
    deepest: Deepest,
    /// Directed candidates (particle, other particle), kept for their memory.
    directed: Vec<(u32, u32)>,
    /// See [`closing`].
    closing: f64,
    arch: Arch,
}

/// The contacts of one chunk. They are taken one by one, but with the instructions of the machine: the laws round as
/// these do, and without them a library function has to ([`Real::mul_add`](crate::base::lanes::Real::mul_add)).
struct Chunk<'a, N: NormalLaw, T: TangentialLaw> {
    laws: &'a Laws<N, T>,
    state: &'a State,
    chains: &'a Chains,
    deepest: Deepest,
    closing: f64,
    contacts: &'a mut [Contact<N, T>],
}

impl<N: NormalLaw, T: TangentialLaw> WithSimd for Chunk<'_, N, T> {
    type Output = Partial;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Partial {
        let mut sum = Partial::beyond(self.deepest);
        for c in self.contacts.iter_mut().filter(|c| c.quiet_until <= self.state.travel) {
            let own = capsule_pair(self.laws, self.state, self.chains, self.closing, c, &mut sum.deepest);
            sum.add(&own.scaled(c.share));
        }
        sum
    }
}

impl<N: NormalLaw, T: TangentialLaw> CapsuleContacts<N, T> {
    /// Without contacts yet.
    pub fn new(laws: Laws<N, T>, assembly: &Assembly) -> Self {
        Self {
            laws,
            chains: Chains { wire_of: assembly.wire_of.clone(), apart: apart(assembly) },
            contacts: Vec::new(),
            old: Vec::new(),
            partial: Vec::new(),
            deepest: Deepest::default(),
            directed: Vec::new(),
            closing: closing(assembly),
            arch: Arch::new(),
        }
    }

    fn free(&self, p: u32) -> bool {
        self.chains.wire_of[p as usize] == u32::MAX
    }

    /// Both directions of every pair; a wire's particle never rests on a free sphere (the sphere rests on the wire).
    fn direct(&mut self, list: &PairList) {
        self.directed.clear();
        for (i, j) in list.pairs.iter().copied() {
            match (self.free(i), self.free(j)) {
                (true, true) | (true, false) => self.directed.push((i, j)),
                (false, true) => self.directed.push((j, i)),
                (false, false) => self.directed.extend([(i, j), (j, i)]),
            }
        }
        self.directed.sort_unstable();
    }

    fn fresh(&self, i: u32, j: u32, state: &State) -> Contact<N, T> {
        let (a, b) = (state.radius0[i as usize], state.radius0[j as usize]);
        let (free_i, free_j) = (self.free(i), self.free(j));
        let mut radius = reduced_radius(a, b);
        if free_i && !free_j {
            // Sphere on a cylinder: geometric mean of the two principal relative radii.
            radius = (radius * a).sqrt();
        }
        let mut contact = Contact {
            i,
            j,
            t: 0.0,
            segment: false,
            share: if free_i || free_j { 1.0 } else { 0.5 },
            history: History::new(radius),
            overlap: 0.0,
            reach: 0.0,
            quiet_until: 0.0,
            action: PairForce::default(),
            twist: Triple::default(),
            arm: [0.0; 2],
        };
        // During a run a new pair was beyond reach until now, or a bond has just broken.
        if state.step > 0 {
            let (d, reach) = across(state, &self.chains, &mut contact);
            contact.history.offset = (reach - d.length()).max(0.0);
        }
        contact
    }

    /// One contact per particle and stretch of the other body: the nearest particle of each run of candidates. A run
    /// ends where the other wire is broken, for its two ends touch by themselves.
    fn runs(&mut self, state: &State) -> Vec<(u32, u32)> {
        let mut out: Vec<(u32, u32)> = Vec::with_capacity(self.directed.len() / 3);
        let mut last: Option<(u32, u32, f64)> = None;
        for (i, j) in self.directed.iter().copied() {
            let d = (state.x.get(i as usize) - state.x.get(j as usize)).length_squared();
            match &mut last {
                Some((li, lj, ld)) if *li == i && j - *lj <= 2 && self.chains.one_piece(*lj, j, state) => {
                    // Same run: the last entry stands for the nearest so far.
                    if d < *ld {
                        *ld = d;
                        if let Some(entry) = out.last_mut() {
                            entry.1 = j;
                        }
                    }
                    *lj = j;
                }
                _ => {
                    out.push((i, j));
                    last = Some((i, j, d));
                }
            }
        }
        out
    }

    /// Adds every contact to its three particles, in order.
    fn scatter(&self, state: &mut State) {
        for v in [&mut state.contact_force, &mut state.contact_torque] {
            v.x.fill(0.0);
            v.y.fill(0.0);
            v.z.fill(0.0);
        }
        for c in self.contacts.iter().filter(|c| c.history.touching()) {
            let (i, j) = (c.i as usize, c.j as usize);
            let force = DVec3::from(c.action.force) * c.share;
            let twist = DVec3::from(c.twist) * c.share;
            state.contact_force.add(i, force);
            state.contact_torque.add(i, twist * c.arm[0]);
            state.contact_force.add(j, -force * (1.0 - c.t));
            state.contact_torque.add(j, twist * (c.arm[1] * (1.0 - c.t)));
            if c.segment {
                state.contact_force.add(j + 1, -force * c.t);
                state.contact_torque.add(j + 1, twist * (c.arm[1] * c.t));
            }
        }
    }
}

impl<N: NormalLaw, T: TangentialLaw> Contacts for CapsuleContacts<N, T> {
    fn rebuild(&mut self, list: &PairList, state: &State) -> Partial {
        std::mem::swap(&mut self.contacts, &mut self.old);
        self.contacts.clear();
        self.direct(list);
        let mut lost = Partial::default();
        let mut from = 0;
        for (i, j) in self.runs(state) {
            while from < self.old.len() && self.old[from].i < i {
                from += 1;
            }
            // Where the segment under a contact broke, the contact is gone, and the two ends touch afresh.
            let same = |c: &Contact<N, T>| {
                let severed = c.segment && !state.whole[c.j as usize];
                !severed && (c.j == j || c.j.abs_diff(j) <= 3 && self.chains.one_piece(c.j, j, state))
            };
            let kept = (from..self.old.len())
                .take_while(|k| self.old[*k].i == i)
                .filter(|k| self.old[*k].share > 0.0 && same(&self.old[*k]))
                .min_by_key(|k| self.old[*k].j.abs_diff(j));
            match kept {
                Some(k) => {
                    // What is near may have changed: a bond broke, or the contact belongs to another segment now.
                    self.contacts.push(Contact { quiet_until: 0.0, ..self.old[k] });
                    // A share of 0 marks an old contact as taken over.
                    self.old[k].share = 0.0;
                }
                None => {
                    let fresh = self.fresh(i, j, state);
                    self.contacts.push(fresh);
                }
            }
        }
        for c in self.old.iter().filter(|c| c.share > 0.0) {
            let released = normal_energy(&self.laws, &c.history, c.overlap);
            let gone = Partial { released, friction: leave(&self.laws, &c.history), ..Default::default() };
            lost.add(&gone.scaled(c.share));
        }
        self.partial.clear();
        self.partial.resize(self.contacts.len().div_ceil(CHUNK), Partial::default());
        lost
    }

    fn compute(&mut self, state: &mut State) -> Partial {
        let (laws, shared, chains, arch) = (&self.laws, &*state, &self.chains, self.arch);
        let (deepest, closing) = (self.deepest, self.closing);
        (self.contacts.par_chunks_mut(CHUNK), self.partial.par_iter_mut()).into_par_iter().for_each(
            |(contacts, partial)| {
                *partial = arch.dispatch(Chunk { laws, state: shared, chains, deepest, closing, contacts });
            },
        );
        self.scatter(state);
        let mut sum = Partial::beyond(deepest);
        self.partial.iter().for_each(|p| sum.add(p));
        self.deepest = sum.deepest;
        sum
    }

    fn second_sides(&self) -> Option<SecondSides<'_>> {
        None
    }

    fn elastic_energy(&self, _: &State) -> f64 {
        self.contacts.iter().map(|c| c.share * elastic_energy(&self.laws, &c.history, c.overlap)).sum()
    }

    fn add_normal_forces(&self, onto: &mut [f64]) {
        for c in self.contacts.iter().filter(|c| c.history.touching()) {
            let force = c.share * c.history.normal_force;
            onto[c.i as usize] += force;
            onto[c.j as usize] += force * (1.0 - c.t);
            if c.segment {
                onto[c.j as usize + 1] += force * c.t;
            }
        }
    }

    fn active(&self) -> usize {
        self.contacts.iter().filter(|c| c.history.touching()).count()
    }

    fn candidates(&self) -> usize {
        self.contacts.len()
    }

    fn stiffness(&self, state: &State, horizon: f64, out: &mut Stiffness) {
        for c in self.contacts.iter().filter(|c| c.history.touching()) {
            let mut c = *c;
            let point = walk(state, &self.chains, &mut c);
            let (i, j) = (c.i as usize, c.j as usize);
            let next = if c.segment { j + 1 } else { j };
            let d = point - state.x.get(i);
            let distance = d.length();
            let approach = (state.v.get(i) - state.v.get(j).lerp(state.v.get(next), c.t)).dot(d) / distance;
            let radius = state.radius[j] * (1.0 - c.t) + state.radius[next] * c.t;
            let overlap = state.radius[i] + radius - c.history.offset - distance;
            let Some(k) = foreseen_stiffness(&self.laws, &c.history, overlap, approach, horizon) else { continue };
            let viscosity = viscous_coefficient(self.laws.damping, mass_of(state, &c), k[0]) * c.share;
            let arm = [state.radius[i], radius];
            out.contact([c.i, c.j, next as u32], c.t, k.map(|k| k * c.share), arm, viscosity);
        }
    }

    fn bytes(&self, particles: usize) -> Bytes {
        let lists = behind(&self.chains.wire_of) + behind(&self.directed) + behind(&self.partial);
        // x, v, ω, radius and mass in; force and torque cleared, and added to.
        let per_particle = 3 * VECTOR + 2 * NUMBER + 6 * VECTOR;
        Bytes {
            kept: behind(&self.contacts) + behind(&self.old) + lists,
            // Records in and out, and in again to be added up.
            moved: 3 * size_of_val(&self.contacts[..]) + particles * per_particle,
        }
    }
}

fn mass_of<N: NormalLaw, T: TangentialLaw>(state: &State, c: &Contact<N, T>) -> f64 {
    let (j, next) = (c.j as usize, c.j as usize + usize::from(c.segment));
    // A segment weighs what its point does, from whichever end one counts: the last particle of a wire has half a mass.
    let (a, b) = (state.mass[c.i as usize], state.mass[j] * (1.0 - c.t) + state.mass[next] * c.t);
    reduced_mass(a, b)
}

/// Lets the contact walk along the other body until its nearest point lies on the segment (j, j + 1), and returns that
/// point. Where two segments meet on the outside of a bend the particle between them is nearest; at the end of a piece
/// its last particle is.
#[inline(always)]
fn walk<N: NormalLaw, T: TangentialLaw>(state: &State, chains: &Chains, c: &mut Contact<N, T>) -> DVec3 {
    let p = state.x.get(c.i as usize);
    let (i, own) = (c.i as usize, chains.one_wire(c.i, c.j));
    let segment = |k: usize| {
        let exists = state.whole.get(k).is_some_and(|whole| *whole) && !(own && chains.beside(i, k, state));
        exists.then(|| closest_on_segment(p, state.x.get(k), state.x.get(k + 1)))
    };
    // A step moves a contact by far less than a segment; after a search it may be two away.
    for _ in 0..4 {
        let j = c.j as usize;
        let before = || j.checked_sub(1).and_then(segment);
        let at_particle = |c: &mut Contact<N, T>, j: usize| {
            (c.j, c.t, c.segment) = (j as u32, 0.0, segment(j).is_some());
            state.x.get(j)
        };
        match segment(j) {
            Some(here) if here.raw > 1.0 => match segment(j + 1) {
                Some(next) if next.raw > 0.0 => c.j += 1,
                _ => return at_particle(c, j + 1),
            },
            Some(here) if here.raw >= 0.0 => {
                // On the inside of a bend two segments have a foot; the nearer one counts, or the overlap would jump.
                let other = if here.raw > 0.5 { segment(j + 1) } else { before() };
                let nearer =
                    |o: &ClosestOnSegment| o.raw == o.t && p.distance_squared(o.point) < p.distance_squared(here.point);
                let Some(other) = other.filter(nearer) else {
                    (c.t, c.segment) = (here.raw, true);
                    return here.point;
                };
                (c.j, c.t, c.segment) = (if here.raw > 0.5 { c.j + 1 } else { c.j - 1 }, other.raw, true);
                return other.point;
            }
            _ => match before() {
                Some(last) if last.raw < 1.0 => c.j -= 1,
                _ => return at_particle(c, j),
            },
        }
    }
    let j = c.j as usize;
    match segment(j) {
        Some(here) => {
            (c.t, c.segment) = (here.raw.clamp(0.0, 1.0), true);
            here.point
        }
        None => {
            (c.t, c.segment) = (0.0, false);
            state.x.get(j)
        }
    }
}

/// Vector from the particle to the nearest point of the other body, and the distance at which they touch [m].
#[inline(always)]
fn across<N: NormalLaw, T: TangentialLaw>(state: &State, chains: &Chains, c: &mut Contact<N, T>) -> (DVec3, f64) {
    let point = walk(state, chains, c);
    let (i, j) = (c.i as usize, c.j as usize);
    let next = if c.segment { j + 1 } else { j };
    let radius = state.radius[j] * (1.0 - c.t) + state.radius[next] * c.t;
    (point - state.x.get(i), state.radius[i] + radius)
}

/// Kinematics and response of one contact; the energies are those of its whole.
#[inline(always)]
fn capsule_pair<N: NormalLaw, T: TangentialLaw>(
    laws: &Laws<N, T>,
    state: &State,
    chains: &Chains,
    closing: f64,
    c: &mut Contact<N, T>,
    deepest: &mut Deepest,
) -> Partial {
    let (d, touching) = across(state, chains, c);
    let (i, j) = (c.i as usize, c.j as usize);
    let next = if c.segment { j + 1 } else { j };
    let reach = touching - c.history.offset;
    let distance2 = d.length_squared();
    let apart = distance2 >= reach * reach;
    if apart && c.history.offset > 0.0 {
        c.history.offset = c.history.offset.min((touching - distance2.sqrt()).max(0.0));
    }
    let distance = distance2.sqrt();
    if apart && !c.history.touching() {
        if c.history.offset == 0.0 {
            c.quiet_until = state.travel + (distance - reach) / closing;
        }
        return Partial::default();
    }
    let normal = d * (1.0 / distance);
    c.overlap = if apart { 0.0 } else { reach - distance };
    // The arms meet where the surfaces do, so that they add up to the distance.
    let arm = state.radius[i] - 0.5 * (touching - distance);
    c.arm = [arm, distance - arm];
    let mut velocity = state.v.get(j).lerp(state.v.get(next), c.t) - state.v.get(i);
    if T::ACTIVE {
        let spin = state.w.get(j).lerp(state.w.get(next), c.t);
        velocity -= (state.w.get(i) * c.arm[0] + spin * c.arm[1]).cross(normal);
    }
    let viscosity = viscous_coefficient(laws.damping, mass_of(state, c), 1.0);
    let (overlap, thinner, dt) = (c.overlap, c.reach - reach, state.dt);
    c.reach = reach;
    let meeting = Meeting { normal: normal.into(), overlap, thinner, velocity: velocity.into(), viscosity, dt };
    let (action, given) = meet(laws, &mut c.history, &meeting);
    c.twist = Triple::from(normal).cross(action.friction);
    c.action = action;
    let least = state.radius[i].min(touching - state.radius[i]);
    deepest.meet([c.i, c.j], overlap, least, c.history.reduced_radius, c.history.normal_force);
    given.partial()
}
