//! Every shipped scene, shortened where it takes long, after a break where it has one.

use crate::{passed, run_into, wrong};
use strandsnap::scene::builtin;

/// What makes a strand or wire of the shipped scenes break within a second.
const SHORT: [&str; 6] = [
    "strand.length=24 mm",
    "grip.length=4 mm",
    "grip.speed=10 m/s",
    "bond.rupture.strain=3 %",
    "output.samples=400",
    "output.snapshots=30",
];

fn options(name: &str) -> Vec<&'static str> {
    let wire = ["wire.0.to=[\"0 mm\", \"0 mm\", \"24 mm\"]"];
    match name {
        "ka4" => [&SHORT[..], &["grip.adaptive="]].concat(),
        "jaw-grip" | "strand-1x7" => SHORT.to_vec(),
        "strand-1x19" => [&SHORT[..], &["strand.length=40 mm", "bond.rupture.strain=0.5 %"]].concat(),
        "hard-drawn-7" => [&SHORT[..], &["strand.length=60 mm", "bond.rupture.strain=0.5 %"]].concat(),
        "acsr" => vec![
            "strand.length=110 mm",
            "grip.length=15 mm",
            "grip.speed=10 m/s",
            "materials.aluminium.rupture.strain=0.4 %",
            "materials.steel.rupture.strain=0.6 %",
            "stop.strain=1.6 %",
            "output.samples=300",
            "output.snapshots=20",
        ],
        "single-wire" => [&SHORT[1..], &wire].concat(),
        _ => Vec::new(),
    }
}

fn check(name: &str) {
    let set: Vec<String> = options(name).iter().map(ToString::to_string).collect();
    let scene = strandsnap::scene::load(name, &set).unwrap_or_else(|error| panic!("{error:?}"));
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    run_into(&scene, &out);
    let broke = std::fs::read_to_string(out.join("ruptures.csv")).unwrap().lines().count() > 1;
    assert_eq!(broke, !options(name).is_empty(), "{name} breaks");
    let wrong = wrong(&out);
    assert!(wrong.is_empty(), "{name}\n{}", wrong.join("\n"));
    assert!(passed(&out).len() >= 8, "{name}: {:?}", passed(&out));
}

macro_rules! shipped {
    ($($test:ident $name:literal),* $(,)?) => {
        const TESTED: &[&str] = &[$($name),*];
        $(#[test] fn $test() { check($name); })*
    };
}

shipped! {
    ka4 "ka4",
    jaw_grip "jaw-grip",
    strand_1x7 "strand-1x7",
    strand_1x19 "strand-1x19",
    hard_drawn_7 "hard-drawn-7",
    acsr "acsr",
    single_wire "single-wire",
    cantilever "cantilever",
    torsion "torsion",
    two_spheres "two-spheres",
    bounce "bounce",
    bend3 "bend3",
}

#[test]
fn no_shipped_scene_lacks_a_test() {
    let listed: Vec<&str> = builtin::list().iter().map(|(name, _)| *name).collect();
    for name in listed {
        assert!(TESTED.contains(&name), "{name}");
    }
}
