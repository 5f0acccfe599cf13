//! Edges: curves between two vertices.

use super::model::Read;
use super::reader::{Reader, Segment};
use super::shapes;
use super::trims::{self, Trim};
use crate::import::fault::Why;
use std::sync::Arc;

/// An EDGE_CURVE or ORIENTED_EDGE that `from` refers to.
pub fn edge(reader: &Reader, from: u64, number: u64) -> Read<Segment> {
    let model = reader.model;
    model.instance(from, number)?;
    if let Some(oriented) = model.record(number, "ORIENTED_EDGE") {
        let inner = oriented.reference(3, "edge: an instance")?;
        let forward = oriented.truth(4).ok_or_else(|| oriented.unusable("orientation: .T. or .F."))?;
        // An oriented edge of an oriented edge is allowed nowhere, so this goes one step down.
        model.expect(number, inner, "EDGE_CURVE", "an EDGE_CURVE")?;
        let segment = edge(reader, number, inner)?;
        return Ok(if forward { segment } else { Segment { from: segment.to, to: segment.from, ..segment } });
    }
    let Some(edge) = model.record(number, "EDGE_CURVE") else {
        return Err(model.fault(from, Why::Unexpected { number, wanted: "an EDGE_CURVE" }));
    };
    let what = "vertices: two instances";
    let (start, end) = (edge.reference(1, what)?, edge.reference(2, what)?);
    let agrees = edge.truth(4).ok_or_else(|| edge.unusable("sense: .T. or .F."))?;
    let shape = shapes::shape(reader, number, edge.reference(3, "curve: an instance")?, 0)?;
    let trims = [model.point(number, start)?, model.point(number, end)?].map(Trim::Point);
    let [from, to] = trims::between(reader, number, &shape, trims, agrees)?;
    Ok(Segment { shape: Arc::new(shape), from, to, diameter: None })
}
