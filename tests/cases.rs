//! Small inputs that once went wrong in silence, each with what is right: `tests/scenes/cases` and `tests/studies`.

use std::path::{Path, PathBuf};
use strandsnap::base::error::{Error, SceneError};
use strandsnap::engine::Engine;
use strandsnap::run::{assemble, cautions};
use strandsnap::scene::{self, Scene, builtin};
use strandsnap::strand;
use strandsnap::study::sweep::{Changes, Definition};

fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/cases").join(name).join("scene.toml")
}

fn load(name: &str, options: &[&str]) -> Result<Scene, Error> {
    let options: Vec<String> = options.iter().map(|option| option.to_string()).collect();
    scene::load(name, &options)
}

fn load_case(name: &str, options: &[&str]) -> Scene {
    load(case(name).to_str().unwrap(), options).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn scene_error<T>(result: Result<T, Error>, case: &str) -> Box<SceneError> {
    match result {
        Err(Error::Scene(error)) => error,
        Err(other) => panic!("{case}: not a scene error: {other}"),
        Ok(_) => panic!("{case}: was accepted"),
    }
}

/// What an error points at, in the file or in an option.
fn pointed(error: &SceneError) -> String {
    let span = error.span.expect("every scene error has a place");
    let text = error.source_code.inner();
    text[span.offset()..span.offset() + span.len()].to_owned()
}

/// What is told before a run.
fn told(scene: &Scene) -> Vec<String> {
    let assembly = assemble(scene).unwrap_or_else(|error| panic!("{error}"));
    cautions::of_run(scene, &assembly).unwrap()
}

#[test]
fn an_option_that_changes_nothing_is_refused() {
    // Scene, options of which the last one is to blame, and what the message says.
    let cases: [(&str, &[&str], &str); 15] = [
        ("strand-1x7", &["strand.pitch=20 mm"], "every layer that is laid around the axis has its own"),
        ("strand-1x7", &["strand.layer.0.pitch=20 mm"], "a wire on the axis is straight"),
        ("strand-1x7", &["strand.layer.0.phase=20 deg"], "a wire on the axis is straight"),
        ("strand-1x7", &["strand.layer.1.pitch=inf", "strand.layer.1.lay=left"], "straight"),
        ("ka4", &["contact.normal=none", "contact.friction=0.3"], "leaves contacts out"),
        ("ka4", &["contact.normal=none", "contact.hardness_strain=3 %"], "leaves contacts out"),
        ("ka4", &["contact.tangential=none", "contact.friction=0.3"], "leaves friction out"),
        ("single-wire", &["bond.rupture=", "stop.stress_fraction=", "output.rupture_density=3"], "can break"),
        ("two-spheres", &["bond.damping=0.1"], "has no wires"),
        ("two-spheres", &["spacing=0.5"], "has no wires"),
        ("bounce", &["body.0.friction=0.3"], "leaves friction out"),
        ("bounce", &["contact.normal=none", "body.0.name=wall"], "does nothing but touch"),
        ("ka4", &["time.step=10 ns", "time.contact_resolution=0.2"], "time.step fixes the step"),
        ("ka4", &["bond.hardening.saturation=0 MPa"], "no saturation"),
        (
            "ka4",
            &[
                "bond.rupture=",
                "stop.stress_fraction=",
                "grip.adaptive={ fastest = '20 m/s' }",
                "grip.adaptive.passages=3",
            ],
            "can break",
        ),
    ];
    for (name, options, words) in cases {
        let last = *options.last().unwrap();
        if last.starts_with("bond.hardening.saturation") {
            // The rate that stands in the file is left without effect: that is told.
            let idle: Vec<String> = load(name, options).unwrap().idle.iter().map(ToString::to_string).collect();
            assert!(idle.iter().any(|one| one.contains("bond.hardening.rate") && one.contains(words)), "{idle:?}");
            continue;
        }
        let error = scene_error(load(name, options), last);
        assert!(error.what.contains("changes nothing") && error.what.contains(words), "{last}: {}", error.what);
        assert_eq!(error.source_code.name(), format!("--set {last}"));
    }
}

#[test]
fn a_value_is_checked_even_where_it_has_no_effect() {
    for (name, options, words) in [
        ("strand-1x7", &["strand.pitch=-3 furlongs"][..], "`furlongs` is not a known unit of length"),
        ("strand-1x7", &["strand.pitch=-3 mm"], "must be greater than zero"),
        (
            "strand-1x7",
            &["strand.layer.0.wire_diameter=1 mm", "strand.layer.1.wire_diameter=1 mm", "strand.wire_diameter=3 s"],
            "is a time",
        ),
        ("ka4", &["contact.normal=none", "contact.hardness_factor=-3"], "must be greater than zero"),
        ("ka4", &["contact.normal=none", "contact.limiting_pressure=3 mm"], "is a length"),
    ] {
        let error = scene_error(load(name, options), options[0]);
        assert!(error.what.contains(words), "{options:?}: {}", error.what);
    }
}

/// In a file the same is told, and the run goes on; what an option switches off for one run is not.
#[test]
fn a_key_of_the_file_without_effect_is_told() {
    let layers = ["strand.layer.0.pitch=40 mm", "strand.layer.1.pitch=41 mm", "strand.layer.2.pitch=42 mm"];
    let idle = load("ka4", &layers).unwrap().idle;
    assert_eq!(idle.len(), 1, "{idle:?}");
    assert_eq!(
        idle[0].to_string(),
        "`strand.pitch` has no effect: every layer that is laid around the axis has its own"
    );
    assert!(load("ka4", &["contact.normal=none"]).unwrap().idle.is_empty());
    let text = "about = 'two'\n[contact]\nnormal = 'none'\nfriction = 0.3\n[[sphere]]\ndiameter = '1 mm'\n\
                position = ['0 mm', '0 mm', '0 mm']\n[stop]\nsteps = 1\n";
    let idle = scene::parse(text, "two.toml", Path::new("."), &[]).unwrap().idle;
    assert_eq!(idle.iter().map(|idle| idle.key.as_str()).collect::<Vec<_>>(), ["contact.friction"]);
}

/// No scene that comes along says what it need not, or begins under load.
#[test]
fn shipped_scenes_have_nothing_to_be_told() {
    for (name, _) in builtin::list() {
        let scene = load(name, &[]).unwrap();
        assert_eq!(told(&scene), Vec::<String>::new(), "{name}");
    }
}

#[test]
fn two_holds_on_one_component_are_refused() {
    let error = scene_error(assemble(&load_case("held-twice", &[])), "held twice");
    assert_eq!(error.what, "[[hold]] 2 prescribes x of body 0, but [[hold]] 1 does already");
    assert_eq!(pointed(&error), "[\"x\"]");
    // Another end, or another component, is another matter; the whole body is not.
    for free in [&["hold.1.part=end"][..], &["hold.1.fix=['y']", "hold.1.velocity="]] {
        assert!(assemble(&load_case("held-twice", free)).is_ok(), "{free:?}");
    }
    scene_error(assemble(&load_case("held-twice", &["hold.0.part=end", "hold.1.part=all"])), "whole body");
    // What a grip holds cannot be held or loaded by another.
    for hold in ["{ body = 0, part = 'end', fix = ['x'] }", "{ body = 0, part = 'all', force = ['1 N', '0 N', '0 N'] }"]
    {
        let error = scene_error(assemble(&load("single-wire", &[&format!("hold=[{hold}]")]).unwrap()), hold);
        assert!(error.what.ends_with("of body 0, but a grip holds it"), "{}", error.what);
    }
}

#[test]
fn wires_that_grips_do_not_reach_are_told_by_number() {
    let said = told(&load_case("wires-of-unlike-length", &[]));
    assert!(
        said[0].starts_with(
            "wire 1 reaches the lower grip only, wire 2 reaches the upper grip only: 0 of 2 wires are held at both ends"
        ),
        "{said:?}"
    );
    let held = told(&load_case("wires-of-unlike-length", &["grip.length=4 mm"]));
    assert!(held.is_empty(), "{held:?}");
}

#[test]
fn a_stop_that_no_drive_reaches_is_refused_or_told() {
    let error = scene_error(assemble(&load_case("stop-out-of-reach", &[])), "out of reach");
    assert!(error.what.contains("`stop.strain` of 2 % is never reached"), "{}", error.what);
    assert_eq!(pointed(&error), "\"2 %\"");
    let said = told(&load_case("stop-out-of-reach", &["stop.steps=10"]));
    assert!(said.iter().any(|one| one.contains("never reached; another condition ends the run")), "{said:?}");
    assert!(assemble(&load_case("stop-out-of-reach", &["stop.strain=0.05 %"])).is_ok());
}

/// What is advised helps: at the spacing, or the diameter, that is named nothing is left to be told.
#[test]
fn bodies_that_press_from_the_start_are_told_with_what_helps() {
    let pressed = |scene: &Scene| told(scene).into_iter().find(|one| one.contains("press on each other"));
    // Bent wires with few particles: more of them help.
    let said = pressed(&load_case("rope-by-centre-points", &[])).expect("the rope begins under load");
    // With few particles the curve between them strays sideways by the cube of the angle from one to the next, so that wires
    // lie deeper in each other than they were given; with enough of them what is stored is that of the curves.
    let stored = |spacing: &str| {
        let scene = load_case("rope-by-centre-points", &[spacing]);
        Engine::new(&scene.spec, &scene.plan, assemble(&scene).unwrap()).unwrap().energy().elastic_contacts
    };
    let [coarse, fine, finer] = ["spacing=1.5", "spacing=0.5", "spacing=0.375"].map(stored);
    assert!(said.contains(&format!("contacts hold {coarse:.2e} J")) && !said.contains("lay_radius"), "{said}");
    assert!(coarse > 10.0 * fine && (fine / finer - 1.0).abs() < 0.02, "{coarse:e} {fine:e} {finer:e}");
    let (_, advice) = said.split_once("to follow curved wires: spacing = ").unwrap_or_else(|| panic!("{said}"));
    let spacing = advice.split_once(' ').unwrap().0;
    assert_eq!(pressed(&load_case("rope-by-centre-points", &[&format!("spacing={spacing}")])), None);
    // Centre lines that are too close for the diameter: a thinner wire helps.
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("w.txt"), "0 0 0\n0 0 20\n\n0.38 0 0\n0.38 0 20\n").unwrap();
    let with = |diameter: &str| {
        let text = format!(
            "about = 'two'\n[contact]\nnormal = 'hertz'\n[[wire]]\nfile = 'w.txt'\nall = true\ndiameter = '{diameter}'\n\
             [grip]\nlength = '2 mm'\nspeed = '1 m/s'\n[stop]\nstrain = '0.1 %'\n"
        );
        scene::parse(&text, "two.toml", folder.path(), &[]).unwrap()
    };
    let said = pressed(&with("0.4 mm")).expect("two wires begin under load");
    assert!(said.contains("Wires 1 and 2 overlap most, by 0.02 mm (5.0 % of the diameter)"), "{said}");
    let (_, advice) = said.split_once("it would fit at ").unwrap_or_else(|| panic!("{said}"));
    assert_eq!(pressed(&with(advice.split_once(" or less").unwrap().0)), None);
}

