//! The layers taken apart: each is drawn beside the others, so that inner wires are seen.

use super::body::Body;
use super::camera::Camera;
use super::canvas::{Canvas, Rect, Weight};
use super::data::Data;
use super::labels::{self, Mark};
use super::panel::{Panel, Shot};
use super::sides::{FRONT, facing, sides};
use super::wires::Looks;
use crate::scene::spec::View;
use glam::Vec3;

/// Space between layers over the body's radius (-).
const SPACE: f32 = 0.62;

/// The panel.
pub struct Exploded;

impl Panel for Exploded {
    fn shots(&self, data: &Data, panel: Rect, unit: f32) -> Vec<Shot> {
        let z = data.current_z(data.focus());
        // It faces the first break whatever its layer.
        let preferred = data.ruptures.first().map_or(FRONT, |first| facing(data, first));
        let shots = sides(panel, unit, preferred).into_iter().map(|(panel, side)| Shot {
            view: View::Exploded,
            camera: camera(data, panel, unit, z, side.turn),
            caption: "layers apart",
            remark: side.name.to_owned(),
            fade: data.body.radius,
        });
        shots.collect()
    }

    fn looks(&self, data: &Data, camera: &Camera) -> Option<Looks> {
        Some(data.looks(positions(data, camera), Vec::new()))
    }

    fn annotate(&self, canvas: &mut Canvas, shot: &Shot, data: &Data, _frame: &[Shot]) {
        annotate(canvas, &shot.camera, data);
    }
}

/// How far each layer is moved up in the picture (m), outermost on top, and the total height of the stack (m).
fn lifts(body: &Body) -> (Vec<f32>, f32) {
    let space = SPACE * body.radius;
    let height = body.layer_radius.iter().map(|r| 2.0 * r + space).sum::<f32>();
    let mut bottom = -0.5 * height;
    let lift = |r: &f32| {
        let middle = bottom + r;
        bottom += 2.0 * r + space;
        middle
    };
    (body.layer_radius.iter().map(lift).collect(), height)
}

/// Positions with every layer moved to its place (m).
fn positions(data: &Data, camera: &Camera) -> Vec<[f32; 3]> {
    let (lifts, _) = lifts(data.body);
    let up = camera.rotation.transpose() * Vec3::Y;
    let mut position = data.snapshot.position.clone();
    for wire in &data.info.wires {
        let move_by = up * lifts[wire.layer];
        for p in &mut position[wire.particles()] {
            *p = (Vec3::from(*p) + move_by).to_array();
        }
    }
    position
}

/// Camera on the section that is now at `z` (m) that holds the whole stack; `turn` (rad) is added to the elevation.
fn camera(data: &Data, panel: Rect, unit: f32, z: f32, turn: f64) -> Camera {
    let body = data.body;
    // The title needs room above, the scale bar below.
    let (above, below) = (20.0 * unit, 14.0 * unit);
    let (_, height) = lifts(body);
    let scale = data.camera.zoom as f32 * (panel.h - above - below) / height.max(1e-9);
    let rotation = Camera::orientation(0.0, data.camera.elevation + turn);
    let shift = rotation.transpose() * Vec3::Y * (0.5 * (above - below) / scale);
    let middle = Vec3::new(body.axis.x, body.axis.y, z) + shift;
    Camera { rotation, centre: middle, panel, scale, depth: body.depth_of_view() }
}

/// Names of the layers beside them, and above each the numbers of its breaks on the side that is seen.
fn annotate(canvas: &mut Canvas, camera: &Camera, data: &Data) {
    let u = canvas.unit;
    let panel = camera.panel;
    let (lifts, _) = lifts(data.body);
    let [_, axis] = camera.project(data.body.axis);
    let width = |name: &str| canvas.fonts.width(name, 11.0 * u, Weight::Bold) + 12.0 * u;
    let room = data.info.layers.iter().map(|n| width(n)).fold(0.0, f32::max) + 8.0 * u;
    for (layer, name) in data.info.layers.iter().enumerate() {
        let middle = axis - lifts[layer] * camera.scale;
        let top = middle - data.body.layer_radius[layer] * camera.scale;
        let space = SPACE * data.body.radius * camera.scale;
        let name_at = panel.x + 7.0 * u + 0.5 * (canvas.fonts.width(name, 11.0 * u, Weight::Bold) + 10.0 * u);
        labels::word(canvas, [name_at, top - 0.5 * space], data, name);
        let marks: Vec<Mark> = data
            .first_breaks()
            .filter(|(_, r)| r.layer == layer && camera.to_view(data.place(r)).z > 0.0)
            .map(|(number, r)| (number, camera.project(data.place(r))))
            .filter(|(_, [x, _])| *x > panel.x && *x < panel.right())
            .map(|(number, [x, y])| Mark { number, at: [x, y - lifts[layer] * camera.scale] })
            .collect();
        let band = Rect::new(panel.x + room, top - space, panel.w - room - 4.0 * u, space);
        labels::badges(canvas, band, data, &marks);
    }
}
