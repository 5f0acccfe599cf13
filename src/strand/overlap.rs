//! Bodies that overlap before the first step: wires as swept segments between their particles, spheres as points.

use glam::DVec3;
use std::collections::HashMap;

/// A body for the search.
#[derive(Debug, Clone, Copy)]
pub struct Body<'a> {
    /// Particle centres along the body (m); a single one for a sphere.
    pub points: &'a [DVec3],
    /// Radius (m).
    pub radius: f64,
}

/// The deepest overlap of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// The two bodies; the same one twice when a wire runs into itself.
    pub bodies: [usize; 2],
    /// Overlap over the smaller of the two diameters (-).
    pub share: f64,
    /// Overlap (m).
    pub depth: f64,
    /// Place between the two centre lines (m).
    pub place: DVec3,
}

/// The segment between two neighbouring particles.
struct Segment {
    body: usize,
    index: usize,
    ends: [DVec3; 2],
    radius: f64,
}

/// The deepest overlap of more than `limit` of a diameter (-), if there is one.
///
/// Parts of one wire closer along it than two diameters are neighbours, not overlaps: a wire bent to its own radius is
/// back within 0.909 d of itself there.
pub fn deepest(bodies: &[Body], limit: f64) -> Option<Overlap> {
    let segments = segments(bodies);
    let cell = segments.iter().map(|s| s.ends[0].distance(s.ends[1]) + 2.0 * s.radius).fold(0.0, f64::max);
    let mut grid: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for (i, segment) in segments.iter().enumerate() {
        grid.entry(cell_of(segment, cell)).or_default().push(i);
    }
    let mut worst: Option<Overlap> = None;
    for (i, segment) in segments.iter().enumerate() {
        for neighbour in around(cell_of(segment, cell)) {
            for &j in grid.get(&neighbour).into_iter().flatten() {
                if j <= i || are_neighbours(segment, &segments[j]) {
                    continue;
                }
                let found = overlap(segment, &segments[j]);
                if found.share > worst.map_or(limit, |w| w.share) {
                    worst = Some(found);
                }
            }
        }
    }
    worst
}

fn segments(bodies: &[Body]) -> Vec<Segment> {
    let mut all = Vec::new();
    for (body, b) in bodies.iter().enumerate() {
        let segment = |index, ends| Segment { body, index, ends, radius: b.radius };
        match b.points {
            [] => {}
            [centre] => all.push(segment(0, [*centre; 2])),
            points => all.extend(points.windows(2).enumerate().map(|(i, pair)| segment(i, [pair[0], pair[1]]))),
        }
    }
    all
}

fn cell_of(segment: &Segment, size: f64) -> [i64; 3] {
    let middle = 0.5 * (segment.ends[0] + segment.ends[1]) / size;
    [middle.x, middle.y, middle.z].map(|x| x.floor() as i64)
}

fn around(cell: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    (0..27).map(move |k| {
        let step = [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1];
        std::array::from_fn(|axis| cell[axis].saturating_add(step[axis]))
    })
}

fn are_neighbours(a: &Segment, b: &Segment) -> bool {
    if a.body != b.body {
        return false;
    }
    let between = (a.index.abs_diff(b.index) as f64 - 1.0) * a.ends[0].distance(a.ends[1]);
    between < 4.0 * a.radius
}

fn overlap(a: &Segment, b: &Segment) -> Overlap {
    let [p, q] = closest_points(a.ends, b.ends);
    let depth = a.radius + b.radius - p.distance(q);
    Overlap { bodies: [a.body, b.body], share: depth / (2.0 * a.radius.min(b.radius)), depth, place: 0.5 * (p + q) }
}

