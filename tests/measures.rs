//! What a run reports is what its body did: in every file, at any number of rows, however the run ended.

#[path = "common/rows.rs"]
mod rows;

use rows::{column, column as column_of, rows};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use strandsnap::base::error::Result;
use strandsnap::engine::view::{BondState, RunInfo, Rupture, Sample, Snapshot};
use strandsnap::observe::Observer;
use strandsnap::observe::summary::RunSummary;
use strandsnap::reference::plasticity::tension_at;
use strandsnap::run::{self, RunOptions, StopReason};
use strandsnap::scene::spec::BondLawSpec;
use strandsnap::scene::{self, Scene};

fn load(name: &str, options: &[&str]) -> Scene {
    let options: Vec<String> = options.iter().map(|o| o.to_string()).collect();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/measures").join(name);
    let name = if file.is_file() { file.to_str().unwrap().to_owned() } else { name.to_owned() };
    scene::load(&name, &options).unwrap()
}

/// Everything that a run shows.
#[derive(Default)]
struct All {
    rows: Vec<Sample>,
    snapshots: Vec<Arc<Snapshot>>,
    ruptures: Vec<Rupture>,
    /// Sets this flag at this row.
    interrupt: Option<(usize, Arc<AtomicBool>)>,
}

impl Observer for All {
    fn start(&mut self, _info: &Arc<RunInfo>) -> Result<()> {
        Ok(())
    }
    fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.rows.push(sample.clone());
        if let Some((_, stop)) = self.interrupt.as_ref().filter(|(row, _)| self.rows.len() >= *row) {
            stop.store(true, Ordering::Relaxed);
        }
        Ok(())
    }
    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        self.snapshots.push(snapshot.clone());
        Ok(())
    }
    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.ruptures.push(rupture.clone());
        Ok(())
    }
    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Runs a scene without writing.
fn watch(scene: &Scene) -> (All, RunSummary) {
    let mut all = All::default();
    let summary = run::summarise(scene, vec![&mut all], &AtomicBool::new(false)).unwrap();
    (all, summary)
}

/// Runs a scene into a folder and gives its summary.
fn write(scene: &Scene, out: PathBuf) -> RunSummary {
    let options = RunOptions {
        out,
        overwrite: false,
        wait: false,
        threads: Some(1),
        device: run::DeviceChoice::default(),
        frames: false,
        animation: None,
        recording: false,
        live: None,
    };
    run::run(scene, &options, &AtomicBool::new(false)).unwrap()
}

fn at(x: &[f64], y: &[f64], wanted: f64) -> f64 {
    let i = x.partition_point(|x| *x < wanted);
    assert!(i > 0 && i < x.len(), "{wanted} lies outside {:?}", (x.first(), x.last()));
    y[i - 1] + (y[i] - y[i - 1]) * (wanted - x[i - 1]) / (x[i] - x[i - 1])
}

#[test]
fn a_broken_bond_carries_nothing_in_any_output() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let summary = write(&load("stress-after-break.toml", &[]), out.clone());
    assert_eq!(summary.bonds_broken, 2, "both bonds reach their strain at once");
    let curve = rows(&out.join("curve.csv"));
    let (layer, broken) = (column(&curve, "stress_wire_mpa"), column(&curve, "bonds_broken"));
    assert!(broken.contains(&2.0) && broken.contains(&0.0));
    for (stress, broken) in layer.iter().zip(&broken) {
        assert!(if *broken > 0.0 { *stress == 0.0 } else { (-1e-6..=500.0).contains(stress) }, "{stress} MPa");
    }
    let wires = rows(&out.join("wires.csv"));
    let greatest = column(&wires, "greatest_stress_mpa")[0];
    assert!((490.0..=500.0).contains(&greatest), "{greatest} MPa");
    let ruptures = rows(&out.join("ruptures.csv"));
    assert!(column(&ruptures, "stress_mpa")[0] <= 500.0 * 1.005, "true stress at a strain of 0.5 %");
}

