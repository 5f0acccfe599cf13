//! `strandsnap run`.

use super::animation::AnimationArgs;
use super::ended::Ended;
use super::explore::{AddressArgs, Watched};
use super::finished::{check_more, make_more, print};
use super::interrupt;
use super::look::LookArgs;
use super::progress::Progress;
use super::resume::{draw, go_on};
use super::values::{SceneArgs, Threads, duration, threads};
use crate::base::error::{Error, Result};
use crate::observe::Observer;
use crate::run::drawing::Undrawn;
use crate::run::folder::{ANIMATION, SUMMARY};
use crate::run::{self, DeviceChoice, Resumable, RunOptions, cautions, lock, outputs};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Where a Rerun viewer listens when nobody says otherwise.
pub(super) const DEFAULT_VIEWER: &str = "rerun+http://127.0.0.1:9876/proxy";

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// Folder of the results [default: out/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace earlier results in that folder
    #[arg(long)]
    overwrite: bool,
    /// Wait for another process that writes into that folder, instead of refusing; what it leaves there asks for
    /// --overwrite or --resume
    #[arg(long)]
    wait: bool,
    /// Go on from the last checkpoint in that folder, if it holds an unfinished run of this scene, with the outputs
    /// that it began with: one command to start a job and to start it again. A finished run is refused, with exit code 2
    #[arg(long)]
    resume: bool,
    /// Stop after this time, such as 90s, 20m or 2h, as Ctrl-C does: results so far are kept, exit code 130
    #[arg(long, value_name = "TIME", value_parser = duration)]
    time_limit: Option<Duration>,
    /// Threads: a number, or as many as make it faster, up to one per core; the results are the same on any number
    #[arg(long, value_name = "N|auto", value_parser = threads, default_value = "auto")]
    threads: Threads,
    /// Compute on the processor (cpu), on a graphics adapter with 64-bit numbers (gpu), on the one with this in its name, or on
    /// one that is there and can (auto); `strandsnap devices` lists them. Results of different devices differ by rounding
    /// [default: cpu]
    #[arg(long, value_name = "cpu|gpu|auto|NAME")]
    device: Option<DeviceChoice>,
    /// Draw no frames (this needs no graphics adapter)
    #[arg(long, conflicts_with = "animation")]
    no_frames: bool,
    /// Write no Rerun recording
    #[arg(long)]
    no_recording: bool,
    /// Stream to a Rerun viewer that is already open
    #[arg(long, value_name = "URL", num_args = 0..=1, default_missing_value = DEFAULT_VIEWER)]
    live: Option<String>,
    /// Show the run in a browser while it goes on: its newest state from any side, its curve; hold it, step it, stop it
    #[arg(long)]
    explore: bool,
    #[command(flatten)]
    address: AddressArgs,
    /// Show no progress, and one line at the end
    #[arg(long)]
    quiet: bool,
    #[command(flatten)]
    animation: AnimationArgs,
    #[command(flatten)]
    look: LookArgs,
}

pub fn run(args: Args) -> Result<Ended> {
    let mut scene = args.scene.load()?;
    note_what_was_not_built(&args);
    args.look.apply(&mut scene.spec.output);
    let out = args.out.unwrap_or_else(|| Path::new("out").join(&scene.spec.name));
    if args.wait {
        wait(&out, args.overwrite || args.resume, args.time_limit)?;
    }
    // The limit of one that may have waited runs already.
    let time_limit = args.time_limit.filter(|_| !args.wait);
    let explore = args.explore.then_some(&args.address);
    if args.resume && run::folder::has_checkpoint(&out) {
        let resumable = Resumable::open(&out, args.threads.count(), args.device)?;
        resumable.check_scene(&scene)?;
        return go_on(resumable, time_limit, args.quiet, explore);
    }
    if args.resume
        && let Some(undrawn) = Undrawn::find(&out)?.filter(|undrawn| undrawn.is_of(&scene))
    {
        return draw(undrawn, time_limit, args.quiet);
    }
    if args.resume && !args.overwrite && out.join(SUMMARY).is_file() && !run::folder::is_unfinished(&out) {
        return Err(Error::input(
            format!("the run in {} has come to its end", out.display()),
            "there is nothing to go on with; --overwrite runs it again, in place of its results",
        ));
    }
    check_more(&out, &scene.spec.output)?;
    let options = RunOptions {
        animation: args.animation.resolve(&out.join(ANIMATION)),
        // What was ended before its first checkpoint begins anew.
        overwrite: args.overwrite || (args.resume && run::folder::is_unfinished(&out)),
        out,
        wait: args.wait,
        threads: args.threads.count(),
        device: args.device.unwrap_or_default(),
        frames: outputs::HAS_RENDER && !args.no_frames,
        recording: outputs::HAS_RECORD && !args.no_recording,
        live: args.live,
    };
    let before = cautions::of_run(&scene, &run::assemble(&scene)?)?;
    before.iter().for_each(|caution| eprintln!("WARNING: {caution}"));
    let stop = interrupt::install()?;
    time_limit.into_iter().for_each(interrupt::after);
    let mut watched = Watched::begin(explore, &options.out, &scene.spec, stop)?;
    let summary = run::in_pool(options.threads, || {
        let mut progress = (!args.quiet).then(|| Progress::new(&scene.spec.stop));
        let bar = progress.iter_mut().map(|bar| bar as &mut dyn Observer);
        let watchers = bar.chain(watched.observer()).collect();
        run::run_watched(&scene, &options, watchers, stop)
    })??;
    print(&summary, &options, args.quiet);
    make_more(&summary, &scene.spec, &options.out, args.quiet, stop)?;
    watched.end(&summary, stop);
    interrupt::ended_run(&summary)
}

/// Waits until no other process writes into a folder, and says so; `takes_over`: what that one leaves there may be replaced
/// or gone on with.
fn wait(out: &Path, takes_over: bool, time_limit: Option<Duration>) -> Result<()> {
    let stop = interrupt::install()?;
    time_limit.into_iter().for_each(interrupt::after);
    if let Some(process) = lock::holder(out).filter(|_| takes_over) {
        eprintln!("note: waiting for the end of process {process}, which writes into {}", out.display());
    }
    lock::wait_to_write(out, takes_over, stop)
}

/// Frames and recording are on unless refused; a program that cannot make them must say so.
fn note_what_was_not_built(args: &Args) {
    if !outputs::HAS_RENDER && !args.no_frames {
        eprintln!("note: no frames, because this program was built without the feature `render`");
    }
    if !outputs::HAS_RECORD && !args.no_recording {
        eprintln!("note: no recording, because this program was built without the feature `record`");
    }
}
