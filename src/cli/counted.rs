//! A bar that counts pictures.

use crate::base::error::Result;
use crate::base::finding::Notice;
use crate::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use crate::observe::Observer;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Passes everything on to another observer, with a bar that counts the snapshots.
pub struct Counted<'a> {
    inner: &'a mut dyn Observer,
    bar: ProgressBar,
}

impl<'a> Counted<'a> {
    /// `count` snapshots are to come. Draws nothing when standard error is no terminal or `shown` is not set.
    pub fn new(inner: &'a mut dyn Observer, count: usize, shown: bool) -> Self {
        Self { inner, bar: bar(count, shown) }
    }
}

/// A bar of so many pictures; nothing is drawn when standard error is no terminal or `shown` is not set.
pub fn bar(count: usize, shown: bool) -> ProgressBar {
    let target = if shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(Some(count as u64), target);
    let style = ProgressStyle::with_template("drawing [{bar:24}] {pos} of {len}, {eta} left");
    bar.set_style(style.expect("the template is constant and right"));
    bar
}

impl Observer for Counted<'_> {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        self.inner.start(info)
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.inner.sample(sample)
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        self.inner.snapshot(snapshot)?;
        self.bar.inc(1);
        Ok(())
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.inner.rupture(rupture)
    }

    fn notice(&mut self, notice: &Notice) -> Result<()> {
        self.inner.notice(notice)
    }

    fn finish(&mut self) -> Result<()> {
        self.finish_unless(&AtomicBool::new(false))
    }

    fn finish_unless(&mut self, stop: &AtomicBool) -> Result<()> {
        let finished = self.inner.finish_unless(stop);
        self.bar.finish_and_clear();
        finished
    }
}
