//! `strandsnap accuracy`.

use super::cases::{self as shared, ProgressLine};
use super::ended::Ended;
use super::interrupt;
use super::say::{self, say};
use super::values::{SceneArgs, Seeds, duration};
use crate::base::error::{Error, Result};
use crate::base::wording::counted;
use crate::run::folder;
use crate::scene::quality::Quality;
use crate::study::accuracy::{self, Study, Subject, parameters, table, verified};
use crate::study::runner::{CaseRunner, CaseStore};
use crate::study::verify::{Effort, VerificationCase};
use std::path::PathBuf;
use std::time::Duration;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// Seeds: how many, such as 8, or which, such as 1,2,3 or 4..9. Errors are those of their mean and of their spread, and
    /// every run is made once per seed [default: 4 where bonds scatter and nothing exact is known]
    #[arg(long, value_name = "SEEDS", conflicts_with = "seed")]
    seeds: Option<Seeds>,
    /// Numerical parameters to vary [default: all, see --list]
    #[arg(long, value_name = "PARAMETER,PARAMETER", value_delimiter = ',')]
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
    /// List the parameters with the values that this scene would get, and run nothing
    #[arg(long)]
    list: bool,
}

pub fn accuracy(args: &Args) -> Result<Ended> {
    let cases = verified::select(&args.scene.scene);
    if cases.is_empty() { of_pulled_scene(args) } else { of_cases(args, &cases) }
}

/// Of verification cases, which vary what they vary.
fn of_cases(args: &Args, cases: &[&'static VerificationCase]) -> Result<Ended> {
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
    let effort = if args.quick { Effort::Quick } else { Effort::Full };
    let store = CaseStore::open(&out, args.fresh)?;
    let stop = interrupt::install_for_cases()?;
    let line = ProgressLine::new("accuracy");
    // One by one and each on one thread, because their run times are shown.
    let runner = CaseRunner { jobs: 1, threads: Some(1), budget: None, stop, tell: &|progress| line.show(progress) };
    let found = verified::study(&name, cases, effort, &store, &runner)?;
    drop(line);
    shared::tell_damaged(&store, shared::RUN_AGAIN);
    let files = found.write(&shared::command(), &out)?;
    say::print(format_args!("{}", found.table().to_text()));
    say::print(format_args!("\n{}", found.summary()));
    say!("{} run, {} kept from before. Written:", counted(found.cases.len() - found.kept, "case"), found.kept);
    files.iter().for_each(|file| say!("  {}", file.display()));
    interrupt::ended(stop)
}

fn of_pulled_scene(args: &Args) -> Result<Ended> {
    if args.quick {
        let help = "say how much time there is with --budget, or vary fewer parameters with --vary";
        return Err(Error::input("--quick is for verification cases", help));
    }
    let seeds = match (&args.seeds, args.scene.seed) {
        (Some(seeds), _) => seeds.0.clone(),
        (None, seed) => seed.into_iter().collect(),
    };
    let parameters = parameters::select(&args.vary)?;
    let subject = Subject::new(args.scene.load()?, &parameters, seeds)?;
    if args.list {
        say::print(format_args!("{}", table::list(&subject)));
        return Ok(Ended::Well);
    }
    let out = args.out.clone().unwrap_or_else(|| folder::accuracy(&subject.scene.spec.name));
    let _lock = shared::lock(&out, false)?;
    subject.notes.iter().for_each(|note| eprintln!("note: {note}"));
    let store = CaseStore::open(&out, args.fresh)?;
    let stop = interrupt::install_for_cases()?;
    let line = ProgressLine::new("accuracy");
    let runner = CaseRunner {
        jobs: args.jobs.into(),
        threads: args.threads.map(usize::from),
        budget: args.budget.map(|budget| budget.as_secs_f64()),
        stop,
        tell: &|progress| line.show(progress),
    };
    let study = accuracy::study(&subject, &store, &runner)?;
    drop(line);
    shared::tell_damaged(&store, shared::RUN_AGAIN);
    let files = accuracy::write(&study, &shared::command(), &out)?;
    print(&study, &files);
    interrupt::ended(stop)
}

fn print(study: &Study, files: &[PathBuf]) {
    say::print(format_args!("{}", table::costs_and_errors(study).to_text()));
    say::print(format_args!("\n{}", table::histories_and_checks(study).to_text()));
    say::print(format_args!("\n{}", table::reference(&study.reference, study.seeds.len())));
    table::scatter(study).iter().for_each(|line| say!("{line}"));
    table::failed(study).iter().for_each(|line| say!("{line}"));
    for (parameter, reason) in &study.absent {
        say!("{parameter} was not varied: {reason}.");
    }
    let left_out = table::left_out(study);
    if !left_out.is_empty() {
        say!("The budget had no room for:");
        left_out.iter().for_each(|line| say!("  {line}"));
    }
    if let Some(caution) = table::caution(study) {
        say!("{caution}");
    }
    if study.other_build > 0 {
        say!("Made by another build with the same physics, until --fresh: {}.", counted(study.other_build, "run"));
    }
    say!("{} made, {} kept from before. Written:", counted(study.made, "run"), study.kept);
    files.iter().for_each(|file| say!("  {}", file.display()));
}
