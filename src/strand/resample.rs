//! A centre line given by points, resampled at equal arc spacing.
//!
//! Between the points runs a cubic spline of the Catmull–Rom kind (Overhauser 1968): at each point it has the tangent
//! of the parabola through that point and its two neighbours, over the accumulated chord length as parameter. Chosen
//! because it is local and passes through every point: a natural spline would spread the error of its straight ends
//! along the wire, and straight lines would put corners into a helix that bends the wire from the start. On a smooth
//! curve its error falls with the third power of the spacing of the points.

use glam::DVec3;

/// Why points do not make a centre line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PathError {
    /// Fewer than two points.
    TooFewPoints,
    /// Point `0` (from 0) has a coordinate that is not finite.
    NotFinite(usize),
    /// The line is shorter than the spacing: its length (m).
    TooShort(f64),
}

/// A wire's particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    /// Centres (m).
    pub points: Vec<DVec3>,
    /// Arc length between neighbours (m): one fewer than points.
    pub arcs: Vec<f64>,
    /// Greatest distance between the particles' polygon and the one through the points given (m): of a particle from the
    /// line between the two points that it lies between, or of a point from the line between two particles.
    pub deviation: f64,
    /// Number of given points that were left out because they lie upon the one before.
    pub merged: usize,
}

/// Distance over the spacing within which a point counts as a repetition of the one before it (-). Between points so close
/// the direction of a line is noise, and a curve that follows it bulges by a quarter of the distance to the next point.
const REPEATED: f64 = 0.01;

/// Unevenness over the mean spacing up to which points count as equally spaced (-). Text files of CAD models carry few
/// digits.
const EVEN: f64 = 1e-3;

/// Number of equal pieces for a wire of arc length `arc` (m) at about `spacing` (m): the nearest that covers it exactly;
/// `None` when the wire is shorter than one spacing.
pub fn pieces(arc: f64, spacing: f64) -> Option<usize> {
    // A wire of one spacing has one piece, whatever the last bits of its length.
    (arc >= spacing * (1.0 - 1e-9)).then(|| (arc / spacing).round() as usize)
}

/// Particles of a straight wire.
///
/// # Errors
/// When it is shorter than the spacing or not finite.
pub fn straight(from: DVec3, to: DVec3, spacing: f64) -> Result<Chain, PathError> {
    let not_finite = [from, to].iter().position(|p| !p.is_finite());
    if let Some(i) = not_finite {
        return Err(PathError::NotFinite(i));
    }
    let length = from.distance(to);
    let n = pieces(length, spacing).ok_or(PathError::TooShort(length))?;
    Ok(Chain {
        points: (0..=n).map(|i| from.lerp(to, i as f64 / n as f64)).collect(),
        arcs: vec![length / n as f64; n],
        deviation: 0.0,
        merged: 0,
    })
}

/// Particles along a line through `points` (m), at equal arc spacing nearest to `spacing` (m), ends included.
///
/// Points that already have that spacing are taken as they are, so that an exported wire comes back unchanged. A point
/// nearer to the one before than a hundredth of the spacing repeats it and is left out.
///
/// # Errors
/// See [`PathError`].
pub fn resample(points: &[DVec3], spacing: f64) -> Result<Chain, PathError> {
    check(points)?;
    let given = points;
    let points = &without_repeated(given, REPEATED * spacing);
    if points.len() < 2 {
        return Err(PathError::TooShort(given[0].distance(given[given.len() - 1])));
    }
    let merged = given.len() - points.len();
    let spline = Spline::through(points);
    let total: f64 = spline.arcs.iter().sum();
    let n = pieces(total, spacing).ok_or(PathError::TooShort(total))?;
    if has_spacing(&spline.chords, spacing) {
        let deviation = farthest(given, points);
        return Ok(Chain { points: points.to_vec(), arcs: spline.arcs, deviation, merged });
    }
    let mut resampled = Vec::with_capacity(n + 1);
    resampled.push(points[0]);
    let (mut span, mut before) = (0, 0.0);
    let mut deviation = 0.0_f64;
    for i in 1..n {
        let target = total * i as f64 / n as f64;
        while span + 1 < spline.arcs.len() && before + spline.arcs[span] < target {
            before += spline.arcs[span];
            span += 1;
        }
        let particle = spline.point_at_arc(span, target - before);
        deviation = deviation.max(distance_to_segment(particle, points[span], points[span + 1]));
        resampled.push(particle);
    }
    resampled.push(points[points.len() - 1]);
    let deviation = deviation.max(farthest(given, &resampled));
    Ok(Chain { points: resampled, arcs: vec![total / n as f64; n], deviation, merged })
}

