//! Pictures that a run had not drawn when it was stopped after its last step: they are drawn from its trajectory.

use super::folder::{OutFolder, SCENE, SUMMARY, TRAJECTORY, has_checkpoint, outputs_undrawn};
use super::lock::Lock;
use super::options::RunOptions;
use super::replay::{Replay, Selection};
use super::{RunSummary, identity, outputs};
use crate::base::error::{Error, Result};
use crate::base::finding::StopReason;
use crate::base::regular;
use crate::observe::Observer;
use crate::observe::origin::Origin;
use crate::observe::timings::Timings;
use crate::scene::Scene;
use std::path::Path;

/// A run that came to its end, but for its pictures.
pub struct Undrawn {
    /// What it writes, and where.
    pub options: RunOptions,
    scene: Scene,
    summary: RunSummary,
    folder: OutFolder,
    replay: Replay,
}

impl Undrawn {
    /// Looks at the folder of a run, and changes nothing there; `None` when its pictures are all drawn, none were asked for,
    /// or the run itself has not come to its end.
    ///
    /// # Errors
    /// [`Error::Input`] when files of the run were changed or are damaged; [`Error::Missing`] when nothing can be drawn here.
    pub fn find(run: &Path) -> Result<Option<Self>> {
        let whole = [SCENE, SUMMARY, TRAJECTORY].iter().all(|name| run.join(name).is_file());
        let Some(wanted) = outputs_undrawn(run).filter(|_| whole && !has_checkpoint(run)) else { return Ok(None) };
        let summary = run.join(SUMMARY);
        let text = regular::text(&summary, regular::LONGEST_TABLE)?;
        let summary: RunSummary = serde_json::from_str(&text).map_err(|e| {
            let what = format!("{} is damaged or of another version of strandsnap: {e}", summary.display());
            Error::input(what, "draw the pictures with `strandsnap render`")
        })?;
        // An error that is no failure of the simulation is a warning without a finding.
        if summary.stopped == StopReason::Interrupted || summary.warnings.len() > summary.findings.len() {
            return Ok(None);
        }
        identity::check(run, false)?;
        let options = RunOptions::of_resumed(run, &wanted, None);
        outputs::check(&options)?;
        Ok(Some(Self {
            options,
            scene: crate::scene::load(&run.join(SCENE).to_string_lossy(), &[])?,
            summary,
            folder: OutFolder::of_run(run)?,
            replay: Replay::open(run, &Selection::default())?,
        }))
    }

    /// Whether it is a run of `scene`.
    pub fn is_of(&self, scene: &Scene) -> bool {
        self.replay.origin() == Origin::of(&scene.spec)
    }

    /// Its scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Makes ready to draw what is missing.
    ///
    /// # Errors
    /// [`Error::Input`] when another process writes into the folder; [`Error::Missing`] when nothing can be drawn here.
    pub fn begin(self) -> Result<Drawing> {
        let Self { options, scene, summary, folder, replay } = self;
        let lock = folder.take_over()?;
        let (writer, frames) = outputs::frames(&options, &scene.spec, &folder, true)?;
        let animated = options.animation.is_some();
        Ok(Drawing { replay, writer, frames, animated, scene, summary, folder, _lock: lock })
    }
}

/// Pictures of a run that are being drawn: `replay` is to be shown to `writer`.
pub struct Drawing {
    /// The run.
    pub replay: Replay,
    /// What draws.
    pub writer: Box<dyn Observer>,
    frames: outputs::Frames,
    /// An animation is to be made of them.
    animated: bool,
    scene: Scene,
    summary: RunSummary,
    folder: OutFolder,
    _lock: Lock,
}

impl Drawing {
    /// Says in the run's summary what has become of the pictures, and gives it.
    ///
    /// # Errors
    /// [`Error::Io`] when a file cannot be written.
    pub fn end(self) -> Result<RunSummary> {
        let Self { replay, frames, animated, scene, mut summary, folder, .. } = self;
        let mut timings = frames.timings();
        let drawn = frames.kept() + timings.frames as usize;
        // Of those that were drawn again, the first time counts no more.
        if let Some(before) = summary.cost.frames.filter(|_| frames.kept() > 0) {
            timings.merge(&Timings { not_animated: false, ..before });
        }
        // Those that the writer was never told of, too.
        let left = replay.count().saturating_sub(drawn);
        let not_animated = timings.not_animated || (animated && left > 0);
        timings = Timings { not_drawn: left as u32, not_animated, ..timings.for_frames(drawn as u32) };
        summary.cost.frames = Some(timings);
        super::write_summary(&folder, &scene.spec, &summary)?;
        if !timings.unfinished() {
            frames.complete()?;
        }
        Ok(summary)
    }
}
