//! The results as a table for people and as JSON for programs.

use super::case::StabilityCase;
use super::measure::Answer;
use super::outcome::{Outcome, Report};
use crate::base::error::Result;
use crate::base::wording::counted;
use crate::observe::files::write_whole;
use crate::study::column::{self, Column, Value};
use std::path::Path;

/// Names and claims of cases, one to a line.
pub fn list(cases: &[StabilityCase]) -> String {
    let width = cases.iter().map(|case| case.name.len()).max().unwrap_or(0);
    cases.iter().map(|case| format!("{:width$}  {}\n", case.name, case.about)).collect()
}

/// The columns of a result, in JSON and for people.
fn columns() -> Vec<Column<'static, Report>> {
    fn of_answer<V: Into<Value> + 'static>(of: fn(&Answer) -> V) -> impl Fn(&Report) -> Value {
        move |report: &Report| report.answer.as_ref().map_or(Value::Missing, |answer| of(answer).into())
    }
    vec![
        Column::new("case", "case", "", 0, |report: &Report| report.case.name.clone()),
        Column::in_files("about", |report: &Report| report.case.about.clone()),
        Column::new("outcome", "outcome", "", 0, |report: &Report| report.outcome.word())
            .shown_as(|report| report.outcome.to_string()),
        Column::in_files("unit", of_answer(|answer| answer.unit.to_string())),
        Column::in_files("computed", of_answer(|answer| answer.computed)),
        Column::in_files("exact", of_answer(|answer| answer.exact)),
        Column::in_files("error_percent", of_answer(Answer::error_percent)),
        Column::new("residual_percent", "residual", "", 1, |report: &Report| report.residual.map(|r| 100.0 * r))
            .shown_as(|report| report.residual.map_or("-".into(), |r| format!("{:.1e} %", 100.0 * r))),
        Column::new("steps", "steps", "", 0, |report: &Report| report.steps),
        Column::new("wall_s", "wall", "", 1, |report: &Report| report.wall_s)
            .shown_as(|report| format!("{:.1} s", report.wall_s)),
        Column::new("measured", "measured", "", 0, of_answer(|answer| answer.what.to_string()))
            .shown_as(|report| report.answer.as_ref().map(measured).unwrap_or_default()),
        Column::in_files("message", |report: &Report| report.message.clone()),
    ]
}

/// The results, a line per case, and below it what the program said.
pub fn table(reports: &[Report]) -> String {
    let text = column::table(String::new(), &columns(), reports, 2).aligned("", "measured");
    let said = |report: &Report| report.message.lines().map(|said| format!("    {said}\n")).collect::<String>();
    reports.iter().zip(text.rows).fold(text.head, |table, (report, row)| table + &row + &said(report))
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

/// Writes the results as a JSON list.
///
/// # Errors
/// A file that cannot be written.
pub fn write_json(reports: &[Report], path: &Path) -> Result<()> {
    write_whole(path, &column::json(&columns(), reports))
}
