//! A scene run to its end as a run of the program is, and watched more closely.

use super::measure::CompletedRun;
use crate::base::error::Result;
use crate::base::worst::renew;
use crate::engine::Engine;
use crate::observe::guard::Guard;
use crate::observe::planned::PlannedEnd;
use crate::run::steps::Steps;
use crate::run::{DeviceChoice, Schedule, StopRule, assemble};
use crate::scene::Scene;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// What a run reports while it goes: its steps, and whether it must end.
#[derive(Debug, Default)]
pub struct RunControl {
    /// Steps done.
    pub steps: AtomicU64,
    /// Set to end the run.
    pub stop: AtomicBool,
    /// What does its steps, where it can.
    pub device: DeviceChoice,
}

/// Runs a scene to its end; rows come as the scene's `output` asks.
///
/// # Errors
/// What the scene, the engine or the guard refuse.
pub fn watch(scene: &Scene, control: &RunControl) -> Result<CompletedRun> {
    let engine = Engine::new(&scene.spec, &scene.plan, assemble(scene)?)?;
    let info = engine.info();
    let mut guard = Guard::new(&scene.spec.time);
    guard.start(&info);
    let seen = CompletedRun::start(scene.spec.clone(), &engine);
    let steps = Steps::where_possible(&control.device, &engine)?;
    let mut watched = Watched { engine, steps, guard, rule: StopRule::new(&scene.spec.stop, info.wave_passage), seen };
    let end = PlannedEnd::new(&scene.spec.stop, info.strain_end);
    let mut schedule = Schedule::new(&scene.spec.output);
    watched.row()?;
    while !control.stop.load(Ordering::Relaxed) && !watched.is_over() {
        let begun = watched.engine.steps();
        let ruptures = watched.step(&schedule, &end)?;
        control.steps.fetch_add(watched.engine.steps() - begun, Ordering::Relaxed);
        let engine = &watched.engine;
        let now = end.fraction(engine.strain(), engine.time(), engine.steps());
        if ruptures > 0 {
            // No pictures are drawn, so no earlier state is kept for one.
            schedule.rupture(None, now);
        }
        let due = schedule.due(now);
        if due.row || due.snapshot {
            watched.row()?;
        }
    }
    watched.engine.check_crossings()?;
    watched.row()?;
    watched.guard.finish(true);
    watched.notices();
    for notice in watched.engine.take_worse().iter().chain(&watched.guard.take_worse()) {
        renew(&mut watched.seen.notices, notice);
    }
    watched.seen.finish(&watched.engine);
    Ok(watched.seen)
}

/// A run and all that watch it.
struct Watched {
    engine: Engine,
    steps: Steps,
    guard: Guard,
    rule: StopRule,
    seen: CompletedRun,
}

impl Watched {
    fn is_over(&self) -> bool {
        let engine = &self.engine;
        self.rule.reached(engine.strain(), engine.time(), engine.steps()).is_some()
    }

    /// One step, or a few up to one after which something is due; returns how many bonds broke.
    fn step(&mut self, schedule: &Schedule, end: &PlannedEnd) -> Result<usize> {
        let Self { engine, steps, rule, .. } = self;
        let between = |engine: &Engine, rule: &mut StopRule| rule.step(engine.time(), engine.strain(), engine.stress());
        steps.step_until_due(engine, schedule, end, rule, between)?;
        let ruptures = self.engine.take_ruptures();
        for rupture in &ruptures {
            self.rule.rupture();
            self.guard.rupture(rupture);
        }
        self.rule.step(self.engine.time(), self.engine.strain(), self.engine.stress());
        let count = ruptures.len();
        self.seen.ruptures.extend(ruptures);
        self.notices();
        Ok(count)
    }

    fn row(&mut self) -> Result<()> {
        let sample = self.engine.sample();
        self.guard.check(&sample)?;
        let judged = self.guard.row(&sample);
        self.seen.row(&self.engine, sample);
        judged
    }

    fn notices(&mut self) {
        let said = self.engine.take_notices().into_iter().chain(self.guard.take_notices());
        self.seen.notices.extend(said);
    }
}
