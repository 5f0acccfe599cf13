//! Curves with their ends, and what holds them.

use super::model::{Attributes, Read};
use super::reader::{Reader, Segment, within};
use super::trims::{self, Trim};
use super::{edges, shapes};
use crate::import::fault::Why;
use crate::import::part21::Value;
use crate::import::shape::Shape;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A curve that `from` refers to, in one segment or several.
pub fn curve(reader: &Reader, from: u64, number: u64, depth: usize) -> Read<Vec<Segment>> {
    within(depth, reader.model, number)?;
    let model = reader.model;
    model.instance(from, number)?;
    let record = |name: &str| model.record(number, name);
    if let Some(curve) = record("TRIMMED_CURVE") {
        return Ok(vec![trimmed(reader, curve, depth)?]);
    }
    if let Some(curve) = record("COMPOSITE_CURVE").or_else(|| record("COMPOSITE_CURVE_ON_SURFACE")) {
        let mut all = Vec::new();
        for part in curve.references(1, "segments: a list of instances")? {
            let segment = model.expect(number, part, "COMPOSITE_CURVE_SEGMENT", "a COMPOSITE_CURVE_SEGMENT")?;
            all.extend(self::curve(reader, part, segment.reference(2, "parent curve: an instance")?, depth + 1)?);
        }
        return Ok(all);
    }
    for name in ["EDGE_LOOP", "PATH", "OPEN_PATH"] {
        if let Some(path) = record(name) {
            let mut all = Vec::new();
            for edge in path.references(1, "edges: a list of instances")? {
                all.push(edges::edge(reader, number, edge)?);
            }
            return Ok(all);
        }
    }
    if record("EDGE_CURVE").is_some() || record("ORIENTED_EDGE").is_some() {
        return Ok(vec![edges::edge(reader, from, number)?]);
    }
    let shape = shapes::shape(reader, from, number, depth)?;
    let [begin, end] = match (&shape, shape.domain()) {
        (_, Some(domain)) => domain,
        // A whole circle: it closes, which is told where wires are made.
        (Shape::Round { .. }, None) => [0.0, TAU],
        (_, None) => return Err(model.fault(number, Why::Unusable("ends: a line without them is no wire"))),
    };
    Ok(vec![Segment { shape: Arc::new(shape), from: begin, to: end, diameter: None }])
}

fn trimmed(reader: &Reader, curve: Attributes, depth: usize) -> Read<Segment> {
    let number = curve.number();
    let shape = shapes::shape(reader, number, curve.reference(1, "basis curve: an instance")?, depth + 1)?;
    let by_points = curve.value(5) == Some(&Value::Word("CARTESIAN".into()));
    let agrees = curve.truth(4).ok_or_else(|| curve.unusable("sense: .T. or .F."))?;
    let trim = |index: usize| -> Read<Trim> {
        let what = "trims: parameters or points";
        let (mut parameter, mut point) = (None, None);
        for value in curve.list(index, what)? {
            match value {
                Value::Reference(at) => point = Some(reader.model.point(number, *at)?),
                Value::Typed(_, _) | Value::Number(_) => parameter = super::model::number(value),
                _ => return Err(curve.unusable(what)),
            }
        }
        match (parameter, point) {
            (_, Some(point)) if by_points => Ok(Trim::Point(point)),
            (Some(parameter), _) => Ok(Trim::Parameter(parameter)),
            (None, Some(point)) => Ok(Trim::Point(point)),
            (None, None) => Err(curve.unusable(what)),
        }
    };
    let [from, to] = trims::between(reader, number, &shape, [trim(2)?, trim(3)?], agrees)?;
    Ok(Segment { shape: Arc::new(shape), from, to, diameter: None })
}
