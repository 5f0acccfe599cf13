//! Shapes of curves, without their ends.

use super::model::{Attributes, Read};
use super::reader::{Reader, within};
use super::{placement, splines, surfaces};
use crate::import::fault::Why;
use crate::import::shape::Shape;
use glam::DVec3;

/// The shape of a curve without its ends.
pub fn shape(reader: &Reader, from: u64, number: u64, depth: usize) -> Read<Shape> {
    within(depth, reader.model, number)?;
    let model = reader.model;
    let instance = model.instance(from, number)?;
    let record = |name: &str| model.record(number, name);
    if let Some(line) = record("LINE") {
        let origin = model.point(number, line.reference(1, "point: an instance")?)?;
        let vector = line.reference(2, "vector: an instance")?;
        let attributes = model.expect(number, vector, "VECTOR", "a VECTOR")?;
        let direction = model.direction(vector, attributes.reference(1, "orientation: a direction")?)?;
        let magnitude = attributes.real(2, "magnitude: a number")?;
        let direction =
            direction.try_normalize().ok_or_else(|| attributes.unusable("orientation: a direction that is not 0"))?;
        return Ok(Shape::Line { origin, direction: direction * magnitude });
    }
    if let Some(circle) = record("CIRCLE") {
        let radius = circle.positive(2, "radius: a number greater than 0")?;
        return round(reader, circle, [radius; 2]);
    }
    if let Some(ellipse) = record("ELLIPSE") {
        let what = "semi-axes: numbers greater than 0";
        let axes = [ellipse.positive(2, what)?, ellipse.positive(3, what)?];
        return round(reader, ellipse, axes);
    }
    if let Some(polyline) = record("POLYLINE") {
        let points = polyline.references(1, "points: a list of instances")?;
        let points = points.into_iter().map(|point| model.point(number, point)).collect::<Read<Vec<DVec3>>>()?;
        return match points.len() {
            0 | 1 => Err(polyline.unusable("points: two at least")),
            _ => Ok(Shape::Points(points)),
        };
    }
    // Whoever refers to a trimmed curve as a basis or between vertices says anew where it ends.
    if let Some(curve) = record("TRIMMED_CURVE") {
        return self::shape(reader, number, curve.reference(1, "basis curve: an instance")?, depth + 1);
    }
    for name in ["SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE", "BOUNDED_SURFACE_CURVE"] {
        if let Some(curve) = record(name) {
            return self::shape(reader, number, curve.reference(1, "curve in space: an instance")?, depth + 1);
        }
    }
    if let Some(pcurve) = record("PCURVE") {
        let surface = surfaces::surface(reader, number, pcurve.reference(1, "surface: an instance")?)?;
        let plane = pcurve.reference(2, "curve: a representation")?;
        let items = model.expect(number, plane, "DEFINITIONAL_REPRESENTATION", "a DEFINITIONAL_REPRESENTATION")?;
        let items = items.references(1, "items: one curve")?;
        let [curve] = items[..] else { return Err(model.fault(plane, Why::Unusable("items: one curve"))) };
        return Ok(Shape::Within(surface, Box::new(self::shape(reader, plane, curve, depth + 1)?)));
    }
    if instance.records.iter().any(|record| splines::CURVES.contains(&record.name.as_str())) {
        return splines::curve(model, number).map(Shape::Spline);
    }
    Err(model.fault(number, Why::Kind))
}

fn round(reader: &Reader, attributes: Attributes, axes: [f64; 2]) -> Read<Shape> {
    let frame = placement::frame(reader.model, attributes.number(), attributes.reference(1, "position: a placement")?)?;
    Ok(Shape::Round { centre: frame.origin, x: frame.x * axes[0], y: frame.y * axes[1], rise: DVec3::ZERO })
}
