//! When to take a row of the curve and when a snapshot.

use crate::scene::spec::OutputSpec;

/// How many times denser rows are after the first rupture.
const ROW_DENSITY: f64 = 4.0;
/// How many snapshots ruptures may bring for each planned one: a run that breaks all its wires one by one must not
/// fill the disk.
const FOR_RUPTURES: usize = 4;
/// Ruptures that follow each other within this share of the densest spacing are one batch with one snapshot.
const BATCH: f64 = 0.25;
/// Wait for the next snapshot over the time since the last rupture: what a rupture brought about slows down as it
/// spreads, so snapshots thin out with it.
const QUIET: f64 = 0.25;

/// Spreads rows and snapshots evenly over the planned run, and brings more snapshots around ruptures: the last state
/// before, the first after, and then a series that thins out until the next rupture.
///
/// Time is the fraction of the planned run that is done (-)
/// ([`crate::observe::planned::PlannedEnd::fraction`]). The first and the last state are not its business:
/// they are always taken.
#[derive(Debug, Clone)]
pub struct Schedule {
    rows: Ticks,
    snapshots: Ticks,
    /// Densest spacing of snapshots (-).
    spacing: f64,
    /// Snapshots that ruptures may bring in all, and those that are left of them.
    budget: usize,
    left: usize,
    last_rupture: Option<f64>,
    /// A rupture waits for the first snapshot after it.
    waiting: bool,
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
    /// How many there are per planned run (-).
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

/// Most snapshots of a run but for its first and last, where bonds can break or not.
pub fn most_snapshots(output: &OutputSpec, breaks: bool) -> usize {
    output.snapshots.saturating_mul(if breaks { 1 + FOR_RUPTURES } else { 1 })
}

impl Schedule {
    /// The schedule that a scene asks for.
    pub fn new(output: &OutputSpec) -> Self {
        let budget = output.snapshots.saturating_mul(FOR_RUPTURES);
        Self {
            rows: Ticks::new(output.samples),
            snapshots: Ticks::new(output.snapshots),
            spacing: 1.0 / (output.snapshots as f64 * output.rupture_density),
            budget,
            left: budget,
            last_rupture: None,
            waiting: false,
            last_snapshot: 0.0,
        }
    }

    /// One bond or more broke in the step just done. Whether the state that was kept from before, at `kept`, is to be
    /// shown first.
    pub fn rupture(&mut self, kept: Option<f64>, now: f64) -> bool {
        if self.last_rupture.is_none() {
            self.rows.densify(ROW_DENSITY, now);
        }
        let before = kept.filter(|at| self.left > 0 && at - self.last_snapshot >= BATCH * self.wait());
        if let Some(at) = before {
            self.left -= 1;
            self.last_snapshot = at;
        }
        self.last_rupture = Some(now);
        self.waiting = true;
        before.is_some()
    }

    /// Least time between two snapshots: it grows as the budget shrinks, so that many ruptures cannot use it up at once.
    fn wait(&self) -> f64 {
        self.spacing * self.budget as f64 / self.left.max(1) as f64
    }

    /// What is due at this fraction of the run (-); asked once after every step.
    pub fn due(&mut self, now: f64) -> Due {
        let planned = self.snapshots.due(now);
        let snapshot = planned || self.due_for_ruptures(now);
        if snapshot {
            self.last_snapshot = now;
            self.waiting = false;
            if !planned {
                self.left -= 1;
            }
        }
        Due { row: self.rows.due(now) || snapshot, snapshot }
    }

