//! `strandsnap resume`.

use super::{Ended, interrupt, run::print};
use crate::base::error::Result;
use crate::run;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run that was interrupted or killed, such as out/ka4
    run: PathBuf,
    /// Threads [default: one per core]; the results are the same on any number
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Show no progress, and one line at the end
    #[arg(long)]
    quiet: bool,
}

pub fn resume(args: Args) -> Result<Ended> {
    let stop = interrupt::install()?;
    let mut note = |what: &str| eprintln!("note: {what}");
    let (summary, options) = run::resume(&args.run, args.threads.map(usize::from), args.quiet, stop, &mut note)?;
    print(&summary, &options);
    Ok(if stop.load(Ordering::Relaxed) { Ended::Interrupted } else { Ended::Well })
}
