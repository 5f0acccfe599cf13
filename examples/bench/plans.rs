//! What each shipped scene leaves out, and what that saves against the general plan.

use crate::Args;
use std::time::{Duration, Instant};
use strandsnap::base::error::Result;
use strandsnap::engine::Engine;
use strandsnap::run::{assemble, in_pool};
use strandsnap::scene::{self, builtin};

/// What makes a lone elastic wire of `single-wire`: nothing is left but bonds that stretch, and motion.
const ELASTIC_WIRE: [&str; 5] = [
    "bond.law=elastic",
    "bond.hardening=",
    "bond.rupture=",
    "stop.stress_fraction=",
    r#"contact={ normal = "hertz" }"#,
];

/// One scene under one plan.
struct Run {
    engine: Engine,
    us_per_step: f64,
    /// Microseconds by stage, in the same repeat.
    stages: Vec<(&'static str, f64)>,
}

/// Prints the table.
pub fn print(args: &Args) -> Result<()> {
    in_pool(args.threads.first().copied(), || rows(args))?
}

fn rows(args: &Args) -> Result<()> {
    println!(
        "What scenes need, on {} threads, best of the repeats; below it the same with --set plan=general",
        args.threads[0]
    );
    for (name, _) in builtin::list() {
        pair(args, name, name, &[])?;
    }
    pair(args, "single-wire, elastic, with a contact law", "single-wire", &ELASTIC_WIRE)
}

/// A scene as it plans, and the same made general.
fn pair(args: &Args, title: &str, name: &str, set: &[&str]) -> Result<()> {
    let set: Vec<String> = set.iter().map(ToString::to_string).collect();
    let general = [&set[..], &["plan=general".to_string()]].concat();
    // One step that suits both: modes that a plan leaves out do not limit its own.
    let step =
        [&set, &general].into_iter().map(|set| Ok(engine(name, set)?.time_step())).collect::<Result<Vec<f64>>>()?;
    let fixed = format!("time.step={} s", 0.5 * step.into_iter().fold(f64::INFINITY, f64::min));
    let [special, general] =
        [&set, &general].map(|set| run(args, name, &[&set[..], std::slice::from_ref(&fixed)].concat()));
    let (special, general) = (special?, general?);
    println!("\n{title}: {} particles", special.engine.assembly().len());
    println!("  {}", line(&special));
    if present(&special) == present(&general) {
        println!("  needs all that the general plan has");
    } else {
        println!("  {}", line(&general));
        println!("  saves {:.0} % of the general plan's time", 1e2 * (1.0 - special.us_per_step / general.us_per_step));
    }
    let verdict = if same_bits(&special.engine, &general.engine) { "bitwise equal" } else { "NOT EQUAL" };
    println!("  special and general after {} steps: {verdict}", special.engine.steps());
    Ok(())
}

fn engine(name: &str, set: &[String]) -> Result<Engine> {
    let scene = scene::load(name, set)?;
    Engine::new(&scene.spec, &scene.plan, assemble(&scene)?)
}

/// Best of the repeats.
fn run(args: &Args, name: &str, set: &[String]) -> Result<Run> {
    let mut engine = engine(name, set)?;
    let (mut best, mut stages) = (f64::INFINITY, Vec::new());
    let us = |time: Duration| time.as_secs_f64() * 1e6 / args.steps as f64;
    for _ in 0..args.repeats {
        let (clock, before) = (Instant::now(), *engine.timings());
        (0..args.steps).try_for_each(|_| engine.step())?;
        let taken = us(clock.elapsed());
        if taken < best {
            best = taken;
            stages = engine.timings().since(&before).stages().map(|(name, time)| (name, us(time))).to_vec();
        }
    }
    Ok(Run { engine, us_per_step: best, stages })
}

/// Whether two engines have moved alike, to the bit.
fn same_bits(a: &Engine, b: &Engine) -> bool {
    let (s, t) = (a.state(), b.state());
    s.x == t.x && s.v == t.v && s.w == t.w && s.radius == t.radius && s.whole == t.whole && a.energy() == b.energy()
}

/// Components that run and that do not.
fn present(run: &Run) -> String {
    let sign = run.engine.plan().components.iter().map(|c| match c.state.as_str() {
        "runs" => format!("+{}", c.name),
        "left out" => format!("-{}", c.name),
        later => format!("({} {later})", c.name),
    });
    sign.collect::<Vec<_>>().join(" ")
}

/// Stages present, time and memory.
fn line(run: &Run) -> String {
    let n = run.engine.assembly().len();
    let bytes = run.engine.bytes();
    let kept = bytes.stages().into_iter().filter(|(_, b)| b.kept > 0);
    let kept: Vec<String> = kept.map(|(name, b)| format!("{name} {}", b.kept / n)).collect();
    let times = run.stages.iter().filter(|(_, us)| *us > 0.0);
    let times: Vec<String> = times.map(|(name, us)| format!("{name} {us:.2}")).collect();
    format!(
        "{}\n    {:.2} µs per step: {}\n    {} bytes per particle: {}",
        present(run),
        run.us_per_step,
        times.join(", "),
        bytes.kept() / n,
        kept.join(", "),
    )
}
