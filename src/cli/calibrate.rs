//! `strandsnap calibrate`.

use super::cases::{self, ProgressLine};
use super::ended::Ended;
use super::interrupt;
use super::say::say;
use super::values::{SceneArgs, Seeds, within};
use crate::base::error::Result;
use crate::base::wording::counted;
use crate::reference::published::{self, CALIBRATED_ON};
use crate::run::{DeviceChoice, folder};
use crate::study::calibrate::{Calibration, Found, Iteration, Target, calibrate, default_seeds};
use crate::study::runner::{CaseRunner, CaseStore, cores};
use crate::study::statistics::Statistics;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// Seeds whose mean is fitted: how many, such as 16, or which, such as 1,2,3 or 4..9. Each setting that is tried with
    /// all takes a run per seed; two or three are, after some with a quarter of the seeds [default: 8 where bonds scatter]
    #[arg(long, value_name = "SEEDS", conflicts_with = "seed")]
    seeds: Option<Seeds>,
    /// Tensile strength to reach [MPa; default: the reference experiment]
    #[arg(long, value_name = "MPA", value_parser = within(1e-3, 1e6, "a stress in MPa"))]
    strength: Option<f64>,
    /// Fracture elongation to reach [%; default: the reference experiment]
    #[arg(long, value_name = "PERCENT", value_parser = within(1e-3, 1e3, "a strain in per cent"))]
    elongation: Option<f64>,
    /// Allowed error of either mean (%)
    #[arg(long, value_name = "PERCENT", default_value_t = 1.0, value_parser = within(1e-3, 100.0, "a share in per cent"))]
    tolerance: f64,
    /// Runs side by side, each on one thread [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Threads of each run, when runs are made one by one [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), conflicts_with = "jobs")]
    threads: Option<u16>,
    /// Compute the steps on this, as `run --device` says: runs side by side on one adapter go together there
    #[arg(long, value_name = "cpu|gpu|auto|NAME", default_value = "cpu")]
    device: DeviceChoice,
    /// Folder of the calibration [default: out/calibration/NAME]; runs that are kept in it are not made again
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Make the runs again that are kept
    #[arg(long)]
    fresh: bool,
}

pub fn run(args: &Args) -> Result<Ended> {
    let experiment = &published::find(CALIBRATED_ON).expect("it comes with the program").experiment;
    let target = Target {
        strength: args.strength.unwrap_or(experiment.tensile_strength_mpa),
        elongation: args.elongation.unwrap_or(experiment.fracture_elongation_percent),
        tolerance: args.tolerance / 100.0,
    };
    let scene = args.scene.load()?;
    let seeds = match (&args.seeds, args.scene.seed) {
        (Some(seeds), _) => seeds.0.clone(),
        (None, Some(seed)) => vec![seed],
        (None, None) => default_seeds(&scene),
    };
    let out = args.out.clone().unwrap_or_else(|| folder::calibration(&scene.spec.name));
    let _lock = cases::lock(&out, false)?;
    let store = CaseStore::open(&out, args.fresh)?.on(&args.device);
    let stop = interrupt::install_for_cases()?;
    let line = ProgressLine::new("calibrate");
    let runner = CaseRunner {
        jobs: match (args.jobs, args.threads) {
            (Some(jobs), _) => jobs.into(),
            (None, Some(_)) => 1,
            (None, None) => cores(),
        },
        threads: args.threads.map(usize::from),
        budget: None,
        stop,
        tell: &|progress| line.show(progress),
    };
    let calibration = Calibration { scene: &scene, seeds: &seeds, store: &store, runner: &runner };
    say!("target: {:.2} MPa at {:.2} %, each within {} %", target.strength, target.elongation, args.tolerance);
    say!("means over seeds ± 95 % interval (standard deviation)\n");
    say!("{}", row(None));
    let mut iterations: Vec<Iteration> = Vec::new();
    let best = calibrate(&calibration, &target, &mut |_, iteration| {
        line.0.suspend(|| say!("{}", row(Some(iteration))));
        iterations.push(iteration.clone());
    })?;
    drop(line);
    cases::tell_damaged(&store, cases::RUN_AGAIN);
    let found = Found { scene: &scene.spec.name, seeds: &seeds, target: &target, iterations: &iterations, best: &best };
    let file = found.write(&cases::command(), &out)?;
    say!("\n{}", claim(&best, &seeds, &target));
    let [kept, other] =
        [|t: &Iteration| t.kept, |t: &Iteration| t.other_build].map(|of| iterations.iter().map(of).sum::<usize>());
    if kept > 0 {
        say!("Already there: {}, {other} by another build; --fresh makes all again.", counted(kept, "run"));
    }
    say!("\nThe scene that reproduces the test:");
    best.setting.overrides().iter().for_each(|option| say!("  --set \"{option}\""));
    say!("Written: {}", file.display());
    Ok(Ended::Well)
}

/// The columns of the printed table: least width, heading and cell.
type Cell = fn(&Iteration) -> String;
const COLUMNS: [(usize, &str, Cell); 8] = [
    (5, "seeds", |one| one.strength.count.to_string()),
    (7, "Q [MPa]", |one| format!("{:.1}", one.setting.saturation)),
    (7, "H [MPa]", |one| format!("{:.1}", one.setting.linear)),
    (7, "p_f [%]", |one| format!("{:.3}", one.setting.rupture_strain)),
    (25, "strength [MPa]", |one| one.strength.with_deviation(2)),
    (9, "error [%]", |one| format!("{:+.2}", 100.0 * one.error[0])),
    (25, "elongation [%]", |one| one.elongation.with_deviation(2)),
    (9, "error [%]", |one| format!("{:+.2}", 100.0 * one.error[1])),
];

/// A row of the table as it is found, or its head.
fn row(iteration: Option<&Iteration>) -> String {
    let cell = |(width, head, of): &(usize, &str, Cell)| {
        let text = iteration.map_or_else(|| head.to_string(), of);
        format!("{text:>width$}")
    };
    COLUMNS.iter().map(cell).collect::<Vec<_>>().join("  ")
}

/// What the fit can claim.
fn claim(best: &Iteration, seeds: &[u64], target: &Target) -> String {
    let [seed, ..] = seeds else { unreachable!("there is a seed") };
    if seeds.len() == 1 {
        return format!(
            "One strand was fitted (seed {seed}). If its bonds scatter, others are weaker or stronger: fit \
                        the mean with --seeds."
        );
    }
    let told = |name: &str, stat: &Statistics, target: f64, unit: &str| {
        let half = stat.interval_95.unwrap_or(0.0);
        let share = 100.0 * half / target;
        format!("{name} {:.2} ± {half:.2} {unit} (the mean of all strands is known to {share:.1} %)", stat.mean)
    };
    format!(
        "Mean of {}: {}, {}.",
        counted(seeds.len(), "seed"),
        told("strength", &best.strength, target.strength, "MPa"),
        told("elongation", &best.elongation, target.elongation, "%")
    )
}
