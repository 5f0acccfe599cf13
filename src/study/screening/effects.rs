//! What each factor does, by ordinary least squares: means of levels, differences, interactions and the analysis of
//! variance (Montgomery, *Design and Analysis of Experiments*, 8th ed. 2013, chapters 3, 5 and 10).

use super::model::Model;
use crate::study::statistics::t_95;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Why there are no effects.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EffectsError {
    /// Too few runs.
    #[error(
        "{rows} responses cannot tell {parameters} parameters apart and leave anything to judge them by: more points or seeds, or fewer interactions"
    )]
    TooFew {
        /// Runs with a value.
        rows: usize,
        /// Parameters of the model.
        parameters: usize,
    },
    /// Every run gave the same.
    #[error("every run gave {0}: nothing moves it")]
    Constant(f64),
    /// The runs that are there do not tell the terms apart.
    #[error("the runs that are there do not tell the terms of the model apart: make those that are missing")]
    Confounded,
}

/// A number with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// Its value, in the unit of the response.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Half the width of its 95 % interval (Student's t).
    pub interval_95: f64,
}

impl Estimate {
    /// Whether zero is outside its interval.
    pub fn is_told_from_zero(&self) -> bool {
        self.value.abs() > self.interval_95
    }
}

/// A level, averaged over all levels of the other factors.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LevelMean {
    /// Number of the level whose mean this is.
    pub level: usize,
    /// Mean over the grid.
    pub mean: Estimate,
    /// Difference from the factor's first level; `None` for that.
    pub from_first: Option<Estimate>,
}

/// What a factor does.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Factor {
    /// Number of the factor in the design.
    pub factor: usize,
    /// Its levels.
    pub levels: Vec<LevelMean>,
}

/// The effect of a factor at one level of another.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AtLevel {
    /// Level of the factor, compared with its first.
    pub level: usize,
    /// Level of the other factor.
    pub at: usize,
    /// Difference from the factor's first level there.
    pub effect: Estimate,
    /// That difference less the one at the other factor's first level; `None` there.
    pub from_first: Option<Estimate>,
}

/// How the effect of one factor changes with another.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Interaction {
    /// The factor whose effect it is.
    pub of: usize,
    /// The factor that it changes with.
    pub with: usize,
    /// Its effects.
    pub effects: Vec<AtLevel>,
}

/// A term of the analysis of variance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Term {
    /// One factor, or two that interact.
    pub factors: Vec<usize>,
    /// Degrees of freedom.
    pub freedom: usize,
    /// What the model loses without it: extra sum of squares.
    pub squares: f64,
    /// The same over the total about the mean (%); terms that overlap need not add up.
    pub share_percent: f64,
    /// F against the residual.
    pub f: f64,
    /// Probability of so great an F by scatter alone (-).
    pub p: f64,
}

/// Everything that the runs say of one response.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Effects {
    /// Runs, or points, that have a value.
    pub rows: usize,
    /// Those that have none.
    pub left_out: usize,
    /// Residual degrees of freedom.
    pub freedom: usize,
    /// Residual standard deviation, in the unit of the response.
    pub residual: f64,
    /// Share of the variance that the model explains, R² (-).
    pub explained: f64,
    /// Factor by factor.
    pub factors: Vec<Factor>,
    /// The model's interactions.
    pub interactions: Vec<Interaction>,
    /// Terms, the one with the greatest share first.
    pub terms: Vec<Term>,
}

/// Effects on a response: `rows` are the levels of each run, or of each point with its mean, and the response there, NaN
/// where there is none.
///
/// # Errors
/// Too few runs, runs that do not tell the terms apart, or a response that never changes.
pub fn effects(model: &Model, rows: &[(Vec<usize>, f64)]) -> Result<Effects, EffectsError> {
    let known: Vec<&(Vec<usize>, f64)> = rows.iter().filter(|(_, y)| y.is_finite()).collect();
    let parameters = model.parameters();
    if known.len() <= parameters {
        return Err(EffectsError::TooFew { rows: known.len(), parameters });
    }
    if known.iter().all(|(_, y)| *y == known[0].1) {
        return Err(EffectsError::Constant(known[0].1));
    }
    let flat: Vec<f64> = known.iter().flat_map(|(levels, _)| model.row(levels)).collect();
    let x = DMatrix::from_row_slice(known.len(), parameters, &flat);
    let y = DVector::from_iterator(known.len(), known.iter().map(|(_, y)| *y));
    let solved = Solved::new(model, &x, &y).ok_or(EffectsError::Confounded)?;
    let about_mean = y.add_scalar(-y.mean()).norm_squared();
    Ok(Effects {
        rows: known.len(),
        left_out: rows.len() - known.len(),
        freedom: solved.freedom,
        residual: solved.variance.sqrt(),
        explained: 1.0 - solved.variance * solved.freedom as f64 / about_mean,
        factors: (0..model.levels.len()).filter(|f| model.levels[*f] > 1).map(|f| solved.factor(f)).collect(),
        interactions: model.interactions.iter().map(|[of, with]| solved.interaction(*of, *with)).collect(),
        terms: solved.terms(about_mean),
    })
}

