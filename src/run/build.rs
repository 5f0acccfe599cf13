//! Which program this is, to the build.

/// Which build of the program this is, by length and time of its file: one revision may be built many times while it is
/// worked on.
pub fn build() -> String {
    build_id().unwrap_or_else(|| "unknown".into())
}

/// The same; `None` where the system does not tell.
pub fn build_id() -> Option<String> {
    let told = std::env::current_exe().and_then(|path| path.metadata()).and_then(|file| {
        let since = file.modified()?.duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
        Ok(format!("{} bytes of {} s", file.len(), since.as_secs()))
    });
    told.ok()
}
