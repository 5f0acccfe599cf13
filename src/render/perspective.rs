//! Perspective as a change of shape: what is nearer to the eye is drawn larger, then all is seen straight on.
//!
//! The shader draws wires as they are seen along parallel lines, which is what makes them cheap. Seen from an eye at distance D
//! from the middle of the picture, a point (x, y, z) of view coordinates lies at (x, y) s with s = D / (D − z). With
//! z' = −D ln(1 − z/D) its surroundings grow by s in depth too (dz'/dz = s), so that a sphere around it becomes a sphere of radius
//! r s, sheared by the slant of the line of sight, which is left out: the outline of a wire of radius r is off by the order of
//! (r/D)² of its radius. Depths keep their order.

use super::camera::Camera;
use super::wires::Segment;
use glam::{Mat3, Vec3};

/// Nearest to the eye that anything is drawn, over the eye's distance from the middle (-).
const NEAREST: f32 = 0.05;

/// An eye at a finite distance.
#[derive(Debug, Clone, Copy)]
pub struct Perspective {
    camera: Camera,
    /// From the middle of the picture to the eye (m).
    distance: f32,
}

impl Perspective {
    /// The eye that sees as much in the middle of `camera`'s picture, whose height it sees under `angle` (rad, above zero).
    pub fn new(camera: Camera, angle: f64) -> Self {
        let distance = 0.5 * camera.panel.h / camera.scale / (0.5 * angle as f32).tan();
        Self { camera, distance }
    }

    /// The camera that sees straight on what was changed.
    pub fn straight(&self) -> Camera {
        let deepest = -(self.distance * NEAREST.ln());
        let depth = self.camera.depth.max(deepest);
        Camera { rotation: Mat3::IDENTITY, centre: Vec3::ZERO, depth, ..self.camera }
    }

    /// Where a point (m) is drawn, and by how much what is there is larger (-); none of one behind the eye, or nearly.
    pub fn place(&self, p: Vec3) -> Option<(Vec3, f32)> {
        let v = self.camera.to_view(p);
        let share = 1.0 - v.z / self.distance;
        (share >= NEAREST).then(|| ((v.truncate() / share).extend(-self.distance * share.ln()), 1.0 / share))
    }

    /// A segment as it is drawn; none where an end of it lies behind the eye.
    pub fn segment(&self, segment: &Segment) -> Option<Segment> {
        let turned = |[x, y, z, w]: [f32; 4]| (self.camera.rotation * Vec3::new(x, y, z)).extend(w).to_array();
        let (a, tangent_a) = self.end(segment.a, turned(segment.tangent_a))?;
        let (b, tangent_b) = self.end(segment.b, turned(segment.tangent_b))?;
        let [occlusion_a, occlusion_b] = [segment.occlusion_a, segment.occlusion_b].map(turned);
        Some(Segment { a, b, tangent_a, tangent_b, occlusion_a, occlusion_b, ..*segment })
    }

    /// Centre and radius of an end, and the wire's tangent there: the change's derivative along it.
    fn end(&self, [x, y, z, radius]: [f32; 4], [tx, ty, tz, kind]: [f32; 4]) -> Option<([f32; 4], [f32; 4])> {
        let (place, larger) = self.place(Vec3::new(x, y, z))?;
        let slant = place.truncate() / self.distance * tz;
        let tangent = Vec3::new(tx + slant.x, ty + slant.y, tz).normalize();
        Some((place.extend(radius * larger).to_array(), tangent.extend(kind).to_array()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::canvas::Rect;

    fn camera() -> Camera {
        Camera {
            rotation: Camera::orientation(0.4, -0.3),
            centre: Vec3::new(1.0, -2.0, 3.0),
            panel: Rect::new(0.0, 0.0, 400.0, 300.0),
            scale: 100.0,
            depth: 10.0,
        }
    }

    /// The pixel at which a pinhole camera sees a point, by similar triangles.
    fn pinhole(camera: &Camera, angle: f32, p: Vec3) -> [f32; 2] {
        let to_eye = camera.to_eye();
        let eye = camera.centre + to_eye * (0.5 * camera.panel.h / camera.scale) / (0.5 * angle).tan();
        let ray = p - eye;
        let hit = eye + ray * (eye - camera.centre).dot(to_eye) / -ray.dot(to_eye);
        camera.project(hit)
    }

    #[test]
    fn points_lie_where_a_pinhole_camera_sees_them() {
        let (camera, angle) = (camera(), 0.7);
        let eye = Perspective::new(camera, f64::from(angle));
        for p in [Vec3::ZERO, Vec3::new(1.5, -2.2, 3.1), Vec3::new(0.2, 0.3, 5.0), camera.centre] {
            let (place, _) = eye.place(p).unwrap();
            let (drawn, seen) = (eye.straight().project(place), pinhole(&camera, angle, p));
            assert!((drawn[0] - seen[0]).hypot(drawn[1] - seen[1]) < 2e-3, "{p}: {drawn:?}, {seen:?}");
        }
    }

    #[test]
    fn magnification_is_that_of_a_short_piece_in_every_direction_and_tangents_follow() {
        let camera = camera();
        let eye = Perspective::new(camera, 0.7);
        let (p, step) = (Vec3::new(1.4, -1.0, 2.2), 1e-2);
        let (place, larger) = eye.place(p).unwrap();
        for direction in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(0.6, 0.0, -0.8)] {
            let moved = (eye.place(p + direction * step).unwrap().0 - place) / step;
            let view = camera.rotation * direction;
            assert!((moved.z - view.z * larger).abs() < 2e-2, "{moved}");
            let segment = Segment {
                a: p.extend(0.1).to_array(),
                b: p.extend(0.1).to_array(),
                tangent_a: direction.extend(0.0).to_array(),
                tangent_b: direction.extend(0.0).to_array(),
                colour_a: [0.0; 4],
                colour_b: [0.0; 4],
                occlusion_a: [0.0; 4],
                occlusion_b: [0.0; 4],
            };
            let drawn = eye.segment(&segment).unwrap();
            assert!((drawn.a[3] - 0.1 * larger).abs() < 1e-6);
            let tangent = Vec3::from_slice(&drawn.tangent_a[..3]);
            assert!(tangent.dot(moved.normalize()) > 0.9999, "{tangent}, {moved}");
        }
    }

    #[test]
    fn what_lies_behind_the_eye_is_not_drawn_and_depths_keep_their_order() {
        let camera = camera();
        let eye = Perspective::new(camera, 0.7);
        let at = |near: f32| eye.place(camera.centre + camera.to_eye() * near * eye.distance);
        assert!(at(1.1).is_none() && at(0.96).is_none());
        let depths: Vec<f32> = [-9.0, -1.0, 0.0, 0.5, 0.9, 0.94].iter().map(|near| at(*near).unwrap().0.z).collect();
        assert!(depths.is_sorted() && depths[5] < eye.straight().depth, "{depths:?}");
    }

    #[test]
    fn a_narrow_angle_is_the_view_along_parallel_lines() {
        let camera = camera();
        let eye = Perspective::new(camera, 1e-4);
        let p = Vec3::new(1.3, -2.4, 2.0);
        let (drawn, seen) = (eye.straight().project(eye.place(p).unwrap().0), camera.project(p));
        assert!((drawn[0] - seen[0]).hypot(drawn[1] - seen[1]) < 0.05, "{drawn:?}, {seen:?}");
    }
}
