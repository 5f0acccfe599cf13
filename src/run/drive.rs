//! The step loop: engine, schedule, stop rule and observers.

use super::checkpoint::{Checkpoint, Keeper, LoopPosition};
use super::schedule::Schedule;
use super::steps::Steps;
use super::stop::StopRule;
use crate::base::error::{Error, Result};
use crate::base::finding::{Finding, Notice, StopReason};
use crate::engine::Engine;
use crate::engine::saved::{Reader, Unfit, Writer};
use crate::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use crate::observe::Observer;
use crate::observe::guard::{Guard, QuasiStatic};
use crate::observe::limits::Limits;
use crate::observe::peaks::{Monitor, Peaks};
use crate::observe::planned::PlannedEnd;
use crate::observe::trajectory::{Record, Trajectory};
use crate::scene::plan::Plan;
use crate::scene::spec::Spec;
use crate::strand::assembly::Assembly;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Steps between two looks of the guard at energies and forces: rows are as many as the user wants, judgement is not.
const GUARD_INTERVAL: u64 = 64;

/// How a run went, apart from what its observers saw.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Why it ended.
    pub reason: StopReason,
    /// Steps done.
    pub steps: u64,
    /// Simulated time (s).
    pub time: f64,
    /// Strain of the body at the end (-).
    pub strain: f64,
    /// How far loading was from quasi-static.
    pub quasi_static: QuasiStatic,
    /// How near it came to the limits of the model.
    pub limits: Limits,
    /// Wall time spent in the engine, observers not included.
    pub stepping: Duration,
    /// Wall time spent in observers.
    pub observing: Duration,
    /// Threads that worked at the end, and how many there were to choose from.
    pub threads: [usize; 2],
    /// The graphics adapter that has done the steps.
    pub adapter: Option<String>,
    /// Why the processor has, where an adapter would have been taken.
    pub not_on_adapter: Option<String>,
}

/// Simulates the assembly of a scene and its plan, and shows it to observers; writes nothing itself.
///
/// Rows and snapshots come as the scene's `output` says, in the order in which things happen; a rupture comes
/// before the row that follows it. What a run should not be believed without comes as a notice when it is found,
/// the error that ends a run included, and once more at the end if it became worse. The first and the last state always come with a snapshot, and ruptures with the
/// state at the last row before them and one soon after ([`Schedule`]). Every observer
/// that was started is finished, also after an error. Call it inside a rayon pool to choose the threads.
///
/// # Errors
/// What [`Engine::new`] refuses; [`Error::Simulation`] when the simulation had to stop; the first error of an
/// observer.
pub fn simulate(
    spec: &Spec,
    plan: &Plan,
    assembly: Assembly,
    observers: &mut [&mut dyn Observer],
    stop: &AtomicBool,
) -> Result<Outcome> {
    simulate_engine(Engine::new(spec, plan, assembly)?, observers, stop)
}

/// [`simulate`] from an engine that is set up, such as one with a bond law of its own ([`Engine::with_law`]).
///
/// # Errors
/// As for [`simulate`], but for what [`Engine::new`] refuses.
pub fn simulate_engine(engine: Engine, observers: &mut [&mut dyn Observer], stop: &AtomicBool) -> Result<Outcome> {
    let spec = engine.spec().clone();
    let (outcome, error) = drive((engine, Steps::default()), &spec, observers, stop, None, None)?;
    match error {
        Some(error) => Err(error),
        None => Ok(outcome),
    }
}

/// A run that goes on with an engine that was restored.
pub(super) struct Resumed {
    /// From here.
    pub checkpoint: Checkpoint,
    /// The state of the loop there.
    pub state: LoopState,
    /// What it has told up to then.
    pub trajectory: Trajectory,
}

/// All that a run remembers beside its engine.
pub(super) struct LoopState {
    schedule: Schedule,
    rule: StopRule,
    guard: Guard,
    monitor: Monitor,
    /// Step of the last snapshot.
    shown: Option<u64>,
    /// Step of the last row: a run may end at one, and its last snapshot must not repeat it.
    told: Option<u64>,
    /// The state at the last row and when that was, in case the next thing to happen is a rupture: which one is the
    /// last before it shows only afterwards.
    kept: Option<(f64, Arc<Snapshot>)>,
}

impl LoopState {
    /// Before the first step.
    fn new(spec: &Spec, info: &RunInfo) -> Self {
        let mut guard = Guard::new(&spec.time);
        guard.start(info);
        let (schedule, rule) = (Schedule::new(&spec.output), StopRule::new(&spec.stop, info.wave_passage));
        Self { schedule, rule, guard, monitor: Monitor::default(), shown: None, told: None, kept: None }
    }

