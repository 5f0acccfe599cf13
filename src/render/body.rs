//! The body before loading.

use crate::engine::view::{RunInfo, WireInfo};
use glam::Vec3;

/// Strain for which views leave room when the run does not know where it will end (-).
pub const UNKNOWN_STRAIN: f64 = 0.3;

/// Size and place of the body before loading (m).
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Least corner of the box around all particles.
    pub low: Vec3,
    /// Greatest corner.
    pub high: Vec3,
    /// Middle of the cross-section.
    pub axis: Vec3,
    /// Greatest distance of a wire's surface from the axis.
    pub radius: f32,
    /// Mean distance of each wire from the axis over the greatest such distance (-); 1 when all lie on the axis.
    pub depth: Vec<f32>,
    /// Greatest distance of a wire's surface from the axis, per layer (m).
    pub layer_radius: Vec<f32>,
}

impl Body {
    /// Measures the body at rest.
    pub fn of(info: &RunInfo) -> Self {
        let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
        for (p, r) in info.rest_position.iter().zip(&info.radius) {
            low = low.min(Vec3::from(*p) - *r);
            high = high.max(Vec3::from(*p) + *r);
        }
        if info.rest_position.is_empty() {
            (low, high) = (Vec3::splat(-1e-3), Vec3::splat(1e-3));
        }
        let middle = 0.5 * (low + high);
        let axis = Vec3::new(middle.x, middle.y, 0.0);
        let surface = |i: usize| {
            let [x, y, _] = info.rest_position[i];
            (x - axis.x).hypot(y - axis.y) + info.radius[i]
        };
        let radius = (0..info.rest_position.len()).map(surface).fold(1e-9, f32::max);
        let depth = wire_depth(info, axis);
        let mut layer_radius = vec![0f32; info.layers.len()];
        for wire in &info.wires {
            let widest = wire.particles().map(surface).fold(0.0, f32::max);
            layer_radius[wire.layer] = layer_radius[wire.layer].max(widest);
        }
        Self { low, high, axis, radius, depth, layer_radius }
    }

    /// Half of a depth that holds everything that may ever be in view (m).
    pub fn depth_of_view(&self) -> f32 {
        10.0 * (self.high - self.low).length().max(self.radius)
    }

    /// Shade of each wire (-): 1 outside, less further in.
    pub fn shade(&self) -> Vec<f32> {
        self.depth.iter().map(|d| 0.45 + 0.55 * d).collect()
    }
}

fn wire_depth(info: &RunInfo, axis: Vec3) -> Vec<f32> {
    let distance = |wire: &WireInfo| {
        let points = &info.rest_position[wire.particles()];
        let sum: f32 = points.iter().map(|p| (p[0] - axis.x).hypot(p[1] - axis.y)).sum();
        sum / wire.len.max(1) as f32
    };
    let all: Vec<f32> = info.wires.iter().map(distance).collect();
    let greatest = all.iter().copied().fold(0.0, f32::max);
    all.iter().map(|d| if greatest > 1e-9 { d / greatest } else { 1.0 }).collect()
}
