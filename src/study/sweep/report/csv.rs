//! `cases.csv`: a line per case; `points.csv`: means over seeds; `breaks.csv`: what each layer did. Cells of what is not
//! known are empty.

use super::super::breaks::{self, LayerBreaks};
use super::super::definition::Definition;
use super::super::gather::{CaseResult, Gathered, construction};
use super::super::quantity::{self, Quantity};
use crate::base::error::Result;
use crate::study::column::{Column, Value, write_csv};
use crate::study::statistics::Statistics;
use crate::study::tensile::TensileResult;
use std::path::Path;

/// A line per case.
///
/// # Errors
/// When the file cannot be written.
pub fn cases(definition: &Definition, gathered: &Gathered, path: &Path) -> Result<()> {
    let mut columns: Vec<Column<CaseResult>> = vec![
        Column::in_files("case", |case: &CaseResult| case.number),
        Column::in_files("folder", |case: &CaseResult| case.folder.clone()),
        Column::in_files("outcome", |case: &CaseResult| case.word()),
        Column::in_files("cause", |case: &CaseResult| case.cause().map(str::to_owned)),
    ];
    columns.extend(levels(definition, |case: &CaseResult| case.point));
    columns.push(Column::in_files("seed", |case: &CaseResult| case.seed));
    columns.push(Column::in_files("construction", |case: &CaseResult| gathered.spec(case.point).map(construction)));
    let quantity = |quantity: &'static Quantity| of_run(quantity.label(), move |run| quantity.value(run));
    columns.extend(quantity::ALL.iter().map(quantity));
    columns.extend([
        of_run("first layer", |run| run.breaks.first().map(|first| first.layer.clone()).into()),
        of_run("first wire", |run| run.breaks.first().map(|first| first.wire).into()),
        of_run("first break z [mm]", |run| run.breaks.first().map(|first| first.rest_z_mm).into()),
        of_run("order of layers", |run| breaks::order(run).join(" ").into()),
        of_run("wires broken", |run| run.breaks.len().into()),
        of_run("wires", |run| run.wires.into()),
        of_run("particles", |run| run.particles.into()),
        of_run("steps", |run| run.steps.into()),
        of_run("run time [s]", |run| run.wall_s.into()),
        of_run("CPU [s]", |run| run.cpu_s.into()),
        of_run("energy residual [%]", |run| run.energy_residual_percent.into()),
        of_run("kinetic/internal [-]", |run| run.kinetic_over_internal.into()),
    ]);
    write_csv(&columns, &gathered.cases, path)
}

/// A column of what a case gave, empty where it gave nothing.
fn of_run<'a>(
    name: impl Into<std::borrow::Cow<'a, str>>,
    of: impl Fn(&TensileResult) -> Value + Send + Sync + 'a,
) -> Column<'a, CaseResult> {
    Column::in_files(name, move |case: &CaseResult| case.result().map_or(Value::Missing, &of))
}

/// A line per point and quantity: mean, standard deviation and interval over seeds.
///
/// # Errors
/// When the file cannot be written.
pub fn points(definition: &Definition, gathered: &Gathered, path: &Path) -> Result<()> {
    type Mean = (usize, &'static Quantity, Statistics);
    let mut columns: Vec<Column<Mean>> = levels(definition, |(point, ..): &Mean| *point);
    columns.extend([
        Column::in_files("construction", |(point, ..): &Mean| gathered.spec(*point).map(construction)),
        Column::in_files("quantity", |(_, quantity, _): &Mean| &*quantity.heading),
        Column::in_files("unit", |(_, quantity, _): &Mean| &*quantity.unit),
        Column::in_files("mean", |(.., stat): &Mean| stat.mean),
        Column::in_files("standard deviation", |(.., stat): &Mean| stat.standard_deviation),
        Column::in_files("interval 95 %", |(.., stat): &Mean| stat.interval_95),
        Column::in_files("runs", |(.., stat): &Mean| stat.count),
    ]);
    let means = |point: usize| {
        definition.quantities.iter().filter_map(move |one| Some((point, *one, gathered.stat(point, one)?)))
    };
    write_csv(&columns, &(0..definition.points.len()).flat_map(means).collect::<Vec<Mean>>(), path)
}

/// A line per point and layer: when and where it broke, as frequencies over seeds.
///
/// # Errors
/// When the file cannot be written.
pub fn breaks(definition: &Definition, gathered: &Gathered, path: &Path) -> Result<()> {
    type Layer = (usize, LayerBreaks);
    let of_point = |point: usize| breaks::layers(gathered, point).into_iter().map(move |layer| (point, layer));
    let layers: Vec<Layer> = (0..definition.points.len()).flat_map(of_point).collect();
    let most = layers.iter().map(|(_, layer)| layer.places.len()).max().unwrap_or(0);
    let mut columns: Vec<Column<Layer>> = levels(definition, |(point, _): &Layer| *point);
    columns.extend([
        Column::in_files("layer", |(_, layer): &Layer| layer.layer.clone()),
        Column::in_files("wires", |(_, layer): &Layer| layer.wires),
        Column::in_files("runs", |(point, _): &Layer| gathered.runs(*point).count()),
    ]);
    columns.extend((0..most).map(|place| {
        let name = format!("runs as layer {} to break", place + 1);
        Column::in_files(name, move |(_, layer): &Layer| layer.places.get(place).copied())
    }));
    columns.extend([
        Column::in_files("runs unbroken", |(_, layer): &Layer| layer.never),
        Column::in_files("wires broken [%]", |(_, layer): &Layer| layer.broken_percent.map(|stat| stat.mean)),
        Column::in_files("runs with its first break in the middle third", |(_, layer): &Layer| layer.middle_third),
        Column::in_files("first break from mid-length [mm]", |(_, layer): &Layer| {
            layer.off_middle_mm.map(|stat| stat.mean)
        }),
    ]);
    write_csv(&columns, &layers, path)
}

/// A column per axis: numbers where its levels are, names otherwise.
fn levels<'a, R: 'a>(
    definition: &'a Definition,
    point: impl Fn(&R) -> usize + Copy + Send + Sync + 'a,
) -> Vec<Column<'a, R>> {
    let column = |(k, axis): (usize, &'a super::super::axis::Axis)| {
        Column::in_files(axis.label(), move |result: &R| {
            let level = &axis.levels[definition.points[point(result)][k]];
            level.number.map_or_else(|| Value::from(&*level.name), Value::from)
        })
    };
    definition.axes.iter().enumerate().map(column).collect()
}
