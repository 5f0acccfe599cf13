//! Which camera each three-dimensional panel has. Cameras depend on the run's fixed data and on the material section
//! in view, so that nothing jumps from frame to frame.

use super::camera::Camera;
use super::canvas::Rect;
use super::style::CameraOptions;
use crate::engine::view::{RunInfo, Snapshot};
use glam::Vec3;

/// Strain for which the overview leaves room when the run does not know where it will end (-).
pub const UNKNOWN_STRAIN: f64 = 0.3;

/// Size and place of the body before loading (mm).
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
    /// Greatest distance of a wire's surface from the axis, per layer (mm).
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
            (low, high) = (Vec3::splat(-1.0), Vec3::ONE);
        }
        let middle = 0.5 * (low + high);
        let axis = Vec3::new(middle.x, middle.y, 0.0);
        let surface = |i: usize| {
            let [x, y, _] = info.rest_position[i];
            (x - axis.x).hypot(y - axis.y) + info.radius[i]
        };
        let radius = (0..info.rest_position.len()).map(surface).fold(1e-6, f32::max);
        let depth = wire_depth(info, axis);
        let mut layer_radius = vec![0f32; info.layers.len()];
        for wire in &info.wires {
            let widest = (wire.first..wire.first + wire.len).map(surface).fold(0.0, f32::max);
            layer_radius[wire.layer] = layer_radius[wire.layer].max(widest);
        }
        Self { low, high, axis, radius, depth, layer_radius }
    }
}

fn wire_depth(info: &RunInfo, axis: Vec3) -> Vec<f32> {
    let distance = |wire: &crate::engine::view::WireInfo| {
        let points = &info.rest_position[wire.first..wire.first + wire.len];
        let sum: f32 = points.iter().map(|p| (p[0] - axis.x).hypot(p[1] - axis.y)).sum();
        sum / wire.len.max(1) as f32
    };
    let all: Vec<f32> = info.wires.iter().map(distance).collect();
    let greatest = all.iter().copied().fold(0.0, f32::max);
    all.iter().map(|d| if greatest > 1e-6 { d / greatest } else { 1.0 }).collect()
}

/// Camera of the overview: the whole body with room for its stretch, always at the same scale.
pub fn overview(info: &RunInfo, body: &Body, options: &CameraOptions, panel: Rect, unit: f32) -> Camera {
    let length = body.high.z - body.low.z;
    let gauge = info.gauge.map_or(length, |[low, high]| high - low);
    let stretched = length + gauge * info.strain_end.unwrap_or(UNKNOWN_STRAIN) as f32;
    let view = panel.inset(14.0 * unit, 22.0 * unit, 14.0 * unit, 8.0 * unit);
    // The width decides, unless the body is so short that it would not fit the height.
    let scale = (view.w / stretched).min(view.h / (2.0 * body.radius));
    let centre = Vec3::new(body.axis.x, body.axis.y, body.low.z + 0.5 * stretched);
    let reach = stretched + 10.0 * body.radius;
    Camera { rotation: Camera::orientation(0.0, options.elevation_deg), centre, panel, scale, depth: reach }
}

/// Camera of a close-up on the section at `z` (mm); `turn_deg` is added to the elevation.
pub fn section(body: &Body, options: &CameraOptions, panel: Rect, z: f32, turn_deg: f32) -> Camera {
    // The strand fills a little more than half of the height: the rest is for wires that spring out.
    let scale = options.zoom * (panel.h / 3.5).min(panel.w / 5.0) / body.radius;
    Camera {
        rotation: Camera::orientation(options.azimuth_deg, options.elevation_deg + turn_deg),
        centre: Vec3::new(body.axis.x, body.axis.y, z),
        panel,
        scale,
        depth: 10.0 * (body.high - body.low).length().max(body.radius),
    }
}

/// Camera that shows everything from an angle. Its field grows by fixed factors when something leaves it.
pub fn everything(body: &Body, snapshot: &Snapshot, options: &CameraOptions, panel: Rect) -> Camera {
    let rotation = Camera::orientation(options.azimuth_deg - 28.0, options.elevation_deg + 22.0);
    let centre = 0.5 * (body.low + body.high);
    let reach = |points: &mut dyn Iterator<Item = (Vec3, f32)>| {
        points.fold([1e-6f32; 2], |m, (p, r)| {
            let v = rotation * (p - centre);
            [m[0].max(v.x.abs() + r), m[1].max(v.y.abs() + r)]
        })
    };
    let corners = (0..8).map(|k| {
        let pick = |bit: usize, low: f32, high: f32| if k & bit == 0 { low } else { high };
        let p = Vec3::new(
            pick(1, body.low.x, body.high.x),
            pick(2, body.low.y, body.high.y),
            pick(4, body.low.z, body.high.z),
        );
        (p, 0.0)
    });
    let [rest_x, rest_y] = reach(&mut corners.into_iter());
    let now = snapshot.position.iter().zip(&snapshot.radius).map(|(p, r)| (Vec3::from(*p), *r));
    let [now_x, now_y] = reach(&mut now.into_iter());
    let fit = |x: f32, y: f32| (0.5 * panel.w / x).min(0.5 * panel.h / y);
    let mut scale = fit(rest_x, rest_y) / 1.3;
    let needed = fit(now_x, now_y);
    while scale > needed && needed > 0.0 {
        scale /= 1.5;
    }
    let depth = 4.0 * (body.high - body.low).length() * (fit(rest_x, rest_y) / scale);
    Camera { rotation, centre, panel, scale: scale * options.zoom, depth }
}

/// Where the material section that was at `rest_z` is now (mm): the median over wires, which a wire that sprang
/// back does not move.
pub fn current_z(info: &RunInfo, snapshot: &Snapshot, rest_z: f32) -> f32 {
    let mut places: Vec<f32> = info
        .wires
        .iter()
        .filter_map(|wire| {
            let at = |i: usize| info.rest_position[i][2];
            let nearest = (wire.first..wire.first + wire.len)
                .min_by(|&a, &b| (at(a) - rest_z).abs().total_cmp(&(at(b) - rest_z).abs()))?;
            Some(snapshot.position[nearest][2] + rest_z - at(nearest))
        })
        .collect();
    if places.is_empty() {
        return rest_z;
    }
    places.sort_by(f32::total_cmp);
    let middle = places.len() / 2;
    0.5 * (places[middle] + places[(places.len() - 1) / 2])
}
