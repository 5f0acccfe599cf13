//! One process at a time writes into a folder. The system gives the lock back when its process ends, however it does.

use crate::base::error::{Error, Result};
use crate::base::regular;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Its file, while a process writes into the folder.
pub const LOCK: &str = ".strandsnap.lock";
/// How often to look whether another process has ended.
const POLL: Duration = Duration::from_millis(100);
/// Looks before a lock counts as held: who asks for its holder has it himself for an instant.
const LOOKS: usize = 4;

/// The right to write into a folder, given back when it is dropped.
#[derive(Debug)]
pub struct Lock {
    /// Open, and so locked.
    _file: File,
    /// `None` for one of several holders, who leave the file to the others.
    path: Option<PathBuf>,
}

impl Lock {
    /// Takes the lock of a folder that is there.
    ///
    /// # Errors
    /// [`Error::Input`] with the number of the process that has it; [`Error::Io`] when the file system refuses.
    pub fn take(folder: &Path) -> Result<Self> {
        let path = folder.join(LOCK);
        let mut file = lock(folder, &path, File::try_lock)?;
        let write = file.set_len(0).and_then(|()| write!(file, "{}", std::process::id()));
        write.map_err(|cause| Error::io("cannot write", &path, cause))?;
        Ok(Self { _file: file, path: Some(path) })
    }

    /// Takes a part of the lock: others may have parts too, and nobody all of it.
    ///
    /// # Errors
    /// As for [`Lock::take`].
    pub fn share(folder: &Path) -> Result<Self> {
        Ok(Self { _file: lock(folder, &folder.join(LOCK), File::try_lock_shared)?, path: None })
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        if let Some(path) = &self.path {
            // While it is still held: nobody else can have taken it. Left behind, it would say nothing wrong.
            let _ = std::fs::remove_file(path);
        }
    }
}

/// Number of the process that writes into `folder`, as far as it told; `None` when none does.
pub fn holder(folder: &Path) -> Option<String> {
    let mut file = regular::open(&folder.join(LOCK)).ok()?;
    match file.try_lock_shared() {
        Err(TryLockError::WouldBlock) => Some(told(&mut file)),
        _ => None,
    }
}

/// Waits until no process writes into `folder`, or `stop` is set.
pub fn wait(folder: &Path, stop: &AtomicBool) {
    while holder(folder).is_some() && !stop.load(Ordering::Relaxed) {
        std::thread::sleep(POLL);
    }
}

/// The same before writing into `folder`: what the process leaves there can only be replaced, and where it may not be
/// (`overwrite`), that is found out before the wait.
///
/// # Errors
/// [`Error::Input`] when a process writes into `folder` and `overwrite` is not set; [`Error::Interrupted`] when `stop` was.
pub fn wait_to_write(folder: &Path, overwrite: bool, stop: &AtomicBool) -> Result<()> {
    if let Some(by) = holder(folder).filter(|_| !overwrite) {
        return Err(Error::input(
            format!("process {by} writes into {}, and its results will be there when it has ended", folder.display()),
            "give --overwrite with --wait to replace them then, or another folder with --out",
        ));
    }
    wait(folder, stop);
    if holder(folder).is_some() { Err(Error::Interrupted) } else { Ok(()) }
}

/// The error for a folder that a process writes into.
pub fn held(folder: &Path, by: &str) -> Error {
    Error::input(
        format!("process {by} writes into {}", folder.display()),
        "wait for its end, with --wait where there is that option, or give another folder with --out",
    )
}

fn lock(folder: &Path, path: &Path, with: impl Fn(&File) -> std::result::Result<(), TryLockError>) -> Result<File> {
    let refuse = |cause| Error::io("cannot lock", path, cause);
    let mut looks = 0;
    loop {
        regular::replaceable(path)?;
        let mut options = OpenOptions::new();
        let mut file = options.read(true).write(true).create(true).truncate(false).open(path).map_err(refuse)?;
        match with(&file) {
            // Its holder may have removed the file between the two calls: then others would lock a new one.
            Ok(()) if is_at(&file, path) => return Ok(file),
            Ok(()) => {}
            Err(TryLockError::WouldBlock) if looks + 1 < LOOKS => {
                looks += 1;
                std::thread::sleep(POLL / LOOKS as u32);
            }
            Err(TryLockError::WouldBlock) => return Err(held(folder, &told(&mut file))),
            Err(TryLockError::Error(cause)) => return Err(refuse(cause)),
        }
    }
}

fn told(file: &mut File) -> String {
    let mut number = String::new();
    match file.read_to_string(&mut number) {
        Ok(_) if !number.is_empty() => number,
        _ => "of an unknown number".into(),
    }
}

#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let id = |m: std::io::Result<std::fs::Metadata>| m.map(|m| (m.dev(), m.ino())).ok();
    id(file.metadata()) == id(std::fs::metadata(path))
}

/// An open file cannot be removed here.
#[cfg(not(unix))]
fn is_at(_file: &File, _path: &Path) -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_has_it_and_the_other_is_told_who() {
        let folder = tempfile::tempdir().unwrap();
        let own = std::process::id().to_string();
        let lock = Lock::take(folder.path()).unwrap();
        assert_eq!(holder(folder.path()), Some(own.clone()));
        for refused in [Lock::take(folder.path()), Lock::share(folder.path())] {
            let error = refused.unwrap_err();
            assert_eq!(error.exit_code(), 2);
            assert!(error.to_string().contains(&format!("process {own} ")), "{error}");
        }
        drop(lock);
        assert_eq!(holder(folder.path()), None);
        assert!(!folder.path().join(LOCK).exists());
        let shared = [Lock::share(folder.path()).unwrap(), Lock::share(folder.path()).unwrap()];
        assert!(Lock::take(folder.path()).is_err());
        drop(shared);
        assert!(Lock::take(folder.path()).is_ok());
    }

    /// What a killed process leaves is its file, which nobody has locked.
    #[test]
    fn a_lock_of_the_dead_is_none() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(LOCK), "4194304").unwrap();
        assert_eq!(holder(folder.path()), None);
        assert!(Lock::take(folder.path()).is_ok());
    }

    #[test]
    fn who_waits_gets_it() {
        let folder = tempfile::tempdir().unwrap();
        let lock = Lock::take(folder.path()).unwrap();
        let ended = std::thread::spawn(move || {
            std::thread::sleep(3 * POLL);
            drop(lock);
        });
        wait(folder.path(), &AtomicBool::new(false));
        assert!(Lock::take(folder.path()).is_ok());
        ended.join().unwrap();
        let _lock = Lock::take(folder.path()).unwrap();
        wait(folder.path(), &AtomicBool::new(true));
    }
}
