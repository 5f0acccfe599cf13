//! Names of entities: by layer and wire, so that either can be hidden or selected.

use crate::engine::view::{RunInfo, Rupture};
use crate::observe::wording::{self, layer_words, wire_number};
use rerun::EntityPath;
use rerun::external::re_log_types::EntityPathPart;

/// Name under which the viewer files all recordings of this program.
pub const APPLICATION: &str = "strandsnap";
/// Strand, by layer and wire.
pub const STRAND: &str = "strand";
/// Free spheres.
pub const SPHERES: &str = "spheres";
/// Rigid bodies.
pub const BODIES: &str = "bodies";
/// Grips.
pub const GRIPS: &str = "grips";
/// Nominal stress of the body (MPa).
pub const BODY_STRESS: &str = "stress/body";
/// Nominal stress of the layers (MPa).
pub const LAYER_STRESS: &str = "stress/layers";
/// Nominal stress of the wires (MPa), an entity per layer.
pub const WIRE_STRESS: &str = "stress/wires";
/// Nominal stress of the materials (MPa), where there are several.
pub const MATERIAL_STRESS: &str = "stress/materials";
/// Force along z of the materials (N), where there are several.
pub const MATERIAL_FORCE: &str = "force/materials";
/// Force along z of the layers (N), where there are several materials.
pub const LAYER_FORCE: &str = "force/layers";
/// Wires and bonds broken so far.
pub const BROKEN: &str = "broken";
/// Energy ledger (J).
pub const ENERGY: &str = "energy";
/// Unrolled map, by layer.
pub const MAP: &str = "map";
/// State of each wire over time.
pub const STATES: &str = "states";
/// Order of break of a wire on the map, below its marks.
pub const ORDER: &str = "order";
/// One line per rupture or notice.
pub const LOG: &str = "ruptures";
/// Mark and label of the first break.
pub const FIRST_BREAK: &str = "first_break";
/// The same for the view of the whole strand, where it has to stand further off.
pub const FIRST_BREAK_FAR: &str = "first_break_far";
/// What the eye of the close view follows.
pub const FOCUS: &str = "focus";
/// Stress over strain as a drawing with axes in per cent and MPa.
pub const CHART: &str = "chart";
/// What the run found, in a few words.
pub const HEADLINE: &str = "headline";
/// What the run is.
pub const ABOUT: &str = "about";

/// Field of a particle: true axial stress of its bond (MPa).
pub const STRESS: &str = "Bond:true_axial_stress_MPa";
/// Field of a particle: equivalent plastic strain of its bond (-).
pub const PLASTIC_STRAIN: &str = "Bond:equivalent_plastic_strain";
/// Field of a particle: share of the rupture limit that its bond has reached (-).
pub const UTILISATION: &str = "Bond:utilisation_to_rupture";
/// Field of a particle: contact pressure (MPa).
pub const CONTACT_PRESSURE: &str = "Bond:contact_pressure_MPa";
/// Field of a particle: state of its bond, named by the annotation context.
pub const STATE: &str = "Bond:state";
/// Field of a particle, recorded when speed gives the colour (m/s).
pub const SPEED: &str = "Bond:speed_m_per_s";

/// The layer's name as a part of a path; a layer without a name is called by its number.
fn layer_part(info: &RunInfo, layer: usize) -> String {
    match info.layers[layer].as_str() {
        "" => format!("layer_{}", layer + 1),
        name => name.to_owned(),
    }
}

/// What the label of the first break says: "first break in this strand: wire 24, outer layer".
pub fn first_break(info: &RunInfo, first: &Rupture) -> String {
    format!("{}: wire {}, {}", wording::FIRST_BREAK, wire_number(first.wire), layer_words(info, first.layer))
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
