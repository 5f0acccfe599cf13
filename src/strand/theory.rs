//! A scene's strand as strand theory sees it, and what that theory expects of a pull between grips that hold every wire.

use crate::base::lay::least_radius_of_layer;
use crate::reference::strand::{self, Layer, Wire, Wrench};
use crate::scene::spec::{DriveSpec, GripKind, LayerSpec, PathSpec, Spec, StrandSpec, WireSpec};
use crate::strand::lay_radius;

/// A strand, or straight parallel wires, with what theory expects of it per unit of strain.
#[derive(Debug, Clone, PartialEq)]
pub struct Theory {
    /// Layers from the inside out; straight wires given one by one are a layer each.
    pub layers: Vec<Layer>,
    /// Axial force and torque over strain, ends held, elastic, each layer resting on the one below.
    pub wrench: Wrench,
    /// Section of all wires (m²).
    pub area: f64,
    /// Strain at which loose layers have closed in (-); 0 where none is loose.
    pub closing_strain: f64,
}

impl Theory {
    /// Theory of the bodies of `spec`; `None` when it has none for them: free spheres, wires that are neither laid in
    /// layers nor straight along z and equally long, layers that do not fit.
    pub fn of(spec: &Spec) -> Option<Self> {
        let (layers, gaps, materials) = match &spec.strand {
            Some(strand) if spec.wires.is_empty() => {
                let (layers, gaps) = laid(strand)?;
                (layers, gaps, strand.layers.iter().map(|layer| layer.material).collect::<Vec<_>>())
            }
            None if !spec.wires.is_empty() => {
                let (layers, gaps) = straight(&spec.wires)?;
                (layers, gaps, spec.wires.iter().map(|wire| wire.material).collect())
            }
            _ => return None,
        };
        let elastic = |number: usize| {
            let material = spec.material_at(number).material;
            [material.young, material.poisson]
        };
        let materials: Vec<[f64; 2]> = materials.into_iter().map(elastic).collect();
        let wrench = strand::elastic_of_materials(&layers, &materials, Wire::Extensible);
        let closing_strain = strand::closing_strain(&layers, &gaps);
        Some(Self { area: strand::area(&layers), wrench, closing_strain, layers })
    }

    /// The same, for a scene whose grips pull it as the theory assumes: all wires held, no turning, nothing else that
    /// holds or loads it.
    pub fn of_pull(spec: &Spec) -> Option<Self> {
        let grip = spec.grip.as_ref()?;
        let held = grip.kind == GripKind::All && grip.rotation_rate == 0.0 && !grip.free_rotation;
        let pulled = matches!(grip.drive, DriveSpec::Speed(speed) if speed > 0.0);
        if held && pulled && spec.holds.is_empty() && spec.spheres.is_empty() { Self::of(spec) } else { None }
    }

    /// Nominal modulus: force per strain over the wires' sections (Pa).
    pub fn modulus(&self) -> f64 {
        self.wrench.force / self.area
    }
}

fn laid(strand: &StrandSpec) -> Option<(Vec<Layer>, Vec<f64>)> {
    let radii = lay_radius::resolve(&strand.layers).ok()?;
    let layer = |(layer, radius): (&LayerSpec, &f64)| Layer {
        wires: layer.wires,
        diameter: layer.wire_diameter,
        radius: *radius,
        pitch: layer.pitch,
        lay: layer.lay,
    };
    let gaps = (0..radii.len()).map(|k| gap(&strand.layers, &radii, k)).collect();
    Some((strand.layers.iter().zip(&radii).map(layer).collect(), gaps))
}

/// Radial distance by which layer `k` can move in before its wires touch each other or, crest on crest, those below (m).
fn gap(layers: &[LayerSpec], radii: &[f64], k: usize) -> f64 {
    let layer = &layers[k];
    if radii[k] == 0.0 {
        return 0.0;
    }
    let own = least_radius_of_layer(layer.wires, layer.wire_diameter, layer.pitch).unwrap_or(0.0);
    let rest = k.checked_sub(1).map_or(0.0, |b| radii[b] + 0.5 * (layers[b].wire_diameter + layer.wire_diameter));
    // Lay radii are found to rounding.
    let gap = radii[k] - own.max(rest);
    if gap > 1e-6 * layer.wire_diameter { gap } else { 0.0 }
}

/// Straight parallel wires between the same two planes.
fn straight(wires: &[WireSpec]) -> Option<(Vec<Layer>, Vec<f64>)> {
    let ends = |wire: &WireSpec| match wire.path {
        PathSpec::Straight { from, to } if from.truncate() == to.truncate() => {
            Some([from.z.min(to.z), from.z.max(to.z)])
        }
        _ => None,
    };
    let first = ends(wires.first()?)?;
    let alike = wires.iter().all(|wire| ends(wire) == Some(first));
    let layer =
        |wire: &WireSpec| Layer { wires: 1, diameter: wire.diameter, radius: 0.0, pitch: f64::INFINITY, lay: 1.0 };
    alike.then(|| (wires.iter().map(layer).collect(), vec![0.0; wires.len()]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn theory(name: &str, set: &[&str]) -> Option<Theory> {
        let set: Vec<String> = set.iter().map(ToString::to_string).collect();
        Theory::of_pull(&crate::scene::load(name, &set).unwrap().spec)
    }

    #[test]
    fn shipped_strands_have_a_theory() {
        let ka4 = theory("ka4", &[]).unwrap();
        assert!((ka4.modulus() / 110.4e9 - 1.0).abs() < 5e-3, "{}", ka4.modulus());
        // The outer layer's wires touch each other at 1.142 mm, to a micrometre, before they touch the middle layer.
        assert!((ka4.closing_strain - 0.023 / 1.165 * 0.187_69f64.powi(2)).abs() < 3.1e-5, "{}", ka4.closing_strain);
        assert_eq!(theory("strand-1x7", &[]).unwrap().closing_strain, 0.0);
        let wire = theory("single-wire", &[]).unwrap();
        assert!((wire.modulus() / 115e9 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn other_loads_have_none() {
        assert_eq!(theory("jaw-grip", &[]), None);
        assert_eq!(theory("torsion", &[]), None);
        assert_eq!(theory("cantilever", &[]), None);
        assert_eq!(theory("ka4", &["grip.speed=-1 m/s", "grip.adaptive="]), None);
        assert_eq!(theory("two-spheres", &[]), None);
    }
}
