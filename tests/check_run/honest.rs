//! Runs of many kinds, short ones: whatever a scene asks for, nothing may be found wrong with what the program wrote.

use crate::{STRAND, run_into, scene, wrong};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use strandsnap::base::error::{Error, Result};
use strandsnap::engine::view::{RunInfo, Sample};
use strandsnap::observe::Observer;
use strandsnap::run::{Resumable, RunOptions, run_watched};

/// A straight wire between grips.
const WIRE: &str = concat!(
    r#"
about = "A straight wire between grips."
seed = 3
[bond]
"#,
    copper!(),
    r#"rupture = { criterion = "plastic-strain", strain = "3 %", weibull_modulus = 20 }
[[wire]]
diameter = "0.39 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "12 mm"]
[grip]
length = "2 mm"
speed = "8 m/s"
[stop]
strain = "6 %"
[output]
samples = 400
snapshots = 30
"#
);

/// Two wires of two diameters between the same grips.
const TWO_WIRES: &str = concat!(
    r#"
about = "Two wires of two diameters side by side."
seed = 5
[bond]
"#,
    copper!(),
    r#"rupture = { criterion = "plastic-strain", strain = "3 %", weibull_modulus = 20 }
[[wire]]
diameter = "0.39 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "10 mm"]
layer = "thick"
[[wire]]
diameter = "0.3 mm"
from = ["1 mm", "0 mm", "0 mm"]
to = ["1 mm", "0 mm", "10 mm"]
layer = "thin"
[grip]
length = "2 mm"
speed = "6 m/s"
[stop]
strain = "6 %"
[output]
samples = 200
snapshots = 20
"#
);

/// A wire that a hold turns.
const HELD: &str = concat!(
    r#"
about = "Two wires, one of them turned by a hold."
seed = 1
[bond]
"#,
    copper!(),
    r#"[[wire]]
diameter = "0.39 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "6 mm"]
[[hold]]
body = 0
part = "start"
fix = ["x", "y", "z", "rx", "ry", "rz"]
[[hold]]
body = 0
part = "end"
fix = ["x", "y", "z", "rx", "ry", "rz"]
spin = ["0 rad/s", "0 rad/s", "2000 rad/s"]
[stop]
time = "100 us"
[output]
samples = 100
snapshots = 8
"#
);

/// A wire without grips.
const BENT: &str = r#"
about = "A wire that is bent by a force at its end."
[bond]
law = "elastic"
damping = 0.05
[[wire]]
diameter = "0.39 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "6 mm"]
[[hold]]
body = 0
part = "start"
fix = ["x", "y", "z", "rx", "ry", "rz"]
[[hold]]
body = 0
part = "end"
force = ["0.1 N", "0 N", "0 N"]
ramp = "20 us"
[stop]
time = "100 us"
[output]
samples = 100
snapshots = 8
"#;

/// Free bodies alone.
const SPHERES: &str = r#"
about = "Two spheres that collide."
[bond]
law = "elastic"
[contact]
normal = "thornton"
tangential = "mindlin"
friction = 0.2
limiting_pressure = "300 MPa"
[[sphere]]
diameter = "1 mm"
position = ["0 mm", "0 mm", "0 mm"]
velocity = ["0 m/s", "0 m/s", "1 m/s"]
[[sphere]]
diameter = "1 mm"
position = ["0.1 mm", "0 mm", "1.01 mm"]
[stop]
time = "30 us"
[output]
samples = 50
snapshots = 6
"#;

/// A shipped scene.
const STRAND_1X7: &str = include_str!("../../assets/scenes/strand-1x7.toml");

