//! What an engine shows of its state is that state: means over their window, names, snapshots, pressures.

#[path = "common/drive.rs"]
mod drive;

use drive::*;
use strandsnap::base::finding::{Body, Member};
use strandsnap::engine::measure::MEAN_LAG;
use strandsnap::engine::view::BondState;

const YOUNG: f64 = 115e9;
const DENSITY: f64 = 8960.0;

/// An elastic wire of 10 mm, pulled at 5 m/s.
const WIRE: &str = r#"
about = "An elastic wire that is pulled."
[material]
density = "8960 kg/m^3"
young = "115 GPa"
poisson = 0.34
[bond]
law = "elastic"
[[wire]]
diameter = "0.4 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "10 mm"]
[grip]
length = "1 mm"
speed = "5 m/s"
[stop]
strain = "1 %"
"#;

/// Strain is the mean over the steps of the last eighth of an elastic wave's passage, all of the same length, each counted
/// where it began: the forces of a step are those of its start.
#[test]
fn strain_lags_by_half_its_window() {
    let mut engine = engine(WIRE, &["grip.length=1.2 mm"]);
    let last = engine.assembly().len() - 1;
    let z: Vec<f64> = (0..=last).map(|p| engine.assembly().position.get(p).z).collect();
    // Between the innermost particles that the grips hold; particles lie 0.4 mm apart.
    let low = z.iter().copied().filter(|z| *z < 1.2e-3 + 1e-9).fold(0.0, f64::max);
    let high = z.iter().copied().filter(|z| *z > 8.8e-3 - 1e-9).fold(f64::MAX, f64::min);
    let dt = engine.time_step();
    let passage = 10e-3 / (YOUNG / DENSITY).sqrt();
    let window = (0.125 * passage / dt).ceil() as usize;
    let lag = 0.5 * (window as f64 + 1.0) * dt;
    assert!((MEAN_LAG * passage - lag).abs() <= dt, "{MEAN_LAG} of a passage is not {lag} s");
    assert!(window > 3, "a window of {window} steps shows nothing");
    let mut strains = Vec::new();
    for _ in 0..10 * window {
        engine.step().unwrap();
        assert_eq!(engine.time_step(), dt);
        let state = engine.state();
        strains.push((state.x.get(last).z - state.x.get(0).z - (z[last] - z[0])) / (high - low));
        if let Some(first) = strains.len().checked_sub(window + 1) {
            let mean = strains[first..first + window].iter().sum::<f64>() / window as f64;
            assert!((engine.strain() / mean - 1.0).abs() < 1e-6, "{} instead of {mean}", engine.strain());
        }
    }
}

/// A saved engine goes on as the one that it was saved from; another body's engine refuses it.
#[test]
fn what_was_measured_is_saved() {
    let mut whole = engine(STRAND, &[]);
    run_steps(&mut whole, 50);
    let bytes = whole.save();
    let mut other = engine(STRAND, &[]);
    other.restore(&bytes).unwrap_or_else(|unfit| panic!("{unfit:?}"));
    for _ in 0..20 {
        assert_eq!(other.sample(), whole.sample());
        run_steps(&mut whole, 1);
        run_steps(&mut other, 1);
    }
    assert!(engine(WIRE, &[]).restore(&bytes).is_err());
}

/// Hooke's law of a wire whose waves have passed a hundred times, in every measure of it.
#[test]
fn forces_and_stresses_of_a_pulled_wire_are_those_of_its_section() {
    let mut engine = engine(WIRE, &["grip.speed=0.5 m/s", "bond.damping=0.1"]);
    run_to(&mut engine, 100.0 * 10e-3 / (YOUNG / DENSITY).sqrt());
    let sample = engine.sample();
    let (stress, area) = (YOUNG * sample.strain, std::f64::consts::PI * 0.2e-3 * 0.2e-3);
    for (value, expected) in [
        (sample.stress, stress),
        (sample.wire_stress[0], stress),
        (sample.layer_stress[0], stress),
        (sample.grip_force[0], stress * area),
        (sample.grip_force[1], stress * area),
    ] {
        assert!((value / expected - 1.0).abs() < 0.03, "{value} instead of {expected}");
    }
    let energy = engine.energy();
    let stored = 0.5 * stress * sample.strain * area * 8e-3;
    assert!((energy.elastic_bonds / stored - 1.0).abs() < 0.12, "{} instead of {stored}", energy.elastic_bonds);
    assert_eq!((sample.torque, sample.contacts, sample.wires_broken, sample.bonds_broken), (0.0, 0, 0, 0));
    assert_eq!(sample.step, engine.steps());
    assert_eq!((sample.time, sample.time_step, sample.energy), (engine.time(), engine.time_step(), energy));
}

