//! Numerical stability on stiff and extreme cases: a matrix of scenes, each run and judged.
//!
//! Every case must end `stable`, with its energy ledger closed and the number right where one is known, or `refused`
//! or `stopped` by a message that names cause and remedy. Everything else is `FAILED`: a value that is not finite, a
//! hang, an open ledger, a wrong number, a panic.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`matrix`] | the table of cases |
//! | [`case`] | what a case is |
//! | [`run`] | runs one on a thread of its own |
//! | [`watch`] | runs a scene to its end and watches it |
//! | [`measure`] | known numbers |
//! | [`critical`] | the empirical critical time step by bisection |
//! | [`outcome`] | how a case ended |
//! | [`report`], [`plots`] | the results for people and programs |

pub mod case;
pub mod critical;
pub mod matrix;
pub mod measure;
pub mod outcome;
pub mod plots;
pub mod report;
pub mod run;
pub mod watch;

use crate::base::error::Result;
use crate::run::DeviceChoice;
use crate::study::runner::{Case, CaseRunner, Status, Unfinished};
use crate::study::select;
use case::StabilityCase;
use measure::Answer;
use outcome::{Outcome, Report};
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;

/// The cases of these names, all when there is none; a name that ends in `*` takes all that begin so.
///
/// # Errors
/// A name that no case has; the nearest is suggested.
pub fn select(names: &[String]) -> Result<Vec<StabilityCase>> {
    let all = matrix::cases();
    let chosen = select::select(names, &all, |case| &case.name, "stability case", "strandsnap stability --list")?;
    Ok(chosen.into_iter().cloned().collect())
}

/// A case of a command that may have been ended before.
struct CaseOfCommand<'a> {
    case: &'a StabilityCase,
    quick: bool,
    device: &'a DeviceChoice,
    unfinished: Option<&'a Unfinished>,
}

/// What is kept of a case that ended as it should. One that did not is run again.
#[derive(PartialEq, Serialize, Deserialize)]
struct AsExpected {
    outcome: Outcome,
    answer: Option<Answer>,
    residual: Option<f64>,
    steps: u64,
    wall_s: f64,
    message: String,
}

impl CaseOfCommand<'_> {
    /// What it is kept by.
    fn key(&self) -> String {
        let effort = if self.quick { "quick" } else { "full" };
        match self.device {
            DeviceChoice::Processor => format!("stability case {}, {effort}", self.case.name),
            device => format!("stability case {}, {effort}, on {device}", self.case.name),
        }
    }
}

impl Case for CaseOfCommand<'_> {
    type Output = Report;

    fn name(&self) -> String {
        self.case.name.clone()
    }

    fn kept(&self) -> Option<Report> {
        let AsExpected { outcome, answer, residual, steps, wall_s, message } = self.unfinished?.find(&self.key())?;
        Some(Report { case: self.case.clone(), outcome, answer, residual, steps, wall_s, message })
    }

    fn run(&self, stop: &AtomicBool) -> Result<Report> {
        let report = run::run_case(self.case, self.quick, self.device, stop)?;
        if let Some(unfinished) = self.unfinished.filter(|_| report.outcome != Outcome::Failed) {
            let Report { outcome, answer, residual, steps, wall_s, message, .. } = report.clone();
            unfinished.keep(&self.key(), AsExpected { outcome, answer, residual, steps, wall_s, message })?;
        }
        Ok(report)
    }
}

/// Runs cases, the long ones first. The statuses come in the order of `cases`. Those that ended as they should in a command
/// that was ended before are taken from `unfinished`.
///
/// # Errors
/// When a thread cannot be started, or a result cannot be kept.
pub fn run_all(
    cases: &[StabilityCase],
    quick: bool,
    device: &DeviceChoice,
    runner: &CaseRunner,
    unfinished: Option<&Unfinished>,
) -> Result<Vec<Status<Report>>> {
    let mut order: Vec<usize> = (0..cases.len()).collect();
    order.sort_by_key(|index| !cases[*index].long);
    let of_command = |index: &usize| CaseOfCommand { case: &cases[*index], quick, device, unfinished };
    let statuses = runner.run(&order.iter().map(of_command).collect::<Vec<_>>())?;
    let mut placed: Vec<_> = order.into_iter().zip(statuses).collect();
    placed.sort_by_key(|(index, _)| *index);
    Ok(placed.into_iter().map(|(_, status)| status).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_are_found_by_name_and_by_beginning() {
        let find = |name: &str| select(&[name.to_string()]);
        assert_eq!(find("friction-0-sphere").unwrap().len(), 1);
        assert!(find("friction-*").unwrap().len() >= 8);
        let error = format!("{:?}", miette::Report::new(find("frition-0-sphere").unwrap_err()));
        assert!(error.contains("friction-0-sphere"), "{error}");
        assert_eq!(select(&[]).unwrap().len(), matrix::cases().len());
    }

    #[test]
    fn no_two_cases_have_one_name() {
        let mut names: Vec<String> = matrix::cases().into_iter().map(|case| case.name).collect();
        names.sort();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?}");
    }
}
