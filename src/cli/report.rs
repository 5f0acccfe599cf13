//! `strandsnap report`.

use super::say::say;
use crate::base::error::Result;
use crate::page;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run, such as out/ka4; also of one that was interrupted
    run: PathBuf,
    /// The page [default: RUN/report.html]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Folder of a study of error against run time to show [default: out/accuracy/NAME, if there is one]
    #[arg(long, value_name = "DIR")]
    accuracy: Option<PathBuf>,
    /// Go on where files of the run were changed or are another's; the result says so
    #[arg(long)]
    anyway: bool,
    /// Replace the file if it exists
    #[arg(long)]
    overwrite: bool,
}

pub fn report(args: &Args) -> Result<()> {
    let out = args.out.as_deref();
    let written = page::write(&args.run, out, args.accuracy.as_deref(), args.overwrite, args.anyway)?;
    for note in &written.notes {
        eprintln!("WARNING: {note}");
    }
    let [shown, of] = written.frames;
    say!(
        "{} ({:.1} MB, {shown} of {of} frames): open it in any browser",
        written.path.display(),
        written.bytes as f64 / 1e6
    );
    Ok(())
}
