//! The recording of a run for the Rerun viewer (`recording.rrd`), and the stream to a running viewer.
//!
//! This file and its folder are the only place that names `rerun`.
//!
//! | entity | contents |
//! | --- | --- |
//! | `/headline` | what happened: the first break, the result, notices |
//! | `/strand/<layer>/wire_<NN>` | particles: positions (mm), radii (mm), colours; fields `Bond`: true axial stress (MPa), equivalent plastic strain (-), utilisation to rupture (-), contact pressure (MPa), state; `Tube`: turn and length (mm) of the capsule at each particle; `Map`: places on the unrolled map |
//! | `/strand/<layer>/wire_<NN>/ruptures` | labelled points at the places of rupture (mm), from their time on |
//! | `/first_break`, `/focus` | mark and label of the first break; what the eye of the close view follows: the main fracture |
//! | `/spheres`, `/bodies`, `/grips` | free spheres; rigid bodies; cylinders around what the grips hold (mm) |
//! | `/map/<layer>/wire_<NN>/ruptures` | ruptures on the unrolled map, and their order |
//! | `/chart` | nominal stress over strain, drawn with axes in % and MPa |
//! | `/states/<layer>/wire_<NN>` | lane of the wire's state: whole, yielding, broken |
//! | `/strain` | strain of the body (%) |
//! | `/stress/body`, `/stress/layers`, `/stress/wires/<layer>` | nominal stress (MPa); over `microstrain` the first is the stress–strain curve |
//! | `/broken`, `/energy` | wires and bonds broken; energy ledger (J) |
//! | `/ruptures` | log, a line per rupture, and notices as warnings |
//! | `/about`, properties | what the run is |
//!
//! Nothing is recorded twice: a wire as particles, as a tube and as a row of the map is one entity, and the layout tells each
//! view by which of the viewer's visualizers to draw it, and from which components. States, radii, turns and lengths are
//! recorded where they change: what was recorded last holds until then.
//!
//! A viewer opens at the last state and plays a run in twenty seconds, over strain, or over time where nothing is pulled;
//! the stretch around the ruptures is selected, so that its button for loops repeats it.
//!
//! Everything is on three timelines: `step`, `sim_time` and `microstrain` (whole µm/m: 10,000 is 1 %). Snapshots go
//! out in batches of fixed size, everything as columns without clock times, so that the same run gives the same
//! contents.

mod bodies;
mod chart;
mod curve;
mod first_break;
mod grips;
mod headline;
mod layout;
mod look;
mod map;
mod marks;
pub mod names;
mod paint;
mod particles;
pub mod read;
mod run;
mod sections;
mod sink;
mod states;
mod stream;
mod tubes;

pub use names::{APPLICATION, CONTACT_PRESSURE, PLASTIC_STRAIN, SPEED, STATE, STRESS, UTILISATION};
pub use sink::{DEFAULT_VIEWER, RERUN_VERSION};
pub use stream::{STEP, STRAIN, TIME};

use crate::base::error::{Error, Result};
use crate::base::finding::Notice;
use crate::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use crate::observe::{Observer, Peaks};
use crate::scene::spec::Spec;
use crate::scene::write::to_toml;
use rerun::RecordingStreamBuilder;
use rerun::external::re_uri::ProxyUri;
use rerun::log::{ChunkBatcherConfig, LogMsg};
use rerun::sink::{GrpcSink, LogSink, MultiSink};
use run::Run;
use sink::RecordingFile;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use stream::Stream;

/// Snapshots per chunk: enough that the head of a chunk does not count, few enough to hold in memory.
const BATCH: usize = 16;

/// How to record.
#[derive(Debug, Clone)]
pub struct RecordingOptions {
    /// Address of a running viewer to stream to as well, such as [`DEFAULT_VIEWER`].
    pub live: Option<String>,
    /// The scene: what tells this run from others, the quantity that colours, and the limits of what is believed.
    pub scene: Spec,
}

/// An observer that writes a recording.
pub struct Recording {
    path: PathBuf,
    file: RecordingFile,
    viewer: Option<ProxyUri>,
    scene: Spec,
    run: Option<Run>,
}

