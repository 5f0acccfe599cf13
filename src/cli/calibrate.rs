//! `strandsnap calibrate`.

use super::interrupt;
use super::say::say;
use super::values::{SceneArgs, Seeds, within};
use super::{Ended, cases};
use crate::base::error::Result;
use crate::observe::files::write_whole;
use crate::reference::paper::paper;
use crate::run::folder;
use crate::study::calibrate::{Calibration, Target, Trial, calibrate, default_seeds};
use crate::study::cases::stat::Stat;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

const STOPPING: &str = "\nstopping; finished runs are kept, and the same command goes on with them.";

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
    /// Folder of the calibration [default: out/calibration/NAME]; runs that are kept in it are not made again
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Make the runs again that are kept
    #[arg(long)]
    fresh: bool,
}

/// `calibration.json`.
#[derive(Serialize)]
struct Document<'a> {
    scene: &'a str,
    command: String,
    version: &'static str,
    seeds: &'a [u64],
    target: Target,
    /// Setting by setting; the last one met the target.
    trials: &'a [Trial],
    /// The options that reproduce the test.
    set: Vec<String>,
}

pub fn run(args: &Args) -> Result<Ended> {
    let experiment = paper().experiment;
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
    let stop = interrupt::install_saying(STOPPING)?;
    let overrides = args.scene.overrides()?;
    let bar = cases::bar_of_parts("calibrate");
    let tell = |progress: &_| cases::show(&bar, progress, "runs of this setting");
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let calibration = Calibration {
        scene: &args.scene.scene,
        overrides: &overrides,
        seeds: &seeds,
        folder: &out,
        fresh: args.fresh,
        jobs: match (args.jobs, args.threads) {
            (Some(jobs), _) => jobs.into(),
            (None, Some(_)) => 1,
            (None, None) => cores(),
        },
        threads: args.threads.map(usize::from),
        stop,
        tell: &tell,
    };
    say!("target: {:.2} MPa at {:.2} %, each within {} %", target.strength, target.elongation, args.tolerance);
    say!("means over seeds ± 95 % interval (standard deviation)\n");
    say!(
        "seeds  Q [MPa]  H [MPa]  p_f [%]             strength [MPa]  error [%]             elongation [%]  error [%]"
    );
    let mut trials: Vec<Trial> = Vec::new();
    let best = calibrate(&calibration, &target, &mut |_, trial| {
        bar.suspend(|| say!("{}", line(trial)));
        trials.push(trial.clone());
    });
    bar.finish_and_clear();
    let best = match best {
        Err(error) if stop.load(Ordering::Relaxed) => {
            eprintln!("{error}");
            return Ok(Ended::Interrupted);
        }
        best => best?,
    };
    let file = write(&scene.spec.name, &seeds, target, &trials, &best, &out)?;
    say!("\n{}", claim(&best, &seeds, &target));
    let [kept, other] = [|t: &Trial| t.kept, |t: &Trial| t.other_build].map(|of| trials.iter().map(of).sum::<usize>());
    if kept > 0 {
        say!("{kept} runs were there already, {other} of them by another build; --fresh makes them again.");
    }
    say!("\nThe scene that reproduces the test:");
    best.setting.overrides().iter().for_each(|option| say!("  --set \"{option}\""));
    say!("Written: {}", file.display());
    Ok(Ended::Well)
}

fn write(scene: &str, seeds: &[u64], target: Target, trials: &[Trial], best: &Trial, out: &Path) -> Result<PathBuf> {
    let set = best.setting.overrides();
    let version = env!("CARGO_PKG_VERSION");
    let document = Document { scene, command: cases::command(), version, seeds, target, trials, set };
    let text = serde_json::to_string_pretty(&document).expect("a calibration holds nothing that JSON lacks");
    let file = out.join(folder::CALIBRATION);
    write_whole(&file, &(text + "\n"))?;
    Ok(file)
}

fn line(t: &Trial) -> String {
    format!(
        "{:>5}  {:>7.1}  {:>7.1}  {:>7.3}  {:>25}  {:>+9.2}  {:>25}  {:>+9.2}",
        t.strength.count,
        t.setting.saturation,
        t.setting.linear,
        t.setting.rupture_strain,
        spread(&t.strength),
        100.0 * t.error[0],
        spread(&t.elongation),
        100.0 * t.error[1],
    )
}

/// Mean ± interval (standard deviation); the number alone with one seed.
fn spread(stat: &Stat) -> String {
    let Stat { mean, interval_95, standard_deviation, .. } = stat;
    match interval_95.zip(*standard_deviation) {
        Some((half, deviation)) => format!("{mean:.2} ± {half:.2} ({deviation:.2})"),
        None => format!("{mean:.2}"),
    }
}

/// What the fit can claim.
fn claim(best: &Trial, seeds: &[u64], target: &Target) -> String {
    let [seed, ..] = seeds else { unreachable!("there is a seed") };
    if seeds.len() == 1 {
        return format!(
            "One strand was fitted (seed {seed}). If its bonds scatter, others are weaker or stronger: fit \
                        the mean with --seeds."
        );
    }
    let told = |name: &str, stat: &Stat, target: f64, unit: &str| {
        let half = stat.interval_95.unwrap_or(0.0);
        let share = 100.0 * half / target;
        format!("{name} {:.2} ± {half:.2} {unit} (the mean of all strands is known to {share:.1} %)", stat.mean)
    };
    format!(
        "Mean of {} seeds: {}, {}.",
        seeds.len(),
        told("strength", &best.strength, target.strength, "MPa"),
        told("elongation", &best.elongation, target.elongation, "%")
    )
}
