//! The results as a table for people and as JSON for programs.

use super::measure::Answer;
use super::outcome::{Outcome, Report};
use crate::base::error::{Error, Result};
use crate::observe::files::write_whole;
use serde::Serialize;
use std::path::Path;

/// The printed table.
pub struct Table;

impl Table {
    /// Its head.
    pub const HEAD: &str = "case                   outcome  residual       steps   wall  measured and said\n\
                            ---------------------  -------  ----------  --------  -----  -----------------";

    /// One case.
    pub fn row(report: &Report) -> String {
        let residual = report.residual.map_or_else(|| "-".to_string(), |r| format!("{:.1e} %", 100.0 * r));
        let said: Vec<String> = report.answer.as_ref().map(measured).into_iter().chain(said(report)).collect();
        format!(
            "{:<21}  {:<7}  {residual:>10}  {:>8}  {:>4.1}s  {}",
            report.case.name,
            report.outcome,
            report.steps,
            report.wall_s,
            said.join("; ")
        )
    }
}

fn measured(answer: &Answer) -> String {
    let Answer { what, unit, computed, exact, .. } = answer;
    match answer.error_percent() {
        Some(error) => format!("{what} {computed:.4} against {exact:.4} {unit} ({error:+.2} %)"),
        None => format!("{what} {computed:.1e} {unit}"),
    }
}

fn said(report: &Report) -> Option<String> {
    (!report.message.is_empty()).then(|| report.message.clone())
}

/// How many cases ended how.
pub fn summary(reports: &[Report]) -> String {
    let count = |outcome| reports.iter().filter(|report| report.outcome == outcome).count();
    let failed: Vec<&str> =
        reports.iter().filter(|r| r.outcome == Outcome::Failed).map(|r| r.case.name.as_str()).collect();
    let steps: u64 = reports.iter().map(|report| report.steps).sum();
    let mut text = format!(
        "{} cases: {} stable, {} refused, {} stopped, {} FAILED; {:.1} million steps",
        reports.len(),
        count(Outcome::Stable),
        count(Outcome::Refused),
        count(Outcome::Stopped),
        failed.len(),
        steps as f64 * 1e-6
    );
    if !failed.is_empty() {
        text += &format!("\nFAILED: {}", failed.join(", "));
    }
    text
}

/// One case in JSON.
#[derive(Debug, Serialize)]
struct Record<'a> {
    case: &'a str,
    about: &'a str,
    outcome: Outcome,
    measured: Option<&'a str>,
    unit: Option<&'a str>,
    computed: Option<f64>,
    exact: Option<f64>,
    error_percent: Option<f64>,
    order: Option<f64>,
    residual_percent: Option<f64>,
    steps: u64,
    wall_s: f64,
    message: &'a str,
}

/// Writes the results as a JSON list.
///
/// # Errors
/// A file that cannot be written.
pub fn write_json(path: &Path, reports: &[Report]) -> Result<()> {
    let record = |report: &'_ Report| -> serde_json::Result<serde_json::Value> {
        let answer = report.answer.as_ref();
        serde_json::to_value(Record {
            case: &report.case.name,
            about: &report.case.about,
            outcome: report.outcome,
            measured: answer.map(|a| a.what),
            unit: answer.map(|a| a.unit),
            computed: answer.map(|a| a.computed),
            exact: answer.map(|a| a.exact),
            error_percent: answer.and_then(Answer::error_percent),
            order: None,
            residual_percent: report.residual.map(|r| 100.0 * r),
            steps: report.steps,
            wall_s: report.wall_s,
            message: &report.message,
        })
    };
    let list: serde_json::Result<Vec<_>> = reports.iter().map(record).collect();
    let text = list.and_then(|list| serde_json::to_string_pretty(&list));
    let text = text.map_err(|error| Error::io("cannot write", path, std::io::Error::other(error)))?;
    write_whole(path, &(text + "\n"))
}
