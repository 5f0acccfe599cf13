//! Floor 5: observers of a run. Each gets what the engine lets out and writes one kind of output.

pub mod animation;
pub mod bodies;
pub mod colouring;
pub mod column;
pub mod details;
pub mod files;
pub mod fracture;
pub mod guard;
pub mod limits;
pub mod materials;
pub mod origin;
pub mod partial;
pub mod peaks;
pub mod planned;
#[cfg(feature = "record")]
pub mod recording;
pub mod report;
#[cfg(any(feature = "record", feature = "render"))]
pub mod shapes;
pub mod stiffness;
pub mod stress_strain;
pub mod summary;
pub mod tables;
pub mod timings;
pub mod trajectory;
pub mod unrolled;
pub mod wording;

use crate::base::error::Result;
use crate::base::finding::Notice;
use crate::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use peaks::Peaks;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Something that watches a run.
pub trait Observer {
    /// Before the first step.
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()>;
    /// A row of the curve.
    fn sample(&mut self, _sample: &Sample) -> Result<()> {
        Ok(())
    }
    /// Every particle, at the scene's output interval. Shared, so that it can be drawn or encoded on another thread.
    fn snapshot(&mut self, _snapshot: &Arc<Snapshot>) -> Result<()> {
        Ok(())
    }
    /// A bond broke.
    fn rupture(&mut self, _rupture: &Rupture) -> Result<()> {
        Ok(())
    }
    /// Something that the user must know was found.
    fn notice(&mut self, _notice: &Notice) -> Result<()> {
        Ok(())
    }
    /// The greatest stresses of the run, once, after its last row.
    fn peaks(&mut self, _peaks: &Peaks) -> Result<()> {
        Ok(())
    }
    /// The run is being stopped: what takes long and has not been begun need not be done.
    fn stopping(&mut self) {}
    /// After the last step, also of a run that was stopped: everything written so far must be made whole.
    fn finish(&mut self) -> Result<()>;
    /// [`Self::finish`] that leaves out what takes long once `stop` is set: what is not done then is not there, and does not
    /// look as if it were.
    fn finish_unless(&mut self, _stop: &AtomicBool) -> Result<()> {
        self.finish()
    }
}
