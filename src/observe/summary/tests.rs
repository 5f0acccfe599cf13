use super::*;
use crate::base::finding::{Failure, Quantity};
use crate::engine::view::{RuptureCause, WireInfo};
use crate::observe::peaks::Peak;

fn info() -> Arc<RunInfo> {
    let wire = |layer| WireInfo { layer, material: 0, first: 0, len: 2, diameter: 0.4 };
    Arc::new(RunInfo {
        name: "two layers".into(),
        about: String::new(),
        layers: vec!["core".into(), "outer".into()],
        materials: vec!["default".into()],
        sphere_material: Vec::new(),
        wires: vec![wire(0), wire(1), wire(1)],
        wire_particles: 6,
        particles: 6,
        bodies: Vec::new(),
        radius: vec![0.2; 6],
        rest_position: vec![[0.0; 3]; 6],
        gauge: Some([10.0, 110.0]),
        stress_range: [0.0, 400.0],
        plastic_strain_range: [0.0, 0.3],
        speed_range: [0.0, 10.0],
        contact_pressure_range: [0.0, 1.0],
        strain_end: Some(0.3),
        body_stress_end: None,
        negligible_energy: 1e-12,
        wave_passage: 3e-5,
    })
}

fn rupture(order: usize, wire: usize, layer: usize) -> Rupture {
    Rupture {
        order,
        step: 10,
        time: 0.0,
        strain: 0.25,
        wire,
        layer,
        bond: 0,
        bond_in_wire: 0,
        position: [0.0, 0.0, 0.0657],
        rest_z: 0.05,
        cause: RuptureCause::PlasticStrain,
        stress: 294e6,
        body_stress: 300e6,
        first_of_wire: true,
    }
}

fn row(strain: f64, stress: f64) -> Sample {
    let energy = Energy { work: 2.0, elastic_bonds: 1.0, kinetic: 0.5, ..Energy::default() };
    Sample { strain, stress, energy, ..Sample::default() }
}

fn spec() -> Spec {
    // Only its name, seed and limits are read; any scene will do.
    crate::scene::load("single-wire", &[]).unwrap().spec
}

fn seen() -> Summariser {
    let mut summariser = Summariser::new();
    summariser.start(&info()).unwrap();
    for (strain, stress) in [(0.0, 0.0), (0.1, 250e6), (0.2, 300e6)] {
        summariser.sample(&row(strain, stress)).unwrap();
    }
    for (order, wire, layer) in [(1, 2, 1), (2, 0, 0), (3, 2, 1)] {
        summariser.rupture(&rupture(order, wire, layer)).unwrap();
    }
    summariser.sample(&row(0.3, 200e6)).unwrap();
    summariser
}

fn close(value: Option<f64>, right: f64) {
    let value = value.expect("there is a value");
    assert!((value - right).abs() < 1e-9 * right.abs(), "{value} is not {right}");
}

#[test]
fn strength_and_elongations_are_read_from_the_curve() {
    let summary = seen().summary(&spec(), 3, Closing::default());
    close(summary.tensile_strength_mpa, 300.0);
    close(summary.fracture_elongation_percent, 20.0);
    // 240 MPa lies 60 % of the way from (20 %, 300 MPa) to (30 %, 200 MPa).
    close(summary.elongation_at_20_percent_drop_percent, 26.0);
    close(summary.residual_stress_mpa, 200.0);
    close(summary.energy_residual_percent, 25.0);
}

#[test]
fn a_wire_that_breaks_twice_is_one_broken_wire() {
    let summary = seen().summary(&spec(), 3, Closing::default());
    assert_eq!(summary.wires_broken, 2);
    assert_eq!(summary.bonds_broken, 3);
    assert_eq!(summary.wires_broken_by_layer["core"], BrokenOf { broken: 1, of: 1 });
    assert_eq!(summary.wires_broken_by_layer["outer"], BrokenOf { broken: 1, of: 2 });
    let first = summary.first_rupture.unwrap();
    assert_eq!((first.wire, first.layer.as_str(), first.order), (3, "outer", 1));
    assert!((first.z_mm - 65.7).abs() < 1e-9);
    assert_eq!(summary.breaks_by_layer["outer"].len(), 1);
}

#[test]
fn what_was_seen_at_every_step_counts_rather_than_the_rows() {
    let mut summariser = seen();
    let peak = Peak { stress: 301e6, strain: 0.21 };
    let compression = Some(Peak { stress: -5e6, strain: 0.3 });
    let peaks = Peaks { tension: Some(peak), compression, drop: Some(0.25), wires: Vec::new() };
    summariser.peaks(&peaks).unwrap();
    let summary = summariser.summary(&spec(), 3, Closing::default());
    close(summary.tensile_strength_mpa, 301.0);
    close(summary.fracture_elongation_percent, 21.0);
    close(summary.elongation_at_20_percent_drop_percent, 25.0);
    assert_eq!(summary.compressive_peak_mpa, None, "a pulled body that springs back was not pushed");
}

