//! Momentum and frame indifference of bodies that nothing holds.

use crate::drive::*;
use glam::{DQuat, DVec3};
use strandsnap::engine::Engine;
use strandsnap::strand::assembly::Assembly;

/// Torn and twisted apart by its own inertia: yields, rubs and breaks. One bond breaks early, the others follow.
fn torn(shape: &str, edit: impl FnOnce(&mut Assembly)) -> Engine {
    let shape = format!("contact.shape={shape}");
    let set = [&FREE[..], &[&shape, "bond.rupture.strain=0.5 %"]].concat();
    edited(STRAND, &set, |a| {
        let c = centre(a);
        add_velocity(a, |x| {
            let r = x - c;
            // Pulled along z, twisted about z, and the whole thing tumbling and flying.
            DVec3::Z * (1e4 * r.z)
                + DVec3::Z.cross(r) * (3e6 * r.z)
                + DVec3::new(700.0, -300.0, 100.0).cross(r)
                + DVec3::new(3.0, -2.0, 5.0)
        });
        edit(a);
    })
}

#[test]
fn momentum_is_conserved_to_rounding() {
    for shape in ["sphere", "wire"] {
        let mut engine = torn(shape, |_| {});
        let scale: f64 =
            (0..engine.state().len()).map(|p| engine.state().mass[p] * engine.state().v.get(p).length()).sum();
        let reach = 0.006;
        let before = (momentum(engine.state()), angular_momentum(engine.state()));
        let mut most = 0;
        for _ in 0..30 {
            run_steps(&mut engine, 100);
            most = most.max(engine.contact_counts().2);
        }
        let after = (momentum(engine.state()), angular_momentum(engine.state()));
        let energy = engine.energy();
        let ruptures = engine.take_ruptures().len();
        println!("{shape}: {ruptures} ruptures, {most} contacts, {energy:?}");
        assert!(most > 10 && energy.friction > 0.0 && energy.plastic_bonds > 0.0 && ruptures > 1);
        // 3000 steps of a few hundred sums with 1e-16 each; errors add up like a random walk, far below 1e-12.
        let linear = (after.0 - before.0).length() / scale;
        let angular = (after.1 - before.1).length() / (scale * reach);
        println!("{shape}: {linear:e} {angular:e}");
        assert!(linear < 1e-12 && angular < 1e-12, "{shape}: {linear:e} {angular:e}");
    }
}

/// Bent, twisted and stretched by an initial motion; no contact, so that nothing amplifies rounding.
const WIRE: &str = r#"
about = "One free wire."
[bond]
law = "elasto-plastic"
damping = 0.02
hardening = { form = "voce", yield_stress = "100 MPa", saturation = "180 MPa", rate = 12, linear = "550 MPa" }
[contact]
normal = "none"
[[wire]]
diameter = "0.39 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "8 mm"]
[stop]
time = "1 ms"
"#;

const ELASTIC: [&str; 2] = ["bond.law=elastic", "bond.hardening="];

/// Nothing in the scene bends the wire, only the test does.
const BENDS: &str = "plan=general";

fn shaken(set: &[&str], edit: impl FnOnce(&mut Assembly)) -> Engine {
    edited(WIRE, &[set, &[BENDS]].concat(), |a| {
        let c = centre(a);
        for p in 0..a.len() {
            let s = (a.position.get(p) - c).z / 4e-3;
            a.velocity.set(p, DVec3::new(4.0 * s * s, 3.0 * s * s * s, 8.0 * s));
            a.spin.set(p, DVec3::Z * (3e4 * s));
        }
        edit(a);
    })
}

/// Internal energies that a rigid motion must not change (J).
fn internal(e: &Engine) -> [f64; 3] {
    let e = e.energy();
    [e.elastic_bonds, e.plastic_bonds, e.damping]
}

