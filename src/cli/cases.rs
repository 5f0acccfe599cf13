//! What commands that make many runs share: arguments of those that run a table of cases, progress, and what was typed.

use super::called;
use super::interrupt;
use super::say::say;
use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::run::DeviceChoice;
use crate::run::lock::Lock;
use crate::study::runner::{CaseRunner, CaseStore, Progress, Status, Unfinished, cores};
use crate::study::sweep::cluster::quoted;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::path::{Path, PathBuf};

/// Which cases, how thoroughly, and where the results go.
#[derive(Debug, clap::Args)]
pub struct CaseArgs {
    /// Cases to run [default: all, see --list]
    #[arg(value_name = "CASE")]
    pub cases: Vec<String>,
    /// Shorter runs, in a minute
    #[arg(long)]
    pub quick: bool,
    /// Write what was found as a list of objects
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Folder of the plots [default: out/ and the command's name]. Until all cases are over it also holds those that are: a
    /// command that was killed or interrupted goes on with the others when it is started again
    #[arg(long, value_name = "DIR", conflicts_with = "no_plots")]
    out: Option<PathBuf>,
    /// Draw no plots, and keep no cases
    #[arg(long)]
    no_plots: bool,
    /// Run all cases again, those too that a command which was ended has finished
    #[arg(long)]
    fresh: bool,
    /// Cases that run side by side, each on one thread [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Compute the steps on this, as `run --device` says; cases whose steps cannot be done there are computed on the processor
    #[arg(long, value_name = "cpu|gpu|auto|NAME", default_value = "cpu")]
    pub device: DeviceChoice,
    /// List the cases, and run none
    #[arg(long)]
    pub list: bool,
}

impl CaseArgs {
    /// Folder of the plots; `None` when none are drawn.
    pub fn plots(&self, command: &str) -> Option<PathBuf> {
        let folder = || self.out.clone().unwrap_or_else(|| Path::new("out").join(command));
        (!self.no_plots).then(folder)
    }

    /// Calls `work` with the runner of the cases, which shows how far it is, and with the place of finished cases.
    ///
    /// # Errors
    /// What `work` answers; [`Error::Io`].
    pub fn run<T>(
        &self,
        command: &str,
        work: impl FnOnce(&CaseRunner, Option<&Unfinished>) -> Result<Vec<Status<T>>>,
    ) -> Result<Ran<T>> {
        let open = |folder: PathBuf| Unfinished::open(&folder, command, self.fresh);
        let unfinished = self.plots(command).map(open).transpose()?;
        let stop = match &unfinished {
            Some(_) => interrupt::install_for_cases()?,
            None => interrupt::install()?,
        };
        let line = ProgressLine::new(command);
        let jobs = self.threads.map_or_else(cores, usize::from);
        let runner = CaseRunner { jobs, threads: Some(1), budget: None, stop, tell: &|progress| line.show(progress) };
        let statuses = work(&runner, unfinished.as_ref())?;
        drop(line);
        let of = statuses.len();
        let kept = statuses.iter().filter(|status| matches!(status, Status::Kept(_))).count();
        if kept > 0 {
            eprintln!("note: {kept} of {of} cases were finished before, by a command that was ended; --fresh runs all");
        }
        unfinished.iter().for_each(|unfinished| tell_damaged(unfinished.store(), RUN_AGAIN));
        let outputs: Vec<T> = statuses.into_iter().filter_map(Status::into_output).collect();
        let interrupted = outputs.len() < of;
        if interrupted {
            say!("interrupted: {} of {of} cases were run", outputs.len());
        }
        Ok(Ran { outputs, interrupted, unfinished })
    }

    /// Whether results can be written is found out before minutes are spent on them.
    ///
    /// # Errors
    /// A folder that cannot be made, or a file that is one.
    pub fn prepare(&self, command: &str) -> Result<()> {
        self.plots(command).map_or(Ok(()), |folder| regular::make_folder(&folder))?;
        match &self.json {
            Some(file) => {
                regular::replaceable(file)?;
                file.parent().map_or(Ok(()), regular::make_folder)
            }
            None => Ok(()),
        }
    }
}

/// What became of the cases of a command.
pub struct Ran<T> {
    /// Results of those that are over.
    pub outputs: Vec<T>,
    interrupted: bool,
    unfinished: Option<Unfinished>,
}

impl<T> Ran<T> {
    /// Everything is told and written: cases are kept no longer, unless some are missing.
    ///
    /// # Errors
    /// [`Error::Interrupted`] when the user ended it early; [`Error::Io`].
    pub fn complete(self) -> Result<()> {
        match self.interrupted {
            true => Err(Error::Interrupted),
            false => self.unfinished.map_or(Ok(()), Unfinished::complete),
        }
    }
}

/// Keeps other studies out of a folder, which is made if it is not there; `part`: others may run parts of the same study.
///
/// # Errors
/// [`Error::Input`] with the number of the process that has it; [`Error::Io`].
pub fn lock(folder: &Path, part: bool) -> Result<Lock> {
    regular::make_folder(folder)?;
    if part { Lock::share(folder) } else { Lock::take(folder) }
}

/// Says which records of finished cases cannot be used, and what becomes of their cases.
pub fn tell_damaged(store: &CaseStore, fate: &str) {
    for (file, why) in store.damaged() {
        eprintln!("note: {} is damaged ({why}); {fate}", file.display());
    }
}

/// What becomes of a case whose record is damaged, where cases are run.
pub const RUN_AGAIN: &str = "its case is computed again";

/// Parts of a progress line that shows a share of the work.
const PARTS: u64 = 1000;

/// How far a command is that runs many cases, on standard error.
pub struct ProgressLine(pub ProgressBar);

impl ProgressLine {
    /// The line of a command; nothing is shown yet.
    pub fn new(command: &str) -> Self {
        let bar = ProgressBar::with_draw_target(Some(PARTS), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template(&format!("{command} [{{bar:24}}] {{wide_msg}}"));
        Self(bar.with_style(style.expect("the template is constant and right")))
    }

    /// Shows how far the cases are.
    pub fn show(&self, progress: &Progress) {
        let left = progress.left.map_or(String::new(), |left| format!(", about {} left", time(left)));
        self.0.set_position((progress.share * PARTS as f64) as u64);
        self.0.set_message(format!("{} of {} cases{left}: {}", progress.finished, progress.of, progress.name));
    }
}

impl Drop for ProgressLine {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// A time as people read it.
pub fn time(seconds: f64) -> String {
    if seconds < 120.0 { format!("{seconds:.0} s") } else { format!("{:.0} min", seconds / 60.0) }
}

/// What the user typed after the name of the program, but for an option and its value.
pub fn words_without(option: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut typed = called::words();
    while let Some(word) = typed.next() {
        if word == option {
            typed.next();
        } else if word.strip_prefix(option).is_none_or(|rest| !rest.starts_with('=')) {
            words.push(word);
        }
    }
    words
}

/// What the user typed.
pub fn command() -> String {
    let words = called::words().map(|word| quoted(&word));
    std::iter::once("strandsnap".to_string()).chain(words).collect::<Vec<_>>().join(" ")
}
