//! One strand of one length: pulled into contact, then timed stage by stage.

use crate::machine::Machine;
use crate::roofline::{self, Limits};
use crate::work::Work;
use crate::{Args, loops, memory};
use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};
use strandsnap::base::error::Result;
use strandsnap::engine::memory::StageBytes;
use strandsnap::engine::{Engine, Timings};
use strandsnap::run::cost::cpu_time;
use strandsnap::run::{assemble, in_pool};
use strandsnap::scene::spec::{RuptureCriterion, Spec};
use strandsnap::scene::{self, Scene};

/// Steps between two looks at the number of contacts.
const LOOK: u64 = 50;

/// One measurement.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Row {
    pub scene: String,
    pub length_factor: f64,
    pub threads: usize,
    pub particles: usize,
    pub bonds: usize,
    /// Closed contacts and candidate pairs, means over the steps that were timed.
    pub contacts: f64,
    pub candidates: f64,
    /// The best of the repeats, by wall time.
    pub ms_per_step: f64,
    /// Processor time of all threads; none where the system does not tell.
    pub cpu_ms_per_step: Option<f64>,
    pub particle_steps_per_s: f64,
    /// A step's parallel loops with nothing to do in them (ms).
    pub empty_loops_ms: f64,
    /// Milliseconds per step.
    pub stages: Stages<f64>,
    /// What the machine would need at the least.
    pub limits: Stages<Limits>,
    /// Rates of the machine behind that.
    pub machine: Machine,
    pub searches_per_1000_steps: f64,
    /// The way to the strain at which is measured, if there was one.
    pub pull: Option<Pull>,
    /// Memory kept per particle, by stage (bytes).
    pub bytes_per_particle: Vec<(String, usize)>,
    /// Greatest resident memory over the number of particles (bytes); the program itself included.
    pub peak_bytes_per_particle: Option<f64>,
}

/// Something for each stage.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub struct Stages<T> {
    pub integrate: T,
    pub bonds: T,
    pub contacts: T,
    pub neighbours: T,
    pub time_step: T,
}

impl Row {
    /// Share of its cores that the run really got (-): others may use the machine. Waiting threads spin from one loop to the
    /// next, so that an undisturbed run is busy on all of them.
    pub fn got(&self) -> f64 {
        self.cpu_ms_per_step.map_or(1.0, |cpu| (cpu / (self.ms_per_step * self.threads as f64)).min(1.0))
    }
}

impl<T: Copy> Stages<T> {
    /// Every stage with its name.
    pub fn named(&self) -> [(&'static str, T); 5] {
        [
            ("motion", self.integrate),
            ("bonds", self.bonds),
            ("contacts", self.contacts),
            ("neighbours", self.neighbours),
            ("bound", self.time_step),
        ]
    }
}

/// What the neighbour search did on the way.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Pull {
    pub steps: u64,
    pub searches: u64,
    /// Strain at its end (-).
    pub strain: f64,
    /// Share of the time that went into the search (-).
    pub search_share: f64,
    /// Candidates over closed contacts, mean over the steps (-).
    pub candidates_per_contact: f64,
}

/// Sums of candidates and closed contacts.
#[derive(Default)]
struct ParticleView {
    looks: f64,
    candidates: f64,
    contacts: f64,
}

impl ParticleView {
    fn look(&mut self, engine: &Engine) {
        let (_, candidates, contacts) = engine.contact_counts();
        self.looks += 1.0;
        self.candidates += candidates as f64;
        self.contacts += contacts as f64;
    }
}

/// The scene with its strand `factor` times as long, pulled at the bench's strain rate; at its own when it is measured
/// as it starts.
pub fn load(args: &Args, factor: f64) -> Result<Scene> {
    let base = scene::load(&args.scene, &args.set)?;
    let (Some(strand), Some(grip)) = (&base.spec.strand, &base.spec.grip) else {
        return Err(base.source.error("strand", "the bench pulls a strand", "name a scene with a strand and grips"));
    };
    let length = strand.length * factor;
    let mut set = args.set.clone();
    set.push(format!("strand.length={} mm", length * 1e3));
    if args.strain > 0.0 {
        let speed = args.rate * (length - 2.0 * grip.length);
        set.push(format!("grip.speed={speed} m/s"));
        if grip.adaptive.is_some() {
            // The same rate all the way.
            set.push(format!("grip.adaptive={{ from = \"1000 %\", fastest = \"{} m/s\" }}", 2.0 * speed));
        }
    }
    // Nothing breaks on the way, or it would not be the same strand.
    let by_strain =
        |s: &Spec| s.bond.rupture.as_ref().is_some_and(|r| !matches!(r.criterion, RuptureCriterion::BeamStress { .. }));
    if by_strain(&base.spec) {
        set.push("bond.rupture.strain=200 %".into());
    }
    scene::load(&args.scene, &set)
}

