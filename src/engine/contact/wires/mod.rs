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
pub(super) mod chains;
mod chunk;
pub(super) mod curve;
mod meeting;
mod record;
mod spread;
mod store;

use super::law_table::LawTable;
use super::pair::{Laws, foreseen_stiffness, leave, touch};
use super::spheres::second::SecondSides;
use super::stage::{Contacts, Elsewhere, closing};
use crate::engine::bytes::{Bytes, NUMBER, VECTOR, behind};
use crate::engine::neighbours::{PairList, apart};
use crate::engine::saved::{Reader, Unfit, Writer};
use crate::engine::state::{CHUNK, ChunkSums, Deepest, State};
use crate::engine::team::Team;
use crate::engine::time_step::Element;
use crate::engine::view::Touch;
use crate::law::contact::NormalLaw;
use crate::law::contact::constants::reduced_radius;
use crate::law::contact::line::{CELLS, LineStiffness, patch_length};
use crate::law::damping::{HERTZIAN, viscous_coefficient};
use crate::law::tangential::{TangentialInput, TangentialLaw};
use crate::strand::assembly::Assembly;
use chains::Chains;
use chunk::Chunk;
use curve::{Around, Place, Weights};
use glam::DVec3;
use meeting::Meets;
use pulp::Arch;
use record::{Contact, Kind, Mode};
use spread::{FarSum, NearSum, Spread};
use store::{Candidate, Store};

/// Movement of particles moves points of a centreline by up to this (-): the weights of a cubic, or of a quartic near an
/// end of the wire.
pub(super) const SPREAD: f64 = 2.2;

/// Cells of a stretch beside another wire must be this much shorter than the patch in which wires touch that cross: the
/// sine of the angle times the length of a stretch, over the sum of the radii (-). Below, a patch 1 % of the radius deep
/// has some ten cells.
const RESOLVED: f64 = 0.25;

/// Contacts between smooth wires with normal law `N` and tangential law `T`.
pub struct WireContacts<N: NormalLaw, T: TangentialLaw> {
    laws: LawTable<N, T>,
    line: LineStiffness,
    chains: Chains,
    /// Per chunk of particles.
    stores: Vec<Store<N, T>>,
    spread: Spread,
    /// The deepest contact so far.
    deepest: Deepest,
    /// See [`closing`].
    closing: f64,
    arch: Arch,
}

