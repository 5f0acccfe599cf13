//! What `verify` and `stability` share: they run a table of cases.

use crate::base::error::{Error, Result};
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
    /// Folder of the plots [default: out/ and the command's name]
    #[arg(long, value_name = "DIR", conflicts_with = "no_plots")]
    out: Option<PathBuf>,
    /// Draw no plots
    #[arg(long)]
    no_plots: bool,
    /// Cases that run side by side, each on one thread [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
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

    /// Cases that run side by side.
    pub fn threads(&self) -> usize {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        self.threads.map_or_else(cores, usize::from)
    }

    /// Whether results can be written is found out before minutes are spent on them.
    ///
    /// # Errors
    /// A folder that cannot be made, or a file that is one.
    pub fn prepare(&self, command: &str) -> Result<()> {
        let make =
            |folder: &Path| std::fs::create_dir_all(folder).map_err(|e| Error::io("cannot make the folder", folder, e));
        self.plots(command).map_or(Ok(()), |folder| make(&folder))?;
        match &self.json {
            Some(file) if file.is_dir() => {
                Err(Error::input(format!("--json {} is a folder", file.display()), "give the name of a file"))
            }
            Some(file) => file.parent().map_or(Ok(()), make),
            None => Ok(()),
        }
    }
}

/// Cases done of all.
pub fn bar(command: &str, cases: usize) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(cases as u64), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template(&format!("{command} [{{bar:24}}] {{pos}} of {{len}} cases  {{msg}}"));
    bar.with_style(style.expect("the template is constant and right"))
}