/// Points without those that are nearer than `least` (m) to the one kept before them; both ends stay.
fn without_repeated(points: &[DVec3], least: f64) -> Vec<DVec3> {
    let mut kept: Vec<DVec3> = Vec::with_capacity(points.len());
    for point in points {
        if kept.last().is_none_or(|last| last.distance(*point) > least) {
            kept.push(*point);
        }
    }
    // The wire ends where it was said to.
    let end = points[points.len() - 1];
    if kept.len() > 1 && kept.last() != Some(&end) {
        kept.pop();
        kept.push(end);
    }
    kept
}

/// Greatest distance of `points` from the polygon through `corners`, both in order along one line (m).
fn farthest(points: &[DVec3], corners: &[DVec3]) -> f64 {
    let mut at = 0;
    let mut greatest = 0.0_f64;
    for point in points {
        let distance = |k: usize| distance_to_segment(*point, corners[k], corners[k + 1]);
        // Both run along the same line, so that the nearest segment moves on with the points.
        while at + 2 < corners.len() && distance(at + 1) <= distance(at) {
            at += 1;
        }
        greatest = greatest.max(distance(at));
    }
    greatest
}

/// Distance of `p` from the segment from `a` to `b` (m).
fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let length_squared = along.length_squared();
    let t = if length_squared > 0.0 { ((p - a).dot(along) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a + along * t)
}

fn check(points: &[DVec3]) -> Result<(), PathError> {
    if let Some(i) = points.iter().position(|p| !p.is_finite()) {
        return Err(PathError::NotFinite(i));
    }
    if points.len() < 2 {
        return Err(PathError::TooFewPoints);
    }
    Ok(())
}

/// Whether points with these distances are spaced evenly and as a wire of this spacing would be.
fn has_spacing(chords: &[f64], spacing: f64) -> bool {
    let n = chords.len() as f64;
    let total: f64 = chords.iter().sum();
    let mean = total / n;
    let even = chords.iter().all(|c| (c - mean).abs() <= EVEN * mean);
    // The number of pieces was rounded from an arc length, which is a little more than the chords that are seen here.
    even && (n - total / spacing).abs() <= 0.5 + EVEN * n
}

/// Cubic pieces between points.
struct Spline<'a> {
    points: &'a [DVec3],
    /// Distance between neighbouring points: the parameter of each piece (m).
    chords: Vec<f64>,
    /// Derivative by the parameter at each point (-).
    tangents: Vec<DVec3>,
    /// Arc length of each piece (m).
    arcs: Vec<f64>,
}

impl<'a> Spline<'a> {
    fn through(points: &'a [DVec3]) -> Self {
        let chords: Vec<f64> = points.windows(2).map(|p| p[0].distance(p[1])).collect();
        let tangents = tangents(points, &chords);
        let mut spline = Self { points, chords, tangents, arcs: Vec::new() };
        spline.arcs = (0..spline.chords.len()).map(|span| spline.arc(span, 1.0)).collect();
        spline
    }

    /// Point of a piece at `u` in 0..=1 (cubic Hermite).
    fn point(&self, span: usize, u: f64) -> DVec3 {
        let (p, q, h) = self.piece(span);
        let (m, n) = (self.tangents[span] * h, self.tangents[span + 1] * h);
        let (u2, u3) = (u * u, u * u * u);
        p * (2.0 * u3 - 3.0 * u2 + 1.0) + m * (u3 - 2.0 * u2 + u) + q * (3.0 * u2 - 2.0 * u3) + n * (u3 - u2)
    }