#[test]
fn a_body_that_did_not_fail_has_a_greatest_stress_and_no_strength() {
    let mut summariser = Summariser::new();
    summariser.start(&info()).unwrap();
    for (strain, stress) in [(0.0, 0.0), (0.1, 250e6), (0.2, 300e6), (0.21, 250e6)] {
        summariser.sample(&row(strain, stress)).unwrap();
    }
    summariser.rupture(&rupture(1, 2, 1)).unwrap();
    let summary = summariser.summary(&spec(), 3, Closing::default());
    assert_eq!((summary.tensile_strength_mpa, summary.fracture_elongation_percent), (None, None));
    close(summary.greatest_stress_mpa, 300.0);
    close(summary.strain_at_greatest_stress_percent, 20.0);
}

#[test]
fn a_body_that_is_pushed_has_a_compressive_peak() {
    let spec = crate::scene::load("single-wire", &["grip.speed=-1 m/s".into()]).unwrap().spec;
    let mut summariser = Summariser::new();
    summariser.start(&info()).unwrap();
    for (strain, stress) in [(0.0, 0.0), (-0.001, -97e6), (-0.006, 18e6)] {
        summariser.sample(&row(strain, stress)).unwrap();
    }
    let summary = summariser.summary(&spec, 3, Closing::default());
    close(summary.compressive_peak_mpa, -97.0);
    close(summary.strain_at_compressive_peak_percent, -0.1);
    assert_eq!((summary.tensile_strength_mpa, summary.greatest_stress_mpa), (None, None));
}

#[test]
fn rounding_errors_have_no_ratio() {
    let mut summariser = Summariser::new();
    summariser.start(&info()).unwrap();
    let energy = Energy { work: 1e-24, elastic_bonds: 4e-20, ..Energy::default() };
    summariser.sample(&Sample { energy, ..Sample::default() }).unwrap();
    assert_eq!(summariser.summary(&spec(), 3, Closing::default()).energy_residual_percent, None);
}

#[test]
fn free_bodies_have_no_strength() {
    let mut summariser = Summariser::new();
    summariser.start(&Arc::new(RunInfo { gauge: None, ..info().as_ref().clone() })).unwrap();
    summariser.sample(&row(0.0, 0.0)).unwrap();
    let summary = summariser.summary(&spec(), 3, Closing::default());
    assert_eq!(summary.tensile_strength_mpa, None);
    assert_eq!(summary.quasi_static, QuasiStatic::default());
    let json: serde_json::Value = serde_json::to_value(&summary).unwrap();
    assert!(json["tensile_strength_mpa"].is_null() && json["kinetic_over_internal_max"].is_null());
}

#[test]
fn findings_stand_in_the_order_of_their_steps_and_at_their_worst_as_the_warnings_do() {
    let notice = |step, finding| Notice { at: Instant { step, time: 0.0, strain: None }, finding };
    let open = |over_work| Finding::LedgerOpen { missing_j: 1.0, over_work };
    let mut summariser = seen();
    let short = Finding::BondsStretched { stretch: 4.0, covered: 3.0 };
    for notice in [notice(3, open(0.02)), notice(9, short), notice(7, open(0.1))] {
        summariser.notice(&notice).unwrap();
    }
    let summary = summariser.summary(&spec(), 3, Closing::default());
    assert_eq!(summary.findings.iter().map(|found| found.step).collect::<Vec<_>>(), [7, 9]);
    assert_eq!(summary.findings[0].finding, open(0.1));
    assert!(summary.warnings[0].contains("10.00 %") && summary.warnings[1].contains("4.0 times"));
}

#[test]
fn an_error_that_is_no_failure_is_the_reason_too() {
    let closing = Closing { stopped: StopReason::Failed, error: Some("cannot write x".into()), ..Closing::default() };
    let summary = seen().summary(&spec(), 3, closing);
    assert_eq!(summary.stopped_because, "an error ended it: cannot write x");
}

#[test]
fn a_failure_stands_first_among_the_warnings() {
    let at = Instant { step: 5, time: 0.0, strain: Some(0.1) };
    let failure = Failure::NotFinite { quantity: Quantity::Torque };
    let mut summariser = seen();
    for finding in [Finding::TooShort { passages: 1.0, start: 10.0 }, Finding::Failed { failure }] {
        summariser.notice(&Notice { at, finding }).unwrap();
    }
    let closing = Closing { stopped: StopReason::Failed, ..Closing::default() };
    let summary = summariser.summary(&spec(), 3, closing);
    assert_eq!(summary.warnings[0], "stopped at step 5: the torque is not a finite number");
    assert_eq!((summary.warnings.len(), summary.findings.len()), (2, 2));
    assert_eq!(summary.findings[0].strain_percent, Some(10.0));
    assert_eq!(summary.stopped_because, "the simulation failed at step 5: the torque is not a finite number");
    let json = serde_json::to_value(&summary).unwrap();
    assert_eq!(json["findings"][0]["failure"]["quantity"]["name"], "torque");
    assert_eq!(serde_json::from_value::<RunSummary>(json).unwrap(), summary);
}
