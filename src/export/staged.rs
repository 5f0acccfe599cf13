//! Files that get their names when all of them are whole.

use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::run::exported::Format;
use crate::run::lock::Lock;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A locked folder, and one in it where files grow. Dropped before it is completed, nothing is left of them.
pub struct Staged {
    out: PathBuf,
    // Dropped in this order: what grows is in the folder, and the folder can only go when no lock is in it.
    growing: TempDir,
    _lock: Lock,
    _empty: RemoveIfEmpty,
}

/// Removes a folder that was made for nothing.
struct RemoveIfEmpty(PathBuf);

impl Drop for RemoveIfEmpty {
    fn drop(&mut self) {
        // Fails where something is in it, which is right.
        let _ = fs::remove_dir(&self.0);
    }
}

impl Staged {
    /// Makes the folder where it is not there, and locks it.
    ///
    /// # Errors
    /// [`Error::Input`] when another process writes into it; [`Error::Io`].
    pub fn open(out: &Path) -> Result<Self> {
        regular::make_folder(out)?;
        let empty = RemoveIfEmpty(out.to_owned());
        let lock = Lock::take(out)?;
        let growing = tempfile::Builder::new().prefix(".strandsnap-").tempdir_in(out);
        let growing = growing.map_err(|e| Error::io("cannot write into the folder", out, e))?;
        Ok(Self { out: out.to_owned(), growing, _lock: lock, _empty: empty })
    }

    /// Where files grow.
    pub fn path(&self) -> &Path {
        self.growing.path()
    }

    /// An error in writing a file, told by the name that the file was to get: nobody has asked for the other.
    pub fn by_own_name(&self, error: Error) -> Error {
        match error {
            Error::Io { action, path, cause } => {
                let own = path.strip_prefix(self.path()).map(|name| self.out.join(name));
                Error::Io { action, path: own.unwrap_or(path), cause }
            }
            other => other,
        }
    }

    /// Removes what an earlier export in the same format wrote, and gives the files their names, that to be opened first
    /// last. Returns how many they are and their size (bytes).
    ///
    /// # Errors
    /// [`Error::Input`] where something else than a file has one of the names; [`Error::Io`].
    pub fn complete(self, format: Format) -> Result<(usize, u64)> {
        let list = |folder: &Path| -> Result<Vec<String>> {
            let refuse = |e| Error::io("cannot read the folder", folder, e);
            let entries = fs::read_dir(folder).map_err(refuse)?;
            let name = |entry: fs::DirEntry| entry.file_name().into_string().ok();
            let names = entries.filter_map(|entry| entry.map(name).transpose()).collect::<std::io::Result<_>>();
            names.map_err(refuse)
        };
        let mut new = list(self.path())?;
        debug_assert!(new.iter().all(|name| format.writes(name)), "{new:?}");
        let old: Vec<PathBuf> =
            list(&self.out)?.iter().filter(|name| format.writes(name)).map(|name| self.out.join(name)).collect();
        old.iter().try_for_each(|file| regular::replaceable(file))?;
        for file in old {
            fs::remove_file(&file).map_err(|e| Error::io("cannot remove", &file, e))?;
        }
        new.sort_by_key(|name| (name == format.first_file(), name.clone()));
        let mut bytes = 0;
        for name in &new {
            let (from, to) = (self.path().join(name), self.out.join(name));
            bytes += fs::metadata(&from).map_err(|e| Error::io("cannot read", &from, e))?.len();
            fs::rename(&from, &to).map_err(|e| Error::io("cannot write", &to, e))?;
        }
        Ok((new.len(), bytes))
    }
}
