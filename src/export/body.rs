//! What a run's particles are, for all formats alike.

use crate::engine::view::{BondState, RunInfo, Snapshot};
use std::sync::Arc;

/// What a run's particles are, and how its snapshots are told of them.
pub struct Body {
    pub info: Arc<RunInfo>,
    /// Wire of each particle, from 1; 0 for free spheres.
    pub wire: Vec<i32>,
    /// Layer of each particle, from 1 inside out; 0 for free spheres.
    pub layer: Vec<i32>,
}

impl Body {
    pub fn new(info: &Arc<RunInfo>) -> Self {
        let (mut wire, mut layer) = (vec![0; info.particles], vec![0; info.particles]);
        for (number, own) in info.wires.iter().enumerate() {
            wire[own.particles()].fill(number as i32 + 1);
            layer[own.particles()].fill(own.layer as i32 + 1);
        }
        Self { info: info.clone(), wire, layer }
    }

    /// Every bond slot with the wire (from 0) that it belongs to, broken ones included.
    pub fn bonds(&self) -> impl Iterator<Item = (usize, usize)> {
        self.info.wires.iter().enumerate().flat_map(|(wire, own)| own.bonds().map(move |slot| (wire, slot)))
    }

    /// The two bond slots beside each particle, where there are such.
    pub fn beside(snapshot: &Snapshot, particle: usize) -> impl Iterator<Item = usize> {
        let there = |slot: &usize| snapshot.bond_state[*slot] != BondState::Absent;
        [particle.checked_sub(1), Some(particle)].into_iter().flatten().filter(there)
    }

    /// A quantity of bonds, as the mean over those beside each particle that hold; 0 where none does.
    pub fn at_particles(snapshot: &Snapshot, quantity: &[f32]) -> Vec<f32> {
        let mean = |particle: usize| {
            let holding = || Self::beside(snapshot, particle).filter(|slot| snapshot.bond_state[*slot].holds());
            holding().map(|slot| quantity[slot]).sum::<f32>() / holding().count().max(1) as f32
        };
        (0..snapshot.position.len()).map(mean).collect()
    }

    /// Whether a bond beside each particle is broken.
    pub fn at_breaks(snapshot: &Snapshot) -> Vec<u8> {
        let broken = |slot: usize| snapshot.bond_state[slot] == BondState::Broken;
        (0..snapshot.position.len()).map(|p| u8::from(Self::beside(snapshot, p).any(broken))).collect()
    }
}

/// Least and greatest coordinates of what the particles fill (m).
pub fn bounds(position: &[[f32; 3]], radius: &[f32]) -> [[f32; 2]; 3] {
    std::array::from_fn(|k| {
        position
            .iter()
            .zip(radius)
            .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], (x, r)| [low.min(x[k] - r), high.max(x[k] + r)])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn particles_get_the_mean_of_the_bonds_that_hold() {
        let bond_state = [BondState::Whole, BondState::Broken, BondState::Yielding, BondState::Absent].to_vec();
        let snapshot = Snapshot { position: vec![[0.0; 3]; 4], bond_state, ..Snapshot::default() };
        assert_eq!(Body::at_particles(&snapshot, &[2.0, 7.0, 4.0, 9.0]), [2.0, 2.0, 4.0, 4.0]);
        assert_eq!(Body::at_breaks(&snapshot), [0, 1, 1, 0]);
    }
}
