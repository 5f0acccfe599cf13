//! Contact stage for smooth wires: centrelines run smoothly through the particles (`curve`), and force acts per length
//! ([`crate::law::contact::line`]).
//!
//! Of two wires one is followed particle by particle, the one with the finer spacing, or else the later one. Each of its
//! particles stands for the stretch of wire half a bond to either side. A contact is such a stretch against the other
//! wire: the gap between the two smooth centrelines is taken along the stretch as a parabola around its narrowest place,
//! and the law integrates the force over what overlaps. So wires that cross meet where they cross, whatever particles are
//! near, wires side by side share a line, and neither depends on the spacing. A contact walks along the other wire from
//! bond to bond and keeps its history.
//!
//! Distance of a point p(u) of the stretch from the other curve q(t), e = p − q with e·q' = 0 at the foot:
//! (½e²)' = e·p', (½e²)'' = e·p'' + p'² − (p'·q')²/(q'² − e·q''); for straight wires ½e² is a parabola, and Newton's method
//! finds the narrowest place in one step.
//!
//! A free sphere, or a particle that two breaks have left alone, is a ball against the nearest point of the other body.
//! The two ends of a broken bond face each other: they meet again at the distance that the bond had without stress when it
//! broke.

mod curve;
mod meeting;

use super::bytes::{Bytes, NUMBER, VECTOR, behind};
use super::contacts::{Contacts, closing};
use super::neighbours::{PairList, apart};
use super::pair::{History, Laws, PairForce, foreseen_stiffness, leave};
use super::spheres::SecondSides;
use super::state::{CHUNK, Deepest, Partial, State};
use super::time_step::Stiffness;
use crate::base::triple::Triple;
use crate::law::contact::NormalLaw;
use crate::law::contact::constants::reduced_radius;
use crate::law::contact::line::{LineStiffness, patch_length};
use crate::law::damping::viscous_coefficient;
use crate::law::tangential::{TangentialInput, TangentialLaw};
use crate::strand::assembly::Assembly;
use curve::{Chains, Place, Weights};
use glam::DVec3;
use meeting::Meets;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Movement of particles moves points of a centreline by up to this [-]: the weights of a cubic, or of a quartic near an
/// end of the wire.
const SPREAD: f64 = 2.2;

/// What meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// A stretch of wire against a wire.
    Stretch,
    /// A ball against a body.
    Ball,
    /// The two ends of a broken bond.
    Ends,
}

/// Particle `i` against another body near `place` of it.
#[derive(Clone, Copy)]
struct Contact<N: NormalLaw, T: TangentialLaw> {
    i: u32,
    kind: Kind,
    /// Taken over by the next list.
    taken: bool,
    /// Two pieces of one wire, one of which has not yet passed the end of the other.
    end_to_end: bool,
    place: Place,
    history: History<N, T>,
    /// Overlap at the last step, at its deepest [m].
    overlap: f64,
    /// Sum of the radii at the last step, less the overlap that does not count [m].
    reach: f64,
    /// Length of a stretch [m], and curvature of its gap [1/m], at the last step.
    length: f64,
    curvature: f64,
    /// Elastic energy of the normal force [J].
    energy: f64,
    /// Nothing can touch until [`State::travel`] has reached this [m].
    quiet_until: f64,
    action: PairForce,
    /// n × friction [N].
    twist: Triple,
    /// Lever arms of the two sides [m].
    arm: [f64; 2],
    /// Where the force acts on the two sides.
    near: Weights<5>,
    far: Weights<4>,
}

/// Contacts between smooth wires with normal law `N` and tangential law `T`.
pub struct WireContacts<N: NormalLaw, T: TangentialLaw> {
    laws: Laws<N, T>,
    line: LineStiffness,
    chains: Chains,
    /// Spacing of each wire [m].
    spacing: Vec<f64>,
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
    meets: Meets<'a, N, T>,
    deepest: Deepest,
    contacts: &'a mut [Contact<N, T>],
}

