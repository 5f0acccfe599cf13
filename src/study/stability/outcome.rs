//! How a case ended. Outcomes are worked out from what happened; nobody writes one by hand.

use super::case::{Expect, StabilityCase};
use super::measure::Answer;
use crate::base::finding::{Failure, FindingKind, Notice, Stopped};
use serde::{Deserialize, Serialize};
use std::fmt;

/// How a case ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Outcome {
    /// Ran to its end: every value finite, ledger closed, the known number met.
    Stable,
    /// Refused before the first step, with cause and remedy.
    Refused,
    /// Stopped during the run, with cause and remedy.
    Stopped,
    /// Anything else.
    Failed,
}

impl Outcome {
    /// In a word, for programs.
    pub fn word(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Refused => "refused",
            Self::Stopped => "stopped",
            Self::Failed => "failed",
        }
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(if *self == Self::Failed { "FAILED" } else { self.word() })
    }
}

/// What a case did, as the table shows it.
#[derive(Debug, Clone)]
pub struct Report {
    /// The case.
    pub case: StabilityCase,
    /// How it ended.
    pub outcome: Outcome,
    /// The number asked of it, when one is known.
    pub answer: Option<Answer>,
    /// Greatest energy residual over the greatest work done (-).
    pub residual: Option<f64>,
    /// Steps done, over all runs.
    pub steps: u64,
    /// Wall time (s).
    pub wall_s: f64,
    /// What the program said: cause and remedy, or what it found; what is wrong where it failed.
    pub message: String,
}

/// What happened, before it is judged.
#[derive(Debug, Clone)]
pub enum Ended {
    /// It ran to its end.
    Ran {
        /// See [`Report::answer`].
        answer: Option<Answer>,
        /// See [`Report::residual`].
        residual: Option<f64>,
        /// What else is not as it must be.
        wrong: Vec<String>,
        /// What it found.
        notices: Vec<Notice>,
    },
    /// It was refused before the first step.
    Refused {
        /// Cause.
        what: String,
        /// Remedy.
        help: Option<String>,
    },
    /// It was stopped.
    Stopped(Box<Stopped>),
    /// It panicked, hung, or met an error of another kind.
    Broke(String),
}

/// Greatest energy residual over the work done (-).
const RESIDUAL: f64 = 0.01;

/// Judges what happened by what the case expects.
pub fn judge(case: &StabilityCase, ended: Ended, steps: u64, wall_s: f64) -> Report {
    let report =
        |outcome, message| Report { case: case.clone(), outcome, answer: None, residual: None, steps, wall_s, message };
    match ended {
        Ended::Broke(what) => report(Outcome::Failed, what),
        Ended::Refused { what, help } => {
            let wrong = match (case.expect, &help) {
                (Expect::Refused, Some(_)) => None,
                (Expect::Refused, None) => Some("the message names no remedy"),
                _ => Some("it should have run"),
            };
            let said = help.map_or(what.clone(), |help| format!("{what}; {help}"));
            closed(wrong, Outcome::Refused, said, report)
        }
        Ended::Stopped(stopped) => {
            let wrong = match (case.expect, &stopped.failure) {
                (Expect::PassesThrough, Failure::PassedThrough { .. }) => None,
                (Expect::PassesThrough, _) => Some("it should have been stopped for another reason"),
                _ => Some("it should have run"),
            };
            closed(wrong, Outcome::Stopped, format!("{stopped}; {}", stopped.remedy()), report)
        }
        Ended::Ran { answer, residual, mut wrong, notices } => {
            match case.expect {
                Expect::Stable => {}
                Expect::Refused => wrong.push("it ran, and should have been refused".into()),
                Expect::PassesThrough => wrong.push("it ran, and bodies should have passed through each other".into()),
            }
            if let Some(residual) = residual.filter(|r| r.is_nan() || *r > RESIDUAL) {
                wrong.push(format!("the energy ledger is open by {:.2} %", 100.0 * residual));
            }
            wrong.extend(answer.as_ref().and_then(Answer::miss));
            let made = |kind: &FindingKind| notices.iter().any(|notice| notice.finding.kind() == *kind);
            wrong.extend(case.found.iter().filter(|kind| !made(kind)).map(|kind| format!("it did not find {kind:?}")));
            let outcome = if wrong.is_empty() { Outcome::Stable } else { Outcome::Failed };
            wrong.extend(notices.iter().map(Notice::to_string));
            Report { answer, residual, ..report(outcome, wrong.join("\n")) }
        }
    }
}

