//! Contact stage for spheres: every particle is a ball of its wire's diameter.
//!
//! Wires that touch lie side by side over many particles: where particle i meets j, i + 1 meets j + 1, and only here and
//! there a wire has gained a particle on its neighbour. So pairs are kept in diagonals, j − i constant, cut into blocks
//! of [`BLOCK`] pairs that begin at a multiple of [`BLOCK`] in i. A block needs no list of particles and no gathered
//! loads: both its sides are contiguous in memory, and 96 to 99 % of the places in the blocks of a strand are pairs.
//!
//! Blocks are ordered by the chunk of particles that their first side lies in, then by diagonal. A chunk's task adds
//! the first sides to its own particles; the second sides are left as actions, which the gathering of all forces adds
//! up ([`SecondSides`]). Each chunk has memory of its own ([`store`]).

mod block;
mod elsewhere;
mod kernel;
pub mod meeting;
pub mod second;
mod store;

use super::law_table::LawTable;
use super::pair::{History, elastic_energy, foreseen_stiffness, leave, touch};
use super::stage::{Contacts, Elsewhere, closing};
use crate::base::lanes::BLOCK;
use crate::engine::bytes::{Bytes, NUMBER, VECTOR, behind};
use crate::engine::neighbours::PairList;
use crate::engine::saved::{Reader, Unfit, Writer};
use crate::engine::shared_rows::SharedRows;
use crate::engine::state::{BondActions, CHUNK, ChunkSums, ContactSides, Deepest, RowChunks, State};
use crate::engine::team::Team;
use crate::engine::time_step::Element;
use crate::engine::view::Touch;
use crate::law::contact::NormalLaw;
use crate::law::contact::constants::reduced_radius;
use crate::law::damping::viscous_coefficient;
use crate::law::tangential::TangentialLaw;
use crate::strand::assembly::Assembly;
use block::{Block, key, order, pair};
use pulp::{Arch, Simd, WithSimd};
use second::{Places, SecondSides};
use store::Store;

/// Contacts between spheres with normal law `N` and tangential law `T`.
pub struct SphereContacts<N: NormalLaw, T: TangentialLaw> {
    laws: LawTable<N, T>,
    /// Per chunk of particles.
    stores: Vec<Store>,
    /// What does not change from search to search: a row of R* (m), 0 where no candidate is, and one of 2ξ√m* (√kg).
    constants: SharedRows,
    places: Places,
    /// The deepest contact so far.
    deepest: Deepest,
    /// See [`closing`].
    closing: f64,
    /// Wire of each particle.
    wire_of: Vec<u32>,
    /// Length of each bond slot without stress at the start (m).
    rest_length: Vec<f64>,
    arch: Arch,
}

impl<N: NormalLaw, T: TangentialLaw> SphereContacts<N, T> {
    /// Fields of a record.
    const FIELDS: usize = History::<N, T>::NUMBERS;

    /// Without contacts yet.
    pub fn new(laws: LawTable<N, T>, assembly: &Assembly) -> Self {
        Self {
            laws,
            stores: Vec::new(),
            constants: SharedRows::default(),
            places: Places::default(),
            deepest: Deepest::default(),
            closing: closing(assembly),
            wire_of: assembly.wire_of.clone(),
            rest_length: assembly.rest_length.clone(),
            arch: Arch::new(),
        }
    }

    /// The history of a pair; `radius` is its reduced radius (m).
    fn history(record: Option<&[f64]>, lane: usize, radius: f64) -> History<N, T> {
        History::of(radius, |k| record.map_or(0.0, |record| record[k * BLOCK + lane]))
    }