#[test]
fn a_diameter_beside_that_of_the_header_is_refused() {
    let rope = case("rope-by-centre-points");
    let with = |diameter: &str| load(rope.to_str().unwrap(), &[&format!("wire.0.diameter={diameter}")]);
    let error = scene_error(with("0.3 mm"), "two diameters");
    assert_eq!(error.what, "`diameter` is 0.3 mm, but the header of wire 1 of the file says 0.4 mm");
    assert!(with("400 um").is_ok());
}

/// A straight wire stays straight, and is as stiff as its material.
#[test]
fn a_nearly_repeated_point_does_not_bend_a_wire() {
    let scene = load_case("near-repeated-point", &[]);
    let followed = strand::caution::followed(&scene.spec);
    assert!((followed[0].deviation - 1e-9).abs() < 1e-11 && followed[0].merged == 1, "{followed:?}");
    let line = strand::caution::deviation(&scene.spec).unwrap();
    assert!(line.contains("1 point repeats the one before it"), "{line}");
    // The slope between two strains, so that what is filtered lags behind both.
    let mut engine = Engine::new(&scene.spec, &scene.plan, assemble(&scene).unwrap()).unwrap();
    let mut at = |strain: f64| {
        while engine.strain() < strain {
            engine.step().unwrap();
        }
        [engine.strain(), engine.stress()]
    };
    let [low, high] = [at(0.0005), at(0.001)];
    let young = (high[1] - low[1]) / (high[0] - low[0]);
    assert!((young / 115e9 - 1.0).abs() < 0.01, "{young:e}");
}