/// Checks that a viewer listens at `address`, so that this is known before a simulation starts.
///
/// # Errors
/// [`Error::Missing`] when nobody listens there, [`Error::Input`] when it is not the address of a viewer.
pub fn check_viewer(address: &str) -> Result<()> {
    sink::viewer(address).map(|_| ())
}

impl Recording {
    /// Opens `<file>.partial` for writing; it is renamed to `file` when the run is finished.
    ///
    /// # Errors
    /// [`Error::Io`] when the file cannot be created, [`Error::Missing`] when no viewer listens at
    /// [`RecordingOptions::live`], [`Error::Input`] when that is not the address of a viewer.
    pub fn new(file: &Path, options: RecordingOptions) -> Result<Self> {
        let viewer = options.live.as_deref().map(sink::viewer).transpose()?;
        Ok(Self { path: file.to_owned(), file: RecordingFile::create(file)?, viewer, scene: options.scene, run: None })
    }

    fn run(&mut self) -> Result<&mut Run> {
        let path = &self.path;
        self.run.as_mut().ok_or_else(|| {
            Error::io(
                "cannot record to",
                path,
                std::io::Error::other("the run has not been announced to the recording"),
            )
        })
    }

    fn stream(&self, id: &str) -> Result<Stream> {
        let rerun = RecordingStreamBuilder::new(APPLICATION)
            // Whatever the environment says (RERUN=off): a recording was asked for.
            .enabled(true)
            .recording_id(id)
            // Its own properties hold the clock time of the start; ours come from `Run::send_properties`.
            .send_properties(false)
            .batcher_config(ChunkBatcherConfig::NEVER)
            .buffered()
            .map_err(|e| Error::io("cannot record to", &self.path, std::io::Error::other(e.to_string())))?;
        rerun.set_sink(self.sink());
        Ok(Stream::new(rerun, &self.path))
    }

    fn sink(&self) -> Box<dyn LogSink> {
        let file = Box::new(self.file.clone());
        match &self.viewer {
            None => file,
            Some(viewer) => Box::new(MultiSink::new(vec![file, Box::new(GrpcSink::new(viewer.clone()))])),
        }
    }
}

impl Observer for Recording {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        let id = recording_id(info, &self.scene)
            .map_err(|e| Error::io("cannot record to", &self.path, std::io::Error::other(e.to_string())))?;
        // A live viewer should see each snapshot at once.
        let batch = if self.viewer.is_some() { 1 } else { BATCH };
        self.run = Some(Run::start(self.stream(&id)?, info, &id, &self.scene, batch)?);
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.run()?.sample(sample)
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        self.run()?.snapshot(snapshot)?;
        self.file.check()
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.run()?.rupture(rupture)
    }

    fn notice(&mut self, notice: &Notice) -> Result<()> {
        self.run()?.notice(notice)
    }

    fn peaks(&mut self, peaks: &Peaks) -> Result<()> {
        self.run()?.peaks(peaks)
    }

    fn finish(&mut self) -> Result<()> {
        let Some(mut run) = self.run.take() else { return Ok(()) };
        // Whoever watches has arranged the views by now; the file is opened afresh.
        let activation = run.finish(&self.scene, self.viewer.is_none())?;
        if let Err(error) = run.stream.rerun.flush_blocking()
            && self.viewer.is_some()
        {
            // The file keeps its own errors, so this one is the viewer's, and the run does not depend on it.
            eprintln!("the Rerun viewer no longer listens ({error}); the recording in the file is whole");
        }
        if self.viewer.is_some() {
            self.file.send(LogMsg::BlueprintActivationCommand(activation));
        }
        drop(run);
        self.file.complete()
    }
}

/// The same run always gets the same id, and runs that differ in what is known of them get different ones, because
/// the viewer merges recordings with the same id.
fn recording_id(info: &RunInfo, scene: &Spec) -> Result<String, postcard::Error> {
    let mut hasher = DefaultHasher::new();
    postcard::to_stdvec(info)?.hash(&mut hasher);
    // The viewer remembers layouts by id, so a program with another layout needs other ids.
    env!("CARGO_PKG_VERSION").hash(&mut hasher);
    to_toml(scene).hash(&mut hasher);
    Ok(format!("{}-{:016x}", info.name, hasher.finish()))
}
