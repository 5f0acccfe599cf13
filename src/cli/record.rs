//! `strandsnap record`.

use super::ended::Ended;
use super::run::DEFAULT_VIEWER;
use super::select::SelectArgs;
use crate::base::error::Result;
use crate::scene::spec::ColourBy;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a finished run, such as out/ka4
    run: PathBuf,
    /// What colours the wires [default: as the scene says]
    #[arg(long, value_enum)]
    colour: Option<ColourBy>,
    /// The file to write [default: RUN/recording.rrd]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    overwrite: bool,
    /// Go on where files of the run were changed or are another's; the result says so
    #[arg(long)]
    anyway: bool,
    #[command(flatten)]
    select: SelectArgs,
    /// Stream to a Rerun viewer that is already open
    #[arg(long, value_name = "URL", num_args = 0..=1, default_missing_value = DEFAULT_VIEWER)]
    live: Option<String>,
}

#[cfg(not(feature = "record"))]
pub fn record(_args: Args) -> Result<Ended> {
    Err(crate::run::outputs::built_without("recordings", "record", "record on a machine where it is"))
}

#[cfg(feature = "record")]
pub fn record(args: Args) -> Result<Ended> {
    use super::say::say;
    use crate::run::record::{RecordOptions, record};

    let options = RecordOptions {
        selection: args.select.into(),
        colour: args.colour,
        out: args.out,
        overwrite: args.overwrite,
        anyway: args.anyway,
        live: args.live,
    };
    let stop = super::interrupt::install()?;
    let file = record(&args.run, &options, stop)?;
    say!("recorded to {}", file.display());
    interrupt::ended(stop)
}