/// The least-squares solution.
struct Solved<'a> {
    model: &'a Model,
    coefficients: DVector<f64>,
    /// (XᵀX)⁻¹.
    inverse: DMatrix<f64>,
    /// Residual variance.
    variance: f64,
    freedom: usize,
    t: f64,
}

impl<'a> Solved<'a> {
    /// `None` when the rows do not tell the parameters apart.
    fn new(model: &'a Model, x: &DMatrix<f64>, y: &DVector<f64>) -> Option<Self> {
        let singular = x.singular_values();
        if singular.min() < 1e-9 * singular.max() {
            return None;
        }
        let inverse = (x.transpose() * x).cholesky()?.inverse();
        let coefficients = &inverse * x.transpose() * y;
        let freedom = x.nrows() - x.ncols();
        let variance = (y - x * &coefficients).norm_squared() / freedom as f64;
        Some(Self { model, coefficients, inverse, variance, freedom, t: t_95(freedom) })
    }

    /// c'β with its error.
    fn estimate(&self, contrast: &[f64]) -> Estimate {
        let c = DVector::from_column_slice(contrast);
        let standard_error = (self.variance * c.dot(&(&self.inverse * &c))).max(0.0).sqrt();
        Estimate { value: c.dot(&self.coefficients), standard_error, interval_95: self.t * standard_error }
    }

    fn factor(&self, factor: usize) -> Factor {
        let row = |level: usize| self.model.mean_row(&[(factor, level)]);
        let level = |level: usize| LevelMean {
            level,
            mean: self.estimate(&row(level)),
            from_first: (level > 0).then(|| self.estimate(&less(&row(level), &row(0)))),
        };
        Factor { factor, levels: (0..self.model.levels[factor]).map(level).collect() }
    }

    fn interaction(&self, of: usize, with: usize) -> Interaction {
        let difference = |level: usize, at: usize| {
            less(&self.model.mean_row(&[(of, level), (with, at)]), &self.model.mean_row(&[(of, 0), (with, at)]))
        };
        let places =
            (1..self.model.levels[of]).flat_map(|level| (0..self.model.levels[with]).map(move |at| (level, at)));
        let effect = |(level, at): (usize, usize)| AtLevel {
            level,
            at,
            effect: self.estimate(&difference(level, at)),
            from_first: (at > 0).then(|| self.estimate(&less(&difference(level, at), &difference(level, 0)))),
        };
        Interaction { of, with, effects: places.map(effect).collect() }
    }

    /// The extra sum of squares of a term is bᵀ C⁻¹ b with b its coefficients and C its block of (XᵀX)⁻¹.
    fn terms(&self, about_mean: f64) -> Vec<Term> {
        let one = |(factors, offset): (Vec<usize>, usize)| {
            let freedom = self.model.freedom(&factors);
            let b = self.coefficients.rows(offset, freedom).into_owned();
            let block = self.inverse.view((offset, offset), (freedom, freedom)).into_owned();
            let squares = block.cholesky().map_or(f64::NAN, |factor| b.dot(&factor.solve(&b)));
            let f = squares / freedom as f64 / self.variance;
            Term {
                factors,
                freedom,
                squares,
                share_percent: 100.0 * squares / about_mean,
                f,
                p: self.chance(freedom, f),
            }
        };
        let mut terms: Vec<Term> = self.model.terms().into_iter().zip(self.model.offsets()).map(one).collect();
        terms.sort_by(|a, b| b.squares.total_cmp(&a.squares));
        terms
    }

    /// Probability of a greater F.
    fn chance(&self, freedom: usize, f: f64) -> f64 {
        // Without any residual, every effect is certain.
        if !f.is_finite() {
            return 0.0;
        }
        let distribution = FisherSnedecor::new(freedom as f64, self.freedom as f64);
        distribution.map_or(f64::NAN, |distribution| distribution.sf(f))
    }
}

