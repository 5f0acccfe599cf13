//! The scenes that come with the program.

use super::suggest::nearest;
use crate::base::error::{Error, Result};
use std::path::Path;

macro_rules! scenes {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../assets/scenes/", $name, ".toml")))),*]
    };
}

/// Name and text of each, the main one first.
const SCENES: &[(&str, &str)] =
    scenes!["ka4", "jaw-grip", "strand-1x7", "single-wire", "cantilever", "torsion", "two-spheres"];

/// All built-in scenes: name and TOML text.
pub fn list() -> &'static [(&'static str, &'static str)] {
    SCENES
}

/// The TOML text of a built-in scene. Errors: an unknown name; the nearest is suggested.
pub fn find(name: &str) -> Result<&'static str> {
    match SCENES.iter().find(|(known, _)| *known == name) {
        Some((_, text)) => Ok(text),
        None => Err(Error::input(format!("there is no built-in scene `{name}`"), suggestion(name))),
    }
}

/// What a built-in scene shows: its key `about`. Errors: an unknown name.
pub fn about(name: &str) -> Result<String> {
    Ok(super::parse(find(name)?, name, Path::new("."), &[])?.spec.about)
}

/// The error for a scene file that is not there.
pub(super) fn no_such_file(path: &Path) -> Error {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    Error::input(format!("there is no scene file {}", path.display()), suggestion(&stem))
}

fn suggestion(name: &str) -> String {
    let names: Vec<&str> = SCENES.iter().map(|(name, _)| *name).collect();
    let all = format!("built-in scenes: {}; a file is given by its path", names.join(", "));
    match nearest(name, names) {
        Some(near) => format!("did you mean `{near}`? {all}"),
        None => all,
    }
}
