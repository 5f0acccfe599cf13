//! The initial stiffness of a pull: a straight line through the elastic rows of its curve, beside what strand theory expects.

use crate::base::finding::{Finding, StiffnessCause};
use crate::base::units::{gpa, percent};
use crate::engine::estimates;
use crate::engine::view::Sample;
use crate::scene::spec::{BondLawSpec, OneMaterial, RuptureCriterion, Shape, Spec};
use crate::strand::theory::Theory;
use serde::{Deserialize, Serialize};

/// Deviation from strand theory from which a run warns (-).
pub const LIMIT: f64 = 0.05;
/// Rows are used from this many passages of an elastic wave along the body on (-): the pull has settled, and whatever
/// smooths the forces over a fraction of a passage with it.
const PASSAGES: f64 = 2.0;
/// Rows are used up to this share of the strain at which wires yield or break (-): bending strains their outermost fibres
/// a little more.
const ELASTIC: f64 = 0.8;
/// And up to this strain (-): log strain takes 0.5 % off a line by then.
const SMALL: f64 = 5e-3;
/// Rows that make a line.
const LEAST_ROWS: usize = 4;

/// Stiffness expected and measured, ends held.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stiffness {
    /// Nominal modulus by strand theory: force per strain over the wires' sections (GPa).
    pub expected_gpa: f64,
    /// Slope of nominal stress over strain in the window (GPa); `None` when it could not be measured.
    pub measured_gpa: Option<f64>,
    /// Measured against expected (%).
    pub deviation_percent: Option<f64>,
    /// Torque that holds the ends over strain, by strand theory with the extensible rod's twist (N m).
    pub expected_torque_n_m: f64,
    /// Slope of the torque over strain in the window, same sign as the row's (N m).
    pub measured_torque_n_m: Option<f64>,
    /// The window: strains between which rows are used (%).
    pub window_percent: [f64; 2],
    /// Rows in it.
    pub rows: usize,
    /// Why nothing was measured.
    pub not_measured: Option<NotMeasured>,
}

/// Why the curve has no elastic part to measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NotMeasured {
    /// Loose layers close in only after wires have yielded.
    LayersClose,
    /// Wires yield before an elastic wave has passed often enough.
    WavesPass,
    /// Too few rows in the window.
    FewRows,
}

/// A row of the curve as far as it matters here.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Simulated time (s).
    pub time: f64,
    /// Strain (-).
    pub strain: f64,
    /// Nominal stress (Pa).
    pub stress: f64,
    /// Torque (N m).
    pub torque: f64,
}

/// Collects the rows that can matter: small strain, nothing broken.
#[derive(Debug, Default)]
pub struct Rows(Vec<Row>);

impl Rows {
    /// Takes in a row.
    pub fn add(&mut self, sample: &Sample) {
        // Also beyond the elastic range: only there it may show when the waves have passed.
        if sample.bonds_broken == 0 {
            let Sample { time, strain, stress, torque, .. } = *sample;
            self.0.push(Row { time, strain, stress, torque });
        }
    }

    /// The stiffness of the pull that `spec` describes; `None` when strand theory has nothing to say about it.
    pub fn stiffness(&self, spec: &Spec) -> Option<Stiffness> {
        measure(&self.0, spec)
    }
}

/// The same from rows in order, none of them after a rupture.
pub fn measure(rows: &[Row], spec: &Spec) -> Option<Stiffness> {
    let theory = Theory::of_pull(spec)?;
    let settled = PASSAGES * passage(spec)?;
    let passed = rows.iter().find(|row| row.time >= settled).map_or(f64::INFINITY, |row| row.strain);
    let window = [passed.max(theory.closing_strain), elastic_strain(spec)];
    let inside: Vec<Row> = rows.iter().filter(|r| window[0] <= r.strain && r.strain <= window[1]).copied().collect();
    let not_measured = if passed.is_finite() && window[0] >= window[1] {
        Some(if passed >= theory.closing_strain { NotMeasured::WavesPass } else { NotMeasured::LayersClose })
    } else {
        (inside.len() < LEAST_ROWS).then_some(NotMeasured::FewRows)
    };
    let slope = |of: fn(&Row) -> f64| not_measured.is_none().then(|| slope(&inside, of));
    let measured = slope(|row| row.stress);
    let expected = theory.modulus();
    // A run that ended before the wave had passed has no strain to show for it.
    let to = if not_measured.is_none() { inside[inside.len() - 1].strain } else { window[1] };
    let from = if window[0].is_finite() { window[0] } else { rows.last().map_or(0.0, |row| row.strain) };
    Some(Stiffness {
        expected_gpa: gpa(expected),
        measured_gpa: measured.map(gpa),
        deviation_percent: measured.map(|m| percent(m / expected - 1.0)),
        expected_torque_n_m: theory.wrench.torque,
        measured_torque_n_m: slope(|row| row.torque),
        window_percent: [percent(from), percent(to)],
        rows: inside.len(),
        not_measured,
    })
}

