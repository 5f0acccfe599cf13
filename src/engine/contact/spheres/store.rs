//! What the contacts of one chunk of particles remember, and what they do.
//!
//! Most candidates never touch. A block gets a record, and room for what it does, when the first of its pairs touches; it
//! loses them with the next list of candidates if all that it remembers is 0.

use super::block::{Block, key, pair};
use crate::base::lanes::BLOCK;
use crate::engine::bytes::behind;
use crate::engine::state::ChunkSums;

/// Contacts whose first sides lie in one chunk of particles. A record has `fields` rows of [`BLOCK`] numbers, what a block
/// does has `rows` of them.
#[derive(Default)]
pub struct Store {
    /// In the order of their keys.
    pub blocks: Vec<Block>,
    /// Record after record.
    pub records: Vec<f64>,
    /// What blocks with a record do to their second sides, in the order of records, with a block to spare at either end.
    pub actions: Vec<f64>,
    /// Energies of the last step.
    pub partial: ChunkSums,
}

impl Store {
    /// Blocks for the pairs of `keys`, which are [in order](super::block::order), `law` the place of the law of each; they
    /// remember nothing.
    pub fn of(keys: &[u64], rows: usize, law: impl Fn(u64) -> u32) -> Self {
        let mut blocks: Vec<Block> = Vec::new();
        for key in keys {
            let [i, j] = pair(*key);
            let block = Block::of(i, j, law(*key));
            if blocks.last().is_none_or(|last| last.order() != block.order()) {
                blocks.push(block);
            }
            if let Some(last) = blocks.last_mut() {
                last.pairs |= 1 << (i % BLOCK as u32);
            }
        }
        blocks.shrink_to_fit();
        let mut store = Self { blocks, ..Self::default() };
        store.make_room(rows);
        store
    }

    /// Room for what the blocks that have a record do.
    fn make_room(&mut self, rows: usize) {
        let records = self.blocks.iter().filter(|block| block.record != Block::NOTHING).count();
        self.actions = vec![0.0; (records * rows + 2) * BLOCK];
    }

    /// The keys of all pairs.
    pub fn keys(&self) -> impl Iterator<Item = u64> + '_ {
        self.blocks.iter().flat_map(|block| block.lanes().map(|lane| key(block.i, block.j) + lane as u64))
    }

    /// What a block remembers, row after row; `None` where that is nothing.
    #[inline(always)]
    pub fn record(&self, block: &Block, fields: usize) -> Option<&[f64]> {
        let size = fields * BLOCK;
        (block.record != Block::NOTHING).then(|| &self.records[block.record as usize * size..][..size])
    }

    /// Gives records to blocks that have none: to each the numbers that `fill` writes, which finds zeros, unless it leaves
    /// all of them 0.
    pub fn remember(&mut self, fields: usize, rows: usize, mut fill: impl FnMut(&Block, &mut [f64])) {
        let mut numbers = vec![0.0; fields * BLOCK];
        let mut count = 0;
        for block in &mut self.blocks {
            fill(block, &mut numbers);
            // A zero of the other sign is something.
            if numbers.iter().any(|number| number.to_bits() != 0) {
                block.record = count;
                count += 1;
                self.records.extend_from_slice(&numbers);
                numbers.fill(0.0);
            }
        }
        self.records.shrink_to_fit();
        self.make_room(rows);
    }

    /// The record of a block, a new one where it had none, and its actions.
    #[inline(always)]
    pub fn acting(&mut self, block: usize, fields: usize, rows: usize) -> [&mut [f64]; 2] {
        if self.blocks[block].record == Block::NOTHING {
            self.add_record(block, fields, rows);
        }
        let record = self.blocks[block].record as usize;
        let (fields, rows) = (fields * BLOCK, rows * BLOCK);
        [&mut self.records[record * fields..][..fields], &mut self.actions[BLOCK + record * rows..][..rows]]
    }

    #[cold]
    fn add_record(&mut self, block: usize, fields: usize, rows: usize) {
        self.blocks[block].record = (self.records.len() / (fields * BLOCK)) as u32;
        grow(&mut self.records, fields * BLOCK);
        grow(&mut self.actions, rows * BLOCK);
    }

    /// Memory behind it (bytes).
    pub fn bytes(&self) -> usize {
        behind(&self.blocks) + behind(&self.records) + behind(&self.actions)
    }
}

/// Adds zeros, with little to spare: there is a store for every chunk, and all of one are seldom filled.
fn grow(numbers: &mut Vec<f64>, by: usize) {
    if numbers.capacity() < numbers.len() + by {
        numbers.reserve_exact(by + numbers.len() / 8);
    }
    numbers.resize(numbers.len() + by, 0.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIELDS: usize = 2;
    const ROWS: usize = 3;

    #[test]
    fn a_block_has_a_record_only_while_it_remembers_something() {
        let keys = [key(0, 40), key(1, 41), key(16, 56), key(3, 70)];
        let mut store = Store::of(&keys, ROWS, |_| 0);
        assert_eq!(store.keys().collect::<Vec<_>>(), keys);
        assert_eq!((store.blocks.len(), store.records.len(), store.actions.len()), (3, 0, 2 * BLOCK));
        let [record, actions] = store.acting(1, FIELDS, ROWS);
        (record[BLOCK + 5], actions[2]) = (7.0, 8.0);
        assert_eq!((store.records.len(), store.actions.len()), (FIELDS * BLOCK, (ROWS + 2) * BLOCK));
        store.acting(2, FIELDS, ROWS);
        let block = store.blocks[1];
        assert_eq!(store.record(&block, FIELDS).map(|record| record[BLOCK + 5]), Some(7.0));
        assert!(store.record(&store.blocks[0], FIELDS).is_none());

        let mut next = Store::of(&keys, ROWS, |_| 0);
        next.remember(FIELDS, ROWS, |block, numbers| {
            let old = store.blocks.iter().find(|old| old.order() == block.order()).unwrap();
            numbers.copy_from_slice(store.record(old, FIELDS).unwrap_or(&[0.0; FIELDS * BLOCK]));
        });
        let records: Vec<u32> = next.blocks.iter().map(|block| block.record).collect();
        assert_eq!(records, [Block::NOTHING, 0, Block::NOTHING]);
        assert_eq!(next.records[BLOCK + 5], 7.0);
    }

    /// Pairs of one place in a diagonal whose laws differ are in blocks of their own.
    #[test]
    fn a_block_has_one_law() {
        let law = |key: u64| u32::from(pair(key)[0] >= 2);
        let keys = [key(0, 40), key(1, 41), key(2, 42), key(3, 43), key(16, 56)];
        let store = Store::of(&keys, ROWS, law);
        let blocks: Vec<(u32, u16)> = store.blocks.iter().map(|block| (block.law, block.pairs)).collect();
        assert_eq!(blocks, [(0, 0b11), (1, 0b1100), (1, 0b1)]);
        assert!(store.blocks.is_sorted_by_key(Block::order));
        assert_eq!(store.keys().collect::<Vec<_>>(), keys);
    }
}
