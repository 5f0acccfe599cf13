//! Every case of `strandsnap verify`, in its quick form. One test per case, so that a miss is named.

use std::sync::atomic::AtomicBool;
use strandsnap::run::DeviceChoice;
use strandsnap::run::in_pool;
use strandsnap::scene::{self, builtin};
use strandsnap::strand;
use strandsnap::study::verify::comparison::{Comparison, Verdict};
use strandsnap::study::verify::{CASES, Effort, run_one, select};

/// What is wrong with a finding, for people.
fn miss(f: &Comparison) -> String {
    let order = f
        .order
        .map_or(String::new(), |o| format!(", order {:.3} instead of {} ± {}", o.observed, o.theory, o.tolerance));
    let [low, high] = f.allowed;
    let (what, unit, error) = (&f.what, &f.unit, f.error());
    format!(
        "{what}: {:e} {unit}, exact {:e}, error {error:+.2e} (allowed {low:.0e} to {high:.0e}){order}",
        f.computed, f.exact
    )
}

fn check(name: &str) {
    let case = select(&[name.to_owned()]).unwrap_or_else(|error| panic!("{error}"))[0];
    let report = in_pool(Some(1), || run_one(case, Effort::Quick, &DeviceChoice::Processor, &AtomicBool::new(false)))
        .unwrap()
        .unwrap();
    let findings = report.result.unwrap_or_else(|error| panic!("{name}: {error:?}"));
    let misses: Vec<String> = findings.iter().filter(|f| f.verdict() == Verdict::Miss).map(miss).collect();
    assert!(misses.is_empty(), "{name} misses\n{}", misses.join("\n"));
}

macro_rules! cases {
    ($($test:ident $name:literal),* $(,)?) => {
        const TESTED: &[&str] = &[$($name),*];
        $(#[test] fn $test() { check($name); })*
    };
}

cases! {
    acsr_stiffness "acsr-stiffness",
    axial_wave "axial-wave",
    bending_frequency "bending-frequency",
    bond_bent "bond-bent",
    bond_twisted "bond-twisted",
    buckling_bracket "buckling-bracket",
    buckling_load "buckling-load",
    cantilever_shared "cantilever-shared",
    cantilever_stocky "cantilever-stocky",
    cantilever_tip "cantilever-tip",
    capstan "capstan",
    capstan_on_drum "capstan-on-drum",
    critical_step_cantilever "critical-step-cantilever",
    critical_step_chain "critical-step-chain",
    critical_step_damped "critical-step-damped",
    critical_step_free_wire "critical-step-free-wire",
    crossed_wires "crossed-wires",
    curve_as_written "curve-as-written",
    damping_axial "damping-axial",
    damping_bending "damping-bending",
    elastica "elastica",
    energy_drift "energy-drift",
    frame_indifference "frame-indifference",
    friction_constant_load "friction-constant-load",
    hertz "hertz",
    momenta_collision "momenta-collision",
    momenta_strand "momenta-strand",
    momenta_wire "momenta-wire",
    oblique_impact "oblique-impact",
    rolling_on_plane "rolling-on-plane",
    section_plasticity "section-plasticity",
    sliding_to_rolling "sliding-to-rolling",
    sliding_wires "sliding-wires",
    snapped_bond "snapped-bond",
    sphere_on_plane "sphere-on-plane",
    sphere_on_wire "sphere-on-wire",
    spring "spring",
    strand_ghoreishi "strand-ghoreishi",
    strand_jiang "strand-jiang",
    strand_spacing "strand-spacing",
    strand_stiffness "strand-stiffness",
    strand_textbook "strand-textbook",
    strand_utting "strand-utting",
    restitution "restitution",
    three_point_bending "three-point-bending",
    thornton "thornton",
    thornton_repeated "thornton-repeated",
    torsion_bar "torsion-bar",
    unlike_spheres "unlike-spheres",
    unlike_wires "unlike-wires",
    wave_energy "wave-energy",
    wire_modulus "wire-modulus",
    wire_pulled "wire-pulled",
    wire_twisted "wire-twisted",
}

#[test]
fn no_case_lacks_a_test() {
    let mut names: Vec<&str> = CASES.iter().map(|case| case.name).collect();
    names.sort_unstable();
    let mut tested = TESTED.to_vec();
    tested.sort_unstable();
    assert_eq!(tested, names);
}

/// Every verification scene of the sources comes with the program, can be built, and says what it shows.
#[test]
fn every_scene_comes_along_and_says_what_it_shows() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenes/verify");
    let entries = std::fs::read_dir(folder).expect("the scenes are part of the sources");
    let stem = |path: std::path::PathBuf| path.file_stem().unwrap().to_string_lossy().into_owned();
    let mut files: Vec<String> = entries.map(|e| format!("verify/{}", stem(e.unwrap().path()))).collect();
    files.sort();
    let listed: Vec<&str> = builtin::verification().iter().map(|(name, _)| *name).collect();
    assert_eq!(listed, files);
    for name in listed {
        let spec = scene::load(name, &[]).unwrap_or_else(|error| panic!("{name}: {error:?}")).spec;
        assert!(spec.about.ends_with('.'), "{name}");
        strand::build(&spec).unwrap_or_else(|error| panic!("{name}: {error:?}"));
    }
}
