//! Wires as a list of capsules, one per holding bond, for the shader `wires.wgsl`.

use super::colour::{desaturated, linear4, signal4};
use super::occlusion::Occlusion;
use super::style::Rgb;
use crate::engine::view::{BondState, RunInfo, Snapshot, WireInfo};
use glam::Vec3;

/// A piece of wire between two bonded particles, or a sphere (both ends the same).
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Segment {
    /// First centre and radius (m).
    pub a: [f32; 4],
    /// Second centre and radius (m).
    pub b: [f32; 4],
    /// Unit tangent of the wire at `a`, and the kind of this end ([`JOINT`], [`END`], [`CUT`], [`NECK`],
    /// [`BROKEN`]).
    pub tangent_a: [f32; 4],
    /// The same at `b`.
    pub tangent_b: [f32; 4],
    /// Linear colour at `a`, and the shade of the wire, 0 to 1.
    pub colour_a: [f32; 4],
    /// Linear colour at `b`.
    pub colour_b: [f32; 4],
    /// Occlusion at `a`, see [`Occlusion`].
    pub occlusion_a: [f32; 4],
    /// Occlusion at `b`.
    pub occlusion_b: [f32; 4],
}

/// The wire goes on.
pub const JOINT: f32 = 0.0;
/// The wire ends as it was made: round.
pub const END: f32 = 1.0;
/// The wire was cut off to show what lies behind it: flat.
pub const CUT: f32 = 2.0;
/// The wire goes on as the tip of a broken end: open, with a band of the signal colour.
pub const NECK: f32 = 3.0;
/// The face of a broken end: flat, in the signal colour.
pub const BROKEN: f32 = 4.0;
/// Where a section meets a wire that is broken somewhere: a face with a ring of the signal colour.
pub const HOLLOW: f32 = 5.0;
/// Where a section meets a wire that is whole: a face in its own colour, with a ring around it.
pub const DISC: f32 = 6.0;
/// The wire goes on behind, and nothing of it may bulge beyond the other end: flat, without a face.
pub const OPEN: f32 = 7.0;

/// Length of the tip that a broken end is drawn with, and the radius of its face, both over the wire's radius (-):
/// ductile copper necks before it parts. The particle itself is a sphere, so the tip stays inside what collides.
const TIP: [f32; 2] = [0.8, 0.55];

/// Steps of the 8 bits of a colour that a longer segment may lack.
const SHADES: i32 = 3;

/// Most bonds that a segment may stand for, where particles lie `spacing` pixels apart: it is about sixteen pixels long.
pub fn stride(spacing: f32) -> usize {
    (16.0 / spacing).clamp(1.0, 16.0) as usize
}

/// What is drawn of a snapshot, per particle.
pub struct Looks {
    /// Centres (m): those of the snapshot, or moved apart.
    position: Vec<[f32; 3]>,
    /// Direction of the wire: the mean of the bonds that hold a particle, or z where none does.
    tangent: Vec<Vec3>,
    /// Colours, sRGB.
    colour: Vec<Rgb>,
    occlusion: Occlusion,
    /// Shade per wire (-): 1 outside, less further in, so that what lies below a gap reads as deeper.
    shade: Vec<f32>,
    /// Particles that are left out, so that what lies behind them is seen; empty when none is.
    removed: Vec<bool>,
    /// Wires that are see-through; empty when none is.
    ghosts: Vec<bool>,
    /// z of a plane beyond which all is left out (m): wires end in it.
    section: Option<f32>,
}

impl Looks {
    /// Wires with their particles at `position` (m), each in its `shade` (-), without the `removed` ones.
    pub fn new(
        info: &RunInfo,
        snapshot: &Snapshot,
        position: Vec<[f32; 3]>,
        colours: &[Rgb],
        shade: Vec<f32>,
        removed: Vec<bool>,
    ) -> Self {
        let occlusion = Occlusion::new(info, &position, &snapshot.radius, &removed);
        let tangent = tangents(info, snapshot, &position);
        let (ghosts, section) = (Vec::new(), None);
        Self { position, tangent, colour: colours.to_vec(), occlusion, shade, removed, ghosts, section }
    }

