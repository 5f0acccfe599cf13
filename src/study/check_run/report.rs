//! What a check of a run found, as a table for people and as JSON for programs.

use super::{Deviation, InvariantCheck, InvariantOutcome};
use crate::study::column::{self, Column, Value};

impl InvariantCheck {
    /// Whether it speaks against the run.
    pub fn failed(&self) -> bool {
        matches!(self.outcome, InvariantOutcome::Failed(_))
    }

    fn word(&self) -> &'static str {
        match self.outcome {
            InvariantOutcome::Passed(_) => "passed",
            InvariantOutcome::Failed(_) => "failed",
            InvariantOutcome::NotApplicable(_) => "not-applicable",
        }
    }

    fn deviation(&self) -> Option<&Deviation> {
        match &self.outcome {
            InvariantOutcome::Passed(seen) | InvariantOutcome::Failed(seen) => Some(seen),
            InvariantOutcome::NotApplicable(_) => None,
        }
    }

    fn why(&self) -> Option<String> {
        match &self.outcome {
            InvariantOutcome::NotApplicable(why) => Some(why.clone()),
            _ => None,
        }
    }
}

/// The columns of a check, in JSON and for people. Numbers that are not finite are null.
fn columns() -> [Column<'static, InvariantCheck>; 9] {
    fn of<V: Into<Value> + 'static>(of: fn(&Deviation) -> V) -> impl Fn(&InvariantCheck) -> Value {
        move |check: &InvariantCheck| check.deviation().map_or(Value::Missing, |seen| of(seen).into())
    }
    [
        Column::new("invariant", "invariant", "", 0, |check: &InvariantCheck| check.invariant.name),
        Column::in_files("about", |check: &InvariantCheck| check.invariant.about),
        Column::new("outcome", "outcome", "", 0, |check: &InvariantCheck| check.word()),
        Column::new("values", "values", "", 0, of(|seen| seen.values)),
        Column::new("worst", "furthest off", "", 0, of(|seen| seen.worst))
            .shown_as(|check| check.deviation().map_or(String::new(), |seen| number(seen.worst, seen))),
        Column::new("allowed", "allowed", "", 0, of(|seen| seen.allowed))
            .shown_as(|check| check.deviation().map_or(String::new(), |seen| number(seen.allowed, seen))),
        Column::in_files("unit", of(|seen| seen.unit)),
        Column::in_files("place", of(|seen| seen.place.clone())),
        Column::new("why", "note", "", 0, InvariantCheck::why),
    ]
}

/// The findings as a list of JSON objects.
pub fn json(findings: &[InvariantCheck]) -> String {
    column::json(&columns(), findings)
}

/// The findings for people; below them, what failed in full.
pub fn text(findings: &[InvariantCheck]) -> String {
    let mut text = column::table("Invariants of the run".into(), &columns(), findings, 2).to_text();
    for finding in findings {
        if let InvariantOutcome::Failed(seen) = &finding.outcome {
            text += &format!("\nFAILED {}: {}\n  {}\n", finding.invariant.name, finding.invariant.about, seen.place);
        }
    }
    text
}

fn number(value: f64, seen: &Deviation) -> String {
    let unit = if seen.unit == "-" { String::new() } else { format!(" {}", seen.unit) };
    if value == 0.0 { format!("0{unit}") } else { format!("{value:.2e}{unit}") }
}
