//! What blocks of contacts do to their second sides, seen from the particles that these are.

use super::store::Store;
use crate::base::lanes::{BLOCK, Lanes, Real};
use crate::engine::bytes::behind;
use pulp::Simd;

/// Where the second sides of blocks lie among blocks of particles: a block of contacts begins anywhere in j, so it
/// reaches into one or two of them.
#[derive(Default)]
pub struct Places {
    /// Per block of particles the first of its entries, and their number at the end.
    start: Vec<u32>,
    entries: Vec<Entry>,
}

/// Contacts of a block, seen from a block of particles.
#[derive(Debug, Clone, Copy, Default)]
struct Entry {
    chunk: u32,
    block: u32,
    /// Place in the block of contacts less place in the block of particles.
    shift: i32,
}

impl Places {
    /// Memory behind it (bytes).
    pub fn bytes(&self) -> usize {
        behind(&self.start) + behind(&self.entries)
    }

    /// Finds the entries of `n` particles, those of each in the order of blocks.
    pub fn index<'a>(&mut self, stores: &'a [Store], n: usize) {
        let count = n.div_ceil(BLOCK);
        self.start.clear();
        self.start.resize(count + 1, 0);
        let blocks = || {
            let of_chunk = |(chunk, store): (usize, &'a Store)| {
                store.blocks.iter().enumerate().map(move |(b, block)| ([chunk, b].map(|k| k as u32), block.j))
            };
            stores.iter().enumerate().flat_map(of_chunk)
        };
        let entries = || {
            blocks().flat_map(move |([chunk, block], j)| {
                let (at, shift) = (j as usize / BLOCK, j as i32 % BLOCK as i32);
                let low = (at, Entry { chunk, block, shift: -shift });
                let high = (at + 1, Entry { chunk, block, shift: BLOCK as i32 - shift });
                let reaches = shift > 0 && at + 1 < count;
                std::iter::once(low).chain(reaches.then_some(high))
            })
        };
        entries().for_each(|(at, _)| self.start[at + 1] += 1);
        for at in 0..count {
            self.start[at + 1] += self.start[at];
        }
        self.entries = vec![Entry::default(); self.start[count] as usize];
        // Filling moves every start on to its end, which is the start of the next: so they are put back by one.
        for (at, entry) in entries() {
            self.entries[self.start[at] as usize] = entry;
            self.start[at] += 1;
        }
        self.start.rotate_right(1);
        self.start[0] = 0;
    }
}

/// Forces and torques on the second sides of all blocks.
#[derive(Clone, Copy)]
pub struct SecondSides<'a> {
    pub(super) places: &'a Places,
    pub(super) stores: &'a [Store],
    pub(super) turn: bool,
}

impl SecondSides<'_> {
    /// Takes the forces on the particles of a block of particles off `sum`, from `lane` on, and adds the torques to the
    /// last three.
    #[inline(always)]
    pub fn add<S: Simd>(&self, simd: S, block: usize, lane: usize, sum: &mut [Lanes<S>; 6]) {
        const PLACES: [f64; BLOCK] =
            [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];
        let place = Lanes::load(simd, &PLACES, lane);
        let rows = if self.turn { 6 } else { 3 };
        let entries = self.places.start[block] as usize..self.places.start[block + 1] as usize;
        for Entry { chunk, block, shift } in &self.places.entries[entries] {
            let store = &self.stores[*chunk as usize];
            let block = &store.blocks[*block as usize];
            if !block.acts {
                continue;
            }
            // Places beyond the ends of a row are those of other rows, which the mask leaves out.
            let theirs = place + f64::from(*shift);
            let within = theirs.simd_gt(theirs.splat(-0.5)) & theirs.splat(BLOCK as f64 - 0.5).simd_gt(theirs);
            // The actions begin with a block to spare.
            let row = (1 + block.record as usize * rows) * BLOCK + lane;
            let from = row.wrapping_add_signed(*shift as isize);
            for (k, sum) in sum.iter_mut().take(rows).enumerate() {
                let part = Lanes::load(simd, &store.actions, from + k * BLOCK);
                let part = Lanes::select(within, part, place.splat(0.0));
                *sum += if k < 3 { -part } else { part };
            }
        }
    }
}
