//! Watches whether the run can be trusted: every value finite, energy accounted for, loading quasi-static.

use crate::base::error::{Error, Result};
use crate::base::finding::{Failure, Finding, Instant, Notice, Quantity, Stopped};
use crate::base::units::percent;
use crate::base::worst::Worst;
use crate::engine::saved::{Reader, Unfit, Writer};
use crate::engine::view::{RunInfo, Rupture, Sample};
use crate::scene::spec::TimeSpec;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Rows whose internal energy is below this share of the run's greatest one say nothing about kinetic over internal
/// energy (-): a pull starts with kinetic energy and no strain, where the ratio is infinite. The usual demand on
/// quasi-static analyses by explicit integration is a small ratio throughout most of the process, not at its start.
pub const LEAST_INTERNAL_SHARE: f64 = 0.05;

/// Passages of an elastic wave along the body after which loading is judged (-). A pull starts as an even field of
/// velocities without any strain: against the elastic energy ½Eε² of ε = n v/c, after n passages, its kinetic energy ρv²/6
/// is 1/(3n²); of a wire that yields at once it still is a few per cent after ten.
pub const FIRST_PASSAGES: f64 = 10.0;

/// Share of the expected strain from which a row is judged as it comes (-): even an elastic body, whose energy goes with
/// the square of its strain, then has [`LEAST_INTERNAL_SHARE`] of its greatest energy.
const TELLING_STRAIN: f64 = 0.25;

/// Unbalanced share of the energy ledger above which a run warns (-).
pub const ENERGY_LIMIT: f64 = 0.01;

/// The same, above which it stops (-). A step that is not stable feeds energy in without end; everything else that was
/// tried, jaws that crush loose pieces included, stays below the warning.
const ENERGY_STOP: f64 = 0.2;

/// How far loading was from quasi-static, from [`FIRST_PASSAGES`] on. `None` for free bodies, which are not loaded by
/// grips, and before.
///
/// The quasi-static stage ends with the first rupture: a wire that snaps always throws energy about,
/// so the whole run is given beside it and judged by nobody.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct QuasiStatic {
    /// Greatest kinetic over internal energy before the first rupture (-), over rows with at least 5 % of the
    /// run's greatest internal energy (to 1.6 % of that).
    pub kinetic_over_internal_max: Option<f64>,
    /// The same over the whole run (-).
    pub kinetic_over_internal_overall: Option<f64>,
    /// Greatest difference of the two grip forces before the first rupture, over the run's peak grip force (%).
    pub grip_force_mismatch_percent: Option<f64>,
    /// The same over the whole run (%).
    pub grip_force_mismatch_overall_percent: Option<f64>,
}

/// What the rows of a run have been, in bounded memory: a run may have any number of them.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
struct Seen {
    /// Greatest internal energy (J) and greatest force of a grip (N).
    internal: f64,
    force: f64,
    /// Rows before the first rupture, and all.
    staged: Rows,
    all: Rows,
}

/// Some of the rows.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
struct Rows {
    /// Greatest kinetic over internal energy (-) of those in each bin of internal energy, see [`bin`].
    kinetic: BTreeMap<u64, f64>,
    /// Greatest difference of the two grips' forces (N).
    mismatch: Option<f64>,
}

/// The bin of an energy (J) that is not negative: 64 for each factor of two, in order.
fn bin(energy: f64) -> u64 {
    energy.to_bits() >> (f64::MANTISSA_DIGITS - 1 - 6)
}

impl Seen {
    /// Takes in a row: the ratio is given where it means something.
    fn take(&mut self, ratio: Option<f64>, internal: f64, force: [f64; 2], before_rupture: bool, settled: bool) {
        self.force = force.iter().fold(self.force, |most, force| most.max(force.abs()));
        if internal > self.internal {
            self.internal = internal;
            // What is too little now stays so.
            let least = bin(LEAST_INTERNAL_SHARE * internal);
            for rows in [&mut self.staged, &mut self.all] {
                while rows.kinetic.first_key_value().is_some_and(|(bin, _)| *bin < least) {
                    rows.kinetic.pop_first();
                }
            }
        }
        if settled {
            let mismatch = (force[1] - force[0]).abs();
            self.all.take(ratio, internal, mismatch);
            if before_rupture {
                self.staged.take(ratio, internal, mismatch);
            }
        }
    }
}