impl<N: NormalLaw, T: TangentialLaw> WireContacts<N, T> {
    /// Without contacts yet.
    pub fn new(laws: LawTable<N, T>, assembly: &Assembly) -> Self {
        Self {
            laws,
            line: LineStiffness::default(),
            chains: Chains::new(assembly, apart(assembly)),
            stores: Vec::new(),
            spread: Spread::default(),
            deepest: Deepest::default(),
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
        let [a, b] = [i, j].map(|p| self.chains.spacing(p as usize));
        // Wires of one spacing have lengths that differ by rounding.
        if (a - b).abs() < 1e-9 * a { i > j } else { a < b }
    }

    /// The pairs, each with the particle that is followed first, sorted.
    fn directed(&self, list: &PairList, state: &State) -> Vec<(u32, u32)> {
        let direct = |(i, j): &(u32, u32)| if self.follows(*i, *j, state) { (*i, *j) } else { (*j, *i) };
        let mut directed: Vec<(u32, u32)> = list.pairs.iter().map(direct).collect();
        directed.sort_unstable();
        directed
    }

    fn fresh(&self, i: u32, j: u32, kind: Kind, state: &State) -> Contact<N, T> {
        let [a, b] = [i, j].map(|p| state.radius0[p as usize]);
        let mut radius = reduced_radius(a, b);
        if kind == Kind::Ball && !self.chains.alone(j as usize, state) {
            // Sphere on a cylinder: geometric mean of the two principal relative radii.
            radius = (radius * a).sqrt();
        }
        let end_to_end = kind == Kind::Stretch && self.end_to_end(i, j, state);
        let place = Place { j, t: 0.0, joined: false };
        let mut contact =
            Contact { end_to_end, ..Contact::untouched(i, place, kind, radius, self.chains.cell_length(i as usize)) };
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
        let (i, j) = (c.i as usize, c.place.j as usize);
        // The two particles of a bond are mostly held both or neither.
        let fixed = [state.fixed[i], state.fixed[j] & state.fixed[j + usize::from(c.place.joined)]];
        let mass = self.laws.damped_mass([state.mass[i], c.place.between(&state.mass)], fixed);
        // Side by side the stiffness is constant, elsewhere Hertzian.
        let linear = self.laws.gives_restitution() && c.kind == Kind::Stretch && c.mode == Mode::Line;
        let fraction = self.laws.damping() * if linear { HERTZIAN } else { 1.0 };
        c.viscosity = viscous_coefficient(fraction, mass, 1.0);
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
    /// own. Of the candidates of one chunk.
    fn runs(&self, directed: &[(u32, u32)], chunk: usize, state: &State) -> Vec<(u32, Kind, u32)> {
        let mut out: Vec<(u32, Kind, u32)> = Vec::with_capacity(directed.len() / 3);
        let mut last: Option<(u32, u32, f64)> = None;
        for (i, j) in directed.iter().copied() {
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
        let slots = chunk * CHUNK..state.len().min((chunk + 1) * CHUNK);
        out.extend(self.chains.broken(slots, state).map(|slot| (slot as u32, Kind::Ends, slot as u32 + 1)));
        out.sort_unstable();
        out
    }

    /// The contacts of one chunk for its candidates, those that stay with what they remember in `old`; and what was lost with
    /// each of those that left.
    fn renewed(
        &self,
        directed: &[(u32, u32)],
        chunk: usize,
        old: &Store<N, T>,
        state: &State,
    ) -> (Store<N, T>, Vec<ChunkSums>) {
        let runs = self.runs(directed, chunk, state);
        let (mut store, mut taken) = (Store::like(old, runs.len()), vec![false; old.len()]);
        let mut from = 0;
        for (i, kind, j) in runs {
            while from < old.len() && old.candidates[from].i < i {
                from += 1;
            }
            // Where the bond under a contact broke, the contact is gone, and the two ends touch afresh.
            let same = |c: &Candidate| {
                let severed = c.joined && !state.whole[c.j as usize];
                !severed && (c.j == j || c.j.abs_diff(j) <= 3 && self.chains.one_piece(c.j, j, state))
            };
            let kept = (from..old.len())
                .take_while(|k| old.candidates[*k].i == i)
                .filter(|k| old.candidates[*k].kind == kind && !taken[*k] && same(&old.candidates[*k]))
                .min_by_key(|k| old.candidates[*k].j.abs_diff(j));
            match kept {
                Some(k) => {
                    taken[k] = true;
                    // What is near may have changed: a bond broke, or a contact belongs to another bond now.
                    let mut kept = Contact { quiet_until: 0.0, ..old.contact(k, &self.chains) };
                    self.place(&mut kept, state);
                    store.push(&kept);
                }
                None => store.push(&self.fresh(i, j, kind, state)),
            }
        }
        let left = (0..old.len()).filter(|k| !taken[*k] && old.touching(*k)).map(|k| old.contact(k, &self.chains));
        let lost = |c: Contact<N, T>| ChunkSums {
            released: c.energy,
            friction: leave(self.law(&c), &c.history),
            ..Default::default()
        };
        let lost = left.map(lost).collect();
        (store, lost)
    }
}

impl<N: NormalLaw, T: TangentialLaw> Contacts for WireContacts<N, T> {
    fn rebuild(&mut self, list: &PairList, state: &State, team: &Team) -> ChunkSums {
        let directed = self.directed(list, state);
        let mut stores = std::mem::take(&mut self.stores);
        stores.resize_with(state.len().div_ceil(CHUNK), Store::default);
        let from = |chunk: usize| directed.partition_point(|(i, _)| (*i as usize) < chunk * CHUNK);
        let lost = team.map(stores.iter_mut(), |chunk, store| {
            let (new, lost) = self.renewed(&directed[from(chunk)..from(chunk + 1)], chunk, store, state);
            *store = new;
            lost
        });
        self.stores = stores;
        self.spread.resize(state.len());
        let mut sum = ChunkSums::default();
        lost.iter().flatten().for_each(|lost| sum.add(lost));
        sum
    }

    fn compute(&mut self, state: &mut State, team: &Team) -> ChunkSums {
        let Self { laws, line, chains, closing, arch, deepest, stores, spread, .. } = self;
        let (arch, before) = (*arch, *deepest);
        let meets = Meets { laws, line, state: &*state, chains, closing: *closing };
        team.for_each(stores.iter_mut().zip(spread.near.chunks_mut(CHUNK)), |chunk, (store, near)| {
            Chunk { meets, arch, first: chunk * CHUNK, store, near }.compute(before);
        });
        let acting: Vec<&[FarSum]> = stores.iter().map(|store| &store.acting[..]).collect();
        spread.finish(&acting, chains, state, T::ACTIVE, team);
        let mut sum = ChunkSums::beyond(before);
        stores.iter().for_each(|store| sum.add(&store.sum));
        *deepest = sum.deepest;
        sum
    }

    fn second_sides(&self) -> Option<SecondSides<'_>> {
        None
    }

    fn elastic_energy(&self, _: &State) -> f64 {
        self.touching().map(|c| c.energy + leave(self.law(&c), &c.history)).sum()
    }

    fn add_normal_forces(&self, onto: &mut [f64]) {
        for c in self.touching() {
            onto[c.i as usize] += c.history.normal_force;
            for (node, share) in c.place.linear() {
                onto[node] += c.history.normal_force * share;
            }
        }
    }

    fn each_touch(&self, state: &State, each: &mut dyn FnMut(Touch)) {
        for c in self.touching() {
            let (near, far) = self.places(&c, state);
            let ends = [
                (near.mean(|p| state.x.get(p)), near.mean(|p| DVec3::X * state.radius[p]).x),
                (far.mean(|p| state.x.get(p)), far.mean(|p| DVec3::X * state.radius[p]).x),
            ];
            let other = c.place.linear().into_iter().next().map_or(c.i, |(node, _)| node as u32);
            let round = !matches!(c.kind, Kind::Stretch);
            let seen = touch([c.i, other], ends, c.history.normal_force, round.then_some(c.history.reduced_radius));
            let pressure = if round { seen.pressure * seen.overlap / c.overlap } else { f64::NAN };
            each(Touch { overlap: c.overlap, pressure, ..seen });
        }
    }

    fn active(&self) -> usize {
        self.stores.iter().map(Store::active).sum()
    }

    fn candidates(&self) -> usize {
        self.stores.iter().map(Store::len).sum()
    }

    fn stiffness(&self, state: &State, chunk: usize, horizon: f64) -> Vec<[f64; 2]> {
        let foreseen = |c: Contact<N, T>| {
            let (near, far) = self.places(&c, state);
            let normal = far.mean(|p| state.x.get(p)) - near.mean(|p| state.x.get(p));
            let speed = near.mean(|p| state.v.get(p)) - far.mean(|p| state.v.get(p));
            let approach = speed.dot(normal) / normal.length();
            match c.kind {
                Kind::Stretch => self.foreseen(&c, approach.max(0.0) * horizon),
                _ => foreseen_stiffness(self.law(&c), &c.history, c.overlap, approach, horizon).unwrap_or_default(),
            }
        };
        self.touching_in(chunk).map(foreseen).collect()
    }

    fn elements(&self, state: &State, chunk: usize, stiffness: &[[f64; 2]], each: &mut dyn FnMut(Element)) {
        for (c, k) in self.touching_in(chunk).zip(stiffness).filter(|(_, k)| **k != [0.0; 2]) {
            let (near, far) = self.places(&c, state);
            let viscosity = c.viscosity * k[0].sqrt();
            let [b0, b1, b2, b3] = far.shares.map(f64::abs);
            // What the outer particles of the two curves take is counted for those next to them, which weigh the same.
            let next = c.place.j + u32::from(c.place.joined);
            let weights = [near.sum(), b0 + b1, b2 + b3];
            each(Element::contact([c.i, c.place.j, next], weights, *k, c.arm, viscosity));
        }
    }

    fn save(&self, out: &mut Writer) {
        let all = |store: &'_ Store<N, T>| (0..store.len()).map(|k| store.contact(k, &self.chains)).collect::<Vec<_>>();
        let contacts: Vec<Contact<N, T>> = self.stores.iter().flat_map(all).collect();
        let quiet_until: Vec<f64> = contacts.iter().map(|c| c.quiet_until).collect();
        out.put(&contacts);
        out.put(&quiet_until);
        out.put(&self.deepest);
    }

    fn restore(&mut self, from: &mut Reader, state: &State) -> Result<(), Unfit> {
        let contacts: Vec<Contact<N, T>> = from.take()?;
        let beyond = |p: u32| p as usize >= state.len();
        if contacts.iter().any(|c| beyond(c.i) || beyond(c.place.j)) || !contacts.is_sorted_by_key(|c| c.i) {
            return Err(Unfit("its contacts are those of other particles".into()));
        }
        let mut quiet_until = vec![0.0; contacts.len()];
        from.take_into(&mut quiet_until)?;
        self.deepest = from.take()?;
        self.stores.clear();
        self.stores.resize_with(state.len().div_ceil(CHUNK), Store::default);
        for (c, quiet_until) in contacts.iter().zip(quiet_until) {
            self.stores[c.i as usize / CHUNK].push(&Contact { quiet_until, ..*c });
        }
        self.spread.resize(state.len());
        Ok(())
    }

    fn elsewhere(&self) -> Option<&dyn Elsewhere> {
        None
    }

    fn elsewhere_mut(&mut self) -> Option<&mut dyn Elsewhere> {
        None
    }

    fn look_anew(&mut self) {}

    fn bytes(&self, particles: usize) -> Bytes {
        let sizes = |size: fn(&Store<N, T>) -> usize| self.stores.iter().map(size).sum::<usize>();
        // x, v, ω and radius in; sums out and in; force and torque out.
        let per_particle = 3 * VECTOR + NUMBER + 2 * size_of::<NearSum>() + 2 * VECTOR;
        Bytes {
            kept: behind(&self.stores)
                + sizes(Store::bytes)
                + self.chains.bytes()
                + self.spread.bytes()
                + self.laws.bytes(),
            moved: sizes(Store::moved) + particles * per_particle,
        }
    }
}

impl<N: NormalLaw, T: TangentialLaw> WireContacts<N, T> {
    /// Law of a contact.
    fn law(&self, c: &Contact<N, T>) -> &Laws<N, T> {
        self.laws.between(c.i as usize, c.place.j as usize)
    }

    /// All contacts that push.
    fn touching(&self) -> impl Iterator<Item = Contact<N, T>> + '_ {
        self.stores.iter().flat_map(|store| store.all_touching(&self.chains))
    }

    /// Those of one chunk.
    fn touching_in(&self, chunk: usize) -> impl Iterator<Item = Contact<N, T>> + '_ {
        self.stores.get(chunk).into_iter().flat_map(|store| store.all_touching(&self.chains))
    }

    /// Where a contact acts: the weights of particles on its own wire and on the other.
    fn places(&self, c: &Contact<N, T>, state: &State) -> (Weights<5>, Weights<4>) {
        let around = Around::new(&state.x, state, &self.chains, c.i as usize);
        (around.weights(c.u), c.place.weights(state))
    }

    /// Normal and tangential stiffness of a stretch that comes nearer by `closer` (m), in (N/m).
    fn foreseen(&self, c: &Contact<N, T>, closer: f64) -> [f64; 2] {
        let law = self.law(c);
        let modulus = law.normal.effective_modulus();
        let normal = c.per_length * patch_length(c.overlap + closer, c.curvature, c.length);
        let mut across = 0.0;
        if T::ACTIVE {
            let mut tangential = c.history.tangential;
            let input = TangentialInput::at_rest(c.history.normal_force, normal / (2.0 * modulus));
            across = law.tangential.response(&mut tangential, &input).stiffness;
        }
        [normal, across]
    }
}
