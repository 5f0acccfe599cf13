//! Parts of shapes.

use crate::import::shape::Shape;
use glam::DAffine3;

/// A shape from one parameter to another, placed in the drawing.
pub struct Part {
    /// The shape.
    pub shape: Shape,
    /// Its parameter at the start.
    pub from: f64,
    /// Its parameter at the end.
    pub to: f64,
    /// Where it lies in the drawing.
    pub place: DAffine3,
}
