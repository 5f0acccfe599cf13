//! The strand opened towards the eye: outer layers are cut off in steps, so that inner wires are seen in place.
//!
//! Which particles are left out follows from their places before loading alone: wires are cut where they were
//! marked, and the cut moves with them, so that nothing flickers from frame to frame.

use super::body::{Body, UNKNOWN_STRAIN};
use super::camera::Camera;
use super::canvas::{Canvas, Rect, Weight};
use super::data::Data;
use super::labels::{self, Mark};
use super::midsection::section;
use super::panel::{Panel, Shot};
use super::wires::Looks;
use crate::engine::view::{RunInfo, Rupture};
use crate::scene::spec::View;
use glam::Vec3;

/// Turn of the eye from the plain side view, so that cut faces are seen (rad): about the vertical and the horizontal.
const TURN: [f64; 2] = [-24f64.to_radians(), 12f64.to_radians()];
/// Half the length of the opening over the body's radius (-): of the layer next to the innermost, and what each
/// layer further out has more.
const HALF_LENGTH: [f32; 2] = [1.0, 1.15];
/// Where the opening begins in the layer that broke first, over the body's radius (-): beside the break, so that the
/// break is seen; and by how much later in each layer further in.
const BESIDE: [f32; 2] = [0.35, 0.8];
/// By how much the opening ends earlier in each layer further in, over the body's radius (-), where it lies beside.
const STEP: f32 = 0.45;
/// Half the angle of the opening about the eye's direction (rad): of the outermost layer, and what each layer further
/// in has less.
const HALF_ANGLE: [f32; 2] = [80f32.to_radians(), 12f32.to_radians()];

/// The panel.
pub struct Cutaway;

impl Panel for Cutaway {
    fn shots(&self, data: &Data, panel: Rect, _unit: f32) -> Vec<Shot> {
        let camera = camera(data, panel);
        let fade = 2.0 * data.body.radius;
        let (caption, remark) = ("cut open".to_owned(), data.focus.words());
        vec![Shot { view: View::Cutaway, camera, layer: None, caption, remark, fade, measures: true }]
    }

    fn looks(&self, data: &Data, camera: &Camera) -> Option<Looks> {
        Some(data.looks(data.snapshot.position.clone(), opening(data, camera).removed()))
    }

    fn annotate(&self, canvas: &mut Canvas, shot: &Shot, data: &Data, _frame: &[Shot]) {
        annotate(canvas, &shot.camera, data, &opening(data, &shot.camera));
    }
}

/// Camera on the section in view, wide enough for the whole opening.
fn camera(data: &Data, panel: Rect) -> Camera {
    let (info, body, look) = (data.info, data.body, data.camera);
    let azimuth = look.azimuth + TURN[0];
    let mut camera = section(data, [azimuth, look.elevation + TURN[1]], panel, data.current_z(data.focus.z));
    let stretch = info.strain_end.unwrap_or(UNKNOWN_STRAIN) as f32;
    let longest = half_length(info.layers.len().saturating_sub(1), body) * (1.0 + stretch);
    let needed = 2.0 * 1.25 * (longest * azimuth.cos().abs() as f32 + body.radius);
    camera.scale = camera.scale.min(look.zoom as f32 * panel.w / needed);
    camera
}

/// The opening of a frame, around the section in view and towards the eye.
fn opening<'a>(data: &Data<'a>, camera: &Camera) -> Opening<'a> {
    // The first break in view.
    let near = |r: &&Rupture| (r.rest_z as f32 - data.focus.z).abs() < 2.0 * data.body.radius;
    let first = data.ruptures.iter().find(near).map(|r| r.layer);
    Opening::new(data.info, data.body, first, camera.to_eye(), data.focus.z)
}

/// Half the length of the opening in a layer (m); 0 for the innermost, which stays whole.
fn half_length(layer: usize, body: &Body) -> f32 {
    match layer {
        0 => 0.0,
        k => body.radius * (HALF_LENGTH[0] + HALF_LENGTH[1] * (k - 1) as f32),
    }
}

/// Where each layer is open, from and to, about the section in view (m before loading). Layers outside `first`, the
/// layer that broke first, are open around the section; from that layer inwards they are open beside it.
fn intervals(body: &Body, first: Option<usize>) -> Vec<[f32; 2]> {
    let count = body.layer_radius.len();
    let outermost = half_length(count.saturating_sub(1), body);
    let one = |layer: usize| match first {
        _ if layer == 0 => [0.0, 0.0],
        Some(first) if layer <= first => {
            let from = BESIDE[0] + BESIDE[1] * (first - layer) as f32;
            let to = outermost - STEP * (count - 1 - layer) as f32 * body.radius;
            [from * body.radius, to.max(from * body.radius)]
        }
        _ => [-half_length(layer, body), half_length(layer, body)],
    };
    (0..count).map(one).collect()
}

/// An opening of the outer layers.
pub struct Opening<'a> {
    info: &'a RunInfo,
    body: &'a Body,
    rest_z: f32,
    intervals: Vec<[f32; 2]>,
    /// Direction to the eye across the strand, unit length.
    eye: Vec3,
}

impl<'a> Opening<'a> {
    /// An opening around what was at `rest_z` before loading (m), towards an eye in direction `to_eye`. The layer that
    /// broke `first`, and those in it, are opened beside the section, so that the break is seen.
    pub fn new(info: &'a RunInfo, body: &'a Body, first: Option<usize>, to_eye: Vec3, rest_z: f32) -> Self {
        let eye = to_eye.with_z(0.0).try_normalize().unwrap_or(Vec3::NEG_X);
        Self { info, body, rest_z, intervals: intervals(body, first), eye }
    }