    /// Length of the derivative by u (m).
    fn speed(&self, span: usize, u: f64) -> f64 {
        let (p, q, h) = self.piece(span);
        let (m, n) = (self.tangents[span] * h, self.tangents[span + 1] * h);
        let derivative =
            (q - p) * (6.0 * u * (1.0 - u)) + m * (3.0 * u * u - 4.0 * u + 1.0) + n * (3.0 * u * u - 2.0 * u);
        derivative.length()
    }

    fn piece(&self, span: usize) -> (DVec3, DVec3, f64) {
        (self.points[span], self.points[span + 1], self.chords[span])
    }

    /// Arc length of a piece from its start to `u` (m), by Gauss–Legendre with five points.
    fn arc(&self, span: usize, u: f64) -> f64 {
        const NODES: [(f64, f64); 5] = [
            (0.0, 0.568_888_888_888_888_9),
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
            (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
            (0.906_179_845_938_664, 0.236_926_885_056_189_1),
            (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
        ];
        let half = 0.5 * u;
        let sum: f64 = NODES.iter().map(|(x, w)| w * self.speed(span, half * (1.0 + x))).sum();
        half * sum
    }

    /// Point of a piece at `arc` (m) from its start.
    fn point_at_arc(&self, span: usize, arc: f64) -> DVec3 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.arc(span, middle) < arc {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.point(span, 0.5 * (low + high))
    }
}

/// Derivative at each point of the parabola through it and its neighbours; at the ends, of the end parabola.
fn tangents(points: &[DVec3], chords: &[f64]) -> Vec<DVec3> {
    let slope = |i: usize| (points[i + 1] - points[i]) / chords[i];
    let last = points.len() - 1;
    if last == 1 {
        return vec![slope(0); 2];
    }
    let inner = |i: usize| (slope(i - 1) * chords[i] + slope(i) * chords[i - 1]) / (chords[i - 1] + chords[i]);
    (0..=last)
        .map(|i| match i {
            0 => slope(0) * 2.0 - inner(1),
            i if i == last => slope(last - 1) * 2.0 - inner(last - 1),
            i => inner(i),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strand::helix::Helix;
    use glam::DVec2;

    fn helix() -> Helix {
        Helix { radius: 1.165e-3, pitch: 39e-3, lay: 1.0, phase: 0.2 }
    }

    fn helix_points(n: usize) -> Vec<DVec3> {
        (0..=n).map(|i| helix().point(0.12 * i as f64 / n as f64)).collect()
    }

    /// Greatest distance of resampled points from the helix.
    fn error_of(points_given: usize) -> f64 {
        let chain = resample(&helix_points(points_given), 0.39e-3).unwrap();
        chain.points.iter().map(|p| p.distance(helix().point(p.z))).fold(0.0, f64::max)
    }

    #[test]
    fn even_points_come_back_unchanged() {
        let arc = helix().arc_length(0.12);
        let n = pieces(arc, 0.39e-3).unwrap();
        let points = helix_points(n);
        let chain = resample(&points, 0.39e-3).unwrap();
        assert_eq!(chain.points, points);
        assert!((chain.arcs.iter().sum::<f64>() / arc - 1.0).abs() < 1e-8);
    }

    /// A wire whose arc length is rounded up by next to nothing still counts as having the spacing.
    #[test]
    fn even_points_at_the_edge_of_rounding_come_back_unchanged() {
        let arc = helix().arc_length(0.12);
        let spacing = arc / 307.500_001;
        let points = helix_points(pieces(arc, spacing).unwrap());
        assert_eq!(points.len(), 309);
        assert_eq!(resample(&points, spacing).unwrap().points, points);
    }

    #[test]
    fn spline_follows_a_helix_and_converges_with_third_order() {
        let (coarse, fine) = (error_of(60), error_of(120));
        assert!(coarse < 3e-6, "{coarse}");
        assert!(coarse / fine > 6.0, "{coarse} {fine}");
    }

    #[test]
    fn spacing_is_even_and_covers_the_wire() {
        let points: Vec<DVec3> = (0..=40).map(|i| helix().point(0.12 * (i as f64 / 40.0).powi(2))).collect();
        let chain = resample(&points, 0.39e-3).unwrap();
        assert_eq!(chain.points[0], points[0]);
        assert_eq!(chain.points.last(), points.last());
        let chords: Vec<f64> = chain.points.windows(2).map(|p| p[0].distance(p[1])).collect();
        let arc = chain.arcs[0];
        assert!(chords.iter().all(|c| (c / arc - 1.0).abs() < 1e-4));
        assert!((arc / 0.39e-3 - 1.0).abs() < 0.5 / chords.len() as f64);
    }

    #[test]
    fn two_points_make_a_straight_wire() {
        let (from, to) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, 2.0, 4.0));
        let by_points = resample(&[from, to], 0.11).unwrap();
        let by_ends = straight(from, to, 0.11).unwrap();
        assert_eq!(by_points.points.len(), 10);
        for (a, b) in by_points.points.iter().zip(&by_ends.points) {
            assert!(a.distance(*b) < 1e-12);
        }
    }

    /// A point that repeats another but for 1 nm does not tell where the wire goes: it stays as straight as it was.
    #[test]
    fn a_point_that_is_nearly_repeated_does_not_bend_the_wire() {
        let at = |x: f64, z: f64| DVec3::new(x, 0.0, z);
        let nearly = [at(0.0, 0.0), at(0.0, 5e-3), at(1e-9, 5e-3), at(0.0, 10e-3)];
        let chain = resample(&nearly, 0.4e-3).unwrap();
        assert_eq!((chain.points.len(), chain.merged), (26, 1));
        let off = chain.points.iter().map(|p| p.truncate().length()).fold(0.0, f64::max);
        assert!(off < 1.1e-9, "{off}");
        assert!((chain.deviation - 1e-9).abs() < 1e-12, "{}", chain.deviation);
        // At an end too, where the end itself stays; and repeated exactly.
        let at_end = [at(0.0, 0.0), at(0.0, 10e-3), at(1e-9, 10e-3)];
        let chain = resample(&at_end, 0.4e-3).unwrap();
        assert_eq!((chain.points[25], chain.merged), (at_end[2], 1));
        let twice = [at(0.0, 0.0), at(0.0, 5e-3), at(0.0, 5e-3), at(0.0, 10e-3)];
        assert_eq!(
            resample(&twice, 0.4e-3).unwrap(),
            Chain { merged: 1, ..resample(&[twice[0], twice[1], twice[3]], 0.4e-3).unwrap() }
        );
    }

    /// The deviation is what a circle has from its chords, r − √(r² − c²/4), seen from both sides: points far apart let the
    /// curve bulge from the lines between them, and points close together stick out of the particles' polygon.
    #[test]
    fn the_deviation_is_that_of_a_circle_from_its_chords() {
        let arc = |n: usize| -> Vec<DVec3> {
            (0..=n).map(|i| DVec3::from((DVec2::from_angle(i as f64 / n as f64) * 10e-3, 0.0))).collect()
        };
        let sagitta = |angle: f64| 10e-3 * (1.0 - (0.5 * angle).cos());
        let sparse = resample(&arc(5), 0.05e-3).unwrap().deviation;
        assert!((sparse / sagitta(0.2) - 1.0).abs() < 0.02, "{sparse} {}", sagitta(0.2));
        let dense = resample(&arc(1000), 2e-3).unwrap().deviation;
        assert!((dense / sagitta(0.2) - 1.0).abs() < 0.02, "{dense} {}", sagitta(0.2));
    }

    #[test]
    fn lines_that_are_none_are_refused() {
        let (a, b) = (DVec3::ZERO, DVec3::Z);
        assert_eq!(resample(&[a], 0.1), Err(PathError::TooFewPoints));
        assert_eq!(resample(&[a, a], 0.1), Err(PathError::TooShort(0.0)));
        assert_eq!(resample(&[a, b * f64::NAN], 0.1), Err(PathError::NotFinite(1)));
        assert!(matches!(
            resample(&[a, b], 1.1),
            Err(PathError::TooShort(length)) if (length - 1.0).abs() < 1e-12
        ));
        assert_eq!(straight(a, a, 0.1), Err(PathError::TooShort(0.0)));
    }
}
