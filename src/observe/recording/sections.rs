//! Where sections of the body are: the close view follows one, so that it shows the place of the first break at every
//! strain.

use super::stream::{Instant, Stream, in_mm, vectors};
use super::{curve, names};
use crate::base::error::Result;
use crate::engine::view::{RunInfo, Snapshot};
use crate::observe::unrolled::ends;
use rerun::{Points3D, Radius};

/// Sections at most: two millimetres of a strand of 120 mm, less than the close view shows.
const SECTIONS: usize = 64;
/// Height that the viewer's tracking eye shows over the height of what it tracks (-); seen in the viewer, which does
/// not document it.
const SHOWN: f32 = 1.5;
/// Height of the close view over the thickness of the body (-): the body, and room above for a label.
const HEIGHT: f32 = 1.9;

/// Mean position of the particles of each section in each snapshot.
pub(super) struct Sections {
    z: [f32; 2],
    /// Section of each particle of a wire.
    of: Vec<usize>,
    /// Particles in each section.
    count: Vec<usize>,
    history: Vec<(Instant, Vec<[f32; 3]>)>,
}

impl Sections {
    /// Sections of equal length before loading, each with particles of the longest wire in it.
    pub fn new(info: &RunInfo) -> Self {
        let z = ends(info).map(|z| z as f32);
        let longest = info.wires.iter().map(|wire| wire.len).max().unwrap_or(0);
        let n = (longest / 2).clamp(1, SECTIONS);
        let section = |p: &[f32; 3]| (((in_mm(*p)[2] - z[0]) / (z[1] - z[0]) * n as f32) as usize).min(n - 1);
        let of: Vec<_> = info.rest_position[..info.wire_particles].iter().map(section).collect();
        let mut count = vec![0; n];
        of.iter().for_each(|i| count[*i] += 1);
        Self { z, of, count, history: Vec::new() }
    }

    /// Takes note of where sections are.
    pub fn snapshot(&mut self, snapshot: &Snapshot) {
        let mut sum = vec![[0.0; 3]; self.count.len()];
        for (section, p) in self.of.iter().zip(&snapshot.position) {
            let p = in_mm(*p);
            (0..3).for_each(|axis| sum[*section][axis] += p[axis]);
        }
        for (sum, n) in sum.iter_mut().zip(&self.count) {
            sum.iter_mut().for_each(|x| *x /= (*n).max(1) as f32);
        }
        self.history.push((curve::instant(&snapshot.sample), sum));
    }

    /// Makes the eye follow the section at `rest_z` (mm) before loading; `from` counts snapshots.
    pub fn send_focus(&self, stream: &Stream, info: &RunInfo, rest_z: f32, from: usize) -> Result<()> {
        let Some(history) = self.history.get(from..).filter(|h| !h.is_empty() && info.wire_particles > 0) else {
            return Ok(());
        };
        let instants: Vec<_> = history.iter().map(|(instant, _)| *instant).collect();
        // The eye's distance follows from the size of what it tracks: two specks too small to be seen.
        let half = 0.5 * HEIGHT / SHOWN * thickness(info);
        let specks = history.iter().flat_map(|(_, places)| {
            let [x, y, z] = self.at(places, rest_z);
            [[x, y - half, z], [x, y + half, z]]
        });
        let specks = vectors(Points3D::descriptor_positions(), specks);
        stream.rows(names::FOCUS, &instants, [(specks, vec![2; instants.len()])])
    }

    /// Sends the style of what the eye follows.
    pub fn send_style(stream: &Stream) -> Result<()> {
        stream.fixed(names::FOCUS, &Points3D::update_fields().with_radii([Radius::new_scene_units(1e-4)]))
    }

    /// Snapshots seen.
    pub fn len(&self) -> usize {
        self.history.len()
    }

    /// z of mid-length before loading (mm).
    pub fn middle(&self) -> f32 {
        0.5 * (self.z[0] + self.z[1])
    }

    /// Where the section at `rest_z` was in the last snapshot (mm).
    pub fn last(&self, rest_z: f32) -> Option<[f32; 3]> {
        self.history.last().map(|(_, places)| self.at(places, rest_z))
    }

    /// Where the section at `rest_z` was in the last snapshot up to `step` (mm).
    pub fn before(&self, step: u64, rest_z: f32) -> Option<[f32; 3]> {
        let (_, places) = self.history.iter().rev().find(|(instant, _)| instant.step <= step)?;
        Some(self.at(places, rest_z))
    }

    /// Linear between the centres of sections that have particles.
    fn at(&self, places: &[[f32; 3]], rest_z: f32) -> [f32; 3] {
        let n = places.len();
        let along = ((rest_z - self.z[0]) / (self.z[1] - self.z[0]) * n as f32 - 0.5).clamp(0.0, (n - 1) as f32);
        let filled = |i: &usize| self.count[*i] > 0;
        let low = (0..=along as usize).rev().find(filled);
        let high = (along.ceil() as usize..n).find(filled);
        let (Some(a), Some(b)) = (low.or(high), high.or(low)) else { return [0.0; 3] };
        let t = if b > a { (along - a as f32) / (b - a) as f32 } else { 0.0 };
        std::array::from_fn(|axis| places[a][axis] + t * (places[b][axis] - places[a][axis]))
    }
}

/// Largest distance of a wire's surface from the z axis before loading, twice (mm).
pub(super) fn thickness(info: &RunInfo) -> f32 {
    let wires = info.rest_position[..info.wire_particles].iter().zip(&info.radius);
    let [thickness] = in_mm([2.0 * wires.map(|([x, y, _], r)| x.hypot(*y) + r).fold(0.0, f32::max)]);
    thickness
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::view::WireInfo;

    /// One straight wire along z with a particle per millimetre.
    fn wire(len: usize) -> RunInfo {
        RunInfo {
            layers: vec![String::new()],
            wires: vec![WireInfo { layer: 0, material: 0, first: 0, len, diameter: 1e-3 }],
            wire_particles: len,
            particles: len,
            radius: vec![0.5e-3; len],
            rest_position: (0..len).map(|k| [0.0, 0.0, 1e-3 * k as f32]).collect(),
            ..RunInfo::default()
        }
    }

    fn stretched(info: &RunInfo, by: f32) -> Snapshot {
        let position = info.rest_position.iter().map(|[x, y, z]| [*x, *y + 3e-3, z * by]).collect();
        Snapshot { position, ..Snapshot::default() }
    }

    #[test]
    fn a_section_is_found_where_it_was_stretched_to() {
        for len in [1, 2, 3, 7, 100, 1000] {
            let info = wire(len);
            let mut sections = Sections::new(&info);
            sections.snapshot(&stretched(&info, 1.25));
            let middle = sections.middle();
            let [x, y, z] = sections.last(middle).unwrap();
            let spacing = len as f32 / sections.count.len() as f32;
            assert!(x == 0.0 && (y - 3.0).abs() < 1e-5, "{len}: {x}, {y}");
            assert!((z - 1.25 * middle).abs() <= spacing, "{len}: {z} is not {}", 1.25 * middle);
        }
    }
}
