//! `strandsnap scene list|show|check|keys|new`.

use super::keys;
use super::say::{self, say};
use super::values::SceneArgs;
use crate::base::error::{Error, Result};
use crate::run::{self, cautions};
use crate::scene::builtin;
use crate::scene::spec::Spec;
use crate::strand;
use crate::strand::theory::Theory;
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

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
    /// List the keys of a scene, each with what may be written, its unit, default and meaning
    Keys(keys::Args),
    /// Start a scene of one's own from a built-in one, comments included
    New {
        /// The file to write, such as my-strand or my-strand.toml; never replaces one
        name: PathBuf,
        /// The built-in scene to start from
        #[arg(long, default_value = "ka4")]
        from: String,
    },
}

pub fn scene(command: &Command) -> Result<()> {
    match command {
        Command::List => list(),
        Command::Show { name } => show(name),
        Command::Check(args) => check(args),
        Command::Keys(args) => keys::print(args),
        Command::New { name, from } => new(name, from),
    }
}

fn list() -> Result<()> {
    let width = builtin::list().iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, _) in builtin::list() {
        let about = crate::scene::load(name, &[])?.spec.about;
        say!("{name:width$}  {}", about.lines().collect::<Vec<_>>().join(" "));
    }
    Ok(())
}

fn show(name: &str) -> Result<()> {
    say::print(format_args!("{}", builtin::find(name)?));
    Ok(())
}

fn new(name: &Path, from: &str) -> Result<()> {
    let text = builtin::find(from)?;
    let file =
        if name.extension().is_some_and(|e| e == "toml") { name.into() } else { name.with_added_extension("toml") };
    // Another process may make the file between a look and the writing.
    let mut new = File::create_new(&file).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Error::input(format!("{} exists", file.display()), "choose another name"),
        _ => Error::io("cannot write", &file, error),
    })?;
    new.write_all(text.as_bytes()).map_err(|error| Error::io("cannot write", &file, error))?;
    say!("{} is a copy of {from}; `strandsnap scene keys` lists what can be changed", file.display());
    say!("check it: strandsnap scene check {}", file.display());
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
