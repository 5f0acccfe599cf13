//! What has been told of a run up to a frame: what its charts and the way of its eye follow from.

use super::body::Body;
use super::close_up::{CloseUp, Focus};
use super::kind::Kind;
use crate::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use crate::scene::spec::CameraSpec;

/// What charts draw of a row of the curve, in SI.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Row {
    /// Simulated time (s).
    pub time: f64,
    /// Strain of the body (-).
    pub strain: f64,
    /// Nominal stress (Pa).
    pub stress: f64,
    /// Torque on the upper grip (N m).
    pub torque: f64,
}

impl From<&Sample> for Row {
    fn from(sample: &Sample) -> Self {
        Self { time: sample.time, strain: sample.strain, stress: sample.stress, torque: sample.torque }
    }
}

/// Everything so far.
#[derive(Debug, Clone, Default)]
pub struct History {
    /// Rows of the curve.
    pub rows: Vec<Row>,
    /// Ruptures, in order.
    pub ruptures: Vec<Rupture>,
    /// Time (s) and what is measured of a body without grips (m or m/s), per snapshot: [`Kind::measure`].
    pub(super) measured: Vec<[f64; 2]>,
    close_up: CloseUp,
}

impl History {
    /// That of a run that is over, all of whose ruptures are known: its close-ups look at the main fracture from the first
    /// frame, and need not move there.
    pub fn knowing(ruptures: Vec<Rupture>) -> Self {
        Self { close_up: CloseUp::knowing(ruptures), ..Self::default() }
    }

    /// Goes on to a snapshot, after its rows and ruptures were added, whether it is drawn or not.
    pub(super) fn follow(&mut self, info: &RunInfo, body: &Body, look: &CameraSpec, snapshot: &Snapshot) {
        self.close_up.follow(info, body, look, &self.ruptures);
        if let Some(value) = Kind::of(info).measure(info, snapshot) {
            self.measured.push([snapshot.sample.time, value]);
        }
    }

    /// Where close-ups look now.
    pub(super) fn focus(&self, info: &RunInfo, body: &Body) -> Focus {
        self.close_up.focus(info, body, &self.ruptures)
    }
}
