//! Steps of an engine on the adapter that there is, against the engine's own.
//!
//! After 1,000 steps positions may differ by 1e-11 of a diameter. Both round differently: a graphics processor may fuse a
//! product and a sum.

use crate::device;
use crate::drive::{Outcome, assembly, distance, run_steps, spec};
use strandsnap::base::error::Error;
use strandsnap::engine::Engine;
use strandsnap::gpu::{Device, Stepper};
use strandsnap::scene;
use strandsnap::scene::plan::Plan;

/// Greatest difference of a position, in diameters.
const POSITION: f64 = 1e-11;
/// Of any other number, over its scale: of energies the work done, of stresses [`STRESS`].
const NUMBER: f64 = 1e-10;
/// Where the metal of these scenes begins to yield (Pa): what stresses are measured by.
const STRESS: f64 = 100e6;

fn shipped(name: &str, set: &[&str]) -> Engine {
    moved(name, set, 0.0)
}

/// The same with all bodies larger by a share `by`.
fn moved(name: &str, set: &[&str], by: f64) -> Engine {
    let set: Vec<String> = set.iter().map(|option| option.to_string()).collect();
    let scene = scene::load(name, &set).unwrap_or_else(|error| panic!("{name} {set:?}: {error:?}"));
    let mut assembly = assembly(&scene.spec);
    assembly.position.rows_mut().into_iter().flatten().for_each(|x| *x *= 1.0 + by);
    Engine::new(&scene.spec, &scene.plan, assembly).unwrap()
}

pub fn own(text: &str, set: &[&str]) -> Engine {
    let spec = spec(text, set);
    Engine::new(&spec, &Plan::new(&spec), assembly(&spec)).unwrap()
}

/// Steps of one engine on the adapter.
fn step(device: &Device, engine: &mut Engine, steps: u64) {
    let begun = engine.steps();
    Stepper::new(device, engine).unwrap().advance(engine, steps).unwrap();
    assert_eq!(engine.steps(), begun + steps);
}

/// Asserts that an engine whose steps were done on the adapter is where the processor has brought the other one.
pub fn assert_alike(name: &str, on_adapter: &mut Engine, on_processor: &mut Engine) {
    let diameter = 2.0 * on_processor.assembly().least_radius();
    let (strain, stress) = (on_processor.strain(), on_processor.stress());
    assert_eq!(on_adapter.steps(), on_processor.steps(), "{name}");
    let close = |what: &str, found: f64, expected: f64, scale: f64| {
        let error = (found - expected).abs() / scale;
        assert!(error <= NUMBER, "{name}: {what} is {found:e}, not {expected:e}");
    };
    // The size of a step may follow the greatest speed.
    close("time", on_adapter.time(), on_processor.time(), on_processor.time());
    close("speed of the grip", on_adapter.grip_speed(), on_processor.grip_speed(), 1.0);
    close("strain", on_adapter.strain(), strain, 1.0);
    close("stress", on_adapter.stress(), stress, STRESS);
    let (found, expected) = (Outcome::of(on_adapter), Outcome::of(on_processor));
    let off = distance(&found.position, &expected.position) / diameter;
    let moved = distance(&expected.position, &on_processor.assembly().position.iter().collect::<Vec<_>>()) / diameter;
    let turned = expected.spin.iter().map(|w| w.length()).fold(0.0, f64::max);
    println!("{name}: {off:.1e} diameters off, {moved:.1e} moved, up to {turned:.1e} rad/s");
    assert!(moved > 1e-8 || turned > 1.0, "{name}: nothing moved");
    assert!(off <= POSITION, "{name}: {off:e} diameters off");
    let spin = distance(&found.spin, &expected.spin);
    // What is off by the shortest wave that the step resolves swings at 2/Δt.
    let swings = 2.0 / on_processor.time_step();
    assert!(spin <= 2.0 * POSITION * swings, "{name}: spins are {spin:e} rad/s off");
    assert_eq!(found.whole, expected.whole, "{name}: bonds that hold");
    let radii = found.radius.iter().zip(&expected.radius).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(radii <= POSITION * diameter, "{name}: radii are {radii:e} m off");
    let work = expected.energy.work.abs().max(expected.energy.kinetic);
    for (what, found, expected) in [
        ("work", found.energy.work, expected.energy.work),
        ("kinetic energy", found.energy.kinetic, expected.energy.kinetic),
        ("elastic energy", found.energy.elastic_bonds, expected.energy.elastic_bonds),
        ("plastic work", found.energy.plastic_bonds, expected.energy.plastic_bonds),
        ("damping", found.energy.damping, expected.energy.damping),
        ("released energy", found.energy.released, expected.energy.released),
    ] {
        close(what, found, expected, work);
    }
    let broke = |outcome: &Outcome| -> Vec<_> {
        outcome.ruptures.iter().map(|r| (r.order, r.step, r.bond, r.cause, r.first_of_wire)).collect()
    };
    assert_eq!(broke(&found), broke(&expected), "{name}: ruptures");
}

