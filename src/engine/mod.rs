//! Floor 4: the engine. State as structure of arrays, stages, time step, energy ledger.

pub mod view;

use crate::base::error::Result;
use crate::scene::spec::Spec;
use crate::strand::assembly::Assembly;
use view::{RunInfo, Rupture, Sample, Snapshot};

/// One run in progress.
pub struct Engine {}

impl Engine {
    /// Sets the assembly up for its first step.
    ///
    /// # Errors
    /// When the assembly cannot be stepped (overlapping wires, no stable step).
    pub fn new(_spec: &Spec, _assembly: Assembly) -> Result<Self> {
        Ok(Self {})
    }
    /// Advances by one step.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Trouble`] when a value stops being finite or runs away.
    pub fn step(&mut self) -> Result<()> {
        Ok(())
    }
    /// Grip displacement over gauge length, now [-]. Cheap.
    pub fn strain(&self) -> f64 {
        0.0
    }
    /// Simulated time [s]. Cheap.
    pub fn time(&self) -> f64 {
        0.0
    }
    /// Steps done. Cheap.
    pub fn steps(&self) -> u64 {
        0
    }
    /// Nominal stress now [Pa]. Cheap.
    pub fn stress(&self) -> f64 {
        0.0
    }
    /// Current time step [s]. Cheap.
    pub fn time_step(&self) -> f64 {
        0.0
    }
    /// What limits the time step, in words.
    pub fn time_step_limit(&self) -> String {
        String::new()
    }
    /// Ruptures since the last call, in order.
    pub fn take_ruptures(&mut self) -> Vec<Rupture> {
        Vec::new()
    }
    /// A row of the curve.
    pub fn sample(&self) -> Sample {
        Sample::default()
    }
    /// Every particle.
    pub fn snapshot(&self) -> Snapshot {
        todo!()
    }
    /// What does not change during the run.
    pub fn info(&self) -> RunInfo {
        todo!()
    }
    /// The assembly that the run started from.
    pub fn assembly(&self) -> &Assembly {
        todo!()
    }
}