#[test]
fn a_wire_that_leaves_its_points_is_told() {
    let folder = tempfile::tempdir().unwrap();
    // Points 20 µm apart in a row of points 5 mm apart, one of them 5 µm off: the curve follows that noise.
    std::fs::write(folder.path().join("w.txt"), "0 0 0\n0 0 5\n0.005 0 5.02\n0 0 10\n").unwrap();
    let toml = std::fs::read_to_string(case("near-repeated-point")).unwrap();
    let said = told(&scene::parse(&toml, "w.toml", folder.path(), &[]).unwrap());
    assert!(said.iter().any(|one| one.starts_with("wire 1 leaves the lines between the points")), "{said:?}");
}

#[test]
fn centre_points_of_other_programs_are_read() {
    for (file, wires) in [("bom.txt", 1), ("cr_only.txt", 1), ("excel_blank.txt", 2), ("semicolon_deccomma.txt", 1)] {
        let scene = load_case("centreline-text", &[&format!("wire.0.file={file}"), "wire.0.all=true"]);
        assert_eq!(scene.spec.wires.len(), wires, "{file}");
        for wire in &scene.spec.wires {
            let strandsnap::scene::spec::PathSpec::File { points, .. } = &wire.path else { panic!() };
            let along = [points[1] - points[0], points[3] - points[0]].map(|p| (p * 1e3).to_array());
            assert_eq!(points.len(), 4, "{file}");
            for (found, right) in along.iter().flatten().zip([0.5, 0.0, 4.0, 3.0, 0.0, 12.0]) {
                assert!((found - right).abs() < 1e-12, "{file}: {along:?}");
            }
        }
    }
}

