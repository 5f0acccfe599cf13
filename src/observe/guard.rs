//! Watches whether the run can be trusted: every value finite, and loading quasi-static.

use super::Observer;
use super::units::percent;
use crate::base::error::{Error, Result};
use crate::engine::view::{RunInfo, Rupture, Sample};
use crate::scene::spec::TimeSpec;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Rows whose internal energy is below this share of the run's greatest one say nothing about kinetic over internal
/// energy [-]: a pull starts with kinetic energy and no strain, where the ratio is infinite. The usual demand on
/// quasi-static analyses by explicit integration is a small ratio throughout most of the process, not at its start.
pub const LEAST_INTERNAL_SHARE: f64 = 0.05;

/// Unbalanced share of the energy ledger above which a run warns [-].
pub const ENERGY_LIMIT: f64 = 0.01;

/// How far loading was from quasi-static. `None` for free bodies, which are not loaded by grips.
///
/// The quasi-static stage ends with the first rupture: a wire that snaps always throws energy about,
/// so the whole run is given beside it and judged by nobody.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct QuasiStatic {
    /// Greatest kinetic over internal energy before the first rupture [-], over rows with at least 5 % of the
    /// run's greatest internal energy.
    pub kinetic_over_internal_max: Option<f64>,
    /// The same over the whole run [-].
    pub kinetic_over_internal_overall: Option<f64>,
    /// Greatest difference of the two grip forces before the first rupture, over the run's peak grip force [%].
    pub grip_force_mismatch_percent: Option<f64>,
    /// The same over the whole run [%].
    pub grip_force_mismatch_overall_percent: Option<f64>,
}

struct Row {
    kinetic: f64,
    internal: f64,
    force: [f64; 2],
    before_rupture: bool,
}

/// The observer. It stops a run whose values stop being finite.
#[derive(Default)]
pub struct Guard {
    rows: Vec<Row>,
    gripped: bool,
    ruptured: bool,
    residual: Option<f64>,
}

impl Guard {
    /// A guard that has seen nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// What it has seen so far.
    pub fn quasi_static(&self) -> QuasiStatic {
        if !self.gripped {
            return QuasiStatic::default();
        }
        let staged = |row: &&Row| row.before_rupture;
        QuasiStatic {
            kinetic_over_internal_max: self.kinetic_ratio(self.rows.iter().filter(staged)),
            kinetic_over_internal_overall: self.kinetic_ratio(self.rows.iter()),
            grip_force_mismatch_percent: self.mismatch(self.rows.iter().filter(staged)),
            grip_force_mismatch_overall_percent: self.mismatch(self.rows.iter()),
        }
    }

    /// What the user must know about the run before believing it.
    pub fn warnings(&self, limits: &TimeSpec) -> Vec<String> {
        let seen = self.quasi_static();
        let mut warnings = Vec::new();
        if let Some(ratio) = seen.kinetic_over_internal_max
            && ratio > limits.kinetic_limit
        {
            warnings.push(format!(
                "loading was not quasi-static: kinetic energy reached {ratio:.3} of the internal energy before \
                 the first rupture (limit time.kinetic_limit = {}); pull more slowly",
                limits.kinetic_limit
            ));
        }
        if let Some(mismatch) = seen.grip_force_mismatch_percent
            && mismatch > percent(limits.mismatch_limit)
        {
            warnings.push(format!(
                "loading was not quasi-static: the two grip forces differed by {mismatch:.2} % of the peak force \
                 before the first rupture (limit time.mismatch_limit = {} %); pull more slowly",
                percent(limits.mismatch_limit)
            ));
        }
        if let Some(residual) = self.residual
            && residual.abs() > ENERGY_LIMIT
        {
            warnings.push(format!(
                "the energy ledger does not close: {:.2} % of the energy in it is unaccounted for",
                percent(residual)
            ));
        }
        warnings
    }

    fn kinetic_ratio<'a>(&'a self, rows: impl Iterator<Item = &'a Row>) -> Option<f64> {
        let most = self.rows.iter().map(|r| r.internal).fold(0.0, f64::max);
        let telling = rows.filter(|r| r.internal > 0.0 && r.internal >= LEAST_INTERNAL_SHARE * most);
        telling.map(|r| r.kinetic / r.internal).reduce(f64::max)
    }

    fn mismatch<'a>(&'a self, rows: impl Iterator<Item = &'a Row>) -> Option<f64> {
        let peak = self.rows.iter().flat_map(|r| r.force).map(f64::abs).fold(0.0, f64::max);
        if peak == 0.0 {
            return None;
        }
        rows.map(|r| percent((r.force[1] - r.force[0]).abs() / peak)).reduce(f64::max)
    }
}

