//! `strandsnap check-run`: invariants between all files of a run, on every shipped scene after a break, on runs of many
//! kinds and random scenes, which must all pass, and on files that were tampered with, which must not.

/// Law of the bonds of a soft copper that yields early, in a scene's `[bond]`.
macro_rules! copper {
    () => {
        r#"law = "elasto-plastic"
damping = 0.02
hardening = { form = "voce", yield_stress = "100 MPa", saturation = "180 MPa", rate = 12, linear = "550 MPa" }
"#
    };
}

#[path = "check_run/damaged.rs"]
mod damaged;
#[path = "check_run/drawn.rs"]
mod drawn;
#[path = "check_run/falsified.rs"]
mod falsified;
#[path = "check_run/honest.rs"]
mod honest;
#[path = "check_run/random.rs"]
mod random;
#[path = "check_run/shipped.rs"]
mod shipped;

use std::path::Path;
use std::sync::atomic::AtomicBool;
use strandsnap::run::{DeviceChoice, RunOptions, run};
use strandsnap::scene::Scene;
use strandsnap::study::check_run::{InvariantCheck, InvariantOutcome, check};

/// A straight core and three wires around it, pulled until they break, in a second.
pub const STRAND: &str = concat!(
    r#"
about = "A small strand of four wires, pulled until wires break."
seed = 3
[bond]
"#,
    copper!(),
    r#"rupture = { criterion = "plastic-strain", strain = "3 %", weibull_modulus = 20 }
[contact]
normal = "thornton"
tangential = "mindlin"
friction = 0.2
shape = "sphere"
hardness_strain = "8 %"
damping = 0.1
[strand]
length = "12 mm"
wire_diameter = "0.39 mm"
[[strand.layer]]
name = "core"
wires = 1
pitch = "inf"
[[strand.layer]]
name = "outer"
wires = 3
pitch = "12 mm"
[grip]
length = "2 mm"
speed = "8 m/s"
[stop]
strain = "6 %"
[output]
samples = 400
snapshots = 30
frame_size = [160, 120]
"#
);

/// A scene from text; `set` are `--set` options.
pub fn scene(text: &str, set: &[&str]) -> Scene {
    let set: Vec<String> = set.iter().map(ToString::to_string).collect();
    strandsnap::scene::parse(text, "test.toml", Path::new("."), &set).unwrap_or_else(|error| panic!("{error:?}"))
}

/// Runs a scene into `out`, with a recording where the program has them.
pub fn run_into(scene: &Scene, out: &Path) {
    let options = RunOptions {
        out: out.into(),
        overwrite: false,
        wait: false,
        threads: Some(1),
        device: DeviceChoice::default(),
        frames: false,
        animation: None,
        recording: cfg!(feature = "record"),
        live: None,
    };
    run(scene, &options, &AtomicBool::new(false)).unwrap_or_else(|error| panic!("{error:?}"));
    strandsnap::page::write(out, None, None, false, false).unwrap_or_else(|error| panic!("{error:?}"));
}

/// What is wrong with a run, for people; empty when nothing is.
pub fn wrong(out: &Path) -> Vec<String> {
    let findings = check(out).unwrap_or_else(|error| panic!("{error:?}"));
    let told = |finding: &InvariantCheck| match &finding.outcome {
        InvariantOutcome::Failed(seen) => {
            Some(format!("{}: {} ({:e})", finding.invariant.name, seen.place, seen.worst))
        }
        _ => None,
    };
    findings.iter().filter_map(told).collect()
}

/// Names of the invariants that hold.
pub fn passed(out: &Path) -> Vec<&'static str> {
    let findings = check(out).unwrap_or_else(|error| panic!("{error:?}"));
    let holds = |finding: &&InvariantCheck| matches!(finding.outcome, InvariantOutcome::Passed(_));
    findings.iter().filter(holds).map(|finding| finding.invariant.name).collect()
}
