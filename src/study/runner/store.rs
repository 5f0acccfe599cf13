//! Finished cases, each kept in a folder named by the hash of its identity: a study that was interrupted goes on where it
//! stopped.

use crate::base::digest::Digest;
use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::engine::REVISION;
use crate::observe::files::write_whole;
use crate::run::DeviceChoice;
use crate::run::build::build;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Folder of the cases within that of the study.
const CASES: &str = "cases";
/// The record, in the folder of its case.
const RECORD: &str = "case.json";
/// Where the run of a case lies until it is over, in the folder of its case.
const UNFINISHED: &str = "unfinished";

/// What stands before the digest at the end of a record.
const DIGEST: &str = ",\"digest\":\"";

/// What decides the result of a case: two cases that agree in this are the same.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Revision of the engine ([`REVISION`]): one that computes something else is not served an old result.
    revision: u32,
    /// Threads of the engine where the cost of a case is what is studied; `None` where only its answer is, which has the
    /// same bits on any number.
    threads: Option<usize>,
    /// Whether the run was written to disk.
    writes: bool,
    /// What it was computed on, if not on the processor: devices differ by rounding.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    device: Option<String>,
    /// The resolved scene, points of centreline files included; or the name of a case that is code, with its build.
    definition: String,
}

impl Identity {
    /// The identity of what `definition` defines.
    pub fn new(definition: String, threads: Option<usize>, writes: bool) -> Self {
        Self { revision: REVISION, threads, writes, device: None, definition }
    }

    /// The same, computed on `device`.
    pub fn on(self, device: &DeviceChoice) -> Self {
        let device = (*device != DeviceChoice::Processor).then(|| device.to_string());
        Self { device, ..self }
    }

    /// Path of its folder in that of all cases: FNV-1a over all of it, its first two digits a folder for themselves, so that
    /// none holds ten thousand. The record holds the whole identity, so that a clash of names is seen.
    pub fn name(&self) -> String {
        let mut text = format!("{} {:?} {} {}", self.revision, self.threads, self.writes, self.definition);
        self.device.iter().for_each(|device| text += device);
        let fnv = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3);
        let hash = text.bytes().fold(0xCBF2_9CE4_8422_2325, fnv);
        let name = format!("{hash:016x}");
        format!("{}/{}", &name[..2], &name[2..])
    }
}

/// The result of a case that is over.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record<T> {
    /// Which case.
    pub identity: Identity,
    /// Which build ran it, see [`build()`].
    pub build: String,
    /// Its result.
    pub result: T,
}

/// The finished cases of a study.
#[derive(Debug, Clone)]
pub struct CaseStore {
    folder: PathBuf,
    /// What its cases are computed on.
    device: DeviceChoice,
    /// Records that were found and cannot be used, and why.
    damaged: Arc<Mutex<BTreeMap<PathBuf, String>>>,
}

impl CaseStore {
    /// Those in the folder of a study, which need not exist.
    pub fn of(study: &Path) -> Self {
        Self::within(&study.join(CASES))
    }

    /// Those in a folder of their own, which need not exist.
    pub(super) fn within(folder: &Path) -> Self {
        Self { folder: folder.into(), device: DeviceChoice::Processor, damaged: Arc::default() }
    }

    /// The same, ready to take more; `fresh` removes the records and unfinished runs that are there.
    ///
    /// # Errors
    /// When the folder cannot be made or a record cannot be removed.
    pub fn open(study: &Path, fresh: bool) -> Result<Self> {
        let store = Self::of(study);
        let cases = &store.folder;
        regular::make_folder(cases)?;
        if fresh {
            let within = |folder: &Path| -> Result<Vec<PathBuf>> {
                let entries = std::fs::read_dir(folder).map_err(|e| Error::io("cannot read the folder", folder, e))?;
                Ok(entries.flatten().map(|entry| entry.path()).filter(|path| path.is_dir()).collect())
            };
            for case in within(cases)?.iter().map(|some| within(some)).collect::<Result<Vec<_>>>()?.concat() {
                let record = case.join(RECORD);
                if record.is_file() {
                    std::fs::remove_file(&record).map_err(|e| Error::io("cannot remove", &record, e))?;
                }
                store.drop_unfinished(&case.join(UNFINISHED))?;
            }
        }
        Ok(store)
    }

    /// The same store, of cases that are computed on `device`.
    pub fn on(self, device: &DeviceChoice) -> Self {
        Self { device: device.clone(), ..self }
    }

    /// What its cases are computed on.
    pub fn device(&self) -> &DeviceChoice {
        &self.device
    }

    /// The folder of all cases.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Where the run of a case lies until it is over, so that one that is ended early goes on from its last checkpoint.
    pub fn unfinished(&self, identity: &Identity) -> PathBuf {
        self.folder.join(identity.name()).join(UNFINISHED)
    }

