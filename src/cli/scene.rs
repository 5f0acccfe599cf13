//! `strandsnap scene list|show|check`.

use super::say::{self, say};
use super::values::SceneArgs;
use crate::base::error::Result;
use crate::run::{self, cautions};
use crate::scene::builtin;
use crate::scene::spec::Spec;
use crate::strand;
use crate::strand::theory::Theory;

#[derive(Debug, clap::Subcommand)]
pub enum Command {
    /// List the built-in scenes
    List,
    /// Print a built-in scene, to start one's own from
    Show {
        /// Its name
        name: String,
    },
    /// Check a scene and its geometry without running it
    Check(SceneArgs),
}

pub fn scene(command: &Command) -> Result<()> {
    match command {
        Command::List => list(),
        Command::Show { name } => show(name),
        Command::Check(args) => check(args),
    }
}

fn list() -> Result<()> {
    let width = builtin::list().iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, _) in builtin::list() {
        let about = builtin::about(name)?;
        say!("{name:width$}  {}", about.lines().collect::<Vec<_>>().join(" "));
    }
    Ok(())
}

fn show(name: &str) -> Result<()> {
    say::print(format_args!("{}", builtin::find(name)?));
    Ok(())
}

fn check(args: &SceneArgs) -> Result<()> {
    let scene = args.load()?;
    let assembly = run::assemble(&scene)?;
    say!(
        "{} is fine: {} wires, {} particles, {} bonds",
        args.scene,
        assembly.wires.len(),
        assembly.len(),
        assembly.bond_count()
    );
    if let Some(expected) = expected(&scene.spec) {
        say!("{expected}");
    }
    strand::caution::deviation(&scene.spec).iter().for_each(|line| say!("{line}"));
    cautions::of_scene(&scene, &assembly)?.iter().for_each(|caution| say!("WARNING: {caution}"));
    Ok(())
}

/// What strand theory expects of a scene, in a line; `None` where it has nothing to say.
pub(super) fn expected(spec: &Spec) -> Option<String> {
    let theory = Theory::of_pull(spec)?;
    let loose = match theory.closing_strain {
        0.0 => String::new(),
        strain => format!("; loose layers close in at {:.3} % of strain", strain * 1e2),
    };
    Some(format!(
        "strand theory, ends held, elastic: {:.1} GPa, torque {:.4} N m per % of strain{loose}",
        theory.modulus() * 1e-9,
        theory.wrench.torque * 1e-2
    ))
}