fn turn(a: &mut Assembly, rotation: DQuat) {
    for p in 0..a.len() {
        a.position.set(p, rotation * a.position.get(p));
        a.velocity.set(p, rotation * a.velocity.get(p));
        a.spin.set(p, rotation * a.spin.get(p));
    }
}

fn relative(a: [f64; 3], b: [f64; 3]) -> f64 {
    let scale = a.iter().fold(0.0f64, |m, v| m.max(*v));
    (0..3).map(|k| (a[k] - b[k]).abs() / scale).fold(0.0, f64::max)
}

/// Greatest difference of internal energies between a shaken wire and the same one changed by `edit`.
fn frame_error(set: &[&str], steps: u64, edit: impl FnOnce(&mut Assembly)) -> f64 {
    let mut base = shaken(set, |_| {});
    run_steps(&mut base, steps);
    let reference = internal(&base);
    assert!(reference[0] > 0.0 && reference[2] > 0.0, "{reference:?}");
    let mut other = shaken(set, edit);
    run_steps(&mut other, steps);
    relative(reference, internal(&other))
}

fn moved(a: &mut Assembly) {
    (0..a.len()).for_each(|p| a.position.add(p, DVec3::new(0.01, -0.02, 0.005)));
}

fn flying(a: &mut Assembly) {
    add_velocity(a, |_| DVec3::new(20.0, -5.0, 10.0));
}

fn turned(a: &mut Assembly) {
    turn(a, DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 1.1));
}

/// Positions of up to 3e-2 m are rounded at 4e-18 m, strains over 0.39 mm at 1e-14. The elastic strains here are 1e-2,
/// so one step is good for 1e-12 of the forces; errors of 1500 steps add up like a random walk, 40 times that.
#[test]
fn where_a_wire_is_and_how_fast_it_flies_does_not_matter() {
    for set in [&ELASTIC[..], &[]] {
        let error = frame_error(set, 1500, moved).max(frame_error(set, 1500, flying));
        println!("{error:e}");
        assert!(error < 4e-11, "{error:e}");
    }
}

/// The two axes across a bond are chosen anew in the turned frame; increments along and across the turning of the bond
/// differ by the square of its angle per step. That is no rounding, but goes with the square of the step.
#[test]
fn how_a_wire_lies_matters_less_than_any_step() {
    let error = |step: &str, steps| frame_error(&[&ELASTIC[..], &[step]].concat(), steps, turned);
    let (coarse, fine) = (error("time.step=8e-8 s", 1500), error("time.step=2e-8 s", 6000));
    println!("{coarse:e} {fine:e}");
    assert!(coarse < 1e-8, "{coarse:e}");
    let order = (coarse / fine).log(4.0);
    assert!(order > 1.7, "order {order}");
}

/// A rigid rotation strains nothing but by centrifugal force. The increments of shear, bending and torsion are measured
/// at mid-step, so that what is left is of third order in the angle per step.
#[test]
fn a_rigid_rotation_stores_nothing() {
    let stored = |rate: f64, steps: u64| {
        let mut engine =
            edited(WIRE, &[BENDS, "bond.law=elastic", "bond.hardening=", "bond.damping=0", "time.step=2e-8 s"], |a| {
                let (c, spin) = (centre(a), DVec3::new(0.6, 0.0, 0.8) * rate);
                // About a skew axis through the centre, so that the wire tumbles.
                for p in 0..a.len() {
                    a.velocity.set(p, spin.cross(a.position.get(p) - c));
                    a.spin.set(p, spin);
                }
            });
        run_steps(&mut engine, steps);
        let e = engine.energy();
        (e.elastic_bonds, e.kinetic)
    };
    let (slow, kinetic) = stored(2e3, 2000);
    let (fast, _) = stored(4e3, 2000);
    println!("{slow:e} of {kinetic:e}, {fast:e}");
    // Centrifugal stress goes with rate², its energy with rate⁴.
    let order = (fast / slow).log2();
    assert!((order - 4.0).abs() < 0.2, "order {order}");
}
