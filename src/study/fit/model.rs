//! The formulas that are fitted, and why points may have no curve.

use serde::{Serialize, Serializer};

/// A formula with parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    /// a.
    Constant,
    /// a + b x.
    Line,
    /// a + b x + c x².
    Parabola,
    /// A exp(B x) + C.
    Exponential,
}

impl Model {
    /// All of them, the simplest first.
    pub const ALL: [Model; 4] = [Model::Constant, Model::Line, Model::Parabola, Model::Exponential];

    /// Its formula.
    pub fn formula(self) -> &'static str {
        match self {
            Model::Constant => "a",
            Model::Line => "a + b x",
            Model::Parabola => "a + b x + c x²",
            Model::Exponential => "A exp(B x) + C",
        }
    }

    /// Names of its parameters, in the order of [`Fit::parameters`](super::Fit::parameters).
    pub fn names(self) -> &'static [&'static str] {
        match self {
            Model::Constant => &["a"],
            Model::Line => &["a", "b"],
            Model::Parabola => &["a", "b", "c"],
            Model::Exponential => &["A", "B", "C"],
        }
    }

    /// The formula at `x`.
    pub(super) fn value(self, parameters: &[f64], x: f64) -> f64 {
        match self {
            Model::Exponential => parameters[0] * (parameters[1] * x).exp() + parameters[2],
            _ => parameters.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient),
        }
    }

    /// Derivatives of the formula by its parameters at `x`.
    pub(super) fn gradient(self, parameters: &[f64], x: f64) -> Vec<f64> {
        match self {
            Model::Exponential => {
                let growth = (parameters[1] * x).exp();
                vec![growth, parameters[0] * x * growth, 1.0]
            }
            _ => (0..parameters.len()).map(|power| x.powi(power as i32)).collect(),
        }
    }
}

/// Why points have no curve of a kind.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitError {
    /// A value is NaN or infinite.
    #[error("point {number} is ({x}, {y}), which is not finite: leave it out or mend it")]
    NotFinite {
        /// Its number, from 1.
        number: usize,
        /// Its abscissa.
        x: f64,
        /// Its ordinate.
        y: f64,
    },
    /// Fewer places than parameters.
    #[error("{have} different x cannot settle {need} parameters: give at least {need}, and one more for their errors")]
    TooFew {
        /// Different abscissae.
        have: usize,
        /// Parameters.
        need: usize,
    },
    /// All ordinates are equal.
    #[error("all points have the same y = {0}: a constant says it all, and neither A nor B can be told")]
    Flat(f64),
    /// The best curve is a straight line.
    #[error(
        "the points have no bend that an exponential could follow: a line says the same, and A, B and C cannot be told apart"
    )]
    Straight,
    /// The best curve is flat but for one end.
    #[error("the bend is sharper than the points are apart: all but one lie on a constant, so B cannot be told")]
    Step,
    /// The curve needs numbers beyond those that there are.
    #[error(
        "A, or the curve itself, is beyond the range of numbers: count x from nearer to the points, or in a larger unit"
    )]
    Overflow,
    /// Levenberg–Marquardt gave up.
    #[error("Levenberg–Marquardt did not converge: {0}")]
    NotConverged(String),
}

impl Serialize for FitError {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