impl Rows {
    fn take(&mut self, kinetic_over_internal: Option<f64>, internal: f64, mismatch: f64) {
        if let Some(ratio) = kinetic_over_internal {
            self.kinetic.entry(bin(internal)).and_modify(|most| *most = most.max(ratio)).or_insert(ratio);
        }
        self.mismatch = Some(self.mismatch.map_or(mismatch, |most| most.max(mismatch)));
    }

    /// The greatest ratio in the bins that lie above `least` (J) as a whole.
    fn kinetic_ratio(&self, least: f64) -> Option<f64> {
        self.kinetic.range(bin(least) + 1..).map(|(_, ratio)| *ratio).reduce(f64::max)
    }
}

/// Judges the rows of a run. What must stop the run is an error, what the user must know is a [`Notice`].
pub struct Guard {
    limits: TimeSpec,
    /// Energies below this one are nothing (J).
    negligible: f64,
    seen: Seen,
    /// Time in which an elastic wave runs along the body (s).
    passage: f64,
    gripped: bool,
    /// Whether grips alone load the body, so that their forces are alike where loading is slow.
    balanced: bool,
    strain_end: f64,
    ruptured: bool,
    /// Most work done so far (J).
    work: f64,
    /// Greatest unbalanced share of the ledger (-).
    residual: Option<f64>,
    now: Instant,
    notices: Vec<Notice>,
    worst: Worst,
}

impl Guard {
    /// A guard with the limits of a scene.
    pub fn new(limits: &TimeSpec) -> Self {
        Self {
            limits: limits.clone(),
            negligible: 0.0,
            passage: 0.0,
            seen: Seen::default(),
            gripped: false,
            balanced: true,
            strain_end: f64::INFINITY,
            ruptured: false,
            work: 0.0,
            residual: None,
            now: Instant::default(),
            notices: Vec::new(),
            worst: Worst::default(),
        }
    }

    /// Before the first row. Energies below the run's negligible one are rounding: a body at rest has no ledger to close.
    pub fn start(&mut self, info: &RunInfo) {
        self.negligible = info.negligible_energy;
        self.passage = info.wave_passage;
        self.gripped = info.is_pulled();
        self.balanced = info.bodies.is_empty();
        self.strain_end = info.strain_end.unwrap_or(f64::INFINITY);
    }

    /// Puts in what it has seen since [`Self::start`].
    pub fn save(&self, out: &mut Writer) {
        out.put(&(&self.seen, self.ruptured, self.work, self.residual, self.now, &self.notices, &self.worst));
    }

    /// Takes up what [`Self::save`] has put in, after [`Self::start`].
    ///
    /// # Errors
    /// [`Unfit`] when it is something else.
    pub fn restore(&mut self, from: &mut Reader) -> Result<(), Unfit> {
        (self.seen, self.ruptured, self.work, self.residual, self.now, self.notices, self.worst) = from.take()?;
        Ok(())
    }

    /// Refuses a row that nobody should see.
    ///
    /// # Errors
    /// [`Error::Simulation`] that names the first value that is not finite.
    pub fn check(&self, sample: &Sample) -> Result<()> {
        first_not_finite(sample).map_or(Ok(()), |quantity| {
            Err(failed(self.at(sample.step, sample.time, sample.strain), Failure::NotFinite { quantity }))
        })
    }

    /// Takes in a row.
    ///
    /// # Errors
    /// [`Error::Simulation`] when energy worth a fifth of the work is unaccounted for, or motion turns round at every step.
    pub fn row(&mut self, sample: &Sample) -> Result<()> {
        self.now = self.at(sample.step, sample.time, sample.strain);
        let (kinetic, internal) = (sample.energy.kinetic, sample.energy.internal());
        let before_rupture = !self.ruptured && sample.bonds_broken == 0;
        let settled = self.is_settled();
        let ratio = (settled && internal > self.negligible).then(|| kinetic / internal);
        if self.gripped
            && before_rupture
            && sample.strain.abs() >= TELLING_STRAIN * self.strain_end.abs()
            && let Some(ratio) = ratio
        {
            self.judge_kinetic(ratio);
        }
        self.seen.take(ratio, internal, sample.grip_force, before_rupture, settled);
        self.judge_ledger(sample)
    }

    /// A bond broke: the quasi-static stage is over.
    pub fn rupture(&mut self, rupture: &Rupture) {
        if !std::mem::replace(&mut self.ruptured, true) {
            self.now = self.at(rupture.step, rupture.time, rupture.strain);
            self.judge_loading();
        }
    }