/// Name, scene and `--set` options of a run, these with semicolons between them.
type Honest = (&'static str, &'static str, &'static str);

const SHORT: &[Honest] = &[
    ("3 steps", STRAND, "stop.strain=; stop.steps=3"),
    ("40 steps", STRAND, "stop.strain=; stop.steps=40"),
    ("99 steps wire", WIRE, "stop.strain=; stop.steps=99"),
    ("1 step", WIRE, "stop.strain=; stop.steps=1"),
    ("few rows", STRAND, "output.samples=3; output.snapshots=1"),
    ("two rows", WIRE, "output.samples=1; output.snapshots=1"),
    ("timed", STRAND, "stop.strain=; stop.time=20 us"),
];

const PULLS: &[Honest] = &[
    (
        "elastic fast",
        STRAND,
        "bond.law=elastic; bond.hardening=; bond.rupture=; contact.hardness_strain=; \
      contact.limiting_pressure=280 MPa; grip.speed=40 m/s; stop.strain=2 %",
    ),
    (
        "slow elastic",
        STRAND,
        "bond.law=elastic; bond.hardening=; bond.rupture=; contact.hardness_strain=; \
      contact.limiting_pressure=280 MPa; grip.speed=1 m/s; stop.strain=0.1 %",
    ),
    ("fast", STRAND, "grip.speed=60 m/s"),
    ("fast wire", WIRE, "grip.speed=100 m/s"),
    (
        "1x7",
        STRAND_1X7,
        "strand.length=20 mm; grip.length=4 mm; grip.speed=10 m/s; bond.rupture.strain=3 %; \
      output.samples=300; output.snapshots=12; stop.strain=5 %",
    ),
    ("smooth", STRAND, "contact.shape=wire; spacing=2; contact.hardness_strain=; contact.limiting_pressure=280 MPa"),
    ("smooth fine", STRAND, "contact.shape=wire; spacing=1"),
    ("no rupture", STRAND, "bond.rupture="),
    ("fine", STRAND, "spacing=0.5"),
    ("coarse", WIRE, "spacing=3"),
    ("mass scale", STRAND, "time.mass_scale=4"),
    (
        "beam stress",
        STRAND,
        "bond.rupture={ criterion = 'beam-stress', tensile = '150 MPa', shear = '150 MPa', weibull_modulus = 20 }",
    ),
    (
        "beam elastic",
        STRAND,
        "bond.law=elastic; bond.hardening=; contact.hardness_strain=; contact.limiting_pressure=280 MPa; \
      bond.rupture={ criterion = 'beam-stress', tensile = '400 MPa', shear = '400 MPa', weibull_modulus = inf }",
    ),
    ("fibre", STRAND, "bond.rupture={ criterion = 'fibre-strain', strain = '3 %', weibull_modulus = 20 }"),
    ("two wires", TWO_WIRES, ""),
    ("two bonds", WIRE, "wire.0.to=['0 mm', '0 mm', '0.8 mm']; grip.length=0.1 mm"),
    ("three bonds", WIRE, "wire.0.to=['0 mm', '0 mm', '1.2 mm']; grip.length=0.1 mm"),
    ("stress fraction", STRAND, "stop.stress_fraction=50 %"),
    ("core loose", STRAND, "strand.layer.1.lay_radius=0.5 mm"),
    ("one wire", WIRE, ""),
];

const ADAPTIVE: &[Honest] = &[
    ("adaptive", STRAND, "grip.speed=2 m/s; grip.adaptive={ fastest = '20 m/s', kinetic = '10 %', passages = 4 }"),
    (
        "adaptive from",
        STRAND,
        "grip.speed=3 m/s; \
      grip.adaptive={ from = '1 %', fastest = '30 m/s', kinetic = '20 %', passages = 2 }",
    ),
    (
        "adaptive short gauge",
        STRAND,
        "grip.speed=2 m/s; grip.length=5.2 mm; \
      grip.adaptive={ fastest = '10 m/s', kinetic = '10 %', passages = 4 }",
    ),
    (
        "adaptive short wire",
        WIRE,
        "grip.speed=2 m/s; grip.length=5.2 mm; \
      grip.adaptive={ fastest = '10 m/s', kinetic = '10 %', passages = 4 }",
    ),
    (
        "adaptive with waves",
        STRAND,
        "strand.length=16 mm; spacing=0.7; bond.damping=0.1; grip.speed=1 m/s; \
      grip.adaptive={ from = '0.3 %', fastest = '6 m/s', kinetic = '4 %', passages = 5 }; \
      stop.strain=2 %; output.samples=600",
    ),
    (
        "adaptive from fast",
        STRAND_1X7,
        "strand.length=14 mm; grip.length=2 mm; grip.speed=80 m/s; spacing=1.5; \
      grip.adaptive={ fastest = '90 m/s', passages = 5 }; output.samples=300; output.snapshots=12",
    ),
    (
        "adaptive from the start",
        TWO_WIRES,
        "bond.law=elastic; bond.hardening=; bond.rupture=; grip.speed=4 m/s; \
      grip.adaptive={ fastest = '6 m/s', kinetic = '20 %' }; stop.strain=2 %; output.samples=60",
    ),
];

const CYCLIC: &[Honest] = &[
    (
        "cyclic elastic",
        STRAND,
        "bond.law=elastic; bond.hardening=; bond.rupture=; contact.hardness_strain=; \
      contact.limiting_pressure=280 MPa; grip.speed=; grip.displacement_amplitude=0.01 mm; \
      grip.frequency=20 kHz; stop.strain=; stop.time=100 us",
    ),
    (
        "cyclic half",
        STRAND,
        "grip.speed=; grip.displacement_amplitude=0.2 mm; grip.frequency=10 kHz; stop.strain=; \
      stop.time=50 us",
    ),
    (
        "cyclic plastic",
        STRAND,
        "grip.speed=; grip.displacement_amplitude=0.1 mm; grip.frequency=20 kHz; stop.strain=; \
      stop.time=150 us",
    ),
    (
        "cyclic dynamic",
        STRAND,
        "grip.speed=; grip.displacement_amplitude=0.3 mm; grip.frequency=100 kHz; stop.strain=; \
      stop.time=40 us",
    ),
    (
        "cyclic fast wire",
        WIRE,
        "grip.speed=; grip.displacement_amplitude=0.5 mm; grip.frequency=200 kHz; stop.strain=; \
      stop.time=30 us",
    ),
    (
        "cyclic elastic wire",
        WIRE,
        "bond.law=elastic; bond.hardening=; bond.rupture=; grip.speed=; \
      grip.displacement_amplitude=0.1 mm; grip.frequency=150 kHz; stop.strain=; stop.time=60 us",
    ),
    (
        "cyclic resonance",
        WIRE,
        "bond.law=elastic; bond.hardening=; bond.rupture=; grip.speed=; \
      grip.displacement_amplitude=0.005 mm; grip.frequency=225 kHz; stop.strain=; stop.time=60 us",
    ),
    (
        "cyclic short gauge",
        STRAND,
        "grip.speed=; grip.displacement_amplitude=0.02 mm; grip.frequency=20 kHz; stop.strain=; \
      stop.time=150 us; grip.length=5.2 mm",
    ),
    (
        "cyclic fibre",
        STRAND,
        "grip.speed=; grip.displacement_amplitude=0.1 mm; grip.frequency=20 kHz; stop.strain=; \
      stop.time=150 us; \
      bond.rupture={ criterion = 'fibre-strain', strain = '5 %', weibull_modulus = 20 }",
    ),
    (
        "cyclic with waves",
        WIRE,
        "bond.rupture={ criterion = 'fibre-strain', strain = '4 %', weibull_modulus = 20 }; grip.speed=; \
      grip.displacement_amplitude=0.025 mm; grip.frequency=35.8 kHz; stop.strain=; stop.time=70 us; \
      wire.0.to=['0 mm', '0 mm', '6 mm']; spacing=0.7; grip.length=0.5 mm; bond.damping=0; \
      output.samples=60",
    ),
    (
        "cyclic at once",
        WIRE,
        "grip.speed=; grip.displacement_amplitude=0.04 mm; grip.frequency=201 kHz; stop.strain=; \
      stop.time=5 us; spacing=2; time.mass_scale=3",
    ),
    (
        "cyclic in jerks",
        TWO_WIRES,
        "grip.speed=; grip.displacement_amplitude=0.04 mm; grip.frequency=447 kHz; stop.strain=; \
      stop.time=1.1 us; \
      bond.rupture={ criterion = 'fibre-strain', strain = '4 %', weibull_modulus = 20 }; \
      grip.length=1 mm; bond.damping=0; time.mass_scale=3",
    ),
    (
        "cyclic jerked strand",
        STRAND,
        "grip.speed=; grip.displacement_amplitude=0.12 mm; grip.frequency=268 kHz; stop.strain=; \
      stop.time=1 us; strand.length=8 mm; spacing=0.7; grip.length=1 mm",
    ),
];

const PUSHED: &[Honest] = &[
    (
        "until it breaks, and its stress falls",
        WIRE,
        "grip.speed=-5 m/s; grip.length=0.1 mm; bond.rupture.strain=2 %; stop.strain=30 %; stop.stress_fraction=50 %; output.samples=400",
    ),
    ("pushed", STRAND, "grip.speed=-8 m/s; stop.strain=4 %"),
    ("pushed wire", WIRE, "grip.speed=-8 m/s; stop.strain=4 %; wire.0.to=['0 mm', '0 mm', '5 mm']; grip.length=1 mm"),
    ("pushed hard", STRAND, "grip.speed=-20 m/s; stop.strain=12 %; bond.rupture.strain=30 %; strand.length=8 mm"),
    (
        "pushed elastic",
        STRAND,
        "bond.law=elastic; bond.hardening=; bond.rupture=; contact.hardness_strain=; \
      contact.limiting_pressure=280 MPa; grip.speed=-8 m/s; stop.strain=1 %",
    ),
    (
        "pushed fibre",
        STRAND,
        "bond.rupture={ criterion = 'fibre-strain', strain = '3 %', weibull_modulus = 20 }; \
      grip.speed=-8 m/s; stop.strain=4 %",
    ),
];

const HOLDS: &[Honest] = &[
    ("turned", STRAND, "grip.speed=0 m/s; grip.rotation_rate=2000 rad/s; stop.strain=; stop.time=60 us"),
    ("pulled and turned", STRAND, "grip.rotation_rate=2000 rad/s"),
    ("free rotation", STRAND, "grip.free_rotation=true"),
    ("jaw", STRAND, "grip.kind=jaw; grip.clamp_pressure=50 MPa"),
    (
        "jaw cyclic",
        STRAND,
        "grip.kind=jaw; grip.clamp_pressure=50 MPa; grip.speed=; grip.displacement_amplitude=0.05 mm; \
      grip.frequency=20 kHz; stop.strain=; stop.time=80 us",
    ),
    ("held", HELD, ""),
    ("spheres", SPHERES, ""),
    ("no grips", BENT, ""),
];

fn silent(runs: &[Honest]) {
    let loud: Vec<String> = runs
        .iter()
        .filter_map(|(name, text, set)| {
            let folder = tempfile::tempdir().unwrap();
            let out = folder.path().join("run");
            let set: Vec<&str> = set.split("; ").filter(|option| !option.is_empty()).collect();
            run_into(&scene(text, &set), &out);
            let wrong = wrong(&out);
            (!wrong.is_empty()).then(|| format!("{name}\n  {}", wrong.join("\n  ")))
        })
        .collect();
    assert!(loud.is_empty(), "{}", loud.join("\n"));
}

#[test]
fn pulls_of_few_steps_and_rows() {
    silent(SHORT);
}

#[test]
fn pulls_of_every_law_and_shape() {
    silent(PULLS);
}

#[test]
fn adaptive_pulls() {
    silent(ADAPTIVE);
}

#[test]
fn grips_that_swing() {
    silent(CYCLIC);
}

#[test]
fn bodies_that_are_pushed() {
    silent(PUSHED);
}

#[test]
fn other_grips_and_holds() {
    silent(HOLDS);
}

/// Interrupts a run after so many rows.
struct Interrupter<'a> {
    rows: usize,
    stop: &'a AtomicBool,
}

