//! Runs whose steps are done on the adapter that there is, alone and together.

use crate::device;
use crate::drive::{Outcome, STRAND, run_steps};
use crate::steps::{assert_alike, own};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use strandsnap::base::error::{Error, Result};
use strandsnap::engine::view::{RunInfo, Sample};
use strandsnap::gpu::Stepper;
use strandsnap::observe::Observer;
use strandsnap::run::{self, DeviceChoice, Resumable, RunOptions, RunSummary};
use strandsnap::scene::{self, Scene};

fn draw(seed: u64) -> Vec<String> {
    vec![format!("seed={seed}")]
}

/// Draws of one strand go together, each with ruptures, searches and steps of its own; one leaves early.
#[test]
fn together_each_draw_has_the_bits_that_it_has_alone() {
    let Some(device) = device("together_each_draw_has_the_bits_that_it_has_alone") else { return };
    let engine = |seed: u64| own(STRAND, &[&draw(seed)[0], "grip.speed=40 m/s", "bond.rupture.strain=1 %"]);
    let steps = |seed: u64| if seed == 2 { 150 } else { 700 };
    let run = |seed: u64| {
        let mut engine = engine(seed);
        Stepper::new(&device, &engine).unwrap().advance(&mut engine, steps(seed)).unwrap();
        Outcome::of(&mut engine)
    };
    let alone: Vec<Outcome> = (1..=4).map(run).collect();
    assert!(alone.iter().any(|outcome| !outcome.ruptures.is_empty()), "no wire breaks");
    let together: Vec<Outcome> = std::thread::scope(|scope| {
        let threads: Vec<_> = (1..=4).map(|seed| scope.spawn(move || run(seed))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    for (seed, (alone, together)) in (1..).zip(alone.iter().zip(&together)) {
        together.assert_same_motion(alone, &format!("seed {seed}"));
        assert_eq!(together.energy, alone.energy, "seed {seed}");
        assert_eq!(together.ruptures, alone.ruptures, "seed {seed}");
    }
}

#[test]
fn after_an_adapter_is_lost_the_processor_goes_on() {
    let Some(device) = device("after_an_adapter_is_lost_the_processor_goes_on") else { return };
    let engine = || own(STRAND, &[]);
    let (mut on_adapter, mut on_processor) = (engine(), engine());
    let mut stepper = Stepper::new(&device, &on_adapter).unwrap();
    stepper.advance(&mut on_adapter, 100).unwrap();
    device.destroy();
    let lost = stepper.advance(&mut on_adapter, 100).unwrap_err();
    assert!(matches!(lost, Error::Missing { .. }), "{lost}");
    assert_eq!(on_adapter.steps(), 100);
    run_steps(&mut on_adapter, 400);
    run_steps(&mut on_processor, 500);
    assert_alike("after the loss", &mut on_adapter, &mut on_processor);
}

fn strand(overrides: &[&str]) -> Scene {
    let overrides: Vec<String> = overrides.iter().map(|o| (*o).to_owned()).collect();
    scene::parse(STRAND, "strand.toml", Path::new("."), &overrides).unwrap()
}

fn options(out: &Path, device: DeviceChoice) -> RunOptions {
    RunOptions { device, threads: Some(1), ..RunOptions::tables(out) }
}

fn run_on(scene: &Scene, out: &Path, device: DeviceChoice) -> RunSummary {
    run::run(scene, &options(out, device), &AtomicBool::new(false)).unwrap()
}

/// Columns of a table by name.
fn table(folder: &Path, name: &str) -> Vec<Vec<f64>> {
    let mut table = csv::Reader::from_path(folder.join(name)).unwrap();
    let rows = table.records().map(|row| row.unwrap().iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect());
    rows.collect()
}

/// To the first rupture the curve is the processor's; afterwards rounding grows with what flies about.
#[test]
fn a_run_on_the_adapter_has_the_curve_of_the_processor() {
    let Some(device) = device("a_run_on_the_adapter_has_the_curve_of_the_processor") else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let scene = strand(&["bond.rupture.strain=1 %", "stop.strain=2.5 %", "grip.speed=20 m/s"]);
    let name = DeviceChoice::Named(device.adapter.name.to_uppercase());
    let (there, here) = (run_on(&scene, &at("gpu"), name), run_on(&scene, &at("cpu"), DeviceChoice::Processor));
    assert_eq!(there.cost.adapter.as_deref(), Some(device.adapter.name.as_str()));
    assert_eq!((&here.cost.adapter, &here.cost.not_on_adapter), (&None, &None));
    let (found, expected) = (table(&at("gpu"), "curve.csv"), table(&at("cpu"), "curve.csv"));
    let strength = here.greatest_stress_mpa.unwrap();
    let first = table(&at("cpu"), "ruptures.csv")[0][3];
    let compared: Vec<()> = expected
        .iter()
        .zip(&found)
        .take_while(|(row, _)| row[2] < first)
        .map(|(expected, found)| {
            assert!((found[2] - expected[2]).abs() < 1e-9, "{found:?}");
            assert!((found[3] - expected[3]).abs() < 1e-6 * strength, "{found:?} is not {expected:?}");
        })
        .collect();
    assert!(compared.len() > 50, "{} rows of {}", compared.len(), expected.len());
    let broke = |folder: &str| table(&at(folder), "ruptures.csv").iter().map(|row| row[4]).next().unwrap();
    assert_eq!(broke("gpu"), broke("cpu"), "the first wire");
    assert!((there.greatest_stress_mpa.unwrap() - strength).abs() < 1e-6 * strength);
}

/// Stops a run at some strain.
struct Stop<'a>(&'a AtomicBool);

impl Observer for Stop<'_> {
    fn start(&mut self, _: &Arc<RunInfo>) -> Result<()> {
        Ok(())
    }
    fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.0.store(sample.strain > 0.011, Ordering::Relaxed);
        Ok(())
    }
    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}

/// An interrupted run goes on where it was, on the adapter that it began with.
#[test]
fn a_run_on_the_adapter_goes_on_after_an_interruption() {
    let Some(_) = device("a_run_on_the_adapter_goes_on_after_an_interruption") else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let scene = strand(&["stop.strain=2 %", "grip.speed=20 m/s", "output.checkpoint=200"]);
    run_on(&scene, &at("whole"), DeviceChoice::Graphics);
    let stop = AtomicBool::new(false);
    let out = at("parts");
    let interrupted =
        run::run_watched(&scene, &options(&out, DeviceChoice::Graphics), vec![&mut Stop(&stop)], &stop).unwrap();
    assert_eq!(interrupted.stopped, run::StopReason::Interrupted);
    let resumed = Resumable::open(&out, Some(1), None).unwrap();
    assert_eq!(resumed.options.device, DeviceChoice::Graphics);
    let resumed = resumed.go_on(&|_| (), Vec::new(), &AtomicBool::new(false)).unwrap();
    assert!(resumed.cost.adapter.is_some());
    for name in ["curve.csv", "wires.csv", "ruptures.csv"] {
        let read = |folder: &str| std::fs::read(at(folder).join(name)).unwrap();
        assert!(read("whole") == read("parts"), "{name}");
    }
}

#[test]
fn an_adapter_that_is_not_there_is_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let error = run::run(&strand(&[]), &options(&out, DeviceChoice::Named("no such".into())), &AtomicBool::new(false));
    let error = error.unwrap_err();
    assert!(error.to_string().contains("no graphics adapter is called no such"), "{error}");
    assert!(!out.join("scene.toml").exists());
}
