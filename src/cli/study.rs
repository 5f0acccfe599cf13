//! `strandsnap study`.

use super::called;
use super::cases::{self, ProgressLine};
use super::ended::Ended;
use super::interrupt;
use super::say::{self, say};
use super::values::{Seeds, name_or_path, quality};
use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::base::wording::counted;
use crate::export::{self, Format};
use crate::observe::files::write_whole;
use crate::run::{DeviceChoice, folder};
use crate::scene::quality::Quality;
use crate::study::runner::{CaseRunner, CaseStore, all_outputs, cores};
use crate::study::sweep::cluster::{Array, BatchSystem, quoted};
use crate::study::sweep::report::{self, Findings};
use crate::study::sweep::{self, CaseResult, Changes, Cost, Definition, Gathered, definition};
use crate::study::tensile::TensileOutcome;
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in study by name (see --list), or the path of a TOML file
    #[arg(value_name = "STUDY", required_unless_present = "list", value_parser = name_or_path())]
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
    /// Compute the steps on this, as `run --device` says: cases side by side on one adapter go together there
    #[arg(long, value_name = "cpu|gpu|auto|NAME", default_value = "cpu")]
    device: DeviceChoice,
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
    /// Write scripts that run the cases which are missing as the array of a batch system, and gather them; run nothing
    #[arg(long, value_name = "slurm|hq|gnu-parallel", conflicts_with_all = ["case", "collect", "dry_run", "fresh", "jobs"])]
    emit: Option<BatchSystem>,
    /// Write the tables as Apache Parquet too
    #[arg(long, conflicts_with_all = ["case", "dry_run", "emit"])]
    parquet: bool,
    /// Spread the cases that are missing over the workers of a Dask cluster, or over processes of this machine, and gather
    /// them. It needs the Python package of strandsnap, in python3 or in the interpreter that STRANDSNAP_PYTHON names
    #[arg(long, value_name = "dask://HOST:PORT|local", conflicts_with_all = ["case", "collect", "dry_run", "emit", "fresh"])]
    on: Option<String>,
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
    if args.parquet {
        export::check(Format::Parquet)?;
    }
    let definition = Definition::load(name, &changes)?;
    for one in &definition.merged {
        eprintln!("note: {} {} is {}, and is not run twice", one.axis, one.same, one.kept);
    }
    let out = args.out.clone().unwrap_or_else(|| folder::study(&definition.name));
    let jobs = args.jobs.map_or_else(cores, usize::from);
    if args.dry_run {
        return dry_run(&definition, &out, &args.device, jobs);
    }
    if let Some(workers) = &args.on {
        return spread(workers);
    }
    if let Some(system) = args.emit {
        return emit(&definition, &out, &args.device, system);
    }
    if args.collect {
        let store = CaseStore::of(&out).on(&args.device);
        let shown = show(&definition, &store, &out, args.parquet);
        cases::tell_damaged(&store, "its case counts as not run, until the study is run again");
        return shown.map(|()| Ended::Well);
    }
    let _lock = cases::lock(&out, args.case.is_some())?;
    let store = CaseStore::open(&out, args.fresh)?.on(&args.device);
    let stop = interrupt::install_for_cases()?;
    let line = ProgressLine::new("study");
    let jobs = if args.case.is_some() { 1 } else { jobs };
    let runner = CaseRunner { jobs, threads: None, budget: None, stop, tell: &|progress| line.show(progress) };
    if let Some(number) = args.case {
        return one(&definition, number, &store, &runner);
    }
    let gathered = Gathered::read(&definition, &store);
    cases::tell_damaged(&store, cases::RUN_AGAIN);
    let costs = sweep::costs(&definition, &gathered, &|point| {
        line.0.set_message(format!("estimating {}", definition.point_name(point)));
    })?;
    let outputs = all_outputs(sweep::run(&definition, &costs, &store, &runner)?);
    drop(line);
    // What is there is shown also after an interruption, which explains what is not.
    let shown = show(&definition, &store, &out, args.parquet);
    outputs.and(shown).map(|()| Ended::Well)
}

fn list() -> Result<Ended> {
    let wide = definition::STUDIES.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, text) in definition::STUDIES {
        let study = Definition::parse(text, &format!("{name}.toml"), Path::new("."), &Changes::default())?;
        say!("{name:wide$}  {} ({})", study.about, counted(study.cases().len(), "case"));
    }
    Ok(Ended::Well)
}

fn dry_run(definition: &Definition, out: &Path, device: &DeviceChoice, jobs: usize) -> Result<Ended> {
    let store = CaseStore::of(out).on(device);
    let gathered = Gathered::read(definition, &store);
    cases::tell_damaged(&store, cases::RUN_AGAIN);
    let costs = sweep::costs(definition, &gathered, &|_| {})?;
    say::print(format_args!("{}", report::case_list(definition, &gathered, &costs.cases).to_text()));
    say::print(format_args!("\n{}", report::built(definition, &gathered)));
    let by = match costs.ratio {
        Some(ratio) => {
            format!("by their first steps, times {ratio:.1}, which is what a finished case took over its own")
        }
        None => "by their first steps; contacts that form make it up to four times as much".into(),
    };
    let done = costs.cases.iter().filter(|cost| **cost == Cost::Done).count();
    let left = cases::time(costs.left() / jobs as f64);
    say!(
        "{}, {done} of them done; about {left} for the others, {jobs} at a time, {by}.",
        counted(costs.cases.len(), "case")
    );
    Ok(Ended::Well)
}

