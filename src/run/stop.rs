//! When a run ends.

use crate::base::finding::StopReason;
use crate::engine::saved::{Reader, Unfit, Writer};
use crate::observe::peaks::DROP;
use crate::scene::spec::StopSpec;
use std::collections::VecDeque;

/// Time over which the nominal stress is averaged before it is compared with its peak, in passages of an elastic wave
/// along the body (-): the wave that a rupture sends out comes back after two, and is averaged out over them. A fall that
/// lasts is not.
const PASSAGES: f64 = 2.0;

/// Watches the stop conditions of a scene; the first that holds ends the run.
#[derive(Debug, Clone)]
pub struct StopRule {
    stop: StopSpec,
    /// Time over which stress is averaged (s).
    window: f64,
    /// Length of each step in the window (s), and stress times that.
    steps: VecDeque<[f64; 2]>,
    /// Their sums.
    sum: [f64; 2],
    time: f64,
    /// The mean over the window whose magnitude was greatest: below zero where the body is pushed (Pa).
    peak: f64,
    ruptured: bool,
    /// Mean stress over its peak, where it has fallen to `stop.stress_fraction` (-).
    fallen: Option<f64>,
    /// Strain at which stress dropped, as long as it stays down (-).
    dropped_at: Option<f64>,
    /// Strain since the drop, in the direction of the load, where it has gone to `stop.strain_after_drop` (-).
    passed: Option<f64>,
}

impl StopRule {
    /// The rule of a scene; `passage` is the time in which an elastic wave runs along its body (s).
    pub fn new(stop: &StopSpec, passage: f64) -> Self {
        Self {
            stop: stop.clone(),
            window: PASSAGES * passage,
            steps: VecDeque::new(),
            sum: [0.0; 2],
            time: 0.0,
            peak: 0.0,
            ruptured: false,
            fallen: None,
            dropped_at: None,
            passed: None,
        }
    }

    /// Puts in what it has seen so far.
    pub fn save(&self, out: &mut Writer) {
        out.put(&(
            &self.steps,
            self.sum,
            self.time,
            self.peak,
            self.ruptured,
            self.fallen,
            self.dropped_at,
            self.passed,
        ));
    }

    /// Takes up what [`Self::save`] has put in.
    ///
    /// # Errors
    /// [`Unfit`] when it is something else.
    pub fn restore(&mut self, from: &mut Reader) -> Result<(), Unfit> {
        let Self { steps, sum, time, peak, ruptured, fallen, dropped_at, passed, .. } = self;
        (*steps, *sum, *time, *peak, *ruptured, *fallen, *dropped_at, *passed) = from.take()?;
        Ok(())
    }

    /// A bond broke.
    pub fn rupture(&mut self) {
        self.ruptured = true;
    }

    /// A step was done, to this time (s), strain (-) and nominal stress (Pa).
    pub fn step(&mut self, time: f64, strain: f64, stress: f64) {
        if self.stop.stress_fraction.is_none() && self.stop.strain_after_drop.is_none() {
            return;
        }
        let dt = time - std::mem::replace(&mut self.time, time);
        let step = [dt, stress * dt];
        self.steps.push_back(step);
        self.sum = [self.sum[0] + step[0], self.sum[1] + step[1]];
        while let Some(first) = self.steps.front().filter(|first| self.sum[0] - first[0] >= self.window) {
            self.sum = [self.sum[0] - first[0], self.sum[1] - first[1]];
            self.steps.pop_front();
        }
        if self.steps.is_empty() || self.sum[0] < self.window {
            return;
        }
        let mean = self.sum[1] / self.sum[0];
        if mean.abs() > self.peak.abs() {
            self.peak = mean;
        }
        let below = |share: f64| self.ruptured && mean * self.peak.signum() < share * self.peak.abs();
        self.fallen = self.stop.stress_fraction.filter(|share| below(*share)).map(|_| mean / self.peak);
        self.dropped_at = if below(1.0 - DROP) { self.dropped_at.or(Some(strain)) } else { None };
        let beyond = self.dropped_at.zip(self.stop.strain_after_drop);
        let since = beyond.map(|(at, beyond)| ((strain - at) * self.peak.signum(), beyond));
        self.passed = since.filter(|(since, beyond)| since >= beyond).map(|(since, _)| since);
    }