    /// The same in other colours.
    pub fn with_colours(self, colour: Vec<Rgb>) -> Self {
        Self { colour, ..self }
    }

    /// The same with an occlusion that was found before.
    #[cfg(feature = "explore")]
    pub fn with_occlusion(self, occlusion: Occlusion) -> Self {
        Self { occlusion, ..self }
    }

    /// The same with wires that are see-through.
    #[cfg(feature = "explore")]
    pub fn with_ghosts(self, ghosts: Vec<bool>) -> Self {
        Self { ghosts, ..self }
    }

    /// The same, where what was left out lies beyond the plane at this z (m).
    #[cfg(feature = "explore")]
    pub fn with_section(self, section: Option<f32>) -> Self {
        Self { section, ..self }
    }

    /// Shade of a wire (-); the shader draws see-through what has one below zero.
    pub fn shade_of(&self, wire: usize) -> f32 {
        let ghost = self.ghosts.get(wire).copied().unwrap_or(false);
        self.shade[wire] * if ghost { -1.0 } else { 1.0 }
    }

    /// Centre of particle `i` as it is drawn (m), and direction of its wire.
    pub fn place(&self, i: usize) -> (Vec3, Vec3) {
        (self.position[i].into(), self.tangent[i])
    }

    /// What is hidden of the surroundings of particle `i`, see [`Occlusion`].
    pub fn occlusion(&self, i: usize) -> [f32; 4] {
        self.occlusion.at(i)
    }

    /// Whether particle `i` is shown.
    pub fn shows(&self, i: usize) -> bool {
        !self.removed.get(i).copied().unwrap_or(false)
    }
}

/// Mean direction of the bonds that hold each particle; along z for a lone one.
fn tangents(info: &RunInfo, snapshot: &Snapshot, position: &[[f32; 3]]) -> Vec<Vec3> {
    let mut all = vec![Vec3::Z; position.len()];
    for wire in &info.wires {
        let mut before = Vec3::ZERO;
        for i in wire.particles() {
            let holds = i + 1 < wire.particles().end && snapshot.bond_state[i].holds();
            let along = || Vec3::from(position[i + 1]) - Vec3::from(position[i]);
            let after = if holds { along().normalize_or_zero() } else { Vec3::ZERO };
            all[i] = (before + after).try_normalize().unwrap_or(Vec3::Z);
            before = after;
        }
    }
    all
}

/// The segments of every wire and sphere. Where a wire is straight and its colour changes evenly, up to `stride` bonds share a
/// segment: small pictures need no more. Of one layer alone where `layer` names it, and of what a camera `sees` between two spheres.
pub fn segments(
    info: &RunInfo,
    snapshot: &Snapshot,
    looks: &Looks,
    stride: usize,
    layer: Option<usize>,
    sees: impl Fn([f32; 4], [f32; 4]) -> bool,
) -> Vec<Segment> {
    let mut all = Vec::new();
    let shown = |wire: &WireInfo| layer.is_none_or(|layer| layer == wire.layer);
    for (number, wire) in info.wires.iter().enumerate().filter(|(_, wire)| shown(wire)) {
        let shade = looks.shade_of(number);
        let chain = Chain { info, snapshot, looks, wire, shade };
        chain.segments(stride, &sees, &mut all);
        if let Some(z) = looks.section {
            chain.up_to_section(z, &sees, &mut all);
        }
    }
    let spheres = (info.wire_particles..snapshot.position.len()).filter(|i| layer.is_none() && looks.shows(*i));
    let point = |i: usize| Vec3::from(looks.position[i]).extend(snapshot.radius[i]).to_array();
    let spheres = spheres.filter(|i| sees(point(*i), point(*i)));
    all.extend(spheres.map(|i| sphere(point(i), looks, i)));
    all
}

struct Chain<'a> {
    info: &'a RunInfo,
    snapshot: &'a Snapshot,
    looks: &'a Looks,
    wire: &'a WireInfo,
    shade: f32,
}

