//! Cameras on the section in view. They depend on the run's fixed data and on that section alone, so that nothing jumps
//! from frame to frame.

use super::camera::Camera;
use super::canvas::Rect;
use super::data::Data;
use crate::base::units::mm;
use glam::Vec3;

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
