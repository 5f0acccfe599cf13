//! `strandsnap accuracy`.

use super::Ended;
use super::cases as shared;
use super::interrupt;
use super::say::{self, say};
use super::values::{SceneArgs, Seeds, duration};
use crate::base::error::{Error, Result};
use crate::run::folder;
use crate::scene::quality::Quality;
use crate::study::accuracy::{self, Options, Study, Subject, knobs, table, verified};
use crate::study::verify::Case;
use std::path::PathBuf;
use std::time::Duration;

const STOPPING: &str = "\nstopping; finished runs are kept, and the same command goes on with them.";

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// Seeds: how many, such as 8, or which, such as 1,2,3 or 4..9. Errors are those of their mean and of their spread, and
    /// every run is made once per seed [default: 4 where bonds scatter and nothing exact is known]
    #[arg(long, value_name = "SEEDS", conflicts_with = "seed")]
    seeds: Option<Seeds>,
    /// Knobs to turn [default: all, see --list]
    #[arg(long, value_name = "KNOB,KNOB", value_delimiter = ',')]
    vary: Vec<String>,
    /// Time that the study may take, such as 90s, 20m or 2h: what is worth most comes first [default: no limit]
    #[arg(long, value_name = "TIME", value_parser = duration)]
    budget: Option<Duration>,
    /// Runs side by side, each on one thread
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    jobs: u16,
    /// Threads of each run, when runs are made one by one [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), conflicts_with = "jobs")]
    threads: Option<u16>,
    /// Folder of the study [default: out/accuracy/NAME]; runs that are kept in it are not made again
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Make the runs again that are kept
    #[arg(long)]
    fresh: bool,
    /// Fewer levels of a verification case
    #[arg(long)]
    quick: bool,
    /// List the knobs with the values that this scene would get, and run nothing
    #[arg(long)]
    list: bool,
}

pub fn accuracy(args: &Args) -> Result<Ended> {
    let cases = verified::select(&args.scene.scene);
    if cases.is_empty() { of_pulled_scene(args) } else { of_cases(args, &cases) }
}

/// Of verification cases, which vary what they vary.
fn of_cases(args: &Args, cases: &[&'static Case]) -> Result<Ended> {
    let name = args.scene.scene.replace('/', "-");
    let given = [
        ("--quality", args.scene.quality != Quality::Standard),
        ("--set", !args.scene.set.is_empty()),
        ("--seed", args.scene.seed.is_some()),
        ("--seeds", args.seeds.is_some()),
        ("--vary", !args.vary.is_empty()),
        ("--budget", args.budget.is_some()),
    ];
    if let Some((option, _)) = given.iter().find(|(_, given)| *given) {
        let names: Vec<&str> = cases.iter().map(|case| case.name).collect();
        return Err(Error::input(
            format!("{} means the verification cases {}, which take no {option}", args.scene.scene, names.join(", ")),
            "leave it out, or study a scene that a grip pulls",
        ));
    }
    if args.list {
        cases.iter().for_each(|case| say!("{:24}{}", case.name, case.about));
        return Ok(Ended::Well);
    }
    let out = args.out.clone().unwrap_or_else(|| folder::accuracy(&name));
    let _lock = shared::lock(&out, false)?;
    let stop = interrupt::install_saying(STOPPING)?;
    let bar = shared::bar("accuracy", cases.len());
    let began = |case: &str| {
        bar.set_message(case.to_string());
        bar.inc(1);
    };
    let found = verified::study(&name, cases, args.quick, &out, args.fresh, stop, &began);
    bar.finish_and_clear();
    let found = found?;
    let files = found.write(&shared::command(), &out)?;
    say::print(format_args!("{}", found.table().to_text()));
    say::print(format_args!("\n{}", found.summary()));
    say!("{} cases run, {} kept from before. Written:", found.made, found.kept);
    files.iter().for_each(|file| say!("  {}", file.display()));
    Ok(if found.interrupted { Ended::Interrupted } else { Ended::Well })
}

fn of_pulled_scene(args: &Args) -> Result<Ended> {
    if args.quick {
        let help = "say how much time there is with --budget, or turn fewer knobs with --vary";
        return Err(Error::input("--quick is for verification cases", help));
    }
    let mut options = Options {
        scene: args.scene.scene.clone(),
        overrides: args.scene.overrides()?,
        seeds: match (&args.seeds, args.scene.seed) {
            (Some(seeds), _) => seeds.0.clone(),
            (None, seed) => seed.into_iter().collect(),
        },
        vary: knobs::select(&args.vary)?,
        budget: args.budget.map(|budget| budget.as_secs_f64()),
        jobs: args.jobs.into(),
        threads: args.threads.map(usize::from),
        out: PathBuf::new(),
        fresh: args.fresh,
    };
    let subject = Subject::new(&options)?;
    if args.list {
        say::print(format_args!("{}", table::list(&subject)));
        return Ok(Ended::Well);
    }
    options.out = args.out.clone().unwrap_or_else(|| folder::accuracy(&subject.scene.spec.name));
    let _lock = shared::lock(&options.out, false)?;
    subject.notes.iter().for_each(|note| eprintln!("note: {note}"));
    let stop =
        interrupt::install_saying("\nstopping; finished runs are kept, and the same command goes on with them.")?;
    let bar = shared::bar_of_parts("accuracy");
    let study = accuracy::study(&options, &subject, stop, &|progress| shared::show(&bar, progress, "runs"));
    bar.finish_and_clear();
    let study = study?;
    let files = accuracy::write(&study, &shared::command(), &options.out)?;
    print(&study, &files);
    Ok(if study.interrupted { Ended::Interrupted } else { Ended::Well })
}

fn print(study: &Study, files: &[PathBuf]) {
    say::print(format_args!("{}", table::costs_and_errors(study).to_text()));
    say::print(format_args!("\n{}", table::histories_and_checks(study).to_text()));
    say::print(format_args!("\n{}", table::reference(&study.reference, study.seeds.len())));
    table::scatter(study).iter().for_each(|line| say!("{line}"));
    table::failed(study).iter().for_each(|line| say!("{line}"));
    for (knob, reason) in &study.absent {
        say!("{knob} was not turned: {reason}.");
    }
    let left_out = table::left_out(study);
    if !left_out.is_empty() {
        say!("The budget had no room for:");
        left_out.iter().for_each(|line| say!("  {line}"));
    }
    if let Some(caution) = table::caution(study) {
        say!("{caution}");
    }
    if study.interrupted {
        say!("Interrupted: the same command goes on with what is missing.");
    }
    if study.other_build > 0 {
        say!("{} runs were made by another build with the same physics; --fresh makes them again.", study.other_build);
    }
    say!("{} runs made, {} kept from before. Written:", study.made, study.kept);
    files.iter().for_each(|file| say!("  {}", file.display()));
}
