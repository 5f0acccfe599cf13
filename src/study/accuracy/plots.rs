//! Error over run time, parameter by parameter, with the front of what cannot be had both faster and more exact.

use super::errors::Errors;
use super::findings::Study;
use super::parameters::Role;
use super::pareto::staircase;
use super::rows::Row;
use crate::base::error::Result;
use crate::base::wording::counted;
use crate::study::plot::{self, Axis, Figure, Highlight, Legend, Limit, Mark, Series};
use crate::study::statistics::Statistics;
use std::path::{Path, PathBuf};

/// Of each figure (px of an SVG).
const SIZE: [u32; 2] = [900, 520];

/// Writes `accuracy.svg` and `accuracy.png` into `folder`. Gives the files.
///
/// # Errors
/// When the folder cannot be written.
pub fn write(study: &Study, folder: &Path) -> Result<Vec<PathBuf>> {
    let figures = [
        figure(study, "strength", 0, |errors| errors.strength_percent),
        figure(study, "elongation", 1, |errors| errors.elongation_percent),
    ];
    plot::write_pair(&figures, 1, folder, "accuracy")
}

/// A row as it is drawn: time (s), size of the error and half the height of its bar (%).
fn point(study: &Study, row: &Row, error: fn(&Errors) -> f64) -> Option<([f64; 2], f64)> {
    let time = row.of_runs(|run| if on_one_core(study) { run.cpu_s } else { Some(run.wall_s) })?;
    let Statistics { mean, interval_95, .. } = row.of_errors(|errors| Some(error(errors)))?;
    Some(([time.mean, mean.abs()], interval_95.unwrap_or(0.0)))
}

/// Whether processor time is shown: on one thread it is the run time on an idle machine, whatever else this one did.
fn on_one_core(study: &Study) -> bool {
    study.threads == 1 && study.rows.iter().all(|row| row.ran().all(|run| run.result.cpu_s.is_some()))
}

fn figure(study: &Study, quantity: &str, which: usize, error: fn(&Errors) -> f64) -> Figure {
    let time = match on_one_core(study) {
        true => "processor time on one core [s]".to_string(),
        false => format!("run time on {} [s]", counted(study.threads, "thread")),
    };
    let title = format!("{}: error of {quantity} against run time", study.scene);
    let mut figure = Figure::new(title, Axis::log(time), Axis::log(format!("|error of {quantity}| [%]")));
    figure.size = SIZE;
    figure.legend = Legend::Beside;
    for parameter in study.parameters() {
        let rows = study.path(parameter);
        let points: Vec<([f64; 2], f64)> = rows.iter().filter_map(|row| point(study, row, error)).collect();
        let joined = rows.iter().any(|row| row.parameter.as_ref().is_some_and(|k| matches!(k.role, Role::Refines)));
        let other = rows.iter().any(|row| row.is_other_model());
        // One without points keeps its place, so that colours stay with their parameters, but not its line in the legend.
        let name = match (points.is_empty(), other) {
            (true, _) => String::new(),
            (_, true) => format!("{parameter} (other model)"),
            (_, false) => parameter.to_string(),
        };
        let mut series = Series::new(
            name,
            if joined { Mark::LineAndPoints } else { Mark::Points },
            points.iter().map(|(at, _)| *at).collect(),
        );
        if study.seeds.len() > 1 {
            series.errors = points.iter().map(|(_, half)| *half).collect();
        }
        figure.series.push(series);
    }
    figure.series.extend(front_of(study, error));
    if let Some((at, _)) =
        study.rows.iter().find(|row| row.parameter.is_none()).and_then(|row| point(study, row, error))
    {
        figure.series.push(Series::new("", Mark::Points, vec![at]));
        figure.highlights.push(Highlight { at, name: "the scene as it stands".into() });
    }
    let sure = study.reference.uncertainty_percent[which];
    if !study.reference.closed_form && sure > 0.0 {
        figure.limits.push(Limit { y: sure, name: "uncertainty of the reference".into() });
    }
    figure
}

/// Other models have no error, so they do not compete.
fn front_of(study: &Study, error: fn(&Errors) -> f64) -> Option<Series> {
    let rows = study.rows.iter().filter(|row| !row.is_other_model());
    let points: Vec<[f64; 2]> = rows.filter_map(|row| point(study, row, error)).map(|(at, _)| at).collect();
    let line = staircase(&points);
    (!line.is_empty()).then(|| Series::new("best found (Pareto front)", Mark::Behind, line))
}

impl Study {
    /// Names of the parameters that were varied, in the order of the rows.
    fn parameters(&self) -> Vec<&'static str> {
        let mut names: Vec<&str> =
            self.rows.iter().filter_map(|row| row.parameter.as_ref()).map(|parameter| parameter.name).collect();
        names.dedup();
        names
    }

    /// The rows of a parameter; where it refines, by rising value, the scene as it stands in its place among them.
    fn path(&self, parameter: &str) -> Vec<&Row> {
        let mut rows: Vec<&Row> =
            self.rows.iter().filter(|row| row.parameter.as_ref().is_some_and(|k| k.name == parameter)).collect();
        let turn = rows.first().and_then(|row| row.parameter.as_ref());
        if let (Some(Role::Refines), Some(own)) =
            (turn.map(|turn| turn.role), turn.and_then(|turn| turn.default_number))
        {
            let number = |row: &&Row| row.parameter.as_ref().and_then(|k| k.number).unwrap_or(own);
            rows.extend(self.rows.iter().filter(|row| row.parameter.is_none()));
            rows.sort_by(|a, b| number(a).total_cmp(&number(b)));
        }
        rows
    }
}