    /// Whether `layer` is cut off at a place before loading (m).
    fn opens(&self, layer: usize, rest: [f32; 3]) -> bool {
        let across = Vec3::new(rest[0], rest[1], 0.0) - self.body.axis;
        let inwards = self.info.layers.len().saturating_sub(1 + layer) as f32;
        let angle = HALF_ANGLE[0] - HALF_ANGLE[1] * inwards;
        let [from, to] = self.intervals[layer];
        let near = (from..to).contains(&(rest[2] - self.rest_z));
        near && across.normalize_or_zero().dot(self.eye) > angle.cos()
    }

    /// Which particles are left out.
    pub fn removed(&self) -> Vec<bool> {
        let rest = &self.info.rest_position;
        let mut removed = vec![false; rest.len()];
        for wire in &self.info.wires {
            for (gone, place) in removed[wire.particles()].iter_mut().zip(&rest[wire.particles()]) {
                *gone = self.opens(wire.layer, *place);
            }
        }
        removed
    }

    /// Whether a break is seen: its wire is there, faces the eye, and no layer covers it.
    fn shows(&self, rupture: &Rupture, camera: &Camera, place: Vec3) -> bool {
        let rest = self.info.rest_position[rupture.bond];
        let covered = (rupture.layer + 1..self.info.layers.len()).any(|outer| !self.opens(outer, rest));
        camera.to_view(place).z > 0.0 && !covered && !self.opens(rupture.layer, rest)
    }
}

/// Names of the layers where each comes to light, and the numbers of the breaks that are seen.
fn annotate(canvas: &mut Canvas, camera: &Camera, data: &Data, opening: &Opening) {
    let u = canvas.unit;
    let panel = camera.panel;
    let marks: Vec<Mark> = data
        .first_breaks()
        .filter(|(_, rupture)| opening.shows(rupture, camera, data.place(rupture)))
        .filter_map(|(number, rupture)| {
            let at = data.seen_end(rupture, camera, Vec3::ZERO)?;
            Some(Mark { number, words: [true, false].map(|layer| data.words(number, rupture, layer)), at })
        })
        .collect();
    labels::breaks(canvas, panel.inset(4.0 * u, 26.0 * u, 4.0 * u, panel.h - 62.0 * u), data, &marks);
    let names: Vec<([f32; 2], &str)> = ledges(data, camera, opening).into_iter().zip(names(data)).collect();
    let level = panel.bottom() - 20.0 * u;
    let wanted: Vec<f32> = names.iter().map(|(at, _)| at[0]).collect();
    let widest = names.iter().map(|(_, n)| canvas.fonts.width(n, 11.0 * u, Weight::Bold)).fold(0.0, f32::max);
    let pitch = widest + 16.0 * u;
    // The scale bar lies in the right corner, the axes in the left one.
    let places = labels::spread(&wanted, pitch, panel.x + 0.6 * pitch + 40.0 * u, panel.right() - 190.0 * u);
    for ((at, name), x) in names.into_iter().zip(places) {
        canvas.line([x, level], at, 1.2 * u, data.style.text, 0.8);
        canvas.disc(at[0], at[1], 2.2 * u, data.style.text, 1.0);
        labels::word(canvas, [x, level], data, name);
    }
}

/// Layer names from the outermost inwards: the order of the ledges from left to right.
fn names<'a>(data: &Data<'a>) -> impl Iterator<Item = &'a str> {
    let info = data.info;
    info.layers.iter().rev().map(String::as_str)
}

/// A point on the ledge that each layer shows on the left (px), outermost first.
fn ledges(data: &Data, camera: &Camera, opening: &Opening) -> Vec<[f32; 2]> {
    let count = data.info.layers.len();
    (0..count)
        .rev()
        .map(|layer| {
            // The outermost layer's ledge has no end; the innermost one ends where the layer over it closes again.
            let from = opening.intervals.get(layer + 1).map(|i| i[0]);
            let [own, _] = opening.intervals[layer];
            let away = match (from, layer) {
                (None, _) => own - 0.4 * data.body.radius,
                (Some(from), 0) => 0.5 * (from + opening.intervals[1][1]),
                (Some(from), _) => 0.5 * (from + own),
            };
            let z = data.current_z(opening.rest_z + away);
            let radius = 0.85 * data.body.layer_radius[layer];
            camera.project(Vec3::new(data.body.axis.x, data.body.axis.y, z) + radius * opening.eye)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body() -> Body {
        let layer_radius = vec![0.5, 0.9, 1.4];
        Body { low: Vec3::ZERO, high: Vec3::ONE, axis: Vec3::ZERO, radius: 1.4, depth: vec![1.0; 3], layer_radius }
    }

    #[test]
    fn the_innermost_layer_stays_whole_and_openings_lie_inside_one_another() {
        for first in [None, Some(0), Some(1), Some(2)] {
            let intervals = intervals(&body(), first);
            assert_eq!(intervals[0], [0.0, 0.0]);
            assert!(intervals[2][0] < intervals[1][0] && intervals[1][1] < intervals[2][1], "{first:?} {intervals:?}");
            assert!(intervals[1][1] > intervals[1][0] + 0.3, "{first:?} {intervals:?}");
        }
    }

    #[test]
    fn the_layer_that_broke_first_is_whole_where_it_broke() {
        for first in 1..3 {
            let intervals = intervals(&body(), Some(first));
            assert!(intervals[first][0] > 0.0);
            assert!(intervals[first + 1..].iter().all(|i| i[0] < 0.0 && i[1] > 0.0), "layers over it are open there");
        }
    }
}