    /// The condition that holds now, if one does.
    pub fn reached(&self, strain: f64, time: f64, steps: u64) -> Option<StopReason> {
        if let Some(end) = self.stop.strain
            && strain.abs() >= end.abs()
        {
            return Some(StopReason::Strain { limit: end, reached: strain });
        }
        if let (Some(limit), Some(reached)) = (self.stop.stress_fraction, self.fallen) {
            return Some(StopReason::StressFraction { limit, reached });
        }
        if let (Some(limit), Some(reached)) = (self.stop.strain_after_drop, self.passed) {
            return Some(StopReason::AfterDrop { limit, reached });
        }
        if let Some(limit_s) = self.stop.time.filter(|end| time >= *end) {
            return Some(StopReason::Time { limit_s, reached_s: time });
        }
        let limit = self.stop.steps.filter(|end| steps >= *end);
        limit.map(|limit| StopReason::Steps { limit, reached: steps })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at_half() -> StopRule {
        StopRule::new(&StopSpec { stress_fraction: Some(0.5), ..StopSpec::default() }, 10.0)
    }

    /// Steps of 1 s, in a body that a wave takes 10 s to run along.
    fn steps(rule: &mut StopRule, stress: f64, count: usize) {
        (0..count).for_each(|_| rule.step(rule.time + 1.0, 0.0, stress));
    }

    #[test]
    fn a_fall_that_lasts_ends_the_run() {
        let mut rule = at_half();
        steps(&mut rule, 100.0, 30);
        rule.rupture();
        steps(&mut rule, 20.0, 20);
        let Some(StopReason::StressFraction { limit, reached }) = rule.reached(0.0, 0.0, 0) else {
            panic!("it goes on")
        };
        assert_eq!(limit, 0.5);
        assert!((reached - 0.2).abs() < 1e-12, "{reached}");
    }

    #[test]
    fn so_does_a_fall_of_what_is_pushed() {
        let mut rule = at_half();
        steps(&mut rule, -100.0, 30);
        rule.rupture();
        steps(&mut rule, -80.0, 30);
        assert_eq!(rule.reached(0.0, 0.0, 0), None);
        steps(&mut rule, -20.0, 20);
        let Some(StopReason::StressFraction { reached, .. }) = rule.reached(0.0, 0.0, 0) else { panic!("it goes on") };
        assert!((reached - 0.2).abs() < 1e-12, "{reached}");
    }

    #[test]
    fn a_single_wave_does_not() {
        let mut rule = at_half();
        steps(&mut rule, 100.0, 30);
        rule.rupture();
        steps(&mut rule, -50.0, 3);
        steps(&mut rule, 90.0, 20);
        assert_eq!(rule.reached(0.0, 0.0, 0), None);
    }

    #[test]
    fn without_a_rupture_it_is_unloading_not_fracture() {
        let mut rule = at_half();
        steps(&mut rule, 100.0, 30);
        steps(&mut rule, 0.0, 30);
        assert_eq!(rule.reached(0.0, 0.0, 0), None);
    }

    #[test]
    fn a_strain_beyond_the_drop_ends_the_run() {
        let mut rule = StopRule::new(&StopSpec { strain_after_drop: Some(0.02), ..StopSpec::default() }, 10.0);
        let pull = |rule: &mut StopRule, from: f64, to: f64, stress: f64| {
            for k in 0..=100 {
                rule.step(rule.time + 1.0, from + (to - from) * f64::from(k) / 100.0, stress);
            }
            rule.reached(to, 0.0, 0)
        };
        assert_eq!(pull(&mut rule, 0.0, 0.2, 100.0), None);
        rule.rupture();
        // A fall of less than a fifth, and one that does not last.
        assert_eq!(pull(&mut rule, 0.2, 0.23, 85.0), None);
        assert_eq!(pull(&mut rule, 0.23, 0.24, 70.0), None);
        assert_eq!(pull(&mut rule, 0.24, 0.25, 95.0), None);
        assert_eq!(pull(&mut rule, 0.25, 0.265, 40.0), None);
        let Some(StopReason::AfterDrop { limit, reached }) = pull(&mut rule, 0.265, 0.28, 40.0) else {
            panic!("it goes on")
        };
        assert!(limit == 0.02 && (0.02..0.031).contains(&reached), "{reached}");
    }

    #[test]
    fn so_does_one_of_what_is_pushed() {
        let mut rule = StopRule::new(&StopSpec { strain_after_drop: Some(0.02), ..StopSpec::default() }, 10.0);
        let push = |rule: &mut StopRule, from: f64, to: f64, stress: f64| {
            for k in 0..=100 {
                rule.step(rule.time + 1.0, from + (to - from) * f64::from(k) / 100.0, stress);
            }
            rule.reached(to, 0.0, 0)
        };
        push(&mut rule, 0.0, -0.1, -100.0);
        rule.rupture();
        assert_eq!(push(&mut rule, -0.1, -0.11, -40.0), None);
        let Some(StopReason::AfterDrop { reached, .. }) = push(&mut rule, -0.11, -0.13, -40.0) else {
            panic!("it goes on")
        };
        assert!((0.02..0.031).contains(&reached), "{reached}");
    }

    #[test]
    fn each_limit_ends_the_run() {
        let stop = StopSpec { strain: Some(0.3), time: Some(2.0), steps: Some(7), ..StopSpec::default() };
        let rule = StopRule::new(&stop, 10.0);
        assert_eq!(rule.reached(0.29, 1.9, 6), None);
        assert!(matches!(rule.reached(0.3, 1.9, 6), Some(StopReason::Strain { limit: 0.3, reached: 0.3 })));
        assert!(matches!(rule.reached(0.0, 2.0, 6), Some(StopReason::Time { limit_s: 2.0, reached_s: 2.0 })));
        assert!(matches!(rule.reached(0.0, 0.0, 7), Some(StopReason::Steps { limit: 7, reached: 7 })));
    }
}
