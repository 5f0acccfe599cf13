//! The layers taken apart: each is drawn beside the others, so that inner wires are seen.

use super::camera::Camera;
use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::frame::Data;
use super::style::CameraOptions;
use super::viewpoint::Body;
use crate::engine::view::RunInfo;
use glam::Vec3;

/// Space between layers over the body's radius [-].
const SPACE: f32 = 0.45;

/// How far each layer is moved up in the picture [mm], outermost on top, and the total height of the stack [mm].
pub fn lifts(info: &RunInfo, body: &Body) -> (Vec<f32>, f32) {
    let mut radius = vec![0f32; info.layers.len()];
    for wire in &info.wires {
        for i in wire.first..wire.first + wire.len {
            let [x, y, _] = info.rest_position[i];
            let r = (x - body.axis.x).hypot(y - body.axis.y) + info.radius[i];
            radius[wire.layer] = radius[wire.layer].max(r);
        }
    }
    let space = SPACE * body.radius;
    let height = radius.iter().map(|r| 2.0 * r + space).sum::<f32>();
    let mut bottom = -0.5 * height;
    let lift = |r: &f32| {
        let middle = bottom + r + 0.5 * space;
        bottom += 2.0 * r + space;
        middle
    };
    (radius.iter().map(lift).collect(), height)
}

/// Positions with every layer moved to its place [mm].
pub fn positions(data: &Data, lifts: &[f32], camera: &Camera) -> Vec<[f32; 3]> {
    let up = camera.rotation.transpose() * Vec3::Y;
    let mut position = data.snapshot.position.clone();
    for wire in &data.info.wires {
        let move_by = up * lifts[wire.layer];
        for p in &mut position[wire.first..wire.first + wire.len] {
            *p = (Vec3::from(*p) + move_by).to_array();
        }
    }
    position
}

/// Camera on the section at `z` [mm] that holds the whole stack.
pub fn camera(body: &Body, options: &CameraOptions, panel: Rect, unit: f32, z: f32, height: f32) -> Camera {
    // The title needs room above.
    let room = panel.h - 24.0 * unit;
    let scale = options.zoom * room / height.max(1e-6);
    let rotation = Camera::orientation(0.0, options.elevation_deg);
    let middle = Vec3::new(body.axis.x, body.axis.y, z) + rotation.transpose() * Vec3::Y * (8.0 * unit / scale);
    Camera { rotation, centre: middle, panel, scale, depth: 10.0 * (body.high - body.low).length().max(body.radius) }
}

/// Names of the layers beside them.
pub fn names(canvas: &mut Canvas, camera: &Camera, data: &Data, lifts: &[f32]) {
    let u = canvas.unit;
    let kind = Type { size: 11.0 * u, weight: Weight::Bold, colour: data.style.text, align: Align::Left };
    for (name, lift) in data.info.layers.iter().zip(lifts) {
        let [_, middle] = camera.project(data.body.axis);
        let y = middle - lift * camera.scale;
        let w = canvas.fonts.width(name, kind.size, kind.weight);
        let r = Rect::new(camera.panel.x + 8.0 * u, y - 9.0 * u, w + 10.0 * u, 18.0 * u);
        canvas.fill_rounded(r, 4.0 * u, data.style.page, 0.8);
        canvas.text(r.x + 5.0 * u, y + 4.0 * u, kind, name);
    }
}