#[test]
fn a_layer_has_the_mean_stress_of_its_wires_and_broken_wires_are_counted_once() {
    let mut engine = engine(STRAND, &[]);
    let mut ruptures = Vec::new();
    while ruptures.len() < 10 {
        engine.step().unwrap();
        ruptures.extend(engine.take_ruptures());
    }
    let sample = engine.sample();
    assert_eq!(sample.layer_stress[0], sample.wire_stress[0]);
    let mean = sample.wire_stress[1..7].iter().sum::<f64>() / 6.0;
    assert!((sample.layer_stress[1] / mean - 1.0).abs() < 1e-12, "{} instead of {mean}", sample.layer_stress[1]);
    let wires: std::collections::BTreeSet<usize> = ruptures.iter().map(|rupture| rupture.wire).collect();
    assert_eq!((sample.wires_broken, sample.bonds_broken), (wires.len(), ruptures.len()));
    assert!(sample.contacts > 0);
    // Bonds scatter, so that the two ends differ; stress is the upper one's over the sections of seven wires.
    let [lower, upper] = sample.grip_force;
    let expected = upper / (7.0 * std::f64::consts::PI * 0.195e-3 * 0.195e-3);
    assert!((sample.stress / expected - 1.0).abs() < 1e-12, "{} instead of {expected}", sample.stress);
    assert!((lower / upper - 1.0).abs() > 1e-6, "{lower} {upper}");
}

/// Every particle and bond of a snapshot against the state that it shows.
#[test]
fn a_snapshot_is_the_state() {
    let mut engine = engine(STRAND, &[]);
    let mut broken = 0;
    while broken < 5 {
        engine.step().unwrap();
        broken += engine.take_ruptures().len();
    }
    let (shown, state, assembly) = (engine.snapshot(), engine.state(), engine.assembly());
    for i in 0..state.len() {
        assert_eq!(shown.position[i], state.x.get(i).as_vec3().to_array());
        assert_eq!(shown.radius[i], state.radius[i] as f32);
        assert_eq!(shown.speed[i], state.v.get(i).length() as f32);
        let expected = match (assembly.is_bond(i), state.whole[i], shown.plastic_strain[i] > 0.0) {
            (false, ..) => BondState::Absent,
            (true, false, _) => BondState::Broken,
            (true, true, true) => BondState::Yielding,
            (true, true, false) => BondState::Whole,
        };
        assert_eq!(shown.bond_state[i], expected, "slot {i}");
        match expected {
            BondState::Absent => {
                assert_eq!([shown.plastic_strain[i], shown.utilisation[i], shown.bond_stress[i]], [0.0; 3]);
            }
            BondState::Broken => assert_eq!([shown.utilisation[i], shown.bond_stress[i]], [1.0, 0.0]),
            BondState::Yielding | BondState::Whole => assert!((0.0..1.0).contains(&shown.utilisation[i])),
        }
    }
    let count = |kind| shown.bond_state.iter().filter(|state| **state == kind).count();
    assert_eq!(count(BondState::Broken), broken);
    assert_eq!(count(BondState::Absent), 7, "behind the last particle of each wire");
    assert!(count(BondState::Yielding) > 100);
    let fastest = shown.speed.iter().copied().fold(0.0, f32::max);
    assert_eq!(engine.view().fastest() as f32, fastest);
    let instant = engine.view().instant();
    assert_eq!((instant.step, instant.time, instant.strain), (state.step, state.time, Some(engine.strain())));
}

