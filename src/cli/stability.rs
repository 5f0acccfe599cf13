//! `strandsnap stability`.

use super::{Ended, interrupt};
use crate::base::error::Result;
use crate::study::stability::table::{self, Table};
use crate::study::stability::{outcome::Outcome, run_all, select};
use std::path::PathBuf;
use std::sync::atomic::Ordering;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Cases to run; `friction-*` takes all that begin so [default: all]
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// Fewer steps in the long cases: the whole matrix in about a minute
    #[arg(long)]
    quick: bool,
    /// List the cases and run none
    #[arg(long)]
    list: bool,
    /// Write the results to a JSON file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Cases at a time, each on one thread [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

pub fn run(args: &Args) -> Result<Ended> {
    let cases = select(&args.cases)?;
    if args.list {
        cases.iter().for_each(|case| println!("{:<22} {}", case.name, case.about));
        return Ok(Ended::Well);
    }
    let threads = args.threads.map_or_else(|| std::thread::available_parallelism().map_or(1, Into::into), usize::from);
    let stop = interrupt::install()?;
    println!("{}", Table::HEAD);
    let reports = run_all(&cases, args.quick, threads, stop, &mut |report| println!("{}", Table::row(report)));
    println!("\n{}", table::summary(&reports));
    if let Some(file) = &args.json {
        table::write_json(file, &reports)?;
    }
    Ok(match reports.iter().any(|report| report.outcome == Outcome::Failed) {
        _ if stop.load(Ordering::Relaxed) => Ended::Interrupted,
        true => Ended::Failed,
        false => Ended::Well,
    })
}
