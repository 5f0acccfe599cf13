//! Lines in space as formats give them, each with a parameter; and pieces of them, placed.

use super::circle;
use super::fault::{Place, Unread, Why};
use super::spline::{Spline, SplineSurface};
use super::surface::Surface;
use glam::{DAffine3, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

/// Points on a ring of a tube's surface through which its circle goes.
const ON_RING: usize = 12;
/// Farthest coordinate (m): a thousand kilometres. What lies beyond it is no wire, and its squares lose all digits.
const FARTHEST: f64 = 1e6;
/// Most turns of one helix.
const MOST_TURNS: f64 = 25_000.0;
/// Share by which half a step is longer than the step below which it is short enough to be taken for the curve (-).
const SHORT: f64 = 1e-7;
/// Most halvings of a step.
const MOST_HALVINGS: u32 = 9;

/// A line in space, in the unit of its file.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A straight line; its parameter counts lengths of `direction`.
    Line {
        /// Point at 0.
        origin: DVec3,
        /// From there to the point at 1.
        direction: DVec3,
    },
    /// A polygon; its parameter counts points, from 0.
    Points(Vec<DVec3>),
    /// An ellipse, a helix or, where the two radii are equal and nothing rises, a circle; its parameter is an angle (rad).
    Round {
        /// Centre at angle 0.
        centre: DVec3,
        /// From the centre to the point at angle 0.
        x: DVec3,
        /// From the centre to the point at a right angle, without what has risen.
        y: DVec3,
        /// Rise per angle (1/rad).
        rise: DVec3,
    },
    /// A B-spline.
    Spline(Spline),
    /// A line within a surface, whose parameters are its x and y.
    Within(Surface, Box<Shape>),
    /// The centres of a tube's circles, which run along `around` (0 u, 1 v).
    Centres {
        /// The tube.
        tube: SplineSurface,
        /// Direction of the circles.
        around: usize,
    },
}

impl Shape {
    /// Point at a parameter.
    pub fn point(&self, t: f64) -> DVec3 {
        match self {
            Self::Line { origin, direction } => *origin + *direction * t,
            Self::Points(points) => {
                let before = (t.floor().max(0.0) as usize).min(points.len() - 2);
                points[before].lerp(points[before + 1], t - before as f64)
            }
            Self::Round { centre, x, y, rise } => *centre + *x * t.cos() + *y * t.sin() + *rise * t,
            Self::Spline(spline) => spline.point(t),
            Self::Within(surface, line) => {
                let at = line.point(t);
                surface.point(at.x, at.y)
            }
            Self::Centres { tube, around } => {
                circle::ring(&ring(tube, *around, t)).map_or(DVec3::NAN, |ring| ring.centre)
            }
        }
    }

    /// The ends of its parameter; `None` where it has none.
    pub fn domain(&self) -> Option<[f64; 2]> {
        match self {
            Self::Line { .. } | Self::Round { .. } => None,
            Self::Points(points) => Some([0.0, (points.len() - 1) as f64]),
            Self::Spline(spline) => Some(spline.knots().domain()),
            Self::Within(_, line) => line.domain(),
            Self::Centres { tube, around } => Some(tube.knots(1 - around).domain()),
        }
    }

    /// Whether it is straight between its breaks.
    pub fn is_polygon(&self) -> bool {
        matches!(self, Self::Line { .. } | Self::Points(_))
    }

    /// Parameters from `from` to `to`, both included, between which it is smooth.
    pub fn breaks(&self, from: f64, to: f64) -> Vec<f64> {
        let (low, high) = (from.min(to), from.max(to));
        let all: Vec<f64> = match self {
            Self::Line { .. } => Vec::new(),
            Self::Points(points) => (0..points.len()).map(|i| i as f64).collect(),
            // Short enough that no step takes a turn for nothing; more turns than the bound are refused by [`Piece::marks`].
            Self::Round { .. } => {
                let quarters = ((high - low) / FRAC_PI_2).min(4.0 * MOST_TURNS) as usize;
                (1..=quarters).map(|i| low + i as f64 * FRAC_PI_2).collect()
            }
            Self::Spline(spline) => spline.knots().breaks(),
            Self::Within(_, line) => line.breaks(from, to),
            Self::Centres { tube, around } => tube.knots(1 - around).breaks(),
        };
        let mut breaks = vec![low];
        breaks.extend(all.into_iter().filter(|t| *t > low && *t < high));
        breaks.push(high);
        if from > to {
            breaks.reverse();
        }
        breaks
    }

