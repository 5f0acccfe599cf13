//! How large a scene becomes, from its keys alone: before anything is laid up or allocated.

use crate::scene::spec::{PathSpec, Shape, Spec};
use std::f64::consts::TAU;

/// Most wires of a scene (-): lay radii are compared wire by wire.
pub const MOST_WIRES: f64 = 5000.0;
/// Particles that one wire has before its length counts as what makes a scene large (-).
const LONG: f64 = 1e4;
/// Spacing over diameter below which that is it (-).
const DENSE: f64 = 0.3;

/// Memory of a particle by stage, as [`crate::engine::bytes`] counts it and rounded up (bytes): the body, motion and
/// rotation; its bond; the bound on the time step.
const BARE: f64 = 290.0 + 350.0 + 60.0;
/// Contacts and neighbours of a chain of spheres, of smooth wires, in full contact (bytes a particle).
const SPHERES: f64 = 450.0;
const SMOOTH: f64 = 1050.0;
/// What laying it up and looking for overlaps takes beside (bytes a particle).
const LAY_UP: f64 = 500.0;
/// Contacts of a particle in a strand: three by which it touches the layers beside its own, two to its own.
const CONTACTS: f64 = 5.0;

/// The size of a scene. Numbers are floating so that no size is too large to be told.
#[derive(Debug, Clone, PartialEq)]
pub struct Size {
    /// Wires (-).
    pub wires: f64,
    /// Particles, free spheres included (-): exact for straight wires, to a per cent or two for laid ones.
    pub particles: f64,
    /// Bonds (-).
    pub bonds: f64,
    /// Most contacts at a time (-), roughly.
    pub contacts: f64,
    /// Memory at most (bytes), roughly.
    pub memory: f64,
    /// The scene's key that makes it as large as it is.
    pub key: String,
}

/// Wires that are alike.
struct Part {
    wires: f64,
    /// Pieces of each.
    pieces: f64,
    key: &'static str,
    index: Option<usize>,
}

impl Size {
    /// Of a scene.
    pub fn of(spec: &Spec) -> Self {
        let parts: Vec<Part> = laid(spec).chain(single(spec)).collect();
        let wires = parts.iter().map(|part| part.wires).sum();
        let bonds: f64 = parts.iter().map(|part| part.wires * part.pieces).sum();
        let particles = bonds + wires + spec.spheres.len() as f64;
        let touching = spec.contact.as_ref().map(|contact| contact.shape);
        let of_contacts = match touching {
            None => 0.0,
            Some(Shape::Sphere) => SPHERES,
            Some(Shape::Wire) => SMOOTH,
        };
        Self {
            wires,
            particles,
            bonds,
            contacts: if touching.is_some() { CONTACTS * particles } else { 0.0 },
            memory: particles * (BARE + of_contacts + LAY_UP),
            key: blame(spec, &parts),
        }
    }
}

/// The layers of the strand.
fn laid(spec: &Spec) -> impl Iterator<Item = Part> {
    let mut outer = 0.0;
    let layers = spec.strand.iter().flat_map(|strand| strand.layers.iter().map(|layer| (strand.length, layer)));
    layers.enumerate().map(move |(k, (length, layer))| {
        let d = layer.wire_diameter;
        // Side by side around the layers below.
        let least = if layer.wires == 1 { outer } else { f64::max(outer + 0.5 * d, layer.wires as f64 * d / TAU) };
        let radius = layer.lay_radius.unwrap_or(least);
        outer = radius + 0.5 * d;
        let arc = length * (TAU * radius / layer.pitch).hypot(1.0);
        Part {
            wires: layer.wires as f64,
            pieces: (arc / (spec.spacing * d)).round(),
            key: "strand.length",
            index: Some(k),
        }
    })
}

/// The scene's own wires.
fn single(spec: &Spec) -> impl Iterator<Item = Part> {
    spec.wires.iter().enumerate().map(|(k, wire)| {
        let (arc, key) = match &wire.path {
            PathSpec::Straight { from, to } => (from.distance(*to), "to"),
            PathSpec::File { points, .. } => (points.windows(2).map(|p| p[0].distance(p[1])).sum(), "file"),
        };
        Part { wires: 1.0, pieces: (arc / (spec.spacing * wire.diameter)).round(), key, index: Some(k) }
    })
}

/// What is furthest from usual: many wires, a dense spacing, or the length of the wires with the most particles.
fn blame(spec: &Spec, parts: &[Part]) -> String {
    let share = |part: &&Part| part.wires * (part.pieces + 1.0);
    let Some(largest) = parts.iter().max_by(|a, b| share(a).total_cmp(&share(b))) else { return "sphere".into() };
    let index = largest.index.unwrap_or(0);
    let many = largest.wires / 100.0;
    let long = largest.pieces / LONG;
    let dense = DENSE / spec.spacing;
    match (largest.key, spec.wires.len() as f64 > MOST_WIRES) {
        _ if dense > many && dense > long && dense > 1.0 => "spacing".into(),
        ("strand.length", _) if many > long => format!("strand.layer.{index}.wires"),
        ("strand.length", _) => "strand.length".into(),
        (_, true) => "wire".into(),
        (key, false) => format!("wire.{index}.{key}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    fn size(scene: &str, set: &[&str]) -> Size {
        let set: Vec<String> = set.iter().map(ToString::to_string).collect();
        Size::of(&scene::load(scene, &set).unwrap_or_else(|error| panic!("{error}")).spec)
    }

    #[test]
    fn no_size_is_too_large_to_be_told_and_its_key_is_named() {
        for (set, key) in [
            ("strand.length=80 km", "strand.length"),
            ("spacing=1e-9", "spacing"),
            ("strand.layer.1.wires=4000", "strand.layer.1.wires"),
            ("strand.layer.1.wire_diameter=1e-20 mm", "strand.length"),
        ] {
            let size = size("strand-1x7", &[set]);
            assert_eq!(size.key, key, "{size:?}");
            assert!(size.memory > 1e7 && !size.memory.is_nan(), "{size:?}");
        }
        let long = size("single-wire", &["wire.0.to=[\"0 mm\", \"0 mm\", \"90 km\"]"]);
        assert!(long.key == "wire.0.to" && long.particles > 1e8, "{long:?}");
    }
}