    fn save(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.put(&(&self.schedule, &self.monitor, self.shown, self.told));
        out.put(&self.kept.as_ref().map(|(at, snapshot)| (*at, &**snapshot)));
        self.rule.save(&mut out);
        self.guard.save(&mut out);
        out.into_bytes()
    }

    /// The state that a checkpoint holds ([`Checkpoint::driver`]).
    ///
    /// # Errors
    /// [`Unfit`] when the bytes are something else.
    pub(super) fn restore(spec: &Spec, info: &RunInfo, bytes: &[u8]) -> std::result::Result<Self, Unfit> {
        let mut state = Self::new(spec, info);
        let mut from = Reader::new(bytes);
        (state.schedule, state.monitor, state.shown, state.told) = from.take()?;
        let kept: Option<(f64, Snapshot)> = from.take()?;
        state.kept = kept.map(|(at, snapshot)| (at, Arc::new(snapshot)));
        state.rule.restore(&mut from)?;
        state.guard.restore(&mut from)?;
        from.end()?;
        Ok(state)
    }
}

/// [`simulate`] from an engine that is set up, with who does its steps; the error that ended the run comes beside its outcome. `keeper` keeps its
/// checkpoints. A run that was `resumed` first tells its observers again what it had told before.
pub(super) fn drive(
    (engine, steps): (Engine, Steps),
    spec: &Spec,
    observers: &mut [&mut dyn Observer],
    stop: &AtomicBool,
    keeper: Option<&mut Keeper>,
    resumed: Option<Resumed>,
) -> Result<(Outcome, Option<Error>)> {
    let info = Arc::new(engine.info());
    let end = PlannedEnd::new(&spec.stop, info.strain_end);
    if !end.is_known() {
        return Err(Error::input(
            "the scene does not say when to stop, so rows and snapshots cannot be spread over the run",
            "give at least one of stop.strain, stop.time or stop.steps",
        ));
    }
    let before = resumed.as_ref().map(|resumed| resumed.checkpoint.spent).unwrap_or_default();
    let (state, told) = match resumed {
        Some(Resumed { checkpoint, state, trajectory }) => (state, Some((checkpoint, trajectory))),
        None => (LoopState::new(spec, &info), None),
    };
    let mut driver = Driver {
        engine,
        steps,
        end,
        state,
        audience: Audience { observers, started: 0, time: Duration::ZERO, keeper },
        breaks: spec.breaks(),
        begin: Instant::now(),
        broke: false,
    };
    let ended = driver.go(&info, stop, told);
    let stepping = before.stepping + driver.stepping();
    let observing = before.observing + driver.audience.time;
    let finished = driver.audience.finish(stop);
    let (reason, error) = match (ended, finished) {
        (Ok(reason), Ok(())) => (reason, None),
        (Err(error), _) | (Ok(_), Err(error)) => (StopReason::Failed, Some(error)),
    };
    let outcome = Outcome {
        reason,
        steps: driver.engine.steps(),
        time: driver.engine.time(),
        strain: driver.engine.strain(),
        quasi_static: driver.state.guard.quasi_static(),
        limits: Limits::new(driver.engine.findings(), driver.state.guard.greatest_residual()),
        stepping,
        observing,
        threads: driver.engine.threads(),
        adapter: driver.steps.adapter().map(str::to_owned),
        not_on_adapter: driver.steps.reason().map(str::to_owned),
    };
    Ok((outcome, error))
}

struct Driver<'a, 'b> {
    engine: Engine,
    steps: Steps,
    end: PlannedEnd,
    state: LoopState,
    audience: Audience<'a, 'b>,
    /// Bonds can break.
    breaks: bool,
    begin: Instant,
    /// A bond broke in the step just done.
    broke: bool,
}