    /// After the last row. A run that was cut short never had the energy and the force that its rows are measured by, so
    /// only a `whole` one is judged as such.
    pub fn finish(&mut self, whole: bool) {
        if whole {
            self.judge_loading();
        }
    }

    /// Notices since the last call.
    pub fn take_notices(&mut self) -> Vec<Notice> {
        std::mem::take(&mut self.notices)
    }

    /// Those of them that have become worse since they were given, as they were at their worst.
    pub fn take_worse(&mut self) -> Vec<Notice> {
        self.worst.take_worse()
    }

    /// How far from quasi-static loading was so far.
    pub fn quasi_static(&self) -> QuasiStatic {
        if !self.gripped {
            return QuasiStatic::default();
        }
        let Seen { internal, force, staged, all } = &self.seen;
        let least = LEAST_INTERNAL_SHARE * internal;
        let compared = self.balanced && *force > 0.0;
        let mismatch = |rows: &Rows| rows.mismatch.filter(|_| compared).map(|most| percent(most / force));
        QuasiStatic {
            kinetic_over_internal_max: staged.kinetic_ratio(least),
            kinetic_over_internal_overall: all.kinetic_ratio(least),
            grip_force_mismatch_percent: mismatch(staged),
            grip_force_mismatch_overall_percent: mismatch(all),
        }
    }

    /// Greatest share of the energy in the ledger that was unaccounted for (-); `None` when there was none.
    pub fn greatest_residual(&self) -> Option<f64> {
        self.residual
    }

    fn is_settled(&self) -> bool {
        self.now.time >= FIRST_PASSAGES * self.passage
    }

    fn at(&self, step: u64, time: f64, strain: f64) -> Instant {
        Instant { step, time, strain: self.gripped.then_some(strain) }
    }

    /// Takes note of a finding that is the worst of its kind by `measure`.
    fn found(&mut self, measure: f64, finding: Finding) {
        if self.worst.tops(finding.kind(), measure) {
            self.notices.extend(self.worst.put(measure, Notice { at: self.now, finding }));
        }
    }

    /// Judges the quasi-static stage as a whole.
    fn judge_loading(&mut self) {
        if !self.gripped {
            return;
        }
        if !self.is_settled() {
            self.found(0.0, Finding::TooShort { passages: self.now.time / self.passage, start: FIRST_PASSAGES });
        }
        let seen = self.quasi_static();
        if let Some(ratio) = seen.kinetic_over_internal_max {
            self.judge_kinetic(ratio);
        }
        if let Some(mismatch) = seen.grip_force_mismatch_percent
            && mismatch > percent(self.limits.mismatch_limit)
        {
            let limit = self.limits.mismatch_limit;
            self.found(mismatch, Finding::GripForcesDiffer { mismatch: 0.01 * mismatch, limit });
        }
    }

    fn judge_kinetic(&mut self, over_internal: f64) {
        if over_internal > self.limits.kinetic_limit {
            self.found(over_internal, Finding::KineticEnergy { over_internal, limit: self.limits.kinetic_limit });
        }
    }

    fn judge_ledger(&mut self, sample: &Sample) -> Result<()> {
        // Work of the two signs may cancel (a cyclic drive), so the scale is the most that was done so far. Internal energy
        // is none: in a run that blows up it grows without bound, and hides how little was put in.
        self.work = self.work.max(sample.energy.work.abs());
        let scale = self.work;
        let gap = sample.energy.residual();
        if scale.max(gap.abs()) <= self.negligible {
            return Ok(());
        }
        // Leapfrog's kinetic energy is the product of two velocities half a step apart: it is negative as a whole only when
        // most of what moves turns round at every step.
        if sample.energy.kinetic < -ENERGY_STOP * scale {
            return Err(failed(self.now, Failure::UnstableMotion));
        }
        let share = gap.abs() / scale;
        self.residual = Some(self.residual.map_or(share, |greatest| greatest.max(share)));
        if share <= ENERGY_LIMIT {
            return Ok(());
        }
        if share > ENERGY_STOP {
            return Err(failed(self.now, Failure::LedgerOpen { missing_j: gap, over_work: share }));
        }
        self.found(share, Finding::LedgerOpen { missing_j: gap, over_work: share });
        Ok(())
    }
}

fn failed(at: Instant, failure: Failure) -> Error {
    Error::Simulation(Box::new(Stopped { at, failure, kept: None }))
}