#[test]
fn a_broken_bond_keeps_its_last_strain_and_has_no_stress() {
    let (all, summary) = watch(&load("short-wire.toml", &["output.snapshots=40"]));
    assert!(summary.bonds_broken > 0);
    let broken: Vec<_> = all.snapshots.iter().filter(|s| s.bond_state.contains(&BondState::Broken)).collect();
    assert!(broken.len() > 2, "{} snapshots after the break", broken.len());
    for rupture in &all.ruptures {
        let after = |value: fn(&Snapshot) -> &[f32]| -> Vec<f32> {
            let shown = broken.iter().filter(|s| s.bond_state[rupture.bond] == BondState::Broken);
            shown.map(|s| value(s)[rupture.bond]).collect()
        };
        assert!(after(|s| &s.bond_stress).iter().all(|stress| *stress == 0.0), "slot {}", rupture.bond);
        let strain = after(|s| &s.plastic_strain);
        assert!(strain.windows(2).all(|pair| pair[0] == pair[1]), "{strain:?}");
    }
}

/// The one wire of the built-in scene, at the speed that it is shipped with, from the file that a run writes.
#[test]
fn modulus_and_yield_are_read_from_the_curve_as_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let scene = load("single-wire", &["stop.strain=0.15 %", "output.samples=300"]);
    let BondLawSpec::ElastoPlastic(law) = &scene.spec.bond.law else { panic!("the wire yields") };
    write(&scene, out.clone());
    let curve = rows(&out.join("curve.csv"));
    let strain = column(&curve, "strain_percent");
    for column in ["stress_mpa", "stress_wire_mpa"] {
        let stress = column_of(&curve, column);
        for (percent, right) in [(0.02, 22.9), (0.04, 45.9), (0.06, 68.8), (0.1, 100.3)] {
            let closed = 1e-6 * tension_at(0.01 * percent, |p| law.stress(p), 115e9).engineering_stress;
            assert!((closed - right).abs() < 0.3, "{closed} MPa at {percent} %");
            let found = at(&strain, &stress, percent);
            assert!((found / closed - 1.0).abs() < 0.01, "{column}: {found} MPa at {percent} %, not {closed}");
        }
    }
    let last = *strain.last().unwrap();
    assert!((0.15..0.151).contains(&last), "the curve reaches the strain at which the run stops: {last} %");
}

/// Energies are those of the instant, strain and forces are means over an eighth of a wave's passage that lag by half of
/// that: the integral of the curve falls short by what the grip does in that time.
#[test]
fn work_is_the_integral_of_the_curve() {
    let (all, _) = watch(&load("short-wire.toml", &["output.samples=2000", "stop.strain=4 %"]));
    let (speed, lag) = (5.0, 0.0625 * 10e-3 / (115e9_f64 / 8960.0).sqrt());
    let length = speed * lag;
    let gauge = {
        let [a, b] = [all.rows.len() / 4, 3 * all.rows.len() / 4].map(|i| &all.rows[i]);
        speed * (b.time - a.time) / (b.strain - a.strain)
    };
    let most = all.rows.iter().map(|row| row.energy.work).fold(0.0, f64::max);
    let start = all.rows[0].energy.work;
    let mut integral = start;
    for pair in all.rows.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        integral += 0.5 * (a.grip_force[1] + b.grip_force[1]) * (b.strain - a.strain) * gauge;
        let exact = integral + b.grip_force[1] * length;
        let missing = (b.energy.work - exact).abs();
        assert!(missing < 5e-3 * most, "{missing} J of {most} at {}", b.strain);
    }
}

