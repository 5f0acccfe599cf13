//! Helices through wires, and layers of them.

use super::axis::Course;
use crate::strand::helix::Helix;
use glam::{DAffine3, DVec3};
use std::f64::consts::{PI, TAU};

/// Turn of a wire about the axis (rad) below which it counts as straight.
const LEAST_TURN: f64 = 1e-3;
/// Lay radius over the diameter below which a wire lies on the axis (-).
const ON_AXIS: f64 = 0.05;
/// Step of lay radii, over the diameter, from which a new layer begins (-).
const NEW_LAYER: f64 = 0.2;
/// Difference of pitches or diameters, over the greater, from which wires of one radius are of two layers (-).
const ALIKE: f64 = 0.02;

/// The helix that fits a wire best.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// The helix; straight where its pitch is infinite.
    pub helix: Helix,
    /// Greatest distance of a point of the wire from the helix at its height (m).
    pub deviation: f64,
}

/// Wires of one lay radius, pitch, lay and diameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Its name.
    pub name: String,
    /// Numbers of its wires, from 0.
    pub wires: Vec<usize>,
    /// Diameter of its wires (m); `None` where it is not known.
    pub diameter: Option<f64>,
    /// Mean lay radius (m).
    pub radius: f64,
    /// Mean pitch (m); infinite where its wires are straight.
    pub pitch: f64,
    /// Greatest difference of a wire's pitch from the mean, over it (-).
    pub pitch_spread: f64,
    /// +1 right (Z), −1 left (S).
    pub lay: f64,
    /// Greatest distance of a point from its wire's helix (m).
    pub deviation: f64,
}

/// The helix about z that fits a wire best: radius as the mean of distances, pitch and phase by least squares of the angle
/// over z.
pub fn fit(course: &Course, upright: DAffine3) -> Fit {
    let points: Vec<DVec3> = course.points.iter().map(|point| upright.transform_point3(*point)).collect();
    let count = points.len() as f64;
    let radius = points.iter().map(|point| point.truncate().length()).sum::<f64>() / count;
    let mut angles: Vec<f64> = points.iter().map(|point| point.y.atan2(point.x)).collect();
    for i in 1..angles.len() {
        // The turn between two points is less than half of one.
        angles[i] = angles[i - 1] + (angles[i] - angles[i - 1] + PI).rem_euclid(TAU) - PI;
    }
    let (mean_z, mean_angle) = (points.iter().map(|p| p.z).sum::<f64>() / count, angles.iter().sum::<f64>() / count);
    let (mut squares, mut mixed) = (0.0, 0.0);
    for (point, angle) in points.iter().zip(&angles) {
        squares += (point.z - mean_z) * (point.z - mean_z);
        mixed += (point.z - mean_z) * (angle - mean_angle);
    }
    let heights = points.iter().map(|point| point.z);
    let height = heights.clone().fold(f64::NEG_INFINITY, f64::max) - heights.fold(f64::INFINITY, f64::min);
    let rate = if squares > 0.0 { mixed / squares } else { 0.0 };
    let of = |helix: Helix| {
        let off = points.iter().map(|point| point.distance(helix.point(point.z))).fold(0.0, f64::max);
        Fit { helix, deviation: off }
    };
    let straight = || {
        let mean = points.iter().map(|point| point.truncate()).sum::<glam::DVec2>() / count;
        of(Helix { radius: mean.length(), pitch: f64::INFINITY, lay: 1.0, phase: mean.y.atan2(mean.x) })
    };
    // Of a line on the axis, angles say nothing.
    if course.is_straight || (rate * height).abs() < LEAST_TURN {
        return straight();
    }
    let phase = (mean_angle - rate * mean_z).rem_euclid(TAU);
    of(Helix { radius, pitch: TAU / rate.abs(), lay: rate.signum(), phase })
}

