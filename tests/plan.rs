//! What runs and what is left out, for every built-in scene and for the cases that decide it.

#[path = "common/drive.rs"]
mod drive;

use drive::*;
use strandsnap::engine::Engine;
use strandsnap::scene::builtin;
use strandsnap::scene::plan::{ContactPlan, Plan};
use strandsnap::strand::{build, size::Size};

const WIRE: &str = r#"
about = "One straight wire."
[bond]
law = "elastic"
[contact]
normal = "hertz"
[[wire]]
diameter = "0.4 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "10 mm"]
[grip]
length = "1 mm"
speed = "1 m/s"
[stop]
strain = "1 %"
"#;

const BREAKS: &str = r#"bond.rupture={ criterion = "fibre-strain", strain = "1 %" }"#;
const PLASTIC: [&str; 2] = [
    "bond.law=elasto-plastic",
    r#"bond.hardening={ form = "ludwik", yield_stress = "90 MPa", strength = "400 MPa", exponent = 0.5 }"#,
];

fn plan(text: &str, set: &[&str]) -> Plan {
    Plan::new(&spec(text, set))
}

/// State of a component as people read it.
fn state<'a>(plan: &'a Plan, name: &str) -> &'a str {
    &plan.components.iter().find(|c| c.name == name).unwrap_or_else(|| panic!("no {name} in\n{plan}")).state
}

/// Bonds, rotations, plastic state, rupture, scatter, contacts, friction, grips of each built-in scene: `+` runs,
/// `-` left out, `r` from the first rupture on.
const TABLE: [(&str, &str); 12] = [
    ("ka4", "++++++++"),
    ("jaw-grip", "++++++++"),
    ("strand-1x7", "++++++++"),
    ("strand-1x19", "++++++++"),
    ("hard-drawn-7", "++++++++"),
    ("acsr", "++++++++"),
    ("single-wire", "+-+++--+"),
    ("cantilever", "++-----+"),
    ("torsion", "+++----+"),
    ("two-spheres", "-----+--"),
    ("bounce", "--------"),
    ("bend3", "+++--++-"),
];
const COMPONENTS: [&str; 8] =
    ["bonds", "rotations", "plastic state", "rupture", "scatter", "contacts", "friction", "grips"];

#[test]
fn every_built_in_scene_runs_what_it_needs() {
    assert_eq!(TABLE.len(), builtin::list().len(), "a row for every scene");
    for (name, expected) in TABLE {
        let plan = plan(builtin::find(name).unwrap(), &[]);
        let sign = |component: &&str| match state(&plan, component) {
            "runs" => '+',
            "left out" => '-',
            "from the first rupture on" => 'r',
            other => panic!("{component} is \"{other}\""),
        };
        let actual: String = COMPONENTS.iter().map(sign).collect();
        assert_eq!(actual, expected, "{name}:\n{plan}");
        for c in &plan.components {
            assert!(!c.reason.is_empty(), "{name}: {} has no reason", c.name);
            assert!(plan.to_string().contains(&c.reason), "{name}: {} is not shown", c.name);
        }
    }
}

#[test]
fn flags_are_what_people_read() {
    for (name, text) in builtin::list() {
        let plan = plan(text, &[]);
        let runs = |component| state(&plan, component) == "runs";
        assert_eq!(plan.bonds, runs("bonds"), "{name}");
        assert_eq!(plan.rotations, runs("rotations"), "{name}");
        assert_eq!(plan.rupture, runs("rupture"), "{name}");
        assert_eq!(plan.scatter, runs("scatter"), "{name}");
        assert_eq!(plan.contacts == ContactPlan::Present, runs("contacts"), "{name}");
    }
}