/// All rows of one length.
pub fn rows(args: &Args, factor: f64) -> Result<Vec<Row>> {
    let scene = load(args, factor)?;
    let (mut engine, pull) = in_pool(args.threads.iter().copied().max(), || pulled(args, &scene))??;
    let mut measured = Vec::new();
    for threads in &args.threads {
        engine.set_threads(*threads)?;
        measured.push(time(args, &mut engine)?);
    }
    let peak = memory::peak();
    let bytes = engine.bytes();
    // The machine comes last: what it needs for that must not count as the engine's peak.
    let rows = args.threads.iter().zip(measured).map(|(threads, timed)| {
        let machine = Machine::measure(*threads, bytes.kept());
        let empty_loops = loops::empty(*threads, engine.assembly().len())?;
        Ok(row(args, factor, *threads, &scene.spec, &engine, &timed, &bytes, &machine, empty_loops, pull, peak))
    });
    rows.collect()
}

/// An engine in full contact, and what its way there was like.
pub fn pulled(args: &Args, scene: &Scene) -> Result<(Engine, Option<Pull>)> {
    let mut engine = Engine::new(&scene.spec, &scene.plan, assemble(scene)?)?;
    let (clock, mut seen) = (Instant::now(), ParticleView::default());
    while engine.strain() < args.strain / 100.0 {
        engine.step()?;
        if engine.steps() % LOOK == 0 {
            seen.look(&engine);
        }
    }
    let pull = (engine.steps() > 0).then(|| Pull {
        steps: engine.steps(),
        searches: engine.contact_counts().0,
        strain: engine.strain(),
        search_share: engine.timings().neighbours.as_secs_f64() / clock.elapsed().as_secs_f64(),
        candidates_per_contact: seen.candidates / seen.contacts.max(1.0),
    });
    Ok((engine, pull))
}

/// The best of the repeats, and means over all of them.
struct Timed {
    seconds: f64,
    cpu: Option<f64>,
    stages: Timings,
    searches: u64,
    steps: u64,
    seen: ParticleView,
}

fn time(args: &Args, engine: &mut Engine) -> Result<Timed> {
    let first = engine.contact_counts().0;
    let mut best: Option<(f64, Option<f64>, Timings)> = None;
    let mut seen = ParticleView::default();
    for _ in 0..args.repeats {
        let (mut wall, mut cpu, before) = (Duration::ZERO, Some(0.0), *engine.timings());
        let mut left = args.steps;
        while left > 0 {
            let some = left.min(LOOK);
            let (clock, busy) = (Instant::now(), cpu_time());
            (0..some).try_for_each(|_| engine.step())?;
            wall += clock.elapsed();
            cpu = cpu_time().zip(busy).zip(cpu).map(|((after, before), sum)| sum + after - before);
            left -= some;
            seen.look(engine);
        }
        if best.as_ref().is_none_or(|(seconds, ..)| wall.as_secs_f64() < *seconds) {
            best = Some((wall.as_secs_f64(), cpu, engine.timings().since(&before)));
        }
    }
    let (seconds, cpu, stages) = best.expect("at least one repeat");
    let searches = engine.contact_counts().0 - first;
    Ok(Timed { seconds, cpu, stages, searches, steps: args.steps * args.repeats, seen })
}

#[allow(clippy::too_many_arguments, reason = "one place puts everything together that was measured")]
fn row(
    args: &Args,
    factor: f64,
    threads: usize,
    spec: &Spec,
    engine: &Engine,
    timed: &Timed,
    bytes: &StageBytes,
    machine: &Machine,
    empty_loops: f64,
    pull: Option<Pull>,
    peak: Option<u64>,
) -> Row {
    let particles = engine.assembly().len();
    let (candidates, contacts) = (timed.seen.candidates / timed.seen.looks, timed.seen.contacts / timed.seen.looks);
    let per_step = 1.0 / args.steps as f64;
    let ms = |time: Duration| time.as_secs_f64() * 1e3 * per_step;
    let t = &timed.stages;
    Row {
        scene: args.scene.clone(),
        length_factor: factor,
        threads,
        particles,
        bonds: engine.assembly().bond_count(),
        contacts,
        candidates,
        ms_per_step: timed.seconds * 1e3 * per_step,
        cpu_ms_per_step: timed.cpu.map(|seconds| seconds * 1e3 * per_step),
        particle_steps_per_s: particles as f64 / (timed.seconds * per_step),
        empty_loops_ms: empty_loops * 1e3,
        stages: Stages {
            integrate: ms(t.integrate),
            bonds: ms(t.bonds),
            contacts: ms(t.contacts),
            neighbours: ms(t.neighbours),
            time_step: ms(t.time_step),
        },
        machine: *machine,
        limits: roofline::limits(bytes, &Work::of(spec, engine, candidates, contacts), machine),
        searches_per_1000_steps: timed.searches as f64 * 1e3 / timed.steps as f64,
        pull,
        bytes_per_particle: bytes.stages().map(|(name, b)| (name.to_string(), b.kept / particles)).to_vec(),
        peak_bytes_per_particle: peak.map(|bytes| bytes as f64 / particles as f64),
    }
}
