//! Scenes: the corpus of good and bad files, options, writing back, and the shipped scenes.

use miette::Diagnostic;
use std::path::{Path, PathBuf};
use strandsnap::base::error::{Error, SceneError};
use strandsnap::law::bond::elasto_plastic::ElastoPlastic;
use strandsnap::law::bond::{BondForce, BondIncrement, BondLaw, BondShape, Moduli};
use strandsnap::reference::plasticity::tension_at;
use strandsnap::scene::look::Moment;
use strandsnap::scene::picture::When;
use strandsnap::scene::spec::*;
use strandsnap::scene::{self, Scene, builtin, write};

/// Stands at the end of the line that an error must point at; a file without it must get its error at the top.
const MARKER: &str = "# <-- here";

fn corpus(kind: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes").join(kind);
    let entries = std::fs::read_dir(&folder).expect("the corpus is there");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty(), "{} is empty", folder.display());
    files
}

fn load(name: &str, options: &[&str]) -> Result<Scene, Error> {
    let options: Vec<String> = options.iter().map(|option| option.to_string()).collect();
    scene::load(name, &options)
}

fn good(name: &str) -> Spec {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/good").join(name);
    load(file.to_str().unwrap(), &[]).unwrap_or_else(|error| panic!("{name}: {error}")).spec
}

#[test]
fn a_construction_becomes_layers() {
    let strand = good("construction.toml").strand.unwrap();
    let layers: Vec<(&str, usize, f64)> = strand.layers.iter().map(|l| (l.name.as_str(), l.wires, l.lay)).collect();
    assert_eq!(layers, [("inner", 5, -1.0), ("middle 1", 11, -1.0), ("middle 2", 17, -1.0), ("outer", 23, -1.0)]);
    assert!(strand.layers.iter().all(|layer| layer.lay_radius.is_none() && layer.wire_diameter == 0.30e-3));
    let listed = load("ka4", &["strand.layer=", "strand.construction=[1, 6]"]).unwrap().spec.strand.unwrap();
    let radii: Vec<Option<f64>> = listed.layers.iter().map(|layer| layer.lay_radius).collect();
    assert_eq!(radii, [Some(0.0), None]);
}

fn scene_error(result: Result<Scene, Error>, case: &str) -> Box<SceneError> {
    match result {
        Err(Error::Scene(error)) => error,
        Err(other) => panic!("{case}: not a scene error: {other}"),
        Ok(_) => panic!("{case}: was accepted"),
    }
}

/// The text that an error points at, its line, and the name of the source.
fn pointed(error: &SceneError) -> (String, String, String) {
    let span = error.span.expect("every scene error has a place");
    let text = error.source_code.inner();
    let range = span.offset()..span.offset() + span.len();
    let line_start = text[..range.start].rfind('\n').map_or(0, |at| at + 1);
    let line_end = text[range.start..].find('\n').map_or(text.len(), |at| range.start + at);
    (text[range].to_owned(), text[line_start..line_end].to_owned(), error.source_code.name().to_owned())
}

/// Equal but for the rounding of a unit's factor.
fn assert_close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * b.abs(), "{a} instead of {b}");
}

fn assert_at_option(error: &SceneError, option: &str, at: &str) {
    let (pointed, _, source) = pointed(error);
    assert_eq!(source, format!("--set {option}"), "{error}");
    assert_eq!(pointed, at, "{error}");
}

