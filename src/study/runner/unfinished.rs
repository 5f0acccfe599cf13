//! Finished cases of a command that checks the program, kept until all of its cases are over: one that was killed or
//! interrupted goes on when it is started again, and one that has come to its end leaves nothing, so that the next checks
//! everything anew.

use super::store::{CaseStore, Identity};
use crate::base::error::{Error, Result};
use crate::run::build::build_id;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Name of the text that defines a case, beside its record.
const DEFINITION: &str = "case.txt";

/// The finished cases of a command that has not come to its end.
#[derive(Debug)]
pub struct Unfinished {
    folder: PathBuf,
    store: CaseStore,
    /// Which program runs: a case is code, its scene included. `None`, where the system does not tell, keeps nothing.
    build: Option<String>,
}

impl Unfinished {
    /// Those in the folder of the command's results; `fresh` removes what is there. Nothing is made before a case is kept.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be removed.
    pub fn open(results: &Path, command: &str, fresh: bool) -> Result<Self> {
        let folder = results.join(format!("unfinished-{command}"));
        if fresh {
            remove(&folder)?;
        }
        Ok(Self { store: CaseStore::within(&folder), folder, build: build_id() })
    }

    /// What decides the result of a case of this program; `case` names it and how thoroughly it is run.
    fn identity(&self, case: &str) -> Option<Identity> {
        let build = self.build.as_ref()?;
        let (version, machine) = (env!("CARGO_PKG_VERSION"), std::env::consts::ARCH);
        Some(Identity::new(format!("{case}, version {version}, {machine}, build {build}"), Some(1), false))
    }

    /// The result of a case that was finished before, by this program and no other.
    pub fn find<T: DeserializeOwned>(&self, case: &str) -> Option<T> {
        self.store.find(&self.identity(case)?).map(|record| record.result)
    }

    /// Keeps a result, where it can be read back as it is: numbers that are not finite cannot.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be written.
    pub fn keep<T: Serialize + DeserializeOwned + PartialEq>(&self, case: &str, result: T) -> Result<()> {
        let read_back = serde_json::to_string(&result).ok().and_then(|text| serde_json::from_str::<T>(&text).ok());
        match self.identity(case).filter(|_| read_back.as_ref() == Some(&result)) {
            Some(identity) => self.store.keep(&identity, DEFINITION, result).map(|_| ()),
            None => Ok(()),
        }
    }

    /// The store of the records.
    pub fn store(&self) -> &CaseStore {
        &self.store
    }

    /// All cases are over: nothing is left to go on with.
    ///
    /// # Errors
    /// [`Error::Io`] when a record cannot be removed.
    pub fn complete(self) -> Result<()> {
        remove(&self.folder)
    }
}

fn remove(folder: &Path) -> Result<()> {
    match std::fs::remove_dir_all(folder) {
        Err(cause) if cause.kind() != ErrorKind::NotFound => Err(Error::io("cannot remove", folder, cause)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_is_found_by_the_same_program_until_all_are_over() {
        let results = tempfile::tempdir().unwrap();
        let open = |fresh| Unfinished::open(results.path(), "verify", fresh).unwrap();
        let unfinished = open(false);
        assert_eq!(std::fs::read_dir(results.path()).unwrap().count(), 0, "nothing is made before it is needed");
        unfinished.keep("hertz, Full", 0.1_f64 + 0.2).unwrap();
        unfinished.keep("no number, Full", f64::NAN).unwrap();
        let again = open(false);
        assert_eq!(again.find("hertz, Full"), Some(0.1_f64 + 0.2));
        assert_eq!(again.find::<f64>("hertz, Quick"), None);
        assert_eq!(again.find::<f64>("no number, Full"), None);
        // Another build is another program.
        let other = Unfinished { build: Some("another".into()), ..open(false) };
        assert_eq!(other.find::<f64>("hertz, Full"), None);
        let unknown = Unfinished { build: None, ..open(false) };
        unknown.keep("thornton, Full", 1.0).unwrap();
        assert_eq!((unknown.find::<f64>("hertz, Full"), unknown.find::<f64>("thornton, Full")), (None, None));
        assert_eq!(again.store().damaged(), []);
        assert_eq!(open(true).find::<f64>("hertz, Full"), None);
        again.keep("hertz, Full", 1.0).unwrap();
        again.complete().unwrap();
        assert_eq!(std::fs::read_dir(results.path()).unwrap().count(), 0);
    }
}
