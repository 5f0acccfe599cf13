//! What kind of scene it is, for what is told and charted of it.

use crate::engine::view::{RunInfo, Snapshot};
use glam::Vec3;
use std::f64::consts::PI;

/// What is done to the bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Grips pull or press towards a strain that is known.
    Pulled,
    /// Grips do something else: turn, or go to and fro.
    Held,
    /// Wires without grips: they bend.
    Bent,
    /// Two free spheres.
    Collision,
    /// Any other free bodies.
    Free,
}

impl Kind {
    /// Of a run.
    pub fn of(info: &RunInfo) -> Self {
        match (info.gauge, info.wires.len(), info.particles) {
            (Some(_), ..) if info.is_pulled() => Self::Pulled,
            (Some(_), ..) => Self::Held,
            (None, 0, 2) => Self::Collision,
            (None, 0, _) => Self::Free,
            (None, ..) => Self::Bent,
        }
    }

    /// What is charted over time of bodies without grips: deflection (m), approach of two spheres (m, above 0 where they
    /// touch), or greatest speed (m/s).
    pub fn measure(self, info: &RunInfo, snapshot: &Snapshot) -> Option<f64> {
        match self {
            Self::Pulled | Self::Held => None,
            Self::Bent => most_deflected(info, snapshot).map(|(_, by)| by),
            Self::Collision => Some(approach(snapshot)),
            Self::Free => Some(snapshot.speed.iter().copied().fold(0.0, f32::max).into()),
        }
    }
}

/// The wire particle that has moved furthest from its place before loading, and by how much (m).
pub fn most_deflected(info: &RunInfo, snapshot: &Snapshot) -> Option<(usize, f64)> {
    let moved = |i: usize| Vec3::from(snapshot.position[i]).distance(Vec3::from(info.rest_position[i]));
    let all = (0..info.wire_particles).map(|i| (i, f64::from(moved(i))));
    all.reduce(|most, other| if other.1 > most.1 { other } else { most })
}

/// By how much two spheres are nearer than touching (m).
pub fn approach(snapshot: &Snapshot) -> f64 {
    let [a, b] = [0, 1].map(|i| Vec3::from(snapshot.position[i]).as_dvec3());
    f64::from(snapshot.radius[0]) + f64::from(snapshot.radius[1]) - a.distance(b)
}

/// Force between two spheres that touch nothing else (N).
pub fn contact_force(snapshot: &Snapshot) -> f64 {
    f64::from(snapshot.contact_pressure[0]) * PI * f64::from(snapshot.radius[0]).powi(2)
}
