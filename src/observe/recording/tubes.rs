//! Wires as smooth tubes: capsules along each unbroken stretch.
//!
//! A capsule spans a few bonds: over three bonds of a stretched KA4 wire its axis departs from the helix by less than
//! a twentieth of the wire's radius. Its radius is the mean over the particles that it spans, so that a wire that
//! necks is seen to neck. At a broken bond a capsule spans one bond, so that the coloured tip is short.

use super::names::{PLASTIC_STRAIN, STRESS, UTILISATION};
use super::paint::{Palette, at_broken_bond};
use super::stream::{bond_field, colours, in_mm, in_mpa, numbers, vectors};
use crate::engine::view::{BondState, Snapshot, WireInfo};
use glam::{Quat, Vec3};
use rerun::{Capsules3D, SerializedComponentBatch};
use std::ops::Range;
use std::sync::Arc;

/// Bonds that one capsule spans.
const SPAN: usize = 3;

/// Tubes of one wire in a batch of snapshots.
pub(super) fn batches(
    snapshots: &[Arc<Snapshot>],
    palette: &Palette,
    wire: &WireInfo,
    number: usize,
) -> Vec<(SerializedComponentBatch, Vec<usize>)> {
    let pieces: Vec<Vec<Range<usize>>> = snapshots.iter().map(|s| pieces(s, wire)).collect();
    let each: Vec<usize> = pieces.iter().map(Vec::len).collect();
    let all = || snapshots.iter().zip(&pieces).flat_map(|(s, pieces)| pieces.iter().map(move |piece| (s, piece)));
    let middle = |piece: &Range<usize>| (piece.start + piece.end) / 2;
    let value = |field: &'static str, of: fn(&Snapshot, usize) -> f32| {
        let values = all().map(|(s, piece)| of(s, wire.first + middle(piece)));
        (numbers(bond_field(field), values), each.clone())
    };
    let axes: Vec<Vec3> = all().map(|(s, piece)| axis(s, wire, piece)).collect();
    let starts = all().map(|(s, piece)| place(s, wire, piece.start));
    let turns = axes.iter().map(|a| Quat::from_rotation_arc(Vec3::Z, a.normalize_or(Vec3::Z)).to_array());
    let radii = all().map(|(s, piece)| radius(s, wire, piece));
    let paint = all().map(|(s, piece)| {
        let shown = [piece.start, piece.end].into_iter().find(|k| at_broken_bond(s, wire, *k));
        palette.particle(s, wire, number, shown.unwrap_or(middle(piece)))
    });
    vec![
        (vectors(Capsules3D::descriptor_translations(), starts), each.clone()),
        (vectors(Capsules3D::descriptor_quaternions(), turns), each.clone()),
        (numbers(Capsules3D::descriptor_lengths(), axes.iter().map(|a| a.length())), each.clone()),
        (numbers(Capsules3D::descriptor_radii(), radii), each.clone()),
        (colours(Capsules3D::descriptor_colors(), paint), each.clone()),
        value(STRESS, |s, slot| in_mpa(s.bond_stress[slot])),
        value(PLASTIC_STRAIN, |s, slot| s.plastic_strain[slot]),
        value(UTILISATION, |s, slot| s.utilisation[slot]),
    ]
}

/// Where a wire's particle `k` is (mm).
fn place(snapshot: &Snapshot, wire: &WireInfo, k: usize) -> [f32; 3] {
    in_mm(snapshot.position[wire.first + k])
}

fn axis(snapshot: &Snapshot, wire: &WireInfo, piece: &Range<usize>) -> Vec3 {
    let [a, b] = [piece.start, piece.end].map(|k| Vec3::from(place(snapshot, wire, k)));
    b - a
}

fn radius(snapshot: &Snapshot, wire: &WireInfo, piece: &Range<usize>) -> f32 {
    let radii = &snapshot.radius[wire.first + piece.start..=wire.first + piece.end];
    let [mean] = in_mm([radii.iter().sum::<f32>() / radii.len() as f32]);
    mean
}

/// Pieces from particle to particle, counted along the wire; none spans a broken bond.
fn pieces(snapshot: &Snapshot, wire: &WireInfo) -> Vec<Range<usize>> {
    let bonds = wire.len.saturating_sub(1);
    let broken = |bond: usize| snapshot.bond_state[wire.first + bond] == BondState::Broken;
    let mut pieces = Vec::new();
    let mut start = 0;
    for bond in 0..bonds {
        if broken(bond) {
            start = bond + 1;
            continue;
        }
        let end = bond + 1;
        let last = end == bonds || broken(end);
        let tip = (start > 0 && broken(start - 1) && end - start == 1) || (end + 1 < bonds && broken(end + 1));
        if last || tip || end - start == SPAN {
            pieces.push(start..end);
            start = end;
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_cover_every_bond_that_holds_and_no_other() {
        let len = 23;
        let wire = WireInfo { layer: 0, material: 0, first: 0, len, diameter: 1.0 };
        for broken in [vec![], vec![0], vec![21], vec![3, 4], vec![8, 9, 10, 17]] {
            let mut bond_state = vec![BondState::Whole; len];
            broken.iter().for_each(|b: &usize| bond_state[*b] = BondState::Broken);
            let snapshot = Snapshot { bond_state, ..Snapshot::default() };
            let covered: Vec<usize> = pieces(&snapshot, &wire).into_iter().flatten().collect();
            let expected: Vec<usize> = (0..len - 1).filter(|b| !broken.contains(b)).collect();
            assert_eq!(covered, expected, "{broken:?}");
            for piece in pieces(&snapshot, &wire) {
                let tip = at_broken_bond(&snapshot, &wire, piece.start) || at_broken_bond(&snapshot, &wire, piece.end);
                assert!(piece.len() == 1 || !tip && piece.len() <= SPAN, "{piece:?} of {broken:?}");
            }
        }
    }
}
