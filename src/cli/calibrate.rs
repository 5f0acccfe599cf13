//! `strandsnap calibrate`.

use super::interrupt;
use super::values::SceneArgs;
use crate::base::error::Result;
use crate::reference::paper::paper;
use crate::run::in_pool;
use crate::study::calibrate::{Target, Trial, calibrate};

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// Tensile strength to reach [MPa; default: the reference experiment]
    #[arg(long, value_name = "MPA")]
    strength: Option<f64>,
    /// Fracture elongation to reach [%; default: the reference experiment]
    #[arg(long, value_name = "PERCENT")]
    elongation: Option<f64>,
    /// Allowed error of either [%]
    #[arg(long, value_name = "PERCENT", default_value_t = 1.0)]
    tolerance: f64,
    /// Threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

pub fn run(args: &Args) -> Result<()> {
    let experiment = paper().experiment;
    let target = Target {
        strength: args.strength.unwrap_or(experiment.tensile_strength_mpa),
        elongation: args.elongation.unwrap_or(experiment.fracture_elongation_percent),
        tolerance: args.tolerance / 100.0,
    };
    let stop = interrupt::install()?;
    println!("target: {:.2} MPa at {:.2} %, each within {} %\n", target.strength, target.elongation, args.tolerance);
    println!("run  Q [MPa]  H [MPa]  p_f [%]  strength [MPa]  error [%]  elongation [%]  error [%]");
    let threads = args.threads.map(usize::from);
    let overrides = args.scene.overrides()?;
    let best = in_pool(threads, || calibrate(&args.scene.scene, &overrides, &target, stop, &mut print_trial))??;
    println!("\nThe scene that reproduces the test:");
    for option in best.setting.overrides() {
        println!("  --set \"{option}\"");
    }
    Ok(())
}

fn print_trial(run: usize, t: &Trial) {
    println!(
        "{run:>3}  {:>7.1}  {:>7.1}  {:>7.3}  {:>14.2}  {:>+9.2}  {:>14.2}  {:>+9.2}",
        t.setting.saturation,
        t.setting.linear,
        t.setting.rupture_strain,
        t.strength,
        100.0 * t.error[0],
        t.elongation,
        100.0 * t.error[1],
    );
}
