//! `strandsnap import`.

use super::say::say;
use super::values::length;
use crate::base::error::{Error, Result};
use crate::base::regular::check_target;
use crate::import::{self, Clearance, ImportOptions, scene_text, wording};
use crate::observe::files::write_whole;
use crate::scene::{self, centreline_text};
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A model: STEP (.step, .stp), ASCII DXF, or points as text (.csv, .txt), `x y z` per line
    file: PathBuf,
    /// The scene to write [default: named as the file, in the current folder]; its points go beside it
    #[arg(long, value_name = "SCENE")]
    out: Option<PathBuf>,
    /// Diameter of wires for which the model gives none, such as "0.39 mm"
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    diameter: Option<f64>,
    /// What the model counts in, such as mm, inch or "25.4 mm" [default: what it says; text counts in mm]
    #[arg(long, value_name = "UNIT", value_parser = unit)]
    unit: Option<f64>,
    /// Greatest distance of a wire from the polygon of its points [default: a thousandth of the diameter]
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    chord: Option<f64>,
    /// Join ends that are so far apart [default: a hundredth of the diameter, where the model gives it]
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    join: Option<f64>,
    /// Leave the wires where they are drawn, instead of bringing the axis of a strand to z
    #[arg(long)]
    as_drawn: bool,
    /// Replace the scene and its points if they exist
    #[arg(long)]
    overwrite: bool,
}

/// Reads a unit: its name, or a length.
fn unit(text: &str) -> std::result::Result<f64, String> {
    match text {
        "inch" | "inches" | "\"" => length("1 in"),
        _ if text.starts_with(|c: char| c.is_ascii_digit()) => length(text),
        _ => length(&format!("1 {text}")),
    }
}

/// Whether two paths lead to one file that is there.
fn is_same_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

pub fn import(args: &Args) -> Result<()> {
    if let Some(folder) = args.out.as_ref().filter(|out| out.is_dir()) {
        let what = format!("--out {} is a folder", folder.display());
        return Err(Error::input(
            what,
            format!("give the file of the scene, such as {}", folder.join("strand.toml").display()),
        ));
    }
    let scene = match &args.out {
        Some(out) if out.extension().is_some_and(|extension| extension == "toml") => out.clone(),
        Some(out) => out.with_added_extension("toml"),
        None => Path::new(args.file.file_name().unwrap_or_default()).with_extension("toml"),
    };
    let stem = scene.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    if !scene::can_name_a_folder(stem) {
        let what = format!("{stem:?} is no name for a scene");
        return Err(Error::input(
            what,
            "give --out with letters, digits, - and _; results go to a folder of that name",
        ));
    }
    let points = scene.with_extension("points.txt");
    for target in [&scene, &points] {
        if is_same_file(target, &args.file) {
            let what = format!("{} is the model itself", target.display());
            return Err(Error::input(what, "give another name with --out"));
        }
        check_target(target, args.overwrite, "--out")?;
    }
    let options = ImportOptions {
        unit: args.unit,
        diameter: args.diameter,
        chord: args.chord,
        reach: args.join,
        as_drawn: args.as_drawn,
    };
    let found = import::import(&args.file, &options)?;
    wording::report(&found, &args.file).iter().for_each(|line| say!("{line}"));
    wording::unread(&found.unread).iter().for_each(|line| eprintln!("NOT USED: {line}"));
    wording::forks(&found).iter().for_each(|line| eprintln!("NOT JOINED: {line}"));
    if let Clearance::NoDiameter(least) = found.clearance {
        let hint = least.map_or_else(
            || "give --diameter, such as --diameter \"0.39 mm\"".to_owned(),
            |least| {
                // Downwards, so that they do not overlap.
                let most = wording::millimetres((least * 1e7).floor() * 1e-7);
                format!("give --diameter; wires that just touch would have \"{most} mm\"")
            },
        );
        return Err(Error::input(format!("{} gives no diameter of its wires", args.file.display()), hint));
    }
    // The points first: a scene that is there can be run.
    let name = points.file_name().unwrap_or_default().to_string_lossy();
    write_whole(&points, &centreline_text::write(&found.centrelines()))?;
    write_whole(&scene, &scene_text::scene(&found, &args.file, &name))?;
    say!("{} written, with its points in {}", scene.display(), points.display());
    say!("check it: strandsnap scene check {}", super::scene::for_shell(&scene));
    Ok(())
}
