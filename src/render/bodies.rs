//! Rigid bodies for the shader of wires, as thick pieces of wire with round ends.

use super::colour::linear4;
use super::style::Rgb;
use super::wires::{END, Segment};
use crate::engine::view::{RunInfo, Snapshot};
use crate::observe::shapes::{Piece, pieces};
use glam::Vec3;

/// Steel, which no colour map has.
const COLOUR: Rgb = [128, 138, 152];

/// All rigid bodies of a snapshot.
pub fn segments(info: &RunInfo, snapshot: &Snapshot) -> impl Iterator<Item = Segment> {
    pieces(info, snapshot).into_iter().map(segment)
}

fn segment(Piece { ends, radius }: Piece) -> Segment {
    let tangent = (ends[1] - ends[0]).normalize_or(Vec3::Z).extend(END).to_array();
    let [a, b] = ends.map(|end| end.extend(radius).to_array());
    let colour = linear4(COLOUR);
    Segment {
        a,
        b,
        tangent_a: tangent,
        tangent_b: tangent,
        colour_a: colour,
        colour_b: colour,
        occlusion_a: [0.0; 4],
        occlusion_b: [0.0; 4],
    }
}
