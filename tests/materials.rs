//! Several materials in one scene, against closed forms, and one material by a name against the same without.

use std::path::Path;
use strandsnap::engine::Engine;
use strandsnap::observe::materials::GreatestForce;
use strandsnap::reference::hertz::Pair;
use strandsnap::reference::plasticity::tension_point;
use strandsnap::scene::spec::{BondLawSpec, RuptureCriterion, Spec};
use strandsnap::scene::{self, Scene};
use strandsnap::strand as body;

const STEEL: &str = r#"density = "7800 kg/m^3"
young = "200 GPa"
poisson = 0.3
"#;
const ALUMINIUM: &str = r#"density = "2700 kg/m^3"
young = "69 GPa"
poisson = 0.33
"#;

fn load(text: &str, set: &[&str]) -> Scene {
    let set: Vec<String> = set.iter().map(ToString::to_string).collect();
    scene::parse(text, "test.toml", Path::new("."), &set).unwrap_or_else(|error| panic!("{error:?}"))
}

fn engine_of(scene: &Scene) -> Engine {
    Engine::new(&scene.spec, &scene.plan, body::build(&scene.spec).unwrap()).unwrap()
}

fn close(value: f64, right: f64, tolerance: f64, what: &str) {
    assert!((value / right - 1.0).abs() <= tolerance, "{what}: {value} instead of {right}");
}

/// Two wires side by side, apart, of steel and aluminium and of unlike diameters.
fn beside(steel: &str, aluminium: &str) -> String {
    format!(
        r#"about = "Two wires of unlike material pulled side by side."
[materials.steel]
{STEEL}{steel}
[materials.aluminium]
{ALUMINIUM}{aluminium}
[[wire]]
material = "steel"
diameter = "1 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "40 mm"]
[[wire]]
material = "aluminium"
diameter = "2 mm"
from = ["4 mm", "0 mm", "0 mm"]
to = ["4 mm", "0 mm", "40 mm"]
[grip]
length = "4 mm"
speed = "0.5 m/s"
[stop]
strain = "20 %"
"#
    )
}

/// EA adds up, and each wire carries its own share: N_i = E_i A_i ln(1 + ε), as bonds of log strain have it.
#[test]
fn side_by_side_unlike_wires_share_the_load_by_their_stiffness() {
    for law in ["", "damping = 0.1"] {
        let scene = load(&beside(law, law), &[]);
        let mut engine = engine_of(&scene);
        while engine.strain() < 2e-3 {
            engine.step().unwrap();
        }
        let sample = engine.sample();
        let strain = sample.strain.ln_1p();
        let stiffness = [200e9, 69e9]
            .into_iter()
            .zip([1e-3_f64, 2e-3])
            .map(|(young, diameter)| young * std::f64::consts::FRAC_PI_4 * diameter * diameter);
        let expected: Vec<f64> = stiffness.map(|ea| ea * strain).collect();
        for (wire, expected) in expected.iter().enumerate() {
            close(sample.wire_pull[wire], *expected, 2e-4, &format!("force of wire {wire}"));
            let area = engine.assembly().wires[wire].area();
            close(sample.wire_stress[wire], expected / area, 2e-4, &format!("stress of wire {wire}"));
        }
        // The grip feels a pull that began at once; what rings is a little of it.
        close(sample.grip_force[1], expected.iter().sum(), 5e-3, "force of the grip");
    }
}

/// A wire that snaps is missed in the middle before the grip knows of it: what carries the greatest force is told of before that.
#[test]
fn at_the_greatest_force_the_parts_add_up() {
    let rupture = |strain: f64| {
        format!("rupture = {{ criterion = \"beam-stress\", tensile = \"{} MPa\", shear = \"9 GPa\" }}", strain * 200e3)
    };
    let scene = load(&beside(&rupture(2e-3), ""), &[]);
    let mut engine = engine_of(&scene);
    let (info, mut rule, mut told) = (engine.info(), GreatestForce::default(), None);
    let mut end = f64::INFINITY;
    while engine.time() < end {
        engine.step().unwrap();
        if !engine.take_ruptures().is_empty() {
            // Aluminium alone has not come to as much by then.
            end = engine.time() + 6.0 * info.wave_passage;
        }
        let sample = engine.sample();
        if rule.see(&info, &sample) {
            told = Some(sample);
        }
    }
    let told = told.unwrap();
    let steel = 400e6 * std::f64::consts::FRAC_PI_4 * 1e-6;
    close(told.wire_pull[0], steel, 0.02, "steel, which breaks at 400 MPa");
    close(told.wire_pull.iter().sum(), told.grip_force[1], 0.02, "sum of the parts");
}

