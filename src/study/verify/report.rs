//! What verification found, as a table for people and as JSON for programs.

use super::Report;
use super::comparison::{Comparison, Convergence, Point, Verdict};
use crate::base::error::Result;
use crate::observe::files::write_whole;
use crate::study::column::{self, Column, Value};
use std::fmt::Write;
use std::path::Path;

/// A line of the results: a comparison of a case, or that the case could not be run.
type Line<'a> = (&'a Report, Option<&'a Comparison>);

/// The lines of a report.
fn lines(report: &Report) -> Vec<Line<'_>> {
    match &report.result {
        Ok(comparisons) => comparisons.iter().map(|finding| (report, Some(finding))).collect(),
        Err(_) => vec![(report, None)],
    }
}

/// The columns of a line, in JSON and for people. Numbers that are not finite are null.
fn columns<'a>() -> Vec<Column<'a, Line<'a>>> {
    fn of<'a, V: Into<Value> + 'static>(of: fn(&Comparison) -> V) -> impl Fn(&Line<'a>) -> Value {
        move |(_, finding): &Line<'a>| finding.map_or(Value::Missing, |finding| of(finding).into())
    }
    vec![
        Column::in_files("case", |(report, _): &Line<'a>| report.case.name),
        Column::new("quantity", "quantity", "", 0, |(_, f): &Line<'a>| f.map_or("", |f| &f.what))
            .shown_as(|(_, f): &Line| f.map_or(String::new(), quantity)),
        Column::in_files("unit", |(_, f): &Line<'a>| f.map_or("-", |f| &*f.unit)),
        Column::new("computed", "computed", "", 6, of(|f| f.computed))
            .shown_as(|(_, f): &Line| f.map_or(String::new(), |f| number(f.computed))),
        Column::new("exact", "exact", "", 6, of(|f| f.exact)).shown_as(|(_, f): &Line| f.map_or(String::new(), exact)),
        Column::new("error_percent", "error", "%", 3, of(|f| 100.0 * f.error()))
            .shown_as(|(_, f): &Line| f.map_or(String::new(), error)),
        Column::in_files("scale", of(|f| f.scale)),
        Column::in_files("target_percent", |(_, f): &Line<'a>| {
            serde_json::json!(f.map_or([None; 2], |f| f.allowed.map(|limit| finite(100.0 * limit))))
        }),
        Column::new("order", "order (theory)", "", 2, of(|f| f.order.map(|order| order.observed)))
            .shown_as(|(_, f): &Line| f.map_or(String::new(), order)),
        Column::in_files("order_theory", of(|f| f.order.map(|order| order.theory))),
        Column::in_files("order_tolerance", of(|f| f.order.map(|order| order.tolerance))),
        Column::new("steps", "steps", "", 0, |(_, f): &Line<'a>| f.map_or(0, |f| f.spent.steps)),
        Column::new("wall_s", "time", "s", 2, |(report, f): &Line<'a>| f.map_or(report.wall_s, |f| f.spent.wall_s)),
        Column::new("outcome", "outcome", "", 0, |(_, f): &Line<'a>| f.map_or("failed", |f| f.verdict().word()))
            .shown_as(|(_, f): &Line| f.map_or(String::new(), verdict)),
        Column::in_files("note", |(report, f): &Line<'a>| match &report.result {
            Err(error) => Some(error.to_string()),
            Ok(_) => f.and_then(|f| f.note.clone()),
        }),
        Column::in_files("series", of(|f| f.convergence.as_ref().map(series))),
    ]
}

/// Error over resolution for programs.
fn series(convergence: &Convergence) -> serde_json::Value {
    let point = |p: &Point| {
        let Point { resolution, error, spent } = p;
        serde_json::json!({
            "resolution": resolution, "error": finite(*error), "wall_s": spent.wall_s, "steps": spent.steps,
        })
    };
    serde_json::json!({
        "axis": convergence.axis, "points": convergence.points.iter().map(point).collect::<Vec<_>>(),
    })
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// What was computed, with its unit.
fn quantity(f: &Comparison) -> String {
    if f.unit == "-" { f.what.clone() } else { format!("{} [{}]", f.what, f.unit) }
}

/// Whether the finding asks for a least value, which has no error.
fn is_least(f: &Comparison) -> bool {
    f.allowed[1].is_infinite()
}

fn exact(f: &Comparison) -> String {
    if is_least(f) { format!("≥ {}", number(f.exact)) } else { number(f.exact) }
}

fn error(f: &Comparison) -> String {
    if is_least(f) { String::new() } else { percent(100.0 * f.error()) }
}

fn order(f: &Comparison) -> String {
    f.order.map_or(String::new(), |o| format!("{:.2} ({:.2})", o.observed, o.theory))
}

fn verdict(f: &Comparison) -> String {
    let [low, high] = f.allowed.map(|limit| 100.0 * limit);
    let target = if -low == high { format!("±{high:.2}") } else { format!("{low:.2} to {high:.2}") };
    let target = if target == "±0.00" { format!("±{high:.0e}") } else { target };
    match f.verdict() {
        Verdict::Pass => "pass".into(),
        Verdict::Miss => format!("MISS (allowed {target} %)"),
    }
}

/// Writes a list of objects, one per finding, to `path`.
///
/// # Errors
/// When the file cannot be written.
pub fn write_json(reports: &[Report], path: &Path) -> Result<()> {
    write_whole(path, &json(reports))
}

fn json(reports: &[Report]) -> String {
    column::json(&columns(), &reports.iter().flat_map(lines).collect::<Vec<_>>())
}

/// The table: per case a line with its name and claim, then one line per finding.
pub fn table(reports: &[Report]) -> String {
    let all: Vec<Line> = reports.iter().flat_map(lines).collect();
    let text = column::table(String::new(), &columns(), &all, 1).aligned("  ", "outcome");
    let mut rows = text.rows.into_iter();
    let mut table = text.head;
    for report in reports {
        let _ = writeln!(table, "{}: {}", report.case.name, report.case.about);
        let rows: Vec<String> = rows.by_ref().take(lines(report).len()).collect();
        match &report.result {
            Ok(_) => table += &rows.concat(),
            Err(error) => {
                let _ = writeln!(table, "  FAILED: {error}");
            }
        }
    }
    table
}

/// Why comparisons differ from their closed forms by design, and what those that miss would have had to be.
pub fn notes(reports: &[Report]) -> String {
    let mut text = String::new();
    for report in reports {
        for f in report.result.iter().flatten() {
            if let Some(note) = &f.note {
                let _ = writeln!(text, "  {}, {}: {note}", report.case.name, f.what);
            }
        }
    }
    text
}

/// Six figures.
fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if !size.is_finite() => value.to_string(),
        size if (1e-3..1e6).contains(&size) => {
            let decimals = (5.0 - size.log10().floor()).clamp(0.0, 8.0) as usize;
            let text = format!("{value:.decimals$}");
            without_zeros(&text).to_owned()
        }
        _ => {
            let text = format!("{value:.5e}");
            let (mantissa, exponent) = text.split_once('e').expect("Rust writes an exponent");
            format!("{}e{exponent}", without_zeros(mantissa))
        }
    }
}

/// Without zeros at the end of its decimals.
fn without_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

fn percent(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if size >= 1e-3 => format!("{value:+.3}"),
        _ => format!("{value:+.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::error::Error;
    use crate::study::verify::CASES;
    use crate::study::verify::comparison::Spent;

    fn reports() -> Vec<Report> {
        let spent = Spent { steps: 1200, wall_s: 0.25 };
        let point = |resolution: f64, error: f64| Point { resolution, error, spent };
        let good = Comparison::new("contact time", "s", 3.0001e-5, 3e-5, spent).within(1e-3).converging(
            "dt/T",
            vec![point(0.1, 0.04), point(0.05, 0.01)],
            2.0,
            0.1,
        );
        let bad = Comparison::new("depth", "m", f64::NAN, 0.5, spent).within(1e-3).note("because");
        let error = Error::input("no such scene", "");
        vec![
            Report { case: &CASES[0], result: Ok(vec![good, bad]), wall_s: 1.0 },
            Report { case: &CASES[1], result: Err(error), wall_s: 1.0 },
        ]
    }

    #[test]
    fn json_has_the_agreed_keys_and_null_for_what_is_not_a_number() {
        let rows: serde_json::Value = serde_json::from_str(&json(&reports())).unwrap();
        let first = &rows[0];
        for key in ["case", "computed", "exact", "error_percent", "order", "wall_s", "outcome"] {
            assert!(!first[key].is_null(), "{key}: {first}");
        }
        assert_eq!(first["outcome"], "pass");
        assert_eq!(first["series"]["points"].as_array().unwrap().len(), 2);
        assert_eq!((&rows[1]["outcome"], rows[1]["computed"].is_null()), (&"miss".into(), true));
        assert_eq!((&rows[2]["outcome"], &rows[2]["note"]), (&"failed".into(), &"no such scene".into()));
    }

    #[test]
    fn table_shows_what_passes_what_misses_and_what_failed() {
        let text = table(&reports());
        for part in
            ["contact time [s]", "2.00 (2.00)", "+0.003", "pass", "MISS (allowed ±0.10 %)", "FAILED: no such scene"]
        {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
        assert!(notes(&reports()).contains("because"));
    }

    #[test]
    fn numbers_have_six_figures() {
        for (value, text) in [(0.658558123, "0.658558"), (115e9, "1.15e11"), (20.0, "20"), (1234567.0, "1.23457e6")] {
            assert_eq!(number(value), text);
        }
        assert_eq!(number(123456.7), "123457");
    }
}
