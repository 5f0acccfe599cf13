//! `accuracy.json`: the study for programs, and the tables for the page.

use super::columns::COLUMNS;
use super::ensemble::{self, QUANTITIES};
use super::findings::Study;
use super::reference::Along;
use super::rows::{Row, Run};
use super::table;
use crate::base::error::Result;
use crate::observe::files::write_whole;
use serde_json::{Value, json};
use std::path::Path;

/// Writes the study; `command` is what the user typed.
///
/// # Errors
/// When the file cannot be written.
pub fn write(study: &Study, command: &str, path: &Path) -> Result<()> {
    let reference = &study.reference;
    let exact = reference.closed_form;
    let base = study.rows.iter().find(|row| row.parameter.is_none());
    let refinement = |(seed, along): &(u64, Along)| {
        let mut one = json!(along);
        one["seed"] = json!(seed);
        one
    };
    let document = json!({
        "scene": study.scene,
        "command": command,
        "version": env!("CARGO_PKG_VERSION"),
        "seeds": study.seeds,
        // Whether bonds scatter, so that one run is one draw.
        "scatter": study.scatter,
        "threads": study.threads,
        "jobs": study.jobs,
        "interrupted": study.interrupted,
        "reference": {
            "kind": if exact { "closed-form" } else { "refinement" },
            "words": reference.words,
            "strength_mpa": reference.value[0],
            "elongation_percent": reference.value[1],
            // Of strength and elongation; 0 for a closed form.
            "uncertainty_percent": if exact { [0.0; 2] } else { reference.uncertainty_percent },
            "refinement": reference.along.iter().map(refinement).collect::<Vec<_>>(),
        },
        "rows": study.rows.iter().map(|one| row(one, base)).collect::<Vec<_>>(),
        "left_out": table::left_out(study),
        "absent": study.absent.iter().map(|(name, reason)| json!({ "parameter": name, "reason": reason })).collect::<Vec<_>>(),
        // In words, for the page.
        "summary": summary(study),
        "tables": [table::costs_and_errors(study), table::histories_and_checks(study)],
    });
    let text = serde_json::to_string_pretty(&document).expect("a study holds nothing that JSON lacks");
    write_whole(path, &(text + "\n"))
}

/// What stands below the tables.
fn summary(study: &Study) -> String {
    let mut lines = vec![table::reference(&study.reference, study.seeds.len()).trim_end().to_string()];
    lines.extend(table::scatter(study));
    lines.extend(table::failed(study));
    let left_out = table::left_out(study);
    if !left_out.is_empty() {
        lines.push(format!("The budget had no room for {}.", left_out.join("; ")));
    }
    lines.extend(table::caution(study));
    lines.join("\n")
}

/// Means over seeds, what scatter leaves open of them, and the runs.
fn row(row: &Row, base: Option<&Row>) -> Value {
    let own = row.parameter.as_ref();
    let run = |run: &Run| {
        let errors = run.ran().and_then(|run| run.errors.as_ref());
        json!({ "seed": run.seed, "outcome": run.word(), "cause": run.cause(), "errors": errors })
    };
    let mut object = json!({
        "parameter": own.map(|own| own.name),
        "key": own.map(|own| own.key),
        "value": row.value,
        "number": own.and_then(|own| own.number),
        "role": own.map(|own| own.role.word()),
        "default": own.is_none(),
        // Whether the error of the mean is told from scatter: of strength and of elongation.
        "told_from_scatter": QUANTITIES.each_ref().map(|quantity| ensemble::mean_is_told(row, quantity)),
        // Spread over seeds beside that of the scene as it stands: of strength and of elongation.
        "spread": QUANTITIES.each_ref().map(|quantity| base.and_then(|base| ensemble::spread(row, base, quantity))),
        "runs": row.runs.iter().map(run).collect::<Vec<_>>(),
    });
    for column in COLUMNS.iter() {
        object[&*column.column.name] = json!(column.of_row(row));
    }
    object
}
