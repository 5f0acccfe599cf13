//! The observer that writes a numbered PNG sequence while the simulation goes on.

use super::animation::{self, Still};
use super::frame::{Renderer, Scene, Sheet, Wires};
use super::history::{History, Row};
use super::{adapter, png};
use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use crate::observe::Observer;
use crate::observe::animation::Animation;
use crate::observe::origin::Origin;
use crate::observe::timings::Timings;
use crate::scene::spec::OutputSpec;
use image::RgbImage;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Fewest and most snapshots that may wait to be drawn.
const WAITING: std::ops::RangeInclusive<usize> = 4..=1024;
/// Memory of a snapshot for each particle (bytes): five f32, a position and a state, and the other half for vectors
/// that grew with room to spare.
const PARTICLE_BYTES: usize = 48;
/// Time between two looks at whether the run was stopped while its last frames are drawn.
const LOOK: Duration = Duration::from_millis(2);
/// Pictures that may wait for their charts and text, or to be encoded: both are faster than drawing, so few ever do.
const DRAWN: usize = 2;

/// Writes `frame_0000.png`, `frame_0001.png` … into a folder. One thread has the adapter draw wires and makes the next frame
/// ready meanwhile, one draws charts and text over them, and one encodes, while the simulation goes on.
pub struct FrameWriter {
    folder: PathBuf,
    look: OutputSpec,
    animation: Option<Animation>,
    /// Pictures that are there and are not drawn again.
    whole: HashSet<PathBuf>,
    origin: Option<Origin>,
    /// Memory for snapshots that wait to be drawn (bytes).
    memory: usize,
    rows: Vec<Row>,
    ruptures: Vec<Rupture>,
    /// All ruptures of a run that is over.
    known: Option<Vec<Rupture>>,
    workers: Option<Workers>,
    timings: Arc<Mutex<Timings>>,
    stills: Vec<Still>,
}

struct Workers {
    jobs: SyncSender<Job>,
    /// Draw no more of those that wait.
    cut: Arc<AtomicBool>,
    draw: JoinHandle<Result<Timings>>,
    finish: JoinHandle<Timings>,
    encode: JoinHandle<Result<Timings>>,
}

/// A snapshot and what happened since the one before.
struct Job {
    snapshot: Arc<Snapshot>,
    /// Whether a picture of it is missing.
    missing: bool,
    rows: Vec<Row>,
    ruptures: Vec<Rupture>,
}

impl FrameWriter {
    /// Makes the folder and makes sure, now and not after hours, that frames can be drawn.
    ///
    /// # Errors
    /// When there is no adapter or when the folder cannot be made.
    pub fn new(folder: &Path, look: &OutputSpec) -> Result<Self> {
        adapter::check()?;
        regular::make_folder(folder)?;
        Ok(Self {
            folder: folder.to_owned(),
            look: look.clone(),
            animation: None,
            whole: HashSet::new(),
            origin: None,
            memory: 0,
            rows: Vec::new(),
            ruptures: Vec::new(),
            known: None,
            workers: None,
            timings: Arc::default(),
            stills: Vec::new(),
        })
    }

    /// Makes an animation of the pictures when the last one is written, also of those of a run that was stopped.
    pub fn with_animation(mut self, animation: Option<Animation>) -> Self {
        self.animation = animation;
        self
    }

    /// Leaves out pictures that are there already, from an earlier process that drew the same.
    pub fn without(mut self, whole: HashSet<PathBuf>) -> Self {
        self.whole = whole;
        self
    }

    /// Lets close-ups look at the main fracture from the first picture: `ruptures` are all of a run that is over.
    pub fn knowing(mut self, ruptures: Vec<Rupture>) -> Self {
        self.known = Some(ruptures);
        self
    }

    /// Writes into each picture which run it shows.
    pub fn with_origin(mut self, origin: Origin) -> Self {
        self.origin = Some(origin);
        self
    }

    /// Lets snapshots that are not yet drawn take this much memory (bytes) before whoever brings them has to wait.
    /// Ruptures come in bursts that no adapter keeps up with. Without it, four may wait.
    pub fn with_memory(mut self, bytes: usize) -> Self {
        self.memory = bytes;
        self
    }

