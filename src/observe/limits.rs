//! How near a run came to the limits of its model, as written to `summary.json`.

use crate::base::finding::{Body, StepLimit};
use crate::base::units::{mm, mpa, percent};
use crate::engine::view::{self, StepAt};
use serde::{Deserialize, Serialize};

/// The deepest contact, the range of the time step, the ledger's greatest gap.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Limits {
    /// The deepest contact; `None` when nothing touched.
    pub deepest_contact: Option<Deepest>,
    /// The least time step and what limited it.
    pub least_time_step: Step,
    /// The greatest time step and what limited it.
    pub greatest_time_step: Step,
    /// Most energy that was unaccounted for at any row, over the most work done until then (%); `None` at rest.
    pub energy_residual_greatest_percent: Option<f64>,
}

/// The deepest contact of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Deepest {
    /// Overlap over the smaller of the two radii (%).
    pub overlap_percent_of_radius: f64,
    /// The two bodies.
    pub between: [Body; 2],
    /// Where (mm).
    pub z_mm: f64,
    /// Strain of the body (%); `None` without grips.
    pub strain_percent: Option<f64>,
    /// Simulated time (s).
    pub time_s: f64,
    /// Step.
    pub step: u64,
    /// Normal force (N).
    pub force_n: f64,
    /// Force over the area of the contact (MPa): πR*δ of a circle, Σ √(2R*δ) ds of a patch along a smooth wire.
    pub pressure_mpa: f64,
}

/// A time step and when it was chosen.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Step {
    /// The time step (s).
    pub seconds: f64,
    /// Strain of the body (%); `None` without grips.
    pub strain_percent: Option<f64>,
    /// Simulated time (s).
    pub time_s: f64,
    /// What limited it.
    pub limited_by: StepLimit,
}

impl Limits {
    /// What the engine saw, and the ledger's greatest gap (-).
    pub fn new(seen: view::Findings, residual: Option<f64>) -> Self {
        Self {
            deepest_contact: seen.deepest.map(|at| Deepest {
                overlap_percent_of_radius: percent(at.ratio),
                between: at.bodies,
                z_mm: mm(at.position[2]),
                strain_percent: at.strain.map(percent),
                time_s: at.time,
                step: at.step,
                force_n: at.force,
                pressure_mpa: mpa(at.pressure),
            }),
            least_time_step: step(seen.least_step),
            greatest_time_step: step(seen.greatest_step),
            energy_residual_greatest_percent: residual.map(percent),
        }
    }
}

fn step(at: StepAt) -> Step {
    Step { seconds: at.seconds, strain_percent: at.strain.map(percent), time_s: at.time, limited_by: at.limit }
}
