//! Nothing that goes wrong goes wrong silently: each guard is driven to speak once, and a sound run hears nothing.

#[path = "common/drive.rs"]
mod drive;

use drive::*;
use glam::DVec3;
use strandsnap::base::error::{Error, Result};
use strandsnap::base::finding::{Body, Element, Finding, FindingKind, Notice, StepLimit};
use strandsnap::engine::Engine;
use strandsnap::engine::view::RunInfo;
use strandsnap::observe::Observer;
use strandsnap::scene::caution::cautions;
use strandsnap::scene::plan::Plan;

/// Steps until `steps`, or until it fails.
fn until_it_fails(engine: &mut Engine, steps: u64) -> Option<Error> {
    (0..steps).find_map(|_| engine.step().err()).or_else(|| engine.check_crossings().err())
}

fn texts(engine: &mut Engine) -> Vec<String> {
    engine.take_notices().iter().map(Notice::to_string).collect()
}

fn by_contact(limit: &StepLimit) -> bool {
    matches!(limit, StepLimit::Stiffness { element: Element::Contact, .. })
}

fn is(kind: FindingKind) -> impl Fn(&&Notice) -> bool {
    move |notice| notice.finding.kind() == kind
}

/// A straight wire pulled without end.
const BAR: &str = r#"
about = "One straight wire, pulled."
[bond]
law = "elasto-plastic"
damping = 0.02
hardening = { form = "voce", yield_stress = "100 MPa", saturation = "180 MPa", rate = 12, linear = "900 MPa" }
[contact]
normal = "none"
[[wire]]
diameter = "0.39 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "16 mm"]
[grip]
length = "2 mm"
speed = "10 m/s"
[stop]
strain = "40 %"
"#;

/// A wire that thins and lengthens gets softer, EA/l ∝ e^(−2ε), at the same mass: its step grows with e^ε.
#[test]
fn the_step_grows_as_a_wire_gets_softer() {
    let mut engine = engine(BAR, &[]);
    let first = engine.time_step();
    run_while(&mut engine, |e| e.strain() < 0.2);
    let seen = engine.findings();
    let growth = engine.time_step() / first;
    assert!((growth / 1.2 - 1.0).abs() < 0.03, "{growth}");
    assert_eq!((seen.least_step.seconds, seen.least_step.step), (first, 0));
    assert!(seen.greatest_step.strain.unwrap() > 0.15, "{:?}", seen.greatest_step);
    let limit = &seen.greatest_step.limit;
    assert!(limit.to_string().contains("stiffness of a bond in wire 1 (wire layer)"), "{limit}");
    assert_eq!(texts(&mut engine), Vec::<String>::new());
}

#[test]
fn the_step_shrinks_as_contacts_close() {
    // The outer wires are pressed onto the core.
    let mut engine = engine(STRAND, &["bond.rupture=", "grip.kind=jaw", "grip.clamp_pressure=150 MPa"]);
    run_steps(&mut engine, 2500);
    let seen = engine.findings();
    assert!(seen.least_step.seconds < 0.97 * seen.greatest_step.seconds, "{seen:?}");
    assert!(seen.least_step.step > 0 && by_contact(&seen.least_step.limit), "{:?}", seen.least_step);
}

/// Particles without bonds, squeezed between two wires that are held and led; a free wire beside them sets the step while
/// they are hardly touched.
const LIGHT: &str = r#"
about = "Light grains are squeezed between two wires."
[bond]
law = "elastic"
[contact]
normal = "hertz"
tangential = "none"
[[wire]]
diameter = "0.4 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "4 mm"]
[[wire]]
diameter = "0.4 mm"
from = ["0.39999 mm", "0 mm", "0 mm"]
to = ["0.39999 mm", "0 mm", "4 mm"]
[[wire]]
diameter = "0.4 mm"
from = ["-0.4 mm", "0 mm", "0 mm"]
to = ["-0.4 mm", "0 mm", "4 mm"]
[[wire]]
diameter = "0.4 mm"
from = ["9 mm", "0 mm", "0 mm"]
to = ["9 mm", "0 mm", "4 mm"]
[[hold]]
body = 1
fix = ["x", "y", "z", "rx", "ry", "rz"]
velocity = ["-1 m/s", "0 m/s", "0 m/s"]
[[hold]]
body = 2
fix = ["x", "y", "z", "rx", "ry", "rz"]
[stop]
time = "20 us"
"#;