impl<N: NormalLaw, T: TangentialLaw> WithSimd for Chunk<'_, N, T> {
    type Output = Partial;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Partial {
        let (mut sum, mut deepest) = (Partial::default(), self.deepest);
        for c in self.contacts.iter_mut().filter(|c| c.quiet_until <= self.meets.state.travel) {
            sum.add(&self.meets.contact(c, &mut deepest));
        }
        Partial { deepest, ..sum }
    }
}

impl<N: NormalLaw, T: TangentialLaw> WireContacts<N, T> {
    /// Without contacts yet.
    pub fn new(laws: Laws<N, T>, assembly: &Assembly) -> Self {
        Self {
            laws,
            line: LineStiffness::default(),
            chains: Chains::new(assembly, apart(assembly)),
            spacing: assembly.wires.iter().map(|w| assembly.rest_length[w.first]).collect(),
            contacts: Vec::new(),
            old: Vec::new(),
            partial: Vec::new(),
            deepest: Deepest::default(),
            directed: Vec::new(),
            closing: SPREAD * closing(assembly),
            arch: Arch::new(),
        }
    }

    /// Whether `i` is followed along `j`, or the other way round: a ball before a wire, the finer spacing before the
    /// coarser one, the later before the earlier.
    fn follows(&self, i: u32, j: u32, state: &State) -> bool {
        let alone = [i, j].map(|p| self.chains.alone(p as usize, state));
        if alone[0] != alone[1] {
            return alone[0];
        }
        let spacing = |p: u32| self.spacing.get(self.chains.wire_of[p as usize] as usize).copied().unwrap_or(0.0);
        let (a, b) = (spacing(i), spacing(j));
        // Wires of one spacing have lengths that differ by rounding.
        if (a - b).abs() < 1e-9 * a { i > j } else { a < b }
    }

    /// The pairs, each with the particle that is followed first.
    fn direct(&mut self, list: &PairList, state: &State) {
        let mut directed = std::mem::take(&mut self.directed);
        directed.clear();
        directed.extend(list.pairs.iter().map(|(i, j)| if self.follows(*i, *j, state) { (*i, *j) } else { (*j, *i) }));
        directed.sort_unstable();
        self.directed = directed;
    }

    fn fresh(&self, i: u32, j: u32, kind: Kind, state: &State) -> Contact<N, T> {
        let [a, b] = [i, j].map(|p| state.radius0[p as usize]);
        let mut radius = reduced_radius(a, b);
        if kind == Kind::Ball && !self.chains.alone(j as usize, state) {
            // Sphere on a cylinder: geometric mean of the two principal relative radii.
            radius = (radius * a).sqrt();
        }
        let end_to_end = kind == Kind::Stretch && self.end_to_end(i, j, state);
        let mut contact = Contact {
            i,
            kind,
            taken: false,
            end_to_end,
            place: Place { j, t: 0.0, joined: false },
            history: History::new(radius),
            overlap: 0.0,
            reach: 0.0,
            length: 0.0,
            curvature: 0.0,
            energy: 0.0,
            quiet_until: 0.0,
            action: PairForce::default(),
            twist: Triple::default(),
            arm: [0.0; 2],
            near: Weights::default(),
            far: Weights::default(),
        };
        // During a run a new pair was beyond reach until now, or a bond has just broken.
        if state.step > 0 && kind != Kind::Ends && !end_to_end {
            contact.history.offset = self.meets(state).overlap(&mut contact).max(0.0);
        }
        contact
    }

    /// Whether two particles of one wire are near to a break between them.
    fn end_to_end(&self, i: u32, j: u32, state: &State) -> bool {
        let near = || i.abs_diff(j) <= self.chains.apart[self.chains.wire_of[i as usize] as usize] + 2;
        self.chains.one_wire(i, j) && near() && !self.chains.one_piece(i, j, state)
    }

    fn meets<'a>(&'a self, state: &'a State) -> Meets<'a, N, T> {
        Meets { laws: &self.laws, line: &self.line, state, chains: &self.chains, closing: self.closing }
    }