fn study(name: &str, set: &[&str], seeds: &[u64]) -> Result<Definition, Error> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/studies").join(name).join("study.toml");
    let set = set.iter().map(|option| option.to_string()).collect();
    Definition::load(path.to_str().unwrap(), &Changes { quality: None, set, seeds: seeds.to_vec() })
}

#[test]
fn a_study_that_changes_nothing_is_refused() {
    let error = scene_error(study("key-without-effect", &[], &[]), "no effect");
    assert!(error.what.starts_with("`strand.pitch` changes nothing"), "{}", error.what);
}

/// Two levels that come to the same scene would be one run twice.
#[test]
fn points_with_the_same_scene_are_refused() {
    let text = "about = 'twice'\nbase = 'single-wire'\n[[axis]]\nname = 'grip'\n[[axis.levels]]\nname = 'as it is'\n\
                [[axis.levels]]\nname = 'whole'\nset = ['grip.kind=all']\n";
    let error = scene_error(Definition::parse(text, "twice.toml", Path::new("."), &Changes::default()), "twice");
    assert_eq!(error.what, "`grip as it is` and `grip whole` are the same scene, so that they would be one run twice");
}

#[test]
fn values_of_one_meaning_are_one_point_in_one_unit() {
    let definition = study("mixed-units", &[], &[]).unwrap();
    let axis = &definition.axes[0];
    assert_eq!((axis.unit.as_str(), definition.points.len()), ("m/s", 5));
    let numbers: Vec<f64> = axis.levels.iter().filter_map(|level| level.number).collect();
    assert_eq!(numbers, [2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!((definition.merged[0].kept.as_str(), definition.merged[0].same.as_str()), ("2 m/s", "2000 mm/s"));
    let axis = |key: &str, values: &str| {
        let text = format!("about = 'x'\nbase = 'single-wire'\n[[axis]]\nkey = '{key}'\nvalues = {values}\n");
        let definition = Definition::parse(&text, "x.toml", Path::new("."), &Changes::default()).unwrap();
        let names: Vec<String> = definition.axes[0].levels.iter().map(|level| level.name.clone()).collect();
        (definition.axes[0].unit.clone(), names, definition.merged.len())
    };
    let of = |names: &[&str]| names.iter().map(|name| name.to_string()).collect::<Vec<_>>();
    assert_eq!(axis("stop.strain", "[0.04, '4 %', '50 %']"), (String::new(), of(&["0.04", "0.5"]), 1));
    assert_eq!(axis("stop.strain", "['4 %', 0.04, 0.5]"), ("%".into(), of(&["4 %", "50 %"]), 1));
    assert_eq!(axis("grip.length", "['4 mm', '0.5 cm', '6 mm']"), ("mm".into(), of(&["4 mm", "5 mm", "6 mm"]), 0));
}

#[test]
fn seeds_and_axes_are_given_once() {
    let refused = |result: Result<Definition, Error>, words: &str| match result {
        Err(error) => assert!(error.to_string().contains(words), "{error}"),
        Ok(_) => panic!("{words}: was accepted"),
    };
    refused(study("seed-axis", &[], &[]), "an axis varies `seed`");
    refused(study("mixed-units", &["seed=3"], &[]), "`seed=3` has no effect in a study");
    refused(study("mixed-units", &["grip.speed=3 m/s"], &[]), "the axis `speed` varies that key");
    assert!(study("mixed-units", &["grip.length=3 mm"], &[5]).is_ok());
}
