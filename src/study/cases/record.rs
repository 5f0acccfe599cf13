//! One run of a study, and the record that is kept of it in a folder named by the hash of its scene: a study that was
//! interrupted goes on where it stopped.

use super::measured::{Measured, Watcher};
use crate::base::error::{Error, Result};
use crate::engine::REVISION;
use crate::observe::files::write_whole;
use crate::run::folder::SCENE;
use crate::run::{RunOptions, cost, outputs, run_watched, summarise};
use crate::scene::spec::{PathSpec, Spec};
use crate::scene::{Scene, write};
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Folder of the cases within that of the study.
const CASES: &str = "cases";
/// The record, in the folder of its case.
const RECORD: &str = "case.json";

/// What decides what a run gives: two runs that agree in this are the same run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Revision of the physics: an engine that computes something else is not served an old answer.
    pub physics: u32,
    /// Threads of the engine where the cost of a run is what is studied; `None` where only its answer is, which has the
    /// same bits on any number.
    pub threads: Option<usize>,
    /// Whether the run was written to disk.
    pub writes: bool,
    /// The resolved scene, points of centreline files included.
    pub scene: String,
}

impl Identity {
    /// Of a run of `spec`.
    pub fn of(spec: &Spec, threads: Option<usize>, writes: bool) -> Self {
        let mut scene = write::to_toml(spec);
        for wire in &spec.wires {
            if let PathSpec::File { points, .. } = &wire.path {
                let _ = writeln!(scene, "# {points:?}");
            }
        }
        Self { physics: REVISION, threads, writes, scene }
    }

    /// Name of its folder: FNV-1a over all of it. The record holds the whole identity, so that a clash of names is seen.
    pub fn name(&self) -> String {
        let text = format!("{} {:?} {} {}", self.physics, self.threads, self.writes, self.scene);
        let fnv = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3);
        let hash = text.bytes().fold(0xCBF2_9CE4_8422_2325, fnv);
        format!("{hash:016x}")
    }

    /// Its folder within that of the study.
    pub fn folder(&self, study: &Path) -> PathBuf {
        study.join(CASES).join(self.name())
    }
}

/// What became of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Found {
    /// It ran to its end.
    Ran(Box<Measured>),
    /// The scene, the engine or the guard refused it: why.
    Failed(String),
}

/// A run that is over.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Which run.
    pub identity: Identity,
    /// Which build made it: length and time of the program's file.
    pub build: String,
    /// What it gave.
    pub found: Found,
}

impl Record {
    /// The record of a run, if one is kept in the study's folder. One that is damaged, or of another run, is none.
    pub fn kept(identity: &Identity, folder: &Path) -> Option<Self> {
        let text = std::fs::read_to_string(identity.folder(folder).join(RECORD)).ok()?;
        let record: Self = serde_json::from_str(&text).ok()?;
        (record.identity == *identity).then_some(record)
    }

    /// Writes the record beside its scene, and gives it as it will be read: a study that goes on must write the same
    /// numbers as one that was never interrupted, and reading may change the last bit.
    ///
    /// # Errors
    /// When the folder cannot be written.
    fn keep(self, folder: &Path) -> Result<Self> {
        let folder = self.identity.folder(folder);
        std::fs::create_dir_all(&folder).map_err(|e| Error::io("cannot make the folder", &folder, e))?;
        write_whole(&folder.join(SCENE), &self.identity.scene)?;
        let path = folder.join(RECORD);
        let text = serde_json::to_string(&self).expect("a record holds nothing that JSON lacks");
        write_whole(&path, &text)?;
        serde_json::from_str(&text).map_err(|e| Error::io("cannot read back", &path, std::io::Error::other(e)))
    }
}

/// Makes the folder of the cases; `fresh` removes the records that are there.
///
/// # Errors
/// When the folder cannot be made or a record cannot be removed.
pub fn open(folder: &Path, fresh: bool) -> Result<()> {
    let cases = folder.join(CASES);
    std::fs::create_dir_all(&cases).map_err(|e| Error::io("cannot make the folder", &cases, e))?;
    if !fresh {
        return Ok(());
    }
    let entries = std::fs::read_dir(&cases).map_err(|e| Error::io("cannot read the folder", &cases, e))?;
    for path in entries.flatten().map(|entry| entry.path().join(RECORD)).filter(|path| path.is_file()) {
        std::fs::remove_file(&path).map_err(|e| Error::io("cannot remove", &path, e))?;
    }
    Ok(())
}

