//! What a run is asked for.

use crate::observe::animation::Animation;
use std::path::{Path, PathBuf};

/// Where a run goes and what it writes.
#[derive(Debug, Clone, PartialEq)]
pub struct RunOptions {
    /// Folder of the results.
    pub out: PathBuf,
    /// Replace earlier results in that folder.
    pub overwrite: bool,
    /// Wait until no other process writes into that folder, instead of refusing.
    pub wait: bool,
    /// Threads of the engine; `None`: as many as the machine has.
    pub threads: Option<usize>,
    /// Draw numbered pictures into `frames/`.
    pub frames: bool,
    /// Make an animation of them.
    pub animation: Option<Animation>,
    /// Write `recording.rrd`.
    pub recording: bool,
    /// Address of a Rerun viewer to stream to while running.
    pub live: Option<String>,
}

impl RunOptions {
    /// Tables alone, into a folder that does not exist.
    pub fn tables(out: &Path) -> Self {
        let (threads, animation, live) = (None, None, None);
        Self {
            out: out.into(),
            overwrite: false,
            wait: false,
            threads,
            frames: false,
            animation,
            recording: false,
            live,
        }
    }
}
