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
const SCENES: &[(&str, &str)] = scenes![
    "ka4",
    "jaw-grip",
    "strand-1x7",
    "strand-1x19",
    "hard-drawn-7",
    "acsr",
    "single-wire",
    "cantilever",
    "torsion",
    "two-spheres",
    "bounce",
    "bend3"
];

/// Name and text of the scenes that `strandsnap verify` runs, in alphabetical order.
const VERIFICATION: &[(&str, &str)] = scenes![
    "verify/axial-wave",
    "verify/bond-bent",
    "verify/bond-twisted",
    "verify/buckling",
    "verify/capstan",
    "verify/capstan-on-drum",
    "verify/chain",
    "verify/crossed-wires",
    "verify/crossing-wires",
    "verify/elastica",
    "verify/frame",
    "verify/free-strand",
    "verify/free-vibration",
    "verify/free-wire",
    "verify/hertz",
    "verify/known-strand",
    "verify/oblique",
    "verify/parallel-wires",
    "verify/pull",
    "verify/pulled-bar",
    "verify/repeated",
    "verify/rolling",
    "verify/rolling-on-plane",
    "verify/section",
    "verify/shared-load",
    "verify/snapped-wire",
    "verify/sphere-on-plane",
    "verify/sphere-on-wire",
    "verify/spring",
    "verify/strand-elastic",
    "verify/tangential",
    "verify/thornton",
    "verify/three-point-bending",
    "verify/tip-load",
    "verify/torque",
    "verify/unlike-spheres",
    "verify/unlike-wires",
];

/// Scenes of `strandsnap verify`: name, which starts with `verify/`, and TOML text.
pub fn verification() -> &'static [(&'static str, &'static str)] {
    VERIFICATION
}

/// Whether a name is meant for one of [`verification`].
pub(super) fn is_verification(name: &str) -> bool {
    name.starts_with("verify/")
}

/// All built-in scenes that show something to users: name and TOML text.
pub fn list() -> &'static [(&'static str, &'static str)] {
    SCENES
}

/// The TOML text of a built-in scene. Errors: an unknown name; the nearest is suggested.
pub fn find(name: &str) -> Result<&'static str> {
    match SCENES.iter().chain(VERIFICATION).find(|(known, _)| *known == name) {
        Some((_, text)) => Ok(text),
        None => {
            let file = format!("{name}.toml");
            let help = match Path::new(&file).is_file() {
                true => format!("did you mean the file {file}?"),
                false => suggestion(name),
            };
            Err(Error::input(format!("there is no built-in scene `{name}`"), help))
        }
    }
}

/// The error for a scene file that is not there.
pub(super) fn no_such_file(path: &Path) -> Error {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    Error::input(format!("there is no scene file {}", path.display()), suggestion(&stem))
}

fn suggestion(name: &str) -> String {
    let names: Vec<&str> = SCENES.iter().map(|(name, _)| *name).collect();
    let all = format!("built-in scenes: {}; a file is given by its path", names.join(", "));
    let verification = VERIFICATION.iter().map(|(name, _)| *name);
    match nearest(name, names.iter().copied().chain(verification)) {
        Some(near) => format!("did you mean `{near}`? {all}"),
        None => all,
    }
}