    /// Pairs of one chunk that touch: their reduced radius (m), their record and place in it, the two particles.
    #[inline(always)]
    fn touching_in<'a>(&'a self, store: &'a Store) -> impl Iterator<Item = Touching<'a>> + 'a {
        let records = store.blocks.iter().filter_map(|block| Some((block, store.record(block, Self::FIELDS)?)));
        records.flat_map(move |(block, record)| {
            let touches = move |lane: &usize| record[History::<N, T>::FORCE * BLOCK + lane] > 0.0;
            block.lanes().filter(touches).map(move |lane| Touching {
                reduced_radius: self.constants.rows()[block.constants as usize + lane],
                record,
                lane,
                pair: [block.i, block.j].map(|p| p as usize + lane),
            })
        })
    }

    /// All pairs that touch, with their history.
    fn touching(&self) -> impl Iterator<Item = (History<N, T>, [usize; 2])> + '_ {
        let all = self.stores.iter().flat_map(|store| self.touching_in(store));
        all.map(|touching| {
            (Self::history(Some(touching.record), touching.lane, touching.reduced_radius), touching.pair)
        })
    }

    /// Place of the law of the pair that a key stands for.
    fn law(&self, key: u64) -> u32 {
        let [i, j] = pair(key).map(|particle| particle as usize);
        self.laws.place(i, j) as u32
    }

    fn find_constants(&mut self, state: &State) {
        let Self { stores, constants, laws, .. } = self;
        constants.clear();
        for block in stores.iter_mut().flat_map(|store| &mut store.blocks) {
            let mut rows = [0.0; 2 * BLOCK];
            for lane in block.lanes() {
                let [i, j] = [block.i, block.j].map(|p| p as usize + lane);
                let mass = laws.damped_mass([state.mass[i], state.mass[j]], [state.fixed[i], state.fixed[j]]);
                rows[lane] = reduced_radius(state.radius0[i], state.radius0[j]);
                rows[BLOCK + lane] = viscous_coefficient(laws.damping(), mass, 1.0);
            }
            block.constants = constants.place(&rows);
        }
        constants.close();
    }

    /// The blocks of one chunk for the pairs of `list`, with the records of `old`, and for pairs that were not there afresh;
    /// and what friction had stored in pairs that left, block by block of the old ones (J).
    fn renewed(&self, list: &[(u32, u32)], old: &Store, state: &State) -> (Store, Vec<f64>) {
        let mut keys: Vec<u64> = list.iter().map(|(i, j)| key(*i, *j)).collect();
        if self.laws.len() > 1 {
            keys.sort_unstable_by_key(|key| order(*key, self.law(*key)));
        } else {
            keys.sort_unstable();
        }
        let mut store = Store::of(&keys, kernel::rows::<T>(), |key| self.law(key));
        let (mut lost, mut o) = (Vec::new(), 0);
        let mut leaving = |block: &Block, lanes: &mut dyn Iterator<Item = usize>| {
            let Some(record) = old.record(block, Self::FIELDS) else { return };
            let radius = |lane: usize| self.constants.rows()[block.constants as usize + lane];
            let law = self.laws.at(block.law as usize);
            lost.push(lanes.map(|lane| leave(law, &Self::history(Some(record), lane, radius(lane)))).sum());
        };
        store.remember(Self::FIELDS, kernel::rows::<T>(), |block, numbers| {
            while o < old.blocks.len() && old.blocks[o].order() < block.order() {
                leaving(&old.blocks[o], &mut old.blocks[o].lanes());
                o += 1;
            }
            let before = old.blocks.get(o).filter(|before| before.order() == block.order());
            let kept = before.map_or(0, |before| before.pairs);
            let record = before.and_then(|before| old.record(before, Self::FIELDS));
            for lane in block.lanes() {
                if kept >> lane & 1 == 0 {
                    numbers[History::<N, T>::OFFSET * BLOCK + lane] = self.offset_at_first(block, lane, state);
                } else if let Some(record) = record {
                    (0..Self::FIELDS).map(|k| k * BLOCK + lane).for_each(|at| numbers[at] = record[at]);
                }
            }
            if let Some(before) = before {
                leaving(before, &mut before.lanes().filter(|lane| block.pairs >> lane & 1 == 0));
                o += 1;
            }
        });
        old.blocks[o..].iter().for_each(|block| leaving(block, &mut block.lanes()));
        (store, lost)
    }

    /// Overlap that does not count of a pair that is new in the list (m). During a run it was beyond reach until now, or a
    /// bond has just broken.
    fn offset_at_first(&self, block: &Block, lane: usize, state: &State) -> f64 {
        let [i, j] = [block.i, block.j].map(|p| p as usize + lane);
        if state.step > 0 { self.offset(i, j, state) } else { 0.0 }
    }

    /// What hangs on the blocks of all chunks together.
    fn index(&mut self, state: &State) {
        self.find_constants(state);
        self.places.index(&self.stores, state.len());
    }

    /// Overlap that does not count between two particles that were not a pair until now (m). Across a break the two pieces
    /// meet where they parted, when the way between the two along the wire is as long as it was without stress: spheres
    /// that overlap there (spacing below 1) do not count as overlapping, and the two ends themselves, which a long bond
    /// held apart, meet before their spheres do.
    fn offset(&self, i: usize, j: usize, state: &State) -> f64 {
        let touching = state.radius[i] + state.radius[j];
        let between = i..j;
        let one_wire = self.wire_of[i] == self.wire_of[j] && self.wire_of[i] != u32::MAX;
        if !one_wire || between.clone().all(|slot| state.whole[slot]) {
            return (touching - (state.x.get(j) - state.x.get(i)).length()).max(0.0);
        }
        let natural = |slot: usize| match state.length_at_break[slot] {
            length if length > 0.0 => length,
            _ => self.rest_length[slot] / state.bond.get(slot, BondActions::THINNING).powi(2),
        };
        let way: f64 = between.map(natural).sum();
        if j == i + 1 { touching - way } else { (touching - way).max(0.0) }
    }

    /// Overlap that counts, now (m).
    fn overlap(history: &History<N, T>, state: &State, [i, j]: [usize; 2]) -> f64 {
        state.radius[i] + state.radius[j] - history.offset - (state.x.get(j) - state.x.get(i)).length()
    }
}

