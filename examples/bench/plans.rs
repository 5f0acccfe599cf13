//! What each shipped scene leaves out, and what that saves against the general plan.

use crate::Args;
use std::time::Instant;
use strandsnap::base::error::Result;
use strandsnap::engine::Engine;
use strandsnap::run::{assemble, in_pool};
use strandsnap::scene::{self, builtin};

/// A shipped scene without bonds that yield or break: what is left is bonds and motion.
const ELASTIC_WIRE: [&str; 5] =
    ["name=elastic wire", "bond.law=elastic", "bond.hardening=", "bond.rupture=", "contact.hardness_strain="];

/// One scene under one plan.
struct Run {
    engine: Engine,
    ms_per_step: f64,
}

/// Prints the table.
pub fn print(args: &Args) -> Result<()> {
    in_pool(args.threads.first().copied(), || rows(args))?
}

fn rows(args: &Args) -> Result<()> {
    println!(
        "What scenes need, on {} thread; the same scene with --set plan=general in the second line",
        args.threads[0]
    );
    for (name, _) in builtin::list() {
        pair(args, name, &[])?;
    }
    pair(args, "single-wire", &ELASTIC_WIRE)
}

/// A scene as it plans, and the same made general.
fn pair(args: &Args, name: &str, set: &[&str]) -> Result<()> {
    let set: Vec<String> = set.iter().map(ToString::to_string).collect();
    let general = [&set[..], &["plan=general".to_string()]].concat();
    // One step that suits both: modes that a plan leaves out do not limit its own.
    let step =
        [&set, &general].into_iter().map(|set| Ok(engine(name, set)?.time_step())).collect::<Result<Vec<f64>>>()?;
    let fixed = format!("time.step={} s", 0.5 * step.into_iter().fold(f64::INFINITY, f64::min));
    let [special, general] = [&set, &general].map(|set| run(args, name, &[&set[..], &[fixed.clone()]].concat()));
    let (special, general) = (special?, general?);
    let same = same_bits(&special.engine, &general.engine);
    println!("\n{}", special.engine.info().name);
    for run in [&special, &general] {
        println!("  {}", line(run));
    }
    let saved = 1e2 * (1.0 - special.ms_per_step / general.ms_per_step);
    let verdict = if same { "bitwise equal" } else { "NOT EQUAL" };
    println!("  saves {saved:.0} %; after {} steps {verdict}", special.engine.steps());
    Ok(())
}

fn engine(name: &str, set: &[String]) -> Result<Engine> {
    let scene = scene::load(name, set)?;
    Engine::new(&scene.spec, assemble(&scene)?)
}

/// Best of the repeats.
fn run(args: &Args, name: &str, set: &[String]) -> Result<Run> {
    let mut engine = engine(name, set)?;
    let mut best = f64::INFINITY;
    for _ in 0..args.repeats {
        let clock = Instant::now();
        (0..args.steps).try_for_each(|_| engine.step())?;
        best = best.min(clock.elapsed().as_secs_f64());
    }
    Ok(Run { engine, ms_per_step: best * 1e3 / args.steps as f64 })
}

/// Whether two engines have moved alike, to the bit.
fn same_bits(a: &Engine, b: &Engine) -> bool {
    let (s, t) = (a.state(), b.state());
    s.x == t.x && s.v == t.v && s.w == t.w && s.radius == t.radius && s.whole == t.whole && a.energy() == b.energy()
}

/// Stages present, memory and time.
fn line(run: &Run) -> String {
    let n = run.engine.assembly().len();
    let present = run.engine.plan().components.iter().map(|c| match c.state.as_str() {
        "runs" => format!("+{}", c.name),
        "left out" => format!("-{}", c.name),
        later => format!("({} {later})", c.name),
    });
    let kept = run.engine.bytes();
    let kept: Vec<String> = kept.stages().iter().map(|(name, b)| format!("{name} {}", b.kept / n)).collect();
    let times = run.engine.timings().stages();
    let steps = run.engine.steps() as f64;
    let times: Vec<String> =
        times.iter().map(|(name, t)| format!("{name} {:.2}", t.as_secs_f64() * 1e6 / steps)).collect();
    format!(
        "{:.2} µs/step ({}), {} bytes per particle ({})\n    {}",
        run.ms_per_step * 1e3,
        times.join(", "),
        run.engine.bytes().kept() / n,
        kept.join(", "),
        present.collect::<Vec<_>>().join(" ")
    )
}
