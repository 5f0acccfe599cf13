//! Curves through points: A exp(B x) + C by Levenberg–Marquardt, and beside it a constant, a line and a parabola under the
//! same leave-one-out cross-validation, so that a curve with too many parameters shows.

mod comparison;
mod curve;
mod exponential;
mod model;
mod polynomial;
mod scaled;

pub use comparison::{Compared, CrossValidation, ModelComparison, compare};
pub use curve::{Fit, fit};
pub use model::{FitError, Model};

#[cfg(test)]
mod tests;
