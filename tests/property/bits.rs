//! One result, however it is computed: threads, plan, skin of the neighbour list, order of the wires.

use crate::drive::*;
use proptest::prelude::*;

#[test]
fn threads_do_not_change_a_bit() {
    // Long enough for several chunks of particles and of contacts.
    let set = ["strand.length=60 mm", "grip.speed=50 m/s", "bond.rupture.strain=2 %"];
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut engine = engine(STRAND, &set);
            run_steps(&mut engine, 800);
            Outcome::of(&mut engine)
        })
    };
    let one = run(1);
    assert!(one.position.len() > 1024, "{} particles are too few chunks", one.position.len());
    assert!(one.ruptures.len() > 3, "{} ruptures", one.ruptures.len());
    for threads in [2, 3] {
        run(threads).assert_same(&one, &format!("{threads} threads"));
    }
    // As many as it finds best, and others halfway.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap();
    let mut tuned = pool.install(|| engine(STRAND, &set));
    assert_eq!(tuned.threads(), [4, 4]);
    tuned.tune_threads();
    run_steps(&mut tuned, 500);
    assert!((1..=4).contains(&tuned.threads()[0]), "{:?}", tuned.threads());
    tuned.set_threads(2).unwrap();
    assert_eq!(tuned.threads(), [2, 2]);
    run_steps(&mut tuned, 300);
    Outcome::of(&mut tuned).assert_same(&one, "threads that change");
}

#[test]
fn no_more_threads_than_there_is_work_for() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(8).build().unwrap();
    // 301 particles: two chunks.
    let wire = pool.install(|| engine(WIRE, &["wire.0.to=[\"0 mm\", \"0 mm\", \"120 mm\"]"]));
    assert_eq!((wire.assembly().len().div_ceil(256), wire.threads()), (2, [2, 2]));
}

const WIRE: &str = r#"
about = "One wire pulled to fracture."
[bond]
law = "elasto-plastic"
damping = 0.02
hardening = { form = "voce", yield_stress = "100 MPa", saturation = "180 MPa", rate = 12, linear = "550 MPa" }
rupture = { criterion = "plastic-strain", strain = "3 %", weibull_modulus = 20 }
[contact]
normal = "thornton"
friction = 0.2
hardness_strain = "8 %"
damping = 0.1
[[wire]]
diameter = "0.39 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "20 mm"]
[grip]
length = "2 mm"
speed = "10 m/s"
[stop]
strain = "20 %"
"#;

/// Runs a scene under both plans and asserts that they agree. The step is fixed: modes that a special plan leaves out
/// do not limit its step, so the two would choose different ones.
fn special_is_general(set: &[&str], steps: u64) -> (Outcome, String) {
    let set = [set, &["time.step=6e-8 s"]].concat();
    let mut special = engine(WIRE, &set);
    let mut general = engine(WIRE, &[&set[..], &["plan=general"]].concat());
    assert!(general.plan().rotations && !special.plan().rotations);
    assert!(special.time_step_bound() >= general.time_step_bound() && general.time_step_bound() > 6e-8);
    let plan = special.plan().to_string();
    for _ in 0..steps / 100 {
        run_steps(&mut special, 100);
        run_steps(&mut general, 100);
        let a = Outcome { ruptures: Vec::new(), ..Outcome::of(&mut special) };
        let b = Outcome { ruptures: Vec::new(), ..Outcome::of(&mut general) };
        a.assert_same(&b, &format!("step {}", special.steps()));
    }
    (Outcome::of(&mut special), plan)
}

#[test]
fn a_wire_pulled_to_fracture_needs_no_rotations_and_no_contacts() {
    let (end, _) = special_is_general(&[], 3000);
    assert!(end.whole.iter().filter(|w| !**w).count() > 1, "a bond must break, besides the slot that has none");
    assert!(end.energy.plastic_bonds > 0.0);
}

