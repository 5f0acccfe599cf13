//! Figures of a study: stress-strain curves overlaid, strength and elongation over the axis beside published results and theory.

use super::super::axis::Axis as StudyAxis;
use super::super::comparison::{self, PointComparison, QUANTITIES};
use super::super::definition::Definition;
use super::super::gather::Gathered;
use super::super::quantity::{self, Quantity};
use super::findings::Findings;
use crate::base::error::Result;
use crate::study::plot::{self, Axis, Figure, Legend, Mark, Series};
use crate::study::tensile::Curve;
use std::path::{Path, PathBuf};

/// Size of a figure with its legend beside it (px of an SVG).
const SIZE: [u32; 2] = [860, 480];
/// Most curves that are named one by one.
const MOST_NAMED: usize = 16;
/// A curve is drawn with points this far apart at least, over its extent (-).
const RESOLUTION: f64 = 0.002;
/// Points of a fitted curve.
const FINE: usize = 200;

/// Writes all figures of the study as SVG and PNG. Gives the files, SVG before PNG.
///
/// # Errors
/// When the folder cannot be written.
pub fn write(definition: &Definition, gathered: &Gathered, findings: &Findings, folder: &Path) -> Result<Vec<PathBuf>> {
    let mut sheets = vec![("curves", vec![curves(definition, gathered)])];
    if let Some(axis) = definition.abscissa() {
        let trends = QUANTITIES.iter().map(|name| trend(definition, gathered, findings, axis, name));
        sheets.push(("trends", trends.collect()));
    } else if definition.points.len() == 1 && definition.seeds.len() > 1 {
        sheets.push(("scatter", vec![scatter(definition, gathered, findings)]));
    }
    sheets.extend(super::effects::figures(definition, findings));
    let mut files = Vec::new();
    for (name, figures) in sheets {
        files.extend(plot::write_pair(&figures, 1, folder, name)?);
    }
    Ok(files)
}

/// Stress over strain: one curve per point, or per seed when there is one point.
fn curves(definition: &Definition, gathered: &Gathered) -> Figure {
    let seeds = definition.points.len() == 1;
    let mut figure = Figure::new(
        format!("{}: stress over strain{}", definition.name, if seeds { "" } else { ", first seed" }),
        Axis::linear("strain [%]"),
        Axis::linear("nominal stress [MPa]"),
    );
    figure.size = SIZE;
    figure.legend = Legend::Beside;
    let shown: Vec<_> = if seeds {
        gathered.cases.iter().filter_map(|case| Some((case, case.result()?))).collect()
    } else {
        let first = |point| gathered.cases.iter().find(|case| case.point == point && case.result().is_some());
        (0..definition.points.len())
            .filter_map(|point| first(point).and_then(|case| Some((case, case.result()?))))
            .collect()
    };
    let count = shown.len();
    let by_level = !seeds && count > MOST_NAMED;
    let mut named = Vec::new();
    for (k, (case, measured)) in shown.into_iter().enumerate() {
        let (name, shade) = if by_level {
            // So many curves are told apart by the first axis only.
            let (axis, level) = definition.levels(case.point).next().expect("several points have an axis");
            let place = definition.points[case.point][0] as f64 / (axis.levels.len().max(2) - 1) as f64;
            (format!("{} {}", axis.name, level.name), place)
        } else {
            let name = if seeds { format!("seed {}", case.seed) } else { definition.point_name(case.point) };
            (name, k as f64 / (count.max(2) - 1) as f64)
        };
        let name = if named.contains(&name) { String::new() } else { name };
        named.push(name.clone());
        figure.series.push(Series::new(name, Mark::Line, thinned(&measured.curve)).shaded(shade));
    }
    figure
}

/// Strain (%) and stress (MPa) of a curve, without points that lie on top of each other at the size of a figure.
fn thinned(curve: &Curve) -> Vec<[f64; 2]> {
    let all = curve.strain.iter().zip(&curve.stress_mpa).map(|(strain, stress)| [100.0 * strain, *stress]);
    let (wide, high) = (100.0 * curve.end(), curve.stress_mpa.iter().fold(0.0f64, |most, s| most.max(s.abs())));
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for point in all {
        let far = |last: &[f64; 2]| {
            (point[0] - last[0]).abs() > RESOLUTION * wide || (point[1] - last[1]).abs() > RESOLUTION * high
        };
        if kept.last().is_none_or(far) {
            kept.push(point);
        }
    }
    kept
}