/// Time in which an elastic wave runs along the body (s).
pub fn passage(spec: &Spec) -> Option<f64> {
    let length = match (&spec.strand, spec.wires.first().map(|wire| &wire.path)) {
        (Some(strand), _) => strand.length,
        (None, Some(crate::scene::spec::PathSpec::Straight { from, to })) => from.distance(*to),
        _ => return None,
    };
    Some(estimates::passage(spec, length))
}

/// Strain up to which rows are elastic (-).
fn elastic_strain(spec: &Spec) -> f64 {
    spec.materials().map(elastic_strain_of).fold(f64::INFINITY, f64::min)
}

/// The same of one material.
fn elastic_strain_of(one: OneMaterial) -> f64 {
    let young = one.material.young;
    let yields = match &one.bond.law {
        BondLawSpec::Elastic => f64::INFINITY,
        BondLawSpec::ElastoPlastic(hardening) => hardening.stress(0.0) / young,
    };
    let breaks = match one.bond.rupture.as_ref().map(|r| &r.criterion) {
        Some(RuptureCriterion::BeamStress { tensile, .. }) => tensile / young,
        Some(RuptureCriterion::FibreStrain { strain }) => *strain,
        Some(RuptureCriterion::PlasticStrain { .. }) | None => f64::INFINITY,
    };
    SMALL.min(ELASTIC * yields.min(breaks))
}

/// Slope of the least-squares line of `of` over strain.
fn slope(rows: &[Row], of: fn(&Row) -> f64) -> f64 {
    let n = rows.len() as f64;
    let mean = |value: &dyn Fn(&Row) -> f64| rows.iter().map(value).sum::<f64>() / n;
    let (x, y) = (mean(&|row| row.strain), mean(&of));
    let both: f64 = rows.iter().map(|row| (row.strain - x) * (of(row) - y)).sum();
    both / rows.iter().map(|row| (row.strain - x).powi(2)).sum::<f64>()
}

impl Stiffness {
    /// Whether the measured value is off by [`LIMIT`] or more.
    fn is_off(&self) -> bool {
        self.deviation_percent.is_some_and(|deviation| deviation.abs() >= percent(LIMIT))
    }

    /// Both values in words, for the report.
    pub fn words(&self) -> String {
        let [from, to] = self.window_percent;
        let expected = format!("{:.1} GPa by strand theory", self.expected_gpa);
        match (self.measured_gpa, self.deviation_percent, self.not_measured) {
            (Some(measured), Some(deviation), _) => {
                format!(
                    "{expected}, {measured:.1} GPa measured ({deviation:+.1} %, {} rows, {from:.3} to {to:.3} %)",
                    self.rows
                )
            }
            (_, _, Some(why)) => format!("{expected}; not measured: {}", why.words(from, to)),
            _ => expected,
        }
    }

    /// What is found when the curve is too far from theory; `spec` tells what may be behind it.
    pub fn finding(&self, spec: &Spec) -> Option<Finding> {
        let (Some(measured), Some(deviation), true) = (self.measured_gpa, self.deviation_percent, self.is_off()) else {
            return None;
        };
        let spheres = spec.contact.as_ref().is_some_and(|c| c.shape == Shape::Sphere);
        let cause = match (deviation < 0.0, spheres) {
            (true, true) => StiffnessCause::Spheres,
            (true, false) => StiffnessCause::Soft,
            (false, _) => StiffnessCause::Stiff,
        };
        Some(Finding::Stiffness {
            expected_pa: 1e9 * self.expected_gpa,
            measured_pa: 1e9 * measured,
            deviation: 1e-2 * deviation,
            window: self.window_percent.map(|percent| 1e-2 * percent),
            cause,
        })
    }
}