/// The closest points of two segments (Ericson, *Real-Time Collision Detection*, 2005, section 5.1.9); a segment may be
/// a point.
fn closest_points(a: [DVec3; 2], b: [DVec3; 2]) -> [DVec3; 2] {
    let (d1, d2, r) = (a[1] - a[0], b[1] - b[0], a[0] - b[0]);
    let (len1, len2) = (d1.length_squared(), d2.length_squared());
    let (c, f, mixed) = (d1.dot(r), d2.dot(r), d1.dot(d2));
    let on_first = |t: f64| {
        if len1 > 0.0 { ((mixed * t - c) / len1).clamp(0.0, 1.0) } else { 0.0 }
    };
    if len2 == 0.0 {
        return [a[0] + d1 * on_first(0.0), b[0]];
    }
    let area = len1 * len2 - mixed * mixed;
    // Parallel segments (area 0) may start anywhere; the clamps below bring both points to where the two face.
    let s = if area > 0.0 { ((mixed * f - c * len2) / area).clamp(0.0, 1.0) } else { 0.0 };
    let t = (mixed * s + f) / len2;
    let (s, t) = if t < 0.0 {
        (on_first(0.0), 0.0)
    } else if t > 1.0 {
        (on_first(1.0), 1.0)
    } else {
        (s, t)
    };
    [a[0] + d1 * s, b[0] + d2 * t]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn line(x: f64, n: usize) -> Vec<DVec3> {
        (0..=n).map(|i| DVec3::new(x, 0.0, i as f64)).collect()
    }

    #[test]
    fn the_deepest_pair_is_named() {
        let lines = [line(0.0, 20), line(0.95, 20), line(1.75, 20), line(3.0, 20)];
        let bodies: Vec<_> = lines.iter().map(|points| Body { points, radius: 0.5 }).collect();
        let worst = deepest(&bodies, 0.1).unwrap();
        assert_eq!(worst.bodies, [1, 2]);
        assert!((worst.share - 0.2).abs() < 1e-12 && (worst.depth - 0.2).abs() < 1e-12);
        assert!((worst.place.x - 1.35).abs() < 1e-12);
        assert_eq!(deepest(&bodies, 0.21), None);
    }

    #[test]
    fn crossing_wires_are_found_between_their_particles() {
        let along = line(0.0, 10);
        let across: Vec<DVec3> = (0..=10).map(|i| DVec3::new(i as f64 - 4.5, 0.3, 4.5)).collect();
        let body = |points| Body { points, radius: 0.25 };
        let worst = deepest(&[body(&along), body(&across)], 0.1).unwrap();
        assert!((worst.depth - 0.2).abs() < 1e-12);
    }

    #[test]
    fn a_sphere_is_compared_with_the_smaller_diameter() {
        let wire = line(0.0, 10);
        let centre = [DVec3::new(1.9, 0.0, 5.2)];
        let bodies = [Body { points: &wire, radius: 0.5 }, Body { points: &centre, radius: 1.5 }];
        let worst = deepest(&bodies, 0.05).unwrap();
        assert!((worst.share - 0.1).abs() < 1e-12);
    }

    /// A straight or gently bent wire is no overlap with itself; one that returns through itself is.
    #[test]
    fn a_wire_may_run_into_itself() {
        let ring = |radius: f64, n: usize| -> Vec<DVec3> {
            (0..n)
                .map(|i| {
                    let (s, c) = (i as f64 / radius).sin_cos();
                    DVec3::new(radius * c, radius * s, 0.0)
                })
                .collect()
        };
        let worst_of = |points: &[DVec3]| deepest(&[Body { points, radius: 0.5 }], 0.1);
        assert_eq!(worst_of(&line(0.0, 30)), None);
        assert_eq!(worst_of(&ring(3.0, 17)), None);
        let worst = worst_of(&ring(3.0, 22)).unwrap();
        assert_eq!(worst.bodies, [0, 0]);
    }

    proptest! {
        /// No pair of points, one on each segment, is closer than the pair found.
        #[test]
        fn closest_points_are_closest(v in prop::array::uniform12(-1.0..1.0_f64)) {
            let p = |i: usize| DVec3::new(v[i], v[i + 1], v[i + 2]);
            let (a, b) = ([p(0), p(3)], [p(6), p(9)]);
            let [x, y] = closest_points(a, b);
            let least = x.distance(y);
            for i in 0..=20 {
                for j in 0..=20 {
                    let q = a[0].lerp(a[1], i as f64 / 20.0);
                    let r = b[0].lerp(b[1], j as f64 / 20.0);
                    prop_assert!(q.distance(r) >= least - 1e-12);
                }
            }
        }
    }

    #[test]
    fn closest_points_of_parallel_and_degenerate_segments() {
        let z = |z: f64| DVec3::new(0.0, 0.0, z);
        let x = DVec3::X;
        let [p, q] = closest_points([z(0.0), z(1.0)], [z(3.0) + x, z(2.0) + x]);
        assert_eq!((p, q), (z(1.0), z(2.0) + x));
        let [p, q] = closest_points([z(0.0), z(0.0)], [z(-1.0) + x, z(1.0) + x]);
        assert_eq!((p, q), (z(0.0), x));
        let [p, q] = closest_points([z(0.0), z(0.0)], [x, x]);
        assert_eq!((p, q), (z(0.0), x));
    }
}