    /// The parameter between `from` and `to` at which it comes nearest to `target`.
    pub fn nearest(&self, target: DVec3, from: f64, to: f64) -> f64 {
        const TRIED: usize = 16;
        let distance = |t: f64| self.point(t).distance(target);
        let breaks = self.breaks(from, to);
        let tried: Vec<f64> = breaks
            .windows(2)
            .flat_map(|span| (0..TRIED).map(|i| span[0] + (span[1] - span[0]) * i as f64 / TRIED as f64))
            .chain(breaks.last().copied())
            .collect();
        let best = (0..tried.len()).min_by(|a, b| distance(tried[*a]).total_cmp(&distance(tried[*b]))).unwrap_or(0);
        let (mut low, mut high) = (tried[best.saturating_sub(1)], tried[(best + 1).min(tried.len() - 1)]);
        // By thirds: the distance falls and rises again between neighbours of the nearest.
        for _ in 0..100 {
            let third = (high - low) / 3.0;
            if distance(low + third) < distance(high - third) { high -= third } else { low += third }
        }
        let found = 0.5 * (low + high);
        // The ends themselves, where they are meant: an end is only met to the digits of the file.
        [from, to].into_iter().find(|end| distance(*end) <= distance(found)).unwrap_or(found)
    }
}

/// Points on the circle of a tube at `t`, in their order.
pub fn ring(tube: &SplineSurface, around: usize, t: f64) -> Vec<DVec3> {
    let circle = tube.section(1 - around, t);
    let [from, to] = circle.knots().domain();
    (0..=ON_RING).map(|i| circle.point(from + (to - from) * i as f64 / ON_RING as f64)).collect()
}

/// A part of a shape, placed.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// The shape.
    pub shape: Arc<Shape>,
    /// Its parameter where the piece begins.
    pub from: f64,
    /// Its parameter where the piece ends.
    pub to: f64,
    /// From the unit of the file to metres, in place.
    pub place: DAffine3,
    /// Diameter of the wire around it (m), where the file gives one.
    pub diameter: Option<f64>,
    /// What it was read from.
    pub source: Place,
}

/// A point on a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// Parameter of the shape.
    pub t: f64,
    /// Length along the piece from its start (m).
    pub arc: f64,
    /// Where (m).
    pub point: DVec3,
    /// Whether it may turn there.
    pub is_break: bool,
}

impl Piece {
    /// Point at a parameter of its shape (m).
    pub fn point(&self, t: f64) -> DVec3 {
        self.place.transform_point3(self.shape.point(t))
    }

    /// Where it begins and ends (m).
    pub fn ends(&self) -> [DVec3; 2] {
        [self.point(self.from), self.point(self.to)]
    }

    /// The other way round.
    pub fn reversed(self) -> Self {
        Self { from: self.to, to: self.from, ..self }
    }

