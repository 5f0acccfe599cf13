//! The cameras of a frame: which three-dimensional pictures there are, and what each shows.

use super::camera::Camera;
use super::canvas::Rect;
use super::cutaway;
use super::exploded;
use super::frame::Data;
use super::layout::{GAP, Layout};
use super::style::{FrameOptions, View};
use super::viewpoint;
use crate::engine::view::Rupture;
use glam::Vec3;

/// A camera and what it is for.
pub struct Shot {
    /// The view that it belongs to.
    pub view: View,
    /// The camera.
    pub camera: Camera,
    /// Title.
    pub caption: &'static str,
    /// Remark after the title.
    pub remark: String,
    /// Depth over which things darken (mm).
    pub fade: f32,
}

/// Whether a view needs the graphics adapter.
pub fn is_solid(view: View) -> bool {
    !matches!(view, View::CrossSection | View::Unrolled | View::Curve)
}

/// Side of a close-up: a title, and a turn about the strand's axis (°).
type Side = (&'static str, f32);
const FRONT: Side = ("front", 0.0);
const BACK: Side = ("back", 180.0);

/// Every shot of the frame.
pub fn shots(data: &Data, options: &FrameOptions, layout: &Layout) -> Vec<Shot> {
    let u = layout.unit;
    let body = data.body;
    let rest_z = focus(data, options);
    let z = viewpoint::current_z(data.info, data.snapshot, rest_z);
    let around = format!("around z {rest_z:.1} mm before loading");
    // The picture of layers faces the first break whatever its layer; the close-up only shows the outermost layer.
    let first = data.ruptures.first();
    let facing_first = first.map_or(FRONT, |r| facing(data, options, r));
    let facing_outer = if first.is_some_and(|r| r.layer + 1 == data.info.layers.len()) { facing_first } else { FRONT };
    let mut shots = Vec::new();
    for (view, panel) in &layout.panels {
        let mut shot = |camera, caption, remark: String, fade| {
            shots.push(Shot { view: *view, camera, caption, remark, fade });
        };
        match view {
            View::Overview => {
                let camera = viewpoint::overview(data.info, body, &options.camera, *panel, u);
                shot(camera, "whole strand", String::new(), body.radius);
            }
            View::Midsection => {
                let sides = sides(*panel, u, facing_outer);
                let alone = sides.len() == 1;
                for (panel, (side, turn)) in sides {
                    let camera = viewpoint::section(body, &options.camera, panel, z, turn);
                    let slant = options.camera.azimuth_deg.to_radians().sin().abs();
                    let caption = if alone { "midsection" } else { side };
                    let remark = if alone { format!("{side}, {around}") } else { around.clone() };
                    shot(camera, caption, remark, body.radius + slant * panel.w / camera.scale);
                }
            }
            View::Exploded => {
                for (panel, (side, turn)) in sides(*panel, u, facing_first) {
                    let camera = exploded::camera(body, &options.camera, panel, u, z, turn);
                    shot(camera, "layers apart", side.to_owned(), body.radius);
                }
            }
            View::Cutaway => {
                let camera = cutaway::camera(data.info, body, &options.camera, *panel, z);
                shot(camera, "cut open", around.clone(), 2.0 * body.radius);
            }
            View::Scene => {
                let camera = viewpoint::everything(body, data.snapshot, &options.camera, *panel);
                shot(camera, "", String::new(), 2.0 * (body.high - body.low).length());
            }
            View::CrossSection | View::Unrolled | View::Curve => {}
        }
    }
    shots
}

/// The side on which a bond broke, judged before loading: it never changes from frame to frame.
fn facing(data: &Data, options: &FrameOptions, rupture: &Rupture) -> Side {
    let across = Vec3::from(data.info.rest_position[rupture.bond]) - data.body.axis;
    let to_eye = Camera::orientation(options.camera.azimuth_deg, options.camera.elevation_deg) * across.with_z(0.0);
    if to_eye.z >= 0.0 { FRONT } else { BACK }
}

/// Front and back of a close-up where both have room, else `preferred`.
fn sides(panel: Rect, unit: f32, preferred: Side) -> Vec<(Rect, Side)> {
    let gap = GAP * unit;
    if panel.h >= 420.0 * unit && panel.w < 2.2 * panel.h {
        let h = (0.5 * (panel.h - gap)).floor();
        let low = Rect { h, y: panel.bottom() - h, ..panel };
        vec![(Rect { h, ..panel }, FRONT), (low, BACK)]
    } else if panel.w >= 800.0 * unit {
        let w = (0.5 * (panel.w - gap)).floor();
        let right = Rect { w, x: panel.right() - w, ..panel };
        vec![(Rect { w, ..panel }, FRONT), (right, BACK)]
    } else {
        vec![(panel, preferred)]
    }
}

/// z before loading (mm) of the section that close-ups follow.
pub fn focus(data: &Data, options: &FrameOptions) -> f32 {
    let [low, high] = data.info.gauge.unwrap_or([data.body.low.z, data.body.high.z]);
    let first = data.ruptures.first().map(|r| r.rest_z as f32 * 1e3);
    options.camera.focus_z_mm.or(first).unwrap_or(0.5 * (low + high))
}
