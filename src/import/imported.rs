//! What is asked of an import, and what it gives.

use super::axis::Axis;
use super::chains::Fork;
use super::fault::Unread;
use super::layers::Layer;
use crate::scene::centreline_text::CentrelineWire;
use crate::strand::overlap::Overlap;
use glam::DVec3;

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ImportOptions {
    /// What the file counts in (m); `None`: what it says.
    pub unit: Option<f64>,
    /// Diameter of wires for which the file gives none (m).
    pub diameter: Option<f64>,
    /// Greatest distance of a wire from the polygon of its points (m); `None`: a thousandth of the least diameter.
    pub chord: Option<f64>,
    /// Distance up to which ends are joined (m); `None`: see [`join`](crate::import::chains::join).
    pub reach: Option<f64>,
    /// Leave wires where they are drawn, whatever their axis.
    pub as_drawn: bool,
}

/// What there is to say of overlaps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Clearance {
    /// Wires without a diameter do not overlap; least distance of two centre lines (m), if there are two.
    NoDiameter(Option<f64>),
    /// None is deeper than nothing.
    Free,
    /// The deepest one.
    Overlaps(Overlap),
    /// There are too many points to look.
    NotLookedAt,
}

/// Wires of a file.
#[derive(Debug, Clone)]
pub struct Imported {
    /// What kind of file it is, for people.
    pub format: String,
    /// What it counts in (m); empty where that is not said.
    pub units: Vec<f64>,
    /// The wires, layer by layer from the axis, with points in metres.
    pub wires: Vec<ImportedWire>,
    /// The axis that they have in common, in the coordinates of the file (m); `None` where they have none.
    pub axis: Option<Axis>,
    /// Whether they were moved so that it is z.
    pub is_moved: bool,
    /// Layers about it; empty where there is no axis.
    pub layers: Vec<Layer>,
    /// Overlaps.
    pub clearance: Clearance,
    /// Ends that were not joined.
    pub forks: Vec<Fork>,
    /// Distance up to which ends were joined (m).
    pub reach: f64,
    /// Chord error of the points (m).
    pub chord: f64,
    /// What of the file is not used.
    pub unread: Vec<Unread>,
}

/// A wire.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportedWire {
    /// Name of its layer.
    pub layer: String,
    /// Diameter (m); `None` where neither file nor options give it.
    pub diameter: Option<f64>,
    /// Points along it (m).
    pub points: Vec<DVec3>,
    /// Number of pieces that were joined.
    pub pieces: usize,
}

impl Imported {
    /// The wires as a scene reads them.
    pub fn centrelines(&self) -> Vec<CentrelineWire> {
        let line = |wire: &ImportedWire| CentrelineWire {
            layer: wire.layer.clone(),
            diameter: wire.diameter,
            points: wire.points.clone(),
        };
        self.wires.iter().map(line).collect()
    }
}
