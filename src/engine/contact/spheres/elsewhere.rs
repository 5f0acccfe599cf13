//! Contacts between spheres whose steps are done elsewhere: the formula of a pair, and the numbers of all pairs.

use super::SphereContacts;
use super::block::Block;
use super::kernel;
use super::meeting::{ENERGIES, SpherePair};
use crate::base::lanes::BLOCK;
use crate::base::recorder::{Function, Unrecordable};
use crate::engine::contact::stage::Elsewhere;
use crate::engine::state::{ChunkSums, Deepest};
use crate::law::contact::NormalLaw;
use crate::law::tangential::TangentialLaw;
use std::f64::consts::PI;

impl<N: NormalLaw, T: TangentialLaw> SphereContacts<N, T> {
    /// Each pair in order: the chunk and the block that it is in, and its place in that.
    fn places(&self) -> impl Iterator<Item = (usize, &Block, usize)> {
        let blocks =
            self.stores.iter().enumerate().flat_map(|(chunk, store)| store.blocks.iter().map(move |b| (chunk, b)));
        blocks.flat_map(|(chunk, block)| block.lanes().map(move |lane| (chunk, block, lane)))
    }

    /// A constant of each pair.
    fn constant(&self, row: usize) -> Vec<f64> {
        let constants = self.constants.rows();
        self.places().map(|(_, block, lane)| constants[block.constants as usize + row * BLOCK + lane]).collect()
    }

    /// A number that each pair remembers.
    fn remembered(&self, field: usize) -> Vec<f64> {
        let number = |(chunk, block, lane): (usize, &Block, usize)| {
            self.stores[chunk].record(block, Self::FIELDS).map_or(0.0, |record| record[field * BLOCK + lane])
        };
        self.places().map(number).collect()
    }
}

/// The number of a name that ends with one.
fn numbered(name: &str) -> Option<usize> {
    name.strip_prefix("history_")?.parse().ok()
}

impl<N: NormalLaw, T: TangentialLaw> Elsewhere for SphereContacts<N, T> {
    /// Of scenes with one material: the constants of its laws are those of the recording.
    fn record(&self, turn: bool) -> Result<Function, Unrecordable> {
        Function::record("contact", &SpherePair { laws: *self.laws.at(0), turn })
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.places().map(|(_, block, lane)| [block.i, block.j].map(|p| p + lane as u32)).collect()
    }

    fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        match name {
            "reduced_radius" => Some(self.constant(0)),
            "viscosity" => Some(self.constant(1)),
            // Only what is deeper than all before is of interest.
            "deepest" => Some(vec![self.deepest.ratio; self.places().count()]),
            _ => numbered(name).map(|field| self.remembered(field)),
        }
    }

    fn take(&mut self, numbers: &[(String, Vec<f64>)]) -> ChunkSums {
        let named = |name: &str| numbers.iter().find(|(own, _)| own == name).map_or(&[][..], |(_, all)| &all[..]);
        let remembered: Vec<&[f64]> = (0..Self::FIELDS).map(|k| named(&format!("history_{k}"))).collect();
        let (fields, rows) = (Self::FIELDS, kernel::rows::<T>());
        let mut at = 0;
        for store in &mut self.stores {
            for b in 0..store.blocks.len() {
                let block = store.blocks[b];
                let pairs = at..at + block.pairs.count_ones() as usize;
                at = pairs.end;
                let something = |all: &&[f64]| all[pairs.clone()].iter().any(|number| number.to_bits() != 0);
                if block.record == Block::NOTHING && !remembered.iter().any(something) {
                    continue;
                }
                let [record, _] = store.acting(b, fields, rows);
                for (lane, pair) in block.lanes().zip(pairs) {
                    remembered.iter().enumerate().for_each(|(k, all)| record[k * BLOCK + lane] = all[pair]);
                }
            }
        }
        let sum = |name| named(name).iter().sum();
        let [plastic, thinning, friction, damping] = ENERGIES.map(sum);
        let mut sums = ChunkSums { plastic, thinning, friction, damping, ..ChunkSums::beyond(self.deepest) };
        let (ratio, overlap, force) = (named("deepest"), named("deepest_overlap"), named("deepest_force"));
        let all = (0..ratio.len()).zip(self.places()).map(|(pair, (_, block, lane))| (pair, block, lane));
        for (pair, block, lane) in all {
            if ratio[pair] > sums.deepest.ratio {
                let area = PI * self.constants.rows()[block.constants as usize + lane] * overlap[pair];
                let pair_of = [block.i, block.j].map(|p| p + lane as u32);
                sums.deepest = Deepest { ratio: ratio[pair], pair: pair_of, force: force[pair], area };
            }
        }
        self.deepest = sums.deepest;
        sums
    }
}
