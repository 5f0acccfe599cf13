//! `accuracy.csv`: one line per run.

use super::columns::COLUMNS;
use super::errors::Errors;
use super::findings::Study;
use super::rows::{Row, RowParameter, Run};
use crate::base::error::Result;
use crate::study::column::{Column, Value, write_csv};
use std::path::Path;

/// A run and its row.
type Line<'a> = (&'a Row, &'a Run);

/// Writes the table. Cells of what is not known are empty.
///
/// # Errors
/// When the file cannot be written.
pub fn write(study: &Study, path: &Path) -> Result<()> {
    let lines: Vec<Line> = study.rows.iter().flat_map(|row| row.runs.iter().map(move |run| (row, run))).collect();
    write_csv(&columns(&study.layers()), &lines, path)
}

fn columns<'a>(layers: &[String]) -> Vec<Column<'a, Line<'a>>> {
    let parameter =
        |of: fn(&RowParameter) -> Value| move |(row, _): &Line<'a>| row.parameter.as_ref().map_or(Value::Missing, of);
    let yes = |yes: bool| if yes { "yes" } else { "no" };
    let mut columns = vec![
        Column::in_files("parameter", parameter(|own| own.name.into())),
        Column::in_files("key", parameter(|own| own.key.into())),
        Column::in_files("value", |(row, _): &Line<'a>| row.value.clone()),
        Column::in_files("number", parameter(|own| own.number.into())),
        Column::in_files("role", parameter(|own| own.role.word().into())),
        Column::in_files("default", move |(row, _): &Line<'a>| yes(row.parameter.is_none())),
        Column::in_files("seed", |(_, run): &Line<'a>| run.seed),
        Column::in_files("outcome", |(_, run): &Line<'a>| run.word()),
        Column::in_files("cause", |(_, run): &Line<'a>| run.cause()),
    ];
    columns.extend(COLUMNS.iter().map(|one| {
        let of = |(_, run): &Line<'a>| run.ran().map_or(Value::Missing, |run| one.column.value(run));
        Column::in_files(one.column.name.clone(), of)
    }));
    let errors = |of: Box<dyn Fn(&Errors) -> Value + Send + Sync + 'a>| {
        move |(_, run): &Line<'a>| run.ran().and_then(|run| run.errors.as_ref()).map_or(Value::Missing, &of)
    };
    let same = move |errors: &Errors| errors.same_first_wire.map(yes).into();
    columns.push(Column::in_files("same_first_wire", errors(Box::new(same))));
    let worst = |errors: &Errors| errors.worst_layer().map(|(_, error)| error).into();
    columns.push(Column::in_files("worst_layer_error_percent", errors(Box::new(worst))));
    for (k, layer) in layers.iter().enumerate() {
        let of_layer = move |errors: &Errors| errors.layers_percent.get(k).copied().flatten().into();
        columns.push(Column::in_files(format!("layer_error_percent:{layer}"), errors(Box::new(of_layer))));
    }
    columns
}
