//! `strandsnap plan`.

use super::say::say;
use super::values::SceneArgs;
use crate::base::error::Result;
use crate::run;
use crate::scene::{self, caution, plan::Plan};

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// Threads to measure with [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

pub fn plan(args: &Args) -> Result<()> {
    let scene = scene::load(&args.scene.scene, &args.scene.overrides())?;
    say!("{}: {}\n", scene.spec.name, scene.spec.about);
    say!("{}", Plan::new(&scene.spec));
    caution::cautions(&scene.spec).iter().for_each(|caution| say!("WARNING: {caution}\n"));
    let assembly = run::assemble(&scene)?;
    let threads = args.threads.map(usize::from);
    let estimate = run::in_pool(threads, || run::estimate::estimate(&scene.spec, assembly))??;
    say!("{estimate}");
    Ok(())
}
