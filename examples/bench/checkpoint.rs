//! What a checkpoint costs: its state is gathered, written and brought to the disk while the run waits.

use crate::Args;
use crate::measure::load;
use std::time::{Duration, Instant};
use strandsnap::base::error::{Error, Result};
use strandsnap::engine::Engine;
use strandsnap::observe::partial;
use strandsnap::run::checkpoint::{Identity, Keeper, LoopPosition};
use strandsnap::run::folder::TRAJECTORY;
use strandsnap::run::{DeviceChoice, Outputs, assemble};
use strandsnap::scene::write;

/// Checkpoints that are timed.
const TIMED: usize = 12;

/// Measures and prints: time and size, in the folder for temporary files.
pub fn print(args: &Args) -> Result<()> {
    let scene = load(args, 1.0)?;
    let assembly = assemble(&scene)?;
    let particles = assembly.len();
    let mut engine = Engine::new(&scene.spec, &scene.plan, assembly)?;
    let folder = tempfile::tempdir().map_err(|e| Error::io("cannot make", "a folder", e))?;
    let trajectory = partial::name(&folder.path().join(TRAJECTORY));
    std::fs::write(&trajectory, "").map_err(|e| Error::io("cannot write", &trajectory, e))?;
    let identity = Identity::new(write::to_toml(&scene.spec));
    let outputs = Outputs { frames: false, recording: false, animation: None, device: DeviceChoice::Processor };
    let mut keeper = Keeper::new(folder.path(), scene.spec.output.checkpoint, identity, outputs, None);
    let (mut gathered, mut written, mut bytes) = (Duration::ZERO, Duration::ZERO, 0);
    for _ in 0..TIMED {
        (0..50).try_for_each(|_| engine.step())?;
        let begin = Instant::now();
        let state = engine.save();
        gathered += begin.elapsed();
        bytes = state.len();
        let begin = Instant::now();
        keeper.keep(LoopPosition {
            step: engine.steps(),
            driver: Vec::new(),
            engine: state,
            stepping: Duration::ZERO,
            observing: Duration::ZERO,
        })?;
        written += begin.elapsed();
    }
    let ms = |all: Duration| all.as_secs_f64() * 1e3 / TIMED as f64;
    println!("\nCheckpoint, at its default once in a hundred times what it takes, or more rarely");
    println!(
        "gather the state {:.2} ms, write it and wait for the disk {:.2} ms; {:.1} MB, {} bytes per particle",
        ms(gathered),
        ms(written),
        bytes as f64 * 1e-6,
        bytes / particles
    );
    Ok(())
}
