//! `accuracy.csv`: one line per run.

use super::Study;
use super::columns::COLUMNS;
use super::rows::{Outcome, Row, Run};
use crate::base::error::{Error, Result};
use crate::observe::files::write_whole;
use std::path::Path;

/// What stands before the numbers of a run.
const BEFORE: [&str; 9] = ["knob", "key", "value", "number", "role", "default", "seed", "outcome", "cause"];

/// Writes the table. Cells of what is not known are empty.
///
/// # Errors
/// When the file cannot be written.
pub fn write(study: &Study, path: &Path) -> Result<()> {
    let layers = study.layers();
    let refuse = |e: csv::Error| Error::io("cannot write", path, std::io::Error::other(e));
    let mut writer = csv::Writer::from_writer(Vec::new());
    let numbers = COLUMNS.iter().map(|column| column.name);
    let head = BEFORE.into_iter().chain(numbers).chain(["same_first_wire", "worst_layer_error_percent"]);
    let of_layers = layers.iter().map(|layer| format!("layer_error_percent:{layer}"));
    writer.write_record(head.map(str::to_owned).chain(of_layers)).map_err(refuse)?;
    for row in &study.rows {
        for run in &row.runs {
            writer.write_record(cells(row, run, layers.len())).map_err(refuse)?;
        }
    }
    let bytes = writer.into_inner().map_err(|e| Error::io("cannot write", path, e.into_error()))?;
    write_whole(path, &bytes)
}

fn cells(row: &Row, run: &Run, layers: usize) -> Vec<String> {
    let knob = row.knob.as_ref();
    let text = |value: Option<&str>| value.unwrap_or("").to_string();
    let mut cells = vec![
        text(knob.map(|knob| knob.name)),
        text(knob.map(|knob| knob.key)),
        row.value.clone(),
        knob.and_then(|knob| knob.number).map_or(String::new(), |number| number.to_string()),
        text(knob.map(|knob| knob.role.word())),
        if knob.is_none() { "yes" } else { "no" }.into(),
        run.seed.to_string(),
        run.word().into(),
        text(run.cause().map(String::as_str)),
    ];
    let Outcome::Ran { measured, errors } = &run.outcome else {
        cells.resize(BEFORE.len() + COLUMNS.len() + 2 + layers, String::new());
        return cells;
    };
    let errors = errors.as_ref();
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    cells.extend(COLUMNS.iter().map(|column| number(column.of_run(measured, errors))));
    let same = errors.and_then(|errors| errors.same_first_wire);
    cells.push(same.map_or(String::new(), |same| if same { "yes" } else { "no" }.into()));
    cells.push(number(errors.and_then(|errors| errors.worst_layer()).map(|(_, error)| error)));
    let of_layer = |k: usize| errors.and_then(|errors| errors.layers_percent.get(k).copied().flatten());
    cells.extend((0..layers).map(|k| number(of_layer(k))));
    cells
}
