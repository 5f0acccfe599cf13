//! Greatest stresses of a run, seen at every step: what decides on strength and elongation does not hang on how many rows
//! are written.

use serde::{Deserialize, Serialize};

/// Fall of the nominal stress below its peak by which a body has failed, and at which the second elongation is read (-).
pub const DROP: f64 = 0.2;

/// A stress and the strain at which it was reached.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Peak {
    /// Nominal stress (Pa).
    pub stress: f64,
    /// Strain of the body (-).
    pub strain: f64,
}

/// Greatest stresses of a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Peaks {
    /// Greatest nominal stress of the body; `None` when nothing was seen.
    pub tension: Option<Peak>,
    /// Least nominal stress of the body, below zero where it was compressed.
    pub compression: Option<Peak>,
    /// Strain at which the stress of a body in which a bond had broken first lay [`DROP`] below the greatest, after it (-);
    /// `None` when it never did. A body that is unloaded whole does not drop.
    pub drop: Option<f64>,
    /// Greatest nominal stress at mid-gauge of each wire.
    pub wires: Vec<Peak>,
}

/// Follows the stresses of a run.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Monitor {
    peaks: Peaks,
    last: Peak,
    ruptured: bool,
}

impl Monitor {
    /// A bond broke.
    pub fn rupture(&mut self) {
        self.ruptured = true;
    }

    /// The body's strain (-), its nominal stress (Pa) and those of its wires, in order of time.
    pub fn see(&mut self, strain: f64, stress: f64, wires: impl Iterator<Item = f64>) {
        let (now, peaks) = (Peak { stress, strain }, &mut self.peaks);
        if peaks.tension.is_none_or(|peak| stress > peak.stress) {
            peaks.tension = Some(now);
            peaks.drop = None;
        }
        if peaks.compression.is_none_or(|peak| stress < peak.stress) {
            peaks.compression = Some(now);
        }
        let level = (1.0 - DROP) * peaks.tension.map_or(0.0, |peak| peak.stress);
        if self.ruptured && peaks.drop.is_none() && level > 0.0 && stress <= level {
            // A bond may break when the stress is down already.
            let from = self.last;
            let share = if from.stress > level { (from.stress - level) / (from.stress - stress) } else { 1.0 };
            peaks.drop = Some(from.strain + (strain - from.strain) * share);
        }
        for (w, stress) in wires.enumerate() {
            match peaks.wires.get_mut(w) {
                Some(peak) if stress > peak.stress => *peak = Peak { stress, strain },
                Some(_) => {}
                None => peaks.wires.push(Peak { stress, strain }),
            }
        }
        self.last = now;
    }

    /// What was seen so far.
    pub fn peaks(&self) -> &Peaks {
        &self.peaks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(curve: &[(f64, f64)], ruptured_at: usize) -> Peaks {
        let mut monitor = Monitor::default();
        for (i, (strain, stress)) in curve.iter().enumerate() {
            if i == ruptured_at {
                monitor.rupture();
            }
            monitor.see(*strain, *stress, std::iter::once(0.5 * stress));
        }
        monitor.peaks().clone()
    }

    const CURVE: [(f64, f64); 6] = [(0.0, 0.0), (0.1, 250.0), (0.15, 190.0), (0.2, 300.0), (0.3, 200.0), (0.4, -20.0)];

    #[test]
    fn the_drop_is_that_after_the_greatest_peak() {
        let peaks = seen(&CURVE, 2);
        assert_eq!(peaks.tension, Some(Peak { stress: 300.0, strain: 0.2 }));
        assert_eq!(peaks.compression, Some(Peak { stress: -20.0, strain: 0.4 }));
        assert_eq!(peaks.wires, [Peak { stress: 150.0, strain: 0.2 }]);
        // 240 lies 60 % of the way from (0.2, 300) to (0.3, 200).
        assert!((peaks.drop.unwrap() - 0.26).abs() < 1e-12, "{peaks:?}");
    }

    #[test]
    fn unloading_a_whole_body_is_no_drop() {
        assert_eq!(seen(&CURVE, usize::MAX).drop, None);
        assert_eq!(seen(&CURVE, 5).drop, Some(0.4), "down already when the first bond breaks");
        assert_eq!(seen(&CURVE[..4], 2).drop, None, "a new peak takes an earlier drop back");
    }

    #[test]
    fn a_body_that_was_only_pushed_does_not_drop() {
        let peaks = seen(&[(0.0, 0.0), (-0.1, -50.0), (-0.2, -97.0), (-0.3, -60.0)], 1);
        assert_eq!((peaks.drop, peaks.compression), (None, Some(Peak { stress: -97.0, strain: -0.2 })));
    }
}