fn less(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

#[cfg(test)]
mod tests {
    use super::super::d_optimal;
    use super::*;

    fn noise(state: &mut u64) -> f64 {
        let mut uniform = || {
            *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (*state >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }

    /// A 2² with two runs each: A = B = 10, AB = 2 around a mean of 20; squares n·effect² are 800, 800 and 32 for 8 runs.
    #[test]
    fn a_square_of_two_factors_by_hand() {
        let model = Model { levels: vec![2, 2], interactions: vec![[0, 1]] };
        let value = |a: usize, b: usize| {
            let [a, b] = [a, b].map(|level| if level == 0 { -1.0 } else { 1.0 });
            20.0 + 5.0 * a + 5.0 * b + a * b
        };
        let mut rows = Vec::new();
        for a in 0..2 {
            for b in 0..2 {
                rows.extend([(vec![a, b], value(a, b) + 0.5), (vec![a, b], value(a, b) - 0.5)]);
            }
        }
        rows.push((vec![0, 0], f64::NAN));
        let found = effects(&model, &rows).unwrap();
        assert_eq!((found.rows, found.left_out, found.freedom), (8, 1, 4));
        assert!((found.residual - (8.0 * 0.25 / 4.0f64).sqrt()).abs() < 1e-12);
        let of = |factors: &[usize]| found.terms.iter().find(|term| term.factors == factors).unwrap();
        for (factors, squares) in [(&[0][..], 200.0), (&[1], 200.0), (&[0, 1], 8.0)] {
            assert!((of(factors).squares - squares).abs() < 1e-9, "{factors:?}");
        }
        assert!((of(&[0]).f - 400.0).abs() < 1e-9 && of(&[0]).p < 1e-4 && of(&[0, 1]).p > 0.01);
        let from_first = found.factors[0].levels[1].from_first.unwrap();
        assert!((from_first.value - 10.0).abs() < 1e-12);
        // s √(1/4 + 1/4).
        assert!((from_first.standard_error - found.residual * 0.5f64.sqrt()).abs() < 1e-12);
        let at = &found.interactions[0].effects;
        assert!((at[0].effect.value - 8.0).abs() < 1e-12 && (at[1].from_first.unwrap().value - 4.0).abs() < 1e-12);
        let total: f64 = found.terms.iter().map(|term| term.squares).sum::<f64>() + 8.0 * 0.25;
        assert!((found.explained - (1.0 - 2.0 / total)).abs() < 1e-12);
    }

    fn mechanism() -> (Model, Vec<Vec<usize>>) {
        let model = Model { levels: vec![2, 4, 4, 2, 3], interactions: vec![[0, 1], [0, 2], [0, 3], [0, 4], [1, 4]] };
        let design = d_optimal(&model, 32).unwrap();
        (model, design)
    }

    /// Additive, and the effect of pitch grows with scatter.
    fn truth(levels: &[usize]) -> f64 {
        let pitch = levels[0] as f64;
        300.0 - 4.0 * levels[1] as f64 - 7.0 * levels[2] as f64 + levels[3] as f64
            - pitch * (1.0 + 3.0 * levels[2] as f64)
    }

    #[test]
    fn known_effects_come_back_from_a_sixth_of_the_grid() {
        let (model, design) = mechanism();
        let rows: Vec<_> = design.iter().map(|point| (point.clone(), truth(point))).collect();
        let found = effects(&model, &rows).unwrap();
        assert!(found.residual < 1e-9 && found.explained > 1.0 - 1e-12);
        let scatter = found.interactions.iter().find(|one| (one.of, one.with) == (0, 2)).unwrap();
        for (at, effect) in scatter.effects.iter().enumerate() {
            assert!((effect.effect.value + 1.0 + 3.0 * at as f64).abs() < 1e-9, "{effect:?}");
        }
        let grip = found.factors.iter().find(|one| one.factor == 1).unwrap();
        assert!((grip.levels[3].from_first.unwrap().value + 12.0).abs() < 1e-9);
    }

    /// Over many noisy copies, 95 % of the intervals hold the truth.
    #[test]
    fn intervals_hold_the_truth_as_often_as_they_say() {
        let (model, design) = mechanism();
        let mut state = 3;
        let (mut inside, mut all) = (0, 0);
        for _ in 0..300 {
            let twice = design.iter().chain(&design);
            let rows: Vec<_> = twice.map(|point| (point.clone(), truth(point) + 2.0 * noise(&mut state))).collect();
            let found = effects(&model, &rows).unwrap();
            let grip = found.factors.iter().find(|one| one.factor == 1).unwrap();
            for level in 1..4 {
                let estimate = grip.levels[level].from_first.unwrap();
                inside += usize::from((estimate.value + 4.0 * level as f64).abs() <= estimate.interval_95);
                all += 1;
            }
        }
        assert!((0.93..0.97).contains(&(f64::from(inside as u32) / f64::from(all))), "{inside} of {all}");
    }

    #[test]
    fn what_has_no_effects_is_said() {
        let (model, design) = mechanism();
        let same: Vec<_> = design.iter().map(|point| (point.clone(), 0.0)).collect();
        assert_eq!(effects(&model, &same), Err(EffectsError::Constant(0.0)));
        assert!(matches!(effects(&model, &same[..26]), Err(EffectsError::TooFew { rows: 26, .. })));
        // Half of the pitches only.
        let short: Vec<_> =
            model.grid().into_iter().filter(|point| point[0] == 0).map(|p| (p.clone(), truth(&p))).collect();
        assert_eq!(effects(&model, &short), Err(EffectsError::Confounded));
    }
}
