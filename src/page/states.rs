//! The run in pictures: frames and the unrolled map under one slider.

use super::abscissa::Abscissa;
use super::figure::data;
use super::picture::{self, Embedded};
use super::section::Section;
use super::solid;
use super::source::Source;
use super::source::State;
use super::unrolled::Map;
use crate::base::error::Result;
use crate::base::units::mpa;
use crate::base::wording::counted;
use maud::{Markup, html};
use rayon::prelude::*;
use serde_json::{Value, json};

/// A slider over the states, the frame of the state and the map of its stresses.
pub fn section(source: &Source) -> Result<Section> {
    let map = Map::new(source);
    let pictures = source.states.par_iter().map(|s| s.picture.as_deref().map(picture::embed).transpose());
    let pictures = pictures.collect::<Result<Vec<Option<Embedded>>>>()?;
    let body = match source.states.last() {
        Some(last) if map.is_some() || pictures.iter().any(Option::is_some) => html! {
            p.key { (counts(source)) }
            (controls(source, last))
            div.sight {
                div { (frame(source, &pictures)) (solid::picture(source)?) }
                div { @if let Some(map) = &map { (map.figure().markup()) } @else { p { "There is no map: this scene has no wires." } } }
            }
            (data(&states(source, &pictures, map.as_ref()), "states", "states"))
        },
        _ => {
            html! { p { "There is nothing to step through: this scene has no wires, and no frames were drawn. " (how_to_draw()) } }
        }
    };
    Ok(Section { id: "states", title: "Step by step", body })
}

fn counts(source: &Source) -> Markup {
    html! {
        (source.states.len()) " of the run's " (source.snapshots) " snapshots"
        @if source.first_rupture_step().is_some() { ", dense after the first rupture" } ". "
        @if source.pictures.found > 0 { (source.pictures_shown()) " of " (source.pictures.found) " frames are in this page. " }
        @if source.pictures.unfinished { "The run was stopped before it had drawn all of its frames. " }
        "Move with the slider, the arrow keys or the buttons."
    }
}

fn controls(source: &Source, last: &State) -> Markup {
    let end = source.states.len() - 1;
    html! {
        div.controls {
            button type="button" id="play" aria-pressed="false" { "Play" }
            input type="range" id="slider" min="0" max=(end) value=(end) step="1" aria-label="snapshot" aria-describedby="state";
            @for (index, label) in source.states.iter().enumerate().filter_map(|(i, s)| Some((i, s.label?))) {
                button.jump type="button" data-state=(index) { (label) }
            }
        }
        p.state id="state" aria-live="polite" { (told(source, last)) }
    }
}

/// A state in words.
fn told(source: &Source, state: &State) -> String {
    let row = &state.sample;
    let abscissa = Abscissa::of(source);
    let stress =
        if source.info.is_pulled() { format!(" · {:.1} MPa nominal", mpa(row.stress)) } else { String::new() };
    let broken = if source.info.wires.is_empty() {
        String::new()
    } else {
        format!(" · {} of {} broken", row.wires_broken, counted(source.info.wires.len(), "wire"))
    };
    let label = state.label.map_or(String::new(), |label| format!(" · {label}"));
    format!("{}{stress}{broken} · step {}{label}", abscissa.moment(abscissa.value(row)), row.step)
}

fn frame(source: &Source, pictures: &[Option<Embedded>]) -> Markup {
    // The last one stands in the page itself: it is seen without JavaScript and in print.
    match pictures.iter().rev().flatten().next() {
        Some(shown) => html! {
            img.frame id="frame" src=(shown.address) width=(shown.size[0]) height=(shown.size[1])
                alt="Frame of the run at the last snapshot";
        },
        None if source.pictures.found > 0 => {
            html! { p { "The run's frames do not belong to its snapshots. " (how_to_draw()) } }
        }
        None => html! { p { "The run has no frames. " (how_to_draw()) } },
    }
}

fn how_to_draw() -> Markup {
    html! { code { "strandsnap render RUN" } " draws them without simulating; make this page again afterwards." }
}

fn states(source: &Source, pictures: &[Option<Embedded>], map: Option<&Map>) -> Value {
    let states = source.states.iter().zip(pictures).map(|(state, picture)| {
        json!({
            "told": told(source, state),
            "picture": picture.as_ref().map(|p| &p.address),
            "stress": map.map(|map| map.stress(state)),
            "broken": source.ruptures.iter().filter(|r| r.step <= state.sample.step).count(),
        })
    });
    json!({ "states": states.collect::<Vec<_>>(), "marks": map.map(Map::marks) })
}
