//! Contact stage for smooth wires: centrelines run smoothly through the particles (`curve`), and force acts per length
//! ([`crate::law::contact::line`]).
//!
//! Of two wires one is followed particle by particle, the one with the finer spacing, or else the later one. Each of its
//! particles stands for the stretch of wire half a bond to either side. A contact is such a stretch against the other
//! wire; it walks along the other wire from bond to bond and keeps its history.
//!
//! Where wires lie side by side (`beside`), the gap is expanded to the second order along the stretch, whose cells push
//! each by itself. Where they cross so steeply that cells would not resolve the patch in which they touch, the law
//! integrates over a patch around the narrowest place (`meeting`): Hertz's ellipse, whatever particles are near. Both are
//! one force per length, and neither depends on the spacing. Which of the two holds is said by the angle when a list of
//! candidates is made and nothing has touched yet.
//!
//! Distance of a point p(u) of the stretch from the other curve q(t), e = p − q with e·q' = 0 at the foot:
//! (½e²)' = e·p', (½e²)'' = e·p'' + p'² − (p'·q')²/(q'² − e·q''); for straight wires ½e² is a parabola, and Newton's method
//! finds the narrowest place in one step.
//!
//! A free sphere, or a particle that two breaks have left alone, is a ball against the nearest point of the other body.
//! The two ends of a broken bond face each other: they meet again at the distance that the bond had without stress when it
//! broke.

mod batch;
mod beside;
mod chains;
mod chunk;
mod curve;
mod meeting;
mod record;
mod spread;

use super::pair::{History, Laws, foreseen_stiffness, leave};
use super::spheres::second::SecondSides;
use super::stage::{Contacts, closing};
use crate::engine::bytes::{Bytes, NUMBER, VECTOR, behind};
use crate::engine::neighbours::{PairList, apart};
use crate::engine::state::{CHUNK, ChunkSums, Deepest, State};
use crate::engine::time_step::Stiffness;
use crate::law::contact::NormalLaw;
use crate::law::contact::constants::{reduced_mass, reduced_radius};
use crate::law::contact::line::{CELLS, LineStiffness, patch_length};
use crate::law::damping::viscous_coefficient;
use crate::law::tangential::{TangentialInput, TangentialLaw};
use crate::strand::assembly::Assembly;
use chains::Chains;
use chunk::{Chunk, Work};
use curve::{Around, Place};
use meeting::Meets;
use pulp::Arch;
use rayon::prelude::*;
use record::{Contact, Kind, Mode};
use spread::{FarSum, NearSum, Spread};

/// Movement of particles moves points of a centreline by up to this (-): the weights of a cubic, or of a quartic near an
/// end of the wire.
const SPREAD: f64 = 2.2;

/// Cells of a stretch beside another wire must be this much shorter than the patch in which wires touch that cross: the
/// sine of the angle times the length of a stretch, over the sum of the radii (-). Below, a patch 1 % of the radius deep
/// has some ten cells.
const RESOLVED: f64 = 0.25;

