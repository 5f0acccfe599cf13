//! The strand as a shape that the reader can turn: positions of the states on the page, made small, for WebGL.

use super::figure::data;
use super::source::{Source, State};
use crate::base::error::{Error, Result};
use crate::base::units::{mm, mpa};
use crate::observe::wording::{layer_label, wire_number};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use maud::{Markup, html};
use serde_json::{Value, json};
use std::io::Write;

/// Steps of a coordinate within the box of all states; 3 µm for a strand of 200 mm.
const STEPS: f32 = 65_535.0;
/// Value of a particle that no bond holds; others are shares of the range of stress, from 0 to 254.
const LOOSE: u8 = 255;
/// Colours of the scale.
const STOPS: usize = 32;

/// The picture with its buttons, where the page has the positions; a word where it has not.
///
/// # Errors
/// [`Error::Io`] when there is no memory for it.
pub fn picture(source: &Source) -> Result<Markup> {
    if source.states.is_empty() || source.states.iter().any(|state| state.position.is_empty()) {
        return Ok(
            html! { p { "The run is too large to be turned here: " code { "strandsnap explore RUN" } " shows it." } },
        );
    }
    let layers = (0..source.info.layers.len()).filter(|_| source.info.layers.len() > 1);
    Ok(html! {
        div.solid {
            canvas id="solid" tabindex="0" role="img" aria-label="The run in three dimensions at the chosen snapshot" {}
            div.controls role="group" aria-label="View of the shape" {
                button type="button" data-view="home" { "Whole" }
                @if !source.ruptures.is_empty() { button type="button" data-view="break" { "Breaks" } }
                @for layer in layers {
                    button type="button" data-layer=(layer) aria-pressed="true" { (layer_label(&source.info, layer)) }
                }
                span.remark id="solid-told" role="status" { "Drag turns, the wheel zooms, Shift and drag moves; a click names a wire." }
            }
            (data(&facts(source)?, "solid", "solid"))
        }
    })
}

/// What the script draws.
fn facts(source: &Source) -> Result<Value> {
    let info = &source.info;
    let [low, high] = reach(&source.states);
    let thickest = source.states.iter().flat_map(|state| &state.radius).copied().fold(f32::MIN_POSITIVE, f32::max);
    let in_mm = |place: [f32; 3]| place.map(|x| mm(f64::from(x)));
    let wires = info.wires.iter().enumerate().map(|(number, wire)| {
        json!({ "number": wire_number(number), "first": wire.first, "len": wire.len, "layer": wire.layer })
    });
    let stops = (0..STOPS).map(|k| {
        let colour = colorous::VIRIDIS.eval_rational(k, STOPS);
        [colour.r, colour.g, colour.b]
    });
    Ok(json!({
        "particles": info.particles, "states": source.states.len(), "low": in_mm(low), "high": in_mm(high),
        "thickest": mm(f64::from(thickest)), "range": info.stress_range.map(mpa), "wires": wires.collect::<Vec<_>>(),
        "layers": (0..info.layers.len()).map(|layer| layer_label(info, layer)).collect::<Vec<_>>(),
        "stops": stops.collect::<Vec<_>>(), "data": packed(source, [low, high], thickest)?,
    }))
}

/// Least and greatest coordinates over all states (m).
fn reach(states: &[State]) -> [[f32; 3]; 2] {
    let all = states.iter().flat_map(|state| &state.position);
    all.fold([[f32::MAX; 3], [f32::MIN; 3]], |[low, high], p| {
        [[0, 1, 2].map(|k| low[k].min(p[k])), [0, 1, 2].map(|k| high[k].max(p[k]))]
    })
}

/// All states one after the other, as zlib in base64. A state is, for all particles: the low and the high bytes of x, of y and of z,
/// each as steps within the box and less than in the state before, modulo 2¹⁶; radii as shares of the thickest (0 to 255); stresses
/// as shares of the range (0 to 254, or 255 where no bond holds); and whether the bond after each holds (0 or 1).
fn packed(source: &Source, [low, high]: [[f32; 3]; 2], thickest: f32) -> Result<String> {
    let refuse = |e| Error::io("cannot make small", "the shape of the run", e);
    let mut small = ZlibEncoder::new(Vec::new(), Compression::best());
    let mut before = vec![[0u16; 3]; source.info.particles];
    for state in &source.states {
        let now: Vec<[u16; 3]> =
            state.position.iter().map(|p| [0, 1, 2].map(|k| steps(p[k], low[k], high[k]))).collect();
        for axis in 0..3 {
            let change = |(now, before): (&[u16; 3], &[u16; 3])| now[axis].wrapping_sub(before[axis]).to_le_bytes();
            let changes: Vec<[u8; 2]> = now.iter().zip(&before).map(change).collect();
            for byte in 0..2 {
                let bytes: Vec<u8> = changes.iter().map(|change| change[byte]).collect();
                small.write_all(&bytes).map_err(refuse)?;
            }
        }
        let radii: Vec<u8> = state.radius.iter().map(|r| (255.0 * r / thickest).round() as u8).collect();
        small.write_all(&radii).map_err(refuse)?;
        small.write_all(&stresses(source, state)).map_err(refuse)?;
        let holds: Vec<u8> =
            (0..now.len()).map(|i| u8::from(state.stress[i].is_finite() && is_bond(source, i))).collect();
        small.write_all(&holds).map_err(refuse)?;
        before = now;
    }
    Ok(STANDARD.encode(small.finish().map_err(refuse)?))
}

fn steps(x: f32, low: f32, high: f32) -> u16 {
    if high > low { (STEPS * (x - low) / (high - low)).round() as u16 } else { 0 }
}

/// Whether slot `i` lies between two particles of a wire.
fn is_bond(source: &Source, i: usize) -> bool {
    source.info.wires.iter().any(|wire| wire.bonds().contains(&i))
}

/// Stress of each particle, the mean of its bonds that hold, as a share of the range.
fn stresses(source: &Source, state: &State) -> Vec<u8> {
    let [low, high] = source.info.stress_range.map(|stress| stress as f32);
    let mut all = vec![LOOSE; source.info.particles];
    for wire in &source.info.wires {
        let held =
            |slot: usize| Some(state.stress[slot]).filter(|stress| wire.bonds().contains(&slot) && stress.is_finite());
        for i in wire.particles() {
            let sides = [i.checked_sub(1).and_then(held), held(i)];
            let count = sides.iter().flatten().count();
            if count > 0 {
                let mean = sides.iter().flatten().sum::<f32>() / count as f32;
                all[i] = (254.0 * ((mean - low) / (high - low)).clamp(0.0, 1.0)).round() as u8;
            }
        }
    }
    all
}