impl<N: NormalLaw, T: TangentialLaw> Contacts for SphereContacts<N, T> {
    fn rebuild(&mut self, list: &PairList, state: &State, team: &Team) -> ChunkSums {
        let mut stores = std::mem::take(&mut self.stores);
        stores.resize_with(state.len().div_ceil(CHUNK), Store::default);
        let from = |chunk: usize| list.pairs.partition_point(|(i, _)| (*i as usize) < chunk * CHUNK);
        let lost = team.map(stores.iter_mut(), |chunk, store| {
            let (new, lost) = self.renewed(&list.pairs[from(chunk)..from(chunk + 1)], store, state);
            *store = new;
            lost
        });
        self.stores = stores;
        self.index(state);
        let friction = lost.iter().flatten().fold(0.0, |sum, lost| sum + lost);
        ChunkSums { friction, ..ChunkSums::default() }
    }

    fn compute(&mut self, state: &mut State, team: &Team) -> ChunkSums {
        let (laws, arch, deepest, closing) = (&self.laws, self.arch, self.deepest, self.closing);
        let constants = self.constants.rows();
        let (seen, ContactSides { force, torque }) = state.split_contacts();
        let chunks = self.stores.iter_mut().zip(RowChunks::of(force).zip(RowChunks::of(torque)));
        team.for_each(chunks, |chunk, (store, (force, torque))| {
            let (first, sides) = (chunk * CHUNK, ContactSides { force, torque });
            arch.dispatch(kernel::Chunk { laws, seen: &seen, deepest, closing, constants, first, store, sides });
        });
        let mut sum = ChunkSums::beyond(deepest);
        self.stores.iter().for_each(|store| sum.add(&store.partial));
        self.deepest = sum.deepest;
        sum
    }

