//! Shapes of rigid bodies for pictures, put together of pieces with round ends.

use crate::engine::view::{BodyShape, RunInfo, Snapshot};
use glam::{DVec3, Vec3};

/// Lines of a grid to either side of its middle.
const LINES: i32 = 8;
/// Radius of a line over the distance from one to the next (-).
const THIN: f32 = 0.03;

/// All points that are no further than `radius` from the line between two points (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// The two points (m), which may be one.
    pub ends: [Vec3; 2],
    /// Radius (m).
    pub radius: f32,
}

/// The pieces of all rigid bodies of a snapshot: a sphere or cylinder is one, a plane a grid of thin ones. What is endless
/// reaches as far as the particles before loading do from corner to corner.
pub fn pieces(info: &RunInfo, snapshot: &Snapshot) -> Vec<Piece> {
    let mut all = Vec::new();
    let points = info.rest_position.iter().copied().map(Vec3::from);
    let (low, high) = points.fold((Vec3::MAX, Vec3::MIN), |(low, high), p| (low.min(p), high.max(p)));
    let thick = info.radius.iter().copied().fold(0.0, f32::max);
    let (middle, far) = (0.5 * (low + high), (high - low).length() + 4.0 * thick);
    for (body, state) in info.bodies.iter().zip(&snapshot.sample.bodies) {
        let [place, axis] = [state.position, direction(&body.shape)].map(|v| DVec3::from(v).as_vec3());
        match body.shape {
            BodyShape::Sphere { radius } => all.push(Piece { ends: [place; 2], radius: radius as f32 }),
            BodyShape::Cylinder { radius, length, .. } => {
                let (centre, half) = match length {
                    Some(length) => (place, 0.5 * length as f32),
                    None => (place + axis * (middle - place).dot(axis), far),
                };
                let ends = [centre - axis * half, centre + axis * half];
                all.push(Piece { ends, radius: radius as f32 });
            }
            BodyShape::Plane { .. } => {
                let step = far / LINES as f32;
                let radius = THIN * step;
                // The lines lie below the surface.
                let centre = middle - axis * ((middle - place).dot(axis) + radius);
                let one = axis.any_orthonormal_vector();
                for [along, across] in [[one, axis.cross(one)], [axis.cross(one), one]] {
                    all.extend((-LINES..=LINES).map(|k| {
                        let at = centre + across * (k as f32 * step);
                        Piece { ends: [at - along * far, at + along * far], radius }
                    }));
                }
            }
        }
    }
    all
}

fn direction(shape: &BodyShape) -> [f64; 3] {
    match *shape {
        BodyShape::Plane { normal: axis } | BodyShape::Cylinder { axis, .. } => axis,
        BodyShape::Sphere { .. } => [0.0, 0.0, 1.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::view::{BodyInfo, BodyState, Sample};

    #[test]
    fn pieces_lie_where_the_bodies_are() {
        let body = |shape| BodyInfo { name: String::new(), shape };
        let shapes = [
            BodyShape::Sphere { radius: 2.0 },
            BodyShape::Cylinder { axis: [0.0, 1.0, 0.0], radius: 0.5, length: Some(3.0) },
            BodyShape::Cylinder { axis: [1.0, 0.0, 0.0], radius: 0.5, length: None },
            BodyShape::Plane { normal: [0.0, 0.0, 1.0] },
        ];
        let info = RunInfo {
            bodies: shapes.map(body).into(),
            rest_position: vec![[0.0; 3], [0.0, 0.0, 10.0]],
            radius: vec![0.25; 2],
            ..RunInfo::default()
        };
        let state = BodyState { position: [7.0, 8.0, -9.0], ..BodyState::default() };
        let sample = Sample { bodies: vec![state; 4], ..Sample::default() };
        let all = pieces(&info, &Snapshot { sample, ..Snapshot::default() });
        let piece = |a: [f32; 3], b: [f32; 3], radius| Piece { ends: [a.into(), b.into()], radius };
        assert_eq!(all[0], piece([7.0, 8.0, -9.0], [7.0, 8.0, -9.0], 2.0));
        assert_eq!(all[1], piece([7.0, 6.5, -9.0], [7.0, 9.5, -9.0], 0.5));
        // As far to both sides of the particles, whose box has a diagonal of 10, and 4 radii more.
        assert_eq!(all[2], piece([-11.0, 8.0, -9.0], [11.0, 8.0, -9.0], 0.5));
        assert_eq!(all.len(), 3 + 2 * 17);
        let below = |line: &Piece| line.ends.iter().all(|end| (end.z + line.radius + 9.0).abs() < 1e-5);
        assert!(all[3..].iter().all(below));
    }
}
