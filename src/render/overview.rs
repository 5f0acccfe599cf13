//! The whole strand, its axis across the width, always at the same scale.

use super::body::UNKNOWN_STRAIN;
use super::camera::Camera;
use super::canvas::{Canvas, Rect};
use super::data::Data;
use super::panel::{Panel, Shot};
use crate::scene::spec::View;
use glam::Vec3;

/// The panel.
pub struct Overview;

impl Panel for Overview {
    fn shots(&self, data: &Data, panel: Rect, unit: f32) -> Vec<Shot> {
        let camera = camera(data, panel, unit);
        vec![Shot {
            view: View::Overview,
            camera,
            caption: "whole strand",
            remark: String::new(),
            fade: data.body.radius,
        }]
    }

    fn annotate(&self, canvas: &mut Canvas, shot: &Shot, data: &Data, frame: &[Shot]) {
        let window = frame.iter().find(|s| s.view == View::Midsection).map(|s| {
            let half = 0.5 * s.camera.panel.w / s.camera.scale;
            [s.camera.centre.z - half, s.camera.centre.z + half]
        });
        annotate(canvas, &shot.camera, data, window);
    }
}

/// The whole body with room for its stretch.
fn camera(data: &Data, panel: Rect, unit: f32) -> Camera {
    let (info, body) = (data.info, data.body);
    let length = body.high.z - body.low.z;
    let gauge = info.gauge.map_or(length, |[low, high]| (high - low) as f32);
    let stretched = length + gauge * info.strain_end.unwrap_or(UNKNOWN_STRAIN) as f32;
    let view = panel.inset(14.0 * unit, 22.0 * unit, 14.0 * unit, 8.0 * unit);
    // The width decides, unless the body is so short that it would not fit the height.
    let scale = (view.w / stretched).min(view.h / (2.0 * body.radius));
    let centre = Vec3::new(body.axis.x, body.axis.y, body.low.z + 0.5 * stretched);
    let reach = stretched + 10.0 * body.radius;
    Camera { rotation: Camera::orientation(0.0, data.camera.elevation), centre, panel, scale, depth: reach }
}

/// The grips as translucent jaws, a bracket around the section of the close-up, a tip over each break.
fn annotate(canvas: &mut Canvas, camera: &Camera, data: &Data, window: Option<[f32; 2]>) {
    let u = canvas.unit;
    let half = (1.5 * data.body.radius * camera.scale + 3.0 * u).min(0.34 * camera.panel.h);
    let [_, middle] = camera.project(camera.centre);
    let x_of = |z: f32| camera.project(Vec3::new(data.body.axis.x, data.body.axis.y, z))[0];
    if let Some(faces) = data.grip_faces() {
        let ends = data.ends();
        for [from, to] in [[ends[0], faces[0]], [faces[1], ends[1]]] {
            let (x0, x1) = (x_of(from), x_of(to));
            canvas.fill_rounded(Rect::new(x0, middle - half, x1 - x0, 2.0 * half), 3.0 * u, data.style.muted, 0.35);
        }
    }
    if let Some([from, to]) = window {
        let frame = Rect::new(x_of(from), middle - half, x_of(to) - x_of(from), 2.0 * half);
        corners(canvas, frame, 7.0 * u, data.style.text);
    }
    for (_, rupture) in data.first_breaks() {
        let x = x_of(data.place(rupture).z);
        let top = middle - half - 3.0 * u;
        for k in 0..5 {
            let y = top - k as f32 * u;
            let w = (1.0 + k as f32) * u;
            canvas.fill(Rect::new(x - 0.5 * w, y - u, w, u), data.style.signal, 1.0);
        }
    }
}

fn corners(canvas: &mut Canvas, r: Rect, arm: f32, colour: [u8; 3]) {
    let w = 1.5 * canvas.unit;
    let arm = arm.min(0.5 * r.w);
    for x in [r.x, r.right() - arm] {
        for y in [r.y, r.bottom() - w] {
            canvas.fill(Rect::new(x, y, arm, w), colour, 0.9);
        }
    }
    for x in [r.x, r.right() - w] {
        for y in [r.y, r.bottom() - arm] {
            canvas.fill(Rect::new(x, y, w, arm), colour, 0.9);
        }
    }
}