    /// One contact per particle and stretch of the other body: the nearest particle of each run of candidates. A run
    /// ends where the other wire is broken, for its two ends touch by themselves. Broken bonds have a contact of their
    /// own.
    fn runs(&mut self, state: &State) -> Vec<(u32, Kind, u32)> {
        let mut out: Vec<(u32, Kind, u32)> = Vec::with_capacity(self.directed.len() / 3);
        let mut last: Option<(u32, u32, f64)> = None;
        for (i, j) in self.directed.iter().copied() {
            let d = (state.x.get(i as usize) - state.x.get(j as usize)).length_squared();
            match &mut last {
                Some((li, lj, ld)) if *li == i && j - *lj <= 2 && self.chains.one_piece(*lj, j, state) => {
                    // Same run: the last entry stands for the nearest so far.
                    if d < *ld {
                        *ld = d;
                        if let Some(entry) = out.last_mut() {
                            entry.2 = j;
                        }
                    }
                    *lj = j;
                }
                _ => {
                    let kind = if self.chains.alone(i as usize, state) { Kind::Ball } else { Kind::Stretch };
                    out.push((i, kind, j));
                    last = Some((i, j, d));
                }
            }
        }
        // What two breaks have left alone meets its own wire again by the ends of its bonds.
        out.retain(|(i, kind, j)| *kind != Kind::Ball || !self.end_to_end(*i, *j, state));
        out.extend(self.chains.broken(state).map(|slot| (slot as u32, Kind::Ends, slot as u32 + 1)));
        out.sort_unstable();
        out
    }

    /// Adds every contact to the particles that it acts on, in order.
    fn scatter(&self, state: &mut State) {
        for v in [&mut state.contact_force, &mut state.contact_torque] {
            v.x.fill(0.0);
            v.y.fill(0.0);
            v.z.fill(0.0);
        }
        for c in self.contacts.iter().filter(|c| c.history.touching()) {
            let (force, twist) = (DVec3::from(c.action.force), DVec3::from(c.twist));
            for (node, share) in c.near.nodes.into_iter().zip(c.near.shares) {
                state.contact_force.add(node as usize, force * share);
            }
            for (node, share) in c.far.nodes.into_iter().zip(c.far.shares) {
                state.contact_force.add(node as usize, force * -share);
            }
            if T::ACTIVE {
                state.contact_torque.add(c.i as usize, twist * c.arm[0]);
                for (node, share) in c.place.linear() {
                    state.contact_torque.add(node, twist * (c.arm[1] * share));
                }
            }
        }
    }
}

impl<N: NormalLaw, T: TangentialLaw> Contacts for WireContacts<N, T> {
    fn rebuild(&mut self, list: &PairList, state: &State) -> Partial {
        std::mem::swap(&mut self.contacts, &mut self.old);
        self.contacts.clear();
        self.direct(list, state);
        let mut lost = Partial::default();
        let mut from = 0;
        for (i, kind, j) in self.runs(state) {
            while from < self.old.len() && self.old[from].i < i {
                from += 1;
            }
            // Where the bond under a contact broke, the contact is gone, and the two ends touch afresh.
            let same = |c: &Contact<N, T>| {
                let at = c.place.j;
                let severed = c.place.joined && !state.whole[at as usize];
                !severed && (at == j || at.abs_diff(j) <= 3 && self.chains.one_piece(at, j, state))
            };
            let kept = (from..self.old.len())
                .take_while(|k| self.old[*k].i == i)
                .filter(|k| self.old[*k].kind == kind && !self.old[*k].taken && same(&self.old[*k]))
                .min_by_key(|k| self.old[*k].place.j.abs_diff(j));
            match kept {
                Some(k) => {
                    // What is near may have changed: a bond broke, or the contact belongs to another bond now.
                    self.contacts.push(Contact { quiet_until: 0.0, ..self.old[k] });
                    self.old[k].taken = true;
                }
                None => {
                    let fresh = self.fresh(i, j, kind, state);
                    self.contacts.push(fresh);
                }
            }
        }
        for c in self.old.iter().filter(|c| !c.taken && c.history.touching()) {
            lost.add(&Partial { released: c.energy, friction: leave(&self.laws, &c.history), ..Default::default() });
        }
        self.partial.clear();
        self.partial.resize(self.contacts.len().div_ceil(CHUNK), Partial::default());
        lost
    }

