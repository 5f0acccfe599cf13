//! `strandsnap stability`.

use super::Ended;
use super::interrupt;
use super::say::{self, say};
use super::verify::prepare;
use crate::base::error::Result;
use crate::study::stability::outcome::{Outcome, Report};
use crate::study::stability::{plots, report, run_all, select};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Instant;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Cases to run; "friction-*" takes all that begin so [default: all, see --list]
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// Shorter runs of the long cases, in a minute or two
    #[arg(long)]
    quick: bool,
    /// Write what was found as a list of objects
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Folder of the plots of time steps and energy residuals
    #[arg(long, value_name = "DIR", default_value = "out/stability", conflicts_with = "no_plots")]
    out: PathBuf,
    /// Draw no plots
    #[arg(long)]
    no_plots: bool,
    /// Cases that run side by side, each on one thread [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// List the cases, and run none
    #[arg(long)]
    list: bool,
}

pub fn stability(args: &Args) -> Result<Ended> {
    let cases = select(&args.cases)?;
    if args.list {
        say::print(format_args!("{}", report::list(&cases)));
        return Ok(Ended::Well);
    }
    prepare(args.json.as_deref(), (!args.no_plots).then_some(&args.out))?;
    let stop = interrupt::install()?;
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = args.threads.map_or_else(cores, usize::from);
    let bar = ProgressBar::with_draw_target(Some(cases.len() as u64), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("stability [{bar:24}] {pos} of {len} cases  {msg}");
    bar.set_style(style.expect("the template is constant and right"));
    let done = |report: &Report| {
        bar.set_message(format!("{}: {}", report.case.name, report.outcome));
        bar.inc(1);
    };
    let began = Instant::now();
    let reports = run_all(&cases, args.quick, threads, stop, &done);
    bar.finish_and_clear();
    say::print(format_args!("{}", report::table(&reports)));
    say!("\n{}", report::summary(&reports, began.elapsed().as_secs_f64()));
    if let Some(path) = &args.json {
        report::write_json(&reports, path)?;
        say!("findings: {}", path.display());
    }
    if !args.no_plots {
        let files = plots::write(&reports, &args.out)?;
        say!("plots: {} files in {}", files.len(), args.out.display());
    }
    if stop.load(Ordering::Relaxed) {
        say!("interrupted: {} of {} cases were run", reports.len(), cases.len());
        return Ok(Ended::Interrupted);
    }
    Ok(if reports.iter().any(|r| r.outcome == Outcome::Failed) { Ended::Missed } else { Ended::Well })
}
