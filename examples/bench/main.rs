//! Time per step by stage, particle-steps per second, and what recording and frames cost.
//!
//! `cargo run --release --example bench -- [--scene ka4] [--threads 1,2] [--json FILE]`
//!
//! The strand is first pulled fast (same strain rate for every length) until it is in full contact, then timed at that
//! state. Beside the scene itself the same strand ten times as long is measured.

use clap::Parser;
use serde::Serialize;
use std::time::Instant;
use strandsnap::base::error::Result;
use strandsnap::engine::{Engine, Timings};
use strandsnap::run::{assemble, in_pool};
use strandsnap::scene::{self, Scene};

#[derive(Parser)]
struct Args {
    /// Scene with a strand
    #[arg(long, default_value = "ka4")]
    scene: String,
    /// Numbers of threads
    #[arg(long, value_delimiter = ',', default_value = "1,2")]
    threads: Vec<usize>,
    /// Factors on the length of the strand
    #[arg(long, value_delimiter = ',', default_value = "1,10")]
    lengths: Vec<f64>,
    /// Strain at which is measured [%]
    #[arg(long, default_value_t = 6.0)]
    strain: f64,
    /// Strain rate of the way there [1/s]
    #[arg(long, default_value_t = 180.0)]
    rate: f64,
    /// Steps that are timed
    #[arg(long, default_value_t = 400)]
    steps: u64,
    /// Also write the rows to this file
    #[arg(long, value_name = "FILE")]
    json: Option<std::path::PathBuf>,
}

/// One measurement.
#[derive(Serialize)]
struct Row {
    scene: String,
    length_factor: f64,
    threads: usize,
    particles: usize,
    bonds: usize,
    contacts: usize,
    candidates: usize,
    ms_per_step: f64,
    particle_steps_per_s: f64,
    /// Milliseconds per step.
    stages: Stages,
    searches_per_1000_steps: f64,
}

#[derive(Serialize)]
struct Stages {
    integrate: f64,
    bonds: f64,
    contacts: f64,
    neighbours: f64,
    time_step: f64,
}

fn main() -> miette::Result<()> {
    let args = Args::parse();
    let mut rows = Vec::new();
    println!(
        "length  threads  particles  contacts  ms/step  M particle-steps/s  integrate   bonds  contacts  neighbours  bound"
    );
    for factor in &args.lengths {
        let mut engine = in_pool(None, || pulled(&args, *factor))??;
        for threads in &args.threads {
            let row = in_pool(Some(*threads), || measure(&args, &mut engine, *factor, *threads))??;
            print_row(&row);
            rows.push(row);
        }
    }
    output_cost(&args)?;
    if let Some(file) = &args.json {
        let text = serde_json::to_string_pretty(&rows).expect("rows are plain data");
        strandsnap::observe::files::write_whole(file, &text)?;
    }
    Ok(())
}

/// The scene with its strand `factor` times as long, pulled at the bench's strain rate.
fn load(args: &Args, factor: f64) -> Result<Scene> {
    let base = scene::load(&args.scene, &[])?;
    let (Some(strand), Some(grip)) = (&base.spec.strand, &base.spec.grip) else {
        return Err(base.source.error("strand", "the bench pulls a strand", "name a scene with a strand and grips"));
    };
    let length = strand.length * factor;
    let speed = args.rate * (length - 2.0 * grip.length);
    scene::load(
        &args.scene,
        &[
            format!("strand.length={} mm", length * 1e3),
            format!("grip.speed={speed} m/s"),
            "bond.rupture.strain=200 %".into(),
        ],
    )
}

/// An engine in full contact.
fn pulled(args: &Args, factor: f64) -> Result<Engine> {
    let scene = load(args, factor)?;
    let mut engine = Engine::new(&scene.spec, assemble(&scene)?)?;
    while engine.strain() < args.strain / 100.0 {
        engine.step()?;
    }
    Ok(engine)
}

