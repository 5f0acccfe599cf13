//! The layers taken apart: each in a strip of its own, so that inner wires are seen and no loose end hides another layer.

use super::body::Body;
use super::camera::Camera;
use super::canvas::{Canvas, Rect, Weight};
use super::data::Data;
use super::labels::{self, Mark};
use super::panel::{Panel, Shot};
use super::sides::{Side, sides};
use super::style::Rgb;
use super::wires::Looks;
use crate::observe::wording::layer_label;
use crate::scene::spec::View;
use glam::Vec3;

/// Space over each layer, for its name and its breaks, over the body's radius (-).
const SPACE: f32 = 0.95;
/// Distance between layers over the body's radius (-): so far apart that none shades another.
const APART: f32 = 40.0;
/// How far from its layer, in radii of the body (-), a loose wire begins to fade and is faded; and how much of it stays.
const STRAY: [f32; 2] = [0.15, 0.6];
const FADED: f32 = 0.35;

/// The panel.
pub struct Exploded;

impl Panel for Exploded {
    fn shots(&self, data: &Data, panel: Rect, unit: f32) -> Vec<Shot> {
        let z = data.current_z(data.focus.z);
        sides(panel, unit, &data.focus)
            .into_iter()
            .flat_map(|(panel, side)| strips(data, panel, unit, z, side))
            .collect()
    }

    fn looks(&self, data: &Data, _camera: &Camera) -> Option<Looks> {
        let mut position = data.snapshot.position.clone();
        for wire in &data.info.wires {
            let shift = shift(data.body, wire.layer);
            for p in &mut position[wire.particles()] {
                *p = (Vec3::from(*p) + shift).to_array();
            }
        }
        Some(data.looks(position, Vec::new()).with_colours(colours(data)))
    }

    fn annotate(&self, canvas: &mut Canvas, shot: &Shot, data: &Data, _frame: &[Shot]) {
        if let Some(layer) = shot.layer {
            annotate(canvas, &shot.camera, data, layer);
        }
    }
}

/// Where a layer is moved to (m).
fn shift(body: &Body, layer: usize) -> Vec3 {
    Vec3::X * (layer as f32 * APART * body.radius)
}

/// A strip per layer, the outermost on top, all at one scale.
fn strips(data: &Data, panel: Rect, unit: f32, z: f32, side: Side) -> Vec<Shot> {
    let body = data.body;
    let heights: Vec<f32> = body.layer_radius.iter().map(|r| 2.0 * r + SPACE * body.radius).collect();
    // The title needs room above.
    let above = 20.0 * unit;
    let scale = (panel.h - above) / heights.iter().sum::<f32>().max(1e-9);
    let mut top = panel.y;
    let strip = |(layer, height): (usize, &f32)| {
        let first = layer + 1 == heights.len();
        let bottom =
            if layer == 0 { panel.bottom() } else { (top + height * scale + if first { above } else { 0.0 }).round() };
        let strip = Rect::new(panel.x, top, panel.w, bottom - top);
        top = bottom;
        let rotation = Camera::orientation(0.0, data.camera.elevation + side.turn);
        // The layer lies at the bottom of its strip, a little above the edge.
        let up = 0.5 * strip.h / scale - body.layer_radius[layer] - 0.12 * body.radius;
        let middle = Vec3::new(body.axis.x, body.axis.y, z) + shift(body, layer) + rotation.transpose() * Vec3::Y * up;
        let camera = Camera {
            rotation,
            centre: middle,
            panel: strip,
            scale: scale * data.camera.zoom as f32,
            depth: body.depth_of_view(),
        };
        Shot {
            view: View::Exploded,
            camera,
            layer: Some(layer),
            caption: if first { "layers apart".to_owned() } else { String::new() },
            remark: if first { format!("{}, {}", data.focus.words(), side.name) } else { String::new() },
            fade: body.radius,
            measures: layer == 0,
        }
    };
    heights.iter().enumerate().rev().map(strip).collect()
}

/// Colours of particles; what sprang far out of its layer fades into the ground, so that it does not hide what stayed.
fn colours(data: &Data) -> Vec<Rgb> {
    let mut colours = data.colours.to_vec();
    let body = data.body;
    for wire in &data.info.wires {
        for i in wire.particles() {
            let [x, y, _] = data.snapshot.position[i];
            let out = (x - body.axis.x).hypot(y - body.axis.y) - body.layer_radius[wire.layer];
            let strayed = ((out / body.radius - STRAY[0]) / (STRAY[1] - STRAY[0])).clamp(0.0, 1.0);
            if strayed > 0.0 {
                let kept = 1.0 - strayed * (1.0 - FADED);
                let mix = |k: usize| kept * f32::from(colours[i][k]) + (1.0 - kept) * f32::from(data.style.panel[k]);
                colours[i] = std::array::from_fn(|k| mix(k).round() as u8);
            }
        }
    }
    colours
}

/// The name of a layer, and over it the breaks on the side that is seen.
fn annotate(canvas: &mut Canvas, camera: &Camera, data: &Data, layer: usize) {
    let u = canvas.unit;
    let panel = camera.panel;
    let outermost = layer + 1 == data.info.layers.len();
    if !outermost {
        canvas.fill(Rect::new(panel.x, panel.y, panel.w, u.max(1.0)), data.style.grid, 1.0);
    }
    let top = if outermost { panel.y + 24.0 * u } else { panel.y + 2.0 * u };
    let width = |name: &str| canvas.fonts.width(name, 11.0 * u, Weight::Bold) + 10.0 * u;
    let names = (0..data.info.layers.len()).map(|layer| layer_label(data.info, layer));
    let room = names.map(|name| width(&name)).fold(0.0, f32::max) + 14.0 * u;
    let name = layer_label(data.info, layer);
    let at = [panel.x + 7.0 * u + 0.5 * width(&name), top + 9.0 * u];
    labels::word(canvas, at, data, &name);
    let shift = shift(data.body, layer);
    let marks: Vec<Mark> = data
        .first_breaks()
        .filter(|(_, r)| r.layer == layer)
        .filter_map(|(number, r)| {
            let at = data.seen_end(r, camera, shift)?;
            let words = data.words(number, r, false);
            Some(Mark { number, words: [words.clone(), words], at })
        })
        .collect();
    let space = if outermost { panel.h - 24.0 * u } else { panel.h }
        - (2.0 * data.body.layer_radius[layer] + 0.12 * data.body.radius) * camera.scale;
    let band = Rect::new(panel.x + room, top, panel.w - room - 4.0 * u, space.max(17.0 * u));
    labels::breaks(canvas, band, data, &marks);
}
