//! Rigid bodies of a scene, resolved: planes, cylinders and spheres that stand still or move as they are told, whatever
//! presses on them.

use super::material::Material;
use glam::DVec3;

/// A rigid body. Its surface is as elastic in contacts as its material; it does not yield, and it does not give way.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidSpec {
    /// Its name, that of no other one.
    pub name: String,
    /// Its shape.
    pub shape: RigidShape,
    /// Where it begins (m): a point of a plane, the middle of a cylinder, the centre of a sphere.
    pub position: DVec3,
    /// How it moves.
    pub motion: RigidMotion,
    /// Name of its material; `None` for that of `[material]`.
    pub material_name: Option<String>,
    /// What that is.
    pub material: Material,
    /// Coulomb friction coefficient with everything (-).
    pub friction: f64,
}

/// Shape of a rigid body. Directions are of any length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RigidShape {
    /// A half space.
    Plane {
        /// Points out of it, to where wires and spheres are.
        normal: DVec3,
    },
    /// A cylinder.
    Cylinder {
        /// Direction of its axis.
        axis: DVec3,
        /// Diameter (m).
        diameter: f64,
        /// Length without the hemispheres in which it then ends (m); `None` where it is endless.
        length: Option<f64>,
    },
    /// A sphere.
    Sphere {
        /// Direction about which it spins.
        axis: DVec3,
        /// Diameter (m).
        diameter: f64,
    },
}

impl RigidShape {
    /// Unit vector about which it spins: the normal of a plane, the axis of a cylinder.
    pub fn axis(&self) -> DVec3 {
        match *self {
            Self::Plane { normal: axis } | Self::Cylinder { axis, .. } | Self::Sphere { axis, .. } => axis.normalize(),
        }
    }

    /// Its word in scenes and results.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Plane { .. } => "plane",
            Self::Cylinder { .. } => "cylinder",
            Self::Sphere { .. } => "sphere",
        }
    }
}

/// A prescribed motion: along a straight line and about an axis that moves along. Both rise smoothly to full speed, and
/// fall as they rose.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RigidMotion {
    /// Velocity at full speed (m/s).
    pub velocity: DVec3,
    /// Spin at full speed (rad/s), right-handed about [`RigidShape::axis`].
    pub spin: f64,
    /// Time in which the motion rises, and in which it falls (s).
    pub ramp: f64,
    /// When it stands still again (s); `None` where it goes on for ever.
    pub duration: Option<f64>,
}

impl RigidMotion {
    /// Whether it ever moves.
    pub fn moves(&self) -> bool {
        self.velocity != DVec3::ZERO || self.spin != 0.0
    }

    /// Time in which a motion at full speed goes as far as this one has gone at `time` (s). Speed rises by the smooth step
    /// 3τ² − 2τ³ of τ = t/ramp, the integral of which is τ³ − τ⁴/2.
    pub fn progress(&self, time: f64) -> f64 {
        let ramp = self.ramp;
        let rise = |t: f64| {
            if ramp == 0.0 {
                return t.max(0.0);
            }
            let tau = (t / ramp).clamp(0.0, 1.0);
            ramp * tau.powi(3) * (1.0 - 0.5 * tau) + (t - ramp).max(0.0)
        };
        rise(time) - self.duration.map_or(0.0, |end| rise(time - (end - ramp)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_rises_and_falls_by_the_smooth_step() {
        let of = |ramp: f64, duration: f64| RigidMotion { ramp, duration: Some(duration), ..RigidMotion::default() };
        let motion = of(0.5, 4.0);
        // At full speed for the duration less one ramp.
        assert!((motion.progress(10.0) - 3.5).abs() < 1e-15);
        assert!((motion.progress(0.25) - 0.5 * (0.125 - 0.031_25)).abs() < 1e-15);
        assert_eq!(of(0.0, 2.0).progress(3.0), 2.0);
        assert_eq!(RigidMotion::default().progress(7.0), 7.0);
        let smooth = |tau: f64| {
            let tau = tau.clamp(0.0, 1.0);
            tau * tau * (3.0 - 2.0 * tau)
        };
        let h = 1e-6;
        for t in [0.1, 0.3, 1.0, 3.6, 3.9] {
            let speed = (motion.progress(t + h) - motion.progress(t - h)) / (2.0 * h);
            assert!((speed - (smooth(t / 0.5) - smooth((t - 3.5) / 0.5))).abs() < 1e-6, "{t}");
        }
    }
}