/// Ways in which a wire may be made, rupture criteria with them.
fn wire() -> impl Strategy<Value = Vec<String>> {
    let law = prop_oneof![
        (60.0..200.0, 0.05..0.5).prop_map(|(stress, n)| {
            let law = format!("bond.hardening={{ form = \"ludwik\", yield_stress = \"{stress} MPa\", strength = \"400 MPa\", exponent = {n} }}");
            let rupture = "bond.rupture={ criterion = \"fibre-strain\", strain = \"4 %\", weibull_modulus = 15 }";
            vec![law, rupture.into()]
        }),
        (1.0..4.0).prop_map(|strain| vec![format!("bond.rupture.strain={strain} %")]),
        (200.0..900.0).prop_map(|stress| {
            let rupture = format!("bond.rupture={{ criterion = \"beam-stress\", tensile = \"{stress} MPa\", shear = \"{stress} MPa\", weibull_modulus = 20 }}");
            vec!["bond.law=elastic".into(), "bond.hardening=".into(), "contact.normal=hertz".into(), "contact.hardness_strain=".into(), rupture]
        }),
    ];
    let rest = (6.0..20.0, 0.0..0.3, prop_oneof![Just("sphere"), Just("wire")], 0.6..1.5, 2.0..12.0);
    (law, rest).prop_map(|(mut set, (length, damping, shape, spacing, speed))| {
        set.extend([
            format!("wire.0.to=[\"0 mm\", \"0 mm\", \"{length} mm\"]"),
            format!("bond.damping={damping}"),
            format!("contact.shape={shape}"),
            format!("spacing={spacing}"),
            format!("grip.speed={speed} m/s"),
            // A step that suits the finest spacing, whatever the mode that the general plan adds.
            "time.step=1.5e-8 s".into(),
        ]);
        set
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_straight_wire_needs_no_rotations_and_no_contacts(set in wire()) {
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let mut special = engine(WIRE, &set);
        let mut general = engine(WIRE, &[&set[..], &["plan=general"]].concat());
        prop_assert!(general.plan().rotations && !special.plan().rotations);
        prop_assert!(general.time_step_bound() > 1.5e-8, "{}", general.time_step_bound());
        for _ in 0..3 {
            run_steps(&mut special, 800);
            run_steps(&mut general, 800);
            let a = Outcome { ruptures: Vec::new(), ..Outcome::of(&mut special) };
            let b = Outcome { ruptures: Vec::new(), ..Outcome::of(&mut general) };
            a.assert_same(&b, "special and general");
        }
    }

    #[test]
    fn threads_do_not_change_a_bit_of_any_strand(
        wires in 4..8usize,
        shape in prop_oneof![Just("sphere"), Just("wire")],
        tangential in prop_oneof![Just("mindlin"), Just("mindlin-deresiewicz")],
        elastic in any::<bool>(),
        pressure in 30.0..120.0,
    ) {
        let law: &[&str] = if elastic {
            &["bond.law=elastic", "bond.hardening=", "bond.rupture=", "contact.hardness_strain=", "contact.limiting_pressure=400 MPa"]
        } else {
            &["bond.rupture.strain=0.3 %"]
        };
        let own = [
            format!("strand.layer.1.wires={wires}"),
            format!("contact.shape={shape}"),
            format!("contact.tangential={tangential}"),
            format!("grip.clamp_pressure={pressure} MPa"),
        ];
        let mut set = vec!["strand.length=60 mm", "grip.kind=jaw", "grip.speed=50 m/s"];
        set.extend(law.iter().copied().chain(own.iter().map(String::as_str)));
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut engine = engine(STRAND, &set);
                run_steps(&mut engine, 150);
                Outcome::of(&mut engine)
            })
        };
        let one = run(1);
        prop_assert!(one.position.len() > 700, "{} particles are too few chunks", one.position.len());
        run(3).assert_same(&one, "3 threads");
    }
}

/// Every scene that is shipped, for as many steps as a test has time for.
#[test]
fn every_shipped_scene_is_the_same_under_the_general_plan() {
    let mut special_plans = Vec::new();
    for (name, text) in strandsnap::scene::builtin::list() {
        // One step that suits both: modes that a plan leaves out do not limit its own.
        let step = ["plan=auto", "plan=general"].map(|plan| engine(text, &[plan]).time_step());
        let fixed = format!("time.step={} s", 0.5 * step[0].min(step[1]));
        let [mut special, mut general] = ["plan=auto", "plan=general"].map(|plan| engine(text, &[plan, &fixed]));
        if special.plan() != general.plan() {
            special_plans.push(*name);
        }
        let steps = if special.assembly().len() > 2000 { 80 } else { 2000 };
        run_steps(&mut special, steps);
        run_steps(&mut general, steps);
        Outcome::of(&mut special).assert_same(&Outcome::of(&mut general), name);
    }
    println!("special plans: {special_plans:?}");
    for name in ["single-wire", "two-spheres"] {
        assert!(special_plans.contains(&name), "{name} must not be compared with itself");
    }
}

#[test]
fn an_elastic_bar_needs_no_rotations() {
    let (end, plan) = special_is_general(&["bond.law=elastic", "bond.hardening=", "bond.rupture=", "contact="], 1000);
    assert!(plan.contains("nothing turns"), "{plan}");
    assert!(end.energy.elastic_bonds > 0.0);
}