    /// Where the time went; complete after `finish`.
    pub fn timings(&self) -> Timings {
        *self.timings.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The same for those who hand the writer over.
    pub fn shared_timings(&self) -> Arc<Mutex<Timings>> {
        self.timings.clone()
    }

    fn add(&self, timings: &Timings) {
        self.timings.lock().unwrap_or_else(PoisonError::into_inner).merge(timings);
    }

    /// Ends all threads, at once where `stop` is set or else when all is drawn, and returns the first error that one met.
    fn join(&mut self, stop: &AtomicBool) -> Result<()> {
        let Some(Workers { jobs, cut, draw, finish, encode }) = self.workers.take() else {
            return Ok(());
        };
        let begin = Instant::now();
        drop(jobs);
        while !draw.is_finished() && !stop.load(Ordering::Relaxed) {
            std::thread::sleep(LOOK);
        }
        cut.fetch_or(stop.load(Ordering::Relaxed), Ordering::Relaxed);
        let results = [draw.join(), finish.join().map(Ok), encode.join()];
        self.add(&Timings { drained: begin.elapsed(), ..Timings::default() });
        // An encoder that failed (disk full) is why the drawing stopped, so its error comes first.
        for result in results.into_iter().rev() {
            let timings = result.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
            self.add(&timings);
        }
        Ok(())
    }

    fn animate(&mut self, stop: &AtomicBool) -> Result<()> {
        let Some(animation) = self.animation.take() else { return Ok(()) };
        let begin = Instant::now();
        // One that ends too early would look whole.
        let written = match self.timings().not_drawn {
            0 => animation::write(&animation, &self.stills, stop),
            _ => Err(Error::Interrupted),
        };
        let (animation_bytes, not_animated) = match written {
            Ok(bytes) => (bytes, false),
            Err(Error::Interrupted) => (0, true),
            Err(error) => return Err(error),
        };
        self.add(&Timings { animation: begin.elapsed(), animation_bytes, not_animated, ..Timings::default() });
        Ok(())
    }
}

fn picture(folder: &Path, number: usize) -> PathBuf {
    folder.join(format!("frame_{number:04}.png"))
}

impl Observer for FrameWriter {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        let renderer = Renderer::new(info, &self.look)?;
        let waiting = self.memory / (PARTICLE_BYTES * info.particles.max(1));
        let (jobs, waiting) = sync_channel(waiting.clamp(*WAITING.start(), *WAITING.end()));
        let (wires, drawn) = sync_channel(DRAWN);
        let (pictures, finished) = sync_channel(DRAWN);
        let sheet = renderer.sheet();
        let (folder, origin) = (self.folder.clone(), self.origin);
        let cut = Arc::new(AtomicBool::new(false));
        let history = self.known.take().map_or_else(History::default, History::knowing);
        self.workers = Some(Workers {
            jobs,
            cut: cut.clone(),
            draw: std::thread::spawn(move || draw_all(renderer, history, &waiting, &wires, &cut)),
            finish: std::thread::spawn(move || finish_all(&sheet, &drawn, &pictures)),
            encode: std::thread::spawn(move || encode_all(&folder, origin, &finished)),
        });
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.rows.push(sample.into());
        Ok(())
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        let file = picture(&self.folder, self.stills.len());
        let job = Job {
            snapshot: snapshot.clone(),
            missing: !self.whole.contains(&file),
            rows: std::mem::take(&mut self.rows),
            ruptures: std::mem::take(&mut self.ruptures),
        };
        let Some(workers) = &self.workers else {
            return Err(Error::input("a snapshot came before the run started", "call `start` first"));
        };
        let pause = job.ruptures.iter().any(|r| r.first_of_wire);
        let begin = Instant::now();
        if workers.jobs.send(job).is_err() {
            // The drawing thread has ended early: say why.
            return self.join(&AtomicBool::new(false));
        }
        self.add(&Timings { waited: begin.elapsed(), ..Timings::default() });
        self.stills.push(Still { picture: file, pause });
        Ok(())
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.ruptures.push(rupture.clone());
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        self.finish_unless(&AtomicBool::new(false))
    }