#[test]
fn a_step_that_collapses_is_said_with_its_reason() {
    let light = |factor: f64| {
        move |a: &mut strandsnap::strand::assembly::Assembly| {
            for p in a.wires[0].particles() {
                a.rest_length[p] = 0.0;
                a.mass[p] *= factor;
                a.inertia[p] *= factor;
            }
        }
    };
    let mut heavy = edited(LIGHT, &[], light(1.0));
    run_to(&mut heavy, 1.5e-5);
    assert_eq!(texts(&mut heavy), Vec::<String>::new());
    let mut engine = edited(LIGHT, &[], light(1e-4));
    run_to(&mut engine, 1.5e-5);
    let said = texts(&mut engine);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("the time step has shrunk from") && said[0].contains("a contact in wire"), "{said:?}");
    assert!(by_contact(&engine.findings().least_step.limit));
}

#[test]
fn a_fixed_step_beyond_the_bound_is_said_at_once_and_stops_the_run() {
    let bound = engine(BAR, &[]).time_step_bound();
    let fixed = |factor: f64| format!("time.step={} s", factor * bound);
    let mut fine = engine(BAR, &[&fixed(0.95)]);
    assert_eq!(texts(&mut fine), Vec::<String>::new());
    let mut engine = engine(BAR, &[&fixed(1.5)]);
    let said = texts(&mut engine);
    assert!(said.len() == 1 && said[0].contains("is not stable") && said[0].contains("time.step"), "{said:?}");
    assert_eq!(until_it_fails(&mut engine, 20_000).expect("it must blow up").exit_code(), 4);
}

/// Collects what a run says.
#[derive(Default)]
struct Ear(Vec<Notice>);

