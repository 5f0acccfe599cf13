//! What follows from the cases of a study: comparison, trends, curves and effects.

use super::super::comparison::{self, PointComparison, Trend};
use super::super::definition::Definition;
use super::super::gather::{CaseResult, Gathered};
use super::super::quantity::Quantity;
use crate::base::error::Result;
use crate::study::fit::{self, Fit, Model as Curve, ModelComparison};
use crate::study::screening::{self, Effects, Model};
use serde::Serialize;

/// What follows from the cases of a study.
pub struct Findings {
    /// Points compared with published results and theory.
    pub comparison: Vec<PointComparison>,
    /// How strength and elongation go over the axis.
    pub trends: Vec<Trend>,
    /// Curves over the axis.
    pub fits: Vec<Fitted>,
    /// What each factor of a design does.
    pub effects: Vec<Moved>,
}

/// Curves through a quantity over the axis.
#[derive(Serialize)]
pub struct Fitted {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// All models, each with its cross-validation.
    pub comparison: ModelComparison,
}

/// What the factors of a design do to a quantity.
#[derive(Serialize)]
pub struct Moved {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// Whether effects are judged by means of points rather than by runs.
    pub by_points: bool,
    /// Standard deviation from seed to seed, pooled over the points; `None` where no point has two runs.
    pub seeds_deviation: Option<f64>,
    /// Effects, or why there are none.
    pub effects: std::result::Result<Effects, String>,
}

impl Findings {
    /// From the cases that are there.
    ///
    /// # Errors
    /// When strand theory cannot be calibrated.
    pub fn new(definition: &Definition, gathered: &Gathered) -> Result<Self> {
        let comparison = comparison::points(definition, gathered)?;
        let trends = comparison::trends(definition, &comparison);
        let fitted = |quantity: &&'static Quantity| Fitted {
            quantity: &quantity.name,
            comparison: fit::compare(&means_over_axis(definition, gathered, quantity)),
        };
        let fits = definition.fits.iter().map(fitted).collect();
        Ok(Self { comparison, trends, fits, effects: effects_of(definition, gathered) })
    }

    /// A exp(B x) + C through a quantity, if it was asked for and found.
    pub fn exponential(&self, quantity: &str) -> Option<&Fit> {
        let fitted = self.fits.iter().find(|fitted| fitted.quantity == quantity)?;
        fitted.comparison.model(Curve::Exponential).fit.as_ref().ok()
    }
}

/// (x, mean over seeds) of the points of a study over one axis.
fn means_over_axis(definition: &Definition, gathered: &Gathered, quantity: &Quantity) -> Vec<[f64; 2]> {
    let Some(axis) = definition.abscissa() else { return Vec::new() };
    let at = |point: usize| {
        let x = axis.levels[definition.points[point][0]].number?;
        Some([x, gathered.stat(point, quantity)?.mean])
    };
    (0..definition.points.len()).filter_map(at).collect()
}

/// Effects on every quantity of a study with a design; none without one.
fn effects_of(definition: &Definition, gathered: &Gathered) -> Vec<Moved> {
    let Some(model) = &definition.model else { return Vec::new() };
    let one = |quantity: &&'static Quantity| Moved {
        quantity: &quantity.name,
        by_points: by_points(definition, model),
        seeds_deviation: seeds_deviation(definition, gathered, quantity),
        effects: screening::effects(model, &responses(definition, gathered, quantity, model))
            .map_err(|why| why.to_string()),
    };
    definition.quantities.iter().map(one).collect()
}

/// Whether effects are judged by the means of points over seeds rather than by runs. Seeds of a point share what the model
/// leaves out there, such as interactions of three factors: taken as independent, they make intervals too narrow. Only a
/// design without points to spare leaves nothing but the scatter of seeds to judge by.
pub(super) fn by_points(definition: &Definition, model: &Model) -> bool {
    definition.points.len() > model.parameters()
}

/// Levels and response of each point, or of each run.
fn responses(
    definition: &Definition,
    gathered: &Gathered,
    quantity: &Quantity,
    model: &Model,
) -> Vec<(Vec<usize>, f64)> {
    if by_points(definition, model) {
        let mean = |point: usize| gathered.stat(point, quantity).map_or(f64::NAN, |stat| stat.mean);
        return (0..definition.points.len()).map(|point| (definition.points[point].clone(), mean(point))).collect();
    }
    let run = |case: &CaseResult| {
        let value = case.result().map(|run| quantity.number(run).unwrap_or(f64::NAN))?;
        Some((definition.points[case.point].clone(), value))
    };
    gathered.cases.iter().filter_map(run).collect()
}

/// Standard deviation from seed to seed, pooled over the points; `None` where no point has two runs.
fn seeds_deviation(definition: &Definition, gathered: &Gathered, quantity: &Quantity) -> Option<f64> {
    let of_points = (0..definition.points.len()).filter_map(|point| {
        let stat = gathered.stat(point, quantity)?;
        Some(((stat.count - 1) as f64, stat.standard_deviation?))
    });
    let (freedom, squares) = of_points.fold((0.0, 0.0), |(freedom, squares), (more, deviation)| {
        (freedom + more, squares + more * deviation * deviation)
    });
    (freedom > 0.0).then(|| (squares / freedom).sqrt())
}
