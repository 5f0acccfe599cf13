//! How a case ended. Outcomes are worked out from what happened; nobody writes one by hand.

use super::case::{Case, Expect};
use super::measure::Answer;
use serde::Serialize;
use std::fmt;

/// How a case ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
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

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Stable => "stable",
            Self::Refused => "refused",
            Self::Stopped => "stopped",
            Self::Failed => "FAILED",
        })
    }
}

/// What a case did, as the table shows it.
#[derive(Debug, Clone)]
pub struct Report {
    /// The case.
    pub case: Case,
    /// How it ended.
    pub outcome: Outcome,
    /// The number asked of it, when one is known.
    pub answer: Option<Answer>,
    /// Greatest energy residual over the greatest work done [-].
    pub residual: Option<f64>,
    /// Steps done, over all runs.
    pub steps: u64,
    /// Wall time [s].
    pub wall_s: f64,
    /// What the program said: cause and remedy, or its warnings; what is wrong where it failed.
    pub message: String,
}

/// What happened, before it is judged.
#[derive(Debug, Clone)]
pub enum Ended {
    /// It ran to its end with these warnings.
    Ran {
        /// See [`Report::answer`].
        answer: Option<Answer>,
        /// See [`Report::residual`].
        residual: Option<f64>,
        /// What else is not as it must be.
        wrong: Vec<String>,
        /// Warnings as the user reads them.
        warnings: Vec<String>,
    },
    /// It was refused before the first step.
    Refused {
        /// Cause.
        what: String,
        /// Remedy.
        help: Option<String>,
    },
    /// It was stopped.
    Stopped {
        /// Cause.
        what: String,
        /// Remedy.
        help: Option<String>,
    },
    /// It panicked, hung, or met an error of another kind.
    Broke(String),
}

/// Judges what happened by what the case expects.
pub fn judge(case: &Case, ended: Ended, steps: u64, wall_s: f64) -> Report {
    let report =
        |outcome, message| Report { case: case.clone(), outcome, answer: None, residual: None, steps, wall_s, message };
    match ended {
        Ended::Broke(what) => report(Outcome::Failed, what),
        Ended::Refused { what, help } => told(case, Outcome::Refused, what, help, report),
        Ended::Stopped { what, help } => told(case, Outcome::Stopped, what, help, report),
        Ended::Ran { answer, residual, mut wrong, warnings } => {
            if let Expect::Told(words) = case.expect {
                wrong.push(format!("it ran, and should have been refused or stopped ({})", words.join(", ")));
            }
            if let Some(residual) = residual.filter(|r| r.is_nan() || *r > case.residual.0) {
                wrong.push(format!("the energy ledger is open by {:.2} %", 100.0 * residual));
            }
            wrong.extend(answer.as_ref().and_then(Answer::miss));
            let said = warnings.join("\n");
            wrong.extend(missing(case.warned, &said).map(|word| format!("no warning speaks of \"{word}\"")));
            let outcome = if wrong.is_empty() { Outcome::Stable } else { Outcome::Failed };
            let mut parts = wrong;
            if outcome == Outcome::Stable && !case.residual.1.is_empty() {
                parts.push(format!("residual up to {} % allowed: {}", 100.0 * case.residual.0, case.residual.1));
            }
            parts.extend((!said.is_empty()).then_some(said));
            Report { answer, residual, ..report(outcome, parts.join("\n")) }
        }
    }
}

/// A message must be expected, name its cause in the expected words, and have a remedy.
fn told(
    case: &Case,
    outcome: Outcome,
    what: String,
    help: Option<String>,
    report: impl Fn(Outcome, String) -> Report,
) -> Report {
    let remedy = help.filter(|help| !help.is_empty());
    let said = match &remedy {
        Some(help) => format!("{what}; {help}"),
        None => what,
    };
    let wrong = match case.expect {
        Expect::Stable => Some("it should have run".to_string()),
        Expect::Told(_) if remedy.is_none() => Some("the message names no remedy".to_string()),
        Expect::Told(words) => missing(words, &said).map(|word| format!("the message does not say \"{word}\"")).next(),
    };
    match wrong {
        Some(wrong) => report(Outcome::Failed, format!("{wrong}: {said}")),
        None => report(outcome, said),
    }
}

fn missing<'a>(words: &'a [&'a str], said: &'a str) -> impl Iterator<Item = &'a str> {
    words.iter().copied().filter(move |word| !said.contains(word))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::stability::case::Base;

    fn case() -> Case {
        Case::new("x", "a test", Base::Text(""))
    }

    fn ran(residual: f64, wrong: Vec<String>) -> Ended {
        Ended::Ran { answer: None, residual: Some(residual), wrong, warnings: Vec::new() }
    }

    #[test]
    fn a_closed_ledger_is_stable_and_an_open_one_is_not() {
        assert_eq!(judge(&case(), ran(0.009, vec![]), 1, 0.0).outcome, Outcome::Stable);
        assert_eq!(judge(&case(), ran(0.011, vec![]), 1, 0.0).outcome, Outcome::Failed);
        assert_eq!(judge(&case(), ran(f64::NAN, vec![]), 1, 0.0).outcome, Outcome::Failed);
        assert_eq!(judge(&case(), ran(0.0, vec!["bad".into()]), 1, 0.0).outcome, Outcome::Failed);
    }

    #[test]
    fn a_refusal_counts_when_it_is_expected_and_says_cause_and_remedy() {
        let refused =
            |help: Option<&str>| Ended::Refused { what: "spheres 1 and 2 overlap".into(), help: help.map(Into::into) };
        let outcome = |case: &Case, ended| judge(case, ended, 0, 0.0).outcome;
        let told = case().told(&["overlap", "apart"]);
        assert_eq!(outcome(&told, refused(Some("move them apart"))), Outcome::Refused);
        assert_eq!(outcome(&told, refused(Some("pray"))), Outcome::Failed);
        assert_eq!(outcome(&told, refused(None)), Outcome::Failed);
        assert_eq!(outcome(&case(), refused(Some("move them apart"))), Outcome::Failed);
        assert_eq!(outcome(&told, ran(0.0, vec![])), Outcome::Failed);
    }
}