/// Which build this is: one revision may be built many times while it is worked on.
pub fn build() -> String {
    let told = std::env::current_exe().and_then(|path| path.metadata()).and_then(|file| {
        let since = file.modified()?.duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
        Ok(format!("{} bytes of {} s", file.len(), since.as_secs()))
    });
    told.unwrap_or_else(|_| "unknown".into())
}

/// How processor time is told apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CpuClock {
    /// Of the whole program: one run at a time.
    Process,
    /// Of the calling thread: several runs side by side, each on one.
    Thread,
}

impl CpuClock {
    fn now(self) -> Option<f64> {
        match self {
            CpuClock::Process => cost::cpu_time(),
            CpuClock::Thread => cost::thread_cpu_time(),
        }
    }
}

/// Runs a case and keeps its record in `folder`. `None` when `stop` ended it early: that is no result. Call it inside
/// the pool that it is to use.
///
/// # Errors
/// What the machine refuses, the file system foremost. What the scene, the engine or the guard refuse is a result.
pub fn run(
    scene: &Scene,
    identity: &Identity,
    folder: &Path,
    clock: CpuClock,
    stop: &AtomicBool,
) -> Result<Option<Record>> {
    let found = match measure(scene, identity.writes, folder, clock, stop) {
        _ if stop.load(Ordering::Relaxed) => return Ok(None),
        Ok(Some(measured)) => Found::Ran(Box::new(measured)),
        Ok(None) => Found::Failed("the run has no strength: nothing pulled, or it ended before stress had fallen 20 % below its peak after a rupture".into()),
        Err(error @ (Error::Scene(_) | Error::Input { .. } | Error::Simulation(_))) => {
            Found::Failed(error.to_string())
        }
        Err(error) => return Err(error),
    };
    Record { identity: identity.clone(), build: build(), found }.keep(folder).map(Some)
}

fn measure(scene: &Scene, writes: bool, folder: &Path, clock: CpuClock, stop: &AtomicBool) -> Result<Option<Measured>> {
    let mut watcher = Watcher::default();
    let begin = clock.now();
    let summary = if writes {
        let out = tempfile::tempdir_in(folder).map_err(|e| Error::io("cannot write into", folder, e))?;
        run_watched(scene, &written(out.path()), vec![&mut watcher], stop)?
    } else {
        summarise(scene, vec![&mut watcher], stop)?
    };
    let cpu = clock.now().zip(begin).map(|(now, begin)| now - begin);
    Ok(Measured::new(summary, watcher, cpu))
}

/// Everything that `strandsnap run` writes but pictures, which cost what they cost whatever the engine does.
fn written(out: &Path) -> RunOptions {
    RunOptions {
        out: out.into(),
        overwrite: false,
        wait: false,
        threads: None,
        frames: false,
        animation: None,
        recording: outputs::HAS_RECORD,
        live: None,
        quiet: true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    fn identity(options: &[&str], threads: usize) -> Identity {
        let options: Vec<String> = options.iter().map(|text| text.to_string()).collect();
        Identity::of(&scene::load("single-wire", &options).unwrap().spec, Some(threads), false)
    }

    fn record(identity: &Identity) -> Record {
        Record { identity: identity.clone(), build: build(), found: Found::Failed("it would not".into()) }
    }

    #[test]
    fn a_record_is_found_by_what_was_run_and_by_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        open(folder.path(), false).unwrap();
        let one = identity(&[], 1);
        assert_eq!(Record::kept(&one, folder.path()), None);
        record(&one).keep(folder.path()).unwrap();
        assert_eq!(Record::kept(&one, folder.path()), Some(record(&one)));
        assert_eq!(std::fs::read_to_string(one.folder(folder.path()).join(SCENE)).unwrap(), one.scene);
        assert_eq!(Record::kept(&identity(&["seed=2"], 1), folder.path()), None);
        assert_eq!(Record::kept(&identity(&[], 2), folder.path()), None);
        let other_physics = Identity { physics: one.physics + 1, ..one.clone() };
        assert_eq!(Record::kept(&other_physics, folder.path()), None);
        open(folder.path(), true).unwrap();
        assert_eq!(Record::kept(&one, folder.path()), None);
    }

    #[test]
    fn half_a_record_is_none() {
        let folder = tempfile::tempdir().unwrap();
        open(folder.path(), false).unwrap();
        let one = identity(&[], 1);
        record(&one).keep(folder.path()).unwrap();
        let path = one.folder(folder.path()).join(RECORD);
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, &text[..text.len() / 2]).unwrap();
        assert_eq!(Record::kept(&one, folder.path()), None);
    }
}
