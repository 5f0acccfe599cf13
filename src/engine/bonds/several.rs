//! Bonds of several materials: a stage of each, with its own law, damping and rupture, which leaves the bonds of the others
//! alone. So every loop stays monomorphic over one law, whichever laws meet in a scene.

use super::stage::Bonds;
use crate::base::lanes::BLOCK;
use crate::base::recorder::Function;
use crate::engine::bytes::{Bytes, behind};
use crate::engine::rupture::Criterion;
use crate::engine::saved::{Reader, Unfit, Writer};
use crate::engine::state::{CHUNK, ChunkSums, State};
use crate::engine::team::Team;
use crate::engine::time_step::Element;
use crate::strand::assembly::Assembly;

/// The bonds of one material among others.
pub struct Own {
    /// 1 at each slot of a bond that is its own, 0 elsewhere.
    pub slots: Vec<f64>,
    /// Whether there are any, block by block.
    pub blocks: Vec<bool>,
}

impl Own {
    /// Those of material `material`.
    pub fn new(material: usize, assembly: &Assembly) -> Self {
        let own = |slot: usize| assembly.is_bond(slot) && assembly.material_of(slot) == material;
        let slots: Vec<f64> = (0..assembly.len()).map(|slot| f64::from(u8::from(own(slot)))).collect();
        let blocks = slots.chunks(BLOCK).map(|block| block.contains(&1.0)).collect();
        Self { slots, blocks }
    }

    /// Whether a slot is one of them.
    pub fn has(&self, slot: usize) -> bool {
        self.slots[slot] > 0.0
    }

    /// Slots of the blocks that have any of them.
    pub fn worked_on(&self) -> usize {
        self.blocks.iter().filter(|own| **own).count() * BLOCK
    }

    /// What is of a chunk: slots and blocks.
    pub fn of_chunk(&self, chunk: usize) -> (&[f64], &[bool]) {
        (&self.slots[chunk * CHUNK..], &self.blocks[chunk * (CHUNK / BLOCK)..])
    }

    /// Memory behind it (bytes).
    pub fn bytes(&self) -> usize {
        behind(&self.slots) + behind(&self.blocks)
    }
}

/// Bonds of several materials.
pub struct SeveralBonds {
    /// Per material.
    stages: Vec<Box<dyn Bonds>>,
    /// Material of each slot.
    material_of: Vec<u32>,
}

impl SeveralBonds {
    /// `stages` are those of the materials, each with its [`Own`] bonds.
    pub fn new(stages: Vec<Box<dyn Bonds>>, assembly: &Assembly) -> Self {
        let material_of = (0..assembly.len()).map(|slot| assembly.material_of(slot) as u32).collect();
        Self { stages, material_of }
    }

    fn of(&self, slot: usize) -> &dyn Bonds {
        &*self.stages[self.material_of[slot] as usize]
    }
}

impl Bonds for SeveralBonds {
    fn compute(&mut self, state: &mut State, team: &Team) -> ChunkSums {
        let mut sum = ChunkSums::default();
        self.stages.iter_mut().for_each(|stage| sum.add(&stage.compute(state, team)));
        sum
    }

    fn rupture(&mut self, state: &mut State, broke: &mut dyn FnMut(usize, Criterion, f64)) -> f64 {
        let mut broken = Vec::new();
        let mut released = 0.0;
        for stage in &mut self.stages {
            released += stage.rupture(state, &mut |slot, cause, stress| broken.push((slot, cause, stress)));
        }
        broken.sort_by_key(|(slot, ..)| *slot);
        broken.into_iter().for_each(|(slot, cause, stress)| broke(slot, cause, stress));
        released
    }

    fn elastic_energy(&self, state: &State) -> f64 {
        self.stages.iter().map(|stage| stage.elastic_energy(state)).sum()
    }

    fn elements(&self, state: &State, chunk: usize, each: &mut dyn FnMut(Element)) {
        self.stages.iter().for_each(|stage| stage.elements(state, chunk, each));
    }

    fn stress(&self, slot: usize) -> f64 {
        self.of(slot).stress(slot)
    }

    fn axial_force(&self, slot: usize) -> f64 {
        self.of(slot).axial_force(slot)
    }

    fn plastic_strain(&self, slot: usize) -> f64 {
        self.of(slot).plastic_strain(slot)
    }

    fn utilisation(&self, slot: usize, state: &State) -> f64 {
        self.of(slot).utilisation(slot, state)
    }

    fn bytes(&self) -> Bytes {
        let mut sum = Bytes { kept: behind(&self.material_of), moved: 0 };
        for Bytes { kept, moved } in self.stages.iter().map(|stage| stage.bytes()) {
            sum.kept += kept;
            sum.moved += moved;
        }
        sum
    }

    fn record(&self) -> Result<Function, String> {
        Err("its wires are of several materials".into())
    }

    fn numbers(&self, _: &str) -> Option<Vec<f64>> {
        None
    }

    fn set_numbers(&mut self, _: &str, _: &[f64]) {}

    fn save(&self, out: &mut Writer) {
        self.stages.iter().for_each(|stage| stage.save(out));
    }

    fn restore(&mut self, from: &mut Reader) -> Result<(), Unfit> {
        self.stages.iter_mut().try_for_each(|stage| stage.restore(from))
    }
}
