//! `strandsnap resume`.

use super::counted::Counted;
use super::ended::Ended;
use super::explore::{AddressArgs, Watched};
use super::finished::{check_more, make_more, print};
use super::interrupt;
use super::progress::Progress;
use super::values::{Threads, duration, threads};
use crate::base::error::Result;
use crate::observe::Observer;
use crate::run::drawing::Undrawn;
use crate::run::{self, DeviceChoice, Resumable};
use std::path::PathBuf;
use std::time::Duration;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run that was interrupted or killed, such as out/ka4; where only pictures are missing, they are drawn
    run: PathBuf,
    /// Threads: a number, or as many as make it faster, up to one per core; the results are the same on any number
    #[arg(long, value_name = "N|auto", value_parser = threads, default_value = "auto")]
    threads: Threads,
    /// Compute on this from here on, as `run --device` says [default: what the run began with]
    #[arg(long, value_name = "cpu|gpu|auto|NAME")]
    device: Option<DeviceChoice>,
    /// Stop after this time, such as 90s, 20m or 2h, as Ctrl-C does: results so far are kept, exit code 130
    #[arg(long, value_name = "TIME", value_parser = duration)]
    time_limit: Option<Duration>,
    /// Show no progress, and one line at the end
    #[arg(long)]
    quiet: bool,
}

pub fn resume(args: &Args) -> Result<Ended> {
    if let Some(undrawn) = Undrawn::find(&args.run)? {
        return draw(undrawn, args.time_limit, args.quiet);
    }
    let resumable = Resumable::open(&args.run, args.threads.count(), args.device.clone())?;
    go_on(resumable, args.time_limit, args.quiet, None)
}

/// Goes on with a run to its end, and says how it ended.
pub(super) fn go_on(
    resumable: Resumable,
    time_limit: Option<Duration>,
    quiet: bool,
    explore: Option<&AddressArgs>,
) -> Result<Ended> {
    let stop = interrupt::install()?;
    time_limit.into_iter().for_each(interrupt::after);
    let options = resumable.options.clone();
    let spec = resumable.scene.spec.clone();
    check_more(&options.out, &spec.output)?;
    let mut watched = Watched::begin(explore, &options.out, &resumable.scene.spec, stop)?;
    let summary = run::in_pool(options.threads, || {
        let mut progress = (!quiet).then(|| Progress::new(&resumable.scene.spec.stop));
        let bar = progress.iter_mut().map(|bar| bar as &mut dyn Observer);
        let watchers = bar.chain(watched.observer()).collect();
        resumable.go_on(&|what| eprintln!("note: {what}"), watchers, stop)
    })??;
    print(&summary, &options, quiet);
    make_more(&summary, &spec, &options.out, quiet, stop)?;
    watched.end(&summary, stop);
    interrupt::ended_run(&summary)
}

/// Draws the pictures that a run has not drawn, and says how it ended.
pub(super) fn draw(undrawn: Undrawn, time_limit: Option<Duration>, quiet: bool) -> Result<Ended> {
    let stop = interrupt::install()?;
    time_limit.into_iter().for_each(interrupt::after);
    let options = undrawn.options.clone();
    let spec = undrawn.scene().spec.clone();
    check_more(&options.out, &spec.output)?;
    eprintln!("note: the run has come to its end; drawing the pictures that are missing");
    let mut drawing = undrawn.begin()?;
    let count = drawing.replay.count();
    drawing.replay.show(&mut Counted::new(&mut *drawing.writer, count, !quiet), stop)?;
    let summary = drawing.end()?;
    print(&summary, &options, quiet);
    make_more(&summary, &spec, &options.out, quiet, stop)?;
    interrupt::ended_run(&summary)
}
