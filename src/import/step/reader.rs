//! What geometry is read with, and what it is read as.

use super::model::{Model, Read};
use crate::import::fault::Why;
use crate::import::shape::Shape;
use std::sync::Arc;

/// Deepest nesting of references: they may make circles.
const DEEPEST: usize = 40;

/// Reads geometry in the unit of its representation.
pub struct Reader<'a> {
    /// The instances.
    pub model: &'a Model<'a>,
    /// The unit of angles (rad).
    pub angle: f64,
}

/// A part of a shape, in the unit of its representation.
#[derive(Debug, Clone)]
pub struct Segment {
    /// The shape.
    pub shape: Arc<Shape>,
    /// Its parameter at the start.
    pub from: f64,
    /// Its parameter at the end.
    pub to: f64,
    /// Diameter of a tube around it, in the same unit.
    pub diameter: Option<f64>,
}

/// Refuses what is nested too deep.
pub fn within(depth: usize, model: &Model, number: u64) -> Read<()> {
    if depth > DEEPEST { Err(model.fault(number, Why::Circular)) } else { Ok(()) }
}
