//! Wires as a list of capsules, one per holding bond, for the shader `wires.wgsl`.

use super::colour::{desaturated, linear4, signal4};
use super::style::Rgb;
use crate::engine::view::{BondState, RunInfo, Snapshot, WireInfo};
use glam::Vec3;

/// A piece of wire between two bonded particles, or a sphere (both ends the same).
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Segment {
    /// First centre and radius [mm].
    pub a: [f32; 4],
    /// Second centre and radius [mm].
    pub b: [f32; 4],
    /// Unit tangent of the wire at `a`, and the kind of this end ([`JOINT`], [`END`], [`BROKEN`]).
    pub tangent_a: [f32; 4],
    /// The same at `b`.
    pub tangent_b: [f32; 4],
    /// Linear colour at `a`, and the shade of the wire, 0 to 1.
    pub colour_a: [f32; 4],
    /// Linear colour at `b`.
    pub colour_b: [f32; 4],
    /// Occlusion at `a`, see [`super::occlusion::occlusion`].
    pub occlusion_a: [f32; 4],
    /// Occlusion at `b`.
    pub occlusion_b: [f32; 4],
}

/// The wire goes on.
pub const JOINT: f32 = 0.0;
/// The wire ends as it was made.
pub const END: f32 = 1.0;
/// The wire ends where a bond broke.
pub const BROKEN: f32 = 2.0;

/// What is drawn of a snapshot, per particle.
pub struct Looks {
    /// Centres [mm]: those of the snapshot, or moved apart.
    pub position: Vec<[f32; 3]>,
    /// Colours, sRGB.
    pub colour: Vec<Rgb>,
    /// Occlusion.
    pub occlusion: Vec<[f32; 4]>,
    /// Shade per wire [-]: 1 outside, less further in, so that what lies below a gap reads as deeper.
    pub shade: Vec<f32>,
}

/// The segments of every wire and sphere. Where a wire is straight, up to `stride` bonds share a segment: small
/// pictures need no more.
pub fn segments(info: &RunInfo, snapshot: &Snapshot, looks: &Looks, stride: usize) -> Vec<Segment> {
    let mut all = Vec::with_capacity(snapshot.position.len());
    for (wire, shade) in info.wires.iter().zip(&looks.shade) {
        let chain = Chain { info, snapshot, looks, wire, shade: *shade };
        chain.segments(stride, &mut all);
    }
    for i in info.wire_particles..snapshot.position.len() {
        all.push(sphere(snapshot, looks, i));
    }
    all
}

/// Whether bond slot `b` holds.
pub fn holds(snapshot: &Snapshot, b: usize) -> bool {
    matches!(snapshot.bond_state[b], BondState::Whole | BondState::Yielding)
}

/// Whether a particle lies in a grip before loading.
pub fn in_grip(info: &RunInfo, i: usize) -> bool {
    let z = info.rest_position[i][2];
    info.gauge.is_some_and(|[low, high]| z < low || z > high)
}

struct Chain<'a> {
    info: &'a RunInfo,
    snapshot: &'a Snapshot,
    looks: &'a Looks,
    wire: &'a WireInfo,
    shade: f32,
}

impl Chain<'_> {
    fn segments(&self, stride: usize, all: &mut Vec<Segment>) {
        let last = self.wire.first + self.wire.len.saturating_sub(1);
        let mut i = self.wire.first;
        while i < last {
            let mut j = i + 1;
            if holds(self.snapshot, i) {
                while j < last && j - i < stride && holds(self.snapshot, j) && self.straight(i, j + 1) {
                    j += 1;
                }
                all.push(self.between(i, j));
            }
            i = j;
        }
        for i in self.wire.first..self.wire.first + self.wire.len {
            if !self.holds_before(i) && !self.holds_after(i) {
                all.push(self.between(i, i));
            }
        }
    }

    /// Whether the wire turns by less than 2.5° between two particles.
    fn straight(&self, i: usize, j: usize) -> bool {
        self.tangent(i).dot(self.tangent(j)) > 0.999
    }

    fn holds_before(&self, i: usize) -> bool {
        i > self.wire.first && holds(self.snapshot, i - 1)
    }

    fn holds_after(&self, i: usize) -> bool {
        i + 1 < self.wire.first + self.wire.len && holds(self.snapshot, i)
    }

    fn position(&self, i: usize) -> Vec3 {
        Vec3::from(self.looks.position[i])
    }

    /// Mean direction of the bonds that hold particle `i`; along z for a lone one.
    fn tangent(&self, i: usize) -> Vec3 {
        let from = if self.holds_before(i) { i - 1 } else { i };
        let to = if self.holds_after(i) { i + 1 } else { i };
        let one = |a: usize, b: usize| (self.position(b) - self.position(a)).normalize_or_zero();
        (one(from, i) + one(i, to)).try_normalize().unwrap_or(Vec3::Z)
    }

    /// Kind of the end that the wire has at `i`, seen from a bond on the other side of `i`.
    fn kind(&self, i: usize, goes_on: bool, outermost: usize) -> f32 {
        match (goes_on, i == outermost) {
            (true, _) => JOINT,
            (false, true) => END,
            (false, false) => BROKEN,
        }
    }

    fn between(&self, i: usize, j: usize) -> Segment {
        let last = self.wire.first + self.wire.len - 1;
        let point = |k: usize| self.position(k).extend(self.snapshot.radius[k]).to_array();
        let kind_a = self.kind(i, self.holds_before(i), self.wire.first);
        let kind_b = self.kind(j, self.holds_after(j), last);
        Segment {
            a: point(i),
            b: point(j),
            tangent_a: self.tangent(i).extend(kind_a).to_array(),
            tangent_b: self.tangent(j).extend(kind_b).to_array(),
            colour_a: self.colour(i),
            colour_b: self.colour(j),
            occlusion_a: self.looks.occlusion[i],
            occlusion_b: self.looks.occlusion[j],
        }
    }

    fn colour(&self, i: usize) -> [f32; 4] {
        let colour = self.looks.colour[i];
        let shown = if in_grip(self.info, i) { desaturated(colour) } else { colour };
        let [r, g, b, _] = linear4(shown);
        [r, g, b, self.shade]
    }
}

fn sphere(snapshot: &Snapshot, looks: &Looks, i: usize) -> Segment {
    let point = Vec3::from(looks.position[i]).extend(snapshot.radius[i]).to_array();
    let tangent = Vec3::Z.extend(END).to_array();
    let colour = linear4(looks.colour[i]);
    let occlusion = looks.occlusion[i];
    Segment {
        a: point,
        b: point,
        tangent_a: tangent,
        tangent_b: tangent,
        colour_a: colour,
        colour_b: colour,
        occlusion_a: occlusion,
        occlusion_b: occlusion,
    }
}

/// The colour of broken ends as the shader takes it.
pub fn signal() -> [f32; 4] {
    signal4()
}
