//! What all cases share: scenes, engines, averages, frequencies, the ledger.

use super::comparison::{Comparison, Spent};
use crate::base::error::{Error, Result};
use crate::engine::Engine;
use crate::reference::beam::RoundBar;
use crate::run::steps::{DeviceChoice, Steps};
use crate::scene::spec::Spec;
use crate::scene::{self, Scene};
use crate::strand;
use crate::strand::assembly::Assembly;
use std::cell::Cell;
use std::f64::consts::{PI, TAU};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// How much a case may spend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Every claim, with fewer points and shorter runs: for tests.
    Quick,
    /// All points.
    Full,
}

/// Steps between two looks at whether the user wants to stop.
const STOP_INTERVAL: u64 = 1024;
/// What the energy ledger of a simulation may miss of the work done (-).
const LEDGER_TARGET: f64 = 1e-3;

/// What a case is run in: it sets up simulations, ends them when the user wants to stop, and keeps the worst energy ledger
/// among them.
pub struct Context<'a> {
    effort: Effort,
    device: &'a DeviceChoice,
    stop: &'a AtomicBool,
    ledger: Cell<Ledger>,
}

#[derive(Clone, Copy, Default)]
struct Ledger {
    runs: usize,
    worst: f64,
    spent: Spent,
}

impl<'a> Context<'a> {
    /// The context of one case; `stop` ends its simulations early. Steps are done on `device` where they can be.
    pub fn new(effort: Effort, device: &'a DeviceChoice, stop: &'a AtomicBool) -> Self {
        Self { effort, device, stop, ledger: Cell::default() }
    }

    /// What ends a case early.
    pub(super) fn stop(&self) -> &AtomicBool {
        self.stop
    }

    /// One of two, by effort.
    pub fn pick<T>(&self, quick: T, full: T) -> T {
        match self.effort {
            Effort::Quick => quick,
            Effort::Full => full,
        }
    }

    /// The built-in scene of this name (`verify/hertz`, `torsion`) with `key=value` options, before its first step.
    ///
    /// # Errors
    /// What is wrong in the scene or the options.
    pub fn simulation(&self, scene: &str, options: &[String]) -> Result<Simulation<'_>> {
        self.changed(scene, options, |_| {})
    }

    /// The same with its bodies changed where options do not reach, such as the velocity of single particles.
    ///
    /// # Errors
    /// What is wrong in the scene or the options.
    pub fn changed(
        &self,
        scene: &str,
        options: &[String],
        change: impl FnOnce(&mut Assembly),
    ) -> Result<Simulation<'_>> {
        self.set_up(scene::load(scene, options)?, change)
    }

    /// A simulation of a scene that was changed where options do not reach, such as by a rotation.
    ///
    /// # Errors
    /// When the bodies cannot be built.
    pub fn simulation_of(&self, scene: Scene) -> Result<Simulation<'_>> {
        self.set_up(scene, |_| {})
    }

    fn set_up(&self, Scene { spec, plan, .. }: Scene, change: impl FnOnce(&mut Assembly)) -> Result<Simulation<'_>> {
        let mut assembly = strand::build(&spec)?;
        change(&mut assembly);
        let engine = Engine::new(&spec, &plan, assembly)?;
        let steps = Steps::where_possible(self.device, &engine)?;
        Ok(Simulation { spec, engine, steps, context: self, wall_s: 0.0 })
    }

    /// The worst energy ledger of the simulations that were finished, if any: what is missing over the work done.
    pub(super) fn ledger(&self) -> Option<Comparison> {
        let Ledger { runs, worst, spent } = self.ledger.get();
        let what = match runs {
            0 => return None,
            1 => "energy ledger: missing over work".into(),
            _ => format!("energy ledger: missing over work, worst of {runs}"),
        };
        Some(Comparison::new(what, "-", worst, 0.0, spent).relative_to(1.0).within(LEDGER_TARGET))
    }
}

/// A scene in an engine.
pub struct Simulation<'a> {
    /// The scene.
    pub spec: Spec,
    /// The engine that runs it.
    pub engine: Engine,
    steps: Steps,
    context: &'a Context<'a>,
    wall_s: f64,
}