    fn due_for_ruptures(&self, now: f64) -> bool {
        let Some(rupture) = self.last_rupture.filter(|_| self.left > 0) else { return false };
        // The state before a rupture and the first one after it may lie close together: it is what they differ in
        // that is to be seen.
        let wait = if self.waiting { BATCH * self.wait() } else { self.wait().max(QUIET * (now - rupture)) };
        now - self.last_snapshot >= wait
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn output(samples: usize, snapshots: usize, rupture_density: f64) -> OutputSpec {
        OutputSpec { samples, snapshots, rupture_density, ..OutputSpec::default() }
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

    /// Fractions at which snapshots come in 100,000 steps, when ruptures come at `ruptures`; the state at the last row
    /// is kept, as a run does.
    fn shown(schedule: &mut Schedule, ruptures: &[f64]) -> Vec<f64> {
        let (mut shown, mut kept, mut broken) = (Vec::new(), None, 0);
        for step in 1..=100_000 {
            let now = f64::from(step) / 100_000.0;
            let before = broken;
            broken = ruptures.iter().filter(|at| **at <= now + 1e-9).count();
            let at = kept;
            if broken > before && schedule.rupture(kept.take(), now) {
                shown.extend(at);
            }
            let due = schedule.due(now);
            if due.snapshot {
                shown.push(now);
                kept = None;
            } else if due.row {
                kept = Some(now);
            }
        }
        shown
    }

    fn between(shown: &[f64], from: f64, to: f64) -> usize {
        shown.iter().filter(|at| (from..to).contains(*at)).count()
    }

    #[test]
    fn rows_are_denser_after_the_first_rupture_only() {
        let mut schedule = Schedule::new(&output(100, 10, 1.0));
        count(&mut schedule, 1, 5_001);
        schedule.rupture(None, 0.5);
        schedule.rupture(None, 0.5001);
        let (rows, _) = count(&mut schedule, 5_002, 10_001);
        assert!((200..=203).contains(&rows), "{rows}");
    }

    #[test]
    fn a_rupture_is_shown_before_and_after_and_then_ever_less_often() {
        let shown = shown(&mut Schedule::new(&output(2000, 50, 40.0)), &[0.7123]);
        assert_eq!(between(&shown, 0.0, 0.711), 35, "evenly spread before");
        let after = shown.iter().position(|at| *at >= 0.7123).unwrap();
        assert!(shown[after - 1] > 0.7123 - 0.0006 && shown[after - 1] < 0.7123, "{}", shown[after - 1]);
        assert!(shown[after] < 0.7123 + 0.0005, "{}", shown[after]);
        // Densest spacing 0.0005: seven in the first 0.004, two or three in the 0.004 before 0.73.
        let (dense, thin) = (between(&shown, 0.7123, 0.7163), between(&shown, 0.726, 0.73));
        assert!((6..=9).contains(&dense) && (1..=2).contains(&thin), "{dense} and {thin}");
        assert_eq!(between(&shown, 0.9, 1.0001), 6, "evenly spread again, both ends included");
    }

    #[test]
    fn ruptures_in_a_row_are_each_followed_by_a_snapshot() {
        let ruptures = [0.75, 0.7504, 0.7521, 0.7533, 0.7571];
        let shown = shown(&mut Schedule::new(&output(2000, 50, 40.0)), &ruptures);
        for pair in ruptures.windows(2) {
            assert!(between(&shown, pair[0], pair[1]) > 0, "{pair:?} in {shown:?}");
        }
    }

    #[test]
    fn a_batch_of_ruptures_has_one_snapshot() {
        let ruptures: Vec<f64> = (0..10).map(|i| 0.5 + 1e-5 * f64::from(i)).collect();
        let shown = shown(&mut Schedule::new(&output(2000, 50, 40.0)), &ruptures);
        assert!(between(&shown, 0.5, 0.5001) <= 2, "{shown:?}");
    }

    #[test]
    fn snapshots_for_ruptures_are_bounded_and_do_not_end_at_once() {
        let ruptures: Vec<f64> = (1..100_000).map(|i| f64::from(i) / 100_000.0).collect();
        let shown = shown(&mut Schedule::new(&output(2000, 60, 40.0)), &ruptures);
        assert!((295..=300).contains(&shown.len()), "60 and four times 60, not {}", shown.len());
        let last = shown.iter().rposition(|at| (at * 60.0 + 1e-6).fract() > 1e-3).unwrap();
        assert!(shown[last] > 0.1, "the last one for a rupture came at {}", shown[last]);
    }

    #[test]
    fn with_density_one_a_rupture_brings_its_two_states_only() {
        let shown = shown(&mut Schedule::new(&output(2000, 10, 1.0)), &[0.55]);
        assert_eq!(shown.len(), 10 + 2, "{shown:?}");
    }

    /// Strains at which the wires of the main scene broke, in per cent, and the strain at which it was expected to end.
    const KA4: [f64; 22] = [
        27.9949, 28.2360, 28.2461, 28.2560, 28.5788, 28.8396, 28.8402, 28.8681, 28.8738, 28.8821, 28.9124, 28.9232,
        28.9335, 28.9377, 28.9906, 28.9988, 29.0253, 29.0434, 29.0480, 29.1157, 29.1227, 29.1255,
    ];
    const KA4_END: f64 = 37.58;

    #[test]
    fn most_frames_of_the_main_scene_show_its_fracture_and_hardly_two_wires_break_between_two() {
        let ruptures = KA4.map(|strain| strain / KA4_END);
        let all = shown(&mut Schedule::new(&output(2000, 60, 40.0)), &ruptures);
        let shown: Vec<f64> = all.into_iter().filter(|at| *at <= ruptures[21] + 3e-4).collect();
        let before = between(&shown, 0.0, ruptures[0]);
        let after = shown.len() - before;
        println!("{before} before the first rupture, {after} after it");
        assert!((45..=50).contains(&before) && after > before, "{before} before, {after} after");
        let broken = |at: f64| ruptures.iter().filter(|r| **r <= at).count();
        let most = shown.windows(2).map(|pair| broken(pair[1]) - broken(pair[0])).max().unwrap();
        assert!(most <= 2, "{most} wires broke between two frames");
        assert_eq!(broken(*shown.last().unwrap()), 22, "the last one to snap is seen");
    }
}
