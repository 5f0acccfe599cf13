//! What a stage keeps in memory, and what it moves through it at every step.

use crate::base::vectors::Vectors;

/// Memory of one stage.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Bytes {
    /// Kept between steps (bytes).
    pub kept: usize,
    /// Read and written at each step (bytes): every array that the stage streams, once for each direction and pass.
    /// What it gathers here and there counts as if read once.
    pub moved: usize,
}

/// Memory behind a vector (bytes).
pub(super) fn behind<T>(v: &Vec<T>) -> usize {
    v.capacity() * size_of::<T>()
}

/// Memory behind three streams (bytes).
pub(super) fn behind_all(v: &Vectors) -> usize {
    behind(&v.x) + behind(&v.y) + behind(&v.z)
}

/// A vector, and a number, of a particle (bytes).
pub(super) const VECTOR: usize = 3 * size_of::<f64>();
pub(super) const NUMBER: usize = size_of::<f64>();
