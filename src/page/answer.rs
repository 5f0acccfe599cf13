//! The answer first: what broke, where and when, how strong the body was, and what must be known before believing it.

use super::abscissa::Abscissa;
use super::figure::layer_colour;
use super::section::Section;
use super::source::Source;
use crate::base::error::Result;
use crate::base::units::{mm, mpa};
use crate::base::wording::counted;
use crate::engine::view::{RunInfo, Rupture};
use crate::observe::summary::RunSummary;
use crate::observe::wording::{layer_label, wire_number};
use maud::{Markup, html};

/// Wires in the row of chips at most.
const MOST_CHIPS: usize = 120;

/// The first rupture, strength and elongation, warnings, and how failure ran through the layers.
pub fn section(source: &Source) -> Result<Section> {
    let body = html! {
        p.headline { (headline(source)) }
        @if let Some(draw) = source.summary.one_draw.filter(|_| !source.ruptures.is_empty()) { p.remark { (draw.sentence()) } }
        (facts(source))
        (warnings(source))
        @if !source.cut_short() { p { "The run ended because: " (source.summary.stopped_because) "." } }
        @if !source.ruptures.is_empty() { (sequence(source)) (layers(source)) }
    };
    Ok(Section { id: "answer", title: "What happened", body })
}

fn warnings(source: &Source) -> Markup {
    let texts: Vec<&String> = source.notes.iter().chain(&source.summary.warnings).collect();
    html! {
        @if texts.is_empty() && !source.cut_short() {
            p.good { "No warnings." @if source.info.is_pulled() { " Loading stayed within its limits up to the first rupture, and the energy ledger closes." } }
        } @else {
            div.warnings role="alert" {
                @if source.cut_short() && source.finished { p { strong { "Cut short. " } "The run did not reach its own end: " (source.summary.stopped_because) "." } }
                @for text in texts { p { strong { "Warning. " } (text) } }
            }
        }
    }
}

/// What broke first, where and when, in a sentence.
pub fn headline(source: &Source) -> Markup {
    let wires = source.info.wires.len();
    match source.ruptures.first() {
        Some(first) => first_rupture(&source.info, first, source.summary.one_draw.is_some()),
        None if source.cut_short() && wires > 0 => html! { "No wire had broken when the run was cut short." },
        None if source.info.is_pulled() => html! { "No wire broke." },
        None if wires > 0 => html! { "Nothing broke: this body was not pulled until it snaps." },
        None => html! { "Free bodies only: there is no wire that could break." },
    }
}

/// Which wire snapped first, where and when; `one_draw` where bonds scatter, so that it is true of this strand alone.
pub fn first_rupture(info: &RunInfo, first: &Rupture, one_draw: bool) -> Markup {
    let abscissa = Abscissa::of_run(info);
    html! {
        strong { "Wire " (wire_number(first.wire)) ", " (layer_label(info, first.layer)) " layer," } " snapped first" @if one_draw { " in this strand" } ", at z = "
        strong { (format!("{:.1} mm", mm(first.rest_z))) } " before loading (" (format!("{:.1} mm", mm(first.position[2])))
        " when it snapped), at " strong { (abscissa.moment(abscissa.at(first))) }
        @if info.is_pulled() { " and " strong { (format!("{:.1} MPa", mpa(first.body_stress))) } " nominal stress" }
        "."
    }
}

fn facts(source: &Source) -> Markup {
    html! {
        dl.facts {
            @for (name, value, remark) in listed(source) {
                div { dt { (name) } dd { (value) @if !remark.is_empty() { span.remark { (remark) } } } }
            }
        }
    }
}

/// Name, value and remark of everything that the run has.
fn listed(source: &Source) -> Vec<(&'static str, String, String)> {
    let s = &source.summary;
    let mut facts = stresses(s);
    if let (Some(first), Some(mid)) = (source.ruptures.first(), source.mid_length()) {
        let (distance, towards) = from_middle(mm(first.rest_z) - mid);
        facts.push(("From mid-length", distance, towards.into()));
        facts.push((
            "Wire stress there",
            format!("{:.0} MPa", mpa(first.stress)),
            "true axial, just before it broke".into(),
        ));
    }
    if !source.info.wires.is_empty() {
        let of = format!("{} of {}", s.wires_broken, source.info.wires.len());
        facts.push(("Wires broken", of, counted(s.bonds_broken, "bond")));
    }
    facts
}

