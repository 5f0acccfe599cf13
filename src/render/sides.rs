//! The sides from which close-ups are seen.

use super::camera::Camera;
use super::canvas::Rect;
use super::data::Data;
use super::panel::GAP;
use crate::engine::view::Rupture;
use glam::Vec3;

/// Side of a close-up.
#[derive(Debug, Clone, Copy)]
pub struct Side {
    /// Its name.
    pub name: &'static str,
    /// Turn about the strand's axis (rad).
    pub turn: f64,
}

/// The side of the eye.
pub const FRONT: Side = Side { name: "front", turn: 0.0 };
/// The other one.
const BACK: Side = Side { name: "back", turn: std::f64::consts::PI };

/// The side on which a bond broke, judged before loading: it never changes from frame to frame.
pub fn facing(data: &Data, rupture: &Rupture) -> Side {
    let across = Vec3::from(data.info.rest_position[rupture.bond]) - data.body.axis;
    let to_eye = Camera::orientation(data.camera.azimuth, data.camera.elevation) * across.with_z(0.0);
    if to_eye.z >= 0.0 { FRONT } else { BACK }
}

/// Front and back of a close-up where both have room, else `preferred`.
pub fn sides(panel: Rect, unit: f32, preferred: Side) -> Vec<(Rect, Side)> {
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
