//! What the panels of one frame are drawn from.

use super::body::Body;
use super::colour::ColourScale;
use super::style::{Rgb, Style};
use super::wires::Looks;
use crate::engine::view::{RunInfo, Rupture, Snapshot};
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
    /// Strain (-) and nominal stress (Pa) so far.
    pub curve: &'a [(f64, f64)],
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
}

impl Data<'_> {
    /// Each wire's first rupture with its number in the order in which wires broke, from 1.
    pub fn first_breaks(&self) -> impl Iterator<Item = (usize, &Rupture)> {
        self.ruptures.iter().filter(|r| r.first_of_wire).enumerate().map(|(k, r)| (k + 1, r))
    }

    /// Where the broken bond is now, between its two particles (m).
    pub fn place(&self, rupture: &Rupture) -> Vec3 {
        let at = |i: usize| Vec3::from(self.snapshot.position[i]);
        0.5 * (at(rupture.bond) + at(rupture.bond + 1))
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

    /// z before loading (m) of the section that close-ups follow.
    pub fn focus(&self) -> f32 {
        let [low, high] = self.info.gauge.unwrap_or([self.body.low.z.into(), self.body.high.z.into()]);
        let first = self.ruptures.first().map(|r| r.rest_z);
        self.camera.focus_z.or(first).unwrap_or(0.5 * (low + high)) as f32
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