impl Simulation<'_> {
    /// The first wire as a bar of beam theory.
    pub fn bar(&self) -> RoundBar {
        let (a, m) = (self.engine.assembly(), &self.spec.material);
        RoundBar {
            length: a.rest_length[a.wires[0].bonds()].iter().sum(),
            diameter: a.wires[0].diameter,
            young: m.young,
            poisson: m.poisson,
            density: m.density,
        }
    }

    /// Number of bonds of the first wire.
    pub fn bonds(&self) -> usize {
        self.engine.assembly().wires[0].len - 1
    }

    /// Steps while `more`, calling `each` after every step.
    ///
    /// # Errors
    /// What stops the engine, or that the user wants to stop.
    pub fn run_while(&mut self, more: impl Fn(&Engine) -> bool, mut each: impl FnMut(&Engine)) -> Result<()> {
        let began = Instant::now();
        while more(&self.engine) {
            if self.engine.steps().is_multiple_of(STOP_INTERVAL) && self.context.stop.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
            self.steps.step(&mut self.engine)?;
            each(&self.engine);
        }
        self.wall_s += began.elapsed().as_secs_f64();
        Ok(())
    }

    /// Steps until `time` (s).
    ///
    /// # Errors
    /// See [`Simulation::run_while`].
    pub fn run_to(&mut self, time: f64, each: impl FnMut(&Engine)) -> Result<()> {
        self.run_while(|engine| engine.time() < time, each)
    }

    /// Takes `steps` more steps.
    ///
    /// # Errors
    /// See [`Simulation::run_while`].
    pub fn run_steps(&mut self, steps: u64, each: impl FnMut(&Engine)) -> Result<()> {
        let end = self.engine.steps() + steps;
        self.run_while(|engine| engine.steps() < end, each)
    }

    /// Steps to the scene's own end.
    ///
    /// # Errors
    /// See [`Simulation::run_while`].
    pub fn run(&mut self, each: impl FnMut(&Engine)) -> Result<()> {
        let stop = self.spec.stop.clone();
        let reached = move |limit: Option<f64>, value: f64| limit.is_some_and(|limit| value >= limit);
        let more = move |engine: &Engine| {
            !reached(stop.time, engine.time())
                && !reached(stop.strain, engine.strain())
                && stop.steps.is_none_or(|steps| engine.steps() < steps)
        };
        self.run_while(more, each)
    }

    /// Mean over `from..to` (s) under a Hann window, which takes out the swing that is left after a smooth ramp.
    ///
    /// # Errors
    /// See [`Simulation::run_while`].
    pub fn settled(&mut self, from: f64, to: f64, mut value: impl FnMut(&Engine) -> f64) -> Result<f64> {
        let (mut sum, mut weights) = (0.0, 0.0);
        self.run_to(to, |engine| {
            let now = value(engine);
            let phase = (engine.time() - from) / (to - from);
            if (0.0..=1.0).contains(&phase) {
                let weight = (PI * phase).sin().powi(2) * engine.time_step();
                sum += weight * now;
                weights += weight;
            }
        })?;
        Ok(sum / weights)
    }

    /// What the simulation has taken so far.
    pub fn spent(&self) -> Spent {
        Spent { steps: self.engine.steps(), wall_s: self.wall_s }
    }

    /// Ends the simulation: its energy ledger must close. Gives what it took.
    pub fn finish(self) -> Spent {
        let (energy, spent) = (self.engine.energy(), self.spent());
        let missing = energy.residual().abs() / energy.work.abs().max(energy.internal());
        let Ledger { runs, worst, spent: so_far } = self.context.ledger.get();
        // Not f64::max, which would drop a NaN.
        let worst = if worst.is_nan() || missing <= worst { worst } else { missing };
        self.context.ledger.set(Ledger { runs: runs + 1, worst, spent: so_far + spent });
        spent
    }
}

/// An option `key=value`.
pub fn set(key: &str, value: impl std::fmt::Display) -> String {
    format!("{key}={value}")
}

/// Angular frequency of a signal from its rising zero crossings.
#[derive(Default)]
pub struct Crossings {
    last: Option<[f64; 2]>,
    times: Vec<f64>,
}

impl Crossings {
    /// The signal's next `value` at `time` (s).
    pub fn add(&mut self, time: f64, value: f64) {
        if let Some([t0, v0]) = self.last
            && v0 < 0.0
            && value >= 0.0
        {
            self.times.push(t0 + (time - t0) * v0 / (v0 - value));
        }
        self.last = Some([time, value]);
    }

    /// Angular frequency (rad/s); NaN with fewer than three crossings.
    pub fn frequency(&self) -> f64 {
        match self.times[..] {
            [first, _, .., last] if self.times.len() > 2 => TAU * (self.times.len() - 1) as f64 / (last - first),
            _ => f64::NAN,
        }
    }
}
