//! Which program this is, to the build.

use std::path::PathBuf;
use std::sync::OnceLock;

/// The file that this library is in, where that is not the program's.
static FILE: OnceLock<PathBuf> = OnceLock::new();

/// Tells that this library is not in the file of the program but in `file`, as that of an interpreter that has loaded it: the
/// interpreter stays the same when the library is built anew. The first file that is told holds.
pub fn is_in(file: PathBuf) {
    let _ = FILE.set(file);
}

/// Which build of the program this is, by length and time of its file: one revision may be built many times while it is
/// worked on.
pub fn build() -> String {
    build_id().unwrap_or_else(|| "unknown".into())
}

/// The same; `None` where the system does not tell.
pub fn build_id() -> Option<String> {
    let own = FILE.get().cloned().map_or_else(std::env::current_exe, Ok);
    let told = own.and_then(|path| path.metadata()).and_then(|file| {
        let since = file.modified()?.duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
        Ok(format!("{} bytes of {} s", file.len(), since.as_secs()))
    });
    told.ok()
}
