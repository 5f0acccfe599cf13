//! One curve through points, with its errors.

use super::model::{FitError, Model};
use super::scaled::Scaled;
use super::{exponential, polynomial};
use crate::study::statistics::t_95;
use nalgebra::DMatrix;
use serde::Serialize;

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
