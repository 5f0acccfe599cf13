//! `strandsnap check-run`.

use super::ended::Ended;
use super::say::{self, say};
use crate::base::error::{Error, Result};
use crate::observe::files::write_whole;
use crate::study::check_run::{self, InvariantCheck, report};
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run that has ended, such as out/ka4
    run: PathBuf,
    /// Write what was found as a list of objects
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

pub fn check_run(args: &Args) -> Result<Ended> {
    if let Some(file) = args.json.as_ref().filter(|file| file.is_dir()) {
        return Err(Error::input(format!("--json {} is a folder", file.display()), "give the name of a file"));
    }
    let findings = check_run::check(&args.run)?;
    say::print(format_args!("{}", report::text(&findings)));
    let failed: Vec<&str> = findings.iter().filter(|f| f.failed()).map(|f| f.invariant.name).collect();
    let applied =
        findings.iter().filter(|f| !matches!(f.outcome, check_run::InvariantOutcome::NotApplicable(_))).count();
    let tail = if failed.is_empty() { String::new() } else { format!("; not: {}", failed.join(", ")) };
    say!("{} of {applied} invariants hold, {} do not apply{tail}", applied - failed.len(), findings.len() - applied);
    if let Some(path) = &args.json {
        write_whole(path, &report::json(&findings))?;
        say!("findings: {}", path.display());
    }
    Ok(if findings.iter().any(InvariantCheck::failed) { Ended::Missed } else { Ended::Well })
}
