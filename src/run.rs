//! Floor 7: a run from scene to results: assembly → engine + observers → [`RunSummary`].
//!
//! [`run`] writes a folder; [`simulate`] shows a run to observers and writes nothing.

pub mod build;
pub mod cautions;
pub mod checkpoint;
pub mod cost;
pub mod devices;
pub mod drawing;
mod drive;
pub mod estimate;
pub mod exported;
pub mod folder;
pub mod identity;
pub mod lock;
mod options;
pub mod outputs;
#[cfg(feature = "record")]
pub mod record;
pub mod replay;
mod schedule;
pub mod size;
pub mod steps;
mod stop;
#[cfg(feature = "record")]
pub mod view;

pub use crate::base::finding::StopReason;
pub use crate::observe::summary::RunSummary;
pub use drive::{Outcome, simulate, simulate_engine};
pub use options::{Outputs, RunOptions};
pub use schedule::{Due, Schedule};
pub use steps::DeviceChoice;
pub use stop::StopRule;

use crate::base::error::{Error, Result};
use crate::base::finding::KeptResults;
use crate::base::units::ms;
use crate::engine::Engine;
use crate::observe::Observer;
use crate::observe::details::Details;
use crate::observe::files::write_whole;
use crate::observe::origin::Origin;
use crate::observe::summary::{Closing, Cost, Summariser};
use crate::observe::tables::Tables;
use crate::observe::timings::Timings;
use crate::observe::trajectory::Trajectory;
use crate::scene::spec::{PathSpec, Spec};
use crate::scene::{Scene, write};
use crate::strand::assembly::Assembly;
use crate::strand::discretise;
use checkpoint::{Checkpoint, Identity, Keeper, Spent};
use drive::{LoopState, Resumed};
use folder::OutFolder;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;
use steps::Steps;

/// Runs a scene and writes its results; `stop` ends it cleanly after the step in progress.
///
/// Everything that can be checked before simulating is checked before anything is written or removed. Files
/// grow under a partial name and get their own when they are whole. Results up to an interruption or an error
/// are kept.
///
/// # Errors
/// Bad input (scene, geometry, output folder), something missing on the machine (adapter, viewer), failure of the
/// simulation, or a file that cannot be written.
pub fn run(scene: &Scene, options: &RunOptions, stop: &AtomicBool) -> Result<RunSummary> {
    in_pool(options.threads, || run_watched(scene, options, Vec::new(), stop))?
}

/// [`run`] in the present thread pool, shown to `watchers` too.
///
/// # Errors
/// As for [`run`], and what a watcher answers.
pub fn run_watched(
    scene: &Scene,
    options: &RunOptions,
    watchers: Vec<&mut dyn Observer>,
    stop: &AtomicBool,
) -> Result<RunSummary> {
    let clock = Clock::start();
    if options.wait {
        lock::wait_to_write(&options.out, options.overwrite, stop)?;
    }
    let folder = OutFolder::check(&options.out, options.overwrite)?;
    spare_inputs(scene, &folder)?;
    outputs::check(options)?;
    let assembly = assemble(scene)?;
    let bonds = assembly.bond_count();
    let engine = Engine::new(&scene.spec, &scene.plan, assembly)?;
    let steps = Steps::new(&options.device, &engine)?;
    let _lock = folder.open()?;
    let resolved = write::to_toml(&scene.spec);
    write_whole(&folder.file(folder::SCENE), &resolved)?;
    let written = outputs::open(options, &scene.spec, &folder)?;
    let every = scene.spec.output.checkpoint;
    let keeper = Keeper::new(&options.out, every, Identity::new(resolved), options.outputs(), None);
    let job = Job { scene, options, folder: &folder, clock, bonds, keeper, steps };
    drive_and_summarise(job, engine, written, watchers, stop, None)
}

/// A run that was interrupted or killed and can go on from its last checkpoint.
pub struct Resumable {
    /// Its scene.
    pub scene: Scene,
    /// What it writes, and where.
    pub options: RunOptions,
    folder: OutFolder,
    identity: Identity,
    checkpoint: Checkpoint,
    /// What is remarkable, such as a damaged checkpoint beside a whole one.
    notes: Vec<String>,
}

impl Resumable {
    /// Looks at the folder of a run, and changes nothing there. It goes on with `threads`, and on `device` or on what it began
    /// with.
    ///
    /// # Errors
    /// [`Error::Input`] when there is no checkpoint, when none is whole, or when it is not one of the scene that lies beside
    /// it; something missing on the machine (adapter).
    pub fn open(folder: &Path, threads: Option<usize>, device: Option<DeviceChoice>) -> Result<Self> {
        let out = OutFolder::of_run(folder)?;
        let (checkpoint, damaged) = checkpoint::latest(folder)?;
        let mut notes: Vec<String> =
            damaged.iter().map(|what| format!("{what}; going on from the other one")).collect();
        let scene = crate::scene::load(&out.file(folder::SCENE).to_string_lossy(), &[])?;
        let identity = Identity::new(write::to_toml(&scene.spec));
        checkpoint.check(&identity)?;
        let began = RunOptions::of_resumed(folder, &checkpoint.outputs, threads);
        let options = RunOptions { device: device.unwrap_or(began.device), ..began };
        outputs::check(&options)?;
        notes.push(format!("going on from step {}", checkpoint.step));
        Ok(Self { scene, options, folder: out, identity, checkpoint, notes })
    }

