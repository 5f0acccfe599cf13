//! Grips: a box around what each holds.

use super::stream::{Instant, Stream, in_mm, vectors};
use super::{names, paint};
use crate::base::error::Result;
use crate::engine::view::{RunInfo, Snapshot};
use rerun::{Boxes3D, Color};
use std::sync::Arc;

/// Sends a box per grip and snapshot. A grip is where the particles of the outermost layer are that lay beyond its
/// face before loading: that layer is held by every kind of grip.
pub(super) fn send(stream: &Stream, info: &RunInfo, instants: &[Instant], snapshots: &[Arc<Snapshot>]) -> Result<()> {
    let Some([lower, upper]) = info.gauge.map(|faces| faces.map(|z| z as f32)) else { return Ok(()) };
    let held = [held(info, |z| z <= lower), held(info, |z| z >= upper)];
    if held.iter().any(Vec::is_empty) {
        return Ok(());
    }
    let boxes: Vec<_> = snapshots.iter().flat_map(|s| held.iter().map(|h| bounds(s, h))).collect();
    let lengths = vec![2; snapshots.len()];
    stream.rows(
        names::GRIPS,
        instants,
        [
            (vectors(Boxes3D::descriptor_centers(), boxes.iter().map(|[c, _]| *c)), lengths.clone()),
            (vectors(Boxes3D::descriptor_half_sizes(), boxes.iter().map(|[_, h]| *h)), lengths.clone()),
        ],
    )
}

/// Sends the colour of the boxes.
pub(super) fn send_style(stream: &Stream) -> Result<()> {
    stream.fixed(names::GRIPS, &Boxes3D::update_fields().with_colors([Color::from_u32(paint::NEUTRAL)]))
}

fn held(info: &RunInfo, beyond: impl Fn(f32) -> bool) -> Vec<usize> {
    let outermost = info.layers.len().saturating_sub(1);
    let wires = info.wires.iter().filter(|wire| wire.layer == outermost);
    wires.flat_map(|wire| wire.particles()).filter(|i| beyond(info.rest_position[*i][2])).collect()
}

/// Centre and half size of the box around particles (mm).
fn bounds(snapshot: &Snapshot, particles: &[usize]) -> [[f32; 3]; 2] {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for &i in particles {
        let ([r], place) = (in_mm([snapshot.radius[i]]), in_mm(snapshot.position[i]));
        for axis in 0..3 {
            low[axis] = low[axis].min(place[axis] - r);
            high[axis] = high[axis].max(place[axis] + r);
        }
    }
    let halves = |f: fn(f32, f32) -> f32| std::array::from_fn(|axis| f(low[axis], high[axis]));
    [halves(|a, b| 0.5 * (a + b)), halves(|a, b| 0.5 * (b - a))]
}
