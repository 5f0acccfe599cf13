//! The progress bar on standard error.

use crate::base::error::Result;
use crate::base::finding::{FindingKind, Notice};
use crate::base::units::{mpa, percent};
use crate::base::wording::counted;
use crate::engine::view::{RunInfo, Sample};
use crate::observe::Observer;
use crate::observe::peaks::Peaks;
use crate::observe::planned::PlannedEnd;
use crate::scene::spec::StopSpec;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::collections::BTreeSet;
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
    told: BTreeSet<FindingKind>,
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
            told: BTreeSet::new(),
        }
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
        _ => format!("{} of {} broken, ", sample.wires_broken, counted(wires, "wire")),
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
        // At once for whoever watches; the report has it at its head, at its worst.
        if self.told.insert(notice.finding.kind()) {
            self.bar.println(format!("WARNING: {notice}"));
        }
        Ok(())
    }

    fn peaks(&mut self, _peaks: &Peaks) -> Result<()> {
        // The last thing that a run tells; what other observers have still to write may take a while.
        self.bar
            .set_style(ProgressStyle::with_template("{prefix}  {msg}").expect("the template is constant and right"));
        self.bar.set_message("simulated; writing results and drawing the last pictures");
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        self.bar.finish_and_clear();
        Ok(())
    }
}