impl Driver<'_, '_> {
    /// Runs to the end; a failure is told as a notice before it is returned.
    fn go(
        &mut self,
        info: &Arc<RunInfo>,
        stop: &AtomicBool,
        told: Option<(Checkpoint, Trajectory)>,
    ) -> Result<StopReason> {
        self.audience.start(info)?;
        match told {
            Some((checkpoint, trajectory)) => self.tell_again(&checkpoint, trajectory, stop)?,
            None => {
                self.monitor_step();
                self.show()?;
            }
        }
        let ended = self.run(stop);
        self.state.guard.finish(matches!(ended, Ok(reason) if reason != StopReason::Interrupted));
        self.notices()?;
        // What became worse after it was told of, as it was at its worst.
        let worse = [self.engine.take_worse(), self.state.guard.take_worse()];
        worse.iter().flatten().try_for_each(|notice| self.audience.notice(notice))?;
        if let Err(Error::Simulation(stopped)) = &ended {
            let finding = Finding::Failed { failure: stopped.failure.clone() };
            self.audience.notice(&Notice { at: stopped.at, finding })?;
        }
        self.audience.peaks(self.state.monitor.peaks())?;
        ended
    }

    fn run(&mut self, stop: &AtomicBool) -> Result<StopReason> {
        let reason = loop {
            if stop.load(Ordering::Relaxed) {
                self.audience.stopping();
                // Before anything is told that a run which goes on would not tell.
                self.keep()?;
                break StopReason::Interrupted;
            }
            let engine = &self.engine;
            if let Some(reason) = self.state.rule.reached(engine.strain(), engine.time(), engine.steps()) {
                break reason;
            }
            self.advance()?;
            self.look()?;
            let (step, broke) = (self.engine.steps(), self.broke);
            if self.audience.keeper.as_ref().is_some_and(|keeper| keeper.due(step, broke)) {
                self.keep()?;
            }
        };
        self.engine.check_crossings()?;
        if self.state.shown != Some(self.engine.steps()) {
            self.show()?;
        }
        self.judge()?;
        Ok(reason)
    }

    /// The next step, or a few up to one after which something is due.
    fn advance(&mut self) -> Result<()> {
        let Self { engine, steps, end, state, .. } = self;
        let LoopState { schedule, rule, monitor, .. } = state;
        steps.step_until_due(engine, schedule, end, rule, |engine, rule| monitor_step(engine, rule, monitor))
    }

    /// Wall time in the engine since the loop began.
    fn stepping(&self) -> Duration {
        self.begin.elapsed().saturating_sub(self.audience.time)
    }

    /// Keeps a checkpoint, if any are kept.
    fn keep(&mut self) -> Result<()> {
        if !self.audience.keeper.as_ref().is_some_and(|keeper| keeper.keeps()) {
            return Ok(());
        }
        let (driver, engine, step) = (self.state.save(), self.engine.save(), self.engine.steps());
        let (stepping, observing) = (self.stepping(), self.audience.time);
        match &mut self.audience.keeper {
            Some(keeper) => keeper.keep(LoopPosition { step, driver, engine, stepping, observing }),
            None => Ok(()),
        }
    }

    /// Tells again what was told up to a checkpoint.
    fn tell_again(&mut self, checkpoint: &Checkpoint, trajectory: Trajectory, stop: &AtomicBool) -> Result<()> {
        for record in trajectory.take(checkpoint.records as usize) {
            if stop.load(Ordering::Relaxed) {
                self.audience.stopping();
            }
            self.audience.tell(&record?)?;
        }
        checkpoint.tail.iter().try_for_each(|record| self.audience.tell(record))
    }

    /// See [`monitor_step`].
    fn monitor_step(&mut self) {
        monitor_step(&self.engine, &mut self.state.rule, &mut self.state.monitor);
    }

    /// The guard's look at the present state; a failure is told before it is returned.
    fn judge(&mut self) -> Result<()> {
        let sample = self.engine.sample();
        self.state.guard.check(&sample)?;
        let judged = self.state.guard.row(&sample);
        self.notices()?;
        judged
    }

    /// Passes on what the step just done brought.
    fn look(&mut self) -> Result<()> {
        let now = self.end.fraction(self.engine.strain(), self.engine.time(), self.engine.steps());
        let ruptures = self.engine.take_ruptures();
        self.broke = !ruptures.is_empty();
        if !ruptures.is_empty() {
            self.state.rule.rupture();
            self.state.monitor.rupture();
            let kept = self.state.kept.take();
            if self.state.schedule.rupture(kept.as_ref().map(|(at, _)| *at), now)
                && let Some((_, snapshot)) = kept
            {
                self.audience.snapshot(&snapshot)?;
            }
        }
        for rupture in &ruptures {
            self.state.guard.rupture(rupture);
            self.audience.rupture(rupture)?;
        }
        self.notices()?;
        self.monitor_step();
        if self.engine.steps().is_multiple_of(GUARD_INTERVAL) {
            self.judge()?;
        }
        let due = self.state.schedule.due(now);
        if due.snapshot {
            self.show()
        } else if due.row && self.breaks {
            let snapshot = Arc::new(self.engine.snapshot());
            self.row(&snapshot.sample)?;
            self.state.kept = Some((now, snapshot));
            Ok(())
        } else if due.row {
            let sample = self.engine.sample();
            self.row(&sample)
        } else {
            Ok(())
        }
    }