    fn second_sides(&self) -> Option<SecondSides<'_>> {
        Some(SecondSides { places: &self.places, stores: &self.stores, turn: T::ACTIVE })
    }

    fn elastic_energy(&self, state: &State) -> f64 {
        let stored = |(h, [i, j]): (History<N, T>, [usize; 2])| {
            elastic_energy(self.laws.between(i, j), &h, Self::overlap(&h, state, [i, j]))
        };
        self.touching().map(stored).sum()
    }

    fn add_normal_forces(&self, onto: &mut [f64]) {
        for (history, pair) in self.touching() {
            pair.into_iter().for_each(|p| onto[p] += history.normal_force);
        }
    }

    fn each_touch(&self, state: &State, each: &mut dyn FnMut(Touch)) {
        for touching in self.stores.iter().flat_map(|store| self.touching_in(store)) {
            let history = Self::history(Some(touching.record), touching.lane, touching.reduced_radius);
            let [i, j] = touching.pair;
            let ends = [i, j].map(|p| (state.x.get(p), state.radius[p]));
            each(touch([i as u32, j as u32], ends, history.normal_force, Some(touching.reduced_radius)));
        }
    }

    fn active(&self) -> usize {
        self.stores.iter().map(|store| self.touching_in(store).count()).sum()
    }

    fn candidates(&self) -> usize {
        let pairs = |block: &Block| block.pairs.count_ones() as usize;
        self.stores.iter().flat_map(|store| &store.blocks).map(pairs).sum()
    }

    fn stiffness(&self, state: &State, chunk: usize, horizon: f64) -> Vec<[f64; 2]> {
        let store = self.stores.get(chunk);
        store.map_or_else(Vec::new, |store| self.arch.dispatch(Foresee { contacts: self, store, state, horizon }))
    }

    fn elements(&self, state: &State, chunk: usize, stiffness: &[[f64; 2]], each: &mut dyn FnMut(Element)) {
        let touching = self.stores.get(chunk).into_iter().flat_map(|store| self.touching_in(store));
        for (Touching { pair: [i, j], .. }, k) in touching.zip(stiffness).filter(|(_, k)| **k != [0.0; 2]) {
            let mass = self.laws.damped_mass([state.mass[i], state.mass[j]], [state.fixed[i], state.fixed[j]]);
            let viscosity = viscous_coefficient(self.laws.damping(), mass, k[0]);
            let (nodes, arms) = ([i as u32, j as u32, 0], [state.radius[i], state.radius[j]]);
            each(Element::contact(nodes, [1.0, 1.0, 0.0], *k, arms, viscosity));
        }
    }

    fn save(&self, out: &mut Writer) {
        let keys: Vec<u64> = self.stores.iter().flat_map(Store::keys).collect();
        let blocks = || self.stores.iter().flat_map(|store| store.blocks.iter().map(move |block| (store, block)));
        let acts: Vec<(bool, f64)> = blocks().map(|(_, block)| (block.acts, block.quiet_until)).collect();
        let nothing = vec![0.0; Self::FIELDS * BLOCK];
        let record = |(store, block): (&'_ Store, _)| store.record(block, Self::FIELDS).unwrap_or(&nothing).to_vec();
        let records: Vec<f64> = blocks().flat_map(record).collect();
        out.put(&keys);
        out.put(&acts);
        out.put(&records);
        out.put(&self.deepest);
    }

    fn restore(&mut self, from: &mut Reader, state: &State) -> Result<(), Unfit> {
        let keys: Vec<u64> = from.take()?;
        if keys.iter().any(|key| pair(*key)[1] as usize >= state.len())
            || !keys.is_sorted_by_key(|key| order(*key, self.law(*key)))
        {
            return Err(Unfit("its contacts are those of other particles".into()));
        }
        let chunks = 0..state.len().div_ceil(CHUNK);
        let first = |chunk: usize| keys.partition_point(|key| pair(*key)[0] as usize / CHUNK < chunk);
        let of_chunk =
            |chunk| Store::of(&keys[first(chunk)..first(chunk + 1)], kernel::rows::<T>(), |key| self.law(key));
        self.stores = chunks.map(of_chunk).collect();
        let blocks = self.stores.iter().map(|store| store.blocks.len()).sum();
        let (mut acts, mut records) = (vec![(false, 0.0); blocks], vec![0.0; blocks * Self::FIELDS * BLOCK]);
        from.take_into(&mut acts)?;
        from.take_into(&mut records)?;
        let mut records = records.chunks(Self::FIELDS * BLOCK);
        let mut acts = acts.into_iter();
        for store in &mut self.stores {
            let fill = |_: &Block, numbers: &mut [f64]| {
                records.next().into_iter().for_each(|record| numbers.copy_from_slice(record));
            };
            store.remember(Self::FIELDS, kernel::rows::<T>(), fill);
            for (block, (acts, quiet_until)) in store.blocks.iter_mut().zip(&mut acts) {
                // What touches has a record.
                (block.acts, block.quiet_until) = (acts && block.record != Block::NOTHING, quiet_until);
            }
        }
        self.deepest = from.take()?;
        self.index(state);
        Ok(())
    }

    fn elsewhere(&self) -> Option<&dyn Elsewhere> {
        Some(self)
    }

    fn elsewhere_mut(&mut self) -> Option<&mut dyn Elsewhere> {
        Some(self)
    }

    fn look_anew(&mut self) {
        let blocks = self.stores.iter_mut().flat_map(|store| &mut store.blocks);
        blocks.for_each(|block| (block.acts, block.quiet_until) = (false, 0.0));
    }

    fn bytes(&self, particles: usize) -> Bytes {
        let sizes = |size: fn(&Store) -> usize| self.stores.iter().map(size).sum::<usize>();
        let wires = behind(&self.wire_of) + behind(&self.rest_length);
        let records = sizes(|store| size_of_val(&store.records[..]));
        let actions = sizes(|store| size_of_val(&store.actions[..]));
        // x, v, ω, radius and thinning in; forces and torques of first sides cleared, and added to.
        let per_particle = 3 * VECTOR + 2 * NUMBER + 6 * VECTOR;
        Bytes {
            kept: sizes(Store::bytes)
                + behind(&self.stores)
                + self.constants.bytes()
                + self.places.bytes()
                + wires
                + self.laws.bytes(),
            // Records in and out; actions out, and in again where forces are added up.
            moved: 2 * records + 2 * actions + sizes(|store| size_of_val(&store.blocks[..])) + particles * per_particle,
        }
    }
}

