//! `strandsnap export`.

use super::ended::Ended;
use super::say::say;
use super::select::SelectArgs;
use crate::base::error::Result;
use crate::base::wording::counted;
use crate::export::{ExportOptions, Format, export as export_run};
use crate::run::outputs::megabytes;
use clap::ValueEnum;
use clap::builder::PossibleValue;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run, such as out/ka4; one that was stopped will do
    run: PathBuf,
    /// What kind of files
    #[arg(long, value_enum)]
    format: Format,
    /// Folder of the files [default: RUN/FORMAT]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace what an earlier export wrote into that folder
    #[arg(long)]
    overwrite: bool,
    /// Go on where files of the run were changed or are another's; the result says so
    #[arg(long)]
    anyway: bool,
    #[command(flatten)]
    select: SelectArgs,
}

impl ValueEnum for Format {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.word()).help(self.about()))
    }
}

pub fn export(args: Args) -> Result<Ended> {
    let Args { run, format, out, overwrite, anyway, select } = args;
    let options = ExportOptions { format, selection: select.into(), out, overwrite, anyway };
    let stop = super::interrupt::install_saying("\nstopping; nothing is exported")?;
    let exported = export_run(&run, &options, stop)?;
    if let Some(why) = &exported.cut_off {
        eprintln!("note: {why}; what there is was exported");
    }
    say!(
        "{} ({}) of {} in {}; open {} first",
        counted(exported.files, "file"),
        megabytes(exported.bytes),
        counted(exported.snapshots, "snapshot"),
        exported.folder.display(),
        format.first_file()
    );
    Ok(Ended::Well)
}
