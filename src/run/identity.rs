//! Whether the files of a run's folder are of one run, and as it wrote them.
//!
//! The trajectory carries the run's [`Origin`] from its first byte; `summary.json` ends with a [`Seal`], which names the
//! run again, and the digests of the files that only the run writes.

use super::folder::{SCENE, SUMMARY, TRAJECTORY};
use crate::base::digest::Digest;
use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::observe::bodies::BODIES;
use crate::observe::origin::Origin;
use crate::observe::trajectory::Trajectory;
use crate::observe::{details, partial, tables};
use crate::scene;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

/// The last key of `summary.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Seal {
    /// Which run it is.
    #[serde(flatten)]
    pub origin: Origin,
    /// Digests of the files that only the run writes, by name.
    pub files: BTreeMap<String, Digest>,
    /// Digest of the summary without its seal.
    pub summary: Digest,
}

/// What stands before the seal.
const SEAL: &str = ",\n  \"seal\": ";

/// Why a file is not believed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Doubt {
    /// It is not as the run wrote it.
    Changed(&'static str),
    /// It is of another run, or was changed since.
    Foreign(&'static str),
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Changed(file) => write!(f, "{file} was changed since the run wrote it"),
            Self::Foreign(file) => write!(f, "{file} is not of the run of {TRAJECTORY}, or was changed since"),
        }
    }
}

/// A summary's JSON object with its seal, for the run in the folder `run`, whose other files are whole, `more` of them in the
/// seal than those that every run writes.
///
/// # Errors
/// [`Error::Io`] when a file cannot be read.
pub fn seal(summary: &str, origin: Origin, run: &Path, more: &[&str]) -> Result<String> {
    let names =
        tables::FILES.into_iter().chain(details::FILES).chain([BODIES, SCENE, TRAJECTORY]).chain(more.iter().copied());
    let files =
        names.filter(|name| run.join(name).exists()).map(|name| Ok((name.to_owned(), digest(&run.join(name))?)));
    let seal = Seal { origin, files: files.collect::<Result<_>>()?, summary: Digest::of(summary) };
    let open = summary.trim_end().trim_end_matches('}').trim_end();
    Ok(format!("{open}{SEAL}{}\n}}\n", serde_json::to_string(&seal).expect("a seal holds nothing that JSON lacks")))
}

/// The digest of a file, or of all numbered pictures in a folder, in their order.
///
/// # Errors
/// [`Error::Io`] when one cannot be read.
pub fn digest(path: &Path) -> Result<Digest> {
    if !path.is_dir() {
        return Digest::of_file(path);
    }
    let pictures = pictures(path)?;
    let digests: Result<Vec<String>> = pictures.values().map(|file| Ok(Digest::of_file(file)?.to_string())).collect();
    Ok(Digest::of(digests?.join("\n")))
}

/// `frame_0012.png` and the like in a folder, by number; none where there is no folder.
///
/// # Errors
/// [`Error::Io`] when it cannot be read.
pub fn pictures(folder: &Path) -> Result<BTreeMap<usize, PathBuf>> {
    let entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(BTreeMap::new()),
        Err(e) => return Err(Error::io("cannot read the folder", folder, e)),
    };
    let number = |path: &Path| -> Option<usize> {
        path.file_name()?.to_str()?.strip_prefix("frame_")?.strip_suffix(".png")?.parse().ok()
    };
    Ok(entries.flatten().filter_map(|entry| Some((number(&entry.path())?, entry.path()))).collect())
}

/// The seal of a summary, if it has one and is as it was sealed.
pub fn unsealed(text: &str) -> Option<Seal> {
    let at = text.rfind(SEAL)?;
    let seal: Seal = serde_json::from_str(text[at + SEAL.len()..].trim_end().strip_suffix('}')?).ok()?;
    (seal.summary == Digest::of(format!("{}\n}}", &text[..at]))).then_some(seal)
}

/// What is doubtful about the files of the run in the folder `run`; those that are not there are not.
///
/// # Errors
/// What reading them says.
pub fn doubts(run: &Path) -> Result<Vec<Doubt>> {
    let Some((trajectory, text)) = [run.join(TRAJECTORY), partial::name(&run.join(TRAJECTORY))]
        .into_iter()
        .find(|file| file.is_file())
        .map(|file| Trajectory::open(&file).map(|opened| opened.origin()))
        .transpose()?
        .map(|origin| Ok::<_, Error>((origin, regular::text_if_there(&run.join(SUMMARY), regular::LONGEST_TABLE)?)))
        .transpose()?
    else {
        return Ok(Vec::new());
    };
    let mut doubts = Vec::new();
    if let Some(scene) = regular::text_if_there(&run.join(SCENE), regular::LONGEST_SCENE)? {
        let spec = scene::parse(&scene, SCENE, run, &[]).ok().map(|scene| scene.spec);
        if !trajectory.is_of(&scene, spec.as_ref()) {
            doubts.push(Doubt::Foreign(SCENE));
        }
    }
    let Some(text) = text else { return Ok(doubts) };
    let Some(seal) = unsealed(&text) else {
        doubts.push(Doubt::Changed(SUMMARY));
        return Ok(doubts);
    };
    if seal.origin != trajectory {
        doubts.push(Doubt::Foreign(SUMMARY));
        return Ok(doubts);
    }
    for name in tables::FILES.into_iter().chain(details::FILES).chain([BODIES, TRAJECTORY]) {
        let path = run.join(name);
        if path.is_file() && seal.files.get(name) != Some(&Digest::of_file(&path)?) {
            doubts.push(Doubt::Changed(name));
        }
    }
    Ok(doubts)
}

/// [`doubts`], which are an error unless they are meant to be passed over: `anyway`.
///
/// # Errors
/// [`Error::Input`] that lists them; what reading the files says.
pub fn check(run: &Path, anyway: bool) -> Result<Vec<Doubt>> {
    let doubts = doubts(run)?;
    if doubts.is_empty() || anyway {
        return Ok(doubts);
    }
    Err(Error::input(
        format!("{}: {}", run.display(), list(&doubts)),
        "restore what the run wrote, or run its scene again; --anyway goes on, and the result says so",
    ))
}

/// Doubts in a row.
pub fn list(doubts: &[Doubt]) -> String {
    doubts.iter().map(Doubt::to_string).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sealed_summary_is_the_same_object_and_tells_every_change() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("curve.csv"), "step\n").unwrap();
        let summary = serde_json::to_string_pretty(&serde_json::json!({ "scene": "a", "strength": 1.5 })).unwrap();
        let sealed = seal(&summary, Origin::default(), folder.path(), &[]).unwrap();
        let read: serde_json::Value = serde_json::from_str(&sealed).unwrap();
        assert_eq!((read["scene"].as_str(), read["strength"].as_f64()), (Some("a"), Some(1.5)));
        let seal = unsealed(&sealed).unwrap();
        assert_eq!(seal.files["curve.csv"], Digest::of("step\n"));
        assert_eq!(unsealed(&sealed.replace("1.5", "1.6")), None);
        assert_eq!(unsealed(&summary), None);
    }
}
