//! `strandsnap view`.

use super::ended::Ended;
use crate::base::error::Result;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run, such as out/ka4
    run: PathBuf,
    /// Go on where files of the run were changed or are another's; a warning says so
    #[arg(long)]
    anyway: bool,
    /// Serve it to a browser instead of opening a window
    #[arg(long)]
    web: bool,
}

#[cfg(not(feature = "record"))]
pub fn view(_args: Args) -> Result<Ended> {
    Err(crate::run::outputs::built_without("recordings", "record", "open the recording with `rerun`"))
}

#[cfg(feature = "record")]
pub fn view(args: Args) -> Result<Ended> {
    use super::say::say;
    use crate::run::identity;
    use crate::run::view::{Viewer, find};

    let doubts = identity::check(&args.run, args.anyway)?;
    let found = find(&args.run)?;
    let viewer = Viewer::installed()?;
    if let Some(mismatch) = viewer.mismatch() {
        eprintln!("WARNING: {mismatch}");
    }
    if !doubts.is_empty() {
        eprintln!("WARNING: {}", identity::list(&doubts));
    }
    if found.unfinished {
        eprintln!("WARNING: the run was cut off or is still going: its recording ends early");
    }
    let stop = super::interrupt::install_saying("\nclosing the viewer")?;
    let showing = if args.web { viewer.serve(&found.file)? } else { viewer.open(&found.file)? };
    match &showing.address {
        Some(address) => say!("Open {address} in a browser; Ctrl-C ends it."),
        None => say!("Opening {} in Rerun {}; Ctrl-C closes it.", found.file.display(), viewer.version),
    }
    // To end it by Ctrl-C is the way it is meant to be ended.
    showing.wait(stop).map(|()| Ended::Well)
}
