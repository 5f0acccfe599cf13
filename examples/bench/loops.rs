//! What it costs to start and end the parallel loops of a step.

use crate::machine::best;
use rayon::prelude::*;
use std::hint::black_box;
use strandsnap::base::error::Result;
use strandsnap::engine::state::CHUNK;
use strandsnap::run::in_pool;

/// Loops of a step with contacts between spheres: kick, drift, bonds, contacts, gather. Smooth wires have one more.
const LOOPS: usize = 5;

/// Least wall time of a step's loops over the chunks of `particles` with nothing to do in them (s): each ends when all
/// threads have come to its end.
pub fn empty(threads: usize, particles: usize) -> Result<f64> {
    let chunks = particles.div_ceil(CHUNK);
    in_pool(Some(threads), || {
        best(|| {
            for _ in 0..LOOPS {
                (0..chunks).into_par_iter().with_max_len(1).for_each(|chunk| {
                    black_box(chunk);
                });
            }
        })
    })
}