impl Chain<'_> {
    fn segments(&self, stride: usize, sees: &impl Fn([f32; 4], [f32; 4]) -> bool, all: &mut Vec<Segment>) {
        let last = self.wire.first + self.wire.len.saturating_sub(1);
        let mut i = self.wire.first;
        while i < last {
            let mut j = i + 1;
            if self.drawn(i) {
                while j < last && j - i < stride && self.drawn(j) && self.straight(i, j + 1) && self.fades(i, j + 1) {
                    j += 1;
                }
                // The tips reach no further than the spheres.
                if sees(self.point(i), self.point(j)) {
                    let segment = self.between(i, j);
                    all.push(segment);
                    all.extend(tips(&segment));
                }
            }
            i = j;
        }
        for i in self.wire.particles() {
            let alone = self.looks.shows(i) && !self.holds_before(i) && !self.holds_after(i);
            if alone && sees(self.point(i), self.point(i)) {
                all.push(self.lone(i));
            }
        }
    }

    /// What lies between the plane at `z` (m) and the last particle before it, which a bond crosses.
    fn up_to_section(&self, z: f32, sees: &impl Fn([f32; 4], [f32; 4]) -> bool, all: &mut Vec<Segment>) {
        let bonds = self.wire.bonds();
        let broken = bonds.clone().any(|bond| self.snapshot.bond_state[bond] == BondState::Broken);
        for i in bonds.filter(|i| self.holds(*i) && self.looks.shows(*i) != self.looks.shows(*i + 1)) {
            let (from, to) = if self.looks.shows(i) { (i, i + 1) } else { (i + 1, i) };
            let height = |p: usize| self.looks.position[p][2];
            let share = ((z - height(from)) / (height(to) - height(from))).clamp(0.0, 1.0);
            let between = |a: [f32; 4], b: [f32; 4]| std::array::from_fn(|k| a[k] + share * (b[k] - a[k]));
            let (near, far) = (self.point(from), between(self.point(from), self.point(to)));
            if !sees(near, far) {
                continue;
            }
            let first = self.wire.first;
            let last = first + self.wire.len - 1;
            let outside = if from == i { (i > first).then(|| i - 1) } else { (i + 1 < last).then_some(i + 1) };
            let end = self.kind(outside);
            let along = (Vec3::from_slice(&far) - Vec3::from_slice(&near)).normalize_or_zero();
            let occlusion = self.looks.occlusion.at(from);
            let segment = Segment {
                a: near,
                b: far,
                tangent_a: along.extend(if end == JOINT { OPEN } else { end }).to_array(),
                tangent_b: along.extend(if broken { HOLLOW } else { DISC }).to_array(),
                colour_a: self.colour(from),
                colour_b: between(self.colour(from), self.colour(to)),
                occlusion_a: occlusion,
                occlusion_b: occlusion,
            };
            all.push(segment);
            all.extend(tips(&segment));
        }
    }

    fn holds(&self, bond: usize) -> bool {
        self.snapshot.bond_state[bond].holds()
    }

    /// Whether the bond after particle `i` holds and both its particles are shown.
    fn drawn(&self, i: usize) -> bool {
        self.holds(i) && self.looks.shows(i) && self.looks.shows(i + 1)
    }

    /// Whether the wire turns by less than 2.5° between two particles.
    fn straight(&self, i: usize, j: usize) -> bool {
        self.tangent(i).dot(self.tangent(j)) > 0.999
    }

    /// Whether colours between two particles are what lies between theirs.
    fn fades(&self, i: usize, j: usize) -> bool {
        let colour = |k: usize| self.looks.colour[k].map(i32::from);
        let [from, to] = [i, j].map(colour);
        let length = (j - i) as i32;
        (i + 1..j).all(|k| {
            let (between, at) = (colour(k), (k - i) as i32);
            let off = |c: usize| (length * (between[c] - from[c]) - at * (to[c] - from[c])).abs();
            self.info.in_grip(k) == self.info.in_grip(i) && (0..3).all(|c| off(c) <= SHADES * length)
        }) && self.info.in_grip(i) == self.info.in_grip(j)
    }

    fn holds_before(&self, i: usize) -> bool {
        i > self.wire.first && self.holds(i - 1)
    }

    fn holds_after(&self, i: usize) -> bool {
        i + 1 < self.wire.first + self.wire.len && self.holds(i)
    }

    fn tangent(&self, i: usize) -> Vec3 {
        self.looks.tangent[i]
    }

    /// Kind of the end that a segment has at `i`; `outside` is the bond on its other side there, if there is one.
    fn kind(&self, outside: Option<usize>) -> f32 {
        match outside {
            None => END,
            Some(bond) if self.drawn(bond) => JOINT,
            // What lies up to a section goes on to it.
            Some(bond) if self.holds(bond) => {
                if self.looks.section.is_some() {
                    JOINT
                } else {
                    CUT
                }
            }
            Some(_) => NECK,
        }
    }

    fn between(&self, i: usize, j: usize) -> Segment {
        let last = self.wire.first + self.wire.len - 1;
        let kind_a = self.kind((i > self.wire.first).then(|| i - 1));
        let kind_b = self.kind((j < last).then_some(j));
        Segment {
            a: self.point(i),
            b: self.point(j),
            tangent_a: self.tangent(i).extend(kind_a).to_array(),
            tangent_b: self.tangent(j).extend(kind_b).to_array(),
            colour_a: self.colour(i),
            colour_b: self.colour(j),
            occlusion_a: self.looks.occlusion.at(i),
            occlusion_b: self.looks.occlusion.at(j),
        }
    }

    /// A particle that no bond holds: a crumb between two breaks.
    fn lone(&self, i: usize) -> Segment {
        let tangent = self.tangent(i).extend(END).to_array();
        let broken = self.wire.len > 1;
        let colour = if broken { signal4() } else { self.colour(i) };
        alone(self.point(i), tangent, colour, self.looks.occlusion.at(i))
    }

    /// Centre and radius (m).
    fn point(&self, i: usize) -> [f32; 4] {
        Vec3::from(self.looks.position[i]).extend(self.snapshot.radius[i]).to_array()
    }

    fn colour(&self, i: usize) -> [f32; 4] {
        let colour = self.looks.colour[i];
        let shown = if self.info.in_grip(i) { desaturated(colour) } else { colour };
        let [r, g, b, _] = linear4(shown);
        [r, g, b, self.shade]
    }
}

