//! The close-up on the section where it breaks, from the front and from the back.

use super::camera::Camera;
use super::canvas::{Canvas, Rect};
use super::data::Data;
use super::labels::{self, Mark};
use super::marks;
use super::panel::{Panel, Shot};
use super::sides::sides;
use crate::base::units::mm;
use crate::engine::view::Rupture;
use crate::scene::spec::View;
use glam::Vec3;

/// The panel.
pub struct Midsection;

impl Panel for Midsection {
    fn shots(&self, data: &Data, panel: Rect, unit: f32) -> Vec<Shot> {
        let z = data.current_z(data.focus.z);
        let slant = data.camera.azimuth.sin().abs() as f32;
        let shots = sides(panel, unit, &data.focus).into_iter().map(|(panel, side)| {
            let camera = section(data, [data.camera.azimuth, data.camera.elevation + side.turn], panel, z);
            let fade = data.body.radius + slant * panel.w / camera.scale;
            let (caption, remark) = (data.focus.words(), side.name.to_owned());
            Shot { view: View::Midsection, camera, layer: None, caption, remark, fade, measures: true }
        });
        shots.collect()
    }

    fn annotate(&self, canvas: &mut Canvas, shot: &Shot, data: &Data, _frame: &[Shot]) {
        breaks(canvas, &shot.camera, data);
        first_break(canvas, &shot.camera, data);
    }
}

/// Camera of a close-up on the section that is now at `z` (m), its eye turned about the vertical and the horizontal
/// (rad).
pub fn section(data: &Data, [azimuth, elevation]: [f64; 2], panel: Rect, z: f32) -> Camera {
    let body = data.body;
    // The strand fills a little more than half of the height: the rest is for wires that spring out.
    let scale = data.camera.zoom as f32 * (panel.h / 3.5).min(panel.w / 5.0) / body.radius;
    Camera {
        rotation: Camera::orientation(azimuth, elevation),
        centre: Vec3::new(body.axis.x, body.axis.y, z),
        panel,
        scale,
        depth: body.depth_of_view(),
    }
}

/// Order and number of the wires that broke on the side that this camera sees, with a line to an end.
fn breaks(canvas: &mut Canvas, camera: &Camera, data: &Data) {
    let u = canvas.unit;
    let panel = camera.panel;
    let seen: Vec<Mark> = data
        .first_breaks()
        .filter(|(_, r)| outermost(data, r))
        .filter_map(|(number, r)| {
            let at = data.seen_end(r, camera, Vec3::ZERO)?;
            Some(Mark { number, words: [true, false].map(|layer| data.words(number, r, layer)), at })
        })
        .collect();
    // Above the strand for breaks in its upper half, below it for the others.
    let (upper, lower): (Vec<Mark>, Vec<Mark>) = seen.into_iter().partition(|m| m.at[1] < panel.y + 0.5 * panel.h);
    let band = |y: f32| Rect::new(panel.x + 4.0 * u, y, panel.w - 8.0 * u, 36.0 * u);
    labels::breaks(canvas, band(panel.y + 26.0 * u), data, &upper);
    labels::breaks(canvas, band(panel.bottom() - 62.0 * u), data, &lower);
}

/// Where the first break is, when it lies outside the picture.
fn first_break(canvas: &mut Canvas, camera: &Camera, data: &Data) {
    let u = canvas.unit;
    let panel = camera.panel;
    let Some((number, first)) = data.first_breaks().next() else { return };
    let [x, _] = camera.project(data.place(first));
    if (panel.x..panel.right()).contains(&x) {
        return;
    }
    let words = format!("first break, {}, {:.0} mm", data.words(number, first, true), mm(first.rest_z));
    marks::aside(canvas, panel, data, &words, x < panel.x, 73.0 * u);
}

fn outermost(data: &Data, rupture: &Rupture) -> bool {
    rupture.layer + 1 == data.info.layers.len()
}
