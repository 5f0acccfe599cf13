//! The observer that writes a numbered PNG sequence while the simulation goes on.

use super::frame::Renderer;
use super::png;
use super::style::FrameOptions;
use super::timings::Timings;
use crate::base::error::{Error, Result};
use crate::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use crate::observe::Observer;
use image::RgbImage;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::Instant;

/// Snapshots that may wait to be drawn before the simulation has to wait.
const WAITING: usize = 4;

/// Writes `frame_0000.png`, `frame_0001.png` … into a folder. Draws on one thread and encodes on another; only when
/// four snapshots are not yet drawn does the simulation wait.
pub struct FrameWriter {
    folder: PathBuf,
    options: FrameOptions,
    curve: Vec<(f64, f64)>,
    ruptures: Vec<Rupture>,
    workers: Option<Workers>,
    timings: Timings,
    frames: usize,
}

struct Workers {
    jobs: SyncSender<Job>,
    draw: JoinHandle<Result<Timings>>,
    encode: JoinHandle<Result<Timings>>,
}

/// A snapshot and what happened since the one before.
struct Job {
    snapshot: Arc<Snapshot>,
    curve: Vec<(f64, f64)>,
    ruptures: Vec<Rupture>,
}

impl FrameWriter {
    /// Makes the folder and makes sure, now and not after hours, that frames can be drawn.
    ///
    /// # Errors
    /// When there is no adapter or when the folder cannot be made.
    pub fn new(folder: &Path, options: FrameOptions) -> Result<Self> {
        super::adapter::check()?;
        std::fs::create_dir_all(folder).map_err(|e| Error::io("cannot make the folder", folder, e))?;
        Ok(Self {
            folder: folder.to_owned(),
            options,
            curve: Vec::new(),
            ruptures: Vec::new(),
            workers: None,
            timings: Timings::default(),
            frames: 0,
        })
    }

    /// Where the time went; complete after `finish`.
    pub fn timings(&self) -> Timings {
        self.timings
    }

    /// Frames handed over so far.
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Ends both threads and returns the first error that either met.
    fn join(&mut self) -> Result<()> {
        let Some(Workers { jobs, draw, encode }) = self.workers.take() else {
            return Ok(());
        };
        drop(jobs);
        let results = [draw.join(), encode.join()];
        // An encoder that failed (disk full) is why the drawing stopped, so its error comes first.
        for result in results.into_iter().rev() {
            let timings = result.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
            self.timings.merge(&timings);
        }
        Ok(())
    }
}

impl Observer for FrameWriter {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        let renderer = Renderer::new(info, &self.options)?;
        let (jobs, waiting) = sync_channel(WAITING);
        let (pictures, drawn) = sync_channel(2);
        let folder = self.folder.clone();
        self.workers = Some(Workers {
            jobs,
            draw: std::thread::spawn(move || draw_all(renderer, &waiting, &pictures)),
            encode: std::thread::spawn(move || encode_all(&folder, &drawn)),
        });
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.curve.push((sample.strain, sample.stress));
        Ok(())
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        let job = Job {
            snapshot: snapshot.clone(),
            curve: std::mem::take(&mut self.curve),
            ruptures: std::mem::take(&mut self.ruptures),
        };
        let Some(workers) = &self.workers else {
            return Err(Error::input("a snapshot came before the run started", "call `start` first"));
        };
        if workers.jobs.send(job).is_err() {
            // The drawing thread has ended early: say why.
            return self.join();
        }
        self.frames += 1;
        Ok(())
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.ruptures.push(rupture.clone());
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        self.join()
    }
}

impl Drop for FrameWriter {
    fn drop(&mut self) {
        // An observer that is dropped without `finish` (the run failed) still completes the frames it has.
        if !std::thread::panicking() {
            let _ = self.join();
        }
    }
}

fn draw_all(mut renderer: Renderer, jobs: &Receiver<Job>, pictures: &SyncSender<(usize, RgbImage)>) -> Result<Timings> {
    let (mut curve, mut ruptures) = (Vec::new(), Vec::new());
    for (number, job) in jobs.iter().enumerate() {
        curve.extend(job.curve);
        ruptures.extend(job.ruptures);
        let picture = renderer.draw(&job.snapshot, &curve, &ruptures)?;
        if pictures.send((number, picture)).is_err() {
            // The encoder has ended with an error of its own, which `join` reports.
            break;
        }
    }
    Ok(renderer.timings())
}

fn encode_all(folder: &Path, pictures: &Receiver<(usize, RgbImage)>) -> Result<Timings> {
    let mut timings = Timings::default();
    for (number, picture) in pictures.iter() {
        let start = Instant::now();
        let bytes = png::encode(&picture)?;
        png::write(&folder.join(format!("frame_{number:04}.png")), &bytes)?;
        timings.encode += start.elapsed();
    }
    Ok(timings)
}