/// Two wires apart, bent, stretched and broken by stress.
const BEAMS: &str = r#"
about = "Two elastic wires that are pulled and bent until they break, and never touch."
seed = 3
[bond]
law = "elastic"
damping = 0.05
rupture = { criterion = "beam-stress", tensile = "300 MPa", shear = "200 MPa", weibull_modulus = 10 }
[[wire]]
diameter = "0.4 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "8 mm"]
[[wire]]
diameter = "0.3 mm"
from = ["5 mm", "0 mm", "0 mm"]
to = ["5 mm", "3 mm", "6 mm"]
[[hold]]
body = 0
part = "start"
fix = ["x", "y", "z", "rx", "ry", "rz"]
[[hold]]
body = 0
part = "end"
fix = ["z", "ry"]
velocity = ["0 m/s", "0 m/s", "2 m/s"]
force = ["0.5 N", "0 N", "0 N"]
moment = ["0 N m", "0 N m", "1e-4 N m"]
ramp = "20 us"
[[hold]]
body = 1
part = "start"
fix = ["x", "y", "z"]
[[hold]]
body = 1
part = "end"
force = ["0 N", "0 N", "30 N"]
ramp = "50 us"
[stop]
time = "1 ms"
"#;

/// A strand that comes to press, slide and break soon.
const FAST: [&str; 2] = ["grip.speed=60 m/s", "bond.rupture.strain=0.5 %"];

#[test]
fn a_thousand_steps_are_those_of_the_processor() {
    let Some(device) = device("a_thousand_steps_are_those_of_the_processor") else { return };
    let jaw = ["grip.kind=jaw", "grip.clamp_pressure=20 MPa", "grip.length=2 mm", "grip.speed=2 m/s"];
    let adaptive = ["grip.adaptive={ from = \"0.1 %\", fastest = \"20 m/s\", kinetic = \"100 %\", passages = 1 }"];
    let cases: [(&str, &dyn Fn() -> Engine, usize); 11] = [
        ("a wire pulled until it yields", &|| shipped("single-wire", &[]), 0),
        ("a wire that snaps", &|| shipped("single-wire", &["bond.rupture.strain=0.5 %", "grip.speed=60 m/s"]), 1),
        ("an adaptive pull", &|| shipped("single-wire", &adaptive), 0),
        ("a cantilever", &|| shipped("cantilever", &[]), 0),
        ("torsion", &|| shipped("torsion", &[]), 0),
        ("torsion and tension", &|| shipped("torsion", &["grip.speed=3 m/s"]), 0),
        ("a jaw that turns", &|| shipped("torsion", &jaw), 0),
        ("holds and loads until stress breaks bonds", &|| own(BEAMS, &[]), 2),
        ("two spheres that meet", &|| shipped("two-spheres", &[]), 0),
        ("seven wires", &|| shipped("strand-1x7", &[]), 0),
        ("seven wires without friction", &|| shipped("strand-1x7", &[FAST[0], "contact.friction=0"]), 0),
    ];
    for (name, engine, broken) in cases {
        let (mut on_adapter, mut on_processor) = (engine(), engine());
        step(&device, &mut on_adapter, 1000);
        run_steps(&mut on_processor, 1000);
        let faster = on_processor.grip_speed() > engine().grip_speed();
        assert_eq!(faster, name == "an adaptive pull", "{name}: {} m/s", on_processor.grip_speed());
        let whole = on_processor.state().whole.iter().filter(|whole| **whole).count();
        let bonds = (0..on_processor.state().len()).filter(|slot| on_processor.assembly().is_bond(*slot)).count();
        assert!(bonds - whole >= broken, "{name}: {} bonds broke", bonds - whole);
        assert_alike(name, &mut on_adapter, &mut on_processor);
    }
}

/// Once wires have snapped, pieces whip and rub, and rounding grows: by how much shows in the processor's own result for bodies
/// that differ in the last bits.
#[test]
fn seven_wires_snap_as_on_the_processor() {
    let Some(device) = device("seven_wires_snap_as_on_the_processor") else { return };
    let mut engines = [0.0, 0.0, f64::EPSILON, -f64::EPSILON].map(|by| moved("strand-1x7", &FAST, by));
    let [on_adapter, on_processor, others @ ..] = &mut engines;
    step(&device, on_adapter, 1000);
    run_steps(on_processor, 1000);
    let expected = Outcome::of(on_processor);
    assert!(!expected.ruptures.is_empty());
    let diameter = 2.0 * on_processor.assembly().least_radius();
    let off = |outcome: &Outcome| distance(&outcome.position, &expected.position) / diameter;
    let own = others.each_mut().map(|other| {
        run_steps(other, 1000);
        off(&Outcome::of(other))
    });
    let found = Outcome::of(on_adapter);
    let allowed = POSITION + 10.0 * own[0].max(own[1]);
    println!("{:.1e} diameters off; {:.1e} and {:.1e} for other last bits", off(&found), own[0], own[1]);
    assert!(off(&found) < allowed, "{:e} diameters off, not {allowed:e}", off(&found));
    assert_eq!(found.whole, expected.whole);
    let broke = |outcome: &Outcome| outcome.ruptures.iter().map(|r| (r.order, r.step, r.bond)).collect::<Vec<_>>();
    assert_eq!(broke(&found), broke(&expected));
}

