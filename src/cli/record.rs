//! `strandsnap record`.

use super::Ended;
use super::run::DEFAULT_VIEWER;
use super::values::{Colour, strain_range};
use crate::base::error::Result;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a finished run, such as out/ka4
    run: PathBuf,
    /// What colours the wires [default: as the scene says]
    #[arg(long, value_enum)]
    colour: Option<Colour>,
    /// The file to write [default: RUN/recording.rrd]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    overwrite: bool,
    /// Record every Nth snapshot only
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// Record snapshots in this range of strain only, in per cent, such as 20..26
    #[arg(long, value_name = "A..B", value_parser = strain_range)]
    strain_range: Option<[f64; 2]>,
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
    use crate::run::replay::Selection;
    use std::sync::atomic::Ordering;

    let strain = args.strain_range.unwrap_or(Selection::default().strain);
    let options = RecordOptions {
        selection: Selection { every: args.every as usize, strain },
        colour: args.colour.map(Into::into),
        out: args.out,
        overwrite: args.overwrite,
        live: args.live,
    };
    let stop = super::interrupt::install()?;
    let file = record(&args.run, &options, stop)?;
    say!("recorded to {}", file.display());
    Ok(if stop.load(Ordering::Relaxed) { Ended::Interrupted } else { Ended::Well })
}