    /// Refuses to go on as another run than that of `scene`.
    ///
    /// # Errors
    /// [`Error::Input`] that names what differs.
    pub fn check_scene(&self, scene: &Scene) -> Result<()> {
        self.checkpoint.check(&Identity::new(write::to_toml(&scene.spec)))
    }

    /// Goes on, in the present thread pool and shown to `watchers` too: when the run has ended, its files are those that an
    /// uninterrupted run writes. `note` is told from where it goes on, and what is remarkable, when nothing is left that
    /// could be refused.
    ///
    /// # Errors
    /// As for [`run`]; [`Error::Input`] when the trajectory is not that of the checkpoint.
    pub fn go_on(
        self,
        note: &(dyn Fn(&str) + Sync),
        watchers: Vec<&mut dyn Observer>,
        stop: &AtomicBool,
    ) -> Result<RunSummary> {
        let Self { scene, options, folder, identity, checkpoint, notes } = self;
        let clock = Clock::after(&checkpoint.spent);
        let assembly = assemble(&scene)?;
        let bonds = assembly.bond_count();
        let mut engine = Engine::new(&scene.spec, &scene.plan, assembly)?;
        let info = engine.info();
        let _lock = folder.take_over()?;
        // Nothing is touched before all of the state has been taken up.
        let state = LoopState::restore(&scene.spec, &info, &checkpoint.driver);
        let state = state.and_then(|state| engine.restore(&checkpoint.engine).map(|()| state));
        let state = state.map_err(|unfit| checkpoint::not_its(&unfit.to_string()))?;
        let steps = Steps::new(&options.device, &engine)?;
        let before = checkpoint.find_trajectory(&options.out, &info)?;
        // It is kept until the first checkpoint of the new one.
        let kept = folder.file(folder::RESUMED_FROM);
        if before != kept {
            std::fs::rename(&before, &kept).map_err(|e| Error::io("cannot rename", &before, e))?;
        }
        let trajectory = Trajectory::open(&kept)?;
        notes.iter().for_each(|what| note(what));
        folder.clear_results()?;
        let written = outputs::open(&options, &scene.spec, &folder)?;
        let every = scene.spec.output.checkpoint;
        let keeper = Keeper::new(&options.out, every, identity, options.outputs(), Some(&checkpoint));
        let job = Job { scene: &scene, options: &options, folder: &folder, clock, bonds, keeper, steps };
        drive_and_summarise(job, engine, written, watchers, stop, Some(Resumed { checkpoint, state, trajectory }))
    }
}

/// Refuses to write over what the run is made from.
fn spare_inputs(scene: &Scene, folder: &OutFolder) -> Result<()> {
    folder.spare(Path::new(scene.source.file_name()))?;
    scene.spec.wires.iter().try_for_each(|wire| match &wire.path {
        PathSpec::File { file, .. } => folder.spare(file),
        PathSpec::Straight { .. } => Ok(()),
    })
}

/// The wires, particles and bonds of a scene.
///
/// # Errors
/// A scene that does not fit into memory ([`size::check`]), and geometry that cannot be, at the line of the scene that asks
/// for it.
pub fn assemble(scene: &Scene) -> Result<Assembly> {
    size::check(scene)?;
    discretise::build(&scene.spec).map_err(|e| scene.source.error(&e.key, e.message, e.help))
}

/// Runs a scene to its end and writes nothing: shown to `watchers`, and summarised. Call it inside a rayon pool to choose
/// the threads. `stop` ends it early, with a summary that says so.
///
/// # Errors
/// Geometry that cannot be, what [`Engine::new`] refuses, failure of the simulation, and what a watcher answers.
pub fn summarise(scene: &Scene, watchers: Vec<&mut dyn Observer>, stop: &AtomicBool) -> Result<RunSummary> {
    let clock = Clock::start();
    let assembly = assemble(scene)?;
    let bonds = assembly.bond_count();
    let mut summariser = Summariser::new();
    let mut observers: Vec<&mut dyn Observer> = vec![&mut summariser];
    observers.extend(watchers.into_iter().map(|o| o as &mut dyn Observer));
    let outcome = simulate(&scene.spec, &scene.plan, assembly, &mut observers, stop)?;
    let closing = closing(&clock, &outcome, None, None);
    Ok(summariser.summary(&scene.spec, bonds, closing))
}

/// Calls `work` with a given number of threads behind every parallel loop in it.
///
/// # Errors
/// [`Error::Missing`] when the system refuses the threads.
pub fn in_pool<T: Send>(threads: Option<usize>, work: impl FnOnce() -> T + Send) -> Result<T> {
    // Zero means one thread per core.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
    let pool = pool.map_err(|e| Error::Missing {
        what: format!("cannot start the threads: {e}"),
        help: Some("ask for fewer with --threads".into()),
    })?;
    Ok(pool.install(work))
}

