//! The stress-strain curve with a tick per rupture, whole and around fracture.

use super::abscissa::Abscissa;
use super::figure::{Figure, axis, layer_colour, layout, literal, merged, numbers};
use super::section::Section;
use super::select;
use super::source::Source;
use crate::base::error::Result;
use crate::base::units::{mm, mpa, ms, newton_mm, percent};
use crate::engine::view::{Rupture, Sample};
use crate::observe::stress_strain::{STRAIN, STRESS, mark, place};
use crate::observe::tables::cause;
use crate::observe::wording::{layer_label, wire_number};
use maud::{Markup, html};
use serde_json::{Value, json};

/// Rows in the chart at most.
const MOST_ROWS: usize = 4000;

/// Nominal stress over strain where a body is pulled; torque over time where it is only turned.
pub fn section(source: &Source) -> Result<Section> {
    let (title, body) = match source.info.gauge {
        Some(_) if source.info.is_pulled() => ("Stress and strain", stress(source)),
        Some(_) => ("Torque", torque(source)),
        None => ("Stress and strain", html! { p { "There is no curve: no grips hold this body." } }),
    };
    Ok(Section { id: "curve", title, body })
}

fn stress(source: &Source) -> Markup {
    let rows = select::rows(&source.samples, source.first_rupture_step(), MOST_ROWS);
    let whole = Figure {
        id: "curve-whole",
        height: 400,
        caption: html! {
            "Nominal stress (upper grip force over the wires' cross-sections before loading) over nominal strain (grip displacement over the free length between the particles held). "
            @if !source.ruptures.is_empty() { "Ticks: ruptures, in the colour of their layer. " }
            (rows.len()) " of " (source.samples.len()) " rows of " code { "curve.csv" } "."
        },
        data: traces(source, &rows),
        layout: layout(
            axis(STRAIN),
            merged(axis(STRESS), json!({ "rangemode": "tozero" })),
            json!({ "showlegend": !source.ruptures.is_empty() }),
        ),
    };
    html! {
        div.pair {
            (whole.markup())
            @if let Some(range) = fracture_range(source) { (around_fracture(source, &rows, range).markup()) }
        }
    }
}

/// The same curve where the wires break.
fn around_fracture(source: &Source, rows: &[&Sample], [from, to]: [f64; 2]) -> Figure {
    let inside: Vec<&Sample> = rows.iter().copied().filter(|row| (from..=to).contains(&percent(row.strain))).collect();
    Figure {
        id: "curve-fracture",
        height: 400,
        caption: html! { "The same around fracture. Drag to look closer, double-click to come back." },
        data: traces(source, &inside),
        layout: layout(
            merged(axis(STRAIN), json!({ "range": [from, to] })),
            merged(axis(STRESS), json!({ "rangemode": "tozero" })),
            json!({ "showlegend": true }),
        ),
    }
}

/// Strains between which the wires of a pulled body break, with some room (%).
pub fn fracture_range(source: &Source) -> Option<[f64; 2]> {
    let (first, last) = (source.ruptures.first()?, source.samples.last()?);
    let from = percent(first.strain);
    let to = percent(last.strain).max(from);
    let room = (0.15 * (to - from)).max(0.05);
    (source.info.is_pulled() && from > 2.0 * room).then_some([from - room, to + 0.5 * room])
}

fn traces(source: &Source, rows: &[&Sample]) -> Vec<Value> {
    let broken: Vec<usize> = rows.iter().map(|row| row.wires_broken).collect();
    let of = |axis: usize| rows.iter().map(move |row| place(row.strain, row.stress)[axis]);
    let line = json!({
        "type": "scatter", "mode": "lines", "name": "stress", "line": { "color": "$ink", "width": 2 },
        "x": numbers(of(0)), "y": numbers(of(1)), "customdata": broken,
        "hovertemplate": "strain %{x:.3f} %<br>stress %{y:.2f} MPa<br>%{customdata} wires broken<extra></extra>",
    });
    let marks = (0..source.info.layers.len()).filter_map(|layer| ticks(source, layer, |r| mark(r)[1]));
    std::iter::once(line).chain(marks).collect()
}

/// A tick for each rupture of a layer; `height` says where.
fn ticks(source: &Source, layer: usize, height: impl Fn(&Rupture) -> f64) -> Option<Value> {
    let of: Vec<&Rupture> = source.ruptures.iter().filter(|rupture| rupture.layer == layer).collect();
    let abscissa = Abscissa::of(source);
    (!of.is_empty()).then(|| {
        json!({
            "type": "scatter", "mode": "markers", "name": format!("{} breaks", literal(&layer_label(&source.info, layer))),
            "marker": { "symbol": "line-ns-open", "size": 18, "color": layer_colour(layer), "line": { "width": 2, "color": layer_colour(layer) } },
            "x": numbers(of.iter().map(|r| abscissa.at(r))), "y": numbers(of.iter().map(|r| height(r))),
            "text": of.iter().map(|r| told(source, r)).collect::<Vec<_>>(),
            "hovertemplate": "%{text}<extra></extra>",
        })
    })
}

/// A rupture for a chart's hover.
pub fn told(source: &Source, rupture: &Rupture) -> String {
    let abscissa = Abscissa::of(source);
    format!(
        "<b>break {}: wire {}</b>, {} layer<br>z = {:.1} mm before loading, {:.1} mm then<br>{}, body at {:.1} MPa<br>wire at {:.0} MPa (true), {}",
        rupture.order,
        wire_number(rupture.wire),
        literal(&layer_label(&source.info, rupture.layer)),
        mm(rupture.rest_z),
        mm(rupture.position[2]),
        abscissa.moment(abscissa.at(rupture)),
        mpa(rupture.body_stress),
        mpa(rupture.stress),
        cause(rupture.cause),
    )
}

fn torque(source: &Source) -> Markup {
    let rows = select::rows(&source.samples, source.first_rupture_step(), MOST_ROWS);
    let line = json!({
        "type": "scatter", "mode": "lines", "name": "torque", "line": { "color": "$ink", "width": 2 },
        "x": numbers(rows.iter().map(|row| ms(row.time))), "y": numbers(rows.iter().map(|row| newton_mm(row.torque))),
        "hovertemplate": "time %{x:.4f} ms<br>torque %{y:.4f} N mm<extra></extra>",
    });
    let torque_then = |r: &Rupture| {
        let row = source.samples.partition_point(|row| row.step < r.step);
        source.samples.get(row).map_or(0.0, |row| newton_mm(row.torque))
    };
    let marks = (0..source.info.layers.len()).filter_map(|layer| ticks(source, layer, torque_then));
    let figure = Figure {
        id: "curve-whole",
        height: 400,
        caption: html! { "Torque about z on the upper grip over time: this body is turned, not pulled. " (rows.len()) " of " (source.samples.len()) " rows." },
        data: std::iter::once(line).chain(marks).collect(),
        layout: layout(axis("time (ms)"), axis("torque (N mm)"), json!({ "showlegend": !source.ruptures.is_empty() })),
    };
    figure.markup()
}
