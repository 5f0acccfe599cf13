//! Stress of the layers and of every wire.

use super::abscissa::Abscissa;
use super::curve::fracture_range;
use super::figure::{Figure, axis, layer_colour, layout, literal, merged, numbers};
use super::section::Section;
use super::select;
use super::source::Source;
use crate::base::error::Result;
use crate::base::units::{mpa, percent};
use crate::engine::view::Sample;
use crate::observe::materials::{Share, Shares};
use crate::observe::wording::{layer_label, wire_number};
use maud::{Markup, html};
use serde_json::{Value, json};

/// Rows per line at most, and points in a chart at most: a strand of many wires gets fewer rows.
const MOST_ROWS: usize = 800;
const MOST_POINTS: usize = 40_000;
/// Stress below which there is nothing to show (MPa).
const LEAST: f64 = 1e-3;

/// Layer means and wires over strain, whole and around fracture.
pub fn section(source: &Source) -> Result<Section> {
    let stresses = source.samples.iter().flat_map(|row| &row.wire_stress).map(|stress| mpa(*stress).abs());
    let greatest = stresses.reduce(f64::max);
    let body = if source.info.wires.is_empty() {
        html! { p { "This scene has no wires." } }
    } else {
        match greatest {
            None => html! { p { "Stress at mid-gauge is not measured: no grips hold this body." } },
            // A chart would show the rounding of its zero.
            Some(most) if most < LEAST => {
                html! { p { "No wire carried axial stress: it stayed below " (LEAST) " MPa." } }
            }
            Some(_) => {
                html! { (charts(source)) @if let Some(told) = &source.summary.shares_at_greatest_stress { (shares(told)) } }
            }
        }
    };
    Ok(Section { id: "wires", title: "Stress in layers and wires", body })
}

fn charts(source: &Source) -> Markup {
    let most = MOST_ROWS.min(MOST_POINTS / source.info.wires.len()).max(50);
    let rows = select::rows(&source.samples, source.first_rupture_step(), most);
    let range = fracture_range(source);
    let whole = chart(
        source,
        "wires-whole",
        &rows,
        None,
        html! {
            "Nominal axial stress at mid-gauge: thick lines are layer means, thin ones single wires. Click a layer in the legend to hide it. "
            (rows.len()) " of " (source.samples.len()) " rows."
        },
    );
    html! {
        div.pair {
            (whole.markup())
            @if let Some([from, to]) = range {
                @let inside: Vec<&Sample> = rows.iter().copied().filter(|r| (from..=to).contains(&percent(r.strain))).collect();
                (chart(source, "wires-fracture", &inside, range, html! {
                    "The same around fracture: a wire that breaks loses its load, its neighbours take it up."
                }).markup())
            }
        }
    }
}

/// Who carried how much when the body carried most.
fn shares(told: &Shares) -> Markup {
    let rows = |what: &'static str, shares: &[Share]| {
        html! {
            @for share in shares {
                tr {
                    th { (share.name) } td { (what) } td.number { (format!("{:.3}", share.area_mm2)) }
                    td.number { (format!("{:.1}", share.force_n)) }
                    td.number { (format!("{:.1}", 100.0 * share.force_n / told.force_n)) }
                    td.number { (format!("{:.1}", share.stress_mpa)) }
                }
            }
        }
    };
    html! {
        div.scroll { table {
            caption {
                "Who carried the greatest force, " (format!("{:.1} N at {:.3} %", told.force_n, told.strain_percent))
                ": forces along the axis, stresses along the wires"
            }
            thead { tr {
                th { "" } th { "" } th.number { "section (mm²)" } th.number { "force (N)" } th.number { "share (%)" }
                th.number { "mean nominal stress (MPa)" }
            } }
            tbody { (rows("material", &told.materials)) (rows("layer", &told.layers)) }
        } }
    }
}

fn chart(source: &Source, id: &'static str, rows: &[&Sample], range: Option<[f64; 2]>, caption: Markup) -> Figure {
    let abscissa = Abscissa::of(source);
    let x = || numbers(rows.iter().map(|row| abscissa.value(row)));
    let wires = source.info.wires.iter().enumerate().map(|(w, wire)| {
        let layer = literal(&layer_label(&source.info, wire.layer));
        json!({
            "type": "scatter", "mode": "lines", "showlegend": false, "legendgroup": layer, "opacity": 0.45,
            "line": { "color": layer_colour(wire.layer), "width": 1 }, "x": x(),
            "y": numbers(rows.iter().map(|row| row.wire_stress.get(w).map_or(f64::NAN, |s| mpa(*s)))),
            "hovertemplate": format!("<b>wire {}</b>, {layer} layer<br>{}<br>%{{y:.1f}} MPa nominal<extra></extra>", wire_number(w), abscissa.hover()),
        })
    });
    let layers = (0..source.info.layers.len()).map(|layer| {
        let name = literal(&layer_label(&source.info, layer));
        json!({
            "type": "scatter", "mode": "lines", "name": format!("{name} layer"), "legendgroup": name,
            "line": { "color": layer_colour(layer), "width": 3 }, "x": x(),
            "y": numbers(rows.iter().map(|row| row.layer_stress.get(layer).map_or(f64::NAN, |s| mpa(*s)))),
            "hovertemplate": format!("<b>{name} layer</b>, mean<br>{}<br>%{{y:.1f}} MPa nominal<extra></extra>", abscissa.hover()),
        })
    });
    let data: Vec<Value> = wires.chain(layers).collect();
    let x_axis = match range {
        Some(range) => merged(axis(abscissa.title()), json!({ "range": range })),
        None => axis(abscissa.title()),
    };
    Figure { id, height: 420, caption, data, layout: layout(x_axis, axis("nominal axial stress (MPa)"), json!({})) }
}
