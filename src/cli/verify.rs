//! `strandsnap verify`.

use super::Ended;
use super::interrupt;
use super::say::{self, say};
use crate::base::error::{Error, Result};
use crate::study::verify::{self, CASES, Effort, Report, plots, report};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Cases to run [default: all, see --list]
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// Fewer points and shorter runs of every case, in a minute
    #[arg(long)]
    quick: bool,
    /// Write what was found as a list of objects
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Folder of the plots of error against resolution and run time
    #[arg(long, value_name = "DIR", default_value = "out/verify", conflicts_with = "no_plots")]
    out: PathBuf,
    /// Draw no plots
    #[arg(long)]
    no_plots: bool,
    /// Cases that run side by side, each on one thread [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// List the cases and where their equations come from, and run none
    #[arg(long)]
    list: bool,
}

pub fn verify(args: &Args) -> Result<Ended> {
    if args.list {
        list();
        return Ok(Ended::Well);
    }
    let cases = verify::select(&args.cases)?;
    prepare(args.json.as_deref(), (!args.no_plots).then_some(&args.out))?;
    let stop = interrupt::install()?;
    let effort = if args.quick { Effort::Quick } else { Effort::Full };
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = args.threads.map_or_else(cores, usize::from);
    let bar = ProgressBar::with_draw_target(Some(cases.len() as u64), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("verify [{bar:24}] {pos} of {len} cases  {msg}");
    bar.set_style(style.expect("the template is constant and right"));
    let done = |report: &Report| {
        bar.set_message(format!("{}: {}", report.case.name, if report.passes() { "pass" } else { "MISS" }));
        bar.inc(1);
    };
    let began = Instant::now();
    let reports = verify::run_all(&cases, effort, threads, stop, &done)?;
    bar.finish_and_clear();
    show(&reports, began.elapsed().as_secs_f64());
    if let Some(path) = &args.json {
        report::write_json(&reports, path)?;
        say!("findings: {}", path.display());
    }
    if !args.no_plots {
        let files = plots::write(&reports, &args.out)?;
        if !files.is_empty() {
            say!("plots: {} files in {}", files.len(), args.out.display());
        }
    }
    if stop.load(Ordering::Relaxed) {
        say!("interrupted: {} of {} cases were run", reports.len(), cases.len());
        return Ok(Ended::Interrupted);
    }
    Ok(if reports.iter().all(Report::passes) { Ended::Well } else { Ended::Missed })
}

/// Whether results can be written is found out before minutes are spent on them.
pub(super) fn prepare(json: Option<&Path>, plots: Option<&PathBuf>) -> Result<()> {
    let make =
        |folder: &Path| std::fs::create_dir_all(folder).map_err(|e| Error::io("cannot make the folder", folder, e));
    plots.map_or(Ok(()), |folder| make(folder))?;
    match json {
        Some(file) if file.is_dir() => {
            Err(Error::input(format!("--json {} is a folder", file.display()), "give the name of a file"))
        }
        Some(file) => file.parent().map_or(Ok(()), make),
        None => Ok(()),
    }
}

fn list() {
    let width = CASES.iter().map(|case| case.name.len()).max().unwrap_or(0);
    for case in CASES {
        say!("{:width$}  {}", case.name, case.about);
        say!("{:width$}  {}", "", case.source);
    }
}

fn show(reports: &[Report], seconds: f64) {
    say::print(format_args!("{}", report::table(reports)));
    let notes = report::notes(reports);
    if !notes.is_empty() {
        say!("\nNotes:\n{notes}");
    }
    let passed = reports.iter().filter(|r| r.passes()).count();
    let missed: Vec<&str> = reports.iter().filter(|r| !r.passes()).map(|r| r.case.name).collect();
    let tail = if missed.is_empty() { String::new() } else { format!("; not: {}", missed.join(", ")) };
    say!("{passed} of {} cases agree with their closed forms in {seconds:.1} s{tail}", reports.len());
}
