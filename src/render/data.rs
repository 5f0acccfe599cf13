//! What the panels of one frame are drawn from.

use super::body::Body;
use super::camera::Camera;
use super::close_up::Focus;
use super::colour::ColourScale;
use super::history::Row;
use super::style::{Rgb, Style};
use super::wires::Looks;
use crate::engine::view::{RunInfo, Rupture, Snapshot};
use crate::observe::wording::wire_number;
use crate::scene::spec::CameraSpec;
use glam::Vec3;

/// One instant of a run, and how it is to look.
pub struct Data<'a> {
    /// The run.
    pub info: &'a RunInfo,
    /// Its body at rest.
    pub body: &'a Body,
    /// The instant.
    pub snapshot: &'a Snapshot,
    /// Rows of the curve so far.
    pub rows: &'a [Row],
    /// Time (s) and what is measured of bodies without grips, so far: [`super::kind::Kind::measure`].
    pub measured: &'a [[f64; 2]],
    /// Ruptures so far, in order.
    pub ruptures: &'a [Rupture],
    /// Colour scale.
    pub scale: &'a ColourScale,
    /// Colour of each particle.
    pub colours: &'a [Rgb],
    /// Theme.
    pub style: &'a Style,
    /// Viewpoint.
    pub camera: &'a CameraSpec,
    /// Where close-ups look.
    pub focus: Focus,
}

impl Data<'_> {
    /// Each wire's first rupture with its number in the order in which wires broke, from 1.
    pub fn first_breaks(&self) -> impl Iterator<Item = (usize, &Rupture)> {
        self.ruptures.iter().filter(|r| r.first_of_wire).enumerate().map(|(k, r)| (k + 1, r))
    }

    /// Where the broken bond is now, between its two particles (m).
    pub fn place(&self, rupture: &Rupture) -> Vec3 {
        let [a, b] = self.broken_ends(rupture);
        0.5 * (a + b)
    }

    /// Where the two ends of a broken bond are now (m).
    fn broken_ends(&self, rupture: &Rupture) -> [Vec3; 2] {
        [rupture.bond, rupture.bond + 1].map(|i| Vec3::from(self.snapshot.position[i]))
    }

    /// The pixel of an end of a broken bond on the side that the camera sees, moved by `shift` (m): of the one nearer to the
    /// body's axis; `None` where neither lies in the panel.
    pub fn seen_end(&self, rupture: &Rupture, camera: &Camera, shift: Vec3) -> Option<[f32; 2]> {
        let faces = |p: &Vec3| camera.to_view(*p).z > 0.0;
        let inside = |[x, y]: &[f32; 2]| {
            let panel = camera.panel;
            (panel.x..panel.right()).contains(x) && (panel.y..panel.bottom()).contains(y)
        };
        let ends = self.broken_ends(rupture);
        let [a, b] = ends.map(|p| (p.x - self.body.axis.x).hypot(p.y - self.body.axis.y));
        let ends = if b < a { [ends[1], ends[0]] } else { ends };
        ends.map(|p| p + shift).iter().filter(|p| faces(p)).map(|p| camera.project(*p)).find(inside)
    }

    /// What tells of a break, such as `2: wire 30 (outer)`, with the layer or without.
    pub fn words(&self, number: usize, rupture: &Rupture, layer: bool) -> String {
        let wire = wire_number(rupture.wire);
        match self.info.layers.get(rupture.layer).filter(|name| layer && self.info.layers.len() > 1 && !name.is_empty())
        {
            Some(name) => format!("{number}: wire {wire} ({name})"),
            None => format!("{number}: wire {wire}"),
        }
    }

    /// Wires with their particles at `position` (m), all equally bright, without the `removed` ones.
    pub fn looks(&self, position: Vec<[f32; 3]>, removed: Vec<bool>) -> Looks {
        let bright = vec![1.0; self.info.wires.len()];
        Looks::new(self.info, self.snapshot, position, self.colours, bright, removed)
    }

    /// z of the two grip faces now (m).
    pub fn grip_faces(&self) -> Option<[f32; 2]> {
        self.info.gauge.map(|faces| faces.map(|z| self.current_z(z as f32)))
    }

    /// z of the body's two ends now (m).
    pub fn ends(&self) -> [f32; 2] {
        [self.body.low.z, self.body.high.z].map(|z| self.current_z(z))
    }

    /// How much longer the body is expected to become (m), or was at most where that is not known.
    pub fn stretch(&self) -> f32 {
        let Some([low, high]) = self.info.gauge else { return 0.0 };
        let so_far = || self.rows.iter().map(|row| row.strain).fold(0.0, f64::max);
        ((high - low) * self.info.strain_end.map_or_else(so_far, |end| end.max(0.0))) as f32
    }

    /// [`current_z`] of this state.
    pub fn current_z(&self, rest_z: f32) -> f32 {
        current_z(self.info, self.snapshot, rest_z)
    }
}

/// Where the material section that was at `rest_z` is now (m): the median over wires, which a wire that sprang back does
/// not move.
pub fn current_z(info: &RunInfo, snapshot: &Snapshot, rest_z: f32) -> f32 {
    let mut places: Vec<f32> = info
        .wires
        .iter()
        .filter_map(|wire| {
            let at = |i: usize| info.rest_position[i][2];
            let nearest =
                wire.particles().min_by(|&a, &b| (at(a) - rest_z).abs().total_cmp(&(at(b) - rest_z).abs()))?;
            Some(snapshot.position[nearest][2] + rest_z - at(nearest))
        })
        .collect();
    if places.is_empty() {
        return rest_z;
    }
    places.sort_by(f32::total_cmp);
    let middle = places.len() / 2;
    0.5 * (places[middle] + places[(places.len() - 1) / 2])
}
