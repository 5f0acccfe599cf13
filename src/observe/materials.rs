//! What layers and materials carry, where wires are of several materials: a mean of stresses alone no longer tells who
//! carries the load.

use crate::base::units::{mpa, percent};
use crate::engine::view::{RunInfo, Sample, WireInfo};
use serde::{Deserialize, Serialize};

/// A group of wires that is told of: a layer, or a material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// By its place in [`RunInfo::layers`].
    Layer(usize),
    /// By its place in [`RunInfo::materials`].
    Material(usize),
}

impl Group {
    fn has(self, wire: &WireInfo) -> bool {
        match self {
            Self::Layer(layer) => wire.layer == layer,
            Self::Material(material) => wire.material == material,
        }
    }

    /// Sections of its wires before loading (m²).
    pub fn area(self, info: &RunInfo) -> f64 {
        info.wires.iter().filter(|wire| self.has(wire)).map(WireInfo::area).sum()
    }

    /// Force that its wires carry along the body's axis at mid-gauge (N); `None` where it is not measured.
    pub fn force(self, info: &RunInfo, sample: &Sample) -> Option<f64> {
        let wires = info.wires.iter().zip(&sample.wire_pull).filter(|(wire, _)| self.has(wire));
        (!sample.wire_pull.is_empty()).then(|| wires.map(|(_, pull)| pull).sum())
    }

    /// Mean nominal stress of its wires along themselves at mid-gauge, by section (Pa); `None` where it is not measured.
    pub fn stress(self, info: &RunInfo, sample: &Sample) -> Option<f64> {
        let wires = info.wires.iter().zip(&sample.wire_stress).filter(|(wire, _)| self.has(wire));
        let force: f64 = wires.map(|(wire, stress)| stress * wire.area()).sum();
        let area = self.area(info);
        (!sample.wire_stress.is_empty() && area > 0.0).then(|| force / area)
    }
}

/// Name of a layer's material, where wires are of several and all of the layer's of one.
pub fn of_layer(info: &RunInfo, layer: usize) -> Option<&str> {
    let mut wires = info.wires_of(layer).map(|(_, wire)| wire.material);
    let first = wires.next()?;
    of_number(info, first).filter(|_| wires.all(|material| material == first))
}

/// Name of a wire's material, where wires are of several.
pub fn of_wire(info: &RunInfo, wire: usize) -> Option<&str> {
    of_number(info, info.wires.get(wire)?.material)
}

fn of_number(info: &RunInfo, number: usize) -> Option<&str> {
    info.materials.get(number).filter(|_| info.has_several_materials()).map(String::as_str)
}

/// Finds the row of the greatest force at which parts add up to it: not within two passages of a wave after a rupture, while
/// the grips do not know yet what the middle of the body has lost.
#[derive(Debug, Clone, Copy, Default)]
pub struct GreatestForce {
    force: Option<f64>,
    broken: usize,
    /// Until when rows do not count (s).
    waits_until: Option<f64>,
}

impl GreatestForce {
    /// Whether a row has the greatest force so far; rows come in order.
    pub fn see(&mut self, info: &RunInfo, sample: &Sample) -> bool {
        if sample.bonds_broken > self.broken {
            self.broken = sample.bonds_broken;
            self.waits_until = Some(sample.time + 2.0 * info.wave_passage);
        }
        let force = sample.grip_force[1];
        let settled = self.waits_until.is_none_or(|until| sample.time >= until);
        let greatest = settled && self.force.is_none_or(|most| force > most);
        if greatest {
            self.force = Some(force);
        }
        greatest
    }
}

/// Who carried how much at one moment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Shares {
    /// Strain of the body (%).
    pub strain_percent: f64,
    /// Force of the upper grip (N).
    pub force_n: f64,
    /// Layers from the inside out.
    pub layers: Vec<Share>,
    /// Materials.
    pub materials: Vec<Share>,
}

/// What a layer or a material carried.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// Its name.
    pub name: String,
    /// Sections of its wires before loading (mm²).
    pub area_mm2: f64,
    /// Force along the body's axis at mid-gauge (N).
    pub force_n: f64,
    /// Mean nominal stress of its wires along themselves at mid-gauge (MPa).
    pub stress_mpa: f64,
}

impl Shares {
    /// Those of a row; `None` where wires are of one material, or nothing is measured.
    pub fn of(info: &RunInfo, sample: &Sample) -> Option<Self> {
        let share = |group: Group, name: &String| {
            Some(Share {
                name: name.clone(),
                area_mm2: group.area(info) * 1e6,
                force_n: group.force(info, sample)?,
                stress_mpa: mpa(group.stress(info, sample)?),
            })
        };
        if !info.has_several_materials() {
            return None;
        }
        let layers = info.layers.iter().enumerate().map(|(k, name)| share(Group::Layer(k), name));
        let materials = info.materials.iter().enumerate().map(|(k, name)| share(Group::Material(k), name));
        // Spheres may be of a material that no wire is of.
        let materials = materials.flatten().filter(|share| share.area_mm2 > 0.0).collect();
        Some(Self {
            strain_percent: percent(sample.strain),
            force_n: sample.grip_force[1],
            layers: layers.collect::<Option<_>>()?,
            materials,
        })
    }
}
