//! The order of breaks as a table.

use super::answer::chip;
use super::section::Section;
use super::source::Source;
use crate::base::error::Result;
use crate::base::ticks::label;
use crate::base::units::{mm, mpa, ms, percent};
use crate::engine::view::Rupture;
use crate::observe::tables::cause;
use crate::observe::wording::{layer_label, wire_number};
use maud::{Markup, html};

/// Rows at most; all of them are in `ruptures.csv`.
const MOST_ROWS: usize = 300;

/// Every rupture with place, moment and cause.
pub fn section(source: &Source) -> Result<Section> {
    let body = if source.ruptures.is_empty() {
        html! { p { "Nothing broke." } }
    } else {
        html! { (table(source)) }
    };
    Ok(Section { id: "breaks", title: "Order of breaks", body })
}

fn table(source: &Source) -> Markup {
    let shown = &source.ruptures[..source.ruptures.len().min(MOST_ROWS)];
    let pulled = source.info.is_pulled();
    html! {
        div.scroll tabindex="0" role="group" aria-label="Breaks in order" { table {
            caption {
                "z runs along the strand's axis from the lower end. The wire's stress is the true axial stress of the bond just before it broke"
                @if pulled { "; the body's is the nominal stress then" } ". Every bond is in " code { "ruptures.csv" } "."
            }
            thead { tr {
                th.number { "order" } th.number { "wire" } th { "layer" } th.number { "z before loading (mm)" } th.number { "z then (mm)" }
                @if source.mid_length().is_some() { th.number { "from mid-length (mm)" } }
                @if pulled { th.number { "strain (%)" } } @else { th.number { "time (ms)" } }
                th.number { "wire stress (MPa)" }
                @if pulled { th.number { "body stress (MPa)" } }
                th { "cause" }
            } }
            tbody { @for rupture in shown { (row(source, rupture, pulled)) } }
        } }
        @if shown.len() < source.ruptures.len() {
            p.remark { "The first " (shown.len()) " of " (source.ruptures.len()) " broken bonds." }
        }
    }
}

fn row(source: &Source, r: &Rupture, pulled: bool) -> Markup {
    html! {
        tr data-wire=(r.wire) {
            td.number { (r.order) } td.number { (wire_number(r.wire)) } td { (chip(r.layer, &layer_label(&source.info, r.layer))) }
            td.number { (format!("{:.2}", mm(r.rest_z))) } td.number { (format!("{:.2}", mm(r.position[2]))) }
            @if let Some(mid) = source.mid_length() { td.number { (label(mm(r.rest_z) - mid, 2)) } }
            @if pulled { td.number { (format!("{:.3}", percent(r.strain))) } } @else { td.number { (format!("{:.4}", ms(r.time))) } }
            td.number { (format!("{:.1}", mpa(r.stress))) }
            @if pulled { td.number { (format!("{:.1}", mpa(r.body_stress))) } }
            td { (cause(r.cause)) }
        }
    }
}