/// The necked tips of a segment's broken ends, each a short cone with a flat face.
fn tips(segment: &Segment) -> impl Iterator<Item = Segment> {
    let [a, b] = [segment.a, segment.b].map(|p| Vec3::new(p[0], p[1], p[2]));
    let along = (b - a).normalize_or_zero();
    let tip = |root: [f32; 4], out: Vec3, occlusion| {
        let [length, face] = TIP.map(|t| t * root[3]);
        let end = Vec3::new(root[0], root[1], root[2]) + out * length;
        Segment {
            a: root,
            b: end.extend(face).to_array(),
            tangent_a: out.extend(NECK).to_array(),
            tangent_b: out.extend(BROKEN).to_array(),
            colour_a: signal4(),
            colour_b: signal4(),
            occlusion_a: occlusion,
            occlusion_b: occlusion,
        }
    };
    let before = (segment.tangent_a[3] == NECK).then(|| tip(segment.a, -along, segment.occlusion_a));
    let after = (segment.tangent_b[3] == NECK).then(|| tip(segment.b, along, segment.occlusion_b));
    before.into_iter().chain(after)
}

fn sphere(point: [f32; 4], looks: &Looks, i: usize) -> Segment {
    alone(point, Vec3::Z.extend(END).to_array(), linear4(looks.colour[i]), looks.occlusion.at(i))
}

fn alone(point: [f32; 4], tangent: [f32; 4], colour: [f32; 4], occlusion: [f32; 4]) -> Segment {
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