fn measure(args: &Args, engine: &mut Engine, factor: f64, threads: usize) -> Result<Row> {
    let before = *engine.timings();
    let (searches, ..) = engine.contact_counts();
    let began = Instant::now();
    for _ in 0..args.steps {
        engine.step()?;
    }
    let seconds = began.elapsed().as_secs_f64() / args.steps as f64;
    let (after_searches, candidates, contacts) = engine.contact_counts();
    let particles = engine.assembly().len();
    Ok(Row {
        scene: args.scene.clone(),
        length_factor: factor,
        threads,
        particles,
        bonds: engine.assembly().bond_count(),
        contacts,
        candidates,
        ms_per_step: seconds * 1e3,
        particle_steps_per_s: particles as f64 / seconds,
        stages: stages(&before, engine.timings(), args.steps),
        searches_per_1000_steps: (after_searches - searches) as f64 * 1e3 / args.steps as f64,
    })
}

fn stages(before: &Timings, after: &Timings, steps: u64) -> Stages {
    let per_step = |b: std::time::Duration, a: std::time::Duration| (a - b).as_secs_f64() * 1e3 / steps as f64;
    Stages {
        integrate: per_step(before.integrate, after.integrate),
        bonds: per_step(before.bonds, after.bonds),
        contacts: per_step(before.contacts, after.contacts),
        neighbours: per_step(before.neighbours, after.neighbours),
        time_step: per_step(before.time_step, after.time_step),
    }
}

fn print_row(r: &Row) {
    println!(
        "{:>5}×  {:>7}  {:>9}  {:>8}  {:>7.3}  {:>18.1}  {:>9.3}  {:>6.3}  {:>8.3}  {:>10.3}  {:>5.3}",
        r.length_factor,
        r.threads,
        r.particles,
        r.contacts,
        r.ms_per_step,
        r.particle_steps_per_s * 1e-6,
        r.stages.integrate,
        r.stages.bonds,
        r.stages.contacts,
        r.stages.neighbours,
        r.stages.time_step,
    );
}

/// What one snapshot costs in the recording and as a frame.
#[cfg(all(feature = "record", feature = "render"))]
fn output_cost(args: &Args) -> Result<()> {
    use std::sync::Arc;
    use strandsnap::observe::Observer;
    use strandsnap::observe::recording::{Recording, RecordingOptions};
    use strandsnap::render::{FrameOptions, Renderer, check, png};

    const SHOWN: usize = 12;
    let scene = load(args, 1.0)?;
    let mut engine = Engine::new(&scene.spec, assemble(&scene)?)?;
    let folder = tempfile::tempdir().map_err(|e| strandsnap::base::error::Error::io("cannot make", "a folder", e))?;
    let info = Arc::new(engine.info());
    let file = folder.path().join("bench.rrd");
    let options = RecordingOptions { live: None, scene: scene.spec.clone() };
    let mut recording = Recording::new(&file, options)?;
    let mut renderer = match check() {
        Ok(()) => Some(Renderer::new(&info, &FrameOptions::default())?),
        Err(error) => {
            println!("frames were not measured: {error}");
            None
        }
    };
    recording.start(&info)?;
    let (mut record, mut draw, mut encode) = (0.0, 0.0, 0.0);
    for shown in 0..=SHOWN {
        (0..50).try_for_each(|_| engine.step())?;
        let snapshot = Arc::new(engine.snapshot());
        let clock = Instant::now();
        recording.sample(&snapshot.sample)?;
        recording.snapshot(&snapshot)?;
        // The first frame sets pipelines up.
        let first = shown == 0;
        if !first {
            record += clock.elapsed().as_secs_f64();
        }
        if let Some(renderer) = &mut renderer {
            let clock = Instant::now();
            let image = renderer.draw(&snapshot, &[], &[])?;
            let drawn = clock.elapsed().as_secs_f64();
            png::write(&folder.path().join("frame.png"), &image)?;
            if !first {
                draw += drawn;
                encode += clock.elapsed().as_secs_f64() - drawn;
            }
        }
    }
    let clock = Instant::now();
    recording.finish()?;
    record += clock.elapsed().as_secs_f64();
    let per = |seconds: f64| seconds * 1e3 / SHOWN as f64;
    println!("\nrecording  {:>7.2} ms per snapshot, finishing the file included", per(record));
    if renderer.is_some() {
        println!("frame      {:>7.2} ms to draw and read back at 1280×720, {:.2} ms to encode", per(draw), per(encode));
    }
    Ok(())
}

#[cfg(not(all(feature = "record", feature = "render")))]
fn output_cost(_: &Args) -> Result<()> {
    println!("\nrecording and frames were not built in");
    Ok(())
}
