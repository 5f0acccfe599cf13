//! The progress bar on standard error.

use super::Observer;
use super::planned::PlannedEnd;
use crate::base::error::Result;
use crate::base::finding::Notice;
use crate::base::units::{mpa, percent};
use crate::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use crate::scene::spec::StopSpec;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::Arc;
use std::time::Instant;

/// Resolution of the bar.
const TICKS: u64 = 1000;

/// Shows strain, stress, wires broken, speed and time left. Draws nothing when standard error is no terminal.
pub struct Progress {
    stop: StopSpec,
    end: PlannedEnd,
    bar: ProgressBar,
    /// Instant and steps at the last row, for the speed.
    last: (Instant, u64),
    gripped: bool,
    wires: usize,
}

impl Progress {
    /// A bar for a run with these stop conditions.
    pub fn new(stop: &StopSpec) -> Self {
        let bar = ProgressBar::with_draw_target(Some(TICKS), ProgressDrawTarget::stderr());
        Self {
            stop: stop.clone(),
            end: PlannedEnd::default(),
            bar,
            last: (Instant::now(), 0),
            gripped: false,
            wires: 0,
        }
    }
}

/// Passes everything on to another observer, with a bar that counts the snapshots.
pub struct Counted<'a> {
    inner: &'a mut dyn Observer,
    bar: ProgressBar,
}

impl<'a> Counted<'a> {
    /// `count` snapshots are to come. Draws nothing when standard error is no terminal or `shown` is not set.
    pub fn new(inner: &'a mut dyn Observer, count: usize, shown: bool) -> Self {
        let target = if shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(count as u64), target);
        let style = ProgressStyle::with_template("drawing [{bar:24}] {pos} of {len}, {eta} left");
        bar.set_style(style.expect("the template is constant and right"));
        Self { inner, bar }
    }
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
        let finished = self.inner.finish();
        self.bar.finish_and_clear();
        finished
    }
}

fn message(sample: &Sample, gripped: bool, wires: usize, steps_per_second: f64) -> String {
    let state = if gripped {
        format!("strain {:.2} %, {:.1} MPa, ", percent(sample.strain), mpa(sample.stress))
    } else {
        format!("t = {:.3e} s, ", sample.time)
    };
    let broken = match wires {
        0 => String::new(),
        _ => format!("{} of {wires} wires broken, ", sample.wires_broken),
    };
    format!("{state}{broken}{steps_per_second:.0} steps/s")
}

impl Observer for Progress {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        self.end = PlannedEnd::new(&self.stop, info.strain_end);
        let style = ProgressStyle::with_template("{prefix} [{bar:24}] {percent:>3} %  {msg}, {eta} left")
            .expect("the template is constant and right");
        self.bar.set_style(style);
        self.bar.set_prefix(info.name.clone());
        self.bar.reset();
        self.last = (Instant::now(), 0);
        self.gripped = info.gauge.is_some();
        self.wires = info.wires.len();
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        let seconds = self.last.0.elapsed().as_secs_f64();
        let steps = sample.step.saturating_sub(self.last.1);
        if steps > 0 && seconds > 0.0 {
            self.last = (Instant::now(), sample.step);
        }
        let speed = if seconds > 0.0 { steps as f64 / seconds } else { 0.0 };
        let done = self.end.fraction(sample.strain, sample.time, sample.step).min(1.0);
        self.bar.set_position((done * TICKS as f64) as u64);
        self.bar.set_message(message(sample, self.gripped, self.wires, speed));
        Ok(())
    }

    fn notice(&mut self, notice: &Notice) -> Result<()> {
        // At once for whoever watches; the report repeats it at its head.
        self.bar.println(format!("WARNING: {notice}"));
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        self.bar.finish_and_clear();
        Ok(())
    }
}
