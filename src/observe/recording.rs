//! The recording of a run for the Rerun viewer (`recording.rrd`), and the stream to a running viewer.
//!
//! This file and its folder are the only place that names `rerun`.
//!
//! | entity | contents |
//! | --- | --- |
//! | `/strand/<layer>/wire_<NN>` | particles: positions [mm], mean radius [mm], colours; fields `Bond`: true axial stress [MPa], equivalent plastic strain [-], state |
//! | `/strand/<layer>/wire_<NN>/tube` | the same wire as straight pieces of tube, apart where it broke |
//! | `/strand/<layer>/wire_<NN>/ruptures`, `…/ruptures/label` | marked, labelled points at the places of rupture [mm], from their time on |
//! | `/spheres`, `/grips` | free spheres; boxes around what the grips hold [mm] |
//! | `/map/<layer>`, `/map/<layer>/wire_<NN>/ruptures` | unrolled map: a row per wire, coloured like the particles |
//! | `/states/<layer>/wire_<NN>` | lane of the wire's state: whole, yielding, broken |
//! | `/stress/body`, `/stress/layers`, `/stress/wires/<layer>` | nominal stress [MPa]; over `microstrain` the first is the stress–strain curve |
//! | `/broken`, `/energy` | wires and bonds broken; energy ledger [J] |
//! | `/ruptures` | log, a line per rupture |
//! | `/about`, properties | what the run is |
//!
//! Everything is on three timelines: `step`, `sim_time` and `microstrain` (whole millionths of strain). Snapshots go
//! out in batches of fixed size, everything as columns without clock times, so that the same run gives the same
//! contents.

mod curve;
mod grips;
mod layout;
mod map;
mod marks;
pub mod names;
mod paint;
mod particles;
pub mod read;
mod sink;
mod states;
mod stream;
mod tubes;

pub use particles::{PLASTIC_STRAIN, SPEED, STATE, STRESS};
pub use sink::{DEFAULT_VIEWER, RERUN_VERSION};
pub use stream::{STEP, STRAIN, TIME};

use crate::base::error::{Error, Result};
use crate::engine::view::{BondState, RunInfo, Rupture, Sample, Snapshot};
use crate::observe::Observer;
use crate::scene::spec::ColourBy;
use map::Map;
use marks::Marks;
use paint::Palette;
use rerun::external::re_uri::ProxyUri;
use rerun::log::ChunkBatcherConfig;
use rerun::sink::{GrpcSink, LogSink, MultiSink};
use rerun::{
    AnnotationContext, DynamicArchetype, EntityPath, RecordingInfo, RecordingStreamBuilder, TextDocument,
    ViewCoordinates, components,
};
use sink::RecordingFile;
use states::States;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use stream::{Instant, Stream};

/// Name under which the viewer files all recordings of this program.
pub const APPLICATION: &str = "strandsnap";
/// Snapshots per chunk: enough that the head of a chunk does not count, few enough to hold in memory.
const BATCH: usize = 16;

/// How to record.
#[derive(Debug, Clone)]
pub struct RecordingOptions {
    /// Address of a running viewer to stream to as well, such as [`DEFAULT_VIEWER`].
    pub live: Option<String>,
    /// Quantity that colours the particles.
    pub colour: ColourBy,
}

/// An observer that writes a recording.
pub struct Recording {
    path: PathBuf,
    file: RecordingFile,
    viewer: Option<ProxyUri>,
    colour: ColourBy,
    identity: String,
    run: Option<Run>,
}

/// What exists once the run has started.
struct Run {
    info: Arc<RunInfo>,
    stream: Stream,
    palette: Palette,
    map: Map,
    states: States,
    marks: Marks,
    snapshots: Vec<Arc<Snapshot>>,
    samples: Vec<Sample>,
    batch: usize,
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
        Ok(Self {
            path: file.to_owned(),
            file: RecordingFile::create(file)?,
            viewer,
            colour: options.colour,
            identity: String::new(),
            run: None,
        })
    }

    /// Names what tells this run from others of the same scene: its seed, or better the whole resolved scene.
    ///
    /// The viewer merges recordings with the same id, so two runs that differ must not share it.
    pub fn identified_by(mut self, text: &str) -> Self {
        self.identity = text.to_owned();
        self
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
        let id = recording_id(info, &self.identity)
            .map_err(|e| Error::io("cannot record to", &self.path, std::io::Error::other(e.to_string())))?;
        let run = Run {
            info: info.clone(),
            stream: self.stream(&id)?,
            palette: Palette::new(self.colour, info),
            map: Map::new(info),
            states: States::new(info.wires.len()),
            marks: Marks::default(),
            snapshots: Vec::new(),
            samples: Vec::new(),
            // A live viewer should see each snapshot at once.
            batch: if self.viewer.is_some() { 1 } else { BATCH },
        };
        run.send_fixed(&id)?;
        self.run = Some(run);
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.run()?.samples.push(sample.clone());
        Ok(())
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        let run = self.run()?;
        run.states.snapshot(&run.info, snapshot, curve::instant(&snapshot.sample));
        run.snapshots.push(snapshot.clone());
        if run.snapshots.len() >= run.batch {
            run.send()?;
        }
        self.file.check()
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        let run = self.run()?;
        let instant = Instant { step: rupture.step, time: rupture.time, strain: rupture.strain };
        run.states.set(rupture.wire, BondState::Broken, instant);
        run.marks.add(rupture);
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        let Some(mut run) = self.run.take() else { return Ok(()) };
        run.send()?;
        if let Err(error) = run.stream.rerun.flush_blocking()
            && self.viewer.is_some()
        {
            // The file keeps its own errors, so this one is the viewer's, and the run does not depend on it.
            eprintln!("the Rerun viewer no longer listens ({error}); the recording in the file is whole");
        }
        drop(run);
        self.file.complete()
    }
}

