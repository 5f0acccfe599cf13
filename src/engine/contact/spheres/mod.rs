//! Contact stage for spheres: every particle is a ball of its wire's diameter.
//!
//! Wires that touch lie side by side over many particles: where particle i meets j, i + 1 meets j + 1, and only here and
//! there a wire has gained a particle on its neighbour. So pairs are kept in diagonals, j − i constant, cut into blocks
//! of [`BLOCK`] pairs that begin at a multiple of [`BLOCK`] in i. A block needs no list of particles and no gathered
//! loads: both its sides are contiguous in memory, and 96 to 99 % of the places in the blocks of a strand are pairs.
//!
//! Blocks are ordered by the chunk of particles that their first side lies in, then by diagonal. A chunk's task adds
//! the first sides to its own particles; the second sides are left as actions, which the gathering of all forces adds
//! up ([`SecondSides`]).

mod block;
mod kernel;
pub mod second;

use super::pair::{History, Laws, elastic_energy, foreseen_stiffness, leave};
use super::stage::{Contacts, closing};
use crate::base::lanes::BLOCK;
use crate::engine::bytes::{Bytes, NUMBER, VECTOR, behind};
use crate::engine::neighbours::PairList;
use crate::engine::shared_rows::SharedRows;
use crate::engine::state::{BondActions, CHUNK, ChunkSums, Deepest, State};
use crate::engine::time_step::Stiffness;
use crate::law::contact::NormalLaw;
use crate::law::contact::constants::{reduced_mass, reduced_radius};
use crate::law::damping::viscous_coefficient;
use crate::law::tangential::TangentialLaw;
use crate::strand::assembly::Assembly;
use block::{Block, key, pair};
use kernel::Work;
use pulp::Arch;
use rayon::prelude::*;
use second::{Places, SecondSides};

/// Blocks with what their contacts remember: field after field of [`BLOCK`] numbers each.
#[derive(Default)]
struct Store {
    blocks: Vec<Block>,
    records: Vec<f64>,
    /// What does not change from search to search: a row of R* (m), 0 where no candidate is, and one of 2ξ√m* (√kg).
    constants: SharedRows,
}

/// Contacts between spheres with normal law `N` and tangential law `T`.
pub struct SphereContacts<N: NormalLaw, T: TangentialLaw> {
    laws: Laws<N, T>,
    now: Store,
    /// Before a rebuild; kept for its memory.
    old: Store,
    /// Keys of all pairs; kept for its memory.
    keys: Vec<u64>,
    /// Per chunk of particles the first of its blocks, and their number at the end.
    starts: Vec<u32>,
    /// What blocks do to their second sides, [`kernel::rows`] rows of [`BLOCK`] numbers each, with a block to spare at
    /// either end.
    actions: Vec<f64>,
    places: Places,
    partial: Vec<ChunkSums>,
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
    pub fn new(laws: Laws<N, T>, assembly: &Assembly) -> Self {
        Self {
            laws,
            now: Store::default(),
            old: Store::default(),
            keys: Vec::new(),
            starts: Vec::new(),
            actions: Vec::new(),
            places: Places::default(),
            partial: Vec::new(),
            deepest: Deepest::default(),
            closing: closing(assembly),
            wire_of: assembly.wire_of.clone(),
            rest_length: assembly.rest_length.clone(),
            arch: Arch::new(),
        }
    }

    fn place(block: usize, field: usize, lane: usize) -> usize {
        (block * Self::FIELDS + field) * BLOCK + lane
    }

    fn history(store: &Store, block: usize, lane: usize) -> History<N, T> {
        let radius = store.constants.rows()[store.blocks[block].constants as usize + lane];
        History::of(radius, |k| store.records[Self::place(block, k, lane)])
    }

