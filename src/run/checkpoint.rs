//! Checkpoints: the whole state of a run in progress, kept so that it goes on after a crash to the same bits.
//!
//! A checkpoint holds the engine's state, that of the step loop (schedule, stop rule, guard, peaks), and what was told to
//! observers since the last snapshot; what was told before that is in the run's trajectory, whose blocks end with each
//! snapshot. Outputs are not cut back: a resumed run tells its observers everything again from the trajectory, so that they
//! write what they would have written.
//!
//! There are two slots, written in turn under a partial name, flushed to the disk and renamed, so that one of them is
//! always whole. Format: magic bytes, a version (u32, little endian), then an LZ4 frame, with a checksum per block and one
//! over all of it, of a [`Checkpoint`] in postcard.

use super::folder::{self, SLOTS};
use super::options::Outputs;
use crate::base::error::{Error, Result};
use crate::engine;
use crate::engine::view::RunInfo;
use crate::observe::partial;
use crate::observe::trajectory::{Record, Trajectory};
use crate::scene::spec::CheckpointSpec;
use lz4_flex::frame::{FrameDecoder, FrameEncoder, FrameInfo};
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io::{BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const MAGIC: [u8; 12] = *b"strandsnap\0C";
/// Raised whenever what is written changes its meaning or order.
const VERSION: u32 = 4;
/// Share of the run's time that checkpoints may take where the scene does not say how often (-).
const SHARE: f64 = 0.01;
/// Least wall time between two of them there (s).
const LEAST: f64 = 5.0;
/// Steps between two looks at the clock.
const LOOK: u64 = 16;

/// What a run in progress is, and how far it has come.
#[derive(Debug, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Counts the checkpoints of a run; the greater one is the later.
    pub number: u64,
    /// Whose state it is.
    pub identity: Identity,
    /// What the run writes.
    pub outputs: Outputs,
    /// Records of the trajectory that are on the disk and belong to it.
    pub records: u64,
    /// Those that came after them.
    pub tail: Vec<Record>,
    /// State of the step loop.
    pub driver: Vec<u8>,
    /// State of the engine ([`engine::Engine::save`]).
    pub engine: Vec<u8>,
    /// Steps done.
    pub step: u64,
    /// Time spent.
    pub spent: Spent,
}

/// What must be the same for a run to go on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// The resolved scene, as it stands in `scene.toml`.
    pub scene: String,
    /// Revision of the physics.
    pub revision: u32,
    /// Kind of processor, whose arithmetic the bits come from.
    pub machine: String,
}

impl Identity {
    /// Of a resolved scene, here and now.
    pub fn new(scene: String) -> Self {
        Self { scene, revision: engine::REVISION, machine: std::env::consts::ARCH.into() }
    }

    /// In what a run that wants to go on, `self`, differs from the one that was kept; `None` when in nothing.
    fn difference(&self, kept: &Self) -> Option<String> {
        if self.revision != kept.revision {
            return Some(format!(
                "it was made by revision {} of the physics; this program has revision {}",
                kept.revision, self.revision
            ));
        }
        if self.machine != kept.machine {
            return Some(format!("it was made on a {} processor; this is {}", kept.machine, self.machine));
        }
        let mut lines = kept.scene.lines();
        let other = self.scene.lines().zip(1..).find_map(|(line, number)| {
            let before = lines.next().unwrap_or_default();
            (line != before).then(|| format!("line {number} of its scene was `{before}`, and is `{line}` now"))
        });
        other.or_else(|| (lines.next().is_some()).then(|| "its scene was longer".into()))
    }
}

/// Time spent on a run before it was resumed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Spent {
    /// Wall time from its start (s).
    pub wall_s: f64,
    /// Processor time (s).
    pub cpu_s: f64,
    /// Wall time in the engine.
    pub stepping: Duration,
    /// Wall time in observers.
    pub observing: Duration,
}

/// Keeps checkpoints of a run in its folder.
pub struct Keeper {
    folder: PathBuf,
    spec: CheckpointSpec,
    identity: Identity,
    outputs: Outputs,
    began: Instant,
    cpu: Option<f64>,
    before: Spent,
    number: u64,
    last: Instant,
    last_step: u64,
    /// What the last one took.
    cost: Duration,
    /// The run was resumed, and its old trajectory is still there.
    resumed: bool,
    /// Records in the trajectory up to its last snapshot, and those after it.
    records: u64,
    tail: Vec<Record>,
}