    fn finish_unless(&mut self, stop: &AtomicBool) -> Result<()> {
        self.join(stop)?;
        self.animate(stop)
    }

    fn stopping(&mut self) {
        if let Some(workers) = &self.workers {
            workers.cut.store(true, Ordering::Relaxed);
        }
    }
}

impl Drop for FrameWriter {
    fn drop(&mut self) {
        // An observer that is dropped without `finish` (the run failed) still completes the frames it has.
        if !std::thread::panicking() {
            let _ = self.join(&AtomicBool::new(false));
        }
    }
}

/// A frame, its number and what it shows.
struct Drawn<T> {
    number: usize,
    snapshot: Arc<Snapshot>,
    /// All up to it.
    history: History,
    frame: T,
}

/// Has the frames of all jobs drawn without charts and text. A frame is made ready while the adapter draws the one before.
fn draw_all(
    mut renderer: Renderer,
    mut history: History,
    jobs: &Receiver<Job>,
    drawn: &SyncSender<Drawn<Wires>>,
    cut: &AtomicBool,
) -> Result<Timings> {
    let mut not_drawn = 0;
    let mut begun: Option<Drawn<Scene>> = None;
    for number in 0.. {
        // Nothing waits for a job that is long in coming.
        let job = match jobs.try_recv() {
            Err(TryRecvError::Empty) => {
                if !collect(&mut renderer, begun.take(), drawn)? {
                    break;
                }
                jobs.recv().ok()
            }
            received => received.ok(),
        };
        let Some(job) = job else { break };
        history.rows.extend(job.rows);
        history.ruptures.extend(job.ruptures);
        renderer.follow(&mut history, &job.snapshot);
        if !job.missing {
            continue;
        }
        if cut.load(Ordering::Relaxed) {
            not_drawn += 1;
            continue;
        }
        let scene = renderer.prepare(&job.snapshot, &history);
        if !collect(&mut renderer, begun.take(), drawn)? {
            break;
        }
        renderer.begin(&scene);
        begun = Some(Drawn { number, snapshot: job.snapshot, history: history.clone(), frame: scene });
    }
    collect(&mut renderer, begun, drawn)?;
    Ok(Timings { not_drawn, ..renderer.timings() })
}

/// Waits for a frame that was begun and hands it on; whether someone takes it. Who does not has ended with an error of his own,
/// which `join` reports.
fn collect(renderer: &mut Renderer, begun: Option<Drawn<Scene>>, drawn: &SyncSender<Drawn<Wires>>) -> Result<bool> {
    let Some(begun) = begun else { return Ok(true) };
    let Drawn { number, snapshot, history, frame } = begun;
    let frame = renderer.collect(frame)?;
    Ok(drawn.send(Drawn { number, snapshot, history, frame }).is_ok())
}

/// Draws charts and text over all frames.
fn finish_all(sheet: &Sheet, drawn: &Receiver<Drawn<Wires>>, pictures: &SyncSender<Drawn<RgbImage>>) -> Timings {
    let mut timings = Timings::default();
    for Drawn { number, snapshot, history, frame } in drawn.iter() {
        let start = Instant::now();
        let frame = sheet.finish(frame, &snapshot, &history);
        timings.overlay += start.elapsed();
        if pictures.send(Drawn { number, snapshot, history, frame }).is_err() {
            break;
        }
    }
    timings
}

fn encode_all(folder: &Path, origin: Option<Origin>, pictures: &Receiver<Drawn<RgbImage>>) -> Result<Timings> {
    let mut timings = Timings::default();
    for Drawn { number, snapshot, frame, .. } in pictures.iter() {
        let start = Instant::now();
        let bytes = png::encode(&frame, origin.map(|origin| (origin, snapshot.sample.step)))?;
        png::write(&picture(folder, number), &bytes)?;
        timings.encode += start.elapsed();
    }
    Ok(timings)
}
