//! Entities as shapes.

use super::blocks::plane;
use super::part::Part;
use super::polylines;
use super::tags::{Entity, File};
use crate::base::error::Result;
use crate::import::fault::Why;
use crate::import::shape::Shape;
use crate::import::spline::Spline;
use glam::{DAffine3, DVec3};
use std::f64::consts::TAU;

/// Shapes of an entity, or why it has none.
///
/// # Errors
/// A number that is none, with its line.
pub fn parts(file: &File, entity: &Entity) -> Result<Result<Vec<Part>, Why>> {
    let one = |shape, from, to, place| Ok(Ok(vec![Part { shape, from, to, place }]));
    match entity.kind {
        "LINE" => {
            let from = file.point_or(entity, 10, DVec3::ZERO)?;
            let direction = file.point_or(entity, 11, DVec3::ZERO)? - from;
            one(Shape::Line { origin: from, direction }, 0.0, 1.0, DAffine3::IDENTITY)
        }
        "LWPOLYLINE" => polylines::light(file, entity),
        "POLYLINE" => polylines::heavy(file, entity),
        "CIRCLE" => Ok(Err(Why::Closed)),
        "ARC" => {
            let radius = file.number_or(entity, 40, 0.0)?;
            if radius <= 0.0 {
                return Ok(Err(Why::Unusable("radius: a number greater than 0")));
            }
            let centre = file.point_or(entity, 10, DVec3::ZERO)?;
            let shape = Shape::Round { centre, x: DVec3::X * radius, y: DVec3::Y * radius, rise: DVec3::ZERO };
            let from = file.number_or(entity, 50, 0.0)?.to_radians();
            let to = file.number_or(entity, 51, 360.0)?.to_radians();
            one(shape, from, from + turn(to - from), plane(file, entity)?)
        }
        "ELLIPSE" => {
            let centre = file.point_or(entity, 10, DVec3::ZERO)?;
            let x = file.point_or(entity, 11, DVec3::X)?;
            let normal = file.point_or(entity, 210, DVec3::Z)?.try_normalize().unwrap_or(DVec3::Z);
            let y = normal.cross(x) * file.number_or(entity, 40, 1.0)?;
            let (from, to) = (file.number_or(entity, 41, 0.0)?, file.number_or(entity, 42, TAU)?);
            one(Shape::Round { centre, x, y, rise: DVec3::ZERO }, from, from + turn(to - from), DAffine3::IDENTITY)
        }
        "SPLINE" => spline(file, entity),
        "HELIX" => helix_or_spline(file, entity),
        _ => Ok(Err(Why::Kind)),
    }
}

/// An angle within a turn; none at all is the whole.
fn turn(angle: f64) -> f64 {
    let angle = angle.rem_euclid(TAU);
    if angle < 1e-9 { TAU } else { angle }
}

fn spline(file: &File, entity: &Entity) -> Result<Result<Vec<Part>, Why>> {
    let points = file.points(entity, 10)?;
    if points.is_empty() && entity.first(11).is_some() {
        return Ok(Err(Why::Unusable("control points: it has only points to go through, which leave its course open")));
    }
    let weights = file.numbers(entity, 41)?;
    let degree = file.number_or(entity, 71, 3.0)?;
    let degree = if (1.0..100.0).contains(&degree) { degree as usize } else { 0 };
    let spline = Spline::new(degree, file.numbers(entity, 40)?, &points, (!weights.is_empty()).then_some(&weights[..]));
    Ok(spline.map(|spline| {
        let [from, to] = spline.knots().domain();
        vec![Part { shape: Shape::Spline(spline), from, to, place: DAffine3::IDENTITY }]
    }))
}

/// A HELIX by its own numbers where they end where its spline does: that is an approximation. Else the spline, which programs
/// draw.
fn helix_or_spline(file: &File, entity: &Entity) -> Result<Result<Vec<Part>, Why>> {
    let own = helix(file, entity)?;
    let Some(curve) = entity.subclass("AcDbSpline").filter(|curve| curve.first(10).is_some()) else { return Ok(own) };
    let spline = spline(file, &curve)?;
    let agree = |own: &[Part], spline: &[Part]| {
        let ends = |part: &Part| [part.from, part.to].map(|t| part.shape.point(t));
        let ([a, b], [c, d]) = (ends(&own[0]), ends(&spline[0]));
        a.distance(c) + b.distance(d) <= 1e-3 * a.distance(b)
    };
    match (&own, &spline) {
        (Ok(helix), Ok(curve)) if agree(helix, curve) => Ok(own),
        _ => Ok(spline),
    }
}

/// A HELIX by its own numbers: base (10), start (11), axis (12), radius at its end (40), turns (41), height of a turn (42), sense
/// (290: 1 counter-clockwise).
fn helix(file: &File, entity: &Entity) -> Result<Result<Vec<Part>, Why>> {
    let own = entity.subclass("AcDbHelix").unwrap_or_else(|| entity.clone());
    let base = file.point_or(&own, 10, DVec3::ZERO)?;
    let start = file.point_or(&own, 11, DVec3::X)?;
    let Some(axis) = file.point_or(&own, 12, DVec3::Z)?.try_normalize() else {
        return Ok(Err(Why::Unusable("axis: a direction that is not 0")));
    };
    let x = (start - base).reject_from_normalized(axis);
    let radius = x.length();
    let top = file.number_or(&own, 40, radius)?;
    if radius == 0.0 || (top / radius - 1.0).abs() > 1e-6 {
        return Ok(Err(Why::Unusable("radii: one greater than 0 from end to end, where it carries no spline")));
    }
    let (turns, height) = (file.number_or(&own, 41, 0.0)?, file.number_or(&own, 42, 0.0)?);
    let sense = if file.number_or(&own, 290, 1.0)? == 0.0 { -1.0 } else { 1.0 };
    let centre = start - x;
    let shape = Shape::Round { centre, x, y: axis.cross(x) * sense, rise: axis * height / TAU };
    Ok(Ok(vec![Part { shape, from: 0.0, to: turns * TAU, place: DAffine3::IDENTITY }]))
}
