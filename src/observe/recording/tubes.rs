//! Wires as tubes: straight pieces along each unbroken stretch, so that a stretched wire still looks like one.
//!
//! A piece spans a few bonds, because positions are already there with the particles: over four bonds of a KA4 wire
//! a chord departs from the helix by less than a twentieth of the wire's radius.

use super::paint::Palette;
use super::stream::{colours, numbers, strips};
use crate::engine::view::{BondState, Snapshot, WireInfo};
use rerun::{LineStrips3D, SerializedComponentBatch};
use std::ops::Range;
use std::sync::Arc;

/// Bonds that one piece spans.
const SPAN: usize = 4;
/// Radius of a tube over that of its particles [-]: it fills the gaps of a stretched chain and leaves the particles,
/// which are shaded and can be clicked, in front.
const RADIUS: f32 = 0.8;

/// Tubes of one wire in a batch of snapshots.
pub(super) fn batches(
    snapshots: &[Arc<Snapshot>],
    palette: &Palette,
    wire: &WireInfo,
    number: usize,
    radius: impl Fn(&Snapshot) -> f32,
) -> Vec<(SerializedComponentBatch, Vec<usize>)> {
    let pieces: Vec<Vec<Range<usize>>> = snapshots.iter().map(|s| pieces(s, wire)).collect();
    let each: Vec<usize> = pieces.iter().map(Vec::len).collect();
    let all = || snapshots.iter().zip(&pieces).flat_map(|(s, pieces)| pieces.iter().map(move |piece| (s, piece)));
    let ends = all().flat_map(|(s, piece)| [piece.start, piece.end].map(|k| s.position[wire.first + k]));
    let paint = all().map(|(s, piece)| palette.particle(s, wire, number, (piece.start + piece.end) / 2));
    let radii = snapshots.iter().map(|s| RADIUS * radius(s));
    vec![
        (strips(LineStrips3D::descriptor_strips(), ends, 2), each.clone()),
        (colours(LineStrips3D::descriptor_colors(), paint), each),
        (numbers(LineStrips3D::descriptor_radii(), radii), vec![1; snapshots.len()]),
    ]
}

/// Pieces from particle to particle, counted along the wire; none spans a broken bond.
fn pieces(snapshot: &Snapshot, wire: &WireInfo) -> Vec<Range<usize>> {
    let mut pieces = Vec::new();
    let mut start = 0;
    for bond in 0..wire.len.saturating_sub(1) {
        let broken = snapshot.bond_state[wire.first + bond] == BondState::Broken;
        let last = bond + 2 == wire.len;
        let end = if broken { bond } else { bond + 1 };
        if end > start && (broken || last || end - start == SPAN) {
            pieces.push(start..end);
            start = end;
        }
        if broken {
            start = bond + 1;
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::view::Sample;

    #[test]
    fn pieces_cover_every_bond_that_holds_and_no_other() {
        let len = 23;
        let wire = WireInfo { layer: 0, first: 0, len, diameter: 1.0 };
        for broken in [vec![], vec![0], vec![21], vec![3, 4], vec![8, 9, 10, 17]] {
            let mut bond_state = vec![BondState::Whole; len];
            broken.iter().for_each(|b: &usize| bond_state[*b] = BondState::Broken);
            let snapshot = Snapshot {
                sample: Sample::default(),
                position: vec![[0.0; 3]; len],
                radius: vec![0.5; len],
                speed: vec![0.0; len],
                bond_state,
                bond_stress: vec![0.0; len],
                plastic_strain: vec![0.0; len],
                utilisation: vec![0.0; len],
                contact_pressure: vec![0.0; len],
            };
            let covered: Vec<usize> = pieces(&snapshot, &wire).into_iter().flatten().collect();
            let expected: Vec<usize> = (0..len - 1).filter(|b| !broken.contains(b)).collect();
            assert_eq!(covered, expected, "{broken:?}");
        }
    }
}
