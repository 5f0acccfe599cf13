//! The page of a study: one file that holds figures, tables and how it was made.

use super::super::definition::Definition;
use super::super::gather::Gathered;
use super::tables;
use crate::base::error::{Error, Result};
use crate::page::{Section, document};
use crate::study::table::Table;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};
use std::path::{Path, PathBuf};

/// The page; `plots` are the study's figures, of which those in SVG are taken.
///
/// # Errors
/// When a figure cannot be read.
pub fn page(
    definition: &Definition,
    gathered: &Gathered,
    all: &[Table],
    plots: &[PathBuf],
    command: &str,
) -> Result<String> {
    let sections = [
        Section { id: "figures", title: "Figures", body: figures(plots)? },
        Section {
            id: "tables",
            title: "Tables",
            body: html! { p { (tables::frequencies(gathered)) } @for table in all { div.scroll { (cells(table)) } } },
        },
        Section { id: "cases", title: "Cases", body: cases(definition, gathered, command) },
    ];
    Ok(document::plain(&definition.name, &definition.about, &sections).into_string())
}

fn figures(plots: &[PathBuf]) -> Result<Markup> {
    let mut body = Vec::new();
    for path in plots.iter().filter(|path| path.extension().is_some_and(|end| end == "svg")) {
        let text = std::fs::read(path).map_err(|e| Error::io("cannot read", path, e))?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        // As an image, so that nothing in the file can run.
        body.push(html! { img.study alt=(name) src={ "data:image/svg+xml;base64," (STANDARD.encode(text)) }; });
    }
    Ok(html! { @for figure in body { (figure) } })
}

fn cells(table: &Table) -> Markup {
    html! {
        table {
            caption { (table.title) }
            thead { tr { @for head in &table.heads { th { (head) } } } }
            tbody { @for row in &table.rows { tr { @for cell in row { td { (cell) } } } } }
        }
        br;
    }
}

fn cases(definition: &Definition, gathered: &Gathered, command: &str) -> Markup {
    let seeds: Vec<String> = definition.seeds.iter().map(u64::to_string).collect();
    html! {
        p { "Made by " code { (command) } " from the scene " strong { (shown(&definition.base)) } ", seeds " (seeds.join(", ")) "." }
        @for line in tables::built(definition, gathered).lines().chain(tables::state(definition, gathered).lines()) {
            p { (line) }
        }
        p { "Every case is in " code { "cases.csv" } "; means over seeds in " code { "points.csv" } ", breaks by layer in "
            code { "breaks.csv" } ", all findings in " code { "study.json" } "." }
    }
}

/// The file name of a scene that is a path.
fn shown(base: &str) -> String {
    Path::new(base).file_name().map_or_else(|| base.to_owned(), |name| name.to_string_lossy().into_owned())
}