#[test]
fn the_result_does_not_hang_on_how_many_rows_are_written() {
    let run = |samples: usize| {
        let (all, s) = watch(&load("short-wire.toml", &[&format!("output.samples={samples}"), "output.snapshots=1"]));
        let highest = all.rows.iter().map(|row| row.stress * 1e-6).fold(0.0, f64::max);
        assert!(s.tensile_strength_mpa.unwrap() >= highest * (1.0 - 1e-12), "{highest} MPa in a row");
        let result = [s.tensile_strength_mpa, s.fracture_elongation_percent, s.elongation_at_20_percent_drop_percent];
        assert!(result.iter().all(Option::is_some), "{result:?}");
        (result, s.cost.steps, s.quasi_static, s.warnings, all.ruptures)
    };
    let few = run(1);
    for samples in [7, 200] {
        assert_eq!(run(samples), few, "{samples} rows");
    }
}

#[test]
fn a_body_at_rest_has_no_ratios() {
    let (all, summary) = watch(&load("at-rest.toml", &[]));
    assert_eq!(summary.energy_residual_percent, None);
    assert_eq!(summary.limits.energy_residual_greatest_percent, None);
    assert!(all.rows.iter().all(|row| row.energy.kinetic >= 0.0));
    assert_eq!(summary.warnings, Vec::<String>::new());
}

#[test]
fn a_strand_that_is_pushed_has_a_compressive_peak_and_no_strength() {
    let (all, summary) = watch(&load("push.toml", &["stop.time=0.08 ms"]));
    assert_eq!((summary.tensile_strength_mpa, summary.greatest_stress_mpa), (None, None));
    let peak = summary.compressive_peak_mpa.unwrap();
    let least = all.rows.iter().map(|row| row.stress * 1e-6).fold(0.0, f64::min);
    // The wires yield at 100 MPa before they buckle.
    assert!(peak <= least && (-102.0..-95.0).contains(&peak), "{peak} MPa, least row {least}");
    assert!(summary.strain_at_compressive_peak_percent.unwrap() < 0.0);
}

#[test]
fn an_interrupted_run_has_a_greatest_stress_so_far_and_no_strength() {
    let scene = load("short-wire.toml", &[]);
    let stop = Arc::new(AtomicBool::new(false));
    let mut all = All { interrupt: Some((40, stop.clone())), ..All::default() };
    let summary = run::summarise(&scene, vec![&mut all], &stop).unwrap();
    assert_eq!(summary.stopped, StopReason::Interrupted);
    assert_eq!((summary.tensile_strength_mpa, summary.fracture_elongation_percent), (None, None));
    assert!(summary.greatest_stress_mpa.unwrap() > 1.0);
    assert_eq!(summary.warnings, Vec::<String>::new(), "nothing is judged by its first rows");
}

/// A wire that is turned slowly twists evenly: by θ z/L at z, θ being what its end has turned.
#[test]
fn roll_rises_evenly_along_a_wire_that_is_turned() {
    let scene = load("torsion", &["stop.time=0.3 ms", "bond.law=elastic", "bond.hardening="]);
    let mut all = All::default();
    run::summarise(&scene, vec![&mut all], &AtomicBool::new(false)).unwrap();
    let last = all.snapshots.last().unwrap();
    let turned = scene.spec.grip.as_ref().unwrap().rotation_rate * last.sample.time;
    let [low, high] = [0, last.roll.len() - 1];
    assert!(last.roll[low] == 0.0 && (f64::from(last.roll[high]) / turned - 1.0).abs() < 1e-6, "{:?}", last.roll);
    for (i, roll) in last.roll.iter().enumerate() {
        let share = i as f64 / high as f64;
        // Waves go to and fro fifteen times, damped.
        assert!((f64::from(*roll) / turned - share).abs() < 0.01, "{roll} at {share} of {turned}");
    }
    // Where no grip turns, nothing is told of it.
    let scene = load("single-wire", &["stop.steps=10"]);
    let mut all = All::default();
    run::summarise(&scene, vec![&mut all], &AtomicBool::new(false)).unwrap();
    assert!(all.snapshots.iter().all(|snapshot| snapshot.roll.is_empty()));
}
