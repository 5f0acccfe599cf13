//! A exp(B x) + C: start values by variable projection, then Levenberg–Marquardt.
//!
//! The search runs in v = α + β (e^{b(u − u₀)} − 1)/b, which goes over into a line where b goes to zero, so that nearly
//! straight points do not send A and C to infinity on the way. u₀ is the end at which the curve is steepest, so that the
//! exponential is 1 there and less everywhere else: points that crowd together at one end of a long axis make b large, and
//! e^{bu} from the middle of the axis would overflow. A, B and C follow from it exactly.

use super::model::FitError;
use super::scaled::Scaled;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::storage::Owned;
use nalgebra::{DVector, Dyn, OMatrix, U3, Vector3};

/// |b| below which the curve leaves a line by less than a hundred-thousandth of its height.
const STRAIGHT: f64 = 1e-4;
/// Share of the height at one end that is left at the neighbouring point, below which the curve is a step.
const STEP: f64 = 1e-4;
/// Trial values of b, each sign.
const TRIALS: usize = 200;
/// Least trial.
const LEAST: f64 = 0.01;

/// A, B and C nearest to the points, of which there are at least three with different x.
pub(super) fn parameters(scaled: &Scaled) -> Result<Vec<f64>, FitError> {
    if scaled.flat {
        return Err(FitError::Flat(scaled.y[0]));
    }
    let steepest = steepest(scaled);
    let is_step = |b: f64| b.abs() >= (1.0 - 1e-9) * steepest[usize::from(b > 0.0)];
    let start = start(scaled, &steepest).ok_or(FitError::Overflow)?;
    // There the search would go on towards ever sharper bends.
    if is_step(start[2]) {
        return Err(FitError::Step);
    }
    let foot = foot(start[2]);
    let [alpha, beta, b] = polish(scaled, start, foot)?.into();
    if b.abs() < STRAIGHT {
        return Err(FitError::Straight);
    }
    if is_step(b) {
        return Err(FitError::Step);
    }
    let ([middle, half], [mean, height]) = (scaled.x, scaled.y);
    let rate = b / half;
    let amplitude = height * beta / b * (-rate * (middle + half * foot)).exp();
    Ok(vec![amplitude, rate, mean + height * (alpha - beta / b)])
}

/// u₀, the end at which a curve of this b is steepest: the first point of falling ones, the last of rising ones.
fn foot(b: f64) -> f64 {
    if b < 0.0 { -1.0 } else { 1.0 }
}

/// (e^{bu} − 1)/b.
fn bend(b: f64, u: f64) -> f64 {
    if b == 0.0 { u } else { (b * u).exp_m1() / b }
}

/// Its derivative by b.
fn bend_by_b(b: f64, u: f64) -> f64 {
    let t = b * u;
    if t.abs() < 1e-3 {
        // u² (1/2 + t/3 + t²/8 + …): the closed form takes the difference of equals there.
        return u * u * (0.5 + t * (1.0 / 3.0 + t * (0.125 + t / 30.0)));
    }
    (t * t.exp() - t.exp_m1()) / (b * b)
}

/// |b| at which the curve is a step: falling ones (b < 0) by the gap between the first points, rising ones by the last.
fn steepest(scaled: &Scaled) -> [f64; 2] {
    let mut u = scaled.u.clone();
    u.sort_by(f64::total_cmp);
    u.dedup();
    let gap = |a: f64, b: f64| -STEP.ln() / (b - a);
    [gap(u[0], u[1]), gap(u[u.len() - 2], u[u.len() - 1])]
}

