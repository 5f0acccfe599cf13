//! The energy ledger: where the work went, and what is not accounted for.

use super::abscissa::Abscissa;
use super::figure::{Figure, axis, layout, merged, numbers};
use super::section::Section;
use super::select;
use super::source::Source;
use crate::base::error::Result;
use crate::base::ticks::label;
use crate::base::units::percent;
use crate::engine::view::Energy;
use crate::observe::guard::ENERGY_LIMIT;
use maud::{Markup, html};
use serde_json::{Value, json};

/// Rows in a chart at most.
const MOST_ROWS: usize = 800;

/// A term of the ledger: its name, its colour's token and its value.
type Term = (&'static str, &'static str, fn(&Energy) -> f64);

/// What the work became, dissipation first.
const TERMS: [Term; 9] = [
    ("plastic work in bonds", "$term0", |e| e.plastic_bonds),
    ("friction", "$term1", |e| e.friction),
    ("plastic work in contacts", "$term2", |e| e.plastic_contacts),
    ("thinning against contact pressure", "$term3", |e| e.plastic_thinning),
    ("damping", "$term4", |e| e.damping),
    ("released by rupture", "$term5", |e| e.released),
    ("elastic, in bonds", "$term6", |e| e.elastic_bonds),
    ("elastic, in contacts", "$term7", |e| e.elastic_contacts),
    ("kinetic", "$term8", |e| e.kinetic),
];

/// The ledger over the run and at its end.
pub fn section(source: &Source) -> Result<Section> {
    let worked = source.samples.iter().any(|row| row.energy.work.abs() > source.info.negligible_energy);
    let body = if worked {
        html! { div.pair { (chart(source).markup()) (table(source)) } }
    } else {
        html! { p { "No work was done on this body." } }
    };
    Ok(Section { id: "energy", title: "Energy ledger", body })
}

fn table(source: &Source) -> Markup {
    let end = &source.summary.energy;
    let (factor, unit) = unit(source);
    let share = |value: f64| {
        if end.work.abs() <= source.info.negligible_energy {
            String::new()
        } else {
            label(percent(value / end.work), 3)
        }
    };
    html! {
        div.scroll tabindex="0" role="group" aria-label="Energies at the end" { table {
            caption {
                "At the end. Work is that of grips, holds and loads, plus the energy at the start. A run warns when more than "
                (percent(ENERGY_LIMIT)) " % is unaccounted for."
            }
            thead { tr { th { "term" } th.number { "energy (" (unit) ")" } th.number { "of the work (%)" } } }
            tbody {
                @for (name, _, value) in TERMS {
                    tr { td { (name) } td.number { (label(value(end) * factor, 5)) } td.number { (share(value(end))) } }
                }
                tr.total { td { "work done" } td.number { (label(end.work * factor, 5)) } td.number { (share(end.work)) } }
                tr.total {
                    td { "unaccounted for (residual)" } td.number { (label(end.residual() * factor, 5)) }
                    td.number { (source.summary.energy_residual_percent.map_or(String::new(), |r| label(r, 4))) }
                }
            }
        } }
    }
}

fn chart(source: &Source) -> Figure {
    let abscissa = Abscissa::of(source);
    let rows = select::rows(&source.samples, source.first_rupture_step(), MOST_ROWS);
    let (factor, unit) = unit(source);
    let line = |name: &str, colour: &str, width: f64, dash: &str, value: &dyn Fn(&Energy) -> f64| -> Value {
        // A logarithm has no place for zero.
        let y = rows.iter().map(|row| Some(value(&row.energy) * factor).filter(|v| *v > 0.0).unwrap_or(f64::NAN));
        json!({
            "type": "scatter", "mode": "lines", "name": name, "line": { "color": colour, "width": width, "dash": dash },
            "x": numbers(rows.iter().map(|row| abscissa.value(row))), "y": numbers(y),
            "hovertemplate": format!("<b>{name}</b><br>{}<br>%{{y:.4g}} {unit}<extra></extra>", abscissa.hover()),
        })
    };
    let work = line("work done", "$ink", 3.0, "solid", &|e| e.work);
    let terms = TERMS.iter().filter(|(_, _, value)| rows.iter().any(|row| value(&row.energy) > 0.0));
    let terms = terms.map(|(name, colour, value)| line(name, colour, 1.8, "solid", value));
    let residual = line("residual, absolute", "$muted", 1.2, "dot", &|e| e.residual().abs());
    let (low, high) = decades(source);
    Figure {
        id: "ledger",
        height: 460,
        caption: html! { "Every term of the ledger on a logarithmic scale; " (rows.len()) " of " (source.samples.len()) " rows. Click a name to hide its line." },
        data: std::iter::once(work).chain(terms).chain([residual]).collect(),
        layout: layout(
            axis(abscissa.title()),
            merged(axis(&format!("energy ({unit})")), json!({ "type": "log", "range": [low, high], "dtick": 1 })),
            json!({ "margin": { "l": 56, "r": 16, "t": 32, "b": 48 }, "legend": { "orientation": "h", "y": -0.18, "yanchor": "top", "x": 0, "font": { "size": 11 } } }),
        ),
    }
}

/// Greatest energy of the run (J).
fn greatest(source: &Source) -> f64 {
    source.samples.iter().flat_map(|row| [row.energy.work, row.energy.internal()]).fold(0.0, f64::max)
}

/// The unit that suits the run: its factor from J, and its name.
fn unit(source: &Source) -> (f64, &'static str) {
    if greatest(source) >= 0.1 { (1.0, "J") } else { (1e3, "mJ") }
}

/// Decades of the unit that the chart opens with: seven below the greatest term.
fn decades(source: &Source) -> (f64, f64) {
    let most = greatest(source) * unit(source).0;
    let high = if most > 0.0 { most.log10().ceil() } else { 0.0 };
    (high - 7.0, high)
}
