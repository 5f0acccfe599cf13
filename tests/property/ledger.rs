//! The energy ledger closes, whatever happens.

use crate::drive::*;
use proptest::prelude::*;
use strandsnap::engine::Engine;

/// Residual over the work that was done, or the greatest energy that was there [-].
fn residual(engine: &Engine) -> f64 {
    let e = engine.energy();
    let scale = e.work.abs().max(e.internal()).max(e.kinetic);
    e.residual().abs() / scale
}

/// Runs and returns the greatest residual at 40 instants.
fn greatest(engine: &mut Engine, steps: u64) -> f64 {
    let mut greatest = 0.0f64;
    for _ in 0..40 {
        run_steps(engine, steps / 40);
        greatest = greatest.max(residual(engine));
    }
    greatest
}

#[test]
fn the_ledger_of_a_strand_pulled_past_rupture_closes() {
    for shape in ["sphere", "capsule"] {
        for tangential in ["mindlin", "mindlin-deresiewicz"] {
            let mut engine =
                engine(STRAND, &[&format!("contact.shape={shape}"), &format!("contact.tangential={tangential}")]);
            let worst = greatest(&mut engine, 4000);
            let e = engine.energy();
            println!("{shape} {tangential}: {worst:e} {e:?} {}", engine.take_ruptures().len());
            assert!(e.released > 0.0 && e.friction > 0.0 && e.plastic_contacts > 0.0 && e.plastic_thinning != 0.0);
            assert!(worst < 0.01, "{shape} {tangential}: {worst}");
        }
    }
}