/// A run that was not let go on: as expected, or why not.
fn closed(wrong: Option<&str>, outcome: Outcome, said: String, report: impl Fn(Outcome, String) -> Report) -> Report {
    match wrong {
        Some(wrong) => report(Outcome::Failed, format!("{wrong}: {said}")),
        None => report(outcome, said),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::finding::{Body, Finding, Instant, Member, Relief};
    use crate::study::stability::case::Base;

    fn case() -> StabilityCase {
        StabilityCase::new("x", "a test", Base::Text(""))
    }

    fn ran(residual: f64, wrong: Vec<String>) -> Ended {
        Ended::Ran { answer: None, residual: Some(residual), wrong, notices: Vec::new() }
    }

    #[test]
    fn a_closed_ledger_is_stable_and_an_open_one_is_not() {
        assert_eq!(judge(&case(), ran(0.009, vec![]), 1, 0.0).outcome, Outcome::Stable);
        assert_eq!(judge(&case(), ran(0.011, vec![]), 1, 0.0).outcome, Outcome::Failed);
        assert_eq!(judge(&case(), ran(f64::NAN, vec![]), 1, 0.0).outcome, Outcome::Failed);
        assert_eq!(judge(&case(), ran(0.0, vec!["bad".into()]), 1, 0.0).outcome, Outcome::Failed);
    }

    #[test]
    fn a_refusal_counts_when_it_is_expected_and_names_a_remedy() {
        let refused =
            |help: Option<&str>| Ended::Refused { what: "spheres 1 and 2 overlap".into(), help: help.map(Into::into) };
        let outcome = |case: &StabilityCase, ended| judge(case, ended, 0, 0.0).outcome;
        let expected = case().refused();
        assert_eq!(outcome(&expected, refused(Some("move them apart"))), Outcome::Refused);
        assert_eq!(outcome(&expected, refused(None)), Outcome::Failed);
        assert_eq!(outcome(&case(), refused(Some("move them apart"))), Outcome::Failed);
        assert_eq!(outcome(&case().passes_through(), refused(Some("move them apart"))), Outcome::Failed);
        assert_eq!(outcome(&expected, ran(0.0, vec![])), Outcome::Failed);
    }

    #[test]
    fn a_stop_counts_for_the_expected_reason_only() {
        let at = Instant { step: 5, time: 1e-6, strain: None };
        let stopped = |failure| Ended::Stopped(Box::new(Stopped { at, failure, kept: None }));
        let bond = Member { number: Some(2), body: Body::Wire { wire: 1, layer: "core".into() } };
        let through = Failure::PassedThrough { between: [bond.clone(), bond], z_m: 0.0, relief: Relief::Speed };
        let outcome = |case: &StabilityCase, ended| judge(case, ended, 0, 0.0).outcome;
        let expected = case().passes_through();
        assert_eq!(outcome(&expected, stopped(through.clone())), Outcome::Stopped);
        assert_eq!(outcome(&expected, stopped(Failure::UnstableMotion)), Outcome::Failed);
        assert_eq!(outcome(&case().refused(), stopped(through.clone())), Outcome::Failed);
        assert_eq!(outcome(&case(), stopped(through)), Outcome::Failed);
        assert_eq!(outcome(&expected, ran(0.0, vec![])), Outcome::Failed);
    }

    #[test]
    fn a_finding_that_is_missing_fails_the_case() {
        let outcome = |notices: Vec<Notice>| {
            let ended = Ended::Ran { answer: None, residual: Some(0.0), wrong: Vec::new(), notices };
            judge(&case().finds(&[FindingKind::TooShort]), ended, 1, 0.0).outcome
        };
        let finding = Finding::TooShort { passages: 1.0, start: 10.0 };
        assert_eq!(outcome(vec![Notice { at: Instant::default(), finding }]), Outcome::Stable);
        assert_eq!(outcome(Vec::new()), Outcome::Failed);
    }
}
