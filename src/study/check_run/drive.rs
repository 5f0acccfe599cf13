//! What the upper grip did, against what the scene has it do.

use super::finding::{InvariantOutcome, Search};
use super::folder::Folder;
use super::invariant::Invariant;
use crate::engine::measure::MEAN_LAG;
use crate::scene::spec::DriveSpec;
use std::f64::consts::TAU;

pub const STRAIN: Invariant =
    Invariant { name: "strain", about: "strain only grows under a pull, only falls under a push", check: strain };

/// Every row is held against the drive. Its strain is a mean over the time that rows are smoothed over, or since the start
/// where that is shorter, which short pulls never leave; steps decide on which instants that mean is made of, so the way may
/// be what the grip does in two of them off. An adaptive pull has a speed of its own choice once it is past its slow start:
/// from there on its rows must lie between its slow and its fastest speed.
pub const WAY: Invariant = Invariant {
    name: "strain-unit",
    about: "strain in per cent is the way of the scene's drive over the length that is free between the particles held",
    check: way,
};

/// Speed of the grip at the start (m/s), where it is prescribed.
fn speed(run: &Folder) -> Option<f64> {
    match run.spec.grip.as_ref()?.drive {
        DriveSpec::Speed(speed) => Some(speed),
        DriveSpec::Cyclic { .. } => None,
    }
}

fn strain(run: &Folder) -> InvariantOutcome {
    let Some(speed) = speed(run) else {
        return InvariantOutcome::NotApplicable("no grip moves one way".into());
    };
    let mut search = Search::new();
    for row in 1..run.curve.rows.len() {
        let rise = run.curve.number(row, "strain_percent") - run.curve.number(row - 1, "strain_percent");
        let back = if speed == 0.0 { rise.abs() } else { -rise * speed.signum() };
        search.add(back, || format!("curve.csv line {}: strain changes by {rise} %", row + 2));
    }
    search.end(0.0, "%", "there is one row")
}

/// Time over which a row at `time` is smoothed (s).
pub(super) fn smoothed(run: &Folder, time: f64) -> f64 {
    (2.0 * MEAN_LAG * run.trajectory.info.wave_passage).min(time)
}

/// Way of the upper grip that a row at `time` (s) shows, where the scene prescribes it, and how fast it is at most (m, m/s).
fn prescribed(run: &Folder, time: f64, free: f64) -> Option<(f64, f64)> {
    let grip = run.spec.grip.as_ref()?;
    let window = smoothed(run, time);
    match grip.drive {
        DriveSpec::Speed(speed) => {
            let slow = grip.adaptive.as_ref().is_none_or(|adaptive| speed.abs() * time < adaptive.from * free);
            slow.then(|| (speed * (time - 0.5 * window), speed.abs()))
        }
        DriveSpec::Cyclic { amplitude, frequency } => {
            let rate = TAU * frequency;
            let mean = match rate * window {
                0.0 => 0.0,
                phase => ((rate * (time - window)).cos() - (rate * time).cos()) / phase,
            };
            Some((amplitude * mean, (amplitude * rate).abs()))
        }
    }
}

fn way(run: &Folder) -> InvariantOutcome {
    let (Some(free), Some(grip)) = (run.free_length, &run.spec.grip) else {
        return InvariantOutcome::NotApplicable("no grips hold this body".into());
    };
    let time = |row: usize| run.curve.number(row, "time_s");
    let found = |row: usize| run.curve.number(row, "strain_percent") * 1e-2 * free;
    let rows = run.curve.rows.len();
    let longest = run.longest_step();
    let most = (0..rows).map(|row| found(row).abs()).fold(0.0, f64::max);
    let mut search = Search::new();
    for row in 0..rows {
        let place = |right: f64| {
            format!(
                "curve.csv line {}, strain_percent: a way of {:e} m, the drive's is {right:e} m",
                row + 2,
                found(row)
            )
        };
        if let Some((right, fastest)) = prescribed(run, time(row), free) {
            let off = (found(row) - right).abs() - 2.0 * fastest * longest;
            search.add(off.max(0.0) / most.max(right.abs()).max(f64::MIN_POSITIVE), || place(right));
        } else if let (Some(adaptive), Some(slow), true) = (&grip.adaptive, speed(run), row > 0) {
            let middle = |row: usize| time(row) - 0.5 * smoothed(run, time(row));
            let passed = middle(row) - middle(row - 1);
            let rise = (found(row) - found(row - 1)) * slow.signum();
            let slack = 2.0 * adaptive.fastest * longest;
            let [least, greatest] = [slow.abs() * passed - slack, adaptive.fastest * passed + slack];
            let off = (least - rise).max(rise - greatest).max(0.0);
            search.add(off / most.max(f64::MIN_POSITIVE), || place(found(row - 1) + least.max(rise.min(greatest))));
        }
    }
    // Strains and times have nine digits.
    search.end(1e-7, "of the way", "there are no rows")
}
