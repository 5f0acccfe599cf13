//! The study of error against run time that was made for the scene: its plot and tables.

use super::{Section, Source};
use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::run::folder::{ACCURACY_PLOT, ACCURACY_STUDY};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};
use serde::Deserialize;
use std::path::Path;

/// A study as the page shows it: of `accuracy.json`, what is written for people.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Study {
    /// Scene that was studied.
    scene: String,
    /// What the user typed.
    command: String,
    /// Whether it was cut short.
    interrupted: bool,
    /// What the runs were compared with.
    summary: String,
    tables: Vec<Table>,
    /// `accuracy.svg`; `None` when its file is missing.
    #[serde(skip)]
    plot: Option<String>,
}

/// A table of cells.
#[derive(Debug, Clone, PartialEq, Deserialize)]
struct Table {
    title: String,
    heads: Vec<String>,
    rows: Vec<Vec<String>>,
    /// The row that is the scene as it stands.
    default: Option<usize>,
}

impl Study {
    /// Reads the study in `folder`; `None` when it holds none.
    ///
    /// # Errors
    /// [`Error::Io`] when a file cannot be read, [`Error::Input`] when it is damaged.
    pub fn read(folder: &Path) -> Result<Option<Self>> {
        let path = folder.join(ACCURACY_STUDY);
        let Some(text) = read(&path)? else { return Ok(None) };
        let study: Self = serde_json::from_str(&text).map_err(|e| {
            let help = "make it again with `strandsnap accuracy SCENE`; runs that are kept are not made again";
            Error::input(format!("{} is damaged: {e}", path.display()), help)
        })?;
        let plot = read(&folder.join(ACCURACY_PLOT))?;
        Ok(Some(Self { plot, ..study }))
    }
}

fn read(path: &Path) -> Result<Option<String>> {
    regular::text_if_there(path, regular::LONGEST_TABLE)
}

/// What accuracy each second buys.
pub fn section(source: &Source) -> Result<Section> {
    let body = match &source.accuracy {
        Some(study) => shown(study),
        None => html! {
            p { "How far the result is from what refinement or a closed form gives was not studied for this page: "
                code { "strandsnap accuracy " (source.info.name) } " does that." }
        },
    };
    Ok(Section { id: "accuracy", title: "Error against run time", body })
}

fn shown(study: &Study) -> Markup {
    html! {
        p { "Scene " strong { (study.scene) } ", studied by " code { (study.command) } "." }
        @if study.interrupted { p.bad { "The study was cut short; what it had is shown." } }
        @for line in study.summary.lines() { p { (line.trim()) } }
        @if let Some(plot) = &study.plot {
            // As an image, so that nothing in the file can run.
            img.study alt="Error over run time, knob by knob" src={ "data:image/svg+xml;base64," (STANDARD.encode(plot)) };
        }
        @for table in &study.tables {
            div.scroll { (cells(table)) }
        }
    }
}

fn cells(table: &Table) -> Markup {
    html! {
        table {
            caption { (table.title) }
            thead { tr { @for head in &table.heads { th { (head) } } } }
            tbody {
                @for (k, row) in table.rows.iter().enumerate() {
                    tr.own[Some(k) == table.default] { @for cell in row { td { (cell) } } }
                }
            }
        }
    }
}
