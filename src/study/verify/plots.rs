//! Error against resolution and against run time, case by case.

use super::Report;
use super::comparison::{Comparison, Convergence};
use crate::base::error::Result;
use crate::study::plot::{self, Axis, Figure, Limit, Mark, Series, Slope};
use std::path::{Path, PathBuf};

/// Writes `CASE.svg` and `CASE.png` into `folder` for every case that varied its resolution, and `all.svg` and
/// `all.png` with all of them when there are several. Gives the files.
///
/// # Errors
/// When the folder cannot be written.
pub fn write(reports: &[Report], folder: &Path) -> Result<Vec<PathBuf>> {
    let pairs: Vec<(&str, [Figure; 2])> = reports
        .iter()
        .filter_map(|report| {
            let found = report.result.iter().flatten().find(|f| f.convergence.is_some())?;
            Some((report.case.name, figures(report.case.name, found, found.convergence.as_ref()?)))
        })
        .collect();
    let mut files = Vec::new();
    for (name, pair) in &pairs {
        files.extend(plot::write_pair(pair, 2, folder, name)?);
    }
    if pairs.len() > 1 {
        let all: Vec<Figure> = pairs.into_iter().flat_map(|(_, pair)| pair).collect();
        files.extend(plot::write_pair(&all, 4, folder, "all")?);
    }
    Ok(files)
}

/// Error over resolution and over run time.
fn figures(name: &str, finding: &Comparison, convergence: &Convergence) -> [Figure; 2] {
    let error = || Axis::log("|relative error| [-]");
    let title = format!("{name}: {}", finding.what);
    let mut by_resolution = Figure::new(title, Axis::log(format!("{} [-]", convergence.axis)), error());
    let mut by_time = Figure::new(format!("{name}: cost"), Axis::log("run time on one core [s]"), error());
    let points = |x: fn(&super::comparison::Point) -> f64| {
        convergence.points.iter().map(|p| [x(p), p.error.abs()]).collect::<Vec<_>>()
    };
    by_resolution.series.push(Series::new("error", Mark::LineAndPoints, points(|p| p.resolution)));
    by_time.series.push(Series::new("", Mark::LineAndPoints, points(|p| p.spent.wall_s)));
    if let (Some(order), Some(last)) = (finding.order, convergence.points.last()) {
        by_resolution.slopes.push(Slope {
            order: order.theory,
            through: [last.resolution, last.error.abs()],
            name: format!("order {:.3}", order.theory).trim_end_matches('0').trim_end_matches('.').into(),
        });
    }
    let target = finding.allowed.iter().map(|limit| limit.abs()).fold(0.0, f64::max);
    // The target is for the finding: where that is extrapolated, or of another quantity, no point has to meet it.
    let finest = convergence.points.last().is_some_and(|p| (p.error - finding.error()).abs() < 1e-9);
    if finest && target.is_finite() && target > 0.0 {
        for figure in [&mut by_resolution, &mut by_time] {
            figure.limits.push(Limit { y: target, name: format!("target {} %", (100.0 * target) as f32) });
        }
    }
    [by_resolution, by_time]
}
