//! Whether loading was quasi-static: the run's own measures against the scene's limits.

use super::figure::{Figure, axis, layout, merged, numbers, upright};
use super::section::Section;
use super::select;
use super::source::Source;
use crate::base::error::Result;
use crate::base::units::percent;
use crate::engine::view::Sample;
use crate::observe::guard::{FIRST_PASSAGES, LEAST_INTERNAL_SHARE};
use maud::{Markup, html};
use serde_json::{Value, json};

/// Rows in a chart at most.
const MOST_ROWS: usize = 1500;

/// Kinetic over internal energy and the difference of the two grip forces.
pub fn section(source: &Source) -> Result<Section> {
    let body = if source.info.is_pulled() {
        html! { (measures(source)) div.pair { (kinetic(source).markup()) (mismatch(source).markup()) } }
    } else {
        html! { p { "Not judged: only a body that is pulled by its grips is loaded quasi-statically." } }
    };
    Ok(Section { id: "quasi-static", title: "Was loading quasi-static?", body })
}

fn measures(source: &Source) -> Markup {
    let seen = &source.summary.quasi_static;
    let limits = source.spec.as_ref().map(|spec| &spec.time);
    let scaled = |value: Option<f64>| value.map(percent);
    let rows = [
        (
            "kinetic / internal energy (%)",
            scaled(seen.kinetic_over_internal_max),
            scaled(limits.map(|l| l.kinetic_limit)),
            scaled(seen.kinetic_over_internal_overall),
        ),
        (
            "difference of grip forces / peak force (%)",
            seen.grip_force_mismatch_percent,
            scaled(limits.map(|l| l.mismatch_limit)),
            seen.grip_force_mismatch_overall_percent,
        ),
    ];
    html! {
        div.scroll tabindex="0" role="group" aria-label="Measures of loading" { table {
            caption {
                "Greatest values. The quasi-static stage ends with the first rupture, which throws energy about; what comes after is given and judged by nobody."
            }
            thead { tr { th { "measure" } th.number { "before the first rupture" } th.number { "limit" } th { "verdict" } th.number { "whole run" } } }
            tbody { @for (name, before, limit, overall) in rows {
                tr {
                    td { (name) } td.number { (written(before)) } td.number { (written(limit)) }
                    td { (verdict(before, limit)) } td.number { (written(overall)) }
                }
            } }
        } }
    }
}

fn written(value: Option<f64>) -> String {
    value.map_or("not known".into(), |value| format!("{value:.3}"))
}

fn verdict(value: Option<f64>, limit: Option<f64>) -> Markup {
    match (value, limit) {
        (Some(value), Some(limit)) if value > limit => html! { span.bad { "✗ above its limit" } },
        (Some(_), Some(_)) => html! { span.good { "✓ within its limit" } },
        _ => html! { "not judged" },
    }
}

/// Whether a row counts: see [`FIRST_PASSAGES`].
fn settled(source: &Source, row: &Sample) -> bool {
    row.time >= FIRST_PASSAGES * source.info.wave_passage
}

fn kinetic(source: &Source) -> Figure {
    let most = source.samples.iter().map(|row| row.energy.internal()).fold(0.0, f64::max);
    let ratio = |row: &Sample| {
        let internal = row.energy.internal();
        // The same rows as the run's own measure counts.
        if settled(source, row) && internal > source.info.negligible_energy && internal >= LEAST_INTERNAL_SHARE * most {
            percent(row.energy.kinetic / internal)
        } else {
            f64::NAN
        }
    };
    let limit = source.spec.as_ref().map(|spec| percent(spec.time.kinetic_limit));
    let caption = html! {
        "Kinetic over internal energy, for rows with at least " (percent(LEAST_INTERNAL_SHARE)) " % of the run's greatest internal energy, after the first " (FIRST_PASSAGES) " passages of an elastic wave: a pull starts with motion and no strain."
    };
    chart(source, "kinetic", "kinetic / internal energy (%)", ratio, limit, caption)
}

fn mismatch(source: &Source) -> Figure {
    let peak = source.samples.iter().flat_map(|row| row.grip_force).map(f64::abs).fold(0.0, f64::max);
    let share = |row: &Sample| {
        if peak > 0.0 && settled(source, row) {
            percent((row.grip_force[1] - row.grip_force[0]).abs() / peak)
        } else {
            f64::NAN
        }
    };
    let limit = source.spec.as_ref().map(|spec| percent(spec.time.mismatch_limit));
    let caption = html! { "Difference of the two grip forces over the run's peak grip force, after the first " (FIRST_PASSAGES) " passages of an elastic wave." };
    chart(source, "mismatch", "grip force difference (%)", share, limit, caption)
}

fn chart(
    source: &Source,
    id: &'static str,
    title: &str,
    value: impl Fn(&Sample) -> f64,
    limit: Option<f64>,
    caption: Markup,
) -> Figure {
    let rows = select::rows(&source.samples, source.first_rupture_step(), MOST_ROWS);
    let line = json!({
        "type": "scatter", "mode": "lines", "name": "run", "line": { "color": "$ink", "width": 1.5 },
        "x": numbers(rows.iter().map(|row| percent(row.strain))), "y": numbers(rows.iter().map(|row| value(row))),
        "hovertemplate": "strain %{x:.3f} %<br>%{y:.3f} %<extra></extra>",
    });
    let ends = [&rows[0], &rows[rows.len() - 1]].map(|row| percent(row.strain));
    let limit = limit.map(|limit| {
        json!({
            "type": "scatter", "mode": "lines", "name": "limit", "line": { "color": "$signal", "width": 1.5, "dash": "dash" },
            "x": ends, "y": [limit, limit], "hovertemplate": "limit %{y:.3f} %<extra></extra>",
        })
    });
    let (shapes, notes): (Vec<Value>, Vec<Value>) =
        source.ruptures.first().map(|first| upright(percent(first.strain), "first rupture")).into_iter().unzip();
    Figure {
        id,
        height: 340,
        caption,
        data: std::iter::once(line).chain(limit).collect(),
        layout: layout(
            axis("nominal strain (%)"),
            merged(axis(title), json!({ "rangemode": "tozero" })),
            json!({ "shapes": shapes, "annotations": notes }),
        ),
    }
}