    fn compute(&mut self, state: &mut State) -> Partial {
        let Self { laws, line, chains, closing, arch, deepest, contacts, partial, .. } = self;
        let (arch, before) = (*arch, *deepest);
        let meets = Meets { laws, line, state: &*state, chains, closing: *closing };
        (contacts.par_chunks_mut(CHUNK), partial.par_iter_mut()).into_par_iter().for_each(|(contacts, partial)| {
            *partial = arch.dispatch(Chunk { meets, deepest: before, contacts });
        });
        self.scatter(state);
        let mut sum = Partial::beyond(before);
        self.partial.iter().for_each(|p| sum.add(p));
        self.deepest = sum.deepest;
        sum
    }

    fn second_sides(&self) -> Option<SecondSides<'_>> {
        None
    }

    fn elastic_energy(&self, _: &State) -> f64 {
        let touching = self.contacts.iter().filter(|c| c.history.touching());
        touching.map(|c| c.energy + leave(&self.laws, &c.history)).sum()
    }

    fn add_normal_forces(&self, onto: &mut [f64]) {
        for c in self.contacts.iter().filter(|c| c.history.touching()) {
            onto[c.i as usize] += c.history.normal_force;
            for (node, share) in c.place.linear() {
                onto[node] += c.history.normal_force * share;
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
        let meets = self.meets(state);
        for c in self.contacts.iter().filter(|c| c.history.touching()) {
            let normal = c.far.mean(|p| state.x.get(p)) - c.near.mean(|p| state.x.get(p));
            let speed = c.near.mean(|p| state.v.get(p)) - c.far.mean(|p| state.v.get(p));
            let approach = speed.dot(normal) / normal.length();
            let known = match c.kind {
                Kind::Stretch => Some(self.foreseen(c, approach.max(0.0) * horizon)),
                _ => foreseen_stiffness(&self.laws, &c.history, c.overlap, approach, horizon),
            };
            let Some(k) = known else { continue };
            let viscosity = viscous_coefficient(self.laws.damping, meets.mass(c), k[0]);
            let [b0, b1, b2, b3] = c.far.shares.map(f64::abs);
            // What the outer particles of the two curves take is counted for those next to them, which weigh the same.
            let next = c.place.j + u32::from(c.place.joined);
            out.contact([c.i, c.place.j, next], [c.near.sum(), b0 + b1, b2 + b3], k, c.arm, viscosity);
        }
    }

    fn bytes(&self, particles: usize) -> Bytes {
        let lists = self.chains.bytes() + behind(&self.directed) + behind(&self.partial);
        // x, v, ω, radius and mass in; force and torque cleared, and added to.
        let per_particle = 3 * VECTOR + 2 * NUMBER + 6 * VECTOR;
        Bytes {
            kept: behind(&self.contacts) + behind(&self.old) + lists,
            // Records in and out, and in again to be added up.
            moved: 3 * size_of_val(&self.contacts[..]) + particles * per_particle,
        }
    }
}

impl<N: NormalLaw, T: TangentialLaw> WireContacts<N, T> {
    /// Normal and tangential stiffness of a stretch that comes nearer by `closer` [m], in [N/m].
    fn foreseen(&self, c: &Contact<N, T>, closer: f64) -> [f64; 2] {
        let modulus = self.laws.normal.effective_modulus();
        let per_length = modulus * self.line.at(c.history.reduced_radius, c.curvature);
        let normal = per_length * patch_length(c.overlap + closer, c.curvature, c.length);
        let mut across = 0.0;
        if T::ACTIVE {
            let mut tangential = c.history.tangential;
            let input = TangentialInput::at_rest(c.history.normal_force, normal / (2.0 * modulus));
            across = self.laws.tangential.response(&mut tangential, &input).stiffness;
        }
        [normal, across]
    }
}