struct Clock {
    wall: Instant,
    cpu: Option<f64>,
    /// Wall and processor time of the run before it was resumed (s).
    before: [f64; 2],
}

impl Clock {
    fn start() -> Self {
        Self::after(&Spent::default())
    }

    fn after(spent: &Spent) -> Self {
        Self { wall: Instant::now(), cpu: cost::cpu_time(), before: [spent.wall_s, spent.cpu_s] }
    }

    fn cost(&self, outcome: &Outcome, frames: Option<Timings>) -> Cost {
        let stepping_ms = ms(outcome.stepping.as_secs_f64());
        Cost {
            steps: outcome.steps,
            simulated_s: outcome.time,
            wall_s: self.before[0] + self.wall.elapsed().as_secs_f64(),
            cpu_s: cost::cpu_time().zip(self.cpu).map(|(now, begin)| self.before[1] + now - begin),
            ms_per_step: (outcome.steps > 0).then(|| stepping_ms / outcome.steps as f64),
            threads: outcome.threads[0],
            threads_available: outcome.threads[1],
            adapter: outcome.adapter.clone(),
            not_on_adapter: outcome.not_on_adapter.clone(),
            frames,
            versions: cost::versions(),
        }
    }
}

/// What a run in progress needs to know about itself.
struct Job<'a> {
    scene: &'a Scene,
    options: &'a RunOptions,
    folder: &'a OutFolder,
    clock: Clock,
    bonds: usize,
    keeper: Keeper,
    steps: Steps,
}

fn drive_and_summarise(
    mut job: Job,
    mut engine: Engine,
    mut written: outputs::Written,
    watchers: Vec<&mut dyn Observer>,
    stop: &AtomicBool,
    resumed: Option<Resumed>,
) -> Result<RunSummary> {
    if job.options.threads.is_none() {
        engine.tune_threads();
    }
    let spec = &job.scene.spec;
    let mut summariser = Summariser::new();
    let mut tables = Tables::new(&job.options.out);
    let mut details = Details::new(&job.options.out, &spec.output.tables);
    let mut observers: Vec<&mut dyn Observer> = vec![&mut summariser, &mut tables, &mut details];
    observers.extend(written.observers.iter_mut().map(|o| &mut **o as &mut dyn Observer));
    observers.extend(watchers.into_iter().map(|o| o as &mut dyn Observer));
    let (outcome, error) =
        drive::drive((engine, job.steps), spec, &mut observers, stop, Some(&mut job.keeper), resumed)?;
    let timings = written.frames.as_ref().map(outputs::Frames::timings);
    let files = Some(job.options.written());
    let closing = Closing { written: files, ..closing(&job.clock, &outcome, error.as_ref(), timings) };
    let summary = summariser.summary(spec, job.bonds, closing);
    let kept = write_summary(job.folder, spec, &summary);
    // What came to its end, or cannot go on, has nothing to be resumed from.
    if kept.is_ok() && ended(&outcome, error.as_ref()) {
        job.keeper.clear()?;
        written.frames.map_or(Ok(()), outputs::Frames::complete)?;
    }
    match error {
        Some(error) => Err(with_place(error, &job.options.out, summary.warnings.len() - 1)),
        None => kept.map(|()| summary),
    }
}

/// Whether a run came to its end: not interrupted, nor stopped by a full disk or the like.
fn ended(outcome: &Outcome, error: Option<&Error>) -> bool {
    error.map_or(outcome.reason != StopReason::Interrupted, |error| matches!(error, Error::Simulation(_)))
}

/// How a run ended, for its summary.
fn closing(clock: &Clock, outcome: &Outcome, error: Option<&Error>, frames: Option<Timings>) -> Closing {
    Closing {
        stopped: outcome.reason,
        error: error.filter(|error| !matches!(error, Error::Simulation(_))).map(Error::to_string),
        quasi_static: outcome.quasi_static,
        limits: outcome.limits.clone(),
        cost: clock.cost(outcome, frames),
        written: None,
    }
}

fn write_summary(folder: &OutFolder, spec: &Spec, summary: &RunSummary) -> Result<()> {
    let path = folder.file(folder::SUMMARY);
    let text = serde_json::to_string_pretty(summary)
        .map_err(|e| Error::io("cannot write", &path, std::io::Error::other(e)))?;
    // An animation elsewhere is no file of this folder.
    let animation = summary.written.as_ref().and_then(|written| written.animation.as_deref());
    let own = animation.into_iter().filter(|name| !Path::new(name).is_absolute());
    let frames = summary.written.as_ref().is_some_and(|written| written.frames).then_some(folder::FRAMES);
    let own: Vec<&str> = own.chain(frames).collect();
    write_whole(&path, &identity::seal(&text, Origin::of(spec), folder.path(), &own)?)
}

/// Adds where the results so far are, and how many `earlier` findings in them may tell why.
fn with_place(error: Error, out: &Path, earlier: usize) -> Error {
    match error {
        Error::Simulation(mut stopped) => {
            stopped.kept = Some(KeptResults { folder: out.into(), earlier });
            Error::Simulation(stopped)
        }
        other => other,
    }
}