/// Contacts between smooth wires with normal law `N` and tangential law `T`.
pub struct WireContacts<N: NormalLaw, T: TangentialLaw> {
    laws: Laws<N, T>,
    line: LineStiffness,
    chains: Chains,
    /// Spacing of each wire (m).
    spacing: Vec<f64>,
    contacts: Vec<Contact<N, T>>,
    old: Vec<Contact<N, T>>,
    /// Per chunk of particles the first of its contacts, and their number at the end.
    starts: Vec<usize>,
    /// That of each contact.
    quiet_until: Vec<f64>,
    spread: Spread,
    work: Vec<Work>,
    partial: Vec<ChunkSums>,
    /// The deepest contact so far.
    deepest: Deepest,
    /// Directed candidates (particle, other particle), kept for their memory.
    directed: Vec<(u32, u32)>,
    /// See [`closing`].
    closing: f64,
    arch: Arch,
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
            starts: Vec::new(),
            quiet_until: Vec::new(),
            spread: Spread::default(),
            work: Vec::new(),
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
        let rest = self.spacing.get(self.chains.wire_of[i as usize] as usize).copied().unwrap_or(0.0);
        let [low, high] = self.chains.reach(i as usize);
        let mut contact = Contact {
            quiet_until: 0.0,
            i,
            kind,
            taken: false,
            end_to_end,
            mode: Mode::Point,
            edge: false,
            place: Place { j, t: 0.0, joined: false },
            history: History::new(radius),
            dents: [0.0; CELLS],
            shares: [1.0; CELLS],
            cell_length: (high - low) / CELLS as f64 * rest,
            per_length: 0.0,
            viscosity: 0.0,
            overlap: 0.0,
            reach: 0.0,
            length: 0.0,
            curvature: 0.0,
            energy: 0.0,
            u: 0.0,
            arm: [0.0; 2],
        };
        self.place(&mut contact, state);
        // During a run a new pair was beyond reach until now, or a bond has just broken.
        if state.step > 0 && kind != Kind::Ends && !end_to_end {
            contact.history.offset = self.meets(state).overlap(&mut contact).max(0.0);
        }
        contact
    }

    /// What a new list means for a contact, its mode while it has never touched.
    fn place(&self, c: &mut Contact<N, T>, state: &State) {
        let meets = self.meets(state);
        if c.kind == Kind::Stretch {
            let crossing = meets.crosses(c, RESOLVED);
            if c.history.normal_force == 0.0 && c.dents == [0.0; CELLS] {
                c.mode = if crossing { Mode::Point } else { Mode::Line };
            }
        }
        c.edge =
            c.kind != Kind::Stretch || c.end_to_end || !c.place.joined || self.chains.near_end(c.i, c.place.j, state);
        let mass = reduced_mass(state.mass[c.i as usize], c.place.between(&state.mass));
        c.viscosity = viscous_coefficient(self.laws.damping, mass, 1.0);
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
}

