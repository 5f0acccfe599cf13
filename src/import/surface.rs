//! Surfaces on which lines are drawn (pcurves), by their two parameters.

use super::spline::SplineSurface;
use glam::DVec3;

/// Origin and axes of a placed surface or curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Origin.
    pub origin: DVec3,
    /// Unit vectors.
    pub x: DVec3,
    /// At a right angle to the other two.
    pub y: DVec3,
    /// The axis.
    pub z: DVec3,
}

/// A surface, parametrised as in ISO 10303-42.
#[derive(Debug, Clone, PartialEq)]
pub enum Surface {
    /// u along x, v along y.
    Plane(Frame),
    /// A cone, or a cylinder where nothing widens: u around the axis, v along it.
    Cone {
        /// Its axis.
        frame: Frame,
        /// Radius at v = 0.
        radius: f64,
        /// By which it grows per v (-).
        widening: f64,
        /// What u counts (rad).
        angle: f64,
    },
    /// u around the axis, v around the circle within.
    Torus {
        /// Its axis.
        frame: Frame,
        /// From the axis to the circle within.
        major: f64,
        /// Of the circle within.
        minor: f64,
        /// What u and v count (rad).
        angle: f64,
    },
    /// A B-spline surface.
    Spline(SplineSurface),
}

impl Frame {
    /// The axes with `z` and, as nearly as may be, `x`; `None` where they have one direction or none.
    pub fn new(origin: DVec3, z: DVec3, x: DVec3) -> Option<Self> {
        let z = z.try_normalize()?;
        let x = x.reject_from_normalized(z).try_normalize().filter(|x| x.is_finite() && origin.is_finite())?;
        Some(Self { origin, x, y: z.cross(x), z })
    }

    /// Unit vector at an angle (rad) around the axis.
    pub fn around(&self, angle: f64) -> DVec3 {
        self.x * angle.cos() + self.y * angle.sin()
    }

    /// Coordinates of a point.
    pub fn local(&self, point: DVec3) -> DVec3 {
        let from = point - self.origin;
        DVec3::new(from.dot(self.x), from.dot(self.y), from.dot(self.z))
    }
}

impl Surface {
    /// Point at u and v.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        match self {
            Self::Plane(frame) => frame.origin + frame.x * u + frame.y * v,
            Self::Cone { frame, radius, widening, angle } => {
                frame.origin + frame.around(u * angle) * (radius + v * widening) + frame.z * v
            }
            Self::Torus { frame, major, minor, angle } => {
                let (sin, cos) = (v * angle).sin_cos();
                frame.origin + frame.around(u * angle) * (major + minor * cos) + frame.z * (minor * sin)
            }
            Self::Spline(surface) => surface.point(u, v),
        }
    }
}
