//! Items of representations: sets of them, curves, solids.

use super::model::Read;
use super::reader::{Reader, Segment, within};
use super::{curves, tubes};

/// What an item gives: lines, each with the instance that names it, or why it gives none.
pub type Found = Vec<(u64, Read<Vec<Segment>>)>;

/// Kinds of items that are there for other things than lines.
const NO_LINES: [&str; 8] = [
    "AXIS2_PLACEMENT_3D",
    "AXIS2_PLACEMENT_2D",
    "AXIS1_PLACEMENT",
    "CARTESIAN_POINT",
    "VERTEX_POINT",
    "MAPPED_ITEM",
    "PLANE",
    "CARTESIAN_TRANSFORMATION_OPERATOR_3D",
];

/// Lines of an item of a representation.
pub fn item(reader: &Reader, number: u64) -> Found {
    item_at(reader, number, 0)
}

fn item_at(reader: &Reader, number: u64, depth: usize) -> Found {
    let alone = |error| vec![(number, Err(error))];
    if let Err(error) = within(depth, reader.model, number) {
        return alone(error);
    }
    let instance = match reader.model.instance(number, number) {
        Ok(instance) => instance,
        Err(error) => return alone(error),
    };
    let has = |name: &str| instance.record(name).is_some();
    // Sets of items, and where their list stands.
    const SETS: [(&str, usize, &str); 7] = [
        ("GEOMETRIC_CURVE_SET", 1, "elements: instances"),
        ("GEOMETRIC_SET", 1, "elements: instances"),
        ("SHELL_BASED_WIREFRAME_MODEL", 1, "boundary: shells"),
        ("WIRE_SHELL", 1, "extent: loops"),
        ("EDGE_BASED_WIREFRAME_MODEL", 1, "boundary: sets of edges"),
        ("CONNECTED_EDGE_SET", 1, "edges: instances"),
        ("SHELL_BASED_SURFACE_MODEL", 1, "boundary: shells"),
    ];
    if let Some((name, at, what)) = SETS.into_iter().find(|(name, ..)| has(name)) {
        let list = reader.model.expect(number, number, name, what).and_then(|set| set.references(at, what));
        return match list {
            Ok(list) => list.into_iter().flat_map(|item| item_at(reader, item, depth + 1)).collect(),
            Err(error) => alone(error),
        };
    }
    if NO_LINES.iter().any(|name| has(name)) {
        return Vec::new();
    }
    let solids = ["MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "OPEN_SHELL", "CLOSED_SHELL", "SWEPT_DISK_SOLID"];
    let segments = match solids.iter().any(|name| has(name)) {
        true => tubes::tube(reader, number),
        false => curves::curve(reader, number, number, 0),
    };
    vec![(number, segments)]
}