#[test]
fn bad_scenes_get_the_message_they_carry_at_the_line_they_mark() {
    let mut wrong = Vec::new();
    for file in corpus("bad") {
        let text = std::fs::read_to_string(&file).unwrap();
        let expected = text.lines().next().and_then(|line| line.strip_prefix("# expect: "));
        let expected = expected.unwrap_or_else(|| panic!("{} does not say what to expect", file.display()));
        let error = scene_error(load(file.to_str().unwrap(), &[]), &file.display().to_string());
        let (_, line, source) = pointed(&error);
        assert_eq!(source, file.to_str().unwrap());
        let at_marker = match text.contains(MARKER) {
            true => line.ends_with(MARKER),
            false => error.span.unwrap().offset() == 0,
        };
        if !error.what.contains(expected) || !at_marker {
            wrong.push(format!("{}: {}\n    at: {line}", file.display(), error.what));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn good_scenes_are_read_and_written_back_equal() {
    for file in corpus("good") {
        let spec = load(file.to_str().unwrap(), &[]).unwrap_or_else(|error| panic!("{error}")).spec;
        assert_round_trip(&spec);
    }
}

#[test]
fn shipped_scenes_are_read_and_written_back_equal() {
    let names: Vec<&str> = builtin::list().iter().map(|(name, _)| *name).collect();
    for name in [
        "ka4",
        "single-wire",
        "strand-1x7",
        "strand-1x19",
        "hard-drawn-7",
        "acsr",
        "two-spheres",
        "torsion",
        "jaw-grip",
    ] {
        assert!(names.contains(&name), "{name} is not shipped");
    }
    for (name, text) in builtin::list() {
        assert!(text.starts_with("# "), "{name} does not begin with a comment that says what it shows");
        let spec = load(name, &[]).unwrap_or_else(|error| panic!("{name}: {error}")).spec;
        assert_eq!(spec.name, *name);
        assert_round_trip(&spec);
    }
}

fn assert_round_trip(spec: &Spec) {
    let text = write::to_toml(spec);
    let again = scene::parse(&text, "elsewhere.toml", Path::new("/nowhere"), &[])
        .unwrap_or_else(|error| panic!("{}: {error}\n{text}", spec.name));
    assert_eq!(again.spec, *spec, "{text}");
}

#[test]
fn every_key_arrives_in_si() {
    let spec = good("everything.toml");
    assert_eq!((spec.name.as_str(), spec.seed, spec.plan), ("all-of-it", 7, PlanMode::General));
    assert_eq!(spec.about, "Two lines\nand a \"quote\".");
    assert_close(spec.material.density, 8940.0);
    assert_eq!(spec.bond.damping, [0.01, 0.02, 0.03, 0.0]);
    let contact = spec.contact.as_ref().unwrap();
    let NormalSpec::Thornton { limiting_pressure } = contact.normal else { panic!("not Thornton") };
    // 3 × Swift's stress at 8 % plastic strain.
    assert_close(limiting_pressure, 3.0 * 400e6 * 0.09f64.powf(0.3));
    assert_eq!((contact.tangential, contact.shape), (Some(TangentialSpec::MindlinDeresiewicz), Shape::Wire));
    let layers = &spec.strand.as_ref().unwrap().layers;
    assert_eq!((layers[0].name.as_str(), layers[0].lay_radius, layers[0].lay), ("1st", Some(0.0), -1.0));
    assert_close(layers[0].wire_diameter, 0.39e-3);
    assert_close(layers[1].phase, 10f64.to_radians());
    assert_eq!((layers[1].pitch, layers[1].lay), (f64::INFINITY, 1.0));
    let wires: Vec<&str> = spec.wires.iter().map(|wire| wire.layer.as_str()).collect();
    assert_eq!(wires, ["outer", "inner", "extra"]);
    spec.wires.iter().for_each(|wire| assert_close(wire.diameter, 0.39e-3));
    assert_close(spec.wires[2].velocity.y, -0.05 / 60.0);
    assert_close(spec.wires[2].spin.y, std::f64::consts::TAU / 6.0);
    let grip = spec.grip.as_ref().unwrap();
    assert_eq!(grip.drive, DriveSpec::Cyclic { amplitude: 0.3e-3, frequency: 2000.0 });
    assert_eq!(grip.kind, GripKind::Jaw { pressure: 50e6 });
    assert_eq!(spec.holds[0].fixed, [true, false, false, false, false, true]);
    assert_close(spec.holds[0].moment.x, 3e-3);
    assert_close(spec.holds[0].ramp, 50e-6);
    assert_eq!(spec.stop.steps, Some(1000));
    assert_eq!(spec.output.frame_size, [640, 480]);
    assert_eq!(spec.output.views, [View::Midsection, View::CrossSection, View::Curve]);
    assert_eq!((spec.output.theme, spec.output.camera.zoom), (Theme::Light, 1.5));
    assert_close(spec.output.camera.azimuth, 20f64.to_radians());
    let [last, usual] = &spec.output.pictures[..] else { panic!("{:?}", spec.output.pictures) };
    assert_eq!((last.when, last.size, last.theme), (When::Strain(0.12), [64, 48], Theme::Dark));
    assert_eq!((&last.hidden_wires[..], last.selected, last.supersampling), (&[2, 0][..], Some(1), 3));
    assert_close(last.azimuth, -28.1f64.to_radians());
    assert_close(last.centre.unwrap().y, -20e-6);
    assert_close(last.height.unwrap(), 4e-3);
    assert_eq!((usual.when, usual.size, usual.theme), (When::At(Moment::End), [640, 480], Theme::Light));
    assert_eq!((usual.height, usual.supersampling), (None, 2));
    assert_close(spec.output.camera.elevation, -0.5);
    assert_close(spec.output.camera.focus_z.unwrap(), 0.02);
}

#[test]
fn an_adaptive_pull_arrives_in_si_with_its_defaults() {
    let spec = good("adaptive.toml");
    let adaptive = spec.grip.as_ref().and_then(|grip| grip.adaptive.clone()).expect("it is adaptive");
    assert_eq!((adaptive.fastest, adaptive.passages, spec.time.contact_resolution), (15.0, 12.5, 0.6));
    assert_close(adaptive.kinetic, 0.03);
    assert_close(adaptive.from, 0.01);
    let spec = load("ka4", &["grip.adaptive={ fastest = '20 m/s' }"]).unwrap().spec;
    let adaptive = spec.grip.and_then(|grip| grip.adaptive).expect("it is adaptive");
    assert_eq!((adaptive.from, adaptive.kinetic, adaptive.passages), (0.0, 0.04, 20.0));
    assert_eq!(spec.time.contact_resolution, 0.4);
}

/// The engineering curve of the scene, as its bonds give it back: straight between the points that were given.
fn assert_gives_back(law: &HardeningSpec, given: &[[f64; 2]], young: f64) {
    for pair in given.windows(2) {
        for share in [0.01, 0.25, 0.5, 0.75, 1.0] {
            let [strain, stress] = [0, 1].map(|k| pair[0][k] + share * (pair[1][k] - pair[0][k]));
            let found = tension_at(strain, |p| law.stress(p), young).engineering_stress;
            assert!((found / stress - 1.0).abs() < 1e-4, "at {strain}: {found} is not {stress}");
        }
    }
}

#[test]
fn an_engineering_curve_is_given_back() {
    let spec = good("engineering-curve.toml");
    let BondLawSpec::ElastoPlastic(law @ HardeningSpec::Table(points)) = &spec.bond.law else { panic!("not a table") };
    assert_eq!(points[0][0], 0.0);
    // The second point lies on the elastic line, so near that its plastic strain is taken as none.
    assert!((points[0][1] / 92e6 - 1.0).abs() < 1e-5);
    assert_gives_back(law, &[[0.0008, 92e6], [0.1, 200e6], [0.25, 240e6]], 115e9);
    // Steep and high: at σ/E = 0.55 % the elastic part of the strain would be seen.
    let steep = "[['0 %', '0 MPa'], ['0.4 %', '459 MPa'], ['2 %', '580 MPa'], ['20 %', '630 MPa']]";
    let option = format!("bond.hardening={{ form = 'engineering-curve', points = {steep} }}");
    let BondLawSpec::ElastoPlastic(law) = load("torsion", &[&option]).unwrap().spec.bond.law else { panic!() };
    assert_gives_back(&law, &[[0.004, 459e6], [0.02, 580e6], [0.2, 630e6]], 115e9);
}

/// The bond itself, pulled in small steps: its force over its first section is the curve.
#[test]
fn a_bond_pulled_along_an_engineering_curve_carries_it() {
    let spec = good("engineering-curve.toml");
    let BondLawSpec::ElastoPlastic(hardening) = spec.bond.law else { panic!("not elasto-plastic") };
    let law = ElastoPlastic { moduli: Moduli::new(115e9, 0.34), hardening };
    let (radius, length) = (0.195e-3, 0.39e-3);
    let shape = BondShape::new(length, radius);
    let (mut force, mut state) = (BondForce::default(), law.initial());
    // The point on the elastic line is that of Hooke's law in log strain, 0.04 % below what was written.
    let mut before = 0.0;
    for [strain, stress] in [[0.1, 200e6], [0.175, 220e6], [0.25, 240e6]] {
        for k in 1..=20_000 {
            let log_strain = f64::ln_1p(before + (strain - before) * f64::from(k) / 20_000.0);
            let step = BondIncrement { length: length * log_strain.exp(), log_strain, ..BondIncrement::default() };
            law.axial_response(&shape, &mut force, &mut state, &step, true);
        }
        let nominal = force.axial / (std::f64::consts::PI * radius * radius);
        assert!((nominal / stress - 1.0).abs() < 1e-4, "at {strain}: {nominal} is not {stress}");
        before = strain;
    }
}

#[test]
fn without_an_elastic_point_the_curve_is_drawn_back_to_zero_plastic_strain() {
    let points = "[['0 %', '0 MPa'], ['0.2 %', '90 MPa'], ['10 %', '200 MPa']]";
    let option = format!("bond.hardening={{ form = 'engineering-curve', points = {points} }}");
    let spec = load("torsion", &[&option]).unwrap().spec;
    let BondLawSpec::ElastoPlastic(law @ HardeningSpec::Table(table)) = &spec.bond.law else { panic!("not a table") };
    let slope = |a: [f64; 2], b: [f64; 2]| (b[1] - a[1]) / (b[0] - a[0]);
    assert!((slope(table[0], table[1]) / slope(table[1], table[2]) - 1.0).abs() < 1e-9);
    assert!(table[0][0] == 0.0 && table[0][1] > 80e6 && table[0][1] < 90.2e6);
    assert_gives_back(law, &[[0.002, 90e6], [0.1, 200e6]], 115e9);
}

#[test]
fn options_change_every_kind_of_key() {
    let spec = load(
        "ka4",
        &[
            "seed=42",
            "strand.layer.0.pitch=44 mm",
            "strand.layer.2.lay=left",
            "strand.wire_diameter = 0.38 mm",
            "contact.friction=0.3",
            "contact.shape=\"wire\"",
            "contact.hardness_strain=5 %",
            "bond.hardening.linear=600 MPa",
            "bond.damping={ axial = 0.1 }",
            "bond.rupture.weibull_modulus=inf",
            "grip.free_rotation=true",
            "output.frame_size=[640,360]",
            "output.colour=wire",
            "time.step=5e-8 s",
            "stop.steps=10",
            "stop.strain=",
            "output.frame_size.1=480",
        ],
    )
    .unwrap()
    .spec;
    assert_eq!(spec.seed, 42);
    let strand = spec.strand.unwrap();
    assert_eq!(strand.layers.iter().map(|l| l.pitch).collect::<Vec<_>>(), [0.044, 0.039, 0.039]);
    assert_eq!(strand.layers.iter().map(|l| l.lay).collect::<Vec<_>>(), [1.0, 1.0, -1.0]);
    assert!(strand.layers.iter().all(|l| l.wire_diameter == 0.38e-3));
    let contact = spec.contact.unwrap();
    assert_eq!((contact.friction, contact.shape), (0.3, Shape::Wire));
    assert!(matches!(spec.bond.law, BondLawSpec::ElastoPlastic(HardeningSpec::Voce { linear: 600e6, .. })));
    assert_eq!(spec.bond.damping, [0.1, 0.0, 0.0, 0.0]);
    assert_eq!(spec.bond.rupture.unwrap().weibull_modulus, f64::INFINITY);
    assert!(spec.grip.unwrap().free_rotation);
    assert_eq!((spec.output.frame_size, spec.output.colour), ([640, 480], ColourBy::Wire));
    assert_eq!((spec.time.step, spec.stop.steps, spec.stop.strain), (Some(5e-8), Some(10), None));
}

#[test]
fn where_bonds_can_break_most_snapshots_are_left_to_ruptures() {
    let snapshots = |options: &[&str]| load("single-wire", options).unwrap().spec.output.snapshots;
    assert_eq!((snapshots(&[]), snapshots(&["bond.rupture=", "stop.stress_fraction="])), (60, 160));
}

#[test]
fn options_make_tables_remove_them_and_the_last_one_wins() {
    let spec = load("two-spheres", &["contact=", "time.safety=0.5", "time.safety=0.4", "sphere.1.diameter=8 mm"])
        .unwrap()
        .spec;
    assert_eq!((spec.contact, spec.time.safety, spec.spheres[1].diameter), (None, 0.4, 0.008));
    let layers = "strand.layer=[{ wires = 1, name = 'only', lay_radius = 'auto' }]";
    assert_eq!(load("ka4", &[layers]).unwrap().spec.strand.unwrap().layers.len(), 1);
    let layer = "strand.layer.1={ wires = 12, name = 'new' }";
    assert_eq!(load("ka4", &[layer]).unwrap().spec.strand.unwrap().layers[1].wires, 12);
}

#[test]
fn errors_in_an_option_point_at_it() {
    // Option, text of the message, text of the help, what is pointed at.
    let cases = [
        (
            "strand.layer.0.pich=44 mm",
            "unknown key `pich` in `strand.layer.0`",
            "did you mean `pitch`?",
            "strand.layer.0.pich",
        ),
        ("brond.law=elastic", "unknown key `brond`", "did you mean `bond`?", "brond.law"),
        ("strand.pitch=39 MPa", "is a pressure, but a length", "39 mm", "39 MPa"),
        ("strand.pitch=39", "bare number 39", "39 mm", "39"),
        ("bond.damping=-1", "`damping` is -1", "", "-1"),
        (
            "output.views=['overveiw']",
            "`overveiw` is not a value of `output.views",
            "did you mean `overview`?",
            "['overveiw']",
        ),
        ("output.theme=drak", "`drak` is not a value of `output.theme`", "did you mean `dark`?", "drak"),
        ("bond.law=rubber", "`rubber` is not a value of `bond.law`", "elasto-plastic", "rubber"),
        ("strand.layer.3.pitch=44 mm", "`strand.layer` has 3 elements", "from 0 to 2", "strand.layer.3.pitch"),
        ("strand.layer.outer.pitch=44 mm", "`outer` is none of them", "from 0 to 2", "strand.layer.outer.pitch"),
        ("seed.x=1", "`seed` is of type integer", "set `seed` itself", "seed.x"),
        ("strand.layer.0=", "cannot be removed one by one", "whole array", "strand.layer.0"),
        ("strand.lenth=", "there is no `strand.lenth` to remove", "did you mean `length`?", "strand.lenth"),
        ("output.frame_size=[640,", "is not TOML", "close every bracket", "[640,"),
        (
            "seed=9223372036854775808",
            "is too large for a whole number",
            "the largest is 9223372036854775807",
            "9223372036854775808",
        ),
        ("grip.length=60 mm", "leave nothing of a body of 120 mm", "gauge length", "60 mm"),
        (
            "hold=[{ body = 34, fix = ['x'] }]",
            "there is no body 34",
            "strand wires come first",
            "[{ body = 34, fix = ['x'] }]",
        ),
        ("strand.layer.1=3", "is a table, but the value is of type integer", "{ key = value", "3"),
    ];
    for (option, what, help, at) in cases {
        let error = scene_error(load("ka4", &[option]), option);
        assert!(error.what.contains(what), "{option}: {}", error.what);
        assert!(error.help.clone().unwrap_or_default().contains(help), "{option}: {:?}", error.help);
        assert_at_option(&error, option, at);
    }
    for option in ["seed", "=3", "strand..pitch=3 mm"] {
        let error = scene_error(load("ka4", &[option]), option);
        assert_at_option(&error, option, option);
    }
    // A key that is missing in a table which only an option made.
    let error = scene_error(load("single-wire", &["contact.friction=0.3"]), "contact");
    assert!(error.what.contains("`contact` has no `normal`"), "{error}");
    assert_at_option(&error, "contact.friction=0.3", "contact.friction");
}

#[test]
fn unknown_keys_are_answered_with_the_nearest_one() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/bad/unknown-key.toml");
    let error = scene_error(load(file.to_str().unwrap(), &[]), "unknown key");
    assert_eq!(pointed(&error).0, "pich");
    assert!(error.help.as_ref().unwrap().starts_with("did you mean `pitch`?"), "{:?}", error.help);
}

#[test]
fn later_floors_can_point_at_a_key() {
    let scene = load("ka4", &["strand.layer.1.lay_radius=0.5 mm"]).unwrap();
    let at = |path: &str| match scene.source.error(path, "overlap", "0.722 mm is enough") {
        Error::Scene(error) => pointed(&error),
        other => panic!("{other}"),
    };
    assert_eq!(at("strand.layer.2.lay_radius").0, "\"1.165 mm\"");
    let (text, _, source) = at("strand.layer.1.lay_radius");
    assert_eq!((text.as_str(), source.as_str()), ("0.5 mm", "--set strand.layer.1.lay_radius=0.5 mm"));
    // A key that is not there: its table.
    assert!(at("strand.layer.2.pitch").1.contains("[[strand.layer]]"));
    let error = scene.source.error("strand.layer.2.lay_radius", "overlap", "");
    assert!(error.help().is_none());
}

#[test]
fn unknown_scenes_are_answered_with_the_nearest() {
    for (name, near) in
        [("ka5", "ka4"), ("two-sphere", "two-spheres"), ("cantilver", "cantilever"), ("torsion.toml", "torsion")]
    {
        let error = load(name, &[]).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let help = error.help().unwrap().to_string();
        assert!(help.contains(&format!("did you mean `{near}`?")), "{name}: {help}");
    }
    let error = load("no/such/file", &[]).unwrap_err().to_string();
    assert!(error.contains("no scene file no/such/file"), "{error}");
}

#[test]
fn the_main_scene_is_the_strand_of_the_paper() {
    let spec = load("ka4", &[]).unwrap().spec;
    let strand = spec.strand.unwrap();
    assert_eq!(strand.layers.iter().map(|layer| layer.wires).collect::<Vec<_>>(), [5, 11, 18]);
    for layer in &strand.layers {
        assert_close(layer.pitch, 39e-3);
        assert_close(layer.wire_diameter, 0.39e-3);
        assert_eq!(layer.lay, 1.0);
    }
    assert_close(strand.layers[2].lay_radius.unwrap(), 1.165e-3);
    assert_eq!((strand.length, spec.grip.unwrap().length), (0.12, 0.01));
    assert_eq!((spec.contact.unwrap().friction, spec.spacing), (0.2, 1.0));
}

#[test]
fn the_jaw_scene_differs_from_the_main_one_in_its_grip_alone() {
    let main = load("ka4", &[]).unwrap().spec;
    let mut jaw = load("jaw-grip", &[]).unwrap().spec;
    assert_eq!(jaw.grip.as_ref().unwrap().kind, GripKind::Jaw { pressure: 100e6 });
    // Kind and speed: the jaw is pulled at constant speed.
    jaw.grip = main.grip.clone();
    (jaw.name, jaw.about) = (main.name.clone(), main.about.clone());
    assert_eq!(jaw, main);
}

/// The strand on which other engines are timed must stay what it is there: any change makes old figures incomparable.
#[test]
fn the_peers_strand_is_the_one_that_was_timed() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/peers/strand.toml");
    let scene = load(file.to_str().unwrap(), &[]).unwrap_or_else(|error| panic!("{error:?}"));
    let spec = &scene.spec;
    assert_eq!((&spec.bond.law, &spec.bond.rupture, spec.time.step), (&BondLawSpec::Elastic, &None, Some(2e-8)));
    let plan = &scene.plan;
    assert!(plan.bonds && plan.rotations && !plan.rupture, "{plan}");
    let assembly = strandsnap::strand::build(spec).unwrap_or_else(|error| panic!("{error:?}"));
    assert_eq!((assembly.wires.len(), assembly.len(), assembly.bond_count()), (34, 10618, 10584));
    let engine = strandsnap::engine::Engine::new(spec, plan, assembly).unwrap_or_else(|error| panic!("{error:?}"));
    // Closed contacts that LAMMPS counts too, beside those within a grip.
    assert_eq!(engine.contact_counts().2, 1520);
    assert!(engine.time_step_bound() > 2e-8, "{}", engine.time_step_bound());
}
