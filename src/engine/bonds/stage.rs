//! What the engine asks of bonds, whatever their law.

use crate::base::recorder::Function;
use crate::engine::bytes::Bytes;
use crate::engine::rupture::Criterion;
use crate::engine::saved::{Reader, Unfit, Writer};
use crate::engine::state::{ChunkSums, State};
use crate::engine::team::Team;
use crate::engine::time_step::Element;

/// Bonds of a run.
pub trait Bonds: Send + Sync {
    /// Computes every bond's action on its particles from `state`; returns the energies of the step.
    fn compute(&mut self, state: &mut State, team: &Team) -> ChunkSums;
    /// Breaks the bonds that reached their limit; calls `broke(slot, cause, true axial stress [Pa])` for each, in order,
    /// and returns the elastic energy that they held (J).
    fn rupture(&mut self, state: &mut State, broke: &mut dyn FnMut(usize, Criterion, f64)) -> f64;
    /// Stored elastic energy (J).
    fn elastic_energy(&self, state: &State) -> f64;
    /// The bonds of one chunk as the bound on the time step sees them, in order.
    fn elements(&self, state: &State, chunk: usize, each: &mut dyn FnMut(Element));
    /// True axial stress of a bond (Pa).
    fn stress(&self, slot: usize) -> f64;
    /// Axial force of a bond (N).
    fn axial_force(&self, slot: usize) -> f64;
    /// Equivalent plastic strain of a bond (-).
    fn plastic_strain(&self, slot: usize) -> f64;
    /// Share of its rupture limit that a bond has reached (-): it breaks at 1. 0 without a rupture criterion.
    fn utilisation(&self, slot: usize, state: &State) -> f64;
    /// Memory of the stage.
    fn bytes(&self) -> Bytes;
    /// A step of a bond as a function.
    ///
    /// # Errors
    /// Why it cannot be recorded.
    fn record(&self) -> Result<Function, String>;
    /// A number of every slot, by its name in that function.
    fn numbers(&self, name: &str) -> Option<Vec<f64>>;
    /// Takes up a number of every slot that the function has given, if bonds remember a number of this name.
    fn set_numbers(&mut self, name: &str, numbers: &[f64]);
    /// Puts in what the bonds remember.
    fn save(&self, out: &mut Writer);
    /// Takes up what [`Self::save`] has put in.
    ///
    /// # Errors
    /// [`Unfit`] when it is of other bonds.
    fn restore(&mut self, from: &mut Reader) -> Result<(), Unfit>;
}
