//! The output folder: checked before the simulation, cleared only when nothing else can fail.

use super::checkpoint;
use crate::base::error::{Error, Result};
use crate::observe::{partial, tables};
use std::fs;
use std::path::{Path, PathBuf};

/// Resolved scene.
pub const SCENE: &str = "scene.toml";
/// Summary.
pub const SUMMARY: &str = "summary.json";
/// Rerun recording.
pub const RECORDING: &str = "recording.rrd";
/// Snapshots for drawing again.
pub const TRAJECTORY: &str = "trajectory.bin";
/// Trajectory that a run is being resumed from.
pub const RESUMED_FROM: &str = "trajectory.before-resume.bin";
/// The page for people, which is made from all the others.
pub const REPORT: &str = "report.html";
/// Folder of numbered pictures.
pub const FRAMES: &str = "frames";
/// Animation of them, where no other name is given.
pub const ANIMATION: &str = "frames.gif";
/// A study of error against run time, in a folder of its own.
pub const ACCURACY_STUDY: &str = "accuracy.json";
/// Its plot.
pub const ACCURACY_PLOT: &str = "accuracy.svg";

/// Folder of the study of a scene where no other is given.
pub fn accuracy(scene: &str) -> PathBuf {
    Path::new("out").join("accuracy").join(scene)
}

/// A study of many cases, in a folder of its own.
pub const STUDY: &str = "study.json";
/// Its page.
pub const STUDY_PAGE: &str = "study.html";

/// Folder of a study where no other is given.
pub fn study(name: &str) -> PathBuf {
    Path::new("out").join("study").join(name)
}

/// A calibration, in a folder of its own.
pub const CALIBRATION: &str = "calibration.json";

/// Folder of the calibration of a scene where no other is given.
pub fn calibration(scene: &str) -> PathBuf {
    Path::new("out").join("calibration").join(scene)
}

/// An output folder that may be written.
#[derive(Debug)]
pub struct OutFolder {
    path: PathBuf,
}

impl OutFolder {
    /// Checks that `path` may be used, without changing anything there.
    ///
    /// # Errors
    /// [`Error::Input`] when it holds something and `overwrite` is not set, or is no folder; [`Error::Io`] when
    /// it cannot be written.
    pub fn check(path: &Path, overwrite: bool) -> Result<Self> {
        if path.exists() && !path.is_dir() {
            return Err(Error::input(format!("{} is not a folder", path.display()), "give another one with --out"));
        }
        if path.is_dir() && !overwrite && !is_empty(path)? {
            return Err(Error::input(
                format!("the output folder {} exists and is not empty", path.display()),
                "give --overwrite to replace the results in it, or another folder with --out",
            ));
        }
        probe(path)?;
        Ok(Self { path: path.into() })
    }

    /// Creates the folder, or removes what an earlier run wrote into it and nothing else.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn open(&self) -> Result<()> {
        fs::create_dir_all(&self.path).map_err(|e| Error::io("cannot create the folder", &self.path, e))?;
        checkpoint::clear(&self.path)?;
        remove_if_there(&self.path.join(SCENE))?;
        self.clear_results()
    }

    /// Removes what a run has written besides its scene and its checkpoints, which writes it again when it is resumed.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub(super) fn clear_results(&self) -> Result<()> {
        let tables = tables::FILES.into_iter();
        for name in tables.chain([SUMMARY, RECORDING, TRAJECTORY, ANIMATION, REPORT]) {
            let file = self.path.join(name);
            remove_if_there(&partial::name(&file))?;
            remove_if_there(&file)?;
        }
        clear_pictures(&self.path.join(FRAMES))
    }

    /// The same for a folder of pictures only: nothing but numbered pictures is removed.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn open_for_pictures(&self) -> Result<()> {
        clear_pictures(&self.path)?;
        fs::create_dir_all(&self.path).map_err(|e| Error::io("cannot create the folder", &self.path, e))
    }

    /// The folder of a run that is to be resumed.
    ///
    /// # Errors
    /// [`Error::Input`] when there is none; [`Error::Io`] when it cannot be written.
    pub fn of_run(path: &Path) -> Result<Self> {
        if !path.is_dir() {
            return Err(Error::input(
                format!("{} is not a folder", path.display()),
                "give the folder of a run, such as out/ka4",
            ));
        }
        probe(path)?;
        Ok(Self { path: path.into() })
    }

    /// The path of a file in it.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }
}

fn is_empty(folder: &Path) -> Result<bool> {
    let mut entries = fs::read_dir(folder).map_err(|e| Error::io("cannot read the folder", folder, e))?;
    Ok(entries.next().is_none())
}

/// Tries to write a file that vanishes again, in the folder or in the nearest one above it that exists.
fn probe(path: &Path) -> Result<()> {
    let refuse = |e| Error::io("cannot write into the folder", path, e);
    let absolute = std::path::absolute(path).map_err(refuse)?;
    let existing = absolute.ancestors().find(|a| a.exists()).unwrap_or(&absolute);
    tempfile::tempfile_in(existing).map_err(refuse)?;
    if existing != absolute && !existing.is_dir() {
        return Err(refuse(std::io::ErrorKind::NotADirectory.into()));
    }
    Ok(())
}

fn remove_if_there(file: &Path) -> Result<()> {
    match fs::remove_file(file) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(Error::io("cannot remove", file, e)),
        _ => Ok(()),
    }
}

/// Removes numbered pictures from a folder, and the folder when nothing is left in it.
fn clear_pictures(folder: &Path) -> Result<()> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Ok(());
    };
    for entry in entries.flatten() {
        if is_picture(&entry.path()) {
            remove_if_there(&entry.path())?;
        }
    }
    // Fails when the user keeps something there, which is right.
    let _ = fs::remove_dir(folder);
    Ok(())
}

/// Whether a file is named as the frames are: a PNG (or the beginning of one) with a number in its name.
fn is_picture(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let stem = name.strip_suffix(".partial").unwrap_or(&name).strip_suffix(".png");
    stem.is_some_and(|stem| stem.contains(|c: char| c.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_with_something_in_it_is_refused_and_the_remedy_named() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("notes.txt"), "mine").unwrap();
        let error = OutFolder::check(folder.path(), false).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let Error::Input { help: Some(help), .. } = error else { panic!("{error:?}") };
        assert!(help.contains("--overwrite"), "{help}");
    }

    #[test]
    fn overwriting_removes_results_only() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at(FRAMES)).unwrap();
        for name in ["notes.txt", "curve.csv", "summary.json", "frames/0001.png", "frames/mine.svg"] {
            fs::write(at(name), "x").unwrap();
        }
        OutFolder::check(folder.path(), true).unwrap().open().unwrap();
        let left = |name: &str| at(name).exists();
        assert!(left("notes.txt") && left("frames/mine.svg"));
        assert!(!left("curve.csv") && !left("summary.json") && !left("frames/0001.png"));
    }

    #[test]
    fn checking_changes_nothing() {
        let folder = tempfile::tempdir().unwrap();
        OutFolder::check(&folder.path().join("a/b"), false).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        fs::write(folder.path().join("curve.csv"), "old").unwrap();
        OutFolder::check(folder.path(), true).unwrap();
        assert_eq!(fs::read_to_string(folder.path().join("curve.csv")).unwrap(), "old");
    }

    #[test]
    fn a_file_in_the_way_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("plain");
        fs::write(&file, "").unwrap();
        assert!(OutFolder::check(&file, true).is_err());
        assert!(OutFolder::check(&file.join("below"), true).is_err());
    }
}
