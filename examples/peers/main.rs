//! Our side of the comparison with other engines: one timed run of `strand.toml`, as a line of JSON.
//!
//! `examples/peers/compare.sh` calls it. The strand starts at rest while its upper grip moves at full speed, because
//! others cannot start from the affine field of a pull; the wave that this sends along the wires has a kinetic energy
//! that is known in closed form, and so shows that all compute the same thing.

#[path = "../bench/memory.rs"]
mod memory;

use clap::Parser;
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;
use strandsnap::base::error::Result;
use strandsnap::engine::Engine;
use strandsnap::engine::state::State;
use strandsnap::observe::files::write_whole;
use strandsnap::run::cost::cpu_time;
use strandsnap::run::{assemble, in_pool};
use strandsnap::scene::{self, Scene};
use strandsnap::strand::assembly::Assembly;

/// What makes the scene our full physics: bonds that harden and break one by one, elastoplastic contacts.
const FULL: [&str; 6] = [
    "bond.law=elasto-plastic",
    r#"bond.hardening={ form = "voce", yield_stress = "100 MPa", saturation = "177.9 MPa", rate = 12, linear = "543.6 MPa" }"#,
    r#"bond.rupture={ criterion = "plastic-strain", strain = "29.385 %", weibull_modulus = 30 }"#,
    "contact.normal=thornton",
    "contact.hardness_factor=2.8",
    "contact.hardness_strain=8 %",
];

#[derive(Parser)]
struct Args {
    /// The scene
    #[arg(long, default_value = "examples/peers/strand.toml")]
    scene: String,
    /// Bonds that yield and break, and contacts that yield, instead of elastic ones
    #[arg(long)]
    full: bool,
    /// Number of threads
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Steps before the clock starts
    #[arg(long, default_value_t = 20)]
    warm_up: u64,
    /// Steps that are timed
    #[arg(long, default_value_t = 1000)]
    steps: u64,
    /// Write the particles to this file instead, for others to read
    #[arg(long, value_name = "FILE")]
    particles: Option<PathBuf>,
}

/// What a run tells.
#[derive(Serialize)]
struct Outcome {
    engine: &'static str,
    cores: usize,
    particles: usize,
    bonds: usize,
    /// Closed contacts before the first step, and after the last.
    contacts: [usize; 2],
    ms_per_step: f64,
    /// Processor time of all threads, which a busy machine stretches less (ms).
    cpu_ms_per_step: f64,
    /// Time at the end (s).
    time: f64,
    /// Translational kinetic energy then (J).
    kinetic: f64,
    /// Greatest resident memory (MB).
    memory: f64,
}

fn main() -> miette::Result<()> {
    let args = Args::parse();
    let set: &[&str] = if args.full { &FULL } else { &[] };
    let scene = scene::load(&args.scene, &set.iter().map(ToString::to_string).collect::<Vec<_>>())?;
    if let Some(file) = &args.particles {
        return Ok(write_particles(&scene, file)?);
    }
    let outcome = in_pool(Some(args.threads), || run(&args, &scene))??;
    println!("{}", serde_json::to_string(&outcome).expect("an outcome is plain data"));
    Ok(())
}

fn run(args: &Args, scene: &Scene) -> Result<Outcome> {
    let mut engine = Engine::new(&scene.spec, &scene.plan, at_rest(scene)?)?;
    let before = engine.contact_counts().2;
    (0..args.warm_up).try_for_each(|_| engine.step())?;
    let (clock, cpu) = (Instant::now(), cpu_time());
    (0..args.steps).try_for_each(|_| engine.step())?;
    let seconds = clock.elapsed().as_secs_f64();
    let cpu_seconds = cpu_time().zip(cpu).map_or(f64::NAN, |(after, before)| after - before);
    Ok(Outcome {
        engine: if args.full { "strandsnap, full physics" } else { "strandsnap" },
        cores: args.threads,
        particles: engine.assembly().len(),
        bonds: engine.assembly().bond_count(),
        contacts: [before, engine.contact_counts().2],
        ms_per_step: seconds * 1e3 / args.steps as f64,
        cpu_ms_per_step: cpu_seconds * 1e3 / args.steps as f64,
        time: engine.time(),
        kinetic: kinetic(engine.state()),
        memory: memory::peak().map_or(f64::NAN, |bytes| bytes as f64 * 1e-6),
    })
}

/// The assembly with velocities that take off what the engine adds: everything between the grips starts at rest.
fn at_rest(scene: &Scene) -> Result<Assembly> {
    let mut assembly = assemble(scene)?;
    let started = Engine::new(&scene.spec, &scene.plan, assembly.clone())?;
    let state = started.state();
    for p in (0..state.len()).filter(|p| state.hold[*p] == 0) {
        assembly.velocity.add(p, -state.v.get(p));
    }
    Ok(assembly)
}

/// Σ ½ m v² (J).
fn kinetic(state: &State) -> f64 {
    (0..state.len()).map(|p| 0.5 * state.mass[p] * state.v.get(p).length_squared()).sum()
}

/// One line per particle: wire and layer from 0, hold (0 free, 1 lower grip, 2 upper grip), rest length of the bond to
/// the next particle (0 without one), centre, radius and mass in SI; as many digits as the numbers have.
fn write_particles(scene: &Scene, file: &Path) -> Result<()> {
    let assembly = assemble(scene)?;
    let engine = Engine::new(&scene.spec, &scene.plan, assembly.clone())?;
    let mut text = String::from("wire,layer,hold,rest_length,x,y,z,radius,mass\n");
    for p in 0..assembly.len() {
        let wire = assembly.wire_of[p] as usize;
        let (layer, hold) = (assembly.wires[wire].layer, engine.state().hold[p]);
        let ([x, y, z], rest) = (assembly.position.get(p).to_array(), assembly.rest_length[p]);
        let (radius, mass) = (assembly.radius[p], assembly.mass[p]);
        writeln!(text, "{wire},{layer},{hold},{rest},{x},{y},{z},{radius},{mass}").expect("text takes all");
    }
    write_whole(file, &text)
}
