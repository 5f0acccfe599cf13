//! How far a run has come towards where it is expected to end.

use crate::scene::spec::StopSpec;

/// Where a run is expected to end; the first that is reached ends it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlannedEnd {
    /// Strain of the body (-).
    pub strain: Option<f64>,
    /// Simulated time (s).
    pub time: Option<f64>,
    /// Steps.
    pub steps: Option<u64>,
}

impl PlannedEnd {
    /// From the scene's stop conditions and the engine's own expectation of the final strain (-)
    /// ([`crate::engine::view::RunInfo::strain_end`]), which wins over `stop.strain`: it also knows
    /// when the wires will have broken.
    pub fn new(stop: &StopSpec, strain_end: Option<f64>) -> Self {
        Self { strain: strain_end.or(stop.strain), time: stop.time, steps: stop.steps }
    }

    /// Whether any end is known.
    pub fn is_known(&self) -> bool {
        self.strain.is_some() || self.time.is_some() || self.steps.is_some()
    }

    /// Fraction of the planned run that is done (-): the greatest over the known ends, because the
    /// first one reached ends the run. Above 1 when a run goes on past its expected end; 0 when no
    /// end is known.
    pub fn fraction(&self, strain: f64, time: f64, steps: u64) -> f64 {
        let of = |done: f64, end: Option<f64>| match end {
            Some(end) if end != 0.0 => (done / end).max(0.0),
            _ => 0.0,
        };
        of(strain, self.strain).max(of(time, self.time)).max(of(steps as f64, self.steps.map(|n| n as f64)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_end_decides() {
        let end = PlannedEnd { strain: Some(0.2), time: Some(10.0), steps: None };
        assert_eq!(end.fraction(0.1, 1.0, 5), 0.5);
        assert_eq!(end.fraction(0.1, 9.0, 5), 0.9);
    }

    #[test]
    fn compression_counts_towards_a_negative_end() {
        let end = PlannedEnd { strain: Some(-0.2), ..Default::default() };
        assert_eq!(end.fraction(-0.1, 0.0, 0), 0.5);
        assert_eq!(end.fraction(0.1, 0.0, 0), 0.0);
    }

    #[test]
    fn without_an_end_nothing_is_known() {
        assert!(!PlannedEnd::default().is_known());
        assert_eq!(PlannedEnd::default().fraction(1.0, 1.0, 1), 0.0);
    }
}
