//! The close-up on the section where it breaks, from the front and from the back.

use super::camera::Camera;
use super::canvas::{Canvas, Rect};
use super::data::Data;
use super::labels::{self, Mark};
use super::panel::{Panel, Shot};
use super::sides::{FRONT, Side, facing, sides};
use crate::base::units::mm;
use crate::engine::view::Rupture;
use crate::scene::spec::View;
use glam::Vec3;

/// The panel.
pub struct Midsection;

impl Panel for Midsection {
    fn shots(&self, data: &Data, panel: Rect, unit: f32) -> Vec<Shot> {
        let z = data.current_z(data.focus());
        // Only the outermost layer is seen.
        let first = data.ruptures.first().filter(|first| outermost(data, first));
        let sides = sides(panel, unit, first.map_or(FRONT, |first| facing(data, first)));
        let alone = sides.len() == 1;
        let slant = data.camera.azimuth.sin().abs() as f32;
        let shot = |(panel, side): (Rect, Side)| {
            let camera = section(data, [data.camera.azimuth, data.camera.elevation + side.turn], panel, z);
            let caption = if alone { "midsection" } else { side.name };
            let remark = if alone { format!("{}, {}", side.name, around(data)) } else { around(data) };
            let fade = data.body.radius + slant * panel.w / camera.scale;
            Shot { view: View::Midsection, camera, caption, remark, fade }
        };
        sides.into_iter().map(shot).collect()
    }

    fn annotate(&self, canvas: &mut Canvas, shot: &Shot, data: &Data, _frame: &[Shot]) {
        break_numbers(canvas, &shot.camera, data);
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

/// Which section that is, in words.
pub fn around(data: &Data) -> String {
    format!("around z {:.1} mm before loading", mm(data.focus().into()))
}

/// Numbers, in order of break, of the wires that broke on the side that this camera sees, with a line to the place.
fn break_numbers(canvas: &mut Canvas, camera: &Camera, data: &Data) {
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
