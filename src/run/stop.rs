//! When a run ends.

use crate::scene::spec::StopSpec;
use std::collections::VecDeque;
use std::fmt;

/// Rows over which the nominal stress is averaged before it is compared with its peak. One elastic wave after a
/// rupture is shorter than that; a fall that lasts is not.
const WINDOW: usize = 20;

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StopReason {
    /// `stop.strain` was reached [-].
    Strain(f64),
    /// Nominal stress fell below `stop.stress_fraction` of its peak [-].
    StressFraction(f64),
    /// `stop.time` was reached [s].
    Time(f64),
    /// `stop.steps` was reached.
    Steps(u64),
    /// Someone asked for it (Ctrl-C).
    Interrupted,
    /// An error; everything seen before it was kept.
    Trouble,
}

impl fmt::Display for StopReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Strain(strain) => {
                write!(f, "strain reached {:.4} % (stop.strain)", strain * 100.0)
            }
            Self::StressFraction(fraction) => {
                write!(f, "stress fell to {} % of its peak after a rupture (stop.stress_fraction)", fraction * 100.0)
            }
            Self::Time(time) => write!(f, "time reached {time:.4e} s (stop.time)"),
            Self::Steps(steps) => write!(f, "{steps} steps were done (stop.steps)"),
            Self::Interrupted => write!(f, "interrupted"),
            Self::Trouble => write!(f, "trouble"),
        }
    }
}

/// Watches the stop conditions of a scene; the first that holds ends the run.
#[derive(Debug, Clone)]
pub struct StopRule {
    stop: StopSpec,
    window: VecDeque<f64>,
    peak: f64,
    ruptured: bool,
    fallen: bool,
}

impl StopRule {
    /// The rule of a scene.
    pub fn new(stop: &StopSpec) -> Self {
        Self { stop: stop.clone(), window: VecDeque::with_capacity(WINDOW), peak: 0.0, ruptured: false, fallen: false }
    }

    /// A bond broke.
    pub fn rupture(&mut self) {
        self.ruptured = true;
    }

    /// A row of the curve was taken at this nominal stress [Pa].
    pub fn row(&mut self, stress: f64) {
        let Some(fraction) = self.stop.stress_fraction else {
            return;
        };
        if self.window.len() == WINDOW {
            self.window.pop_front();
        }
        self.window.push_back(stress);
        if self.window.len() < WINDOW {
            return;
        }
        let mean = self.window.iter().sum::<f64>() / WINDOW as f64;
        self.peak = self.peak.max(mean);
        self.fallen = self.ruptured && mean < fraction * self.peak;
    }

    /// The condition that holds now, if one does.
    pub fn reached(&self, strain: f64, time: f64, steps: u64) -> Option<StopReason> {
        if let Some(end) = self.stop.strain
            && strain.abs() >= end.abs()
        {
            return Some(StopReason::Strain(strain));
        }
        if let Some(fraction) = self.stop.stress_fraction
            && self.fallen
        {
            return Some(StopReason::StressFraction(fraction));
        }
        if self.stop.time.is_some_and(|end| time >= end) {
            return Some(StopReason::Time(time));
        }
        if self.stop.steps.is_some_and(|end| steps >= end) {
            return Some(StopReason::Steps(steps));
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at_half() -> StopRule {
        StopRule::new(&StopSpec { strain: None, stress_fraction: Some(0.5), time: None, steps: None })
    }

    fn rows(rule: &mut StopRule, stress: f64, count: usize) {
        (0..count).for_each(|_| rule.row(stress));
    }

    #[test]
    fn a_fall_that_lasts_ends_the_run() {
        let mut rule = at_half();
        rows(&mut rule, 100.0, 30);
        rule.rupture();
        rows(&mut rule, 20.0, 20);
        assert_eq!(rule.reached(0.0, 0.0, 0), Some(StopReason::StressFraction(0.5)));
    }

    #[test]
    fn a_single_wave_does_not() {
        let mut rule = at_half();
        rows(&mut rule, 100.0, 30);
        rule.rupture();
        rows(&mut rule, -50.0, 3);
        rows(&mut rule, 90.0, 20);
        assert_eq!(rule.reached(0.0, 0.0, 0), None);
    }

    #[test]
    fn without_a_rupture_it_is_unloading_not_fracture() {
        let mut rule = at_half();
        rows(&mut rule, 100.0, 30);
        rows(&mut rule, 0.0, 30);
        assert_eq!(rule.reached(0.0, 0.0, 0), None);
    }

    #[test]
    fn each_limit_ends_the_run() {
        let stop = StopSpec { strain: Some(0.3), stress_fraction: None, time: Some(2.0), steps: Some(7) };
        let rule = StopRule::new(&stop);
        assert_eq!(rule.reached(0.29, 1.9, 6), None);
        assert!(matches!(rule.reached(0.3, 1.9, 6), Some(StopReason::Strain(_))));
        assert!(matches!(rule.reached(0.0, 2.0, 6), Some(StopReason::Time(_))));
        assert!(matches!(rule.reached(0.0, 0.0, 7), Some(StopReason::Steps(7))));
    }
}
