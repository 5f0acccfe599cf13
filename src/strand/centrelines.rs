//! Centre lines of an assembly as text, the way that CAD models exchange them.

use crate::scene::centreline_text::{self, CentrelineWire};
use crate::strand::assembly::Assembly;

/// Text of all wires' particle centres; `scene::centreline_text::parse` reads it back to the same numbers, and a scene
/// that names the file rebuilds the same particles.
pub fn export(assembly: &Assembly) -> String {
    let wires: Vec<CentrelineWire> = assembly
        .wires
        .iter()
        .map(|wire| CentrelineWire {
            layer: assembly.layers[wire.layer].name.clone(),
            diameter: Some(wire.diameter),
            points: wire.particles().map(|i| assembly.position.get(i)).collect(),
        })
        .collect();
    centreline_text::write(&wires)
}
