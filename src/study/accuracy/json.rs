//! `accuracy.json`: the study for programs, and the tables for the page.

use super::columns::Means;
use super::ensemble::{self, Quantity, Spread};
use super::rows::Row;
use super::table;
use super::{Study, reference::Along};
use crate::base::error::{Error, Result};
use crate::observe::files::write_whole;
use crate::study::table::Table;
use serde::Serialize;
use std::path::Path;

#[derive(Serialize)]
struct Document<'a> {
    scene: &'a str,
    command: &'a str,
    version: &'static str,
    seeds: &'a [u64],
    /// Whether bonds scatter, so that one run is one draw.
    scatter: bool,
    threads: usize,
    jobs: usize,
    interrupted: bool,
    reference: Reference<'a>,
    rows: Vec<RowOut<'a>>,
    left_out: Vec<String>,
    absent: Vec<Absent<'a>>,
    /// In words, for the page.
    summary: String,
    tables: [Table; 2],
}

#[derive(Serialize)]
struct Reference<'a> {
    kind: &'static str,
    words: &'a str,
    strength_mpa: f64,
    elongation_percent: f64,
    /// Of strength and elongation; 0 for a closed form.
    uncertainty_percent: [f64; 2],
    refinement: Vec<Refinement<'a>>,
}

#[derive(Serialize)]
struct Refinement<'a> {
    seed: u64,
    #[serde(flatten)]
    along: &'a Along,
}

#[derive(Serialize)]
struct Absent<'a> {
    parameter: &'a str,
    reason: &'a str,
}

/// Means over seeds.
#[derive(Serialize)]
struct RowOut<'a> {
    parameter: Option<&'a str>,
    key: Option<&'a str>,
    value: &'a str,
    number: Option<f64>,
    role: Option<&'a str>,
    default: bool,
    #[serde(flatten)]
    means: Means<'a>,
    /// Whether the error of the mean is told from scatter: of strength and of elongation.
    told_from_scatter: [Option<bool>; 2],
    /// Spread over seeds beside that of the scene as it stands: of strength and of elongation.
    spread: [Option<Spread>; 2],
    runs: Vec<RunOut<'a>>,
}

#[derive(Serialize)]
struct RunOut<'a> {
    seed: u64,
    outcome: &'a str,
    cause: Option<&'a str>,
    errors: Option<&'a super::errors::Errors>,
}

/// Writes the study; `command` is what the user typed.
///
/// # Errors
/// When the file cannot be written.
pub fn write(study: &Study, command: &str, path: &Path) -> Result<()> {
    let reference = &study.reference;
    let exact = reference.closed_form;
    let base = study.rows.iter().find(|row| row.parameter.is_none());
    let document = Document {
        scene: &study.scene,
        command,
        version: env!("CARGO_PKG_VERSION"),
        seeds: &study.seeds,
        scatter: study.scatter,
        threads: study.threads,
        jobs: study.jobs,
        interrupted: study.interrupted,
        reference: Reference {
            kind: if exact { "closed-form" } else { "refinement" },
            words: &reference.words,
            strength_mpa: reference.value[0],
            elongation_percent: reference.value[1],
            uncertainty_percent: if exact { [0.0; 2] } else { reference.uncertainty_percent },
            refinement: reference.along.iter().map(|(seed, along)| Refinement { seed: *seed, along }).collect(),
        },
        rows: study.rows.iter().map(|one| row(one, base)).collect(),
        left_out: table::left_out(study),
        absent: study.absent.iter().map(|(parameter, reason)| Absent { parameter, reason }).collect(),
        summary: summary(study),
        tables: [table::costs_and_errors(study), table::histories_and_checks(study)],
    };
    let text = serde_json::to_string_pretty(&document)
        .map_err(|e| Error::io("cannot write", path, std::io::Error::other(e)))?;
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

fn row<'a>(row: &'a Row, base: Option<&Row>) -> RowOut<'a> {
    let parameter = row.parameter.as_ref();
    RowOut {
        parameter: parameter.map(|parameter| parameter.name),
        key: parameter.map(|parameter| parameter.key),
        value: &row.value,
        number: parameter.and_then(|parameter| parameter.number),
        role: parameter.map(|parameter| parameter.role.word()),
        default: parameter.is_none(),
        means: Means(row),
        told_from_scatter: Quantity::ALL.map(|quantity| ensemble::mean_is_told(row, quantity)),
        spread: Quantity::ALL.map(|quantity| base.and_then(|base| ensemble::spread(row, base, quantity))),
        runs: row
            .runs
            .iter()
            .map(|run| RunOut {
                seed: run.seed,
                outcome: run.word(),
                cause: run.cause(),
                errors: run.ran().and_then(|run| run.errors.as_ref()),
            })
            .collect(),
    }
}
