//! Plots of the matrix: the bound on the time step against the step that a run bears, and the energy residuals.

use super::case::Kind;
use super::outcome::{Outcome, Report};
use crate::base::error::Result;
use crate::study::plot::{self, Axis, Figure, Limit, Mark, Series};
use std::path::{Path, PathBuf};

/// Writes `stability.svg` and `stability.png` into a folder; nothing when there is nothing to show. Returns the files.
///
/// # Errors
/// A folder that cannot be written.
pub fn write(reports: &[Report], folder: &Path) -> Result<Vec<PathBuf>> {
    let figures: Vec<Figure> = [steps(reports), residuals(reports)].into_iter().flatten().collect();
    if figures.is_empty() {
        return Ok(Vec::new());
    }
    plot::write_pair(&figures, 1, folder, "stability")
}

/// Predicted over empirical critical step.
fn steps(reports: &[Report]) -> Option<Figure> {
    let point = |report: &Report| {
        let answer = report.answer.as_ref().filter(|_| matches!(report.case.kind, Kind::Critical(_)))?;
        Some((report.case.name.clone(), [answer.exact, answer.computed]))
    };
    let points: Vec<(String, [f64; 2])> = reports.iter().filter_map(point).collect();
    let critical = || points.iter().map(|(_, [critical, _])| *critical);
    let ends = [critical().reduce(f64::min)?, critical().reduce(f64::max)?];
    let mut figure = Figure::new(
        "Time step: the bound lies below what a run bears",
        Axis::log("empirical critical step [ns]").from_to(0.05 * ends[0], 2.0 * ends[1]),
        Axis::log("predicted bound [ns]"),
    );
    figure.series.push(Series::new("bound = critical step", Mark::Dashed, ends.map(|x| [x, x]).to_vec()));
    figure.series.push(Series::new("bound = 80 % of it", Mark::Dashed, ends.map(|x| [x, 0.8 * x]).to_vec()));
    figure.series.extend(points.into_iter().map(|(name, point)| Series::new(name, Mark::Points, vec![point])));
    Some(figure)
}

/// Energy residual of every run, from the least to the greatest.
fn residuals(reports: &[Report]) -> Option<Figure> {
    let of = |outcome: Outcome| {
        let mut values: Vec<f64> =
            reports.iter().filter(|r| r.outcome == outcome).filter_map(|r| r.residual).map(|r| 100.0 * r).collect();
        values.sort_by(f64::total_cmp);
        values.iter().enumerate().map(|(rank, value)| [(rank + 1) as f64, *value]).collect::<Vec<_>>()
    };
    let (stable, failed) = (of(Outcome::Stable), of(Outcome::Failed));
    if stable.len() + failed.len() < 2 {
        return None;
    }
    let mut figure = Figure::new(
        "Energy residual of every run",
        Axis::linear("runs, from the least residual to the greatest").from_to(0.0, 1.3 * stable.len() as f64),
        Axis::log("residual over work done [%]").from_to(1e-8, 10.0),
    );
    figure.series.push(Series::new("stable", Mark::Points, stable));
    if !failed.is_empty() {
        figure.series.push(Series::new("FAILED", Mark::Points, failed));
    }
    figure.limits.push(Limit { y: 1.0, name: "most that is accepted".into() });
    Some(figure)
}
