//! The study of error against run time that was made for the scene: its plot and tables.

use super::section::Section;
use super::source::Source;
use super::study::{Study, Table};
use crate::base::error::Result;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};

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
            img.study alt="Error over run time, parameter by parameter" src={ "data:image/svg+xml;base64," (STANDARD.encode(plot)) };
        }
        @for table in &study.tables {
            div.scroll tabindex="0" role="group" aria-label=(table.title) { (cells(table)) }
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