/// Layers from the axis outwards.
pub fn layers(fits: &[Fit], diameters: &[Option<f64>]) -> Vec<Layer> {
    let greatest = fits.iter().map(|fit| fit.helix.radius).fold(0.0, f64::max);
    // Without a diameter, the radii themselves say what is far apart.
    let size = |wire: usize| diameters[wire].unwrap_or(0.2 * greatest);
    let mut order: Vec<usize> = (0..fits.len()).collect();
    order.sort_by(|a, b| fits[*a].helix.radius.total_cmp(&fits[*b].helix.radius));
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut last = f64::NEG_INFINITY;
    for wire in order {
        let radius = fits[wire].helix.radius;
        if groups.is_empty() || radius - last > NEW_LAYER * size(wire) {
            groups.push(Vec::new());
        }
        last = radius;
        if let Some(group) = groups.last_mut() {
            group.push(wire);
        }
    }
    let alike = |a: usize, b: usize| {
        let (p, q) = (fits[a].helix, fits[b].helix);
        let near = |x: f64, y: f64| (x - y).abs() <= ALIKE * x.abs().max(y.abs()) || x == y;
        p.lay == q.lay
            && near(1.0 / p.pitch, 1.0 / q.pitch)
            && diameters[a].zip(diameters[b]).is_none_or(|(x, y)| near(x, y))
    };
    let mut parts: Vec<Vec<usize>> = Vec::new();
    for group in groups {
        let first = parts.len();
        for wire in group {
            match parts[first..].iter_mut().find(|part| alike(part[0], wire)) {
                Some(part) => part.push(wire),
                None => parts.push(vec![wire]),
            }
        }
    }
    let mut outer = 0;
    let layer = |mut wires: Vec<usize>| {
        wires.sort_unstable();
        let mean = |of: &dyn Fn(usize) -> f64| wires.iter().map(|wire| of(*wire)).sum::<f64>() / wires.len() as f64;
        let radius = mean(&|wire| fits[wire].helix.radius);
        let rate = mean(&|wire| fits[wire].helix.pitch.recip());
        let spread = |wire: &usize| if rate > 0.0 { (fits[*wire].helix.pitch * rate - 1.0).abs() } else { 0.0 };
        let is_core = wires.len() == 1 && radius <= ON_AXIS * size(wires[0]).max(0.1 * greatest);
        outer += usize::from(!is_core);
        Layer {
            name: if is_core { "core".into() } else { format!("layer {outer}") },
            diameter: diameters[wires[0]],
            radius,
            pitch: rate.recip(),
            pitch_spread: wires.iter().map(spread).fold(0.0, f64::max),
            lay: fits[wires[0]].helix.lay,
            deviation: wires.iter().map(|wire| fits[*wire].deviation).fold(0.0, f64::max),
            wires,
        }
    };
    parts.into_iter().map(layer).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn course(helix: Helix, length: f64) -> Course {
        let points: Vec<DVec3> = (0..=50).map(|i| helix.point(length * i as f64 / 50.0)).collect();
        Course::new(points.clone(), points, 1e-9)
    }

    #[test]
    fn helices_and_layers_are_found() {
        let helix = |radius, pitch, lay, phase| Helix { radius, pitch, lay, phase };
        let mut wires = vec![helix(0.0, f64::INFINITY, 1.0, 0.0)];
        wires.extend((0..6).map(|i| helix(0.4e-3, 10e-3, 1.0, i as f64)));
        wires.extend((0..12).map(|i| helix(0.8e-3, 14e-3, -1.0, 0.5 * i as f64)));
        let fits: Vec<Fit> = wires.iter().map(|wire| fit(&course(*wire, 12e-3), DAffine3::IDENTITY)).collect();
        for (fit, wire) in fits.iter().zip(&wires) {
            assert!(fit.deviation < 1e-14 && (fit.helix.radius - wire.radius).abs() < 1e-14, "{fit:?} {wire:?}");
            assert!(fit.helix.pitch == wire.pitch || (fit.helix.pitch / wire.pitch - 1.0).abs() < 1e-10);
            assert_eq!(fit.helix.lay, wire.lay);
        }
        let found = layers(&fits, &[Some(0.39e-3); 19]);
        let told: Vec<_> = found.iter().map(|layer| (layer.name.as_str(), layer.wires.len(), layer.lay)).collect();
        assert_eq!(told, [("core", 1, 1.0), ("layer 1", 6, 1.0), ("layer 2", 12, -1.0)]);
        assert_eq!(layers(&fits, &[None; 19]).len(), 3, "without diameters too");
    }
}
