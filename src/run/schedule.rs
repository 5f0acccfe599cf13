//! When to take a row of the curve and when a snapshot.

use crate::scene::spec::OutputSpec;

/// Spreads rows and snapshots evenly over the planned run, denser after the first rupture.
///
/// Time is the fraction of the planned run that is done [-]
/// ([`crate::observe::planned::PlannedEnd::fraction`]). The first and the last state are not its business:
/// they are always taken.
#[derive(Debug, Clone)]
pub struct Schedule {
    rows: Ticks,
    snapshots: Ticks,
    density: f64,
    ruptured: bool,
    /// A rupture waits for its snapshot.
    waiting: bool,
    /// Snapshots that ruptures may still ask for. As many as planned ones: a run that breaks all its wires
    /// one by one must not fill the disk.
    left: usize,
    last_snapshot: f64,
}

/// What is due now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Due {
    /// A row of the curve.
    pub row: bool,
    /// A snapshot, which carries its row.
    pub snapshot: bool,
}

/// Evenly spaced fractions.
#[derive(Debug, Clone, Copy)]
struct Ticks {
    /// How many there are per planned run [-].
    rate: f64,
    /// How many have passed.
    passed: f64,
}

impl Ticks {
    fn new(count: usize) -> Self {
        Self { rate: count as f64, passed: 0.0 }
    }

    /// Ticks up to `now`. The grain of salt keeps rounding from putting 0.58 · 100 below 58.
    fn until(&self, now: f64) -> f64 {
        now.mul_add(self.rate, 1e-9).floor()
    }

    fn due(&mut self, now: f64) -> bool {
        let passed = self.until(now);
        let due = passed > self.passed;
        // Strain may run backwards for a few steps after a rupture; its ticks do not come twice.
        self.passed = self.passed.max(passed);
        due
    }

    fn densify(&mut self, density: f64, now: f64) {
        self.rate *= density;
        self.passed = self.until(now);
    }
}

impl Schedule {
    /// The schedule that a scene asks for.
    pub fn new(output: &OutputSpec) -> Self {
        Self {
            rows: Ticks::new(output.samples),
            snapshots: Ticks::new(output.snapshots),
            density: output.rupture_density.max(1.0),
            ruptured: false,
            waiting: false,
            left: output.snapshots,
            last_snapshot: 0.0,
        }
    }

    /// One bond or more broke in the step just done.
    pub fn rupture(&mut self, now: f64) {
        if !self.ruptured {
            self.ruptured = true;
            self.rows.densify(self.density, now);
            self.snapshots.densify(self.density, now);
        }
        self.waiting = self.left > 0;
    }

    /// What is due at this fraction of the run [-]; asked once after every step.
    pub fn due(&mut self, now: f64) -> Due {
        let planned = self.snapshots.due(now);
        // Ruptures that follow each other within a quarter of the spacing are one batch with one snapshot.
        let batch = self.waiting && (now - self.last_snapshot) * self.snapshots.rate >= 0.25;
        let snapshot = planned || batch;
        if snapshot {
            self.last_snapshot = now;
            self.waiting = false;
            if !planned {
                self.left -= 1;
            }
        }
        Due { row: self.rows.due(now) || snapshot, snapshot }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::spec::ColourBy;

    fn output(samples: usize, snapshots: usize, rupture_density: f64) -> OutputSpec {
        OutputSpec { samples, snapshots, rupture_density, frame_size: [64, 64], colour: ColourBy::Stress }
    }

    fn count(schedule: &mut Schedule, from: u32, to: u32) -> (usize, usize) {
        let dues: Vec<Due> = (from..to).map(|i| schedule.due(f64::from(i) / 10_000.0)).collect();
        (dues.iter().filter(|d| d.row).count(), dues.iter().filter(|d| d.snapshot).count())
    }

    #[test]
    fn rows_and_snapshots_are_spread_evenly() {
        let mut schedule = Schedule::new(&output(100, 10, 5.0));
        assert_eq!(count(&mut schedule, 1, 5_001), (50, 5));
        assert_eq!(count(&mut schedule, 5_001, 10_001), (50, 5));
    }

    #[test]
    fn after_a_rupture_they_are_denser() {
        let mut schedule = Schedule::new(&output(100, 10, 5.0));
        count(&mut schedule, 1, 5_001);
        schedule.rupture(0.5);
        let (rows, snapshots) = count(&mut schedule, 5_001, 10_001);
        // One more for the rupture itself, which also shifts no planned one.
        assert!((250..=252).contains(&rows), "{rows}");
        assert!((25..=26).contains(&snapshots), "{snapshots}");
    }

    #[test]
    fn a_rupture_gets_its_snapshot_at_once_but_a_batch_only_one() {
        let mut schedule = Schedule::new(&output(10, 10, 1.0));
        schedule.due(0.1);
        schedule.rupture(0.15);
        assert!(schedule.due(0.15).snapshot);
        schedule.rupture(0.151);
        assert!(!schedule.due(0.151).snapshot);
        assert!(schedule.due(0.176).snapshot, "the batch is shown when the spacing has passed");
    }

    #[test]
    fn snapshots_for_ruptures_are_bounded() {
        let mut schedule = Schedule::new(&output(10, 10, 1.0));
        let taken = (1..=100_000).filter(|i| {
            let now = f64::from(*i) / 1_000.0;
            schedule.rupture(now);
            schedule.due(now).snapshot
        });
        assert_eq!(taken.count(), 1_000 + 10);
    }

    #[test]
    fn none_asked_for_means_none() {
        let mut schedule = Schedule::new(&output(10, 0, 3.0));
        schedule.rupture(0.1);
        assert_eq!(count(&mut schedule, 1_001, 20_000).1, 0);
    }
}
