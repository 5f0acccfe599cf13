//! Floor 9: the command line. One file per subcommand; each turns arguments into a call below and prints the answer.

/// Stands for the usual one in all commands: see [`say::tell`].
macro_rules! eprintln {
    ($($part:tt)*) => { $crate::cli::say::tell(format_args!($($part)*)) };
}

mod accuracy;
mod animation;
mod calibrate;
mod called;
mod cases;
mod centrelines;
mod check_run;
mod counted;
mod devices;
mod ended;
mod explore;
mod export;
mod finished;
mod import;
mod interrupt;
mod keys;
mod look;
mod manual;
mod plan;
mod progress;
mod record;
mod render;
mod report;
mod resume;
mod run;
mod say;
mod scene;
mod select;
mod stability;
mod study;
mod values;
mod verify;
mod view;

use crate::base::error::{Error, Result};
use crate::engine::REVISION;
use clap::{CommandFactory, Parser, Subcommand};
use ended::Ended;
use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;
use std::sync::LazyLock;

/// Pull stranded wire until it snaps: a discrete-element engine, and the pictures that show how it fails.
#[derive(Debug, Parser)]
#[command(name = "strandsnap", version = VERSION.as_str(), about, propagate_version = true, after_help = EXIT_CODES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Simulate a scene and write its results to a folder
    Run(run::Args),
    /// Go on with a run that was interrupted or killed, from its last checkpoint
    Resume(resume::Args),
    /// Say what a scene would run, what is left out and why, and what it would cost
    Plan(plan::Args),
    /// List, show, check or start scenes, and list their keys
    #[command(subcommand)]
    Scene(scene::Command),
    /// Make a scene of the wires of a CAD model: curves or tubes in STEP or DXF, or points as text
    Import(import::Args),
    /// Open the recording of a run in an installed Rerun viewer, or serve it to a browser
    View(view::Args),
    /// Look at a run from any side in a browser: turn it, cut it open, follow its strain, click what broke
    Explore(explore::Args),
    /// Write one page (HTML) that tells what a run found: answer, curve, map, frames, tables
    Report(report::Args),
    /// Draw the frames of a finished run again, without simulating
    Render(render::Args),
    /// Write the recording of a finished run again, without simulating
    Record(record::Args),
    /// Write a finished run in files that other programs open: Parquet, VTK, LAMMPS, extended XYZ
    Export(export::Args),
    /// Fit a pulled scene's hardening and rupture strain to the strength and elongation of one tensile test
    Calibrate(calibrate::Args),
    /// Say what accuracy each second buys: error against run time, parameter by parameter
    Accuracy(accuracy::Args),
    /// Vary a scene: pitch, wire diameter, seeds, or what a file says; gather, fit, and set beside the paper and theory
    Study(study::Args),
    /// Check that all files of a run agree with each other and with physics
    CheckRun(check_run::Args),
    /// Compare the engine with closed forms
    Verify(cases::CaseArgs),
    /// Run stiff and extreme cases ("friction-*" takes all that begin so): each must be stable, or be refused or
    /// stopped with its reason
    Stability(cases::CaseArgs),
    /// List what this machine can compute and draw with: processor and graphics adapters, and what each is used for
    Devices(devices::Args),
    /// Print the completions of a shell for this program, to be put where that shell looks for them
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Write the manual pages of this program and of its commands into a folder
    Man {
        /// The folder; it is made if it does not exist
        folder: std::path::PathBuf,
    },
}

/// What the program answers to whoever called it ([`crate::base::error::Error::exit_code`], [`Ended`]).
const EXIT_CODES: &str = "\
Exit codes:
    0  well
    1  the file system refused something
    2  bad input
    3  the machine lacks something (graphics adapter, Rerun viewer)
    4  the simulation had to stop, or a case or a check misses what it must give
  130  interrupted (Ctrl-C); what was found so far is kept, unless Ctrl-C comes again two seconds later or more.
       `explore` and `view` are there until Ctrl-C, which ends them well (0)";

/// Runs the program on its arguments and answers with one of the exit codes that `--help` lists.
pub fn main() -> ExitCode {
    ExitCode::from(answer())
}

/// [`main`] from within another program, with `arguments` (those after its name); `starts` are the words that start it
/// again, to be followed by arguments: the scripts of `study --emit` begin with them. It may end the process, as it does
/// after `--help`.
pub fn main_within(starts: Vec<String>, arguments: Vec<OsString>) -> u8 {
    called::tell(starts, arguments);
    answer()
}

/// Version of the program, and the revision of the physics, which decides what its runs give.
static VERSION: LazyLock<String> =
    LazyLock::new(|| format!("{} (physics revision {REVISION})", env!("CARGO_PKG_VERSION")));

fn answer() -> u8 {
    let typed = std::iter::once(OsString::from("strandsnap")).chain(called::arguments().iter().cloned());
    match dispatch(Cli::parse_from(typed).command) {
        Ok(Ended::Well) => 0,
        Ok(Ended::Missed) => 4,
        // Whoever pressed Ctrl-C was told what is kept.
        Err(error @ Error::Interrupted) => error.exit_code(),
        Err(error) => {
            let code = error.exit_code();
            // Where this is lost too, the code is what remains.
            let _ = writeln!(std::io::stderr(), "{:?}", miette::Report::new(error));
            code
        }
    }
}

fn dispatch(command: Command) -> Result<Ended> {
    match command {
        Command::Run(args) => run::run(args),
        Command::Resume(args) => resume::resume(&args),
        Command::Plan(args) => plan::plan(&args).map(|()| Ended::Well),
        Command::Scene(command) => scene::scene(&command).map(|()| Ended::Well),
        Command::Import(args) => import::import(&args).map(|()| Ended::Well),
        Command::Export(args) => export::export(args),
        Command::Calibrate(args) => calibrate::run(&args),
        Command::Accuracy(args) => accuracy::accuracy(&args),
        Command::Study(args) => study::study(&args),
        Command::Stability(args) => stability::stability(&args),
        Command::Render(args) => render::render(args),
        Command::CheckRun(args) => check_run::check_run(&args),
        Command::Verify(args) => verify::verify(&args),
        Command::Report(args) => report::report(&args).map(|()| Ended::Well),
        Command::Record(args) => record::record(args),
        Command::View(args) => view::view(args),
        Command::Explore(args) => explore::explore(args),
        Command::Devices(args) => {
            devices::devices(&args);
            Ok(Ended::Well)
        }
        Command::Completions { shell } => {
            manual::completions(shell, &mut Cli::command());
            Ok(Ended::Well)
        }
        Command::Man { folder } => manual::pages(Cli::command(), &folder).map(|()| Ended::Well),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
