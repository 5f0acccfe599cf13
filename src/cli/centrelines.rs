//! `strandsnap scene centrelines`.

use super::say::say;
use super::values::SceneArgs;
use crate::base::error::Result;
use crate::base::regular::check_target;
use crate::base::wording::counted;
use crate::observe::files::write_whole;
use crate::run;
use crate::strand::centrelines;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// The text file to write
    file: PathBuf,
    /// Replace the file if it exists
    #[arg(long)]
    overwrite: bool,
}

pub fn write(args: &Args) -> Result<()> {
    let scene = args.scene.load()?;
    let assembly = run::assemble(&scene)?;
    check_target(&args.file, args.overwrite, "")?;
    write_whole(&args.file, &centrelines::export(&assembly))?;
    say!("{} written to {}", counted(assembly.wires.len(), "wire"), args.file.display());
    Ok(())
}
