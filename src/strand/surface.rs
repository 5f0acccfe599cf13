//! Surfaces of rigid bodies: how far a point is from one, and how a wire or sphere lies against it.

use crate::scene::rigid::{RigidShape, RigidSpec};
use glam::DVec3;

/// Surface of a rigid body about its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Surface {
    /// Half space; `normal` points out of it.
    Plane {
        /// Unit normal.
        normal: DVec3,
    },
    /// Cylinder; one that ends does so in hemispheres, so that the distance has no corner.
    Cylinder {
        /// Unit vector along its axis.
        axis: DVec3,
        /// Radius (m).
        radius: f64,
        /// Half of its length without the hemispheres (m); infinite where it is endless.
        half_length: f64,
    },
    /// Sphere.
    Sphere {
        /// Radius (m).
        radius: f64,
    },
}

/// Distance of a point from a surface.
#[derive(Debug, Clone, Copy)]
pub struct Distance {
    /// The distance (m), below 0 inside.
    pub value: f64,
    /// Its gradient, a unit vector out of the body.
    pub outward: DVec3,
    /// Distance from the axis or centre (m); infinite of a plane.
    centre: f64,
    /// The axis where the surface is straight along it, else 0.
    axis: DVec3,
}

impl Distance {
    /// Second derivative of the distance applied to `v`: (v − n n·v − a a·v)/ρ; 0 for a plane.
    pub fn hessian(&self, v: DVec3) -> DVec3 {
        if self.centre.is_infinite() {
            return DVec3::ZERO;
        }
        (v - self.outward * self.outward.dot(v) - self.axis * self.axis.dot(v)) / self.centre
    }
}

impl Surface {
    /// Of a body.
    pub fn of(body: &RigidSpec) -> Self {
        match body.shape {
            RigidShape::Plane { normal } => Self::Plane { normal: normal.normalize() },
            RigidShape::Cylinder { axis, diameter, length } => Self::Cylinder {
                axis: axis.normalize(),
                radius: 0.5 * diameter,
                half_length: length.map_or(f64::INFINITY, |length| 0.5 * length),
            },
            RigidShape::Sphere { diameter, .. } => Self::Sphere { radius: 0.5 * diameter },
        }
    }

    /// Of the point `p` from the body's place (m).
    pub fn distance(&self, p: DVec3) -> Distance {
        let from = |way: DVec3, radius: f64, axis: DVec3| {
            let centre = way.length();
            Distance { value: centre - radius, outward: way / centre, centre, axis }
        };
        match *self {
            Self::Plane { normal } => {
                Distance { value: p.dot(normal), outward: normal, centre: f64::INFINITY, axis: DVec3::ZERO }
            }
            Self::Sphere { radius } => from(p, radius, DVec3::ZERO),
            Self::Cylinder { axis, radius, half_length } => {
                let along = p.dot(axis);
                let foot = along.clamp(-half_length, half_length);
                from(p - axis * foot, radius, if along == foot { axis } else { DVec3::ZERO })
            }
        }
    }

    /// Its radius (m); infinite of a plane.
    pub fn radius(&self) -> f64 {
        match *self {
            Self::Plane { .. } => f64::INFINITY,
            Self::Cylinder { radius, .. } | Self::Sphere { radius } => radius,
        }
    }

    /// R* of a sphere of radius `r` (m) on it (m). On a cylinder the geometric mean of the two principal relative radii: the
    /// force is 2.5 % low where R = r/2, 1.0 % where R = r, 0.07 % where R = 5 r (Johnson, Contact Mechanics, 1985, equations
    /// 4.25 and 4.26, with F₂ = 1).
    pub fn reduced_radius(&self, r: f64) -> f64 {
        match *self {
            Self::Plane { .. } => r,
            Self::Sphere { radius } => r * radius / (r + radius),
            Self::Cylinder { radius, .. } => r * (radius / (r + radius)).sqrt(),
        }
    }

    /// R* of the line law ([`mod@crate::law::contact::line`]) for a smooth wire of radius `r` (m) on it (m), with which
    /// 4R*κ = sin²τ. As for two wires on a plane and on a cylinder; on a sphere r (R/(R + r))², which makes the force of a
    /// straight wire Hertz's within 0.6 % for R ≥ 5 r, and 5 % high where R = r.
    pub fn section_radius(&self, r: f64) -> f64 {
        match *self {
            Self::Plane { .. } => r,
            Self::Cylinder { radius, .. } => r * radius / (r + radius),
            Self::Sphere { radius } => r * (radius / (r + radius)).powi(2),
        }
    }

    /// The point of a segment that is nearest to it, and how near it is (m); `ends` are from the body's place (m).
    pub fn nearest(&self, ends: [DVec3; 2]) -> (DVec3, f64) {
        let at = |share: f64| ends[0].lerp(ends[1], share);
        let far = |share: f64| self.distance(at(share)).value;
        // The distance from a convex body is convex along a line: the search by thirds finds its least place.
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..80 {
            let third = (high - low) / 3.0;
            if far(low + third) < far(high - third) { high -= third } else { low += third }
        }
        let middle = 0.5 * (low + high);
        (at(middle), far(middle))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> [Surface; 4] {
        let axis = DVec3::new(1.0, 2.0, -0.5).normalize();
        [
            Surface::Plane { normal: axis },
            Surface::Sphere { radius: 2.0 },
            Surface::Cylinder { axis, radius: 2.0, half_length: f64::INFINITY },
            Surface::Cylinder { axis, radius: 2.0, half_length: 0.3 },
        ]
    }

    #[test]
    fn gradient_and_hessian_are_those_of_differences() {
        let (p, h) = (DVec3::new(1.7, -2.1, 3.3), 1e-5);
        for surface in all() {
            let d = surface.distance(p);
            for e in [DVec3::X, DVec3::Y, DVec3::Z] {
                let [a, b] = [p + e * h, p - e * h].map(|p| surface.distance(p));
                assert!(((a.value - b.value) / (2.0 * h) - d.outward.dot(e)).abs() < 1e-9, "{surface:?}");
                assert!(((a.outward - b.outward) / (2.0 * h) - d.hessian(e)).length() < 1e-8, "{surface:?}");
            }
        }
    }

    #[test]
    fn no_point_of_a_segment_is_nearer_than_the_nearest() {
        let ends = [DVec3::new(-3.0, 2.5, 1.0), DVec3::new(4.0, 2.0, -0.5)];
        for surface in all() {
            let (place, least) = surface.nearest(ends);
            assert!((surface.distance(place).value - least).abs() < 1e-12);
            let fine = (0..=10_000).map(|i| surface.distance(ends[0].lerp(ends[1], f64::from(i) / 1e4)).value);
            let fine = fine.fold(f64::INFINITY, f64::min);
            assert!(least <= fine + 1e-9 && least > fine - 1e-6, "{surface:?}: {least} {fine}");
        }
    }
}
