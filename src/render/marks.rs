//! What is written over the three-dimensional panels: titles, scale bars, grips, numbers of the breaks.

use super::camera::Camera;
use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::frame::Data;
use super::labels::{self, Mark};
use super::ticks::{label, round_step};
use crate::engine::view::Rupture;
use glam::Vec3;

/// Title in the panel's top left corner; returns where it ends (px).
pub fn title(canvas: &mut Canvas, panel: Rect, data: &Data, text: &str) -> f32 {
    let u = canvas.unit;
    let kind = Type { size: 12.0 * u, weight: Weight::Bold, colour: data.style.text, align: Align::Left };
    let x = panel.x + 12.0 * u;
    x + canvas.text(x, panel.y + 18.0 * u, kind, text)
}

/// A remark after the title.
pub fn subtitle(canvas: &mut Canvas, x: f32, panel: Rect, data: &Data, text: &str) {
    let u = canvas.unit;
    let kind = Type { size: 11.0 * u, weight: Weight::Regular, colour: data.style.muted, align: Align::Left };
    canvas.text(x + 9.0 * u, panel.y + 18.0 * u, kind, text);
}

/// Title and remark over a three-dimensional panel, legible also in front of wires.
pub fn title_over(canvas: &mut Canvas, panel: Rect, data: &Data, text: &str, remark: &str) {
    let u = canvas.unit;
    if text.is_empty() {
        return;
    }
    let mut w = canvas.fonts.width(text, 12.0 * u, Weight::Bold) + 12.0 * u;
    if !remark.is_empty() {
        w += canvas.fonts.width(remark, 11.0 * u, Weight::Regular) + 9.0 * u;
    }
    let ground = Rect::new(panel.x + 6.0 * u, panel.y + 4.0 * u, w, 20.0 * u);
    canvas.fill_rounded(ground, 4.0 * u, data.style.panel, 0.8);
    let x = title(canvas, panel, data, text);
    subtitle(canvas, x, panel, data, remark);
}

/// A bar of a round length in the panel's lower right corner.
pub fn scale_bar(canvas: &mut Canvas, camera: &Camera, data: &Data) {
    let u = canvas.unit;
    // The largest of 1, 2, 5 × 10^k that is at most about 120 units long.
    let longest = f64::from(120.0 * u / camera.scale);
    let length = [0.5, 0.4, 0.2, 0.1].map(|f| round_step(longest * f)).into_iter().find(|l| *l <= longest);
    let length = length.unwrap_or(longest);
    let width = length as f32 * camera.scale;
    let (right, y) = (camera.panel.right() - 14.0 * u, camera.panel.bottom() - 12.0 * u);
    let left = right - width;
    let colour = data.style.text;
    let decimals = if length < 1.0 { (-length.log10()).ceil() as usize } else { 0 };
    let text = format!("{} mm", label(length, decimals));
    let text_width = canvas.fonts.width(&text, 11.0 * u, Weight::Regular);
    let ground = Rect::new(left - text_width - 12.0 * u, y - 9.0 * u, width + text_width + 18.0 * u, 18.0 * u);
    canvas.fill_rounded(ground, 4.0 * u, data.style.panel, 0.8);
    canvas.fill(Rect::new(left, y - u, width, 2.0 * u), colour, 1.0);
    for x in [left, right - 1.5 * u] {
        canvas.fill(Rect::new(x, y - 4.0 * u, 1.5 * u, 8.0 * u), colour, 1.0);
    }
    let kind = Type { size: 11.0 * u, weight: Weight::Regular, colour, align: Align::Right };
    canvas.text(left - 6.0 * u, y + 4.0 * u, kind, &text);
}

/// The grips of the overview as translucent jaws, and a bracket around the section of the close-up.
pub fn overview(canvas: &mut Canvas, camera: &Camera, data: &Data, window: Option<[f32; 2]>) {
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
    for rupture in data.ruptures.iter().filter(|r| r.first_of_wire) {
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

/// Numbers, in order of break, of the wires that broke on the side that this camera sees, with a line to the place.
pub fn break_numbers(canvas: &mut Canvas, camera: &Camera, data: &Data) {
    let u = canvas.unit;
    let panel = camera.panel;
    let seen: Vec<Mark> = data
        .first_breaks()
        .filter(|(_, r)| outermost(data, r) && camera.to_view(data.place(r)).z > 0.0)
        .map(|(number, r)| Mark { number, at: camera.project(data.place(r)) })
        .filter(|m| m.at[0] > panel.x && m.at[0] < panel.right())
        .collect();
    // Above the strand for breaks in its upper half, below it for the others.
    let (upper, lower): (Vec<Mark>, Vec<Mark>) = seen.iter().partition(|m| m.at[1] < panel.y + 0.5 * panel.h);
    let band = |y: f32| Rect::new(panel.x + 4.0 * u, y, panel.w - 8.0 * u, 20.0 * u);
    labels::badges(canvas, band(panel.y + 28.0 * u), data, &upper);
    labels::badges(canvas, band(panel.bottom() - 46.0 * u), data, &lower);
}

fn outermost(data: &Data, rupture: &Rupture) -> bool {
    rupture.layer + 1 == data.info.layers.len()
}
