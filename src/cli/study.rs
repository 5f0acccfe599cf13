//! `strandsnap study`.

use super::Ended;
use super::cases;
use super::interrupt;
use super::say::{self, say};
use super::values::{Seeds, quality};
use crate::base::error::{Error, Result};
use crate::run::folder;
use crate::scene::quality::Quality;
use crate::study::cases::workshop::Progress;
use crate::study::sweep::gather::State;
use crate::study::sweep::report::{self, Findings};
use crate::study::sweep::{self, Changes, Cost, Definition, Gathered, Making, definition};
use std::path::{Path, PathBuf};

const STOPPING: &str = "\nstopping; finished cases are kept, and the same command goes on with them.";

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in study by name (see --list), or the path of a TOML file
    #[arg(value_name = "STUDY", required_unless_present = "list")]
    study: Option<String>,
    /// Accuracy against run time of every case [default: as the study says]
    #[arg(long, value_name = "QUALITY", value_parser = quality())]
    quality: Option<Quality>,
    /// Change a key of every case's scene
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Seeds instead of the study's: how many, such as 8, or which, such as 1,2,3 or 4..9
    #[arg(long, value_name = "SEEDS")]
    seeds: Option<Seeds>,
    /// Cases side by side, each on one thread [default: one per core, which is faster than threads within one]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Folder of the study [default: out/study/NAME]; cases that are kept in it are not run again
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Run the cases again that are kept
    #[arg(long)]
    fresh: bool,
    /// List the cases and what they are expected to take, and run nothing
    #[arg(long, conflicts_with_all = ["case", "collect"])]
    dry_run: bool,
    /// Run the case with this number alone, for batch systems that run cases as an array; --collect gathers them
    #[arg(long, value_name = "K", conflicts_with = "collect")]
    case: Option<usize>,
    /// Gather the cases that are there, and run nothing
    #[arg(long, conflicts_with = "fresh")]
    collect: bool,
    /// List the studies that come with the program
    #[arg(long)]
    list: bool,
}

pub fn study(args: &Args) -> Result<Ended> {
    let Some(name) = args.study.as_ref().filter(|_| !args.list) else {
        return list();
    };
    let changes = Changes {
        quality: args.quality,
        set: args.set.clone(),
        seeds: args.seeds.clone().map_or(Vec::new(), |seeds| seeds.0),
    };
    let definition = Definition::load(name, &changes)?;
    sweep::check(&definition)?;
    for one in &definition.merged {
        eprintln!("note: {} {} is {}, and is not run twice", one.axis, one.same, one.kept);
    }
    let out = args.out.clone().unwrap_or_else(|| folder::study(&definition.name));
    if args.dry_run {
        return dry_run(&definition, &out, jobs(args));
    }
    if args.collect {
        return finish(&definition, &out, false);
    }
    let _lock = cases::lock(&out, args.case.is_some())?;
    sweep::open(&out, args.fresh)?;
    let stop = interrupt::install_saying(STOPPING)?;
    let bar = cases::bar_of_parts("study");
    let tell = |progress: &Progress| cases::show(&bar, progress, "cases");
    let making = Making { folder: &out, jobs: jobs(args), threads: None, stop, tell: &tell };
    if let Some(number) = args.case {
        let made = sweep::make_one(&definition, number, &Making { jobs: 1, ..making });
        bar.finish_and_clear();
        made?;
        return one(&definition, number, &out, stop.load(std::sync::atomic::Ordering::Relaxed));
    }
    let costs = sweep::costs(&definition, &out, &|point| {
        bar.set_message(format!("estimating {}", definition.point_name(point)));
    })?;
    let made = sweep::make(&definition, &costs, &making);
    bar.finish_and_clear();
    made?;
    finish(&definition, &out, stop.load(std::sync::atomic::Ordering::Relaxed))
}

/// Cases side by side.
fn jobs(args: &Args) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    args.jobs.map_or_else(cores, usize::from)
}

fn list() -> Result<Ended> {
    let wide = definition::list().iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, text) in definition::list() {
        let study = Definition::parse(text, &format!("{name}.toml"), Path::new("."), &Changes::default())?;
        say!("{name:wide$}  {} ({} cases)", study.about, study.cases().len());
    }
    Ok(Ended::Well)
}

fn dry_run(definition: &Definition, out: &Path, jobs: usize) -> Result<Ended> {
    let costs = sweep::costs(definition, out, &|_| {})?;
    let gathered = Gathered::read(definition, out)?;
    say::print(format_args!("{}", report::agenda(definition, &gathered, &costs.cases).to_text()));
    say::print(format_args!("\n{}", report::built(definition, &gathered)));
    let by = match costs.ratio {
        Some(ratio) => {
            format!("by their first steps, times {ratio:.1}, which is what a finished case took over its own")
        }
        None => "by their first steps; contacts that form make it up to four times as much".into(),
    };
    let done = costs.cases.iter().filter(|cost| **cost == Cost::Done).count();
    let left = cases::time(costs.left() / jobs as f64);
    say!("{} cases, {done} of them done; about {left} for the others, {jobs} at a time, {by}.", costs.cases.len());
    Ok(Ended::Well)
}

/// What became of a case that was run alone.
fn one(definition: &Definition, number: usize, out: &Path, interrupted: bool) -> Result<Ended> {
    let gathered = Gathered::read(definition, out)?;
    let case = &gathered.cases[number - 1];
    let name = definition.case_name(case.point, case.seed);
    match &case.state {
        State::Refused(cause) => {
            let help = "the others can be run all the same";
            return Err(Error::input(format!("case {number} ({name}) is refused: {cause}"), help));
        }
        State::Failed(cause) => {
            say!("case {number} ({name}) failed: {cause}");
            return Ok(Ended::Missed);
        }
        State::Ran(_) | State::Missing => {}
    }
    match case.measured() {
        Some(run) => say!(
            "case {number} ({name}): strength {:.2} MPa at {:.2} %, in {}",
            run.strength_mpa,
            run.elongation_percent,
            out.join("cases").join(&case.folder).display()
        ),
        None => say!("case {number} ({name}) was interrupted; the same command runs it again"),
    }
    Ok(if interrupted { Ended::Interrupted } else { Ended::Well })
}

/// Gathers what is there, writes and prints it.
fn finish(definition: &Definition, out: &Path, interrupted: bool) -> Result<Ended> {
    let gathered = Gathered::read(definition, out)?;
    if gathered.ran() == 0 && !interrupted {
        let cause = gathered.cases.iter().find_map(|case| case.state.cause());
        let cause = cause.map_or_else(|| "none was run yet".to_string(), |cause| format!("the first says: {cause}"));
        let help = "run the study without --collect, or look at a case with `strandsnap run`";
        return Err(Error::input(format!("no case of {} has a result; {cause}", definition.name), help));
    }
    let findings = Findings::new(definition, &gathered)?;
    let files = report::write(definition, &gathered, &findings, &cases::command(), out)?;
    say::print(format_args!("{}", report::to_text(definition, &gathered, &findings)));
    if interrupted {
        say!("Interrupted: the same command goes on with what is missing.");
    }
    say!("Written:");
    files.iter().for_each(|file| say!("  {}", file.display()));
    Ok(if interrupted { Ended::Interrupted } else { Ended::Well })
}