    /// All pairs: block, place in it, the two particles.
    fn pairs(store: &Store) -> impl Iterator<Item = (usize, usize, [usize; 2])> + '_ {
        store.blocks.iter().enumerate().flat_map(|(b, block)| {
            let [i, j] = [block.i, block.j].map(|p| p as usize);
            block.lanes().map(move |k| (b, k, [i + k, j + k]))
        })
    }

    /// Pairs that touch, with their history.
    fn touching(&self) -> impl Iterator<Item = (History<N, T>, [usize; 2])> + '_ {
        let all = Self::pairs(&self.now).map(|(b, k, pair)| (Self::history(&self.now, b, k), pair));
        all.filter(|(history, _)| history.touching())
    }

    /// Blocks for the pairs in `keys`, their records all 0.
    fn lay_out(&mut self) {
        let Store { blocks, records, .. } = &mut self.now;
        blocks.clear();
        for key in &self.keys {
            let [i, j] = pair(*key);
            let lane = i % BLOCK as u32;
            let first = Block { i: i - lane, j: j - lane, pairs: 0, constants: 0, acts: false, quiet_until: 0.0 };
            if blocks.last().is_none_or(|last: &Block| last.key() != first.key()) {
                blocks.push(first);
            }
            if let Some(last) = blocks.last_mut() {
                last.pairs |= 1 << lane;
            }
        }
        records.clear();
        records.resize(blocks.len() * Self::FIELDS * BLOCK, 0.0);
    }

    fn find_constants(&mut self, state: &State) {
        let Store { blocks, constants, .. } = &mut self.now;
        constants.clear();
        for block in blocks {
            let mut rows = [0.0; 2 * BLOCK];
            for lane in block.lanes() {
                let [i, j] = [block.i, block.j].map(|p| p as usize + lane);
                let mass = reduced_mass(state.mass[i], state.mass[j]);
                rows[lane] = reduced_radius(state.radius0[i], state.radius0[j]);
                rows[BLOCK + lane] = viscous_coefficient(self.laws.damping, mass, 1.0);
            }
            block.constants = constants.place(&rows);
        }
    }

    /// Fills the records from the old ones, and for pairs that were not there afresh; returns what friction had stored
    /// in pairs that left (J).
    fn take_over(&mut self, state: &State) -> f64 {
        let (mut lost, mut o) = (0.0, 0);
        let old = std::mem::take(&mut self.old);
        let (size, laws) = (Self::FIELDS * BLOCK, self.laws);
        let leaving = |o: usize, lanes: &mut dyn Iterator<Item = usize>| -> f64 {
            lanes.map(|lane| leave(&laws, &Self::history(&old, o, lane))).sum()
        };
        for b in 0..self.now.blocks.len() {
            let block = self.now.blocks[b];
            while o < old.blocks.len() && old.blocks[o].key() < block.key() {
                lost += leaving(o, &mut old.blocks[o].lanes());
                o += 1;
            }
            let before = old.blocks.get(o).filter(|before| before.key() == block.key()).copied();
            let kept = before.map_or(0, |before| before.pairs);
            for lane in block.lanes() {
                if kept >> lane & 1 == 1 {
                    (0..Self::FIELDS).for_each(|field| {
                        let from = old.records[o * size + field * BLOCK + lane];
                        self.now.records[b * size + field * BLOCK + lane] = from;
                    });
                } else {
                    self.set_up(b, lane, state);
                }
            }
            if let Some(before) = before {
                lost += leaving(o, &mut before.lanes().filter(|lane| block.pairs >> lane & 1 == 0));
                o += 1;
            }
        }
        (o..old.blocks.len()).for_each(|o| lost += leaving(o, &mut old.blocks[o].lanes()));
        self.old = old;
        lost
    }

    /// A pair that is new in the list. During a run it was beyond reach until now, or a bond has just broken.
    fn set_up(&mut self, block: usize, lane: usize, state: &State) {
        if state.step > 0 {
            let [i, j] = [self.now.blocks[block].i, self.now.blocks[block].j].map(|p| p as usize + lane);
            let offset = self.offset(i, j, state);
            self.now.records[Self::place(block, History::<N, T>::OFFSET, lane)] = offset;
        }
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
    fn rebuild(&mut self, list: &PairList, state: &State) -> ChunkSums {
        std::mem::swap(&mut self.now, &mut self.old);
        self.keys.clear();
        self.keys.extend(list.pairs.iter().map(|(i, j)| key(*i, *j)));
        self.keys.par_sort_unstable();
        self.lay_out();
        self.find_constants(state);
        let friction = self.take_over(state);
        let chunks = state.len().div_ceil(CHUNK);
        let blocks = &self.now.blocks;
        self.starts.clear();
        self.starts.extend((0..=chunks).map(|c| blocks.partition_point(|b| (b.i as usize) < c * CHUNK) as u32));
        self.actions.clear();
        self.actions.resize((blocks.len() * kernel::rows::<T>() + 2) * BLOCK, 0.0);
        self.partial.clear();
        self.partial.resize(chunks, ChunkSums::default());
        self.places.index(blocks, state.len());
        ChunkSums { friction, ..ChunkSums::default() }
    }

    fn compute(&mut self, state: &mut State) -> ChunkSums {
        let (laws, arch, deepest, closing) = (&self.laws, self.arch, self.deepest, self.closing);
        let (seen, sides) = state.split_contacts();
        let end = self.actions.len() - BLOCK;
        let work = Work {
            first: 0,
            starts: &self.starts,
            blocks: &mut self.now.blocks,
            records: &mut self.now.records,
            constants: self.now.constants.rows(),
            actions: &mut self.actions[BLOCK..end],
            sides,
            partial: &mut self.partial,
        };
        work.share(Self::FIELDS, kernel::rows::<T>(), &|chunk| {
            arch.dispatch(kernel::Chunk { laws, seen: &seen, deepest, closing, work: chunk });
        });
        let mut sum = ChunkSums::beyond(deepest);
        self.partial.iter().for_each(|p| sum.add(p));
        self.deepest = sum.deepest;
        sum
    }

    fn second_sides(&self) -> Option<SecondSides<'_>> {
        let Self { places, actions, .. } = self;
        Some(SecondSides { places, blocks: &self.now.blocks, actions, turn: T::ACTIVE })
    }

    fn elastic_energy(&self, state: &State) -> f64 {
        self.touching().map(|(h, pair)| elastic_energy(&self.laws, &h, Self::overlap(&h, state, pair))).sum()
    }

    fn add_normal_forces(&self, onto: &mut [f64]) {
        for (history, pair) in self.touching() {
            pair.into_iter().for_each(|p| onto[p] += history.normal_force);
        }
    }

    fn active(&self) -> usize {
        self.touching().count()
    }

    fn candidates(&self) -> usize {
        self.keys.len()
    }

    fn stiffness(&self, state: &State, horizon: f64, out: &mut Stiffness) {
        for (history, pair @ [i, j]) in self.touching() {
            let d = state.x.get(j) - state.x.get(i);
            let approach = (state.v.get(i) - state.v.get(j)).dot(d) / d.length();
            let overlap = Self::overlap(&history, state, pair);
            let Some(k) = foreseen_stiffness(&self.laws, &history, overlap, approach, horizon) else { continue };
            let mass = reduced_mass(state.mass[i], state.mass[j]);
            let viscosity = viscous_coefficient(self.laws.damping, mass, k[0]);
            let nodes = [i as u32, j as u32, 0];
            out.contact(nodes, [1.0, 1.0, 0.0], k, [state.radius[i], state.radius[j]], viscosity);
        }
    }

    fn bytes(&self, particles: usize) -> Bytes {
        let store = |s: &Store| behind(&s.blocks) + behind(&s.records) + s.constants.bytes();
        let wires = behind(&self.wire_of) + behind(&self.rest_length);
        let lists = wires + behind(&self.keys) + behind(&self.starts) + behind(&self.partial) + self.places.bytes();
        let (records, actions) = (size_of_val(&self.now.records[..]), size_of_val(&self.actions[..]));
        // x, v, ω, radius and thinning in; forces and torques of first sides cleared, and added to.
        let per_particle = 3 * VECTOR + 2 * NUMBER + 6 * VECTOR;
        Bytes {
            kept: store(&self.now) + store(&self.old) + behind(&self.actions) + lists,
            // Records in and out; actions out, and in again where forces are added up.
            moved: 2 * records + 2 * actions + size_of_val(&self.now.blocks[..]) + particles * per_particle,
        }
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
