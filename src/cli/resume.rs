//! `strandsnap resume`.

use super::ended::Ended;
use super::interrupt;
use super::progress::Progress;
use super::run::print;
use crate::base::error::Result;
use crate::observe::Observer;
use crate::run::{self, Resumable};
use std::path::PathBuf;

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

pub fn resume(args: &Args) -> Result<Ended> {
    let threads = args.threads.map(usize::from);
    let stop = interrupt::install()?;
    let resumable = Resumable::open(&args.run, threads, &mut |what| eprintln!("note: {what}"))?;
    let options = resumable.options.clone();
    let summary = run::in_pool(threads, || {
        let mut progress = (!args.quiet).then(|| Progress::new(&resumable.scene.spec.stop));
        let watchers = progress.iter_mut().map(|bar| bar as &mut dyn Observer).collect();
        resumable.go_on(watchers, stop)
    })??;
    print(&summary, &options, args.quiet);
    interrupt::ended(stop)
}