/// A pair that touches.
struct Touching<'a> {
    reduced_radius: f64,
    record: &'a [f64],
    lane: usize,
    pair: [usize; 2],
}

/// Stiffness of the touching pairs of one chunk, with the instructions of the machine: the laws round as these do, and
/// without them a library function has to ([`Real::mul_add`](crate::base::lanes::Real::mul_add)).
struct Foresee<'a, N: NormalLaw, T: TangentialLaw> {
    contacts: &'a SphereContacts<N, T>,
    store: &'a Store,
    state: &'a State,
    horizon: f64,
}

impl<N: NormalLaw, T: TangentialLaw> WithSimd for Foresee<'_, N, T> {
    type Output = Vec<[f64; 2]>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Self { contacts, store, state, horizon } = self;
        let mut all = Vec::new();
        for Touching { reduced_radius, record, lane, pair: [i, j] } in contacts.touching_in(store) {
            let history = SphereContacts::history(Some(record), lane, reduced_radius);
            let d = state.x.get(j) - state.x.get(i);
            let approach = (state.v.get(i) - state.v.get(j)).dot(d) / d.length();
            let overlap = SphereContacts::overlap(&history, state, [i, j]);
            let foreseen = foreseen_stiffness(contacts.laws.between(i, j), &history, overlap, approach, horizon);
            all.push(foreseen.unwrap_or_default());
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_stands_for_its_pair_and_orders_by_chunk_diagonal_particle() {
        let pairs = [[3, 900], [4, 901], [255, 256], [256, 257], [300, 1_000_000], [2_000_000, 2_000_001]];
        for [i, j] in pairs {
            assert_eq!(pair(key(i, j)), [i, j]);
        }
        // One diagonal of one chunk before the next diagonal, one chunk before the next.
        assert!(key(3, 900) < key(4, 901) && key(4, 901) < key(3, 901) && key(3, 901) < key(256, 257));
        let block = |i: u32, j: u32| key(i, j) / BLOCK as u64;
        assert!(block(8, 100) == block(15, 107) && block(15, 107) != block(16, 108) && block(8, 100) != block(8, 101));
    }
}