/// Writes scripts that run the cases that are missing on a cluster.
fn emit(definition: &Definition, out: &Path, device: &DeviceChoice, system: BatchSystem) -> Result<Ended> {
    let store = CaseStore::of(out).on(device);
    let gathered = Gathered::read(definition, &store);
    let costs = sweep::costs(definition, &gathered, &|_| {})?;
    let missing: Vec<usize> =
        gathered.cases.iter().filter(|case| case.outcome.is_none()).map(|case| case.number).collect();
    if missing.is_empty() {
        say!("All {} are there; gather them with --collect.", counted(gathered.cases.len(), "case"));
        return Ok(Ended::Well);
    }
    let absolute = |path: &Path| std::path::absolute(path).map_err(|e| Error::io("cannot find", path, e));
    let folder = absolute(&out.join("cluster"))?;
    // What first steps say is a quarter of what a case takes at most, what finished cases say about half.
    let margin = if costs.ratio.is_some() { 2.0 } else { 4.0 };
    let takes =
        costs.cases.iter().filter_map(|cost| if let Cost::Takes(seconds) = cost { Some(*seconds) } else { None });
    let array = Array {
        name: &definition.name,
        cases: &missing,
        command: &[called::starts()?, cases::words_without("--emit")].concat(),
        directory: &absolute(Path::new("."))?,
        folder: &absolute(out)?,
        seconds: takes.reduce(f64::max).map(|seconds| margin * seconds),
        bytes: sweep::memory(definition),
        adapter: *device != DeviceChoice::Processor,
    };
    regular::make_folder(&folder)?;
    regular::make_folder(&out.join("log"))?;
    let scripts = array.scripts(system);
    for (name, text) in &scripts.files {
        write_whole(&folder.join(name), text)?;
    }
    let files: Vec<&str> = scripts.files.iter().map(|(name, _)| *name).collect();
    say!(
        "{} to run; written into {}: {}. Now type",
        counted(missing.len(), "case"),
        folder.display(),
        files.join(", ")
    );
    say!("  cd {}", quoted(&folder.to_string_lossy()));
    scripts.commands.iter().for_each(|command| say!("  {command}"));
    Ok(Ended::Well)
}

/// Has the Python package spread the study that was typed over workers.
fn spread(workers: &str) -> Result<Ended> {
    let named = std::env::var_os("STRANDSNAP_PYTHON").filter(|name| !name.is_empty());
    // An interpreter that runs this has the package.
    let python = named.unwrap_or_else(|| called::within().unwrap_or("python3").into());
    // The first word is this command.
    let words = cases::words_without("--on").into_iter().skip(1);
    let status = std::process::Command::new(&python).args(["-m", "strandsnap.on", workers]).args(words).status();
    let missing = |what: String| {
        let help = Some("install the package with `pip install ./src/python[dask]`".into());
        Error::Missing { what, help }
    };
    let name = python.to_string_lossy();
    let status = status.map_err(|cause| missing(format!("cannot start {name}: {cause}")))?;
    match status.code() {
        Some(0) => Ok(Ended::Well),
        Some(130) => Err(Error::Interrupted),
        // It has said why.
        _ => {
            Err(missing(format!("the study was not finished by `{name} -m strandsnap.on`, which ended with {status}")))
        }
    }
}

/// Runs a case alone, and says what became of it.
fn one(definition: &Definition, number: usize, store: &CaseStore, runner: &CaseRunner) -> Result<Ended> {
    let (point, seed) = sweep::numbered(definition, number)?;
    let case = definition.case((point, seed), 1.0, store);
    let record = all_outputs(runner.run(&[case])?)?.remove(0);
    cases::tell_damaged(store, cases::RUN_AGAIN);
    let name = definition.case_name(point, seed);
    match &record.result {
        TensileOutcome::Refused(cause) => {
            let help = "the others can be run all the same";
            Err(Error::input(format!("case {number} ({name}) is refused: {cause}"), help))
        }
        TensileOutcome::Failed(cause) => {
            say!("case {number} ({name}) failed: {cause}");
            Ok(Ended::Missed)
        }
        TensileOutcome::Ran(run) => {
            let folder = store.folder().join(record.identity.name());
            let [strength, elongation] = [run.strength_mpa, run.elongation_percent];
            say!("case {number} ({name}): strength {strength:.2} MPa at {elongation:.2} %, in {}", folder.display());
            Ok(Ended::Well)
        }
    }
}

/// Gathers what is there, writes and prints it.
fn show(definition: &Definition, store: &CaseStore, out: &Path, parquet: bool) -> Result<()> {
    let gathered = Gathered::read(definition, store);
    if gathered.ran() == 0 {
        let cause = gathered.cases.iter().find_map(CaseResult::cause);
        let cause = cause.map_or_else(|| "none was run yet".to_string(), |cause| format!("the first says: {cause}"));
        let help = "run the study without --collect, or look at a case with `strandsnap run`";
        return Err(Error::input(format!("no case of {} has a result; {cause}", definition.name), help));
    }
    let findings = Findings::new(definition, &gathered)?;
    let files = report::write(definition, &gathered, &findings, &cases::command(), out, parquet)?;
    say::print(format_args!("{}", report::to_text(definition, &gathered, &findings)));
    say!("Written:");
    files.iter().for_each(|file| say!("  {}", file.display()));
    Ok(())
}
