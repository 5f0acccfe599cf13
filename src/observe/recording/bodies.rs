//! Rigid bodies, as capsules.

use super::stream::{Instant, Stream, in_mm, numbers, vectors};
use super::{names, paint};
use crate::base::error::Result;
use crate::engine::view::{RunInfo, Snapshot};
use crate::observe::shapes::{Piece, pieces};
use glam::{Quat, Vec3};
use rerun::components::FillMode;
use rerun::{Capsules3D, Color};
use std::sync::Arc;

/// Sends the bodies of some snapshots.
pub(super) fn send(stream: &Stream, info: &RunInfo, instants: &[Instant], snapshots: &[Arc<Snapshot>]) -> Result<()> {
    if info.bodies.is_empty() {
        return Ok(());
    }
    let pieces: Vec<Vec<Piece>> = snapshots.iter().map(|snapshot| pieces(info, snapshot)).collect();
    let each: Vec<usize> = pieces.iter().map(Vec::len).collect();
    let all = || pieces.iter().flatten();
    let place = |point: Vec3| Vec3::from(in_mm(point.to_array()));
    let axis = |piece: &Piece| place(piece.ends[1]) - place(piece.ends[0]);
    let turn = |piece: &Piece| Quat::from_rotation_arc(Vec3::Z, axis(piece).normalize_or(Vec3::Z)).to_array();
    let radii = all().map(|piece| in_mm([piece.radius])[0]);
    stream.rows(
        names::BODIES,
        instants,
        [
            (
                vectors(Capsules3D::descriptor_translations(), all().map(|piece| place(piece.ends[0]).to_array())),
                each.clone(),
            ),
            (vectors(Capsules3D::descriptor_quaternions(), all().map(turn)), each.clone()),
            (numbers(Capsules3D::descriptor_lengths(), all().map(|piece| axis(piece).length())), each.clone()),
            (numbers(Capsules3D::descriptor_radii(), radii), each),
        ],
    )
}

/// Sends their colour.
pub(super) fn send_style(stream: &Stream, info: &RunInfo) -> Result<()> {
    if info.bodies.is_empty() {
        return Ok(());
    }
    let style = Capsules3D::update_fields().with_fill_mode(FillMode::Solid);
    stream.fixed(names::BODIES, &style.with_colors([Color::from_u32(paint::NEUTRAL)]))
}
