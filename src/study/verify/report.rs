//! What verification found, as a table for people and as JSON for programs.

use super::Report;
use super::finding::{Finding, Outcome};
use crate::base::error::{Error, Result};
use crate::observe::files::write_whole;
use serde::Serialize;
use std::fmt::Write;
use std::path::Path;

/// One finding in JSON. Numbers that are not finite are null.
#[derive(Serialize)]
struct Row<'a> {
    case: &'a str,
    quantity: &'a str,
    unit: &'a str,
    computed: Option<f64>,
    exact: Option<f64>,
    /// Of `scale`, in the finding's unit.
    error_percent: Option<f64>,
    scale: Option<f64>,
    /// Least and greatest error allowed; null where there is no limit.
    target_percent: [Option<f64>; 2],
    order: Option<f64>,
    order_theory: Option<f64>,
    order_tolerance: Option<f64>,
    steps: u64,
    wall_s: f64,
    /// `pass`, `miss`, or `failed` when the case could not be run.
    outcome: &'a str,
    note: Option<String>,
    series: Option<Series<'a>>,
}

#[derive(Serialize)]
struct Series<'a> {
    axis: &'a str,
    points: Vec<SeriesPoint>,
}

#[derive(Serialize)]
struct SeriesPoint {
    resolution: f64,
    error: Option<f64>,
    wall_s: f64,
    steps: u64,
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn word(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Pass => "pass",
        Outcome::Miss => "miss",
    }
}

impl<'a> Row<'a> {
    fn of(case: &'a str, f: &'a Finding) -> Self {
        let series = f.convergence.as_ref().map(|c| Series {
            axis: c.axis,
            points: c
                .points
                .iter()
                .map(|p| SeriesPoint {
                    resolution: p.resolution,
                    error: finite(p.error),
                    wall_s: p.spent.wall_s,
                    steps: p.spent.steps,
                })
                .collect(),
        });
        Self {
            case,
            quantity: &f.what,
            unit: f.unit,
            computed: finite(f.computed),
            exact: finite(f.exact),
            error_percent: finite(100.0 * f.error()),
            scale: finite(f.scale),
            target_percent: f.allowed.map(|limit| finite(100.0 * limit)),
            order: f.order.and_then(|order| finite(order.observed)),
            order_theory: f.order.map(|order| order.theory),
            order_tolerance: f.order.map(|order| order.tolerance),
            steps: f.spent.steps,
            wall_s: f.spent.wall_s,
            outcome: word(f.outcome()),
            note: f.note.clone(),
            series,
        }
    }

    /// A case that could not be run.
    fn failed(report: &'a Report, error: &Error) -> Self {
        Self {
            case: report.case.name,
            quantity: "",
            unit: "-",
            computed: None,
            exact: None,
            error_percent: None,
            scale: None,
            target_percent: [None; 2],
            order: None,
            order_theory: None,
            order_tolerance: None,
            steps: 0,
            wall_s: report.wall_s,
            outcome: "failed",
            note: Some(error.to_string()),
            series: None,
        }
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
    let rows: Vec<Row> = reports
        .iter()
        .flat_map(|report| match &report.result {
            Ok(findings) => findings.iter().map(|f| Row::of(report.case.name, f)).collect(),
            Err(error) => vec![Row::failed(report, error)],
        })
        .collect();
    serde_json::to_string_pretty(&rows).expect("rows hold nothing that JSON lacks") + "\n"
}

/// The table: per case a line with its name and claim, then one line per finding.
pub fn table(reports: &[Report]) -> String {
    let cells: Vec<(&Report, Vec<[String; 8]>)> = reports.iter().map(|r| (r, rows(r))).collect();
    let head = ["quantity", "computed", "exact", "error [%]", "order (theory)", "steps", "time [s]", "outcome"];
    let mut widths = head.map(|text| text.chars().count());
    for row in cells.iter().flat_map(|(_, rows)| rows) {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = (*width).max(cell.chars().count());
        }
    }
    let mut text = line(&head.map(String::from), &widths);
    for (report, rows) in cells {
        let _ = writeln!(text, "{}: {}", report.case.name, report.case.about);
        match &report.result {
            Ok(_) => rows.iter().for_each(|row| text += &line(row, &widths)),
            Err(error) => {
                let _ = writeln!(text, "  FAILED: {error}");
            }
        }
    }
    text
}

/// Why findings differ from their closed forms by design, and what those that miss would have had to be.
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

fn rows(report: &Report) -> Vec<[String; 8]> {
    report.result.iter().flatten().map(cells).collect()
}

fn cells(f: &Finding) -> [String; 8] {
    let unit = if f.unit == "-" { String::new() } else { format!(" [{}]", f.unit) };
    let [low, high] = f.allowed.map(|limit| 100.0 * limit);
    let target = if -low == high { format!("±{high:.2}") } else { format!("{low:.2} to {high:.2}") };
    let target = if target == "±0.00" { format!("±{high:.0e}") } else { target };
    let outcome = match f.outcome() {
        Outcome::Pass => "pass".into(),
        Outcome::Miss => format!("MISS (allowed {target} %)"),
    };
    // A least value has no error.
    let least = high.is_infinite();
    let order = f.order.map_or(String::new(), |o| format!("{:.2} ({:.2})", o.observed, o.theory));
    [
        format!("{}{unit}", f.what),
        number(f.computed),
        if least { format!("≥ {}", number(f.exact)) } else { number(f.exact) },
        if least { String::new() } else { percent(100.0 * f.error()) },
        order,
        f.spent.steps.to_string(),
        format!("{:.2}", f.spent.wall_s),
        outcome,
    ]
}

/// Text to the left, numbers to the right.
fn line(cells: &[String; 8], widths: &[usize; 8]) -> String {
    let mut text = String::new();
    for (k, (cell, width)) in cells.iter().zip(widths).enumerate() {
        let pad = " ".repeat(width - cell.chars().count());
        text += &if k == 0 || k == 7 { format!("  {cell}{pad}") } else { format!("  {pad}{cell}") };
    }
    text.trim_end().to_owned() + "\n"
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
    use crate::study::verify::CASES;
    use crate::study::verify::finding::{Point, Spent};

    fn reports() -> Vec<Report> {
        let spent = Spent { steps: 1200, wall_s: 0.25 };
        let point = |resolution: f64, error: f64| Point { resolution, error, spent };
        let good = Finding::new("contact time", "s", 3.0001e-5, 3e-5, spent).within(1e-3).converging(
            "dt/T",
            vec![point(0.1, 0.04), point(0.05, 0.01)],
            2.0,
            0.1,
        );
        let bad = Finding::new("depth", "m", f64::NAN, 0.5, spent).within(1e-3).note("because");
        let error = Error::input("interrupted", "");
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
        assert_eq!((&rows[2]["outcome"], &rows[2]["note"]), (&"failed".into(), &"interrupted".into()));
    }

    #[test]
    fn table_shows_what_passes_what_misses_and_what_failed() {
        let text = table(&reports());
        for part in
            ["contact time [s]", "2.00 (2.00)", "+0.003", "pass", "MISS (allowed ±0.10 %)", "FAILED: interrupted"]
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