/// An elastic and an elasto-plastic material, or two that harden differently: each bond breaks where its own law and its own
/// limit say, the less ductile first, at a strain that has a closed form.
#[test]
fn the_material_with_the_lower_fracture_strain_breaks_first() {
    let plastic = |strain: f64| {
        format!(
            "law = \"elasto-plastic\"\nhardening = {{ form = \"voce\", yield_stress = \"100 MPa\", saturation = \"50 MPa\", \
             rate = 50, linear = \"900 MPa\" }}\nrupture = {{ criterion = \"plastic-strain\", strain = {strain} }}\n"
        )
    };
    let elastic = |strain: f64| format!("rupture = {{ criterion = \"fibre-strain\", strain = {strain} }}\n");
    let cases = [
        (plastic(0.02), plastic(0.01), 1),
        (plastic(0.01), plastic(0.02), 0),
        (elastic(0.015), plastic(0.01), 1),
        (elastic(0.005), plastic(0.01), 0),
    ];
    for (steel, aluminium, first) in cases {
        let scene = load(&beside(&steel, &aluminium), &["grip.speed=2 m/s"]);
        let mut engine = engine_of(&scene);
        let rupture = loop {
            engine.step().unwrap();
            if let Some(rupture) = engine.take_ruptures().first() {
                break rupture.clone();
            }
            assert!(engine.strain() < 0.05, "nothing breaks");
        };
        assert_eq!(rupture.wire, first, "{rupture:?}");
        close(rupture.strain, fracture_strain(&scene.spec, first), 0.02, "strain at the first break");
    }
}

/// Strain of a straight wire of material `number` when its bonds reach their limit (-).
fn fracture_strain(spec: &Spec, number: usize) -> f64 {
    let one = spec.material_at(number);
    match (&one.bond.law, &one.bond.rupture.as_ref().unwrap().criterion) {
        (BondLawSpec::ElastoPlastic(law), RuptureCriterion::PlasticStrain { strain }) => {
            tension_point(*strain, law.stress(*strain), one.material.young).engineering_strain
        }
        (_, RuptureCriterion::FibreStrain { strain }) => *strain,
        other => panic!("{other:?}"),
    }
}

/// A sphere of steel and one of aluminium, of unlike size.
const COLLISION: &str = r#"about = "Two unlike spheres collide head-on."
[contact]
normal = "hertz"
tangential = "none"
[[sphere]]
material = "steel"
diameter = "10 mm"
position = ["0 mm", "0 mm", "-5 mm"]
velocity = ["0 m/s", "0 m/s", "0.5 m/s"]
[[sphere]]
material = "aluminium"
diameter = "16 mm"
position = ["0 mm", "0 mm", "8 mm"]
velocity = ["0 m/s", "0 m/s", "-0.5 m/s"]
[time]
step = "10 ns"
[stop]
time = "80 us"
"#;

fn unlike_pair() -> Pair {
    let [steel, aluminium] = [(5e-3_f64, 200e9, 0.3, 7800.0), (8e-3, 69e9, 0.33, 2700.0)];
    let mass =
        |(radius, _, _, density): (f64, f64, f64, f64)| density * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let compliance = |(_, young, poisson, _): (f64, f64, f64, f64)| (1.0 - poisson * poisson) / young;
    Pair {
        modulus: 1.0 / (compliance(steel) + compliance(aluminium)),
        radius: 1.0 / (1.0 / steel.0 + 1.0 / aluminium.0),
        mass: 1.0 / (1.0 / mass(steel) + 1.0 / mass(aluminium)),
    }
}

#[test]
fn unlike_spheres_meet_with_the_modulus_of_the_pair() {
    let text = format!("{COLLISION}[materials.steel]\n{STEEL}[materials.aluminium]\n{ALUMINIUM}");
    let mut engine = engine_of(&load(&text, &[]));
    let (mut deepest, mut end, mut before) = (0.0_f64, None, 0.0);
    while engine.time() < 80e-6 {
        engine.step().unwrap();
        let s = engine.state();
        let overlap = s.radius[0] + s.radius[1] - (s.x.get(1) - s.x.get(0)).length();
        if before > 0.0 && overlap <= 0.0 && end.is_none() {
            end = Some(engine.time());
        }
        (deepest, before) = (deepest.max(overlap), overlap);
    }
    let pair = unlike_pair();
    close(deepest, pair.greatest_overlap(1.0), 1e-4, "greatest overlap");
    close(end.expect("they part"), pair.contact_time(1.0), 1e-3, "contact time");
}