impl<N: NormalLaw, T: TangentialLaw> Contacts for WireContacts<N, T> {
    fn rebuild(&mut self, list: &PairList, state: &State) -> ChunkSums {
        std::mem::swap(&mut self.contacts, &mut self.old);
        self.contacts.clear();
        self.direct(list, state);
        let mut lost = ChunkSums::default();
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
                    self.old[k].taken = true;
                    let mut kept = Contact { taken: false, quiet_until: 0.0, ..self.old[k] };
                    self.place(&mut kept, state);
                    self.contacts.push(kept);
                }
                None => {
                    let fresh = self.fresh(i, j, kind, state);
                    self.contacts.push(fresh);
                }
            }
        }
        for c in self.old.iter().filter(|c| !c.taken && c.history.touching()) {
            lost.add(&ChunkSums { released: c.energy, friction: leave(&self.laws, &c.history), ..Default::default() });
        }
        let chunks = state.len().div_ceil(CHUNK);
        let contacts = &self.contacts;
        self.starts.clear();
        self.starts.extend((0..=chunks).map(|chunk| contacts.partition_point(|c| (c.i as usize) < chunk * CHUNK)));
        // What is near may have changed: a bond broke, or a contact belongs to another bond now.
        self.quiet_until.clear();
        self.quiet_until.resize(contacts.len(), 0.0);
        self.spread.resize(state.len());
        self.work.resize_with(chunks, Work::default);
        self.partial.clear();
        self.partial.resize(chunks, ChunkSums::default());
        lost
    }

    fn compute(&mut self, state: &mut State) -> ChunkSums {
        let Self {
            laws,
            line,
            chains,
            closing,
            arch,
            deepest,
            contacts,
            starts,
            quiet_until,
            spread,
            work,
            partial,
            ..
        } = self;
        let (arch, before) = (*arch, *deepest);
        let meets = Meets { laws, line, state: &*state, chains, closing: *closing };
        let mut tasks = Vec::with_capacity(partial.len());
        let (mut contacts, mut quiet) = (&mut contacts[..], &mut quiet_until[..]);
        for (chunk, (near, work)) in spread.near.chunks_mut(CHUNK).zip(&mut *work).enumerate() {
            let count = starts[chunk + 1] - starts[chunk];
            let (own, others) = contacts.split_at_mut(count);
            let (quiet_until, other_quiet) = quiet.split_at_mut(count);
            (contacts, quiet) = (others, other_quiet);
            let (first, sum) = (chunk * CHUNK, ChunkSums::beyond(before));
            tasks.push(Chunk { meets, arch, first, contacts: own, quiet_until, near, sum, work });
        }
        (tasks, &mut *partial).into_par_iter().for_each(|(task, partial)| *partial = task.compute());
        let acting: Vec<&[FarSum]> = work.iter().map(|work| &work.acting[..]).collect();
        spread.finish(&acting, chains, state, T::ACTIVE);
        let mut sum = ChunkSums::beyond(before);
        partial.iter().for_each(|p| sum.add(p));
        *deepest = sum.deepest;
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
        for c in self.contacts.iter().filter(|c| c.history.touching()) {
            let (near, far) =
                (Around::new(&state.x, state, &self.chains, c.i as usize).weights(c.u), c.place.weights(state));
            let normal = far.mean(|p| state.x.get(p)) - near.mean(|p| state.x.get(p));
            let speed = near.mean(|p| state.v.get(p)) - far.mean(|p| state.v.get(p));
            let approach = speed.dot(normal) / normal.length();
            let known = match c.kind {
                Kind::Stretch => Some(self.foreseen(c, approach.max(0.0) * horizon)),
                _ => foreseen_stiffness(&self.laws, &c.history, c.overlap, approach, horizon),
            };
            let Some(k) = known else { continue };
            let viscosity = c.viscosity * k[0].sqrt();
            let [b0, b1, b2, b3] = far.shares.map(f64::abs);
            // What the outer particles of the two curves take is counted for those next to them, which weigh the same.
            let next = c.place.j + u32::from(c.place.joined);
            out.contact([c.i, c.place.j, next], [near.sum(), b0 + b1, b2 + b3], k, c.arm, viscosity);
        }
    }

    fn bytes(&self, particles: usize) -> Bytes {
        let lists = self.chains.bytes() + behind(&self.directed) + behind(&self.partial) + self.spread.bytes();
        // x, v, ω and radius in; sums out and in; force and torque out.
        let per_particle = 3 * VECTOR + NUMBER + 2 * (size_of::<NearSum>() + size_of::<FarSum>()) + 2 * VECTOR;
        Bytes {
            kept: behind(&self.contacts)
                + behind(&self.old)
                + behind(&self.quiet_until)
                + self.work.iter().map(|work| size_of::<Work>() + behind(&work.acting)).sum::<usize>()
                + lists,
            // Records in and out; what they do to the other side out and in.
            moved: 2
                * (size_of_val(&self.contacts[..])
                    + self.work.iter().map(|work| size_of_val(&work.acting[..])).sum::<usize>())
                + particles * per_particle,
        }
    }
}

impl<N: NormalLaw, T: TangentialLaw> WireContacts<N, T> {
    /// Normal and tangential stiffness of a stretch that comes nearer by `closer` (m), in (N/m).
    fn foreseen(&self, c: &Contact<N, T>, closer: f64) -> [f64; 2] {
        let modulus = self.laws.normal.effective_modulus();
        let normal = c.per_length * patch_length(c.overlap + closer, c.curvature, c.length);
        let mut across = 0.0;
        if T::ACTIVE {
            let mut tangential = c.history.tangential;
            let input = TangentialInput::at_rest(c.history.normal_force, normal / (2.0 * modulus));
            across = self.laws.tangential.response(&mut tangential, &input).stiffness;
        }
        [normal, across]
    }
}