    /// Marks along it, so close that chords between them are the curve to seven digits.
    ///
    /// # Errors
    /// When it has no length, or a point of it is not finite or beyond all wires.
    pub fn marks(&self) -> Result<Vec<Mark>, Unread> {
        let refuse = |why| Unread { why, place: self.source.clone() };
        let turned = (self.to - self.from).abs();
        if matches!(*self.shape, Shape::Round { .. }) && (turned > MOST_TURNS * TAU || turned.is_nan()) {
            return Err(refuse(Why::Unusable("turns: at most 25000")));
        }
        let breaks = self.shape.breaks(self.from, self.to);
        let mark = |t: f64, is_break| Mark { t, arc: 0.0, point: self.point(t), is_break };
        let mut marks = vec![mark(breaks[0], true)];
        for span in breaks.windows(2) {
            let steps = if self.shape.is_polygon() { 1 } else { 8 };
            for i in 1..=steps {
                let t = span[0] + (span[1] - span[0]) * i as f64 / f64::from(steps);
                let end = mark(if i == steps { span[1] } else { t }, i == steps);
                if !end.point.is_finite() || end.point.abs().max_element() > FARTHEST {
                    return Err(refuse(Why::Unusable("coordinates: they are finite and within 1000 km")));
                }
                match self.shape.is_polygon() {
                    true => marks.push(end),
                    false => self.halve(&mut marks, end, 0),
                }
            }
        }
        let mut arc = 0.0;
        for i in 1..marks.len() {
            arc += marks[i].point.distance(marks[i - 1].point);
            marks[i].arc = arc;
        }
        match arc > 0.0 && marks.iter().all(|mark| mark.point.is_finite()) {
            true => Ok(marks),
            false => Err(refuse(Why::NoLength)),
        }
    }

    /// Adds marks from the last one to `end`.
    fn halve(&self, marks: &mut Vec<Mark>, end: Mark, depth: u32) {
        let start = marks[marks.len() - 1];
        let t = 0.5 * (start.t + end.t);
        let middle = Mark { t, arc: 0.0, point: self.point(t), is_break: false };
        let (whole, halves) =
            (start.point.distance(end.point), start.point.distance(middle.point) + middle.point.distance(end.point));
        if depth < MOST_HALVINGS && halves - whole > SHORT * halves {
            self.halve(marks, middle, depth + 1);
            self.halve(marks, end, depth + 1);
        } else {
            marks.push(end);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn piece(shape: Shape, from: f64, to: f64) -> Piece {
        let source = Place { entity: "CIRCLE".into(), number: None, line: 1 };
        Piece { shape: Arc::new(shape), from, to, place: DAffine3::IDENTITY, diameter: None, source }
    }

    fn helix(radius: f64, rise: f64) -> Shape {
        Shape::Round { centre: DVec3::ZERO, x: DVec3::X * radius, y: DVec3::Y * radius, rise: DVec3::Z * rise }
    }

    #[test]
    fn marks_measure_circles_and_helices() {
        for (rise, turns) in [(0.0, 0.5), (0.3, 7.0), (5.0, 1.3)] {
            let line = piece(helix(2.0, rise), 0.2, 0.2 + turns * TAU);
            let marks = line.marks().unwrap();
            let length = turns * TAU * 2.0_f64.hypot(rise);
            let measured = marks[marks.len() - 1].arc;
            assert!((measured / length - 1.0).abs() < 1e-7, "{rise}: {measured} {length}");
            assert_eq!(marks[0].point, line.ends()[0]);
            let back = line.clone().reversed();
            assert_eq!(back.ends(), [line.ends()[1], line.ends()[0]]);
        }
    }

    #[test]
    fn the_nearest_parameter_is_found() {
        let line = helix(1.0, 0.2);
        for t in [0.0, 0.4, 3.0, 9.9, 10.0] {
            let found = line.nearest(line.point(t), 0.0, 10.0);
            assert!((found - t).abs() < 1e-7, "{t} {found}");
        }
        assert_eq!(line.nearest(DVec3::ZERO - DVec3::Z, 0.0, 10.0), 0.0);
    }

    #[test]
    fn what_is_no_line_is_refused() {
        let why = |piece: Piece| piece.marks().unwrap_err().why;
        assert_eq!(why(piece(helix(1.0, 0.0), 1.0, 1.0)), Why::NoLength);
        assert!(matches!(why(piece(helix(1e9, 0.0), 0.0, PI)), Why::Unusable(_)));
        assert!(matches!(why(piece(helix(f64::NAN, 0.0), 0.0, PI)), Why::Unusable(_)));
        assert!(matches!(why(piece(helix(1.0, 1e-9), 0.0, 1e12)), Why::Unusable(_)), "a count from a file is bounded");
    }
}
