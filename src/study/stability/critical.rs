//! The empirical critical time step: bisection of a fixed step between one that holds and one that does not.
//!
//! A step does not hold when the run has to stop, or when it ends with another energy than with half of the predicted
//! bound: a run may be unstable without exploding, because plastic flow, friction and damping swallow what a wrong step
//! feeds in. The prediction is the least bound that the engine gives during a run that follows it.

use super::case::{Critical, StabilityCase};
use super::measure::{Accept, Answer, CompletedRun};
use super::outcome::Ended;
use super::watch::{RunControl, watch};
use crate::base::error::{Error, Result};
use crate::engine::view::Sample;

/// Bisection ends when the step that holds and the one that does not are this near (-).
const SHARP: f64 = 0.005;
/// Greatest step tried, over the bound (-).
const WIDEST: f64 = 64.0;

/// Finds the critical step of a case.
///
/// # Errors
/// What the scene or the engine refuse; a run at half of the bound that does not hold.
pub fn search(case: &StabilityCase, critical: &Critical, quick: bool, control: &RunControl) -> Result<Ended> {
    let bound = least_bound(case, quick, control)?;
    let run = |step: f64| -> Result<f64> {
        let scene = case.scene(quick)?.changed(|spec| spec.time.step = Some(step));
        watch(&scene, control).map(|seen| energy(&seen))
    };
    let reference = run(0.5 * bound)?;
    let holds = |step: f64| -> Result<bool> {
        match run(step) {
            Ok(energy) => Ok(energy <= critical.growth * reference),
            Err(Error::Simulation(_)) => Ok(false),
            Err(other) => Err(other),
        }
    };
    let mut low = bound;
    let mut wrong = Vec::new();
    if !holds(low)? {
        wrong.push(format!("a run at the bound of {bound:.3e} s does not hold"));
        low = 0.5 * bound;
    }
    let mut high = 2.0 * low;
    while holds(high)? {
        low = high;
        high *= 2.0;
        if high > WIDEST * bound {
            wrong.push(format!("{WIDEST} times the bound still holds: the case tests nothing"));
            break;
        }
    }
    while high / low > 1.0 + SHARP && wrong.len() < 2 {
        let middle = (low * high).sqrt();
        if holds(middle)? { low = middle } else { high = middle }
    }
    let answer = Answer {
        what: "bound on the step, and critical step:".into(),
        unit: "ns".into(),
        computed: bound * 1e9,
        exact: low * 1e9,
        accept: Accept::Below(critical.within),
    };
    Ok(Ended::Ran { answer: Some(answer), residual: None, wrong, notices: Vec::new() })
}

/// The least bound on the step during a run that follows it (s).
fn least_bound(case: &StabilityCase, quick: bool, control: &RunControl) -> Result<f64> {
    watch(&case.scene(quick)?, control).map(|seen| seen.least_bound)
}

/// Greatest energy stored, moving or swallowed over the run (J).
fn energy(seen: &CompletedRun) -> f64 {
    let of = |row: &Sample| row.energy.internal().abs().max(row.energy.kinetic.abs());
    seen.rows.iter().map(of).fold(0.0, f64::max)
}
