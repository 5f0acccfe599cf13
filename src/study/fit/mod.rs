//! Curves through points: A exp(B x) + C by Levenberg–Marquardt, and beside it a constant, a line and a parabola under the
//! same leave-one-out cross-validation, so that a curve with too many parameters shows.

mod comparison;
mod exponential;
mod polynomial;

pub use comparison::{Compared, CrossValidation, ModelComparison, compare};

use crate::study::statistics::t_95;
use nalgebra::{DMatrix, DVector};
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

    /// Names of its parameters, in the order of [`Fit::parameters`].
    pub fn names(self) -> &'static [&'static str] {
        match self {
            Model::Constant => &["a"],
            Model::Line => &["a", "b"],
            Model::Parabola => &["a", "b", "c"],
            Model::Exponential => &["A", "B", "C"],
        }
    }

    /// The formula at `x`.
    fn value(self, parameters: &[f64], x: f64) -> f64 {
        match self {
            Model::Exponential => parameters[0] * (parameters[1] * x).exp() + parameters[2],
            _ => parameters.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient),
        }
    }

    /// Derivatives of the formula by its parameters at `x`.
    fn gradient(self, parameters: &[f64], x: f64) -> Vec<f64> {
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

/// A curve through points.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fit {
    /// The formula that was fitted.
    pub model: Model,
    /// Its parameters, in the units of y and of 1 over x.
    pub parameters: Vec<f64>,
    /// Standard errors of the parameters; `None` when there are no more points than parameters.
    pub errors: Option<Vec<f64>>,
    /// Half the widths of their 95 % intervals (Student's t).
    pub interval_95: Option<Vec<f64>>,
    /// y less the curve, point by point.
    pub residuals: Vec<f64>,
    /// Root of the mean square of the residuals.
    pub rms: f64,
}

impl Fit {
    /// The curve at `x`.
    pub fn value(&self, x: f64) -> f64 {
        self.model.value(&self.parameters, x)
    }

    /// From parameters: residuals, and errors from s² (JᵀJ)⁻¹ with s² = Σ r²/(n − p) (Draper & Smith, *Applied Regression
    /// Analysis*, 3rd ed. 1998, chapters 5 and 24).
    fn new(model: Model, parameters: Vec<f64>, points: &[[f64; 2]]) -> Self {
        let residuals: Vec<f64> = points.iter().map(|[x, y]| y - model.value(&parameters, *x)).collect();
        let squares: f64 = residuals.iter().map(|r| r * r).sum();
        let freedom = points.len().saturating_sub(parameters.len());
        let units = (freedom > 0).then(|| unit_errors(model, &parameters, points)).flatten();
        let s = (squares / freedom as f64).sqrt();
        let errors = units.map(|units| units.iter().map(|unit| unit * s).collect::<Vec<_>>());
        let interval_95 = errors.as_ref().map(|errors| errors.iter().map(|e| t_95(freedom) * e).collect());
        let rms = (squares / points.len() as f64).sqrt();
        Self { model, parameters, errors, interval_95, residuals, rms }
    }
}

/// Standard errors of the parameters for s = 1, the roots of the diagonal of (JᵀJ)⁻¹; `None` when J does not tell the
/// parameters apart, or when numbers do not hold them. Columns are scaled, so that powers and exponentials of x of very
/// different size do not spoil the inverse.
fn unit_errors(model: Model, parameters: &[f64], points: &[[f64; 2]]) -> Option<Vec<f64>> {
    let rows: Vec<f64> = points.iter().flat_map(|[x, _]| model.gradient(parameters, *x)).collect();
    let mut jacobian = DMatrix::from_row_slice(points.len(), parameters.len(), &rows);
    // By their greatest entry and not their norm, whose squares may vanish.
    let scales: Vec<f64> = jacobian.column_iter().map(|column| column.amax()).collect();
    if !scales.iter().all(|scale| *scale > 0.0 && scale.is_finite()) {
        return None;
    }
    for (mut column, scale) in jacobian.column_iter_mut().zip(&scales) {
        column /= *scale;
    }
    // Through R of J = Q R, whose condition is the root of that of JᵀJ.
    let inverse = jacobian.qr().r().try_inverse()?;
    let errors: Vec<f64> = scales.iter().enumerate().map(|(row, scale)| inverse.row(row).norm() / scale).collect();
    errors.iter().all(|error| error.is_finite()).then_some(errors)
}

/// The curve of a kind through points (x, y), by least squares.
///
/// # Errors
/// Points that do not settle the parameters: see [`FitError`].
pub fn fit(model: Model, points: &[[f64; 2]]) -> Result<Fit, FitError> {
    if let Some((k, [x, y])) = points.iter().enumerate().find(|(_, point)| !point.iter().all(|v| v.is_finite())) {
        return Err(FitError::NotFinite { number: k + 1, x: *x, y: *y });
    }
    let need = model.names().len();
    let have = different(points);
    if have < need {
        return Err(FitError::TooFew { have, need });
    }
    let scaled = Scaled::new(points);
    let parameters = match model {
        Model::Exponential => exponential::parameters(&scaled)?,
        _ => polynomial::parameters(&scaled, need),
    };
    let fit = Fit::new(model, parameters, points);
    // The formula itself, as people will use it, has to hold too: A exp(B x) may be ∞ × 0 far from zero.
    let holds = fit.parameters.iter().chain(&fit.residuals).chain([&fit.rms]).all(|value| value.is_finite());
    if holds { Ok(fit) } else { Err(FitError::Overflow) }
}

/// Number of different abscissae.
fn different(points: &[[f64; 2]]) -> usize {
    let mut xs: Vec<f64> = points.iter().map(|[x, _]| *x).collect();
    xs.sort_by(f64::total_cmp);
    xs.dedup();
    xs.len()
}

/// Points moved and scaled to u and v of −1 to 1, which keeps the search well-conditioned.
struct Scaled {
    /// Middle and half-width of x.
    x: [f64; 2],
    /// Middle and half-width of y; a half-width of 1 when all are equal.
    y: [f64; 2],
    /// u.
    u: Vec<f64>,
    /// v.
    v: Vec<f64>,
    /// Whether all y are equal.
    flat: bool,
}

impl Scaled {
    fn new(points: &[[f64; 2]]) -> Self {
        let span = |k: usize| {
            let ends = points
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| [low.min(point[k]), high.max(point[k])]);
            [0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0])]
        };
        let (x, y) = (span(0), span(1));
        let flat = y[1] <= f64::EPSILON * y[0].abs();
        let unit = |[middle, half]: [f64; 2]| [middle, if half > 0.0 { half } else { 1.0 }];
        let (x, y) = (unit(x), if flat { [y[0], 1.0] } else { y });
        let scale =
            |k: usize, [middle, half]: [f64; 2]| points.iter().map(|point| (point[k] - middle) / half).collect();
        Self { x, y, u: scale(0, x), v: scale(1, y), flat }
    }

    fn v(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.v)
    }
}

#[cfg(test)]
mod tests;
