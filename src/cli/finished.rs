//! What is said of a run that has ended, and the files for other programs that it then gets.

use super::say::say;
use crate::base::error::{Error, Result};
use crate::base::finding::StopReason;
use crate::base::wording::counted;
use crate::export::{self, also};
use crate::observe::report::{one_line, report};
use crate::run::folder::{FRAMES, RECORDING};
use crate::run::{self, RunOptions, RunSummary, outputs};
use crate::scene::spec::{OutputSpec, Spec};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Says how a run ended, and where its results are.
pub fn print(summary: &RunSummary, options: &RunOptions, quiet: bool) {
    for warning in &summary.warnings {
        eprintln!("WARNING: {warning}");
    }
    if quiet {
        say!("{}", one_line(summary));
    } else {
        say!("{}\n{}", summary.scene, report(summary));
    }
    let undrawn = summary.cost.frames.map_or(0, |frames| frames.not_drawn as usize);
    if undrawn > 0 {
        say!("{} still to be drawn: the run was stopped.", counted(undrawn, "picture"));
    }
    let unfinished = summary.cost.frames.is_some_and(|frames| frames.unfinished());
    if unfinished && undrawn == 0 {
        say!("The animation is still to be made: the run was stopped.");
    }
    if run::checkpoint::latest(&options.out).is_ok() || (unfinished && summary.stopped != StopReason::Interrupted) {
        say!("Go on with: strandsnap resume {}", options.out.display());
    }
    if !quiet {
        say!("Results are in {}:", options.out.display());
        let bodies = if summary.bodies.is_empty() { "" } else { "bodies.csv, " };
        say!("  summary.json, curve.csv, wires.csv, ruptures.csv, {bodies}scene.toml");
        if options.frames {
            say!("  {}: one picture per snapshot", options.out.join(FRAMES).display());
        }
        if let (Some(animation), Some(frames)) = (&options.animation, summary.cost.frames.filter(|f| !f.not_animated)) {
            say!("  {}: {} of animation", animation.file.display(), outputs::megabytes(frames.animation_bytes));
        }
        say!("Make one page of all of it with: strandsnap report {}", options.out.display());
        if outputs::HAS_RENDER {
            say!("Draw it again from elsewhere with: strandsnap render {}", options.out.display());
        }
        if options.recording {
            say!("Open the recording ({RECORDING}) with: strandsnap view {}", options.out.display());
        }
    }
}

/// Checks, before the simulation, that what [`make_more`] makes after it can be made.
///
/// # Errors
/// [`Error::Missing`] without what it takes; [`Error::Input`] where something stands in its way.
pub fn check_more(run: &Path, output: &OutputSpec) -> Result<()> {
    export::check_also(run, &output.also)?;
    check_pictures(run, output)
}

/// Makes what `output.picture` and `output.also` ask for, see [`also`], and says so.
///
/// # Errors
/// As for [`also`], and what drawing says; [`Error::Interrupted`] when it was stopped meanwhile, with what makes the rest told.
pub fn make_more(summary: &RunSummary, spec: &Spec, run: &Path, quiet: bool, stop: &AtomicBool) -> Result<()> {
    let undrawn = draw_pictures(summary, spec, run, quiet, stop)?;
    let also = also(run, summary, &spec.output.also, stop)?;
    for made in also.made.iter().filter(|_| !quiet) {
        let size = outputs::megabytes(made.bytes);
        say!("  {}: {} ({size})", made.folder.display(), counted(made.files, "file"));
    }
    let left: Vec<String> = undrawn.into_iter().chain(also.left).collect();
    left.iter().for_each(|command| say!("Still to be made: {command}"));
    if left.is_empty() { Ok(()) } else { Err(Error::Interrupted) }
}

#[cfg(feature = "explore")]
fn check_pictures(run: &Path, output: &OutputSpec) -> Result<()> {
    crate::explore::pictures::check(run, output)
}

#[cfg(not(feature = "explore"))]
fn check_pictures(_: &Path, output: &OutputSpec) -> Result<()> {
    match output.pictures[..] {
        [] => Ok(()),
        _ => Err(outputs::built_without("pictures of a view", "explore", "leave out output.picture")),
    }
}

/// Draws the pictures of a scene and gives the commands that draw what was left.
#[cfg(feature = "explore")]
fn draw_pictures(summary: &RunSummary, spec: &Spec, run: &Path, quiet: bool, stop: &AtomicBool) -> Result<Vec<String>> {
    use crate::explore::pictures::{Drawn, are_due, command, draw};

    let drawn = if are_due(summary) { draw(run, spec, stop)? } else { Drawn::default() };
    drawn.made.iter().filter(|_| !quiet).for_each(|file| say!("  {}", file.display()));
    drawn.left_out.iter().for_each(|why| eprintln!("WARNING: {why}"));
    Ok(if drawn.stopped { vec![command(run)] } else { Vec::new() })
}

#[cfg(not(feature = "explore"))]
fn draw_pictures(_: &RunSummary, _: &Spec, _: &Path, _: bool, _: &AtomicBool) -> Result<Vec<String>> {
    Ok(Vec::new())
}
