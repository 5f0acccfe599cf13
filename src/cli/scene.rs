//! `strandsnap scene list|show|check|keys|new|centrelines`.

use super::say::{self, say};
use super::values::SceneArgs;
use super::{centrelines, keys};
use crate::base::error::{Error, Result};
use crate::base::wording::counted;
use crate::run::{self, cautions};
use crate::scene::spec::Spec;
use crate::scene::{self, builtin};
use crate::strand;
use crate::strand::theory::Theory;
use std::ffi::OsStr;
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
    /// Write the wires' centre lines of a scene to a text file, which a scene can read back
    Centrelines(centrelines::Args),
    /// Start a scene of one's own from a built-in one, comments included
    New {
        /// The file to write, such as my-strand or my-strand.toml; never replaces one
        name: PathBuf,
        /// The built-in scene to start from; a file of one's own is copied as any file
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
        Command::Centrelines(args) => centrelines::write(args),
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
    let text = builtin::find(from).map_err(|error| match Path::new(from).is_file() {
        true => {
            Error::input(format!("--from takes a built-in scene, and {from} is a file"), "copy it under another name")
        }
        false => error,
    })?;
    let file =
        if name.extension().is_some_and(|e| e == "toml") { name.into() } else { name.with_added_extension("toml") };
    let stem = file.file_stem().and_then(OsStr::to_str).unwrap_or_default();
    if !scene::can_name_a_folder(stem) {
        let what = format!("{:?} is no name for a scene", name.display().to_string());
        return Err(Error::input(what, "use letters, digits, - and _; results go to a folder of that name"));
    }
    // Another process may make the file between a look and the writing.
    let mut new = File::create_new(&file).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Error::input(format!("{} exists", file.display()), "choose another name"),
        _ => Error::io("cannot write", &file, error),
    })?;
    new.write_all(text.as_bytes()).map_err(|error| Error::io("cannot write", &file, error))?;
    say!("{} is a copy of {from}; `strandsnap scene keys` lists what can be changed", file.display());
    say!("check it: strandsnap scene check {}", for_shell(&file));
    Ok(())
}

/// A path as it can be pasted into a shell.
pub(super) fn for_shell(path: &Path) -> String {
    let path = path.display().to_string();
    let plain = |c: char| c.is_alphanumeric() || "-_./\\:+".contains(c);
    if path.chars().all(plain) { path } else { format!("'{}'", path.replace('\'', r"'\''")) }
}

fn check(args: &SceneArgs) -> Result<()> {
    let scene = args.load()?;
    let assembly = run::assemble(&scene)?;
    say!(
        "{} is fine: {}, {}, {}",
        args.scene,
        counted(assembly.wires.len(), "wire"),
        counted(assembly.len(), "particle"),
        counted(assembly.bond_count(), "bond")
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
