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
pub enum PathTrouble {
    /// Fewer than two points.
    TooFewPoints,
    /// Point `0` (from 0) equals the one before it.
    RepeatedPoint(usize),
    /// Point `0` (from 0) has a coordinate that is not finite.
    NotFinite(usize),
    /// The line is shorter than the spacing: its length [m].
    TooShort(f64),
}

/// A wire's particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    /// Centres [m].
    pub points: Vec<DVec3>,
    /// Arc length between neighbours [m]: one fewer than points.
    pub arcs: Vec<f64>,
}

/// Unevenness over the mean spacing up to which points count as equally spaced [-]. Text files of CAD models carry few
/// digits.
const EVEN: f64 = 1e-3;

/// Number of equal pieces for a wire of arc length `arc` [m] at about `spacing` [m]: the nearest that covers it exactly;
/// `None` when the wire is shorter than one spacing.
pub fn pieces(arc: f64, spacing: f64) -> Option<usize> {
    // A wire of one spacing has one piece, whatever the last bits of its length.
    (arc >= spacing * (1.0 - 1e-9)).then(|| (arc / spacing).round() as usize)
}

/// Particles of a straight wire.
///
/// # Errors
/// When it is shorter than the spacing or not finite.
pub fn straight(from: DVec3, to: DVec3, spacing: f64) -> Result<Chain, PathTrouble> {
    let not_finite = [from, to].iter().position(|p| !p.is_finite());
    if let Some(i) = not_finite {
        return Err(PathTrouble::NotFinite(i));
    }
    let length = from.distance(to);
    let n = pieces(length, spacing).ok_or(PathTrouble::TooShort(length))?;
    Ok(Chain {
        points: (0..=n).map(|i| from.lerp(to, i as f64 / n as f64)).collect(),
        arcs: vec![length / n as f64; n],
    })
}

/// Particles along a line through `points` [m], at equal arc spacing nearest to `spacing` [m], ends included.
///
/// Points that already have that spacing are taken as they are, so that an exported wire comes back unchanged.
///
/// # Errors
/// See [`PathTrouble`].
pub fn resample(points: &[DVec3], spacing: f64) -> Result<Chain, PathTrouble> {
    check(points)?;
    let spline = Spline::through(points);
    let total: f64 = spline.arcs.iter().sum();
    let n = pieces(total, spacing).ok_or(PathTrouble::TooShort(total))?;
    if has_spacing(&spline.chords, spacing) {
        return Ok(Chain { points: points.to_vec(), arcs: spline.arcs });
    }
    let mut resampled = Vec::with_capacity(n + 1);
    resampled.push(points[0]);
    let (mut span, mut before) = (0, 0.0);
    for i in 1..n {
        let target = total * i as f64 / n as f64;
        while span + 1 < spline.arcs.len() && before + spline.arcs[span] < target {
            before += spline.arcs[span];
            span += 1;
        }
        resampled.push(spline.point_at_arc(span, target - before));
    }
    resampled.push(points[points.len() - 1]);
    Ok(Chain { points: resampled, arcs: vec![total / n as f64; n] })
}

fn check(points: &[DVec3]) -> Result<(), PathTrouble> {
    if let Some(i) = points.iter().position(|p| !p.is_finite()) {
        return Err(PathTrouble::NotFinite(i));
    }
    if points.len() < 2 {
        return Err(PathTrouble::TooFewPoints);
    }
    match points.windows(2).position(|pair| pair[0] == pair[1]) {
        Some(i) => Err(PathTrouble::RepeatedPoint(i + 1)),
        None => Ok(()),
    }
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
    /// Distance between neighbouring points: the parameter of each piece [m].
    chords: Vec<f64>,
    /// Derivative by the parameter at each point [-].
    tangents: Vec<DVec3>,
    /// Arc length of each piece [m].
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

    /// Length of the derivative by u [m].
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

    /// Arc length of a piece from its start to `u` [m], by Gauss–Legendre with five points.
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

    /// Point of a piece at `arc` [m] from its start.
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

    #[test]
    fn lines_that_are_none_are_refused() {
        let (a, b) = (DVec3::ZERO, DVec3::Z);
        assert_eq!(resample(&[a], 0.1), Err(PathTrouble::TooFewPoints));
        assert_eq!(resample(&[a, b, b], 0.1), Err(PathTrouble::RepeatedPoint(2)));
        assert_eq!(resample(&[a, b * f64::NAN], 0.1), Err(PathTrouble::NotFinite(1)));
        assert!(matches!(
            resample(&[a, b], 1.1),
            Err(PathTrouble::TooShort(length)) if (length - 1.0).abs() < 1e-12
        ));
        assert_eq!(straight(a, a, 0.1), Err(PathTrouble::TooShort(0.0)));
    }
}