/// Of unlike materials the softer gives way: beyond the yield force of its limiting pressure the force follows π p_y R* δ.
#[test]
fn between_unlike_materials_the_lower_limiting_pressure_holds() {
    for (steel, aluminium, softer) in [("3 GPa", "500 MPa", 500e6), ("500 MPa", "3 GPa", 500e6)] {
        let text = format!(
            "{COLLISION}[materials.steel]\n{STEEL}limiting_pressure = \"{steel}\"\n[materials.aluminium]\n{ALUMINIUM}\
             limiting_pressure = \"{aluminium}\"\n"
        );
        let mut engine = engine_of(&load(&text, &["contact.normal=thornton"]));
        let (mut greatest, mut pushed) = (0.0_f64, 0.0_f64);
        while engine.time() < 40e-6 {
            engine.step().unwrap();
            let s = engine.state();
            let overlap = s.radius[0] + s.radius[1] - (s.x.get(1) - s.x.get(0)).length();
            if overlap > greatest {
                let force = engine.snapshot().contact_pressure[0];
                (greatest, pushed) = (overlap, f64::from(force) * std::f64::consts::PI * 25e-6);
            }
        }
        let pair = unlike_pair();
        let expected = strandsnap::reference::thornton::force(&pair, softer, greatest, greatest);
        close(pushed, expected, 1e-3, "force at the greatest overlap");
    }
}

/// The friction of a pair of materials is its own: a sphere that slides on a held one is slowed by μ F_n.
#[test]
fn friction_is_that_of_the_pair() {
    let text = |pair: &str| {
        format!(
            r#"about = "A sphere is pressed onto a held wire and drawn along it."
[materials.steel]
{STEEL}[materials.aluminium]
{ALUMINIUM}
[contact]
normal = "hertz"
tangential = "mindlin"
friction = 0.2
shape = "wire"
{pair}
[[wire]]
material = "steel"
diameter = "1 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "10 mm"]
[[sphere]]
material = "aluminium"
diameter = "1 mm"
position = ["1 mm", "0 mm", "5 mm"]
[[hold]]
body = 0
part = "all"
fix = ["x", "y", "z", "rx", "ry", "rz"]
[[hold]]
body = 1
part = "all"
fix = ["y", "z", "rx", "ry", "rz"]
velocity = ["0 m/s", "0 m/s", "0.1 m/s"]
force = ["-1 N", "0 N", "0 N"]
[stop]
time = "1 ms"
"#
        )
    };
    let lost = |pair: &str| {
        let mut engine = engine_of(&load(&text(pair), &["contact.damping=0.3"]));
        let mut at = [0.0; 2];
        for (k, time) in [0.5e-3, 1e-3].into_iter().enumerate() {
            while engine.time() < time {
                engine.step().unwrap();
            }
            at[k] = engine.energy().friction;
        }
        // Over half a millisecond at 0.1 m/s under 1 N.
        (at[1] - at[0]) / (0.5e-3 * 0.1 * 1.0)
    };
    close(lost(""), 0.2, 0.01, "friction of the scene");
    let pair =
        |friction: f64| format!("[[contact.pair]]\nmaterials = [\"aluminium\", \"steel\"]\nfriction = {friction}\n");
    close(lost(&pair(0.45)), 0.45, 0.01, "friction of the pair");
    assert!(lost(&pair(0.0)).abs() < 1e-9, "a smooth pair");
    let like = "[[contact.pair]]\nmaterials = [\"steel\", \"steel\"]\nfriction = 0.6\n";
    close(lost(like), 0.2, 0.01, "another pair's friction is not theirs");
}

const STRANDED: &str = r#"about = "A strand of three layers, pulled."
MATERIAL
[contact]
normal = "thornton"
tangential = "mindlin"
friction = 0.2
shape = "sphere"
hardness_factor = 2.8
hardness_strain = "8 %"
damping = 0.1
[strand]
length = "30 mm"
wire_diameter = "0.39 mm"
pitch = "39 mm"
STRAND
[[strand.layer]]
name = "inner"
wires = 5
INNER
[[strand.layer]]
name = "middle"
wires = 11
[[strand.layer]]
name = "outer"
wires = 18
lay_radius = "1.165 mm"
[grip]
length = "3 mm"
speed = "20 m/s"
[stop]
strain = "40 %"
"#;
const COPPER: &str = "density = \"8960 kg/m^3\"\nyoung = \"115 GPa\"\npoisson = 0.34\n";
const COPPER_BOND: &str = r#"law = "elasto-plastic"
damping = 0.02
hardening = { form = "voce", yield_stress = "100 MPa", saturation = "177.4 MPa", rate = 12, linear = "541.8 MPa" }
rupture = { criterion = "plastic-strain", strain = "2.5 %", weibull_modulus = 30 }
"#;