/// The first value of a row that is not finite.
fn first_not_finite(sample: &Sample) -> Option<Quantity> {
    let named = [
        (Quantity::Time, sample.time),
        (Quantity::Strain, sample.strain),
        (Quantity::NominalStress, sample.stress),
        (Quantity::LowerGripForce, sample.grip_force[0]),
        (Quantity::UpperGripForce, sample.grip_force[1]),
        (Quantity::Torque, sample.torque),
        (Quantity::Work, sample.energy.work),
        (Quantity::KineticEnergy, sample.energy.kinetic),
        (Quantity::InternalEnergy, sample.energy.internal()),
    ];
    let wires = sample.wire_stress.iter().enumerate();
    let wires = wires.map(|(w, stress)| (Quantity::WireStress { wire: w + 1 }, *stress));
    named.into_iter().chain(wires).find(|(_, value)| !value.is_finite()).map(|(quantity, _)| quantity)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::view::Energy;
    use crate::strand::test_specs;

    fn limits() -> TimeSpec {
        TimeSpec { kinetic_limit: 0.05, mismatch_limit: 0.02, ..test_specs::empty().time }
    }

    fn row(kinetic: f64, internal: f64, force: [f64; 2]) -> Sample {
        let energy = Energy { work: kinetic + internal, kinetic, plastic_bonds: internal, ..Energy::default() };
        Sample { energy, grip_force: force, ..Sample::default() }
    }

    fn new() -> Guard {
        Guard { gripped: true, negligible: 1e-9, ..Guard::new(&limits()) }
    }

    fn gripped(rows: &[Sample]) -> Guard {
        let mut guard = new();
        rows.iter().for_each(|row| guard.row(row).unwrap());
        guard
    }

    /// Texts of all notices at the end of the run.
    fn said(guard: &mut Guard) -> Vec<String> {
        guard.finish(true);
        guard.take_notices().iter().map(Notice::to_string).collect()
    }

    #[test]
    fn a_slow_pull_raises_no_warning() {
        // The first row has kinetic energy and no internal energy, as every pull has.
        let mut guard =
            gripped(&[row(1.0, 0.0, [0.0, 0.0]), row(1.0, 50.0, [99.0, 100.0]), row(1.0, 100.0, [100.0, 100.0])]);
        assert_eq!(guard.quasi_static().kinetic_over_internal_max, Some(0.02));
        assert_eq!(guard.quasi_static().grip_force_mismatch_percent, Some(1.0));
        assert_eq!(said(&mut guard), Vec::<String>::new());
    }

    #[test]
    fn a_run_of_any_length_needs_no_more_memory() {
        let mut guard = new();
        let mut size = 0;
        for k in 0..200_000 {
            // The ratio falls as the internal energy grows, so that no row stands for all.
            let internal = 1.0 + f64::from(k) * 1e-2;
            guard.row(&row(1.0, internal, [1.0, 1.1])).unwrap();
            if k == 100_000 {
                size = guard.seen.all.kinetic.len();
            }
        }
        assert!(guard.seen.all.kinetic.len() <= size + 8 && size < 300, "{size}");
        let least = LEAST_INTERNAL_SHARE * 2001.0;
        let found = guard.quasi_static().kinetic_over_internal_max.unwrap();
        assert!((1.0 / (1.017 * least)..=1.0 / least).contains(&found), "{found}");
    }

    #[test]
    fn a_pull_that_was_cut_short_is_not_judged_by_its_first_rows() {
        let mut guard = Guard { strain_end: 0.2, ..new() };
        guard.row(&Sample { strain: 0.01, ..row(10.0, 100.0, [90.0, 100.0]) }).unwrap();
        guard.finish(false);
        assert_eq!(guard.take_notices(), []);
    }

    #[test]
    fn the_first_passages_of_a_wave_are_not_judged() {
        let mut guard = Guard { passage: 1e-5, ..new() };
        guard.row(&Sample { time: 9e-5, ..row(49_200.0, 100.0, [0.0, 100.0]) }).unwrap();
        assert_eq!(guard.quasi_static(), QuasiStatic::default());
        guard.row(&Sample { time: 1.1e-4, ..row(1.0, 100.0, [100.0, 100.0]) }).unwrap();
        assert_eq!(guard.quasi_static().kinetic_over_internal_max, Some(0.01));
        assert_eq!(said(&mut guard), Vec::<String>::new());
    }

    #[test]
    fn a_run_that_ends_within_the_first_passages_is_said_to_be_too_short() {
        let mut guard = Guard { passage: 1e-5, ..new() };
        guard.row(&Sample { time: 4.2e-5, ..row(10.0, 100.0, [90.0, 100.0]) }).unwrap();
        let warnings = said(&mut guard);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(warnings[0].contains("4.2 passages"), "{warnings:?}");
    }

    #[test]
    fn a_fast_pull_is_said_to_be_fast() {
        let mut guard = gripped(&[row(10.0, 100.0, [90.0, 100.0])]);
        let warnings = said(&mut guard);
        assert_eq!(warnings.len(), 2, "{warnings:?}");
        assert_eq!(said(&mut guard).len(), 0, "each is said once");
        assert!(warnings[0].contains("time.kinetic_limit") && warnings[1].contains("time.mismatch_limit"));
    }

    #[test]
    fn what_a_rupture_throws_about_counts_for_the_whole_run_only() {
        let mut guard = gripped(&[row(1.0, 100.0, [100.0, 100.0])]);
        let mut after = row(20.0, 100.0, [50.0, 100.0]);
        after.bonds_broken = 1;
        guard.row(&after).unwrap();
        let seen = guard.quasi_static();
        assert_eq!((seen.kinetic_over_internal_max, seen.kinetic_over_internal_overall), (Some(0.01), Some(0.2)));
        assert_eq!(seen.grip_force_mismatch_percent, Some(0.0));
        assert_eq!(seen.grip_force_mismatch_overall_percent, Some(50.0));
    }

    #[test]
    fn a_row_late_in_the_pull_is_judged_at_once() {
        let mut guard = Guard { strain_end: 0.2, ..new() };
        guard.row(&Sample { strain: 0.04, ..row(10.0, 100.0, [100.0, 100.0]) }).unwrap();
        assert_eq!(guard.take_notices(), [], "an early row may still turn out to say nothing");
        guard.row(&Sample { step: 9, strain: 0.06, ..row(10.0, 100.0, [100.0, 100.0]) }).unwrap();
        let notices = guard.take_notices();
        assert_eq!((notices.len(), notices[0].at.step), (1, 9));
        assert_eq!(notices[0].finding, Finding::KineticEnergy { over_internal: 0.1, limit: 0.05 });
    }

    #[test]
    fn an_open_ledger_is_said_to_be_open_and_a_wide_open_one_stops_the_run() {
        let mut open = row(0.0, 100.0, [1.0, 1.0]);
        open.energy.work = 102.0;
        let warnings = said(&mut gripped(&[open.clone(), open.clone()]));
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(warnings[0].contains("1.96 % of the work done, have vanished"), "{warnings:?}");
        open.energy.work = 70.0;
        let error = new().row(&open).unwrap_err();
        assert!(error.to_string().contains("42.86 % of the work done, came from nowhere"), "{error}");
        assert_eq!(error.exit_code(), 4);
    }

    #[test]
    fn an_open_ledger_is_told_again_at_its_worst() {
        let open = |step, work| {
            let row = row(0.0, 100.0, [1.0, 1.0]);
            Sample { step, energy: Energy { work, ..row.energy }, ..row }
        };
        let mut guard = gripped(&[open(1, 102.0), open(2, 110.0), open(3, 105.0)]);
        assert_eq!(guard.take_notices()[0].at.step, 1);
        let worst = guard.take_worse();
        assert_eq!((worst.len(), worst[0].at.step), (1, 2));
        assert!(worst[0].to_string().contains("9.09 % of the work done"), "{worst:?}");
    }

    #[test]
    fn a_motion_that_turns_round_at_every_step_stops_the_run() {
        let energy = Energy { work: 1.0, kinetic: -19.0, elastic_bonds: 20.0, ..Energy::default() };
        let error = new().row(&Sample { energy, ..Sample::default() }).unwrap_err();
        assert!(error.to_string().contains("not stable"), "{error}");
    }

    #[test]
    fn rounding_in_a_body_at_rest_is_no_open_ledger() {
        let energy = Energy { work: 1e-20, elastic_bonds: 3e-20, ..Energy::default() };
        let mut guard = gripped(&[Sample { energy, ..Sample::default() }]);
        assert_eq!((said(&mut guard), guard.greatest_residual()), (Vec::new(), None));
    }

    #[test]
    fn a_value_that_is_not_finite_stops_the_run_and_is_named() {
        let wild = Sample { step: 7, wire_stress: vec![1.0, f64::NAN], ..Sample::default() };
        let error = new().check(&wild).unwrap_err();
        assert_eq!(error.exit_code(), 4);
        assert_eq!(error.to_string(), "stopped at step 7: the stress of wire 2 is not a finite number");
    }
}
