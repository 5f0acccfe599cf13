//! The tables of a study in files: `cases`, a line per case; `points`, means over seeds; `breaks`, what each layer did. As CSV,
//! where cells of what is not known are empty, and on demand as Parquet.

use super::super::breaks::{self, LayerBreaks};
use super::super::definition::Definition;
use super::super::gather::{CaseResult, Gathered, construction};
use super::super::quantity::{self, Quantity};
use crate::base::error::Result;
use crate::observe::column::{Cell, Kind};
use crate::study::column::{Column, TableSink, Value, write_csv};
use crate::study::statistics::Statistics;
use crate::study::tensile::TensileResult;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// Where tables go.
pub struct Files<'a> {
    /// The study's folder.
    pub folder: &'a Path,
    /// Name of the study.
    pub study: &'a str,
    /// Whether they are written as Parquet too.
    pub parquet: bool,
    /// The files written.
    pub written: Vec<PathBuf>,
}

impl TableSink for Files<'_> {
    fn take<R>(&mut self, name: &str, columns: &[Column<R>], rows: &[R]) -> Result<()> {
        let csv = self.folder.join(name).with_extension("csv");
        write_csv(columns, rows, &csv)?;
        self.written.push(csv);
        let file = self.folder.join(name).with_extension("parquet");
        // One that is there would otherwise tell what the CSV file does no more.
        if self.parquet || (cfg!(feature = "export") && file.is_file()) {
            parquet(&file, self.study, columns, rows)?;
            self.written.push(file);
        }
        Ok(())
    }
}

#[cfg(feature = "export")]
fn parquet<R>(path: &Path, study: &str, columns: &[Column<R>], rows: &[R]) -> Result<()> {
    crate::export::parquet_table::write_whole(path, &[("study", study.to_owned())], columns, rows)
}

#[cfg(not(feature = "export"))]
fn parquet<R>(_: &Path, _: &str, _: &[Column<R>], _: &[R]) -> Result<()> {
    crate::export::check(crate::export::Format::Parquet)
}

/// Hands all three tables to `sink`, under their names without `.csv`.
///
/// # Errors
/// What the sink says.
pub fn tables(definition: &Definition, gathered: &Gathered, sink: &mut impl TableSink) -> Result<()> {
    cases(definition, gathered, sink)?;
    points(definition, gathered, sink)?;
    breaks(definition, gathered, sink)
}

/// A line per case.
fn cases(definition: &Definition, gathered: &Gathered, sink: &mut impl TableSink) -> Result<()> {
    let mut columns: Vec<Column<CaseResult>> = vec![
        Column::in_files("case", |case: &CaseResult| case.number),
        Column::in_files("folder", |case: &CaseResult| case.folder.clone()),
        Column::in_files("outcome", |case: &CaseResult| case.word()),
        Column::in_files("cause", |case: &CaseResult| case.cause().map(str::to_owned)),
    ];
    columns.extend(levels(definition, |case: &CaseResult| case.point));
    columns.push(Column::in_files("seed", |case: &CaseResult| case.seed));
    columns.push(Column::in_files("construction", |case: &CaseResult| gathered.spec(case.point).map(construction)));
    let quantity = |quantity: &'static Quantity| {
        of_run(quantity.label(), &quantity.unit, move |run| quantity.value(run)).of_kind(quantity.kind)
    };
    columns.extend(quantity::ALL.iter().map(quantity));
    columns.extend([
        of_run("first layer", "", |run| run.breaks.first().map(|first| first.layer.clone())),
        of_run("first wire", "", |run| run.breaks.first().map(|first| first.wire)),
        of_run("first break z [mm]", "mm", |run| run.breaks.first().map(|first| first.rest_z_mm)),
        of_run("order of layers", "", |run| breaks::order(run).join(" ")),
        of_run("wires broken", "", |run| run.breaks.len()),
        of_run("wires", "", |run| run.wires),
        of_run("particles", "", |run| run.particles),
        of_run("steps", "", |run| run.steps),
        of_run("run time [s]", "s", |run| run.wall_s),
        of_run("CPU [s]", "s", |run| run.cpu_s),
        of_run("energy residual [%]", "%", |run| run.energy_residual_percent),
        of_run("kinetic/internal [-]", "-", |run| run.kinetic_over_internal),
    ]);
    sink.take("cases", &columns, &gathered.cases)
}

/// A column of what a case gave, in a unit, empty where it gave nothing.
fn of_run<'a, V: Cell>(
    name: impl Into<Cow<'a, str>>,
    unit: &'a str,
    of: impl Fn(&TensileResult) -> V + Send + Sync + 'a,
) -> Column<'a, CaseResult> {
    Column::described(name, unit, "", move |case: &CaseResult| case.result().map(&of))
}

/// A line per point and quantity: mean, standard deviation and interval over seeds.
fn points(definition: &Definition, gathered: &Gathered, sink: &mut impl TableSink) -> Result<()> {
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
    sink.take("points", &columns, &(0..definition.points.len()).flat_map(means).collect::<Vec<Mean>>())
}

/// A line per point and layer: when and where it broke, as frequencies over seeds.
fn breaks(definition: &Definition, gathered: &Gathered, sink: &mut impl TableSink) -> Result<()> {
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
        Column::described("wires broken [%]", "%", "", |(_, layer): &Layer| layer.broken_percent.map(|stat| stat.mean)),
        Column::in_files("runs with its first break in the middle third", |(_, layer): &Layer| layer.middle_third),
        Column::described("first break from mid-length [mm]", "mm", "", |(_, layer): &Layer| {
            layer.off_middle_mm.map(|stat| stat.mean)
        }),
    ]);
    sink.take("breaks", &columns, &layers)
}

/// A column per axis: numbers where its levels are, names otherwise.
fn levels<'a, R: 'a>(
    definition: &'a Definition,
    point: impl Fn(&R) -> usize + Copy + Send + Sync + 'a,
) -> Vec<Column<'a, R>> {
    let column = |(k, axis): (usize, &'a super::super::axis::Axis)| {
        let column = Column::described(axis.label(), &*axis.unit, "", move |result: &R| {
            let level = &axis.levels[definition.points[point(result)][k]];
            level.number.map_or_else(|| Value::from(&*level.name), Value::from)
        });
        column.of_kind(axis.is_numeric().then_some(Kind::Number))
    };
    definition.axes.iter().enumerate().map(column).collect()
}
