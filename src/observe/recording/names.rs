//! Names of entities: by layer and wire, so that either can be hidden or selected.

use crate::engine::view::{RunInfo, Rupture};
use crate::observe::wording::{self, layer_words, wire_number};
use rerun::components;
use rerun::external::re_log_types::EntityPathPart;
use rerun::{Component as _, ComponentDescriptor, ComponentType, EntityPath};

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
/// Strain of the body (%).
pub const BODY_STRAIN: &str = "strain";
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
/// Unrolled map: what is drawn beside the wires, and ruptures by layer and wire.
pub const MAP: &str = "map";
/// Bar of colours, below the map.
pub const COLOUR_BAR: &str = "colour_bar";
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

/// Turn of a particle's capsule from the z axis, a quaternion in half precision.
pub const TURN: &str = "Tube:turn";
/// Length of a particle's capsule (mm).
pub const LENGTH: &str = "Tube:length";
/// Place of a particle on the unrolled map (mm along it).
pub const PLACE: &str = "Map:place";
/// Radius of the particles on the unrolled map.
pub const PLACE_RADIUS: &str = "Map:radius";

/// The descriptor of a component of our own: archetype, name, and the type of its values, which is Rerun's where Rerun has
/// one for such values.
pub(super) fn descriptor(component: &'static str) -> ComponentDescriptor {
    const BOND: &str = "strandsnap.Bond";
    const TUBE: &str = "strandsnap.Tube";
    const MAP: &str = "strandsnap.Map";
    let (archetype, kind): (&'static str, ComponentType) = match component {
        STRESS => (BOND, "strandsnap.components.TrueAxialStress".into()),
        PLASTIC_STRAIN => (BOND, "strandsnap.components.EquivalentPlasticStrain".into()),
        UTILISATION => (BOND, "strandsnap.components.Utilisation".into()),
        CONTACT_PRESSURE => (BOND, "strandsnap.components.ContactPressure".into()),
        SPEED => (BOND, "strandsnap.components.Speed".into()),
        STATE => (BOND, components::ClassId::name()),
        // Rerun's quaternions have single precision.
        TURN => (TUBE, "strandsnap.components.Turn".into()),
        LENGTH => (TUBE, components::Length::name()),
        PLACE => (MAP, components::Position2D::name()),
        PLACE_RADIUS => (MAP, components::Radius::name()),
        other => unreachable!("{other} is no component of ours"),
    };
    ComponentDescriptor::partial(component).with_archetype(archetype.into()).with_component_type(kind)
}

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

/// Entity of a wire's rupture marks, below the wire so that they are hidden with it.
pub fn marks(root: &str, info: &RunInfo, number: usize) -> EntityPath {
    wire(root, info, number).join(&EntityPath::from("ruptures"))
}
