//! `cases.csv`: a line per case; `points.csv`: means over seeds; `breaks.csv`: what each layer did. Cells of what is not
//! known are empty.

use super::super::breaks;
use super::super::definition::Definition;
use super::super::gather::{CaseResult, Gathered, construction};
use super::super::quantity;
use crate::base::error::{Error, Result};
use crate::observe::files::write_whole;
use std::path::Path;

/// A line per case.
///
/// # Errors
/// When the file cannot be written.
pub fn cases(definition: &Definition, gathered: &Gathered, path: &Path) -> Result<()> {
    let axes = definition.axes.iter().map(|axis| axis.label());
    let quantities = quantity::ALL.iter().map(|quantity| quantity.label_and_unit());
    let head = ["case", "folder", "outcome", "cause"].map(String::from).into_iter().chain(axes);
    let head = head.chain(["seed", "construction"].map(String::from)).chain(quantities).chain(
        [
            "first layer",
            "first wire",
            "first break z [mm]",
            "order of layers",
            "wires broken",
            "wires",
            "particles",
            "steps",
        ]
        .map(String::from),
    );
    let head = head.chain(["run time [s]", "CPU [s]", "energy residual [%]", "kinetic/internal [-]"].map(String::from));
    let rows = gathered.cases.iter().map(|case| row(definition, gathered, case));
    write(path, head.collect(), rows.collect())
}

fn row(definition: &Definition, gathered: &Gathered, case: &CaseResult) -> Vec<String> {
    let mut cells = vec![
        case.number.to_string(),
        case.folder.clone(),
        case.state.word().to_string(),
        case.state.cause().unwrap_or("").to_string(),
    ];
    cells.extend(levels(definition, case.point));
    cells.push(case.seed.to_string());
    cells.push(gathered.spec(case.point).map_or(String::new(), construction));
    let Some(run) = case.measured() else { return cells };
    cells.extend(quantity::ALL.iter().map(|quantity| number((quantity.of)(run))));
    let first = run.breaks.first();
    cells.extend([
        first.map_or(String::new(), |one| one.layer.clone()),
        first.map_or(String::new(), |one| one.wire.to_string()),
        number(first.map(|one| one.rest_z_mm)),
        breaks::order(run).join(" "),
        run.breaks.len().to_string(),
        run.wires.to_string(),
        run.particles.to_string(),
        run.steps.to_string(),
        run.wall_s.to_string(),
        number(run.cpu_s),
        number(run.energy_residual_percent),
        number(run.kinetic_over_internal),
    ]);
    cells
}

/// A line per point and quantity: mean, standard deviation and interval over seeds.
///
/// # Errors
/// When the file cannot be written.
pub fn points(definition: &Definition, gathered: &Gathered, path: &Path) -> Result<()> {
    let axes = definition.axes.iter().map(|axis| axis.label());
    let head = axes.chain(
        ["construction", "quantity", "unit", "mean", "standard deviation", "interval 95 %", "runs"].map(String::from),
    );
    let mut rows = Vec::new();
    for point in 0..definition.points.len() {
        let built = gathered.spec(point).map_or(String::new(), construction);
        for quantity in &definition.quantities {
            let Some(stat) = gathered.stat(point, quantity) else { continue };
            let mut cells = levels(definition, point);
            cells.extend([
                built.clone(),
                quantity.label.to_string(),
                quantity.unit.to_string(),
                stat.mean.to_string(),
                number(stat.standard_deviation),
                number(stat.interval_95),
                stat.count.to_string(),
            ]);
            rows.push(cells);
        }
    }
    write(path, head.collect(), rows)
}

/// A line per point and layer: when and where it broke, as frequencies over seeds.
///
/// # Errors
/// When the file cannot be written.
pub fn breaks(definition: &Definition, gathered: &Gathered, path: &Path) -> Result<()> {
    let layers: Vec<_> = (0..definition.points.len()).map(|point| breaks::layers(gathered, point)).collect();
    let most = layers.iter().map(Vec::len).max().unwrap_or(0);
    let axes = definition.axes.iter().map(|axis| axis.label());
    let head = axes.chain(["layer", "wires", "runs"].map(String::from));
    let head = head.chain((1..=most).map(|place| format!("runs as layer {place} to break")));
    let head = head.chain(
        [
            "runs unbroken",
            "wires broken [%]",
            "runs with its first break in the middle third",
            "first break from mid-length [mm]",
        ]
        .map(String::from),
    );
    let mut rows = Vec::new();
    for (point, layers) in layers.iter().enumerate() {
        for layer in layers {
            let mut cells = levels(definition, point);
            cells.extend([layer.layer.clone(), layer.wires.to_string(), gathered.runs(point).count().to_string()]);
            cells.extend((0..most).map(|place| layer.places.get(place).map_or(String::new(), usize::to_string)));
            cells.extend([
                layer.never.to_string(),
                number(layer.broken_percent.map(|stat| stat.mean)),
                layer.middle_third.to_string(),
                number(layer.off_middle_mm.map(|stat| stat.mean)),
            ]);
            rows.push(cells);
        }
    }
    write(path, head.collect(), rows)
}

/// The levels of a point: numbers where they are, names otherwise.
fn levels(definition: &Definition, point: usize) -> Vec<String> {
    let cell = |(_, level): (_, &super::super::axis::Level)| {
        level.number.map_or_else(|| level.name.clone(), |number| number.to_string())
    };
    definition.levels(point).map(cell).collect()
}

fn number(value: Option<f64>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}

/// Writes a table whose rows may be shorter than its head.
fn write(path: &Path, head: Vec<String>, rows: Vec<Vec<String>>) -> Result<()> {
    let refuse = |e: csv::Error| Error::io("cannot write", path, std::io::Error::other(e));
    let mut writer = csv::Writer::from_writer(Vec::new());
    let width = head.len();
    writer.write_record(head).map_err(refuse)?;
    for mut row in rows {
        row.resize(width, String::new());
        writer.write_record(row).map_err(refuse)?;
    }
    let bytes = writer.into_inner().map_err(|e| Error::io("cannot write", path, e.into_error()))?;
    write_whole(path, &bytes)
}
