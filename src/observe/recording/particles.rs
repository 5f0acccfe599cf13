//! Particles: a batch of snapshots becomes one chunk per wire, with everything that there is to draw it in space and on the
//! map, once.

use super::names::{CONTACT_PRESSURE, LENGTH, PLASTIC_STRAIN, SPEED, STATE, STRESS, TURN, UTILISATION, descriptor};
use super::paint::{Palette, slot};
use super::stream::{Column, Instant, Stream, classes, colours, half_vectors, in_mm, in_mpa, numbers, vectors};
use super::tubes::{Capsule, Drawn};
use super::{names, tubes};
use crate::base::error::Result;
use crate::engine::view::{BondState, RunInfo, Snapshot, WireInfo};
use crate::scene::spec::ColourBy;
use rerun::components::FillMode;
use rerun::{Capsules3D, Points3D, SerializedComponentBatch};
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
    /// Sends wires and free spheres; `drawn` is what was recorded of each wire so far.
    pub fn send(&self, stream: &Stream, drawn: &mut [Drawn]) -> Result<()> {
        for (number, drawn) in drawn.iter_mut().enumerate() {
            stream.rows(names::wire(names::STRAND, self.info, number), self.instants, self.wire(number, drawn))?;
        }
        if self.info.particles > self.info.wire_particles {
            stream.rows(names::SPHERES, self.instants, self.spheres())?;
        }
        Ok(())
    }

    fn wire(&self, number: usize, drawn: &mut Drawn) -> Vec<Column> {
        let wire = &self.info.wires[number];
        let each = || vec![wire.len; self.snapshots.len()];
        let particles = || self.snapshots.iter().flat_map(|s| (0..wire.len).map(move |k| (s, k)));
        let positions = self.snapshots.iter().flat_map(|s| s.position[wire.particles()].iter().copied().map(in_mm));
        let paint = particles().map(|(s, k)| self.palette.particle(s, wire, number, k));
        let field = |name, value: fn(&Snapshot, usize) -> f32| -> Column {
            (numbers(descriptor(name), particles().map(|(s, k)| value(s, slot(wire, k)))), each()).into()
        };
        let pressure = particles().map(|(s, k)| in_mpa(s.contact_pressure[wire.first + k]));
        let mut columns = vec![
            (vectors(Points3D::descriptor_positions(), positions), each()).into(),
            (colours(Points3D::descriptor_colors(), paint), each()).into(),
            field(STRESS, |s, slot| in_mpa(s.bond_stress[slot])),
            field(PLASTIC_STRAIN, |s, slot| s.plastic_strain[slot]),
            field(UTILISATION, |s, slot| s.utilisation[slot]),
            (numbers(descriptor(CONTACT_PRESSURE), pressure), each()).into(),
        ];
        if self.palette.by() == ColourBy::Velocity {
            let speed = particles().map(|(s, k)| s.speed[wire.first + k]);
            columns.push((numbers(descriptor(SPEED), speed), each()).into());
        }
        columns.extend(self.changes(wire, drawn));
        columns
    }

    /// What is sent only in those snapshots in which it has changed.
    fn changes(&self, wire: &WireInfo, drawn: &mut Drawn) -> [Column; 4] {
        let (mut turns, mut lengths, mut radii, mut states) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let [mut turned, mut longer, mut thinned, mut became] = [const { Vec::new() }; 4];
        for snapshot in self.snapshots {
            let capsules = tubes::capsules(snapshot, wire);
            let of = |anew: bool| anew.then_some(&capsules);
            let turn = of(drawn.turns(&capsules));
            turned.push(turn.map(Vec::len));
            turns.extend(turn.into_iter().flatten().map(Capsule::turn));
            let length = of(drawn.lengths(&capsules));
            longer.push(length.map(Vec::len));
            lengths.extend(length.into_iter().flatten().map(Capsule::length));
            let thinner = drawn.radii(snapshot, wire);
            thinned.push(thinner.map(<[_]>::len));
            radii.extend(thinner.into_iter().flatten().map(|r| in_mm([*r])[0]));
            let now = drawn.states((0..wire.len).map(|k| snapshot.bond_state[slot(wire, k)]).collect());
            became.push(now.map(<[_]>::len));
            states.extend(now.into_iter().flatten().map(|state| *state as u16));
        }
        [
            Column::sparse(half_vectors(descriptor(TURN), turns.into_iter()), turned),
            Column::sparse(numbers(descriptor(LENGTH), lengths.into_iter()), longer),
            Column::sparse(numbers(Points3D::descriptor_radii(), radii.into_iter()), thinned),
            Column::sparse(classes(descriptor(STATE), states.into_iter()), became),
        ]
    }

    fn spheres(&self) -> [(SerializedComponentBatch, Vec<usize>); 3] {
        let range = self.info.wire_particles..self.info.particles;
        let each = vec![range.len(); self.snapshots.len()];
        let positions = self.snapshots.iter().flat_map(|s| s.position[range.clone()].iter().copied().map(in_mm));
        let paint = self.snapshots.iter().flat_map(|s| range.clone().map(|i| self.palette.sphere(s, i)));
        let speed = self.snapshots.iter().flat_map(|s| s.speed[range.clone()].iter().copied());
        [
            (vectors(Points3D::descriptor_positions(), positions), each.clone()),
            (colours(Points3D::descriptor_colors(), paint), each.clone()),
            (numbers(descriptor(SPEED), speed), each),
        ]
    }
}

/// Sends the style of tubes.
pub(super) fn send_styles(stream: &Stream, info: &RunInfo) -> Result<()> {
    let solid = Capsules3D::update_fields().with_fill_mode(FillMode::Solid);
    (0..info.wires.len()).try_for_each(|w| stream.fixed(names::wire(names::STRAND, info, w), &solid))
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