/// The first value of a row that is not finite, by name.
fn first_not_finite(sample: &Sample) -> Option<String> {
    let named = [
        ("time", sample.time),
        ("strain", sample.strain),
        ("nominal stress", sample.stress),
        ("lower grip force", sample.grip_force[0]),
        ("upper grip force", sample.grip_force[1]),
        ("torque", sample.torque),
        ("work", sample.energy.work),
        ("kinetic energy", sample.energy.kinetic),
        ("internal energy", sample.energy.internal()),
    ];
    let wires = sample.wire_stress.iter().enumerate();
    named
        .into_iter()
        .find(|(_, value)| !value.is_finite())
        .map(|(name, value)| format!("the {name} is {value}"))
        .or_else(|| {
            wires
                .filter(|(_, stress)| !stress.is_finite())
                .map(|(w, stress)| format!("the stress of wire {} is {stress}", w + 1))
                .next()
        })
}

impl Observer for Guard {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        *self = Self { gripped: info.is_pulled(), ..Self::default() };
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        if let Some(what) = first_not_finite(sample) {
            return Err(Error::Trouble {
                step: sample.step,
                what,
                help: Some("try a smaller time.safety, or stronger damping".into()),
            });
        }
        self.rows.push(Row {
            kinetic: sample.energy.kinetic,
            internal: sample.energy.internal(),
            force: sample.grip_force,
            before_rupture: !self.ruptured && sample.bonds_broken == 0,
        });
        // The work of the two signs may cancel (a cyclic drive), so the scale is the greatest term seen.
        let scale = sample.energy.work.abs().max(sample.energy.internal().abs());
        self.residual = (scale > 0.0).then(|| sample.energy.residual() / scale);
        Ok(())
    }

    fn rupture(&mut self, _rupture: &Rupture) -> Result<()> {
        self.ruptured = true;
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::view::Energy;

    fn limits() -> TimeSpec {
        TimeSpec {
            safety: 0.8,
            step: None,
            mass_scale: 1.0,
            inertia_scale: 1.0,
            kinetic_limit: 0.05,
            mismatch_limit: 0.02,
        }
    }

    fn row(kinetic: f64, internal: f64, force: [f64; 2]) -> Sample {
        let energy = Energy { work: kinetic + internal, kinetic, plastic_bonds: internal, ..Energy::default() };
        Sample { energy, grip_force: force, ..Sample::default() }
    }

    fn gripped(rows: &[Sample]) -> Guard {
        let mut guard = Guard { gripped: true, ..Guard::default() };
        rows.iter().for_each(|row| guard.sample(row).unwrap());
        guard
    }

    #[test]
    fn a_slow_pull_raises_no_warning() {
        // The first row has kinetic energy and no internal energy, as every pull has.
        let guard =
            gripped(&[row(1.0, 0.0, [0.0, 0.0]), row(1.0, 50.0, [99.0, 100.0]), row(1.0, 100.0, [100.0, 100.0])]);
        assert_eq!(guard.quasi_static().kinetic_over_internal_max, Some(0.02));
        assert_eq!(guard.quasi_static().grip_force_mismatch_percent, Some(1.0));
        assert_eq!(guard.warnings(&limits()), Vec::<String>::new());
    }

    #[test]
    fn a_fast_pull_is_said_to_be_fast() {
        let guard = gripped(&[row(10.0, 100.0, [90.0, 100.0])]);
        let warnings = guard.warnings(&limits());
        assert_eq!(warnings.len(), 2, "{warnings:?}");
        assert!(warnings[0].contains("time.kinetic_limit") && warnings[1].contains("time.mismatch_limit"));
    }

    #[test]
    fn what_a_rupture_throws_about_counts_for_the_whole_run_only() {
        let mut guard = gripped(&[row(1.0, 100.0, [100.0, 100.0])]);
        let mut after = row(20.0, 100.0, [50.0, 100.0]);
        after.bonds_broken = 1;
        guard.sample(&after).unwrap();
        let seen = guard.quasi_static();
        assert_eq!((seen.kinetic_over_internal_max, seen.kinetic_over_internal_overall), (Some(0.01), Some(0.2)));
        assert_eq!(seen.grip_force_mismatch_percent, Some(0.0));
        assert_eq!(seen.grip_force_mismatch_overall_percent, Some(50.0));
    }

    #[test]
    fn an_open_ledger_is_said_to_be_open() {
        let mut open = row(0.0, 100.0, [1.0, 1.0]);
        open.energy.work = 110.0;
        let warnings = gripped(&[open]).warnings(&limits());
        assert!(warnings.iter().any(|w| w.contains("ledger")), "{warnings:?}");
    }

    #[test]
    fn a_value_that_is_not_finite_stops_the_run_and_is_named() {
        let wild = Sample { step: 7, wire_stress: vec![1.0, f64::NAN], ..Sample::default() };
        let error = Guard::new().sample(&wild).unwrap_err();
        assert_eq!(error.exit_code(), 4);
        assert_eq!(error.to_string(), "stopped at step 7: the stress of wire 2 is NaN");
    }
}
