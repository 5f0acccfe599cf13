//! What a check of a run found, as a table for people and as JSON for programs.

use super::{Finding, Outcome, Seen};
use crate::study::table::Table;
use serde::Serialize;

/// One finding in JSON. Numbers that are not finite are null.
#[derive(Serialize)]
struct Row<'a> {
    invariant: &'a str,
    about: &'a str,
    /// `passed`, `failed` or `not-applicable`.
    outcome: &'a str,
    values: Option<usize>,
    worst: Option<f64>,
    allowed: Option<f64>,
    unit: Option<&'a str>,
    place: Option<&'a str>,
    why: Option<&'a str>,
}

impl Finding {
    /// Whether it speaks against the run.
    pub fn failed(&self) -> bool {
        matches!(self.outcome, Outcome::Failed(_))
    }

    fn word(&self) -> &'static str {
        match self.outcome {
            Outcome::Passed(_) => "passed",
            Outcome::Failed(_) => "failed",
            Outcome::NotApplicable(_) => "not-applicable",
        }
    }

    fn row(&self) -> Row<'_> {
        let (seen, why) = match &self.outcome {
            Outcome::Passed(seen) | Outcome::Failed(seen) => (Some(seen), None),
            Outcome::NotApplicable(why) => (None, Some(why.as_str())),
        };
        let finite = |value: f64| value.is_finite().then_some(value);
        Row {
            invariant: self.invariant.name,
            about: self.invariant.about,
            outcome: self.word(),
            values: seen.map(|s| s.values),
            worst: seen.and_then(|s| finite(s.worst)),
            allowed: seen.and_then(|s| finite(s.allowed)),
            unit: seen.map(|s| s.unit),
            place: seen.map(|s| s.place.as_str()),
            why,
        }
    }
}

/// The findings as a list of JSON objects.
///
/// # Panics
/// Never: the rows hold nothing that JSON lacks.
pub fn json(findings: &[Finding]) -> String {
    let rows: Vec<Row> = findings.iter().map(Finding::row).collect();
    serde_json::to_string_pretty(&rows).expect("plain rows") + "\n"
}

/// The findings for people; below them, what failed in full.
pub fn text(findings: &[Finding]) -> String {
    let cells = |finding: &Finding| {
        let numbers = match &finding.outcome {
            Outcome::Passed(seen) | Outcome::Failed(seen) => {
                [seen.values.to_string(), number(seen.worst, seen), number(seen.allowed, seen), String::new()]
            }
            Outcome::NotApplicable(why) => [String::new(), String::new(), String::new(), why.clone()],
        };
        [vec![finding.invariant.name.to_owned(), finding.word().to_owned()], numbers.to_vec()].concat()
    };
    let table = Table {
        title: "Invariants of the run".into(),
        heads: ["invariant", "outcome", "values", "furthest off", "allowed", "note"].map(String::from).to_vec(),
        rows: findings.iter().map(cells).collect(),
        default: None,
        left: 2,
    };
    let mut text = table.to_text();
    for finding in findings {
        if let Outcome::Failed(seen) = &finding.outcome {
            text += &format!("\nFAILED {}: {}\n  {}\n", finding.invariant.name, finding.invariant.about, seen.place);
        }
    }
    text
}

fn number(value: f64, seen: &Seen) -> String {
    let unit = if seen.unit == "-" { String::new() } else { format!(" {}", seen.unit) };
    if value == 0.0 { format!("0{unit}") } else { format!("{value:.2e}{unit}") }
}
