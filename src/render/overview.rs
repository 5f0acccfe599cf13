//! The whole strand, its axis across the width, always at the same scale; in a high panel in several rows, so that it fills it.

use super::camera::Camera;
use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::data::Data;
use super::panel::{Panel, Shot};
use crate::base::units::mm;
use crate::scene::spec::View;
use glam::Vec3;

/// Height of a row over the body's radius (-).
const HEIGHT: f32 = 5.0;

/// The panel.
pub struct Overview;

impl Panel for Overview {
    fn shots(&self, data: &Data, panel: Rect, unit: f32) -> Vec<Shot> {
        let cameras = rows(data, panel, unit);
        let count = cameras.len();
        let name = if data.info.wires.len() == 1 { "whole wire" } else { "whole strand" };
        let shot = |(k, camera)| Shot {
            view: View::Overview,
            camera,
            layer: None,
            caption: if k == 0 { name.to_owned() } else { String::new() },
            remark: if k == 0 && count > 1 {
                format!("in {count} rows, each goes on in the next")
            } else {
                String::new()
            },
            fade: data.body.radius,
            measures: k + 1 == count,
        };
        cameras.into_iter().enumerate().map(shot).collect()
    }

    fn annotate(&self, canvas: &mut Canvas, shot: &Shot, data: &Data, frame: &[Shot]) {
        let window = frame.iter().find(|s| s.view == View::Midsection).map(|s| {
            let half = 0.5 * s.camera.panel.w / s.camera.scale;
            [s.camera.centre.z - half, s.camera.centre.z + half]
        });
        annotate(canvas, &shot.camera, data, window);
    }
}

/// The whole body with room for its stretch, in as many rows as the panel has room for.
fn rows(data: &Data, panel: Rect, unit: f32) -> Vec<Camera> {
    let body = data.body;
    let stretched = body.high.z - body.low.z + data.stretch();
    let view = panel.inset(14.0 * unit, 22.0 * unit, 14.0 * unit, 8.0 * unit);
    // In n rows the scale is n times that of one, and n of them need n² times its height.
    let one = HEIGHT * body.radius * view.w / stretched;
    let count = (view.h / one).sqrt().floor().clamp(1.0, 8.0);
    let length = stretched / count;
    // The width decides, unless the body is so short that it would not fit the height.
    let scale = (view.w / length).min(view.h / count / (2.0 * body.radius));
    let edge = |k: usize| panel.y + (k as f32 * panel.h / count).round();
    let row = |k: usize| {
        let row = Rect { y: edge(k), h: edge(k + 1) - edge(k), ..panel };
        let centre = Vec3::new(body.axis.x, body.axis.y, body.low.z + (k as f32 + 0.5) * length);
        let depth = stretched + 10.0 * body.radius;
        Camera { rotation: Camera::orientation(0.0, data.camera.elevation), centre, panel: row, scale, depth }
    };
    (0..count as usize).map(row).collect()
}

/// The grips as translucent jaws, a bracket around the section of the close-up, a tip over each break.
fn annotate(canvas: &mut Canvas, camera: &Camera, data: &Data, window: Option<[f32; 2]>) {
    let u = canvas.unit;
    let panel = camera.panel;
    let half = (1.5 * data.body.radius * camera.scale + 3.0 * u).min(0.34 * panel.h);
    let [_, middle] = camera.project(camera.centre);
    let x_of = |z: f32| camera.project(Vec3::new(data.body.axis.x, data.body.axis.y, z))[0];
    let inside = |x: f32| (panel.x..panel.right()).contains(&x);
    if let Some(faces) = data.grip_faces() {
        let ends = data.ends();
        for [from, to] in [[ends[0], faces[0]], [faces[1], ends[1]]] {
            let [x0, x1] = [from, to].map(|z| x_of(z).clamp(panel.x, panel.right()));
            if x1 > x0 {
                canvas.fill_rounded(Rect::new(x0, middle - half, x1 - x0, 2.0 * half), 3.0 * u, data.style.muted, 0.35);
            }
        }
    }
    if let Some([from, to]) = window.filter(|[from, to]| inside(x_of(*from)) || inside(x_of(*to))) {
        let frame = Rect::new(x_of(from), middle - half, x_of(to) - x_of(from), 2.0 * half);
        corners(canvas, frame, 7.0 * u, data.style.text);
    }
    let top = middle - half - 3.0 * u;
    for (number, rupture) in data.first_breaks() {
        let x = x_of(data.place(rupture).z);
        if !inside(x) {
            continue;
        }
        for k in 0..5 {
            let y = top - k as f32 * u;
            let w = (1.0 + k as f32) * u;
            canvas.fill(Rect::new(x - 0.5 * w, y - u, w, u), data.style.signal, 1.0);
        }
        if number == 1 {
            let text = format!("first break, {:.0} mm", mm(rupture.rest_z));
            let size = 10.5 * u;
            let width = canvas.fonts.width(&text, size, Weight::Bold);
            // On the side where fewer tips stand.
            let tips = |from: f32, to: f32| {
                data.first_breaks().map(|(_, r)| x_of(data.place(r).z)).filter(|x| (from..to).contains(x)).count()
            };
            let [before, after] = [tips(x - 12.0 * u - width, x - u), tips(x + u, x + 12.0 * u + width)];
            let left = before <= after && x - width > panel.x + 110.0 * u;
            let (x, align) = if left { (x - 6.0 * u, Align::Right) } else { (x + 6.0 * u, Align::Left) };
            let kind = Type { size, weight: Weight::Bold, colour: data.style.text, align };
            canvas.text(x, top + 0.5 * u, kind, &text);
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