/// The best of many b, each with its best α and β (Golub & Pereyra 1973); `None` when numbers do not hold any.
fn start(scaled: &Scaled, steepest: &[f64; 2]) -> Option<Vector3<f64>> {
    let trial = |sign: f64, limit: f64| {
        let ratio = (limit / LEAST).ln();
        (0..TRIALS).map(move |k| sign * LEAST * (ratio * k as f64 / (TRIALS - 1) as f64).exp())
    };
    let trials = trial(-1.0, steepest[0]).chain(trial(1.0, steepest[1]));
    // A sum that is no number is no best one, whatever its sign.
    let sums = trials.map(|b| projected(scaled, b)).filter(|(_, left)| left.is_finite());
    let best = sums.min_by(|a, b| a.1.total_cmp(&b.1));
    best.map(|(at, _)| at)
}

/// α and β nearest to the points at this b, and the sum of squares that is left.
fn projected(scaled: &Scaled, b: f64) -> (Vector3<f64>, f64) {
    let n = scaled.u.len() as f64;
    let bends: Vec<f64> = scaled.u.iter().map(|u| bend(b, *u - foot(b))).collect();
    let (mean_g, mean_v) = (bends.iter().sum::<f64>() / n, scaled.v.iter().sum::<f64>() / n);
    let pairs = || bends.iter().zip(&scaled.v).map(|(g, v)| (g - mean_g, v - mean_v));
    let beta = pairs().map(|(g, v)| g * v).sum::<f64>() / pairs().map(|(g, _)| g * g).sum::<f64>();
    let left = pairs().map(|(g, v)| (v - beta * g).powi(2)).sum();
    (Vector3::new(mean_v - beta * mean_g, beta, b), left)
}

fn polish(scaled: &Scaled, start: Vector3<f64>, foot: f64) -> Result<Vector3<f64>, FitError> {
    let problem = Problem { scaled, foot, at: start };
    let (problem, report) = LevenbergMarquardt::new().with_tol(4.0 * f64::EPSILON).minimize(problem);
    match report.termination {
        // The tolerances are those of the arithmetic, so that this is the end, too.
        TerminationReason::NoImprovementPossible(_) => Ok(problem.at),
        ended if ended.was_successful() => Ok(problem.at),
        ended => Err(FitError::NotConverged(format!("{ended:?} after {} trials", report.number_of_evaluations))),
    }
}

struct Problem<'a> {
    scaled: &'a Scaled,
    /// u₀.
    foot: f64,
    /// α, β and b.
    at: Vector3<f64>,
}

impl LeastSquaresProblem<f64, Dyn, U3> for Problem<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, U3>;
    type ParameterStorage = Owned<f64, U3>;

    fn set_params(&mut self, at: &Vector3<f64>) {
        self.at = *at;
    }

    fn params(&self) -> Vector3<f64> {
        self.at
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let [alpha, beta, b] = self.at.into();
        let residual = |(u, v): (&f64, &f64)| alpha + beta * bend(b, *u - self.foot) - v;
        let all: Vec<f64> = self.scaled.u.iter().zip(&self.scaled.v).map(residual).collect();
        // A trial step that goes beyond what numbers hold ends the search instead of leading it astray.
        all.iter().all(|r| r.is_finite()).then(|| DVector::from_vec(all))
    }

    fn jacobian(&self) -> Option<OMatrix<f64, Dyn, U3>> {
        let [_, beta, b] = self.at.into();
        let u = &self.scaled.u;
        Some(OMatrix::<f64, Dyn, U3>::from_fn(u.len(), |row, column| match column {
            0 => 1.0,
            1 => bend(b, u[row] - self.foot),
            _ => beta * bend_by_b(b, u[row] - self.foot),
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_derivative_by_b_is_that_of_the_bend() {
        for b in [-3.0, -0.4, -1e-4, 1e-7, 0.02, 1.0, 5.0] {
            for u in [-1.0, -0.3, 0.0, 1e-3, 0.7, 1.0] {
                let h = 1e-5;
                let numeric = (bend(b + h, u) - bend(b - h, u)) / (2.0 * h);
                let scale = (b * u).exp().max(1.0);
                assert!((bend_by_b(b, u) - numeric).abs() < 1e-8 * scale, "{b} {u}: {} {numeric}", bend_by_b(b, u));
            }
        }
    }
}