    /// Removes such a run, if there is one.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn drop_unfinished(&self, run: &Path) -> Result<()> {
        match std::fs::remove_dir_all(run) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(Error::io("cannot remove", run, error)),
            _ => Ok(()),
        }
    }

    /// The record of a case, if one is kept. One that is damaged, or of another case, is none, and among
    /// [`CaseStore::damaged`].
    pub fn find<T: DeserializeOwned>(&self, identity: &Identity) -> Option<Record<T>> {
        let file = self.folder.join(identity.name()).join(RECORD);
        let why = match regular::text_if_there(&file, regular::LONGEST_TABLE) {
            Ok(None) => return None,
            Ok(Some(text)) => match unsealed(&text).map(|record| serde_json::from_str::<Record<T>>(&record)) {
                Some(Ok(record)) if record.identity == *identity => return Some(record),
                Some(Ok(_)) => "it is of another case".into(),
                Some(Err(error)) => error.to_string(),
                None => "it was changed since it was written, or cut off".into(),
            },
            Err(error) => error.to_string(),
        };
        self.damaged.lock().unwrap_or_else(PoisonError::into_inner).insert(file, why);
        None
    }

    /// The records that were looked for, were there and could not be used, each with what is wrong with it: their cases
    /// have to be run again.
    pub fn damaged(&self) -> Vec<(PathBuf, String)> {
        let damaged = self.damaged.lock().unwrap_or_else(PoisonError::into_inner);
        damaged.iter().map(|(file, why)| (file.clone(), why.clone())).collect()
    }

    /// Keeps a result, with the text that defines its case beside it under the name `file`. Gives the record as it will be
    /// read: a study that goes on must write the same numbers as one that was never interrupted, and reading may change
    /// the last bit.
    ///
    /// # Errors
    /// When the folder cannot be written.
    pub fn keep<T: Serialize + DeserializeOwned>(
        &self,
        identity: &Identity,
        file: &str,
        result: T,
    ) -> Result<Record<T>> {
        let folder = self.folder.join(identity.name());
        regular::make_folder(&folder)?;
        write_whole(&folder.join(file), &identity.definition)?;
        let path = folder.join(RECORD);
        let record = Record { identity: identity.clone(), build: build(), result };
        let text = serde_json::to_string(&record).expect("a record holds nothing that JSON lacks");
        write_whole(&path, &sealed(&text))?;
        serde_json::from_str(&text).map_err(|e| Error::io("cannot read back", &path, std::io::Error::other(e)))
    }
}

/// A record's JSON object with its digest, so that an edited number is seen.
fn sealed(record: &str) -> String {
    format!("{}{DIGEST}{}\"}}", record.strip_suffix('}').unwrap_or(record), Digest::of(record))
}

/// The record without its digest; `None` unless that is the record's.
fn unsealed(text: &str) -> Option<String> {
    let (record, digest) = text.rsplit_once(DIGEST)?;
    let record = format!("{record}}}");
    (digest.strip_suffix("\"}")?.parse() == Ok(Digest::of(&record))).then_some(record)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn identity(definition: &str, threads: usize) -> Identity {
        Identity::new(definition.into(), Some(threads), false)
    }

    fn found(store: &CaseStore, identity: &Identity) -> Option<f64> {
        store.find(identity).map(|record| record.result)
    }

    #[test]
    fn a_record_is_found_by_what_was_run_and_by_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let store = CaseStore::open(folder.path(), false).unwrap();
        let one = identity("a scene", 1);
        assert_eq!(found(&store, &one), None);
        store.keep(&one, "scene.toml", 1.5).unwrap();
        assert_eq!(found(&store, &one), Some(1.5));
        let text = std::fs::read_to_string(store.folder().join(one.name()).join("scene.toml")).unwrap();
        assert_eq!(text, "a scene");
        let later = Identity { revision: one.revision + 1, ..one.clone() };
        for other in [identity("another", 1), identity("a scene", 2), later] {
            assert_eq!(found(&store, &other), None);
        }
        let cleared = CaseStore::open(folder.path(), true).unwrap();
        assert_eq!(found(&cleared, &one), None);
    }

    /// A store with the result 1.5 of one case: its folder, itself, the case, and the file of the record.
    fn kept() -> (tempfile::TempDir, CaseStore, Identity, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let store = CaseStore::open(folder.path(), false).unwrap();
        let one = identity("a scene", 1);
        store.keep(&one, "scene.toml", 1.5).unwrap();
        let path = store.folder().join(one.name()).join(RECORD);
        (folder, store, one, path)
    }

    #[test]
    fn half_a_record_is_none() {
        let (_folder, store, one, path) = kept();
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(store.damaged(), []);
        std::fs::write(&path, &text[..text.len() / 2]).unwrap();
        assert_eq!(found(&store, &one), None);
        assert_eq!(found(&store, &identity("never run", 1)), None);
        let damaged = store.damaged();
        assert!(matches!(&damaged[..], [(file, why)] if *file == path && why.contains("cut off")), "{damaged:?}");
    }

    #[test]
    fn a_record_with_another_number_is_none() {
        let (_folder, store, one, path) = kept();
        let text = std::fs::read_to_string(&path).unwrap();
        for changed in
            [text.replace("1.5", "1.6"), text.replace("\"build\":", "\"building\":"), text.replace(DIGEST, ",\"a\":\"")]
        {
            std::fs::write(&path, changed).unwrap();
            assert_eq!(found(&store, &one), None);
        }
        std::fs::write(&path, &text).unwrap();
        assert_eq!(found(&store, &one), Some(1.5));
    }
}
