//! B-spline curves and surfaces, rational or not, by de Boor's algorithm (de Boor, *A Practical Guide to Splines*, 1978).

use super::fault::Why;
use glam::{DVec3, DVec4};

/// Greatest degree: that of the programs which write them (25), and some room.
const GREATEST_DEGREE: usize = 40;

/// One direction of a spline.
#[derive(Debug, Clone, PartialEq)]
pub struct Knots {
    degree: usize,
    values: Vec<f64>,
}

impl Knots {
    /// Knots, each as often as it counts, for `points` control points.
    ///
    /// # Errors
    /// [`Why::Unusable`] when degree, knots and number of points do not belong together.
    pub fn new(degree: usize, values: Vec<f64>, points: usize) -> Result<Self, Why> {
        if degree == 0 || degree > GREATEST_DEGREE || points <= degree {
            return Err(Why::Unusable("degree: it is at least 1, at most 40 and less than the number of its points"));
        }
        if values.len() != points + degree + 1 {
            return Err(Why::Unusable("number of knots: they are as many as points and degree together, and one more"));
        }
        if !values.iter().all(|knot| knot.is_finite()) || values.windows(2).any(|two| two[0] > two[1]) {
            return Err(Why::Unusable("knots: they are finite and never fall"));
        }
        let knots = Self { degree, values };
        let [from, to] = knots.domain();
        match from < to {
            true => Ok(knots),
            false => Err(Why::Unusable("knots: all are the same")),
        }
    }

    /// Range of the parameter.
    pub fn domain(&self) -> [f64; 2] {
        [self.values[self.degree], self.values[self.values.len() - 1 - self.degree]]
    }

    /// Parameters from end to end between which the spline is smooth.
    pub fn breaks(&self) -> Vec<f64> {
        let [from, to] = self.domain();
        let mut breaks: Vec<f64> = self.values.iter().copied().filter(|knot| *knot >= from && *knot <= to).collect();
        breaks.dedup();
        breaks
    }

    /// Value at `t`, of control points by their numbers.
    fn value(&self, t: f64, point: impl Fn(usize) -> DVec4) -> DVec4 {
        let (p, knots) = (self.degree, &self.values);
        let [from, to] = self.domain();
        let t = t.clamp(from, to);
        let last = knots.len() - 2 - p;
        // The last span that is not empty where t is the end.
        let mut span = knots.partition_point(|knot| *knot <= t).saturating_sub(1).clamp(p, last);
        while span > p && knots[span] == knots[span + 1] {
            span -= 1;
        }
        let mut d: Vec<DVec4> = (0..=p).map(|j| point(j + span - p)).collect();
        for r in 1..=p {
            for j in (r..=p).rev() {
                let (low, high) = (knots[j + span - p], knots[j + 1 + span - r]);
                d[j] = d[j - 1].lerp(d[j], (t - low) / (high - low));
            }
        }
        d[p]
    }
}

fn projected(point: DVec4) -> DVec3 {
    point.truncate() / point.w
}

fn homogeneous(points: &[DVec3], weights: Option<&[f64]>) -> Result<Vec<DVec4>, Why> {
    if points.iter().any(|point| !point.is_finite()) {
        return Err(Why::Unusable("control points: a coordinate is not finite"));
    }
    let Some(weights) = weights else { return Ok(points.iter().map(|point| point.extend(1.0)).collect()) };
    if weights.len() != points.len() || weights.iter().any(|weight| !(*weight > 0.0 && weight.is_finite())) {
        return Err(Why::Unusable("weights: each control point has one, greater than 0"));
    }
    Ok(points.iter().zip(weights).map(|(point, weight)| (*point * *weight).extend(*weight)).collect())
}

/// A curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    knots: Knots,
    points: Vec<DVec4>,
}

impl Spline {
    /// A curve of its knots, each as often as it counts, control points and weights (all 1 where there are none).
    ///
    /// # Errors
    /// [`Why::Unusable`] when they do not belong together or are not finite.
    pub fn new(degree: usize, knots: Vec<f64>, points: &[DVec3], weights: Option<&[f64]>) -> Result<Self, Why> {
        Ok(Self { knots: Knots::new(degree, knots, points.len())?, points: homogeneous(points, weights)? })
    }

    /// Range of the parameter, and what lies between.
    pub fn knots(&self) -> &Knots {
        &self.knots
    }

    /// Point at a parameter.
    pub fn point(&self, t: f64) -> DVec3 {
        projected(self.knots.value(t, |i| self.points[i]))
    }
}

/// A surface.
#[derive(Debug, Clone, PartialEq)]
pub struct SplineSurface {
    knots: [Knots; 2],
    /// Control points, u after u, v within.
    net: Vec<Vec<DVec4>>,
}