/// State of the step loop at a checkpoint.
pub struct LoopPosition {
    /// Steps done.
    pub step: u64,
    /// State of the loop.
    pub driver: Vec<u8>,
    /// State of the engine.
    pub engine: Vec<u8>,
    /// Wall time in the engine since it was resumed.
    pub stepping: Duration,
    /// Wall time in observers since then.
    pub observing: Duration,
}

impl Keeper {
    /// For a run that writes into `folder`, or goes on `from` a checkpoint.
    pub fn new(
        folder: &Path,
        spec: CheckpointSpec,
        identity: Identity,
        outputs: Outputs,
        from: Option<&Checkpoint>,
    ) -> Self {
        let now = Instant::now();
        Self {
            folder: folder.into(),
            spec,
            identity,
            outputs,
            began: now,
            cpu: super::cost::cpu_time(),
            before: from.map_or_else(Spent::default, |from| from.spent),
            number: from.map_or(0, |from| from.number),
            last: now,
            last_step: from.map_or(0, |from| from.step),
            cost: Duration::ZERO,
            resumed: from.is_some(),
            records: 0,
            tail: Vec::new(),
        }
    }

    /// A record that the observers are told, other than a snapshot.
    pub fn told(&mut self, record: Record) {
        self.tail.push(record);
    }

    /// They are told a snapshot: with it everything before it is in the trajectory.
    pub fn snapshot(&mut self) {
        self.records += self.tail.len() as u64 + 1;
        self.tail.clear();
    }

    /// Whether it is time for a checkpoint; `broke` says that a bond broke in the step just done.
    pub fn due(&self, step: u64, broke: bool) -> bool {
        match self.spec {
            CheckpointSpec::None => false,
            CheckpointSpec::Steps(steps) => step - self.last_step >= steps,
            CheckpointSpec::WallTime(seconds) => step.is_multiple_of(LOOK) && self.since() >= seconds,
            CheckpointSpec::Auto => {
                let wait = LEAST.max(self.cost.as_secs_f64() / SHARE);
                // What just broke is not computed again if that costs little.
                let early = broke && self.since() >= self.cost.as_secs_f64() / SHARE;
                (step.is_multiple_of(LOOK) && self.since() >= wait) || (early && self.number > 0)
            }
        }
    }

    fn since(&self) -> f64 {
        self.last.elapsed().as_secs_f64()
    }

    /// Whether checkpoints are kept at all.
    pub fn keeps(&self) -> bool {
        self.spec != CheckpointSpec::None
    }

    /// Keeps one.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be written: the run cannot be relied on to survive, and its disk is full.
    pub fn keep(&mut self, now: LoopPosition) -> Result<()> {
        let begin = Instant::now();
        self.number += 1;
        let cpu = super::cost::cpu_time().zip(self.cpu).map_or(0.0, |(now, began)| now - began);
        let checkpoint = Checkpoint {
            number: self.number,
            identity: self.identity.clone(),
            outputs: self.outputs.clone(),
            records: self.records,
            tail: std::mem::take(&mut self.tail),
            driver: now.driver,
            engine: now.engine,
            step: now.step,
            spent: Spent {
                wall_s: self.before.wall_s + self.began.elapsed().as_secs_f64(),
                cpu_s: self.before.cpu_s + cpu,
                stepping: self.before.stepping + now.stepping,
                observing: self.before.observing + now.observing,
            },
        };
        // What the checkpoint refers to must be on the disk before it.
        let trajectory = partial::name(&self.folder.join(folder::TRAJECTORY));
        let synced = File::open(&trajectory).and_then(|file| file.sync_all());
        synced.map_err(|e| Error::io("cannot write", &trajectory, e))?;
        let path = self.folder.join(SLOTS[(self.number % 2) as usize]);
        write(&path, &checkpoint).map_err(|e| Error::io("cannot write", &path, e))?;
        self.tail = checkpoint.tail;
        if std::mem::take(&mut self.resumed) {
            // The new trajectory holds all of the old one now.
            folder::remove_if_there(&self.folder.join(folder::RESUMED_FROM))?;
        }
        (self.last, self.last_step, self.cost) = (Instant::now(), now.step, begin.elapsed());
        Ok(())
    }

    /// The run has come to its end: there is nothing left to go on with.
    ///
    /// # Errors
    /// [`Error::Io`] when a slot cannot be removed.
    pub fn clear(&self) -> Result<()> {
        folder::clear_checkpoints(&self.folder)
    }
}

