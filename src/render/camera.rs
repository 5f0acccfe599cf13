//! Orthographic camera: lengths in the picture are true, so scale bars hold everywhere in a panel.

use super::canvas::Rect;
use glam::{Mat3, Vec3};

/// A view of the scene through one panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// World axes to view axes: x right, y up, z towards the eye.
    pub rotation: Mat3,
    /// The point in the middle of the panel (m).
    pub centre: Vec3,
    /// The panel (px).
    pub panel: Rect,
    /// Magnification (px/m).
    pub scale: f32,
    /// Half of the depth that is drawn (m).
    pub depth: f32,
}

impl Camera {
    /// Rotation of an eye that sees the strand's axis z to the right and y up, turned by `azimuth` about the
    /// vertical and by `elevation` about the horizontal (rad).
    pub fn orientation(azimuth: f64, elevation: f64) -> Mat3 {
        // Rows are the view axes in world coordinates: right = z, up = y, towards the eye = right × up = −x.
        let base = Mat3::from_cols(Vec3::new(0.0, 0.0, -1.0), Vec3::Y, Vec3::X);
        Mat3::from_rotation_x(elevation as f32) * Mat3::from_rotation_y(azimuth as f32) * base
    }

    /// Direction from the scene to the eye, of unit length.
    pub fn to_eye(self) -> Vec3 {
        self.rotation.transpose() * Vec3::Z
    }

    /// View coordinates of a point (m), relative to the centre.
    pub fn to_view(self, p: Vec3) -> Vec3 {
        self.rotation * (p - self.centre)
    }

    /// Whether a piece of wire between two spheres (centre and radius (m)) can reach into the panel.
    pub fn sees(&self, a: [f32; 4], b: [f32; 4]) -> bool {
        let reach = a[3].max(b[3]) + 2.0 / self.scale;
        let [a, b] = [a, b].map(|p| self.to_view(Vec3::new(p[0], p[1], p[2])));
        let half = [0.5 * self.panel.w / self.scale + reach, 0.5 * self.panel.h / self.scale + reach];
        let inside = |a: f32, b: f32, half: f32| a.min(b) < half && a.max(b) > -half;
        inside(a.x, b.x, half[0]) && inside(a.y, b.y, half[1])
    }

    /// Pixel of a point.
    pub fn project(&self, p: Vec3) -> [f32; 2] {
        let v = self.to_view(p);
        let middle = [self.panel.x + 0.5 * self.panel.w, self.panel.y + 0.5 * self.panel.h];
        [middle[0] + v.x * self.scale, middle[1] - v.y * self.scale]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(azimuth: f64, elevation: f64) -> Camera {
        Camera {
            rotation: Camera::orientation(azimuth, elevation),
            centre: Vec3::new(1.0, 2.0, 3.0),
            panel: Rect::new(100.0, 50.0, 400.0, 200.0),
            scale: 10.0,
            depth: 100.0,
        }
    }

    #[test]
    fn the_axis_runs_to_the_right_and_y_up() {
        let c = camera(0.0, 0.0);
        assert_eq!(c.project(c.centre), [300.0, 150.0]);
        assert_eq!(c.project(c.centre + Vec3::Z), [310.0, 150.0]);
        assert_eq!(c.project(c.centre + Vec3::Y), [300.0, 140.0]);
        assert!(c.to_view(c.centre - Vec3::X).z > 0.99, "the eye is on the side of −x");
    }

    #[test]
    fn half_a_turn_shows_the_back_with_the_axis_still_to_the_right() {
        let c = camera(0.0, std::f64::consts::PI);
        let [x, y] = c.project(c.centre + Vec3::Z + Vec3::Y);
        assert!((x - 310.0).abs() < 1e-3 && (y - 160.0).abs() < 1e-3);
        assert!(c.to_view(c.centre + Vec3::X).z > 0.99);
    }

    #[test]
    fn only_what_reaches_into_the_panel_is_seen() {
        let c = camera(0.0, 0.0);
        let at = |z: f32| [1.0, 2.0, 3.0 + z, 1.0];
        assert!(c.sees(at(0.0), at(0.0)));
        assert!(c.sees(at(20.5), at(25.0)), "its edge is still inside");
        assert!(!c.sees(at(22.0), at(25.0)));
        assert!(c.sees(at(-50.0), at(50.0)), "it crosses the whole panel");
    }

    #[test]
    fn orientations_are_rotations() {
        for (a, e) in [(0.0, 0.0), (0.5, 0.3), (-1.2, 3.1)] {
            let m = Camera::orientation(a, e);
            assert!((m.determinant() - 1.0).abs() < 1e-5);
            assert!((m * m.transpose()).abs_diff_eq(Mat3::IDENTITY, 1e-5));
        }
    }
}
