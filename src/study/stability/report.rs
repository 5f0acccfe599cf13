//! The results as a table for people and as JSON for programs.

use super::case::Case;
use super::measure::Answer;
use super::outcome::{Outcome, Report};
use crate::base::error::{Error, Result};
use crate::base::wording::counted;
use crate::observe::files::write_whole;
use serde::Serialize;
use std::path::Path;

/// Names and claims of cases, one to a line.
pub fn list(cases: &[Case]) -> String {
    let width = cases.iter().map(|case| case.name.len()).max().unwrap_or(0);
    cases.iter().map(|case| format!("{:width$}  {}\n", case.name, case.about)).collect()
}

/// The results, a line per case, and below it what the program said.
pub fn table(reports: &[Report]) -> String {
    let width = reports.iter().map(|report| report.case.name.len()).max().unwrap_or(0).max(4);
    let head = format!("{:width$}  outcome  {:>10}  {:>8}  {:>7}  measured\n", "case", "residual", "steps", "wall");
    reports.iter().fold(head, |table, report| table + &row(report, width))
}

fn row(report: &Report, width: usize) -> String {
    let residual = report.residual.map_or_else(|| "-".to_string(), |r| format!("{:.1e} %", 100.0 * r));
    let measured = report.answer.as_ref().map(measured).unwrap_or_default();
    let line = format!(
        "{:width$}  {:<7}  {residual:>10}  {:>8}  {:>5.1} s  {measured}",
        report.case.name, report.outcome, report.steps, report.wall_s,
    );
    let said: String = report.message.lines().map(|said| format!("    {said}\n")).collect();
    format!("{}\n{said}", line.trim_end())
}

fn measured(answer: &Answer) -> String {
    let Answer { what, unit, computed, exact, .. } = answer;
    match answer.error_percent() {
        Some(error) => {
            let relation = answer.relation();
            format!("{what} {} {unit}, {relation} {} ({error:+.2} %)", figures(*computed), figures(*exact))
        }
        None => format!("{what} {computed:.1e} {unit}"),
    }
}

/// A number with five significant figures.
fn figures(value: f64) -> String {
    let before = value.abs().max(1e-300).log10().floor() as i32 + 1;
    match before {
        -3..=6 => format!("{value:.*}", (5 - before).max(0) as usize),
        _ => format!("{value:.4e}"),
    }
}

/// How many cases ended how.
pub fn summary(reports: &[Report], seconds: f64) -> String {
    let count = |outcome| reports.iter().filter(|report| report.outcome == outcome).count();
    let failed: Vec<&str> =
        reports.iter().filter(|r| r.outcome == Outcome::Failed).map(|r| r.case.name.as_str()).collect();
    let steps: u64 = reports.iter().map(|report| report.steps).sum();
    let tail = if failed.is_empty() { String::new() } else { format!(": {}", failed.join(", ")) };
    format!(
        "{}, {:.1} million steps in {seconds:.1} s: {} stable, {} refused, {} stopped, {} FAILED{tail}",
        counted(reports.len(), "case"),
        steps as f64 * 1e-6,
        count(Outcome::Stable),
        count(Outcome::Refused),
        count(Outcome::Stopped),
        failed.len(),
    )
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
pub fn write_json(reports: &[Report], path: &Path) -> Result<()> {
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