/// A quantity over the axis, with error bars, beside published results and theory, and the fitted curve.
fn trend(definition: &Definition, gathered: &Gathered, findings: &Findings, axis: &StudyAxis, name: &str) -> Figure {
    let k = QUANTITIES.iter().position(|known| *known == name).expect("it is one of them");
    let quantity = quantity::find(name).expect("strength and elongation are always there");
    let mut figure = Figure::new(
        format!("{}: {} over {}", definition.name, quantity.heading, axis.name),
        Axis::linear(axis.label()),
        Axis::linear(quantity.label()),
    );
    figure.size = SIZE;
    figure.legend = Legend::Beside;
    let (points, errors) = means(definition, gathered, axis, quantity);
    let interval = if definition.seeds.len() > 1 { ", mean and 95 % interval" } else { "" };
    figure.series.push(Series::new(format!("this engine{interval}"), Mark::Points, points).with_errors(errors));
    let ends = [axis.levels[0].number, axis.levels[axis.levels.len() - 1].number].map(|end| end.unwrap_or(0.0));
    let curve = |value: &dyn Fn(f64) -> f64| -> Vec<[f64; 2]> {
        let x = |i: usize| ends[0] + (ends[1] - ends[0]) * i as f64 / (FINE - 1) as f64;
        (0..FINE).map(|i| [x(i), value(x(i))]).collect()
    };
    let fitted = findings.exponential(name).map_or(Vec::new(), |fit| curve(&|x| fit.value(x)));
    push(&mut figure, "A exp(B x) + C through it", Mark::Line, fitted);
    let of = |value: fn(&PointComparison) -> Option<[f64; 2]>| -> Vec<[f64; 2]> {
        let at = |one: &PointComparison| Some([axis.levels[definition.points[one.point][0]].number?, value(one)?[k]]);
        findings.comparison.iter().filter_map(at).collect()
    };
    let (paper, theory, tested) = (of(|one| one.simulation), of(|one| one.theory), of(|one| one.experiment));
    let printed = comparison::fitted_over(definition, axis, name).filter(|_| !paper.is_empty());
    let printed = printed.map_or(Vec::new(), |fit| curve(&|x| fit.value(x)));
    for (words, mark, points) in [
        ("the paper's simulations", Mark::Points, paper),
        ("the paper's curve", Mark::Dashed, printed),
        ("strand theory", Mark::LineAndPoints, theory),
        ("the experiment, calibrated on", Mark::Points, tested),
    ] {
        push(&mut figure, words, mark, points);
    }
    figure
}

/// Adds a series; one without points keeps its place, so that colours mean the same in every figure, but has no name.
fn push(figure: &mut Figure, name: &str, mark: Mark, points: Vec<[f64; 2]>) {
    let name = if points.is_empty() { "" } else { name };
    figure.series.push(Series::new(name, mark, points));
}

/// Means of a quantity over the axis, and half their intervals.
fn means(
    definition: &Definition,
    gathered: &Gathered,
    axis: &StudyAxis,
    quantity: &Quantity,
) -> (Vec<[f64; 2]>, Vec<f64>) {
    let at = |point: usize| {
        let stat = gathered.stat(point, quantity)?;
        let x = axis.levels[definition.points[point][0]].number?;
        Some(([x, stat.mean], stat.interval_95.unwrap_or(0.0)))
    };
    (0..definition.points.len()).filter_map(at).unzip()
}

/// Strength over elongation, one point per seed, beside the published ones.
fn scatter(definition: &Definition, gathered: &Gathered, findings: &Findings) -> Figure {
    let mut figure = Figure::new(
        format!("{}: strength over elongation, seed by seed", definition.name),
        Axis::linear("elongation [%]"),
        Axis::linear("strength [MPa]"),
    );
    figure.size = SIZE;
    figure.legend = Legend::Beside;
    let runs = gathered.runs(0).map(|run| [run.elongation_percent, run.strength_mpa]).collect();
    figure.series.push(Series::new("this engine, one seed each", Mark::Points, runs));
    if let Some(first) = findings.comparison.first() {
        for (name, value) in
            [("the paper's simulation", first.simulation), ("the experiment, calibrated on", first.experiment)]
        {
            let point = value.map(|[strength, elongation]| [elongation, strength]);
            push(&mut figure, name, Mark::Points, point.into_iter().collect());
        }
    }
    figure
}
