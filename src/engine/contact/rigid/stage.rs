//! What the engine asks of rigid bodies.

use crate::engine::bytes::Bytes;
use crate::engine::saved::{Reader, Unfit, Writer};
use crate::engine::state::{ChunkSums, State};
use crate::engine::team::Team;
use crate::engine::time_step::Element;
use crate::engine::view::BodyState;

/// What the engine asks of rigid bodies, whatever their laws.
pub trait RigidBodies: Send + Sync {
    /// Moves the bodies to where they are at the time of `state`, and adds what they do to particles to its forces and
    /// torques.
    fn compute(&mut self, state: &mut State, team: &Team) -> Outcome;
    /// Stored elastic energy at the last call of [`Self::compute`] (J).
    fn elastic_energy(&self) -> f64;
    /// Adds to each particle the normal forces of its contacts (N).
    fn add_normal_forces(&self, onto: &mut [f64]);
    /// Number of touching particles, each counted once per body.
    fn active(&self) -> usize;
    /// The contacts of one chunk as the bound on the time step sees them, as they can become within `horizon` (s).
    fn elements(&self, state: &State, chunk: usize, horizon: f64, each: &mut dyn FnMut(Element));
    /// Every body as it is now.
    fn bodies(&self) -> Vec<BodyState>;
    /// Greatest speed at which a body moves at `time` (s) or later (m/s).
    fn fastest(&self, time: f64) -> f64;
    /// Memory of the stage.
    fn bytes(&self) -> Bytes;
    /// Puts in what contacts and bodies remember.
    fn save(&self, out: &mut Writer);
    /// Takes up what [`Self::save`] has put in.
    ///
    /// # Errors
    /// [`Unfit`] when it is of other bodies or laws.
    fn restore(&mut self, from: &mut Reader, state: &State) -> Result<(), Unfit>;
}

/// What came of a step.
#[derive(Debug, Clone, Copy, Default)]
pub struct Outcome {
    /// Energies given off, and the deepest contact; its second particle is the number of particles plus that of the body.
    pub sums: ChunkSums,
    /// Work that the bodies did in the last step (J).
    pub work: f64,
    /// A particle whose centre lies inside a body, and that body.
    pub passed: Option<[usize; 2]>,
}