impl Observer for Ear {
    fn start(&mut self, _: &std::sync::Arc<RunInfo>) -> Result<()> {
        Ok(())
    }
    fn notice(&mut self, notice: &Notice) -> Result<()> {
        self.0.push(notice.clone());
        Ok(())
    }
    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Runs a scene as `strandsnap run` does, without files: how it ended, and what it said.
fn heard(text: &str, set: &[&str]) -> (Result<strandsnap::run::Outcome>, Vec<Notice>) {
    let spec = spec(text, set);
    let mut ear = Ear::default();
    let stop = std::sync::atomic::AtomicBool::new(false);
    let ended = strandsnap::run::simulate(&spec, &Plan::new(&spec), assembly(&spec), &mut [&mut ear], &stop);
    (ended, ear.0)
}

#[test]
fn a_failure_is_the_last_notice() {
    let (ended, notices) = heard(BAR, &["time.step=1.5e-7 s"]);
    let failure = ended.unwrap_err();
    assert_eq!(failure.exit_code(), 4);
    assert!(notices.len() >= 2, "{notices:?}");
    assert!(is(FindingKind::UnstableStep)(&&notices[0]) && notices[0].at.step == 0, "{notices:?}");
    assert!(is(FindingKind::Failed)(&notices.last().unwrap()));
    assert_eq!(notices.last().unwrap().to_string(), failure.to_string());
}

#[test]
fn a_pull_that_is_too_fast_is_said() {
    let (ended, notices) = heard(BAR, &["grip.speed=120 m/s", "stop.strain=60 %"]);
    ended.unwrap();
    assert!(
        notices.iter().any(|n| is(FindingKind::KineticEnergy)(&n) && n.to_string().contains("time.kinetic_limit")),
        "{notices:?}"
    );
    let (ended, notices) = heard(BAR, &["grip.speed=3 m/s", "stop.strain=10 %"]);
    let outcome = ended.unwrap();
    assert_eq!(notices, []);
    assert!(outcome.limits.energy_residual_greatest_percent.unwrap() < 0.1, "{:?}", outcome.limits);
}

const FLAT: &str = r#"bond.hardening={ form = "swift", strength = "400 MPa", prestrain = "0.5 %", exponent = 0.08 }"#;

/// Considère: K(ε₀ + p)^n passes its maximum load at p = n − ε₀.
#[test]
fn a_neck_is_foretold_and_then_seen() {
    let foretold = cautions(&spec(BAR, &[FLAT]));
    assert!(foretold.len() == 1 && foretold[0].contains("plastic strain of 7.5 %"), "{foretold:?}");
    assert_eq!(cautions(&spec(BAR, &[FLAT, "stop.strain=5 %"])), Vec::<String>::new());
    assert_eq!(cautions(&spec(BAR, &[])), Vec::<String>::new());
    let mut engine = engine(BAR, &[FLAT]);
    run_while(&mut engine, |e| e.strain() < 0.07);
    assert_eq!(texts(&mut engine), Vec::<String>::new(), "strain is uniform up to there");
    run_while(&mut engine, |e| e.strain() < 0.3);
    let said = texts(&mut engine);
    assert_eq!(said.len(), 1, "{said:?}");
    for word in ["strain localises: bond", "wire 1", "Considère", "spacing"] {
        assert!(said[0].contains(word), "{word}: {said:?}");
    }
}

/// A strand with strong scatter that breaks wire by wire: contacts stay shallow, nothing crosses, nothing necks.
#[test]
fn an_ordinary_fracture_hears_nothing() {
    for shape in ["sphere", "wire"] {
        let (ended, notices) = heard(STRAND, &[&format!("contact.shape={shape}"), "stop.strain=6 %"]);
        let outcome = ended.unwrap();
        let deepest = outcome.limits.deepest_contact.unwrap();
        println!("{shape}: {deepest:?}");
        assert!(matches!(deepest.between[0], Body::Wire { .. }) && deepest.overlap_percent_of_radius > 0.1);
        // Its loading is as fast as a test can bear.
        let of_loading = [FindingKind::KineticEnergy, FindingKind::GripForcesDiffer, FindingKind::TooShort];
        assert!(notices.iter().all(|n| of_loading.contains(&n.finding.kind())), "{notices:?}");
    }
}

#[test]
fn a_contact_too_deep_for_its_law_is_said_with_its_place() {
    let (ended, notices) =
        heard(STRAND, &["bond.rupture=", "grip.kind=jaw", "grip.clamp_pressure=1500 MPa", "stop.strain=4 %"]);
    let deep: Vec<_> = notices.iter().filter(is(FindingKind::DeepContact)).collect();
    assert_eq!(deep.len(), 2, "{notices:?}");
    for word in ["between wire", "(outer layer)", "z = ", "strain ", "mean pressure", "clamp_pressure"] {
        assert!(deep[0].to_string().contains(word), "{word}: {deep:?}");
    }
    // The law's parabola is left at a tenth: what is said at once is the first contact beyond it, and at the end the deepest.
    let depth = deep.iter().map(|notice| match notice.finding {
        Finding::DeepContact { overlap_over_radius, .. } => overlap_over_radius,
        _ => unreachable!(),
    });
    let depth: Vec<f64> = depth.collect();
    let deepest = ended.unwrap().limits.deepest_contact.unwrap();
    assert!((0.1..0.11).contains(&depth[0]) && depth[1] > depth[0], "{deep:?}");
    assert_eq!((100.0 * depth[1], deep[1].at.step), (deepest.overlap_percent_of_radius, deepest.step));
}

/// Two crossed wires, every particle held; the upper one is led down through the lower.
const CROSSED: &str = r#"
about = "One wire is led through another."
[bond]
law = "elastic"
[contact]
normal = "thornton"
limiting_pressure = "300 MPa"
tangential = "none"
[[wire]]
diameter = "0.4 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "8 mm"]
[[wire]]
diameter = "0.4 mm"
from = ["-4 mm", "0.45 mm", "3.9 mm"]
to = ["4.1 mm", "0.45 mm", "4 mm"]
[[hold]]
body = 0
fix = ["x", "y", "z", "rx", "ry", "rz"]
[[hold]]
body = 1
fix = ["x", "y", "z", "rx", "ry", "rz"]
velocity = ["0 m/s", "-20 m/s", "0 m/s"]
[stop]
time = "100 us"
[time]
step = "5e-8 s"
"#;

#[test]
fn wires_that_pass_through_each_other_stop_the_run() {
    for (shape, spacing) in [("sphere", "1"), ("wire", "1"), ("sphere", "0.5"), ("sphere", "1.9"), ("wire", "1.9")] {
        let set = [format!("contact.shape={shape}"), format!("spacing={spacing}")];
        let mut engine = engine(CROSSED, &set.each_ref().map(String::as_str));
        let failure = until_it_fails(&mut engine, 800).unwrap_or_else(|| panic!("{shape} {spacing}: nothing was seen"));
        let said = failure.to_string();
        assert!(said.contains("wire 1") && said.contains("wire 2") && said.contains("passed through"), "{said}");
        // The axes meet after 0.45 mm; the search that sees it comes within a skin of that.
        let way = 20.0 * engine.time();
        assert!((0.45e-3..0.53e-3).contains(&way), "{shape} {spacing}: {way}");
        // Wires of spheres 1.9 diameters apart let each other through without a touch.
        let gaps = cautions(&spec(CROSSED, &set.each_ref().map(String::as_str)));
        assert_eq!(gaps.len(), usize::from(shape == "sphere" && spacing == "1.9"), "{gaps:?}");
    }
}

/// Two soft spheres that meet a little off their centres.
const SPHERES: &str = r#"
about = "A sphere flies at another."
material = { young = "200 GPa" }
[contact]
normal = "hertz"
[[sphere]]
diameter = "1 mm"
position = ["0 mm", "0 mm", "0 mm"]
[[sphere]]
diameter = "0.8 mm"
position = ["0.1 mm", "0 mm", "1 mm"]
velocity = ["0 m/s", "0 m/s", "-100 m/s"]
[stop]
time = "40 us"
"#;

#[test]
fn a_sphere_that_passes_through_another_body_stops_the_run() {
    let soft = "material.young=1 MPa";
    let (ended, _) = heard(SPHERES, &[soft]);
    let said = ended.unwrap_err().to_string();
    assert!(said.contains("the centre of free sphere 2 has passed into free sphere 1"), "{said}");
    let wire =
        "wire=[{ diameter = \"0.5 mm\", from = [\"0 mm\", \"-3 mm\", \"0 mm\"], to = [\"0 mm\", \"3 mm\", \"0 mm\"] }]";
    for shape in ["sphere", "wire"] {
        for spacing in ["1", "1.6"] {
            let sphere = "sphere=[{ diameter = \"0.8 mm\", position = [\"0.05 mm\", \"0.2 mm\", \"1 mm\"], velocity = [\"0 m/s\", \"0 m/s\", \"-100 m/s\"] }]";
            let set = [wire, sphere, soft, &format!("contact.shape={shape}"), &format!("spacing={spacing}")];
            let (ended, _) = heard(SPHERES, &set);
            let said = ended.unwrap_err().to_string();
            assert!(said.contains("the centre of free sphere 1 has passed into bond"), "{shape} {spacing}: {said}");
        }
    }
}

#[test]
fn spheres_that_bounce_do_not_stop_it_and_have_no_strain() {
    let (ended, _) = heard(SPHERES, &[]);
    let limits = ended.unwrap().limits;
    let deepest = limits.deepest_contact.unwrap();
    assert!(deepest.overlap_percent_of_radius > 1.0, "{deepest:?}");
    assert_eq!([deepest.strain_percent, limits.least_time_step.strain_percent], [None; 2]);
    assert_eq!(limits.greatest_time_step.strain_percent, None);
}

#[test]
fn wires_that_meet_and_part_do_not_stop_it() {
    // Down by 0.3 mm, which crushes the contact, and up again.
    let mut engine = engine(CROSSED, &["hold.1.velocity=[\"5 m/s\", \"-20 m/s\", \"3 m/s\"]"]);
    run_steps(&mut engine, 300);
    let deep = texts(&mut engine);
    assert!(deep.len() == 1 && deep[0].contains("of the radius deep"), "{deep:?}");
    engine.check_crossings().unwrap();
}

/// A wire that bends, in a plan that left the bending out.
#[test]
fn rotations_left_out_but_needed_stop_the_run() {
    let sideways = |a: &mut strandsnap::strand::assembly::Assembly| {
        add_velocity(a, |x| DVec3::X * (1.0 - (x.z / 8e-3 - 1.0).powi(2)));
    };
    let mut engine = edited(BAR, &[], sideways);
    assert!(!engine.plan().rotations);
    let said = until_it_fails(&mut engine, 500).expect("it bends").to_string();
    assert!(said.contains("wire 1") && said.contains("rotations were left out"), "{said}");
    let mut general = edited(BAR, &["plan=general"], sideways);
    assert!(until_it_fails(&mut general, 500).is_none());
}

/// A straight wire in no need of contacts, until it folds onto itself.
#[test]
fn contacts_left_out_but_needed_are_added() {
    const FOLDS: &str = r#"
about = "A wire flies in one piece."
[bond]
law = "elasto-plastic"
damping = 0.1
hardening = { form = "voce", yield_stress = "100 MPa", saturation = "180 MPa", rate = 12, linear = "550 MPa" }
[contact]
normal = "hertz"
[[wire]]
diameter = "0.4 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["8 mm", "0 mm", "0 mm"]
[stop]
time = "1 ms"
"#;
    let mut engine = edited(FOLDS, &[], |a| {
        // Both halves swing up about the middle.
        for p in 0..a.len() {
            let s = a.position.get(p).x - 4e-3;
            a.velocity.set(p, DVec3::Y * (5e4 * s.abs()));
            a.spin.set(p, DVec3::Z * (5e4 * s.signum()));
        }
    });
    assert_eq!(engine.contact_counts().1, 0);
    assert!(texts(&mut engine).is_empty());
    let mut touched = false;
    for _ in 0..200 {
        assert!(until_it_fails(&mut engine, 50).is_none());
        touched |= engine.contact_counts().2 > 0;
    }
    let said = texts(&mut engine);
    assert!(said.iter().any(|s| s.contains("turned back on itself")), "{said:?}");
    assert!(touched, "the two halves must meet");
}