#[test]
fn a_straight_wire_touches_nothing_until_it_snaps() {
    assert_eq!(plan(WIRE, &[]).contacts, ContactPlan::Absent);
    assert_eq!(plan(WIRE, &[BREAKS]).contacts, ContactPlan::AfterRupture);
    assert_eq!(plan(WIRE, &[BREAKS, "contact.normal=none"]).contacts, ContactPlan::Absent);
    let pushed = ["grip.speed=-1 m/s", "stop.strain=", "stop.time=1 ms"];
    assert_eq!(plan(WIRE, &pushed).contacts, ContactPlan::Present, "a wire that is pushed buckles");
    let two = format!(
        "{WIRE}[[wire]]\ndiameter = \"0.4 mm\"\nfrom = [\"1 mm\", \"0 mm\", \"0 mm\"]\nto = [\"1 mm\", \"0 mm\", \"10 mm\"]\n"
    );
    assert_eq!(plan(&two, &[]).contacts, ContactPlan::Present);
}

#[test]
fn rotations_are_for_what_can_turn() {
    assert!(!plan(WIRE, &[]).rotations);
    assert!(!plan(WIRE, &[BREAKS]).rotations);
    assert!(plan(WIRE, &["grip.rotation_rate=10 rad/s"]).rotations);
    assert!(plan(WIRE, &["grip.free_rotation=true"]).rotations);
    assert!(plan(WIRE, &[r#"wire.0.to=["1 mm", "0 mm", "10 mm"]"#]).rotations, "a wire aslant bends");
    assert!(plan(STRAND, &[]).rotations);
    assert!(plan(WIRE, &["plan=general"]).rotations);
    assert_eq!(plan(WIRE, &["plan=general"]).contacts, ContactPlan::Present);
}

#[test]
fn plastic_state_goes_with_the_law_and_scatter_with_its_modulus() {
    assert_eq!(state(&plan(WIRE, &[]), "plastic state"), "left out");
    assert_eq!(state(&plan(WIRE, &PLASTIC), "plastic state"), "runs");
    assert!(!plan(WIRE, &[BREAKS]).scatter);
    assert!(plan(WIRE, &[BREAKS, "bond.rupture.weibull_modulus=20"]).scatter);
    assert!(!plan(WIRE, &[BREAKS, "bond.rupture.weibull_modulus=inf"]).scatter);
}

/// The engine builds its stages from the plan and from nothing else; a rupture brings the contacts that were left out.
#[test]
fn a_wire_that_snaps_gets_contacts() {
    let set = [
        &PLASTIC[..],
        &[
            r#"bond.rupture={ criterion = "plastic-strain", strain = "2 %", weibull_modulus = 10 }"#,
            "grip.speed=10 m/s",
            "stop.strain=20 %",
        ],
    ]
    .concat();
    let mut engine = engine(WIRE, &set);
    assert_eq!(engine.plan().contacts, ContactPlan::AfterRupture);
    run_while(&mut engine, |e| e.sample().bonds_broken == 0);
    assert_eq!(engine.contact_counts(), (1, 1, 0), "searches, candidates, touching: two ends, still apart");
    assert_eq!(engine.take_ruptures().len(), 1);
    // Thrown apart by their inertia, elastic pieces spring back. The middle bond reaches its limit within some steps:
    // they must be short, or the rupture comes late by a share of its energy.
    let mut thrown = edited(WIRE, &[BREAKS, "grip.speed=10 m/s", "stop.strain=20 %", "time.safety=0.1"], |a| {
        let half = a.len() / 2;
        (0..a.len()).for_each(|p| a.velocity.set(p, glam::DVec3::Z * if p < half { -20.0 } else { 20.0 }));
    });
    let mut touched = 0;
    run_while(&mut thrown, |e| {
        touched = touched.max(e.contact_counts().2);
        e.steps() < 16000
    });
    assert!(thrown.sample().bonds_broken > 0);
    assert!(touched > 0, "pieces that spring back must touch");
    let e = thrown.energy();
    assert!(e.residual().abs() < 0.01 * e.work, "{e:?}");
}

#[test]
fn without_contacts_nothing_is_searched() {
    let mut engine = engine(WIRE, &[]);
    run_steps(&mut engine, 50);
    assert_eq!(engine.contact_counts(), (0, 0, 0));
    assert!(engine.state().torque.iter().all(|t| t == glam::DVec3::ZERO));
}

/// The least that can be run: one sphere, one bond, nothing that touches, a wire that is held all over.
#[test]
fn tiny_assemblies_run() {
    const SPHERE: &str = r#"
about = "A ball that flies."
[[sphere]]
diameter = "1 mm"
position = ["0 mm", "0 mm", "0 mm"]
velocity = ["0 m/s", "0 m/s", "1 m/s"]
[stop]
time = "1 ms"
"#;
    let mut ball = engine(SPHERE, &[]);
    run_to(&mut ball, 1e-3);
    assert!((ball.state().x.get(0).z - 1e-3).abs() < 1e-6);
    let bond = [r#"wire.0.to=["0 mm", "0 mm", "0.4 mm"]"#, "grip=", "stop.strain=", "stop.time=1 ms", "plan=general"];
    let mut pair = edited(WIRE, &[&bond[..], &[BREAKS]].concat(), |a| a.velocity.set(1, glam::DVec3::Z * 60.0));
    assert_eq!(pair.assembly().bond_count(), 1);
    run_steps(&mut pair, 500);
    let (sample, snapshot) = (pair.sample(), pair.snapshot());
    assert_eq!((sample.bonds_broken, sample.wires_broken, snapshot.position.len()), (1, 1, 2));
    let held =
        ["grip=", "stop.strain=", "stop.time=1 ms", r#"hold=[{ body = 0, fix = ["x", "y", "z", "rx", "ry", "rz"] }]"#];
    let mut still = engine(WIRE, &held);
    run_steps(&mut still, 50);
    // ln(l/l₀) of bonds that were cut to length is a rounding, 1e-16 of 1e4 N over 1e-20 m.
    assert!(still.energy().work.abs() < 1e-28);
    let two_bonds = [r#"wire.0.to=["0 mm", "0 mm", "0.8 mm"]"#, "grip.length=0.1 mm"];
    let mut short = engine(WIRE, &two_bonds);
    run_steps(&mut short, 50);
    assert!(short.sample().wire_stress[0].is_finite());
}

/// A jaw drives the outermost layer; one that does not reach both grips cannot be pulled.
#[test]
fn a_jaw_without_wires_says_so() {
    let text = format!(
        "{WIRE}[[wire]]\nlayer = \"outer\"\ndiameter = \"0.4 mm\"\nfrom = [\"1 mm\", \"0 mm\", \"4 mm\"]\nto = [\"1 mm\", \"0 mm\", \"6 mm\"]\n"
    );
    let spec = spec(&text, &["grip.kind=jaw", "grip.clamp_pressure=10 MPa"]);
    let Err(error) = strandsnap::engine::Engine::new(&spec, &Plan::new(&spec), assembly(&spec)) else {
        panic!("nothing is held")
    };
    let message = format!("{error:?}");
    assert!(message.contains("outer") && message.contains("grip"), "{message}");
}

#[test]
fn shipped_scenes_are_as_large_as_foretold() {
    for (name, set) in [
        ("ka4", None),
        ("strand-1x7", None),
        ("single-wire", None),
        ("two-spheres", None),
        ("strand-1x7", Some("contact.shape=wire")),
    ] {
        let set: Vec<&str> = set.into_iter().collect();
        let spec = spec(builtin::find(name).unwrap(), &set);
        let (assembly, size) = (build(&spec).unwrap(), Size::of(&spec));
        let (particles, bonds) = (assembly.len() as f64, assembly.bond_count() as f64);
        assert_eq!(size.wires, assembly.wires.len() as f64);
        assert!((size.particles / particles - 1.0).abs() < 0.01, "{name}: {size:?}, {particles}");
        assert!((size.bonds - bonds).abs() <= 0.01 * bonds, "{name}: {size:?}, {bonds}");
        let kept = Engine::new(&spec, &Plan::new(&spec), assembly).unwrap().bytes().kept() as f64;
        assert!((1.0..3.0).contains(&(size.memory / kept)) || particles < 10.0, "{name}: {size:?}, {kept}");
    }
}