/// What the body carried: a strength only where it failed.
fn stresses(s: &RunSummary) -> Vec<(&'static str, String, String)> {
    let mut facts = Vec::new();
    let mut add = |name, at, remark: &str, stress: Option<f64>, strain: Option<f64>| {
        if let Some((stress, strain)) = stress.zip(strain) {
            facts.push((name, format!("{stress:.2} MPa"), remark.into()));
            facts.push((at, format!("{strain:.2} %"), "nominal strain".into()));
        }
    };
    if s.failed() {
        let (stress, strain) = (s.tensile_strength_mpa, s.fracture_elongation_percent);
        add("Tensile strength", "Elongation at peak", "peak nominal stress", stress, strain);
    } else {
        let (stress, strain) = (s.greatest_stress_mpa, s.strain_at_greatest_stress_percent);
        let remark = "nominal; no strength, for the body did not fail";
        add("Greatest stress", "Strain there", remark, stress, strain);
    }
    let (stress, strain) = (s.compressive_peak_mpa, s.strain_at_compressive_peak_percent);
    add("Compressive peak", "Strain at the compressive peak", "least nominal stress", stress, strain);
    if let Some(drop) = s.elongation_at_20_percent_drop_percent {
        facts.push(("At 20 % drop", format!("{drop:.2} %"), "elongation, stress 20 % below its peak".into()));
    }
    if let (Some(stress), Some(strain)) = (s.residual_stress_mpa, s.final_strain_percent) {
        facts.push(("At the end", format!("{stress:.2} MPa"), format!("at {strain:.2} %")));
    }
    facts
}

/// A distance from mid-length before loading (mm), and its direction.
fn from_middle(distance: f64) -> (String, &'static str) {
    let towards = if distance < 0.0 {
        "first rupture, towards the lower grip, before loading"
    } else {
        "first rupture, towards the upper grip, before loading"
    };
    (format!("{:.1} mm", distance.abs()), towards)
}

fn sequence(source: &Source) -> Markup {
    let firsts: Vec<&Rupture> = source.ruptures.iter().filter(|rupture| rupture.first_of_wire).collect();
    let shown = &firsts[..firsts.len().min(MOST_CHIPS)];
    html! {
        h3 { "How failure ran" }
        p.key {
            "Wires in the order in which they broke. "
            @for layer in 0..source.info.layers.len() { (chip(layer, &layer_label(&source.info, layer))) " " }
        }
        ol.chips {
            @for rupture in shown {
                li.chip style=(colour(rupture.layer)) title=(layer_label(&source.info, rupture.layer)) { (wire_number(rupture.wire)) }
            }
        }
        @if shown.len() < firsts.len() { p.remark { "The first " (shown.len()) " of " (firsts.len()) "." } }
    }
}

/// A layer's name on its colour.
pub fn chip(layer: usize, text: &str) -> Markup {
    html! { span.chip style=(colour(layer)) { (text) } }
}

/// The layer's colour for a style sheet.
fn colour(layer: usize) -> String {
    format!("--chip:var(--{})", layer_colour(layer).trim_start_matches('$'))
}

fn layers(source: &Source) -> Markup {
    let broken = &source.summary.wires_broken_by_layer;
    let abscissa = Abscissa::of(source);
    html! {
        div.scroll tabindex="0" role="group" aria-label="Layers" { table {
            caption { "Layer by layer, from the inside out" }
            thead { tr {
                th { "layer" } th.number { "wires broken" } th.number { "of" } th.number { "first to break" }
                th.number { "order among all" } th.number { (abscissa.title()) } th.number { "z before loading (mm)" }
            } }
            tbody { @for (layer, name) in source.info.layers.iter().enumerate() {
                tr {
                    td { (chip(layer, &layer_label(&source.info, layer))) }
                    @let count = broken.get(name).copied().unwrap_or_default();
                    td.number { (count.broken) } td.number { (count.of) }
                    (first_of(source, layer, abscissa))
                }
            } }
        } }
    }
}

fn first_of(source: &Source, layer: usize, abscissa: Abscissa) -> Markup {
    match source.ruptures.iter().find(|rupture| rupture.layer == layer) {
        None => html! { td.number colspan="4" { "none broke" } },
        Some(first) => html! {
            td.number { "wire " (wire_number(first.wire)) } td.number { (first.order) }
            td.number { (format!("{:.3}", abscissa.at(first))) } td.number { (format!("{:.1}", mm(first.rest_z))) }
        },
    }
}

#[cfg(test)]
mod tests {
    use super::from_middle;

    #[test]
    fn distances_say_their_side() {
        let (distance, towards) = from_middle(-20.71);
        assert_eq!((distance.as_str(), towards.contains("lower")), ("20.7 mm", true));
        assert!(from_middle(0.04).1.contains("upper"));
    }
}
