//! What a study found, for people and for programs.

mod comparison;
mod effects;
mod files;
mod findings;
mod fits;
mod html;
mod plots;
mod tables;

pub use files::tables as data;
pub use findings::Findings;
pub use tables::{built, case_list};

use super::definition::Definition;
use super::gather::Gathered;
use crate::base::error::{Error, Result};
use crate::observe::files::write_whole;
use crate::run::folder::{STUDY, STUDY_PAGE};
use crate::study::table::Table;
use files::Files;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// All tables, in their order.
fn all_tables(definition: &Definition, gathered: &Gathered, findings: &Findings) -> Vec<Table> {
    let mut all = vec![tables::means(definition, gathered), tables::breaks(definition, gathered)];
    all.extend(comparison::tables(definition, findings));
    all.extend(fits::tables(definition, findings));
    all.extend(effects::tables(definition, findings));
    all
}

/// What a study found, as text.
pub fn to_text(definition: &Definition, gathered: &Gathered, findings: &Findings) -> String {
    let mut text = built(definition, gathered);
    for table in all_tables(definition, gathered, findings) {
        let _ = writeln!(text, "\n{}", table.to_text().trim_end());
    }
    let _ = write!(text, "\n{}{}", tables::frequencies(gathered), tables::state(definition, gathered));
    text
}

/// Writes everything into the study's folder, tables with `parquet` as Parquet too; `command` is what the user typed. Gives the
/// files.
///
/// # Errors
/// When the folder cannot be written.
pub fn write(
    definition: &Definition,
    gathered: &Gathered,
    findings: &Findings,
    command: &str,
    folder: &Path,
    parquet: bool,
) -> Result<Vec<PathBuf>> {
    let mut files = Files { folder, study: &definition.name, parquet, written: Vec::new() };
    files::tables(definition, gathered, &mut files)?;
    let tables = all_tables(definition, gathered, findings);
    let json = folder.join(STUDY);
    write_json(definition, gathered, findings, command, &json)?;
    let plots = plots::write(definition, gathered, findings, folder)?;
    let page = folder.join(STUDY_PAGE);
    let text = html::page(definition, gathered, &tables, &plots, command)?;
    write_whole(&page, &text)?;
    Ok(files.written.into_iter().chain([json]).chain(plots).chain([page]).collect())
}

/// `study.json`: the findings for programs; the numbers of cases stand in the tables beside it.
fn write_json(
    definition: &Definition,
    gathered: &Gathered,
    findings: &Findings,
    command: &str,
    path: &Path,
) -> Result<()> {
    let axes: Vec<_> = definition
        .axes
        .iter()
        .map(|axis| {
            let levels: Vec<&str> = axis.levels.iter().map(|level| level.name.as_str()).collect();
            serde_json::json!({ "name": axis.name, "key": axis.key, "unit": axis.unit, "levels": levels })
        })
        .collect();
    let point = |k: usize| {
        let stats: serde_json::Map<String, serde_json::Value> = definition
            .quantities
            .iter()
            .map(|quantity| (quantity.name.to_string(), serde_json::json!(gathered.stat(k, quantity))))
            .collect();
        serde_json::json!({
            "name": definition.point_name(k),
            "levels": definition.points[k],
            "quantities": stats,
            "breaks": super::breaks::layers(gathered, k),
        })
    };
    let document = serde_json::json!({
        "study": definition.name,
        "about": definition.about,
        "command": command,
        "version": env!("CARGO_PKG_VERSION"),
        "base": definition.base,
        "quality": definition.quality.word(),
        "seeds": definition.seeds,
        "axes": axes,
        "cases": { "all": gathered.cases.len(), "ran": gathered.ran(), "missing": gathered.missing() },
        "design_efficiency": definition.efficiency,
        "points": (0..definition.points.len()).map(point).collect::<Vec<_>>(),
        "comparison": findings.comparison,
        "trends": findings.trends,
        "fits": findings.fits,
        "effects": findings.effects,
    });
    let text = serde_json::to_string_pretty(&document)
        .map_err(|e| Error::io("cannot write", path, std::io::Error::other(e)))?;
    write_whole(path, &(text + "\n"))
}
