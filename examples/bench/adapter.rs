//! Steps on a graphics adapter, one strand or several at once, beside the processor's.

use crate::Args;
use crate::measure::{load, pulled};
use serde::Serialize;
use std::time::Instant;
use strandsnap::base::error::{Error, Result};
use strandsnap::engine::Engine;
use strandsnap::gpu::{Device, Stepper};
use strandsnap::run::{assemble, in_pool};
use strandsnap::scene::Scene;

/// Strands that are stepped at once.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    adapter: String,
    driver: String,
    kind: &'static str,
    strands: usize,
    particles: usize,
    candidates: usize,
    contacts: usize,
    /// Wall time of a step of all strands (µs).
    us_per_step: f64,
    particle_steps_per_s: f64,
    /// The same strands one after the other on the processor, on the first number of threads (µs).
    processor_us_per_step: f64,
}

/// Measures and prints: each number of strands in the state in which the bench measures the processor.
pub fn print(args: &Args, name: &str) -> Result<Vec<Row>> {
    let device = if name == "gpu" { Device::open()? } else { Device::open_named(name)? };
    let scene = load(args, 1.0)?;
    let threads = args.threads.first().copied();
    let (mut engine, _) = in_pool(threads, || pulled(args, &scene))??;
    let state = engine.save();
    let began = Instant::now();
    (0..args.steps).try_for_each(|_| engine.step())?;
    let alone = began.elapsed().as_secs_f64() * 1e6 / args.steps as f64;
    println!("\nSteps on {} ({}), {}", device.adapter.name, device.adapter.driver, device.adapter.kind);
    let mut rows = Vec::new();
    for strands in &args.batch {
        let seconds = (0..args.repeats).map(|_| together(args, &scene, &device, &state, *strands));
        let seconds = seconds.collect::<Result<Vec<f64>>>()?.into_iter().fold(f64::INFINITY, f64::min);
        let particles = strands * engine.assembly().len();
        let (_, candidates, contacts) = engine.contact_counts();
        let row = Row {
            adapter: device.adapter.name.clone(),
            driver: device.adapter.driver.clone(),
            kind: device.adapter.kind,
            strands: *strands,
            particles,
            candidates: strands * candidates,
            contacts: strands * contacts,
            us_per_step: seconds * 1e6 / args.steps as f64,
            particle_steps_per_s: particles as f64 * args.steps as f64 / seconds,
            processor_us_per_step: alone * *strands as f64,
        };
        println!(
            "{strands} at once, {particles} particles: {:.1} µs per step, {:.3e} particle-steps/s; processor {:.1} µs on {} threads",
            row.us_per_step, row.particle_steps_per_s, row.processor_us_per_step, args.threads[0]
        );
        rows.push(row);
    }
    Ok(rows)
}

/// Wall time in which several copies of a strand do their steps (s), each driven by a thread of its own.
fn together(args: &Args, scene: &Scene, device: &Device, state: &[u8], strands: usize) -> Result<f64> {
    let copy = |_| -> Result<(Engine, Stepper)> {
        let mut engine = Engine::new(&scene.spec, &scene.plan, assemble(scene)?)?;
        engine.set_threads(1)?;
        engine.restore(state).map_err(|unfit| Error::input(unfit.to_string(), "report this"))?;
        let stepper = Stepper::new(device, &engine)?;
        Ok((engine, stepper))
    };
    let mut copies = (0..strands).map(copy).collect::<Result<Vec<_>>>()?;
    // What is compiled and laid out once does not count.
    let mut took = 0.0;
    for steps in [64, args.steps] {
        let began = Instant::now();
        std::thread::scope(|scope| {
            let each = copies.iter_mut().map(|(engine, stepper)| scope.spawn(move || stepper.advance(engine, steps)));
            let each: Vec<_> = each.collect();
            each.into_iter().try_for_each(|thread| thread.join().expect("a thread that steps does not panic"))
        })?;
        took = began.elapsed().as_secs_f64();
    }
    Ok(took)
}
