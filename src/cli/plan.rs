//! `strandsnap plan`.

use super::say::say;
use super::scene::expected;
use super::values::SceneArgs;
use crate::base::error::Result;
use crate::run::estimate::Estimate;
use crate::run::{self, cautions};
use crate::strand;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// Threads to measure with [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

pub fn plan(args: &Args) -> Result<()> {
    let (scene, changed) = args.scene.load_and_tell()?;
    let assembly = run::assemble(&scene)?;
    say!("{}: {}\n", scene.spec.name, scene.spec.about);
    let preset = if changed.is_empty() { "the scene as it is written".into() } else { changed.join(", ") };
    say!("quality: {} ({preset})\n", args.scene.quality.word());
    say!("{}", scene.plan);
    if let Some(expected) = expected(&scene.spec) {
        say!("{expected}\n");
    }
    cautions::of_scene(&scene, &assembly)?.iter().for_each(|caution| say!("WARNING: {caution}\n"));
    strand::caution::deviation(&scene.spec).iter().for_each(|line| say!("{line}\n"));
    let threads = args.threads.map(usize::from);
    let estimate = run::in_pool(threads, || -> Result<Estimate> {
        let estimate = run::estimate::estimate(&scene.spec, &scene.plan, assembly.clone())?;
        Ok(Estimate { loaded_wall: run::estimate::under_load(&scene.spec, assembly), ..estimate })
    })??;
    say!("{estimate}");
    Ok(())
}
