//! Particles: a batch of snapshots becomes one chunk per wire.

use super::names::{CONTACT_PRESSURE, PLASTIC_STRAIN, SPEED, STATE, STRESS, UTILISATION};
use super::paint::{Palette, slot};
use super::stream::{Instant, Stream, bond_field, classes, colours, in_mm, in_mpa, numbers, vectors};
use super::{names, tubes};
use crate::base::error::Result;
use crate::base::units::mm;
use crate::engine::view::{BondState, RunInfo, Snapshot, WireInfo};
use crate::scene::spec::ColourBy;
use rerun::components::FillMode;
use rerun::{Capsules3D, Points2D, Points3D, SerializedComponentBatch};
use std::sync::Arc;

/// Names of the bond states, in the order of [`BondState`].
pub(super) const STATE_NAMES: [&str; 4] = ["whole", "yielding", "broken", "no bond"];

/// Snapshots that go out together.
pub(super) struct Batch<'a> {
    pub info: &'a RunInfo,
    pub palette: &'a Palette,
    pub instants: &'a [Instant],
    pub snapshots: &'a [Arc<Snapshot>],
}

impl Batch<'_> {
    /// Sends wires, free spheres, grips and the colours of the map.
    pub fn send(&self, stream: &Stream) -> Result<()> {
        for number in 0..self.info.wires.len() {
            stream.rows(names::wire(names::STRAND, self.info, number), self.instants, self.wire(number))?;
            stream.rows(names::tube(names::STRAND, self.info, number), self.instants, self.tube(number))?;
        }
        for layer in 0..self.info.layers.len() {
            stream.rows(names::layer(names::MAP, self.info, layer), self.instants, [self.map_colours(layer)])?;
        }
        if self.info.particles > self.info.wire_particles {
            stream.rows(names::SPHERES, self.instants, self.spheres())?;
        }
        Ok(())
    }

    fn wire(&self, number: usize) -> Vec<(SerializedComponentBatch, Vec<usize>)> {
        let wire = &self.info.wires[number];
        let each = vec![wire.len; self.snapshots.len()];
        let once = vec![1; self.snapshots.len()];
        let particles = || self.snapshots.iter().flat_map(|s| (0..wire.len).map(move |k| (s, k)));
        let positions = self.snapshots.iter().flat_map(|s| s.position[wire.particles()].iter().copied().map(in_mm));
        let paint = particles().map(|(s, k)| self.palette.particle(s, wire, number, k));
        let field = |name, value: fn(&Snapshot, usize) -> f32| {
            (numbers(bond_field(name), particles().map(|(s, k)| value(s, slot(wire, k)))), each.clone())
        };
        let pressure = particles().map(|(s, k)| in_mpa(s.contact_pressure[wire.first + k]));
        let mut batches = vec![
            (vectors(Points3D::descriptor_positions(), positions), each.clone()),
            (colours(Points3D::descriptor_colors(), paint), each.clone()),
            (numbers(Points3D::descriptor_radii(), self.snapshots.iter().map(|s| mean_radius(s, wire))), once),
            field(STRESS, |s, slot| in_mpa(s.bond_stress[slot])),
            field(PLASTIC_STRAIN, |s, slot| s.plastic_strain[slot]),
            field(UTILISATION, |s, slot| s.utilisation[slot]),
            (numbers(bond_field(CONTACT_PRESSURE), pressure), each.clone()),
            (classes(STATE, particles().map(|(s, k)| s.bond_state[slot(wire, k)] as u16)), each.clone()),
        ];
        if self.palette.by() == ColourBy::Velocity {
            batches.push((numbers(bond_field(SPEED), particles().map(|(s, k)| s.speed[wire.first + k])), each));
        }
        batches
    }

    fn tube(&self, number: usize) -> Vec<(SerializedComponentBatch, Vec<usize>)> {
        let wire = &self.info.wires[number];
        tubes::batches(self.snapshots, self.palette, wire, number)
    }

    fn map_colours(&self, layer: usize) -> (SerializedComponentBatch, Vec<usize>) {
        let wires: Vec<_> = self.info.wires_of(layer).collect();
        let count = wires.iter().map(|(_, wire)| wire.len).sum();
        let paint = self.snapshots.iter().flat_map(|s| {
            wires
                .iter()
                .flat_map(move |(number, wire)| (0..wire.len).map(move |k| self.palette.particle(s, wire, *number, k)))
        });
        (colours(Points2D::descriptor_colors(), paint), vec![count; self.snapshots.len()])
    }

    fn spheres(&self) -> Vec<(SerializedComponentBatch, Vec<usize>)> {
        let range = self.info.wire_particles..self.info.particles;
        let each = vec![range.len(); self.snapshots.len()];
        let positions = self.snapshots.iter().flat_map(|s| s.position[range.clone()].iter().copied().map(in_mm));
        let paint = self.snapshots.iter().flat_map(|s| range.clone().map(|i| self.palette.sphere(s, i)));
        let speed = self.snapshots.iter().flat_map(|s| s.speed[range.clone()].iter().copied());
        vec![
            (vectors(Points3D::descriptor_positions(), positions), each.clone()),
            (colours(Points3D::descriptor_colors(), paint), each.clone()),
            (numbers(bond_field(SPEED), speed), each),
        ]
    }
}

/// Sends the style of tubes.
pub(super) fn send_styles(stream: &Stream, info: &RunInfo) -> Result<()> {
    let solid = Capsules3D::update_fields().with_fill_mode(FillMode::Solid);
    (0..info.wires.len()).try_for_each(|w| stream.fixed(names::tube(names::STRAND, info, w), &solid))
}

/// Mean radius of a wire now (mm). One value per wire and snapshot: a wire thins as a whole, and a radius per
/// particle would cost as much as its stress.
fn mean_radius(snapshot: &Snapshot, wire: &WireInfo) -> f32 {
    let radii = &snapshot.radius[wire.particles()];
    (mm(radii.iter().map(|r| f64::from(*r)).sum::<f64>()) / radii.len().max(1) as f64) as f32
}

/// The worst state of a wire's bonds.
pub(super) fn wire_state(snapshot: &Snapshot, wire: &WireInfo) -> BondState {
    let bonds = &snapshot.bond_state[wire.bonds()];
    let any = |state| bonds.contains(&state);
    if any(BondState::Broken) {
        BondState::Broken
    } else if any(BondState::Yielding) {
        BondState::Yielding
    } else {
        BondState::Whole
    }
}
