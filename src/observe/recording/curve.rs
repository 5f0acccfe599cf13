//! The curve and what goes with it: scalars over the timelines.

use super::names;
use super::paint::distinct;
use super::stream::{Instant, Stream};
use crate::base::error::Result;
use crate::base::units::{mpa, percent};
use crate::engine::view::{RunInfo, Sample};
use crate::observe::materials::Group;
use crate::observe::wording::wire_number;
use rerun::external::arrow::array::Float64Array;
use rerun::{Color, EntityPath, Scalars, SerializedComponentBatch, SeriesLines};
use std::sync::Arc;

const ENERGY_NAMES: [&str; 10] = [
    "work [J]",
    "kinetic [J]",
    "elastic, bonds [J]",
    "elastic, contacts [J]",
    "plastic, bonds [J]",
    "plastic, contacts [J]",
    "plastic, thinning [J]",
    "friction [J]",
    "damping [J]",
    "released by rupture [J]",
];

/// Sends the names of all series.
pub(super) fn send_names(stream: &Stream, info: &RunInfo) -> Result<()> {
    let body = SeriesLines::new().with_names(["nominal stress [MPa]"]).with_colors([Color::from_rgb(255, 255, 255)]);
    stream.fixed(names::BODY_STRESS, &body.with_widths([2.5]))?;
    if info.gauge.is_some() {
        stream.fixed(names::BODY_STRAIN, &SeriesLines::new().with_names(["strain [%]"]))?;
    }
    let layers = SeriesLines::new()
        .with_names(info.layers.iter().map(|name| format!("{name} layer [MPa]")))
        .with_colors((0..info.layers.len()).map(|i| Color::from_u32(distinct(i))))
        .with_widths(vec![2.0; info.layers.len()]);
    stream.fixed(names::LAYER_STRESS, &layers)?;
    for layer in 0..info.layers.len() {
        let wires = info.wires_of(layer).map(|(number, _)| format!("wire {} [MPa]", wire_number(number)));
        stream.fixed(names::layer(names::WIRE_STRESS, info, layer), &SeriesLines::new().with_names(wires))?;
    }
    if info.has_several_materials() {
        let lines = |count: usize, names: Vec<String>| {
            SeriesLines::new().with_names(names).with_colors((0..count).map(|i| Color::from_u32(distinct(i))))
        };
        let named = |what: &[String], unit: &str| what.iter().map(|name| format!("{name} [{unit}]")).collect();
        let (materials, layers) = (&info.materials, &info.layers);
        stream.fixed(names::MATERIAL_STRESS, &lines(materials.len(), named(materials, "MPa")))?;
        stream.fixed(names::MATERIAL_FORCE, &lines(materials.len(), named(materials, "N")))?;
        stream.fixed(names::LAYER_FORCE, &lines(layers.len(), named(layers, "N")))?;
    }
    stream.fixed(names::BROKEN, &SeriesLines::new().with_names(["wires broken", "bonds broken"]))?;
    stream.fixed(names::ENERGY, &SeriesLines::new().with_names(ENERGY_NAMES))
}

/// Sends rows of the curve.
pub(super) fn send(stream: &Stream, info: &RunInfo, samples: &[Sample]) -> Result<()> {
    let instants: Vec<_> = samples.iter().map(instant).collect();
    let series = |path: EntityPath, values: &dyn Fn(&Sample) -> Vec<f64>| {
        let rows: Vec<Vec<f64>> = samples.iter().map(values).collect();
        let lengths = rows.iter().map(Vec::len).collect();
        let array = Arc::new(Float64Array::from(rows.concat()));
        stream.rows(path, &instants, [(SerializedComponentBatch::new(array, Scalars::descriptor_scalars()), lengths)])
    };
    if info.gauge.is_some() {
        series(names::BODY_STRAIN.into(), &|s| vec![percent(s.strain)])?;
    }
    series(names::BODY_STRESS.into(), &|s| vec![mpa(s.stress)])?;
    series(names::LAYER_STRESS.into(), &|s| s.layer_stress.iter().copied().map(mpa).collect())?;
    for layer in 0..info.layers.len() {
        let wires: Vec<_> = info.wires_of(layer).map(|(number, _)| number).collect();
        let stress = |s: &Sample| wires.iter().map(|w| mpa(s.wire_stress[*w])).collect();
        series(names::layer(names::WIRE_STRESS, info, layer), &stress)?;
    }
    if info.has_several_materials() {
        let materials = || (0..info.materials.len()).map(Group::Material);
        let layers = || (0..info.layers.len()).map(Group::Layer);
        let stress = |group: Group, s: &Sample| group.stress(info, s).map(mpa).unwrap_or_default();
        let force = |group: Group, s: &Sample| group.force(info, s).unwrap_or_default();
        series(names::MATERIAL_STRESS.into(), &|s| materials().map(|group| stress(group, s)).collect())?;
        series(names::MATERIAL_FORCE.into(), &|s| materials().map(|group| force(group, s)).collect())?;
        series(names::LAYER_FORCE.into(), &|s| layers().map(|group| force(group, s)).collect())?;
    }
    series(names::BROKEN.into(), &|s| vec![s.wires_broken as f64, s.bonds_broken as f64])?;
    series(names::ENERGY.into(), &energies)
}

/// Where on the timelines a sample is.
pub(super) fn instant(sample: &Sample) -> Instant {
    Instant { step: sample.step, time: sample.time, strain: sample.strain }
}

fn energies(sample: &Sample) -> Vec<f64> {
    let e = &sample.energy;
    vec![
        e.work,
        e.kinetic,
        e.elastic_bonds,
        e.elastic_contacts,
        e.plastic_bonds,
        e.plastic_contacts,
        e.plastic_thinning,
        e.friction,
        e.damping,
        e.released,
    ]
}
