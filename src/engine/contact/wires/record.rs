//! What a contact of smooth wires remembers.

use super::beside::Answer;
use super::curve::Place;
use crate::engine::contact::pair::History;
use crate::law::contact::NormalLaw;
use crate::law::contact::line::CELLS;
use crate::law::tangential::TangentialLaw;
use serde::{Deserialize, Serialize};

/// All of every cell counts.
pub const WHOLE: [f64; CELLS] = [1.0; CELLS];

/// What meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Kind {
    /// A stretch of wire against a wire.
    Stretch,
    /// A ball against a body.
    Ball,
    /// The two ends of a broken bond.
    Ends,
}

/// How a stretch meets a wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mode {
    /// Side by side: cells along the stretch.
    Line,
    /// Across: a patch around the narrowest place, which the cells would not resolve.
    Point,
}

/// What came out for a stretch beside another wire.
#[expect(clippy::large_enum_variant, reason = "it lives on the stack for one contact")]
pub enum Touch {
    /// Nothing touches, at a gap of `gap` (m); the foot is at `t`.
    Apart { t: f64, gap: f64 },
    /// They touch, or did at the last step.
    Here {
        answer: Answer<f64>,
        t: f64,
        /// Sum of the radii (m).
        touching: f64,
        per_length: f64,
        /// Of the gap (1/m).
        curvature: f64,
    },
}

/// Particle `i` against another body near `place` of it, as it is worked with; [`Store`](super::store::Store) keeps less.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Contact<N: NormalLaw, T: TangentialLaw> {
    /// Nothing can touch until [`State::travel`](crate::engine::state::State::travel) has reached this (m).
    pub quiet_until: f64,
    pub place: Place,
    pub i: u32,
    pub kind: Kind,
    pub mode: Mode,
    /// Whether an end of either wire is near.
    pub edge: bool,
    /// Two pieces of one wire, one of which has not yet passed the end of the other.
    pub end_to_end: bool,
    /// Taken over by the next list.
    pub taken: bool,
    pub history: History<N, T>,
    /// Greatest overlap of each cell so far (m); across, of the patch in the first.
    pub dents: [f64; CELLS],
    /// What part of each cell counted at the last step (-).
    pub shares: [f64; CELLS],
    /// Length of a cell along the undeformed wire (m).
    pub cell_length: f64,
    /// Stiffness per length (Pa), of the angle at which they came to touch: what is stored changes by work alone.
    pub per_length: f64,
    /// 2ξ√m* (√kg).
    pub viscosity: f64,
    /// Overlap at the last step, at its deepest (m).
    pub overlap: f64,
    /// Sum of the radii at the last step, less the overlap that does not count (m).
    pub reach: f64,
    /// Length of a stretch (m), and curvature of its gap (1/m), at the last step.
    pub length: f64,
    pub curvature: f64,
    /// Elastic energy of the normal force (J).
    pub energy: f64,
    /// Where the force acts, in bonds from the particle (-).
    pub u: f64,
    /// Lever arms of the two sides (m).
    pub arm: [f64; 2],
}

impl<N: NormalLaw, T: TangentialLaw> Contact<N, T> {
    /// Particle `i` before it has touched what is near `place`, of reduced radius `reduced_radius` (m).
    #[inline(always)]
    pub fn untouched(i: u32, place: Place, kind: Kind, reduced_radius: f64, cell_length: f64) -> Self {
        Self {
            quiet_until: 0.0,
            place,
            i,
            kind,
            mode: Mode::Point,
            edge: false,
            end_to_end: false,
            taken: false,
            history: History::new(reduced_radius),
            dents: [0.0; CELLS],
            shares: WHOLE,
            cell_length,
            per_length: 0.0,
            viscosity: 0.0,
            overlap: 0.0,
            reach: 0.0,
            length: 0.0,
            curvature: 0.0,
            energy: 0.0,
            u: 0.0,
            arm: [0.0; 2],
        }
    }
}