fn write(path: &Path, checkpoint: &Checkpoint) -> std::io::Result<()> {
    let growing = partial::name(path);
    let mut writer = BufWriter::new(File::create(&growing)?);
    writer.write_all(&MAGIC)?;
    writer.write_all(&VERSION.to_le_bytes())?;
    let info = FrameInfo::new().block_checksums(true).content_checksum(true);
    let mut encoder = Refusing { writer: FrameEncoder::with_frame_info(info, writer), refused: None };
    let written = postcard::to_io(checkpoint, &mut encoder).map(|_| ()).map_err(std::io::Error::other);
    let Refusing { writer: encoder, refused } = encoder;
    refused.map_or(written, Err)?;
    let file =
        encoder.finish().map_err(std::io::Error::from)?.into_inner().map_err(std::io::IntoInnerError::into_error)?;
    file.sync_all()?;
    fs::rename(&growing, path)?;
    // The new name too must survive.
    match path.parent() {
        Some(folder) if cfg!(unix) => {
            File::open(if folder.as_os_str().is_empty() { Path::new(".") } else { folder })?.sync_all()
        }
        _ => Ok(()),
    }
}

/// Keeps why a writer has refused, which postcard does not pass on.
struct Refusing<W> {
    writer: W,
    refused: Option<std::io::Error>,
}

impl<W: Write> Refusing<W> {
    fn keep<T>(&mut self, result: std::io::Result<T>) -> std::io::Result<T> {
        result.map_err(|refused| {
            let kind = refused.kind();
            // An interrupted call is made again by whoever made it.
            if kind != std::io::ErrorKind::Interrupted {
                self.refused.get_or_insert(refused);
            }
            kind.into()
        })
    }
}

impl<W: Write> Write for Refusing<W> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let written = self.writer.write(bytes);
        self.keep(written)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        let flushed = self.writer.flush();
        self.keep(flushed)
    }
}

/// The latest checkpoint in a run's folder that is whole, and what is said of another that is not.
///
/// # Errors
/// [`Error::Input`] when there is none, or none that is whole.
pub fn latest(folder: &Path) -> Result<(Checkpoint, Vec<String>)> {
    let (mut found, mut damaged) = (None::<Checkpoint>, Vec::new());
    for path in SLOTS.map(|name| folder.join(name)) {
        match read(&path) {
            Ok(checkpoint) if found.as_ref().is_none_or(|other| other.number < checkpoint.number) => {
                found = Some(checkpoint);
            }
            Ok(_) => {}
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {}
            Err(e) => damaged.push(format!("{} is damaged ({e})", path.display())),
        }
    }
    match found {
        Some(checkpoint) => Ok((checkpoint, damaged)),
        None if damaged.is_empty() => Err(Error::input(
            format!("there is no checkpoint in {}", folder.display()),
            "a run that has come to its end has none, nor has one that was ended before its first; run the scene again",
        )),
        None => Err(Error::input(damaged.join(" and "), "run the scene again")),
    }
}

/// A checkpoint that does not fit what lies beside it.
pub(super) fn not_its(what: &str) -> Error {
    Error::input(format!("the run cannot be resumed from its checkpoint: {what}"), "run the scene again")
}

fn read(path: &Path) -> std::io::Result<Checkpoint> {
    let damaged = |what: String| std::io::Error::new(std::io::ErrorKind::InvalidData, what);
    let mut reader = BufReader::new(File::open(path)?);
    let mut head = [0; MAGIC.len() + 4];
    reader.read_exact(&mut head).map_err(|_| damaged("it is too short".into()))?;
    if head[..MAGIC.len()] != MAGIC {
        return Err(damaged("it is no checkpoint".into()));
    }
    let version = u32::from_le_bytes([head[12], head[13], head[14], head[15]]);
    if version != VERSION {
        return Err(damaged(format!("it has version {version}; this program reads version {VERSION}")));
    }
    let mut bytes = Vec::new();
    FrameDecoder::new(reader).read_to_end(&mut bytes).map_err(|e| damaged(e.to_string()))?;
    postcard::from_bytes(&bytes).map_err(|_| damaged("its bytes are no state of a run".into()))
}

