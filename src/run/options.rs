//! What a run is asked for.

use super::steps::DeviceChoice;
use crate::observe::animation::Animation;
use crate::observe::summary::OutputFiles;
use serde::{Deserialize, Serialize};
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
    /// Threads of the engine; `None`: as many as make it faster, up to one per core.
    pub threads: Option<usize>,
    /// What it is computed on.
    pub device: DeviceChoice,
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
            device: DeviceChoice::default(),
            frames: false,
            animation,
            recording: false,
            live,
        }
    }

    /// What a checkpoint must know of them.
    pub(super) fn outputs(&self) -> Outputs {
        let animation = self.animation.as_ref().map(|animation| (self.within(animation), animation.width));
        let device = self.device.clone();
        Outputs { frames: self.frames, recording: self.recording, animation, device }
    }

    /// What the summary says of them.
    pub(super) fn written(&self) -> OutputFiles {
        let animation = self.animation.as_ref().map(|animation| self.within(animation).to_string_lossy().into_owned());
        OutputFiles { frames: self.frames, recording: self.recording, animation }
    }

    /// The file of an animation: within the folder of the results, which may be moved, or from the root.
    fn within(&self, animation: &Animation) -> PathBuf {
        let whole = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.into());
        let file = whole(&animation.file);
        file.strip_prefix(whole(&self.out)).map_or(file.clone(), Path::to_owned)
    }

    /// Those of a run that goes on.
    pub(super) fn of_resumed(out: &Path, outputs: &Outputs, threads: Option<usize>) -> Self {
        let Outputs { frames, recording, animation, device } = outputs.clone();
        let animation = animation.map(|(file, width)| Animation { file: out.join(file), width });
        let (overwrite, wait, live) = (true, false, None);
        Self { out: out.into(), overwrite, wait, threads, device, frames, animation, recording, live }
    }
}

/// What a run writes besides its tables, and what it is computed on: how it goes on after an interruption.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Outputs {
    /// Frames.
    pub frames: bool,
    /// A recording.
    pub recording: bool,
    /// File of an animation, within the folder of the results or from the root, and its width (px).
    pub animation: Option<(PathBuf, Option<u32>)>,
    /// What it is computed on.
    pub device: DeviceChoice,
}