/// Two wires side by side and two spheres, each pair pressed together by 2 µm, and nothing else touches.
const PAIRS: &str = r#"
about = "Two wires and two spheres that press on each other."
spacing = 1.5
[material]
density = "8960 kg/m^3"
young = "115 GPa"
poisson = 0.34
[bond]
law = "elastic"
[contact]
normal = "hertz"
tangential = "none"
shape = "sphere"
[[wire]]
diameter = "0.4 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "6 mm"]
[[wire]]
diameter = "0.4 mm"
from = ["0.398 mm", "0 mm", "0 mm"]
to = ["0.398 mm", "0 mm", "6 mm"]
[[sphere]]
diameter = "2 mm"
position = ["20 mm", "0 mm", "0 mm"]
velocity = ["0 m/s", "3 m/s", "-4 m/s"]
[[sphere]]
diameter = "2 mm"
position = ["20 mm", "0 mm", "1.998 mm"]
velocity = ["0 m/s", "3 m/s", "-4 m/s"]
[stop]
time = "20 us"
"#;

/// (4/3) E* √R* δ^(3/2) of a pair of spheres of radius `r` (m), over d a in a wire and over πr² of a free sphere.
#[test]
fn contact_pressure_is_hertz_force_over_the_area_shown() {
    let engine = engine(PAIRS, &[]);
    let shown = engine.snapshot();
    let force = |r: f64| {
        let modulus = YOUNG / (2.0 * (1.0 - 0.34 * 0.34));
        4.0 / 3.0 * modulus * (0.5 * r).sqrt() * 2e-6f64.powf(1.5)
    };
    let assembly = engine.assembly();
    let spacing = assembly.position.get(1).z;
    assert!((0.55e-3..0.65e-3).contains(&spacing), "{spacing}");
    for i in 0..assembly.len() {
        let expected = if i < assembly.wire_particles {
            force(0.2e-3) / (0.4e-3 * spacing)
        } else {
            force(1e-3) / (std::f64::consts::PI * 1e-6)
        };
        let pressure = f64::from(shown.contact_pressure[i]);
        assert!((pressure / expected - 1.0).abs() < 1e-5, "particle {i}: {pressure} instead of {expected}");
    }
    // Each pair stores (2/5) F δ, and that is the energy that the run begins with, besides its motion.
    let pairs = (assembly.wire_particles / 2) as f64;
    let stored = 0.4 * 2e-6 * (pairs * force(0.2e-3) + force(1e-3));
    let energy = engine.energy();
    assert!((energy.elastic_contacts / stored - 1.0).abs() < 1e-9, "{} instead of {stored}", energy.elastic_contacts);
    assert!(energy.residual().abs() < 1e-9 * energy.work, "{energy:?}");
}

#[test]
fn bodies_and_their_members_are_numbered_from_one() {
    let engine = engine(PAIRS, &[]);
    let (view, wire) = (engine.view(), engine.assembly().wires[0].len);
    let in_wire = |particle: usize| match view.member(particle) {
        Member { number: Some(number), body: Body::Wire { wire, .. } } => (wire, number),
        other => panic!("{other:?}"),
    };
    assert_eq!([0, wire - 1, wire, 2 * wire - 1].map(in_wire), [(1, 1), (1, wire), (2, 1), (2, wire)]);
    for (particle, sphere) in [(2 * wire, 1), (2 * wire + 1, 2)] {
        assert_eq!(view.member(particle), Member { number: None, body: Body::Sphere { sphere } });
    }
    assert_eq!(view.fastest(), 5.0);
    assert_eq!(view.instant().strain, None, "free bodies have none");
    // Two spheres of 2 mm at 5 m/s; the wires are at rest.
    let mass = DENSITY * 4.0 / 3.0 * std::f64::consts::PI * 1e-9;
    assert!((engine.energy().kinetic / (2.0 * 0.5 * mass * 25.0) - 1.0).abs() < 1e-9, "{}", engine.energy().kinetic);
}