/// Both ways of steps in blocks are the same on one adapter, and so is one run and another.
#[test]
fn blocks_of_any_length_give_the_same_bits() {
    let Some(device) = device("blocks_of_any_length_give_the_same_bits") else { return };
    let run = |blocks: &[u64]| {
        let mut engine = shipped("torsion", &["grip.speed=3 m/s", "grip.rotation_rate=9000 rad/s"]);
        let mut stepper = Stepper::new(&device, &engine).unwrap();
        blocks.iter().for_each(|steps| stepper.advance(&mut engine, *steps).unwrap());
        Outcome::of(&mut engine)
    };
    let whole = run(&[300]);
    for blocks in [&[300][..], &[1, 63, 65, 171]] {
        run(blocks).assert_same_motion(&whole, &format!("{blocks:?}"));
    }
}

/// What an engine is after steps on an adapter, it also is for the processor: it keeps it, and goes on.
#[test]
fn the_processor_goes_on_from_the_adapter() {
    let Some(device) = device("the_processor_goes_on_from_the_adapter") else { return };
    let mut first = shipped("single-wire", &[]);
    step(&device, &mut first, 500);
    let (mut resumed, mut on_processor) = (shipped("single-wire", &[]), shipped("single-wire", &[]));
    resumed.restore(&first.save()).unwrap();
    run_steps(&mut resumed, 500);
    run_steps(&mut on_processor, 1000);
    assert_alike("resumed", &mut resumed, &mut on_processor);
}

/// A lone wire gets contacts once it has snapped.
#[test]
fn contacts_come_in_after_a_rupture() {
    let Some(device) = device("contacts_come_in_after_a_rupture") else { return };
    // Steps of one size: where they follow the greatest speed, times differ by rounding, and fast particles with them.
    let set = [
        "time.step=6e-8 s",
        "bond.rupture.strain=0.5 %",
        "grip.speed=60 m/s",
        "contact={ normal = \"thornton\", friction = 0.2, hardness_strain = \"8 %\", damping = 0.1 }",
    ];
    let (mut on_adapter, mut on_processor) = (shipped("single-wire", &set), shipped("single-wire", &set));
    step(&device, &mut on_adapter, 1000);
    assert!(!on_processor.has_contacts(), "they come in later");
    run_steps(&mut on_processor, 1000);
    assert!(on_processor.has_contacts() && on_adapter.has_contacts());
    assert_alike("contacts after a rupture", &mut on_adapter, &mut on_processor);
}

#[test]
fn what_runs_away_ends_the_run_where_it_does_on_the_processor() {
    let Some(device) = device("what_runs_away_ends_the_run_where_it_does_on_the_processor") else { return };
    let engine = || shipped("cantilever", &["time.step=1.2e-7 s"]);
    let (mut on_adapter, mut on_processor) = (engine(), engine());
    let found = Stepper::new(&device, &on_adapter).unwrap().advance(&mut on_adapter, 100_000).unwrap_err();
    let expected = loop {
        if let Err(error) = on_processor.step() {
            break error;
        }
    };
    assert!(matches!(found, Error::Simulation(_)), "{found}");
    // Rounding grows with what runs away: the step may be another one.
    let steps = |engine: &Engine| engine.steps() as f64;
    let ratio = steps(&on_adapter) / steps(&on_processor);
    assert!((ratio - 1.0).abs() < 0.05, "{found}, but {expected}");
}

#[test]
fn what_cannot_be_recorded_is_refused_with_the_reason() {
    let Some(device) = device("what_cannot_be_recorded_is_refused_with_the_reason") else { return };
    let rupture = "bond.rupture={ criterion = \"fibre-strain\", strain = \"5 %\" }";
    for (name, set, reason) in [
        ("strand-1x7", &["contact.shape=wire"][..], "contacts of smooth wires"),
        ("single-wire", &[rupture], "fibre strain asks for angles between bonds"),
        ("torsion", &["grip.free_rotation=true", "grip.rotation_rate="], "a grip that turns freely"),
        ("strand-1x7", &["contact.tangential=mindlin-deresiewicz"], "the law of friction (contact.tangential)"),
        ("bounce", &[], "rigid bodies ([[body]])"),
    ] {
        match Stepper::new(&device, &shipped(name, set)) {
            Err(Error::Missing { what, .. }) => assert!(what.contains(reason), "{name}: {what}"),
            other => panic!("{name}: {:?}", other.err()),
        }
    }
}