impl NotMeasured {
    /// The reason in short.
    pub fn word(self) -> &'static str {
        match self {
            NotMeasured::LayersClose => "loose layers close in after the elastic range",
            NotMeasured::WavesPass => "the elastic range ends before two elastic waves have passed",
            NotMeasured::FewRows => "there are too few rows in the elastic range",
        }
    }

    /// The reason in words; `from` and `to` are the window (%).
    pub fn words(self, from: f64, to: f64) -> String {
        match self {
            NotMeasured::LayersClose => {
                format!("loose layers close in at {from:.3} %, wires yield or break from {to:.3} %")
            }
            NotMeasured::WavesPass => {
                format!("strain is {from:.3} % when two elastic waves have passed, the elastic range ends at {to:.3} %")
            }
            NotMeasured::FewRows => format!("too few rows between {from:.3} and {to:.3} %"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `strand-1x7` made elastic, so that its elastic range is wide.
    fn spec(set: &[&str]) -> Spec {
        let elastic = [
            "bond.law=elastic",
            "bond.hardening=",
            "bond.rupture=",
            "contact.hardness_factor=",
            "contact.hardness_strain=",
            "contact.limiting_pressure=280 MPa",
            "stop.stress_fraction=",
        ];
        let set: Vec<String> = elastic.iter().chain(set).map(ToString::to_string).collect();
        crate::scene::load("strand-1x7", &set).unwrap_or_else(|e| panic!("{e:?}")).spec
    }

    /// Rows of a pull at 2.5 m/s of a gauge of 50 mm whose stress follows `stress`.
    fn rows(stress: impl Fn(f64) -> f64) -> Vec<Row> {
        slow_rows(1.0, stress)
    }

    /// The same at a fraction of the speed.
    fn slow_rows(slower: f64, stress: impl Fn(f64) -> f64) -> Vec<Row> {
        (0..100)
            .map(|k| {
                let strain = 5e-5 * f64::from(k);
                Row { time: slower * strain * 50e-3 / 2.5, strain, stress: stress(strain), torque: -2.0 * strain }
            })
            .collect()
    }

    #[test]
    fn the_slope_is_that_of_the_rows_whatever_came_before() {
        let spec = spec(&[]);
        let expected = Theory::of_pull(&spec).unwrap().modulus();
        // An early part that lags, as filters make it, and then the right slope.
        let found = measure(&rows(|e| expected * (e - 5e-4).max(0.0)), &spec).unwrap();
        assert!(found.deviation_percent.unwrap().abs() < 1e-6, "{found:?}");
        assert!((found.measured_torque_n_m.unwrap() + 2.0).abs() < 1e-9);
        assert_eq!((found.not_measured, found.finding(&spec)), (None, None));
        // Two passages of a wave: 2 × 60 mm / 3583 m/s, 0.167 % at 2.5 m/s.
        assert!((found.window_percent[0] - 0.17).abs() < 0.006, "{found:?}");
        assert!(found.words().contains("+0.0 %") || found.words().contains("-0.0 %"), "{}", found.words());
    }

    #[test]
    fn from_five_per_cent_on_it_warns_and_names_the_shape() {
        let spec = spec(&[]);
        let expected = Theory::of_pull(&spec).unwrap().modulus();
        let at = |share: f64| measure(&rows(|e| share * expected * e), &spec).unwrap();
        assert_eq!(at(0.951).finding(&spec), None);
        for (share, expected) in [(0.60, StiffnessCause::Spheres), (1.10, StiffnessCause::Stiff)] {
            let Some(Finding::Stiffness { deviation, cause, .. }) = at(share).finding(&spec) else { panic!("{share}") };
            assert!((deviation - (share - 1.0)).abs() < 1e-6 && cause == expected, "{deviation} {cause:?}");
        }
    }

    #[test]
    fn what_cannot_be_measured_says_why() {
        let ka4 = crate::scene::load("ka4", &[]).unwrap().spec;
        let found = measure(&slow_rows(50.0, |e| 26e9 * e), &ka4).unwrap();
        assert_eq!((found.not_measured, found.measured_gpa), (Some(NotMeasured::LayersClose), None));
        assert_eq!(found.finding(&ka4), None);
        assert!(found.words().contains("loose layers close in at 0.072 %"), "{}", found.words());
        let plastic = crate::scene::load("strand-1x7", &[]).unwrap().spec;
        assert_eq!(measure(&rows(|e| e), &plastic).unwrap().not_measured, Some(NotMeasured::WavesPass));
        assert_eq!(measure(&rows(|e| e)[..2], &spec(&[])).unwrap().not_measured, Some(NotMeasured::FewRows));
    }

    /// Pulled so fast that the waves have passed only beyond the strains that are looked at.
    #[test]
    fn waves_that_pass_late_are_the_reason_not_few_rows() {
        let spec = spec(&[]);
        let mut kept = Rows::default();
        // Two passages take 33.5 µs: at 1 % of strain, where the body has long left its elastic range.
        for k in 0..=100 {
            kept.add(&Sample { time: 1e-6 * f64::from(k), strain: 3e-4 * f64::from(k), ..Sample::default() });
        }
        let found = kept.stiffness(&spec).unwrap();
        assert_eq!(found.not_measured, Some(NotMeasured::WavesPass), "{found:?}");
        assert!((found.window_percent[0] - 1.02).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn rows_after_a_rupture_do_not_count() {
        let mut kept = Rows::default();
        kept.add(&Sample { strain: 1e-3, ..Sample::default() });
        kept.add(&Sample { strain: 2e-3, bonds_broken: 1, ..Sample::default() });
        kept.add(&Sample { strain: 2e-2, bonds_broken: 1, ..Sample::default() });
        assert_eq!(kept.0.len(), 1);
    }
}
