//! Adds up what blocks of contacts do to their second sides.

use super::Block;
use crate::base::lanes::{BLOCK, Lanes, Real};
use crate::engine::state::{CHUNK, ContactSides, State};
use pulp::{Arch, Simd, WithSimd};

/// Where the second sides of blocks lie among blocks of particles: a block of contacts begins anywhere in j, so it
/// reaches into one or two of them.
#[derive(Default)]
pub struct SecondSides {
    /// Per block of particles the first of its entries, and their number at the end.
    start: Vec<u32>,
    entries: Vec<Entry>,
}

/// Contacts of a block, seen from a block of particles.
#[derive(Debug, Clone, Copy, Default)]
struct Entry {
    block: u32,
    /// Place in the block of contacts less place in the block of particles.
    shift: i32,
}

impl SecondSides {
    /// Finds the entries of `n` particles, those of each in the order of blocks.
    pub fn index(&mut self, blocks: &[Block], n: usize) {
        let count = n.div_ceil(BLOCK);
        self.start.clear();
        self.start.resize(count + 1, 0);
        let entries = || {
            blocks.iter().enumerate().flat_map(move |(b, block)| {
                let (at, shift) = (block.j as usize / BLOCK, block.j as i32 % BLOCK as i32);
                let low = (at, Entry { block: b as u32, shift: -shift });
                let high = (at + 1, Entry { block: b as u32, shift: BLOCK as i32 - shift });
                let reaches = shift > 0 && at + 1 < count;
                std::iter::once(low).chain(reaches.then_some(high))
            })
        };
        entries().for_each(|(at, _)| self.start[at + 1] += 1);
        for at in 0..count {
            self.start[at + 1] += self.start[at];
        }
        self.entries.clear();
        self.entries.resize(self.start[count] as usize, Entry::default());
        // `start` moves on to the end of each while filling, which is the start of the next: shift it back by one.
        for (at, entry) in entries() {
            self.entries[self.start[at] as usize] = entry;
            self.start[at] += 1;
        }
        self.start.rotate_right(1);
        self.start[0] = 0;
    }

    /// Takes forces off and adds torques to the particles of `state`; with `turn` there are torques.
    pub fn add(&self, blocks: &[Block], actions: &[f64], turn: bool, state: &mut State, arch: Arch) {
        let (_, sides) = state.split_contacts();
        let chunks = sides.particles().div_ceil(CHUNK);
        sides.share(0, chunks, &|chunk, sides| {
            arch.dispatch(Gather { all: self, blocks, actions, turn, first: chunk * CHUNK, sides });
        });
    }
}

/// The particles of one chunk.
struct Gather<'a> {
    all: &'a SecondSides,
    blocks: &'a [Block],
    actions: &'a [f64],
    turn: bool,
    first: usize,
    sides: ContactSides<'a>,
}

impl WithSimd for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        for at in (0..self.sides.particles()).step_by(BLOCK) {
            let block = (self.first + at) / BLOCK;
            let entries = self.all.start[block] as usize..self.all.start[block + 1] as usize;
            let acting = self.all.entries[entries].iter().filter(|e| self.blocks[e.block as usize].acts);
            if self.turn {
                add::<S, 6>(simd, at, acting, self.actions, self.sides.all());
            } else {
                add::<S, 3>(simd, at, acting, self.actions, self.sides.forces());
            }
        }
    }
}

/// Adds the entries of one block of particles to its `ROWS` sums; forces are taken off.
#[inline(always)]
fn add<'a, S: Simd, const ROWS: usize>(
    simd: S,
    at: usize,
    entries: impl Iterator<Item = &'a Entry> + Clone,
    actions: &[f64],
    mut sums: [&mut [f64]; ROWS],
) {
    const PLACES: [f64; BLOCK] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];
    for lane in (0..BLOCK).step_by(Lanes::<S>::LEN) {
        if at + lane >= sums[0].len() {
            break;
        }
        let mut sum = [Lanes::splat(simd, 0.0); ROWS];
        for (sum, row) in sum.iter_mut().zip(&sums) {
            *sum = Lanes::load_up_to_end(simd, row, at + lane);
        }
        let place = Lanes::load(simd, &PLACES, lane);
        for Entry { block, shift } in entries.clone() {
            // Places beyond the ends of a row are those of other rows, which the mask leaves out.
            let theirs = place + f64::from(*shift);
            let within = theirs.above(theirs.like(-0.5)) & theirs.like(BLOCK as f64 - 0.5).above(theirs);
            let row = (1 + *block as usize * ROWS) * BLOCK + lane;
            let from = row.wrapping_add_signed(*shift as isize);
            for (k, sum) in sum.iter_mut().enumerate() {
                let part = Lanes::load(simd, actions, from + k * BLOCK);
                let part = Lanes::choose(within, part, place.like(0.0));
                *sum += if k < 3 { -part } else { part };
            }
        }
        for (sum, out) in sum.into_iter().zip(sums.iter_mut()) {
            sum.store_up_to_end(out, at + lane);
        }
    }
}
