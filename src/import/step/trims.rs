//! Where curves begin and end.

use super::model::Read;
use super::reader::Reader;
use crate::import::fault::Why;
use crate::import::shape::Shape;
use crate::import::surface::Surface;
use glam::DVec3;
use std::f64::consts::TAU;

/// Where a curve begins or ends.
#[derive(Debug, Clone, Copy)]
pub enum Trim {
    /// Its own parameter, in the unit of the file.
    Parameter(f64),
    /// A point on it.
    Point(DVec3),
}

/// Parameters of a shape from the first trim to the second, forwards where the sense `agrees`.
pub fn between(reader: &Reader, number: u64, shape: &Shape, trims: [Trim; 2], agrees: bool) -> Read<[f64; 2]> {
    let [from, to] = trims.map(|trim| match (shape, trim) {
        (Shape::Round { .. }, Trim::Parameter(t)) => t * reader.angle,
        (_, Trim::Parameter(t)) => t,
        (Shape::Line { origin, direction }, Trim::Point(point)) => {
            (point - *origin).dot(*direction) / direction.length_squared()
        }
        (Shape::Round { centre, x, y, .. }, Trim::Point(point)) => {
            let from = point - *centre;
            (from.dot(*y) / y.length_squared()).atan2(from.dot(*x) / x.length_squared())
        }
        // A helix, drawn as a straight line on a cylinder or a cone.
        (Shape::Within(Surface::Cone { frame, .. }, line), Trim::Point(point)) if line.domain().is_none() => {
            match &**line {
                Shape::Line { origin, direction } => (frame.local(point).z - origin.y) / direction.y,
                _ => f64::NAN,
            }
        }
        (_, Trim::Point(point)) => match shape.domain() {
            Some([low, high]) => shape.nearest(point, low, high),
            None => f64::NAN,
        },
    });
    if !from.is_finite() || !to.is_finite() {
        return Err(reader.model.fault(number, Why::Unusable("trims: parameters or points of the curve")));
    }
    if let Shape::Round { .. } = shape {
        // Around in the sense given; the same end twice is the whole.
        let turn = |angle: f64| if angle.rem_euclid(TAU) < 1e-9 { TAU } else { angle.rem_euclid(TAU) };
        return Ok([from, if agrees { from + turn(to - from) } else { from - turn(from - to) }]);
    }
    let Some([low, high]) = shape.domain() else { return Ok([from, to]) };
    let (from, to) = (from.clamp(low, high), to.clamp(low, high));
    match (agrees, from < to) {
        (true, true) | (false, false) if from != to => Ok([from, to]),
        // A closed curve whose ends are one point.
        _ if from == to
            && shape.point(low).distance(shape.point(high))
                <= 1e-6 * shape.point(low).distance(shape.point(0.5 * (low + high))) =>
        {
            Ok(if agrees { [low, high] } else { [high, low] })
        }
        (true, false) if to == low => Ok([from, high]),
        (false, true) if from == low => Ok([high, to]),
        _ => Err(reader.model.fault(number, Why::Unusable("trims: ends in the order of the curve's sense"))),
    }
}