impl Checkpoint {
    /// The trajectory in `folder` that tells all that had been told up to here: of the run that was ended, whole or not, or
    /// the one that an earlier attempt to go on has put aside. Whichever was being written when the power went, one does.
    ///
    /// # Errors
    /// [`Error::Input`] when none does.
    pub fn find_trajectory(&self, folder: &Path, info: &RunInfo) -> Result<PathBuf> {
        let whole = folder.join(folder::TRAJECTORY);
        let all = [partial::name(&whole), whole, folder.join(folder::RESUMED_FROM)];
        let mut known = "there is none".to_owned();
        for file in all.into_iter().filter(|file| file.exists()) {
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            known = match Trajectory::open(&file) {
                Ok(trajectory) if **trajectory.info() != *info => format!("{name} tells of other wires"),
                Ok(trajectory) => {
                    let records = trajectory.take(self.records as usize).take_while(|record| record.is_ok()).count();
                    if records as u64 == self.records {
                        return Ok(file);
                    }
                    format!("{name} has {records} records of {}", self.records)
                }
                Err(error) => error.to_string(),
            };
        }
        Err(not_its(&format!("no trajectory of the run is whole up to it ({known})")))
    }

    /// Refuses to go on as another run.
    ///
    /// # Errors
    /// [`Error::Input`] that names the difference.
    pub fn check(&self, wanted: &Identity) -> Result<()> {
        match wanted.difference(&self.identity) {
            None => Ok(()),
            Some(difference) => Err(Error::input(
                format!("the checkpoint is of another run: {difference}"),
                "undo the change, or run the scene again",
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::steps::DeviceChoice;

    fn checkpoint(number: u64) -> Checkpoint {
        Checkpoint {
            number,
            identity: Identity::new("name = \"a\"\nseed = 1\n".into()),
            outputs: Outputs { frames: false, recording: true, animation: None, device: DeviceChoice::Processor },
            records: 3,
            tail: Vec::new(),
            driver: vec![1; 1000],
            engine: (0..100_000_u32).map(|k| ((k * k) >> 7) as u8).collect(),
            step: 7,
            spent: Spent::default(),
        }
    }

    #[test]
    fn the_later_slot_is_taken_and_a_damaged_one_passed_over() {
        let run = tempfile::tempdir().unwrap();
        let at = |slot: usize| run.path().join(SLOTS[slot]);
        write(&at(0), &checkpoint(4)).unwrap();
        write(&at(1), &checkpoint(5)).unwrap();
        let (latest_whole, damaged) = latest(run.path()).unwrap();
        assert_eq!((latest_whole.number, latest_whole.engine, damaged.len()), (5, checkpoint(5).engine, 0));
        // Any byte: damage is seen by the checksums, a cut by the end of the frame.
        let whole = fs::read(at(1)).unwrap();
        for place in [3, 13, 20, whole.len() / 2, whole.len() - 1] {
            let mut bytes = whole.clone();
            bytes[place] ^= 1;
            fs::write(at(1), &bytes).unwrap();
            let (other, damaged) = latest(run.path()).unwrap();
            assert_eq!(other.number, 4, "byte {place}");
            assert!(damaged[0].contains(SLOTS[1]), "{damaged:?}");
        }
        for length in [0, 5, whole.len() / 3, whole.len() - 1] {
            fs::write(at(1), &whole[..length]).unwrap();
            assert_eq!(latest(run.path()).unwrap().0.number, 4, "cut at {length}");
        }
        fs::write(at(0), "").unwrap();
        assert!(latest(run.path()).unwrap_err().to_string().contains("damaged"));
        folder::clear_checkpoints(run.path()).unwrap();
        assert!(latest(run.path()).unwrap_err().to_string().contains("no checkpoint"));
    }

    #[test]
    fn another_run_is_refused_with_the_difference() {
        let kept = checkpoint(1);
        kept.check(&Identity::new("name = \"a\"\nseed = 1\n".into())).unwrap();
        let refused = |identity: Identity| kept.check(&identity).unwrap_err().to_string();
        let seed = refused(Identity::new("name = \"a\"\nseed = 2\n".into()));
        assert!(seed.contains("line 2") && seed.contains("seed = 1") && seed.contains("seed = 2"), "{seed}");
        let shorter = refused(Identity::new("name = \"a\"\n".into()));
        assert!(shorter.contains("longer"), "{shorter}");
        let revision = refused(Identity { revision: 0, ..kept.identity.clone() });
        assert!(revision.contains("revision"), "{revision}");
    }

    /// `/dev/full` accepts opening and refuses every byte, as a full disk does.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_told_as_the_system_tells_it() {
        let run = tempfile::tempdir().unwrap();
        let path = run.path().join(SLOTS[0]);
        std::os::unix::fs::symlink("/dev/full", partial::name(&path)).unwrap();
        let cause = write(&path, &checkpoint(1)).unwrap_err();
        assert_eq!(cause.kind(), std::io::ErrorKind::StorageFull, "{cause}");
        assert!(cause.to_string().contains("No space left"), "{cause}");
    }
}
