//! The first break, told apart from all others: marked and named in space, where it moves along with the wire's ends.

use super::sections::thickness;
use super::stream::{Instant, Stream, in_mm, strips, vectors};
use super::{curve, names, paint};
use crate::base::error::Result;
use crate::engine::view::{RunInfo, Rupture, Snapshot};
use crate::observe::unrolled::ends;
use rerun::{Color, LineStrips3D, Points3D, Radius};

/// Distance of the label from the axis in the close view, in thicknesses of the body (-).
const NEAR: f32 = 0.7;
/// Share of the way to the label after which its leader ends (-): the viewer writes a text below its point.
const LEADER: f32 = 0.65;
/// The same in the view of the whole strand, in its lengths (-).
const FAR: f32 = 0.075;

/// How the close view looks at the body: from `eye` (a unit vector across z) with `up` upwards and z to the right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ViewDirection {
    pub eye: [f32; 3],
    pub up: [f32; 3],
}

impl ViewDirection {
    /// From the side of −x, before anything is known.
    pub const START: Self = Self { eye: [-1.0, 0.0, 0.0], up: [0.0, 1.0, 0.0] };

    /// So that `place` is on the side of the eye; `axis` is the middle of its section (mm).
    pub fn towards(place: [f32; 3], axis: [f32; 3]) -> Self {
        let [x, y] = [place[0] - axis[0], place[1] - axis[1]];
        let distance = x.hypot(y);
        if distance < 1e-3 {
            return Self::START;
        }
        // z × (−eye), so that z points to the right.
        let eye = [x / distance, y / distance, 0.0];
        Self { eye, up: [eye[1], -eye[0], 0.0] }
    }
}

/// The first break of a run.
pub(super) struct FirstBreak {
    rupture: Rupture,
    /// Middle between the two ends (mm), from the rupture on.
    places: Vec<(Instant, [f32; 3])>,
}

impl FirstBreak {
    /// Where it happened.
    pub fn new(rupture: &Rupture) -> Self {
        Self { rupture: rupture.clone(), places: vec![(rupture.into(), super::marks::place(rupture))] }
    }

    /// Takes note of where the two ends are.
    pub fn snapshot(&mut self, snapshot: &Snapshot) {
        let [a, b] = [self.rupture.bond, self.rupture.bond + 1].map(|i| in_mm(snapshot.position[i]));
        let middle = std::array::from_fn(|axis| 0.5 * (a[axis] + b[axis]));
        self.places.push((curve::instant(&snapshot.sample), middle));
    }

    /// Places known so far.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Sends mark, leader and label for the close view and for the view of the whole strand; `from` counts places.
    pub fn send(&self, stream: &Stream, info: &RunInfo, direction: ViewDirection, from: usize) -> Result<()> {
        let [low, high] = ends(info).map(|z| z as f32);
        self.send_at(names::FIRST_BREAK, NEAR * thickness(info), stream, info, direction, from)?;
        self.send_at(names::FIRST_BREAK_FAR, FAR * (high - low), stream, info, direction, from)
    }

    fn send_at(
        &self,
        path: &str,
        reach: f32,
        stream: &Stream,
        info: &RunInfo,
        direction: ViewDirection,
        from: usize,
    ) -> Result<()> {
        let places = &self.places[from..];
        if places.is_empty() {
            return Ok(());
        }
        if from == 0 {
            self.send_style(path, stream, info)?;
        }
        let instants: Vec<_> = places.iter().map(|(instant, _)| *instant).collect();
        let one = vec![1; places.len()];
        let label = |p: [f32; 3]| -> [f32; 3] {
            let along = p[0] * direction.up[0] + p[1] * direction.up[1];
            let lift = (reach - along).max(0.0);
            std::array::from_fn(|axis| p[axis] + lift * direction.up[axis])
        };
        let below = |p: [f32; 3]| -> [f32; 3] {
            let end = label(p);
            std::array::from_fn(|axis| p[axis] + LEADER * (end[axis] - p[axis]))
        };
        let ends = vectors(Points3D::descriptor_positions(), places.iter().map(|(_, p)| label(*p)));
        let leaders = strips(LineStrips3D::descriptor_strips(), places.iter().flat_map(|(_, p)| [*p, below(*p)]), 2);
        stream.rows(path, &instants, [(ends, one.clone()), (leaders, one)])
    }

    fn send_style(&self, path: &str, stream: &Stream, info: &RunInfo) -> Result<()> {
        let colour = Color::from_u32(paint::FIRST);
        let points = Points3D::update_fields()
            .with_colors([colour])
            .with_radii([Radius::new_ui_points(4.0)])
            .with_labels([names::first_break(info, &self.rupture)])
            .with_show_labels(true);
        stream.fixed(path, &points)?;
        let leader = LineStrips3D::update_fields().with_colors([colour]).with_radii([Radius::new_ui_points(1.0)]);
        stream.fixed(path, &leader)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_eye_stands_on_the_side_of_the_break_with_z_to_the_right() {
        for place in [[2.0, 0.0, 5.0], [0.0, -3.0, 1.0], [1.0, 1.0, 0.0]] {
            let ViewDirection { eye, up } = ViewDirection::towards(place, [0.0, 0.0, 9.0]);
            let toward: f32 = (0..2).map(|axis| eye[axis] * place[axis]).sum();
            assert!((toward - place[0].hypot(place[1])).abs() < 1e-5);
            // Looking along −eye, right = −eye × up.
            let right = eye[1] * up[0] - eye[0] * up[1];
            assert!((right - 1.0).abs() < 1e-5, "{right}");
        }
        assert_eq!(ViewDirection::towards([1.0, 2.0, 3.0], [1.0, 2.0, 9.0]), ViewDirection::START);
        let start = ViewDirection::towards([-1.0, 0.0, 0.0], [0.0; 3]);
        assert_eq!((start.eye, start.up), (ViewDirection::START.eye, ViewDirection::START.up));
    }
}
