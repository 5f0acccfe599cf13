//! What the engine asks of contacts, whatever their laws and shape.

use super::spheres::second::SecondSides;
use crate::base::recorder::{Function, Unrecordable};
use crate::engine::bytes::Bytes;
use crate::engine::neighbours::PairList;
use crate::engine::saved::{Reader, Unfit, Writer};
use crate::engine::state::{ChunkSums, State};
use crate::engine::team::Team;
use crate::engine::time_step::Element;
use crate::engine::view::Touch;
use crate::strand::assembly::Assembly;

/// Contacts of a run.
pub trait Contacts: Send + Sync {
    /// Takes a new list of candidates; history of pairs that stay is kept. Returns what was lost with pairs that left.
    fn rebuild(&mut self, list: &PairList, state: &State, team: &Team) -> ChunkSums;
    /// Computes all contacts and adds them up per particle in `state`, but for [`Self::second_sides`]; returns the
    /// energies of the step.
    fn compute(&mut self, state: &mut State, team: &Team) -> ChunkSums;
    /// What contacts do besides what they have added up.
    fn second_sides(&self) -> Option<SecondSides<'_>>;
    /// Stored elastic energy at the positions of the last call of `compute` (J).
    fn elastic_energy(&self, state: &State) -> f64;
    /// Adds to each particle the normal forces of its contacts, without regard to direction (N).
    fn add_normal_forces(&self, onto: &mut [f64]);
    /// Shows each touching pair, in the order of the pairs.
    fn each_touch(&self, state: &State, each: &mut dyn FnMut(Touch));
    /// Number of touching pairs.
    fn active(&self) -> usize;
    /// Number of candidate pairs.
    fn candidates(&self) -> usize;
    /// Normal and tangential stiffness of each touching pair of one chunk (N/m), as they can become within `horizon` (s), in
    /// order; 0 of one that has parted by then.
    fn stiffness(&self, state: &State, chunk: usize, horizon: f64) -> Vec<[f64; 2]>;
    /// The same pairs with their `stiffness` as the bound on the time step sees them.
    fn elements(&self, state: &State, chunk: usize, stiffness: &[[f64; 2]], each: &mut dyn FnMut(Element));
    /// Memory of the stage, among `particles` particles.
    fn bytes(&self, particles: usize) -> Bytes;
    /// Puts in what the contacts remember, in their order.
    fn save(&self, out: &mut Writer);
    /// Takes up what [`Self::save`] has put in, of the particles as they are in `state`.
    ///
    /// # Errors
    /// [`Unfit`] when it is of other bodies or laws.
    fn restore(&mut self, from: &mut Reader, state: &State) -> Result<(), Unfit>;
    /// What it takes to work them out elsewhere; `None` where that cannot be.
    fn elsewhere(&self) -> Option<&dyn Elsewhere>;
    /// See [`Self::elsewhere`].
    fn elsewhere_mut(&mut self) -> Option<&mut dyn Elsewhere>;
    /// Forgets how long pairs that are apart need not be looked at: particles have moved elsewhere.
    fn look_anew(&mut self);
}

/// Contacts whose steps are done elsewhere, pair by pair.
pub trait Elsewhere {
    /// The step of a pair as a function. It takes numbers of its two particles (`first_`, `second_`), of the pair, and of the
    /// step; puts numbers of the pair: what it remembers, its `push` on the first particle, the second feels the opposite,
    /// and where particles `turn` its torques, `twist_first` and `twist_second`.
    ///
    /// # Errors
    /// [`Unrecordable`] for laws that cannot be recorded.
    fn record(&self, turn: bool) -> Result<Function, Unrecordable>;
    /// The two particles of each pair, in order.
    fn pairs(&self) -> Vec<[u32; 2]>;
    /// A number of all pairs by its name in the function, as it is now; `None` where a step makes it.
    fn numbers(&self, name: &str) -> Option<Vec<f64>>;
    /// Takes up the numbers that some steps gave; the energies of these, and the deepest contact.
    fn take(&mut self, numbers: &[(String, Vec<f64>)]) -> ChunkSums;
}

/// By how much the gap of two bodies may close while no particle moves further than 1 (-): 2 for the way of both, the
/// rest for wires that thicken as they shorten. So a pair that is apart need not be looked at for a while.
pub fn closing(assembly: &Assembly) -> f64 {
    let largest = assembly.radius.iter().copied().fold(0.0, f64::max);
    let shortest = assembly.rest_length.iter().copied().filter(|l| *l > 0.0).fold(f64::INFINITY, f64::min);
    // Two ends of a bond that come 2 nearer raise its log strain by 2/l, and its radius by half of that times itself; a
    // bond may be half as long as at rest.
    2.0 + 2.0 * (2.0 * largest) / shortest
}