/// [`STRANDED`] of one material without a name, of one with a name, and of two that are alike in all but their names.
fn three_ways() -> [String; 3] {
    let text = |material: &str, strand: &str, inner: &str| {
        STRANDED.replace("MATERIAL", material).replace("STRAND", strand).replace("INNER", inner)
    };
    let unnamed = format!("[material]\n{COPPER}[bond]\n{COPPER_BOND}");
    let named = |name: &str| format!("[materials.{name}]\n{COPPER}{COPPER_BOND}");
    [
        text(&unnamed, "", ""),
        text(&named("copper"), "material = \"copper\"", ""),
        text(&(named("copper") + &named("other")), "material = \"copper\"", "material = \"other\""),
    ]
}

fn state(engine: &Engine) -> Vec<u64> {
    let s = engine.state();
    let vectors = [&s.x, &s.v, &s.w].into_iter().flat_map(|v| v.iter().flat_map(|v| v.to_array()));
    vectors.chain(s.radius.iter().copied()).map(f64::to_bits).collect()
}

/// A name costs no bit; and two materials that are alike, whose bonds and contacts go another way through the engine, move
/// the particles by the same bits too, over yield, contact and rupture.
#[test]
fn a_name_changes_no_bit_and_neither_do_two_that_are_alike() {
    let mut engines = three_ways().map(|text| engine_of(&load(&text, &[])));
    for _ in 0..12 {
        engines.iter_mut().for_each(|engine| (0..150).for_each(|_| engine.step().unwrap()));
        let states: Vec<Vec<u64>> = engines.iter().map(state).collect();
        assert!(states[0] == states[1], "a name, step {}", engines[0].steps());
        assert!(states[0] == states[2], "two names, step {}", engines[0].steps());
    }
    let [unnamed, named, two] = &mut engines;
    let ruptures = [&mut *unnamed, &mut *named, &mut *two].map(|engine| engine.take_ruptures());
    assert!(ruptures[0].len() > 3, "{} ruptures", ruptures[0].len());
    assert_eq!(ruptures[0], ruptures[1]);
    let places = |k: usize| ruptures[k].iter().map(|r| (r.step, r.bond)).collect::<Vec<_>>();
    assert_eq!(places(0), places(2));
    assert_eq!(unnamed.energy(), named.energy());
    // Sums over two materials are made in another order.
    let (one, other) = (unnamed.energy(), two.energy());
    for (a, b) in
        [(one.internal(), other.internal()), (one.friction, other.friction), (one.plastic_bonds, other.plastic_bonds)]
    {
        close(b, a, 1e-12, "energy");
    }
    assert!(unnamed.sample().wire_pull.is_empty() && !two.sample().wire_pull.is_empty());
}

/// Smooth wires take their contacts in batches, law by law: sums come in another order, and nothing else.
#[test]
fn smooth_wires_of_two_materials_that_are_alike_move_alike() {
    let set = ["contact.shape=wire", "strand.length=16 mm"];
    let [mut one, mut two] = [0, 2].map(|k| engine_of(&load(&three_ways()[k], &set)));
    let apart = |one: &Engine, two: &Engine| {
        let (one, two) = (one.state(), two.state());
        (0..one.len()).map(|p| one.x.get(p).distance(two.x.get(p))).fold(0.0, f64::max)
    };
    let mut seen = Vec::new();
    for _ in 0..20 {
        (0..10).for_each(|_| [&mut one, &mut two].into_iter().for_each(|engine| engine.step().unwrap()));
        seen.push(apart(&one, &two));
    }
    // From the first neighbour search in which rounding decides on a bond that is nearest, they part.
    assert!(seen.iter().all(|far| *far < 1e-15), "{seen:?}");
    assert!(one.contact_counts().2 > 50 && one.contact_counts() == two.contact_counts());
}

/// What cannot be done with several materials says so.
#[test]
fn several_materials_are_refused_where_one_is_meant() {
    let scene = load(&beside("", ""), &[]);
    let error = engine_of(&scene).record_step().unwrap_err().to_string();
    assert!(error.contains("its bodies are of several materials"), "{error}");
}

/// A resolved scene names its materials, and is read back equal.
#[test]
fn a_resolved_scene_names_its_materials() {
    let text = format!("{COLLISION}[materials.steel]\n{STEEL}[materials.aluminium]\n{ALUMINIUM}");
    let scene = load(&text, &[]);
    let written = scene::write::to_toml(&scene.spec);
    assert!(written.contains("[materials.steel]") && written.contains("material = \"aluminium\""), "{written}");
    let again = scene::parse(&written, "again.toml", Path::new("."), &[]).unwrap().spec;
    assert_eq!(Spec { name: "test".into(), ..again }, Spec { name: "test".into(), ..scene.spec });
    let names: Vec<String> = engine_of(&load(&text, &[])).info().materials;
    assert_eq!(names, ["steel", "aluminium"]);
}