impl Run {
    fn send_fixed(&self, id: &str) -> Result<()> {
        layout::send(&self.stream, APPLICATION, id, &self.info, &self.map)?;
        // Rerun hands on data before messages; without this the layout would come last, and a viewer that is still
        // loading would invent one.
        self.stream.checked(self.stream.rerun.flush_blocking())?;
        self.send_properties()?;
        self.stream.fixed("/", &ViewCoordinates::RIGHT_HAND_Z_UP())?;
        self.stream.fixed("/", &annotation())?;
        self.map.send(&self.stream, &self.info)?;
        if let Some(scale) = self.palette.scale() {
            self.map.send_colour_bar(&self.stream, &scale)?;
        }
        curve::send_names(&self.stream, &self.info)?;
        grips::send_style(&self.stream)?;
        States::send_style(&self.stream, &self.info)?;
        self.send_sphere_radii()
    }

    fn send_properties(&self) -> Result<()> {
        let info = &self.info;
        self.stream.fixed(EntityPath::properties(), &RecordingInfo::new().with_name(info.name.as_str()))?;
        let text = |value: String| [components::Text::from(value)];
        let run = DynamicArchetype::new("strandsnap.Run")
            .with_component::<components::Text>("scene", text(info.name.clone()))
            .with_component::<components::Text>("about", text(info.about.clone()))
            .with_component::<components::Text>("layers", text(info.layers.join(", ")))
            .with_component::<components::Text>("wires", text(info.wires.len().to_string()))
            .with_component::<components::Text>("particles", text(info.particles.to_string()))
            .with_component::<components::Text>("strandsnap_version", text(env!("CARGO_PKG_VERSION").to_owned()))
            .with_component::<components::Text>("rerun_version", text(RERUN_VERSION.to_owned()));
        self.stream.fixed(EntityPath::properties().join(&EntityPath::from("run")), &run)?;
        self.stream.fixed(names::ABOUT, &TextDocument::from_markdown(about(info)))
    }

    fn send_sphere_radii(&self) -> Result<()> {
        let info = &self.info;
        if info.particles == info.wire_particles {
            return Ok(());
        }
        let radii = info.radius[info.wire_particles..].iter().copied();
        self.stream.fixed(names::SPHERES, &rerun::Points3D::update_fields().with_radii(radii))
    }

    /// Sends everything that waits.
    fn send(&mut self) -> Result<()> {
        let instants: Vec<_> = self.snapshots.iter().map(|s| curve::instant(&s.sample)).collect();
        if !instants.is_empty() {
            let (info, palette, snapshots) = (&self.info, &self.palette, &self.snapshots);
            particles::Batch { info, palette, instants: &instants, snapshots }.send(&self.stream)?;
            grips::send(&self.stream, &self.info, &instants, &self.snapshots)?;
        }
        if !self.samples.is_empty() {
            curve::send(&self.stream, &self.info, &self.samples)?;
        }
        self.states.send(&self.stream, &self.info)?;
        self.marks.send(&self.stream, &self.info, &self.map)?;
        self.snapshots.clear();
        self.samples.clear();
        Ok(())
    }
}

/// Names and colours of bond states, shown where a particle is clicked.
fn annotation() -> AnnotationContext {
    let colours = [0x3E6F8EFF, 0xD9A441FF, paint::BROKEN, paint::NEUTRAL];
    let classes = particles::STATE_NAMES.iter().zip(colours).zip(0u16..);
    AnnotationContext::new(classes.map(|((name, colour), i)| (i, *name, rerun::Rgba32::from(colour))))
}

fn about(info: &RunInfo) -> String {
    let wires = info.layers.iter().enumerate().map(|(layer, name)| {
        let count = map::wires_of(info, layer).count();
        format!("- {name}: {count} wires\n")
    });
    let wires: String = wires.collect();
    format!(
        "# {}\n\n{}\n\n{wires}\n{} particles; positions in mm, stress in MPa. \
         The timeline `{STRAIN}` counts strain in millionths: 234,000 is 23.4 %.\n\n\
         Colours: from {:.0} to {:.0} MPa of true axial stress where stress colours; red at broken bonds.\n\n\
         strandsnap {}, Rerun {RERUN_VERSION}\n",
        info.name,
        info.about,
        info.particles,
        info.stress_range[0],
        info.stress_range[1],
        env!("CARGO_PKG_VERSION"),
    )
}

/// The same run always gets the same id, and runs that differ in what is known of them get different ones.
fn recording_id(info: &RunInfo, identity: &str) -> Result<String, postcard::Error> {
    let mut hasher = DefaultHasher::new();
    postcard::to_stdvec(info)?.hash(&mut hasher);
    // The viewer remembers layouts by id, so a program with another layout needs other ids.
    env!("CARGO_PKG_VERSION").hash(&mut hasher);
    identity.hash(&mut hasher);
    Ok(format!("{}-{:016x}", info.name, hasher.finish()))
}
