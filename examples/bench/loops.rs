//! What it costs to start and end the parallel loops of a step.

use crate::machine::best;
use std::hint::black_box;
use strandsnap::base::error::Result;
use strandsnap::engine::state::CHUNK;
use strandsnap::engine::team::Team;

/// Loops of a step with contacts between spheres: kick, drift, bonds, contacts, gather. Smooth wires have one more.
const LOOPS: usize = 5;

/// Least wall time of a step's loops over the chunks of `particles` with nothing to do in them (s): each ends when all
/// threads have come to its end.
pub fn empty(threads: usize, particles: usize) -> Result<f64> {
    let team = Team::new(threads)?;
    Ok(best(|| {
        for _ in 0..LOOPS {
            team.for_each(0..particles.div_ceil(CHUNK), |chunk, _| {
                black_box(chunk);
            });
        }
    }))
}
