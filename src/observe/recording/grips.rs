//! Grips: a cylinder around what each holds.

use super::stream::{Instant, Stream, in_mm, numbers, vectors};
use super::{names, paint};
use crate::base::error::Result;
use crate::engine::view::{RunInfo, Snapshot};
use glam::Vec2;
use rerun::{Color, Cylinders3D};
use std::sync::Arc;

/// Radius of a grip over that of what it holds (-): it is around it.
const AROUND: f32 = 1.2;

/// A cylinder about the z axis or beside it (mm).
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cylinder {
    centre: [f32; 3],
    radius: f32,
    length: f32,
}

/// Sends a cylinder per grip and snapshot. A grip is where the particles of the outermost layer are that lay beyond its
/// face before loading: that layer is held by every kind of grip.
pub(super) fn send(stream: &Stream, info: &RunInfo, instants: &[Instant], snapshots: &[Arc<Snapshot>]) -> Result<()> {
    let Some([lower, upper]) = info.gauge.map(|faces| faces.map(|z| z as f32)) else { return Ok(()) };
    let held = [held(info, |z| z <= lower), held(info, |z| z >= upper)];
    if held.iter().any(Vec::is_empty) {
        return Ok(());
    }
    let grips: Vec<_> = snapshots.iter().flat_map(|s| held.iter().map(|h| around(s, h))).collect();
    let each = || vec![held.len(); snapshots.len()];
    stream.rows(
        names::GRIPS,
        instants,
        [
            (vectors(Cylinders3D::descriptor_centers(), grips.iter().map(|grip| grip.centre)), each()),
            (numbers(Cylinders3D::descriptor_radii(), grips.iter().map(|grip| grip.radius)), each()),
            (numbers(Cylinders3D::descriptor_lengths(), grips.iter().map(|grip| grip.length)), each()),
        ],
    )
}

/// Sends the colour of grips.
pub(super) fn send_style(stream: &Stream) -> Result<()> {
    stream.fixed(names::GRIPS, &Cylinders3D::update_fields().with_colors([Color::from_u32(paint::NEUTRAL)]))
}

fn held(info: &RunInfo, beyond: impl Fn(f32) -> bool) -> Vec<usize> {
    let outermost = info.layers.len().saturating_sub(1);
    let wires = info.wires.iter().filter(|wire| wire.layer == outermost);
    wires.flat_map(|wire| wire.particles()).filter(|i| beyond(info.rest_position[*i][2])).collect()
}

/// The cylinder around particles, about the middle of where they are.
fn around(snapshot: &Snapshot, particles: &[usize]) -> Cylinder {
    let all = || particles.iter().map(|i| (in_mm(snapshot.position[*i]), in_mm([snapshot.radius[*i]])[0]));
    let across = |[x, y, _]: [f32; 3]| Vec2::new(x, y);
    let middle = all().map(|(p, _)| across(p)).sum::<Vec2>() / particles.len() as f32;
    let low = all().map(|(p, r)| p[2] - r).fold(f32::INFINITY, f32::min);
    let high = all().map(|(p, r)| p[2] + r).fold(f32::NEG_INFINITY, f32::max);
    let radius = AROUND * all().map(|(p, r)| across(p).distance(middle) + r).fold(0.0, f32::max);
    Cylinder { centre: [middle.x, middle.y, 0.5 * (low + high)], radius, length: high - low }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cylinder_holds_what_is_in_a_grip() {
        let position = vec![[2e-3, 1e-3, 0.0], [0.0, 1e-3, 1e-3], [1e-3, 2e-3, 3e-3], [1e-3, 0.0, 2e-3], [9.0; 3]];
        let snapshot = Snapshot { position, radius: vec![0.5e-3; 5], ..Snapshot::default() };
        let Cylinder { centre, radius, length } = around(&snapshot, &[0, 1, 2, 3]);
        let off = [1.0, 1.0, 1.5].iter().zip(centre).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(
            off < 1e-6 && (radius - 1.5 * AROUND).abs() < 1e-6 && (length - 4.0).abs() < 1e-6,
            "{centre:?} {radius} {length}"
        );
    }
}
