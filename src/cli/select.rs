//! The options that choose among the snapshots of a finished run, for `render`, `record` and `export` alike.

use super::values::strain_range;
use crate::run::replay::Selection;

/// Which snapshots.
#[derive(Debug, clap::Args)]
pub struct SelectArgs {
    /// Only snapshots in this range of strain, in per cent, such as 20..26
    #[arg(long, visible_alias = "strain", value_name = "A..B", value_parser = strain_range)]
    strain_range: Option<[f64; 2]>,
    /// Only the last state before and the first one after each rupture, the first and the last
    #[arg(long)]
    events: bool,
    /// Only every Nth of the snapshots
    #[arg(long, visible_alias = "stride", value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
}

impl From<SelectArgs> for Selection {
    fn from(args: SelectArgs) -> Self {
        let strain = args.strain_range.unwrap_or(Selection::default().strain);
        Self { strain, events: args.events, every: args.every as usize }
    }
}