    /// A snapshot and its row.
    fn show(&mut self) -> Result<()> {
        let snapshot = Arc::new(self.engine.snapshot());
        self.row(&snapshot.sample)?;
        self.state.shown = Some(snapshot.sample.step);
        self.state.kept = None;
        self.audience.snapshot(&snapshot)
    }

    fn row(&mut self, sample: &Sample) -> Result<()> {
        if self.state.told.replace(sample.step) == Some(sample.step) {
            return Ok(());
        }
        // A row that is not finite must not reach the files.
        self.state.guard.check(sample)?;
        self.audience.sample(sample)
    }

    /// Passes on what engine and guard have to say.
    fn notices(&mut self) -> Result<()> {
        let notices = [self.engine.take_notices(), self.state.guard.take_notices()];
        notices.iter().flatten().try_for_each(|notice| self.audience.notice(notice))
    }
}

/// What decides on the end of the run and on its result, seen at every step whatever is written.
fn monitor_step(engine: &Engine, rule: &mut StopRule, monitor: &mut Monitor) {
    let (strain, stress) = (engine.strain(), engine.stress());
    rule.step(engine.time(), strain, stress);
    let stresses = (0..engine.assembly().wires.len()).map(|w| engine.view().wire_stress(w));
    monitor.see(strain, stress, stresses);
}

/// All observers, and the time they take.
struct Audience<'a, 'b> {
    observers: &'a mut [&'b mut dyn Observer],
    /// How many of them were started: only those may be finished.
    started: usize,
    time: Duration,
    /// Keeps what they are told until it is on the disk.
    keeper: Option<&'a mut Keeper>,
}

impl Audience<'_, '_> {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        let begin = Instant::now();
        for observer in self.observers.iter_mut() {
            observer.start(info)?;
            self.started += 1;
        }
        self.time += begin.elapsed();
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.remember(|| Record::Sample(sample.clone()));
        self.each(|observer| observer.sample(sample))
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        if let Some(keeper) = &mut self.keeper {
            keeper.snapshot();
        }
        self.each(|observer| observer.snapshot(snapshot))
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.remember(|| Record::Rupture(rupture.clone()));
        self.each(|observer| observer.rupture(rupture))
    }

    fn notice(&mut self, notice: &Notice) -> Result<()> {
        self.remember(|| Record::Notice(notice.clone()));
        self.each(|observer| observer.notice(notice))
    }

    fn stopping(&mut self) {
        self.observers.iter_mut().take(self.started).for_each(|observer| observer.stopping());
    }

    fn peaks(&mut self, peaks: &Peaks) -> Result<()> {
        self.each(|observer| observer.peaks(peaks))
    }

    /// A record of a run that is resumed.
    fn tell(&mut self, record: &Record) -> Result<()> {
        match record {
            Record::Sample(sample) => self.sample(sample),
            Record::Snapshot(snapshot) => self.snapshot(&Arc::new(snapshot.clone())),
            Record::Rupture(rupture) => self.rupture(rupture),
            Record::Notice(notice) => self.notice(notice),
            Record::Peaks(peaks) => self.peaks(peaks),
        }
    }

    fn remember(&mut self, record: impl FnOnce() -> Record) {
        if let Some(keeper) = self.keeper.as_mut().filter(|keeper| keeper.keeps()) {
            keeper.told(record());
        }
    }

    fn each(&mut self, mut tell: impl FnMut(&mut dyn Observer) -> Result<()>) -> Result<()> {
        let begin = Instant::now();
        let told = self.observers.iter_mut().try_for_each(|observer| tell(*observer));
        self.time += begin.elapsed();
        told
    }

    /// Finishes every observer that was started, whatever the others answer, without what takes long once `stop` is set; the
    /// first error counts.
    fn finish(&mut self, stop: &AtomicBool) -> Result<()> {
        let begin = Instant::now();
        let started = self.observers.iter_mut().take(self.started);
        let answers: Vec<Result<()>> = started.map(|observer| observer.finish_unless(stop)).collect();
        self.time += begin.elapsed();
        answers.into_iter().collect()
    }
}
