//! `accuracy.csv`: one line per run.

use super::Study;
use super::rows::{Outcome, Row, Run};
use crate::base::error::{Error, Result};
use crate::observe::files::write_whole;
use std::path::Path;

const HEAD: [&str; 27] = [
    "knob",
    "key",
    "value",
    "number",
    "role",
    "default",
    "seed",
    "outcome",
    "cause",
    "wall_s",
    "cpu_s",
    "steps",
    "ms_per_step",
    "particles",
    "strength_mpa",
    "strength_error_percent",
    "elongation_percent",
    "elongation_error_percent",
    "curve_error_percent",
    "plastic_work_error_percent",
    "same_first_wire",
    "first_break_off_mm",
    "order_tau",
    "energy_residual_percent",
    "kinetic_over_internal",
    "grip_mismatch_percent",
    "worst_layer_error_percent",
];

/// Writes the table. Cells of what is not known are empty.
///
/// # Errors
/// When the file cannot be written.
pub fn write(study: &Study, path: &Path) -> Result<()> {
    let layers = study.layers();
    let refuse = |e: csv::Error| Error::io("cannot write", path, std::io::Error::other(e));
    let mut writer = csv::Writer::from_writer(Vec::new());
    let head = HEAD.iter().map(|name| name.to_string());
    let of_layers = layers.iter().map(|layer| format!("layer_error_percent:{layer}"));
    writer.write_record(head.chain(of_layers)).map_err(refuse)?;
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
        cells.resize(HEAD.len() + layers, String::new());
        return cells;
    };
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    let error = |value: &dyn Fn(&super::errors::Errors) -> Option<f64>| number(errors.as_ref().and_then(value));
    let same = errors.as_ref().and_then(|errors| errors.same_first_wire);
    cells.extend([
        measured.wall_s.to_string(),
        number(measured.cpu_s),
        measured.steps.to_string(),
        number(measured.ms_per_step),
        measured.particles.to_string(),
        measured.strength_mpa.to_string(),
        error(&|e| Some(e.strength_percent)),
        measured.elongation_percent.to_string(),
        error(&|e| Some(e.elongation_percent)),
        error(&|e| e.curve_percent),
        error(&|e| e.plastic_work_percent),
        same.map_or(String::new(), |same| if same { "yes" } else { "no" }.into()),
        error(&|e| e.first_break_off_mm),
        error(&|e| e.order_tau),
        number(measured.energy_residual_percent),
        number(measured.kinetic_over_internal),
        number(measured.grip_mismatch_percent),
        error(&|e| e.worst_layer().map(|(_, error)| error)),
    ]);
    cells.extend((0..layers).map(|k| error(&|e| e.layers_percent.get(k).copied().flatten())));
    cells
}