impl Observer for Interrupter<'_> {
    fn start(&mut self, _: &Arc<RunInfo>) -> Result<()> {
        Ok(())
    }

    fn sample(&mut self, _: &Sample) -> Result<()> {
        self.rows = self.rows.saturating_sub(1);
        self.stop.store(self.rows == 0, Ordering::Relaxed);
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Runs the strand until it has written so many rows.
fn interrupted(out: &Path, rows: usize) {
    let (stop, options) = (AtomicBool::new(false), RunOptions::tables(out));
    let mut watcher = Interrupter { rows, stop: &stop };
    run_watched(&scene(STRAND, &[]), &options, vec![&mut watcher], &stop).unwrap();
    strandsnap::page::write(out, None, None, false, false).unwrap();
}

#[test]
fn runs_that_were_interrupted_and_resumed() {
    for rows in [1, 2, 30, 300] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("run");
        interrupted(&out, rows);
        assert_eq!(wrong(&out), Vec::<String>::new(), "interrupted after {rows} rows");
        Resumable::open(&out, None, None).unwrap().go_on(&|_| {}, Vec::new(), &AtomicBool::new(false)).unwrap();
        strandsnap::page::write(&out, None, None, false, false).unwrap();
        assert_eq!(wrong(&out), Vec::<String>::new(), "resumed after {rows} rows");
    }
}

/// The last row of a run that failed is the last one that was finite; its steps have gone on.
#[test]
fn a_run_that_failed() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("gone_on");
    let set = [
        "bond.rupture=",
        "bond.damping=0",
        "grip.length=0.5 mm",
        "grip.speed=",
        "grip.displacement_amplitude=0.54 mm",
        "grip.frequency=338 kHz",
        "grip.rotation_rate=200 rad/s",
        "stop.strain=",
        "stop.time=7.4 us",
        "output.samples=60",
    ];
    let (options, stop) = (RunOptions::tables(&out), AtomicBool::new(false));
    let failed = run_watched(&scene(TWO_WIRES, &set), &options, Vec::new(), &stop);
    assert!(matches!(failed, Err(Error::Simulation(_))), "{failed:?}");
    strandsnap::page::write(&out, None, None, false, false).unwrap();
    assert_eq!(wrong(&out), Vec::<String>::new());
}
