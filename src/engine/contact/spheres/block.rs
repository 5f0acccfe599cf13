//! Pairs of spheres in blocks, and their order.

use crate::base::lanes::BLOCK;
use crate::engine::state::CHUNK;

/// Pairs (i + k, j + k), k below [`BLOCK`].
#[derive(Debug, Clone, Copy)]
pub struct Block {
    /// A multiple of [`BLOCK`].
    pub i: u32,
    pub j: u32,
    /// Which of them are candidates, a bit each.
    pub pairs: u16,
    /// Place of its law in the table.
    pub law: u32,
    /// Its rows among the constants.
    pub constants: u32,
    /// Its record among those of its chunk; [`Self::NOTHING`] where it remembers nothing.
    pub record: u32,
    /// Whether any of them touched at the last step.
    pub acts: bool,
    /// Nothing can touch until [`State::travel`](crate::engine::state::State::travel) has reached this (m).
    pub quiet_until: f64,
}

impl Block {
    /// In the place of a record.
    pub const NOTHING: u32 = u32::MAX;

    /// Without a pair: the block of the pair (`i`, `j`), whose law is at `law`.
    pub fn of(i: u32, j: u32, law: u32) -> Self {
        let lane = i % BLOCK as u32;
        let (i, j) = (i - lane, j - lane);
        Self { i, j, pairs: 0, law, constants: 0, record: Self::NOTHING, acts: false, quiet_until: 0.0 }
    }

    /// The order of blocks; see [`order`].
    pub fn order(&self) -> (u64, u32) {
        (key(self.i, self.j) / BLOCK as u64, self.law)
    }

    pub fn lanes(&self) -> impl Iterator<Item = usize> + use<> {
        let pairs = self.pairs;
        (0..BLOCK).filter(move |k| pairs >> k & 1 == 1)
    }
}

/// Orders pairs by chunk of i, diagonal, i; pairs of a block share all but the last digits.
pub fn key(i: u32, j: u32) -> u64 {
    let (chunk, within) = (i as u64 / CHUNK as u64, i as u64 % CHUNK as u64);
    chunk << 40 | u64::from(j - i) << 8 | within
}

/// Orders pairs so that those of a block, which share a law, stand together.
pub fn order(key: u64, law: u32) -> (u64, u32, u64) {
    (key / BLOCK as u64, law, key)
}

const _: () = assert!(CHUNK == 256 && CHUNK.is_multiple_of(BLOCK), "a key has eight bits for the place in a chunk");

/// The pair that a key stands for.
pub fn pair(key: u64) -> [u32; 2] {
    let i = (key >> 40) as u32 * CHUNK as u32 + (key & 0xFF) as u32;
    [i, i + (key >> 8) as u32]
}
