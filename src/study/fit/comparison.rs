//! All models through the same points, and what each says of points that it was not shown.

use super::curve::{Fit, fit};
use super::model::{FitError, Model};
use serde::Serialize;

/// Leave-one-out cross-validation (Stone 1974): each point is foretold by the curve through the others.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CrossValidation {
    /// Squared error at each point, in the unit of y squared.
    pub folds: Vec<f64>,
    /// Their mean, MSE.
    pub mean: f64,
}

/// A model through the points.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Compared {
    /// The formula that was fitted.
    pub model: Model,
    /// Its curve, or why there is none.
    pub fit: Result<Fit, FitError>,
    /// What it says of points that it was not shown, or why a curve without one of them cannot be had.
    pub cross_validation: Result<CrossValidation, FitError>,
}

/// All models.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelComparison {
    /// The points (x, y).
    pub points: Vec<[f64; 2]>,
    /// Each model, the simplest first.
    pub models: Vec<Compared>,
    /// The one that foretells best; `None` when none can be cross-validated.
    pub best: Option<Model>,
}

impl ModelComparison {
    /// A model of it.
    pub fn model(&self, model: Model) -> &Compared {
        self.models.iter().find(|compared| compared.model == model).expect("all models are compared")
    }
}

/// Fits all models to points (x, y) and cross-validates them.
pub fn compare(points: &[[f64; 2]]) -> ModelComparison {
    let one = |model| Compared { model, fit: fit(model, points), cross_validation: cross_validate(model, points) };
    let models: Vec<Compared> = Model::ALL.into_iter().map(one).collect();
    let best = best(models.iter().filter_map(|one| Some((one.model, one.cross_validation.as_ref().ok()?.mean))));
    ModelComparison { points: points.to_vec(), best, models }
}

/// The model of least mean squared error, the first one of equals; one whose error is no number is not in the running.
fn best(known: impl Iterator<Item = (Model, f64)>) -> Option<Model> {
    let finite = known.filter(|(_, mean)| mean.is_finite());
    finite.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(model, _)| model)
}

fn cross_validate(model: Model, points: &[[f64; 2]]) -> Result<CrossValidation, FitError> {
    if points.is_empty() {
        return Err(FitError::TooFew { have: 0, need: model.names().len() });
    }
    let fold = |k: usize| {
        let others: Vec<[f64; 2]> =
            points.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, point)| *point).collect();
        let [x, y] = points[k];
        let squared = (y - fit(model, &others)?.value(x)).powi(2);
        if squared.is_finite() { Ok(squared) } else { Err(FitError::Overflow) }
    };
    let folds = (0..points.len()).map(fold).collect::<Result<Vec<f64>, FitError>>()?;
    let mean = folds.iter().sum::<f64>() / folds.len() as f64;
    Ok(CrossValidation { folds, mean })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sign of a NaN is what the processor made it: neither may win.
    #[test]
    fn what_is_no_number_never_wins() {
        for nan in [f64::NAN, -f64::NAN] {
            assert_eq!(best([(Model::Constant, nan), (Model::Line, 2.0)].into_iter()), Some(Model::Line));
            assert_eq!(best([(Model::Line, 2.0), (Model::Exponential, nan)].into_iter()), Some(Model::Line));
            assert_eq!(best([(Model::Line, nan)].into_iter()), None);
        }
        assert_eq!(best([(Model::Line, 2.0), (Model::Parabola, 2.0)].into_iter()), Some(Model::Line));
    }
}