impl SplineSurface {
    /// A surface of its knots along u and v and of its net, `net[i]` at the i-th u.
    ///
    /// # Errors
    /// [`Why::Unusable`] when they do not belong together or are not finite.
    pub fn new(
        degrees: [usize; 2],
        knots: [Vec<f64>; 2],
        net: &[Vec<DVec3>],
        weights: Option<&[Vec<f64>]>,
    ) -> Result<Self, Why> {
        let columns = net.first().map_or(0, Vec::len);
        if net.iter().any(|row| row.len() != columns) || weights.is_some_and(|weights| weights.len() != net.len()) {
            return Err(Why::Unusable("net: all rows of control points and weights are of one length"));
        }
        let [u, v] = knots;
        let knots = [Knots::new(degrees[0], u, net.len())?, Knots::new(degrees[1], v, columns)?];
        let row = |(i, row): (usize, &Vec<DVec3>)| homogeneous(row, weights.map(|weights| &weights[i][..]));
        Ok(Self { knots, net: net.iter().enumerate().map(row).collect::<Result<_, _>>()? })
    }

    /// Knots along u (0) or v (1).
    pub fn knots(&self, direction: usize) -> &Knots {
        &self.knots[direction]
    }

    /// The curve on it at parameter `t` of `direction`, along the other one.
    pub fn section(&self, direction: usize, t: f64) -> Spline {
        let points = match direction {
            0 => (0..self.net[0].len()).map(|j| self.knots[0].value(t, |i| self.net[i][j])).collect(),
            _ => self.net.iter().map(|row| self.knots[1].value(t, |j| row[j])).collect(),
        };
        Spline { knots: self.knots[1 - direction].clone(), points }
    }

    /// Point at u and v.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        projected(self.knots[0].value(u, |i| self.knots[1].value(v, |j| self.net[i][j])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_1_SQRT_2;

    /// The rational parabola through a quarter of a circle (Piegl and Tiller, *The NURBS Book*, 1997, section 7.3).
    fn quarter() -> ([DVec3; 3], [f64; 3]) {
        ([DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y], [1.0, FRAC_1_SQRT_2, 1.0])
    }

    #[test]
    fn a_rational_parabola_is_a_circle() {
        let (points, weights) = quarter();
        let arc = Spline::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], &points, Some(&weights)).unwrap();
        for i in 0..=10 {
            assert!((arc.point(0.1 * i as f64).length() - 1.0).abs() < 1e-14);
        }
        assert_eq!((arc.point(0.0), arc.point(1.0)), (DVec3::X, DVec3::Y));
        let plain = Spline::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], &points, None).unwrap();
        assert!((plain.point(0.5).length() - 1.0).abs() > 0.05, "weights count");
    }

    #[test]
    fn a_cubic_reproduces_a_polynomial() {
        // Control points of t³ over knots 0, 1, 2, 3 are products of three knots (blossoms).
        let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0];
        let points: Vec<DVec3> = (0..6).map(|i| DVec3::X * knots[i + 1] * knots[i + 2] * knots[i + 3]).collect();
        let cube = Spline::new(3, knots, &points, None).unwrap();
        for i in 0..=30 {
            let t = 0.1 * i as f64;
            assert!((cube.point(t).x - t.powi(3)).abs() < 1e-12, "{t}");
        }
        assert_eq!(cube.knots().breaks(), [0.0, 1.0, 2.0, 3.0]);
    }

    #[test]
    fn a_surface_has_its_sections() {
        let (points, weights) = quarter();
        let net: Vec<Vec<DVec3>> = points.iter().map(|p| vec![*p, *p + 2.0 * DVec3::Z]).collect();
        let weights: Vec<Vec<f64>> = weights.iter().map(|w| vec![*w; 2]).collect();
        let knots = [vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0]];
        let tube = SplineSurface::new([2, 1], knots, &net, Some(&weights)).unwrap();
        for (u, v) in [(0.0, 0.0), (0.3, 0.7), (1.0, 1.0)] {
            let point = tube.point(u, v);
            assert!((point.truncate().length() - 1.0).abs() < 1e-14 && (point.z - 2.0 * v).abs() < 1e-14);
            assert!(tube.section(1, v).point(u).distance(point) < 1e-14);
            assert!(tube.section(0, u).point(v).distance(point) < 1e-14);
        }
    }

    #[test]
    fn what_does_not_belong_together_is_refused() {
        let points = [DVec3::X, DVec3::Y, DVec3::Z];
        let clamped = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        assert!(Spline::new(2, clamped.clone(), &points, None).is_ok());
        for (degree, knots, weights) in [
            (0, vec![0.0; 4], None),
            (3, vec![0.0; 7], None),
            (2, vec![0.0; 6], None),
            (2, clamped[..5].to_vec(), None),
            (2, vec![0.0, 0.0, 1.0, 0.5, 1.0, 1.0], None),
            (2, vec![0.0, 0.0, 0.0, f64::NAN, 1.0, 1.0], None),
            (2, clamped.clone(), Some(&[1.0, 0.0, 1.0][..])),
            (2, clamped.clone(), Some(&[1.0][..])),
        ] {
            assert!(Spline::new(degree, knots, &points, weights).is_err());
        }
        assert!(Spline::new(2, clamped, &[DVec3::NAN; 3], None).is_err());
    }
}
