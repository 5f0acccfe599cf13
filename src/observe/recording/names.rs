//! Names of entities: by layer and wire, so that either can be hidden or selected.

use crate::engine::view::RunInfo;
use crate::observe::wording::wire_number;
use rerun::EntityPath;
use rerun::external::re_log_types::EntityPathPart;

/// Strand, by layer and wire.
pub const STRAND: &str = "strand";
/// Free spheres.
pub const SPHERES: &str = "spheres";
/// Grips.
pub const GRIPS: &str = "grips";
/// Nominal stress of the body [MPa].
pub const BODY_STRESS: &str = "stress/body";
/// Nominal stress of the layers [MPa].
pub const LAYER_STRESS: &str = "stress/layers";
/// Nominal stress of the wires [MPa], an entity per layer.
pub const WIRE_STRESS: &str = "stress/wires";
/// Wires and bonds broken so far.
pub const BROKEN: &str = "broken";
/// Energy ledger [J].
pub const ENERGY: &str = "energy";
/// Unrolled map, by layer.
pub const MAP: &str = "map";
/// State of each wire over time.
pub const STATES: &str = "states";
/// Labels of a wire's rupture marks, below them.
pub const LABEL: &str = "label";
/// One line per rupture.
pub const LOG: &str = "ruptures";
/// What the run is.
pub const ABOUT: &str = "about";

/// The layer's name as a part of a path; a layer without a name is called by its number.
fn layer_part(info: &RunInfo, layer: usize) -> String {
    match info.layers[layer].as_str() {
        "" => format!("layer_{}", layer + 1),
        name => name.to_owned(),
    }
}

/// Entity of a layer below `root`.
pub fn layer(root: &str, info: &RunInfo, layer: usize) -> EntityPath {
    EntityPath::from(root).join(&vec![EntityPathPart::new(layer_part(info, layer))].into())
}

/// Entity of a wire below its layer below `root`: `/strand/outer/wire_24`.
pub fn wire(root: &str, info: &RunInfo, wire: usize) -> EntityPath {
    let part = EntityPathPart::new(format!("wire_{:02}", wire_number(wire)));
    layer(root, info, info.wires[wire].layer).join(&vec![part].into())
}

/// Entity of a wire's tube, below the wire so that it is hidden with it.
pub fn tube(root: &str, info: &RunInfo, number: usize) -> EntityPath {
    wire(root, info, number).join(&EntityPath::from("tube"))
}

/// Entity of a wire's rupture marks, below the wire so that they are hidden with it.
pub fn marks(root: &str, info: &RunInfo, number: usize) -> EntityPath {
    wire(root, info, number).join(&EntityPath::from("ruptures"))
}