/// The search finds every pair before it touches, whatever the skin: forces are the same to the bit. Hertz, because a
/// pair that leaves the list forgets its dent, and how far it must part for that is the skin's business. The step is
/// fixed, because pairs of the list that are about to meet limit it.
#[test]
fn a_skin_changes_nothing_but_the_number_of_searches() {
    for (shape, smooth) in [("sphere", false), ("wire", true)] {
        let run = |skin: &str| {
            let (skin, shape) = (format!("contact.skin={skin}"), format!("contact.shape={shape}"));
            // Where smooth wires have broken, the half bonds beyond their last particles still are found a little later
            // with a thinner skin.
            let breaks = if smooth { "bond.rupture.strain=50 %" } else { "seed=1" };
            let mut engine = engine(
                STRAND,
                &[&skin, &shape, breaks, "contact.normal=hertz", "contact.hardness_strain=", "time.step=6e-8 s"],
            );
            run_steps(&mut engine, 2500);
            let searches = engine.contact_counts().0;
            (Outcome::of(&mut engine), searches)
        };
        let (thin, often) = run("0.002");
        let (thick, seldom) = run("0.4");
        println!("{shape}: {often} and {seldom} searches, {} ruptures", thin.ruptures.len());
        assert!(often > 10 * seldom, "{often} searches are not many more than {seldom}");
        assert!(thin.ruptures.is_empty() == smooth && thin.energy.friction > 0.0);
        let mut rounding = 1e-12;
        if smooth {
            // A contact begins to follow its foot when it gets on the list; from there on it differs by rounding.
            let apart = thin.position.iter().zip(&thick.position).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
            println!("{apart:e} m apart");
            assert!(apart < 1e-13, "{apart:e} m apart");
            rounding = 1e-6;
        } else {
            thin.assert_same_motion(&thick, shape);
        }
        // Energies are summed over chunks of the list, whose borders differ.
        assert!((thin.energy.friction / thick.energy.friction - 1.0).abs() < rounding);
    }
}

#[test]
fn the_order_of_wires_changes_results_by_rounding_only() {
    // Turning the phase by one wire renumbers the outer layer; the strand is the same.
    let run = |phase: f64| {
        let phase = format!("strand.layer.1.phase={phase} deg");
        let mut engine = engine(STRAND, &[&phase, "bond.rupture.weibull_modulus=", "bond.rupture.strain=50 %"]);
        run_steps(&mut engine, 600);
        let len = engine.assembly().wires[1].len;
        let outcome = Outcome::of(&mut engine);
        (outcome, len)
    };
    let (first, len) = run(0.0);
    let (second, _) = run(60.0);
    let core = first.position.len() - 6 * len;
    // Wire k of the second is wire k + 1 of the first.
    let mut renumbered = first.position[..core].to_vec();
    for k in 0..6 {
        let from = core + (k + 1) % 6 * len;
        renumbered.extend_from_slice(&first.position[from..from + len]);
    }
    let apart = distance(&renumbered, &second.position);
    println!("renumbered: {apart:e}");
    // A strand in contact is chaotic in the end; over this run, rounding of 1e-19 m grows by less than 1e5.
    assert!(apart < 1e-14, "{apart:e} m");
    assert!(apart > 0.0, "the order of summation must differ, or this test compares one run with itself");
}

#[test]
fn a_bond_that_breaks_at_the_start_is_no_bond() {
    const FREE_WIRE: &str = r#"
about = "One wire that is thrown apart."
[bond]
law = "elastic"
damping = 0.02
rupture = { criterion = "fibre-strain", strain = "10 %" }
[contact]
normal = "hertz"
[[wire]]
diameter = "0.39 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "6 mm"]
spin = ["300 rad/s", "0 rad/s", "0 rad/s"]
[stop]
time = "1 ms"
"#;
    let set = ["plan=general"];
    let slot = 7;
    // The two halves bounce: the upper one flies down.
    let throw = |a: &mut strandsnap::strand::assembly::Assembly| {
        for p in slot + 1..a.len() {
            a.velocity.add(p, glam::DVec3::new(0.3, 0.1, -2.0));
        }
    };
    let mut broken = edited(FREE_WIRE, &set, |a| {
        throw(a);
        // This bond is too long from the start.
        a.rest_length[slot] *= 0.8;
    });
    let mut never = edited(FREE_WIRE, &set, |a| {
        throw(a);
        a.rest_length[slot] = 0.0;
        let whole = a.wires[0];
        a.wires[0].len = slot + 1;
        a.wires.push(strandsnap::strand::assembly::Wire { first: slot + 1, len: whole.len - slot - 1, ..whole });
        (slot + 1..a.len()).for_each(|p| a.wire_of[p] = 1);
    });
    assert!(!broken.state().whole[slot]);
    assert_eq!(broken.take_ruptures().len(), 1);
    let mut touched = false;
    for _ in 0..20 {
        run_steps(&mut broken, 100);
        run_steps(&mut never, 100);
        touched |= broken.contact_counts().2 > 0;
        let (a, b) = (Outcome::of(&mut broken), Outcome::of(&mut never));
        a.assert_same_motion(&b, "broken at the start");
    }
    assert!(touched, "the halves must meet");
}
