//! The output folder: checked before the simulation, cleared only when nothing else can fail.

use super::exported;
use super::lock::{self, LOCK, Lock};
use super::options::Outputs;
use crate::base::digest::Digest;
use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::observe::bodies::BODIES;
use crate::observe::files::write_whole;
use crate::observe::origin::RUN_KEYWORD;
use crate::observe::{details, partial, tables};
use std::collections::HashSet;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Resolved scene.
pub const SCENE: &str = "scene.toml";
/// Summary.
pub const SUMMARY: &str = "summary.json";
/// Rerun recording.
pub const RECORDING: &str = "recording.rrd";
/// Snapshots for drawing again.
pub const TRAJECTORY: &str = "trajectory.bin";
/// The two slots of checkpoints.
pub const SLOTS: [&str; 2] = ["checkpoint-1.bin", "checkpoint-2.bin"];
/// Trajectory that a run is being resumed from.
pub const RESUMED_FROM: &str = "trajectory.before-resume.bin";
/// The page for people, which is made from all the others.
pub const REPORT: &str = "report.html";
/// Folder of numbered pictures.
pub const FRAMES: &str = "frames";
/// Animation of them, where no other name is given.
pub const ANIMATION: &str = "frames.gif";
/// Folder of the pictures that the scene asks for by name.
pub const PICTURES: &str = "pictures";
/// What a folder of pictures holds until the last of them is drawn.
const UNFINISHED: &str = "UNFINISHED.txt";
/// Begins the line in it that says what is drawn.
const DRAWN: &str = "drawn: ";
/// Begins the line in it that says what else a run writes, where it is a run's own folder of pictures.
const OUTPUTS: &str = "outputs: ";
/// A study of error against run time, in a folder of its own.
pub const ACCURACY_STUDY: &str = "accuracy.json";
/// Its plot.
pub const ACCURACY_PLOT: &str = "accuracy.svg";

/// Pictures in a folder that say of which run they are: what a user has put there does not.
fn own_pictures(folder: &Path) -> Vec<PathBuf> {
    /// A picture of a run says so right after its signature and its header, which are 33 bytes.
    const SOON: usize = 128;
    let says = |path: &PathBuf| {
        let mut begin = Vec::with_capacity(SOON);
        let read = fs::File::open(path).and_then(|file| file.take(SOON as u64).read_to_end(&mut begin));
        read.is_ok() && begin.windows(RUN_KEYWORD.len()).any(|word| word == RUN_KEYWORD.as_bytes())
    };
    let files = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    files.filter(|path| path.is_file() && path.extension().is_some_and(|end| end == "png") && says(path)).collect()
}

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

/// Whether a run has kept a checkpoint in `run`, whole or not.
pub fn has_checkpoint(run: &Path) -> bool {
    SLOTS.iter().any(|slot| run.join(slot).is_file())
}

/// Whether a run was ended in `run` before it came to its end.
pub fn is_unfinished(run: &Path) -> bool {
    let is_there = |name: &str| run.join(name).is_file();
    // Its summary is the last that a run writes.
    let cut_off = is_there(SCENE) && is_there(TRAJECTORY) && !is_there(SUMMARY);
    has_checkpoint(run) || partial::name(&run.join(TRAJECTORY)).is_file() || cut_off
}

/// Every file that a run writes into its folder.
fn files() -> impl Iterator<Item = &'static str> {
    tables::FILES
        .into_iter()
        .chain(details::FILES)
        .chain([BODIES, SCENE, SUMMARY, RECORDING, TRAJECTORY, ANIMATION, REPORT])
}

/// An output folder that may be written.
#[derive(Debug)]
pub struct OutFolder {
    path: PathBuf,
    overwrite: bool,
}

impl OutFolder {
    /// Checks that `path` may be used, without changing anything there.
    ///
    /// # Errors
    /// [`Error::Input`] when it holds something and `overwrite` is not set, is no folder, another process writes into it, or
    /// what has the name of a result is no regular file; [`Error::Io`] when it cannot be written.
    pub fn check(path: &Path, overwrite: bool) -> Result<Self> {
        regular::check_folder(path)?;
        let folder = Self { path: path.into(), overwrite };
        if let Some(by) = lock::holder(path) {
            return Err(lock::held(path, &by));
        }
        folder.check_content()?;
        probe(path)?;
        Ok(folder)
    }

    fn check_content(&self) -> Result<()> {
        if !self.path.is_dir() {
            return Ok(());
        }
        if !self.overwrite && !is_empty(&self.path)? {
            return Err(Error::input(
                format!("the output folder {} exists and is not empty", self.path.display()),
                "give --overwrite to replace the results in it, or another folder with --out",
            ));
        }
        files().map(|name| self.path.join(name)).try_for_each(|file| {
            regular::replaceable(&partial::name(&file))?;
            regular::replaceable(&file)
        })
    }

    /// Checks that `input`, a file that the run is made from, is not among those that it would replace.
    ///
    /// # Errors
    /// [`Error::Input`] when it is.
    pub fn spare(&self, input: &Path) -> Result<()> {
        let same = |name: &str| {
            let both = input.canonicalize().ok().zip(self.path.join(name).canonicalize().ok());
            both.is_some_and(|(input, result)| input == result)
        };
        if !files().any(same) {
            return Ok(());
        }
        Err(Error::input(
            format!("{} would be replaced by a result of its own run", input.display()),
            "give another folder with --out, or a copy of that file elsewhere",
        ))
    }

    /// Creates the folder, or removes what an earlier run wrote into it and nothing else. Nobody else writes into it while
    /// the lock is kept.
    ///
    /// # Errors
    /// [`Error::Io`]; [`Error::Input`] when another process has been faster.
    pub fn open(&self) -> Result<Lock> {
        let lock = self.take()?;
        clear_checkpoints(&self.path)?;
        remove_if_there(&self.path.join(SCENE))?;
        self.clear_results()?;
        Ok(lock)
    }

    /// Removes what a run has written besides its scene and its checkpoints, which writes it again when it is resumed.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub(super) fn clear_results(&self) -> Result<()> {
        for name in files().filter(|name| *name != SCENE) {
            let file = self.path.join(name);
            remove_if_there(&partial::name(&file))?;
            remove_if_there(&file)?;
        }
        exported::files(&self.path).iter().try_for_each(|file| remove_if_there(file))?;
        for folder in exported::folders(&self.path) {
            // Fails when something else is in it, which is right.
            let _ = fs::remove_dir(folder);
        }
        let pictures = self.path.join(PICTURES);
        own_pictures(&pictures).iter().try_for_each(|file| remove_if_there(file))?;
        let _ = fs::remove_dir(pictures);
        let frames = self.path.join(FRAMES);
        clear_pictures(&frames, None)?;
        remove_if_there(&frames.join(UNFINISHED))?;
        let _ = fs::remove_dir(frames);
        Ok(())
    }

    /// The same for a folder of pictures only: nothing but numbered pictures is removed. It is marked as unfinished until
    /// [`Pictures::complete`]; the mark says what is `drawn`: of which run, and how. Where an earlier process has begun to
    /// draw the same and `go_on` tells which of its pictures are whole, those stay. A run's own pictures are drawn with `outputs`.
    ///
    /// # Errors
    /// As for [`OutFolder::open`].
    pub fn open_for_pictures(
        &self,
        drawn: &Digest,
        go_on: Option<&dyn Fn(&Path) -> bool>,
        outputs: Option<&Outputs>,
    ) -> Result<Pictures> {
        let lock = self.take()?;
        let mark = self.path.join(UNFINISHED);
        let begun = drawn_before(&self.path);
        let is_whole = go_on.filter(|_| begun == Some(*drawn));
        let whole = clear_pictures(&self.path, is_whole)?;
        regular::make_folder(&self.path)?;
        let says = "These pictures are not all that were to be drawn: drawing goes on, or was stopped.";
        let outputs = outputs.map_or(String::new(), |outputs| {
            format!("{OUTPUTS}{}\n", serde_json::to_string(outputs).expect("they hold nothing that JSON lacks"))
        });
        write_whole(&mark, &format!("{says}\n{DRAWN}{drawn}\n{outputs}"))?;
        Ok(Pictures { mark, whole, others: begun.is_some_and(|begun| begun != *drawn), _lock: lock })
    }

    /// Makes and locks it; what came meanwhile is looked at again.
    fn take(&self) -> Result<Lock> {
        regular::make_folder(&self.path)?;
        let lock = Lock::take(&self.path)?;
        self.check_content()?;
        Ok(lock)
    }

    /// Locks it for a run that goes on.
    ///
    /// # Errors
    /// [`Error::Input`] when another process writes into it.
    pub fn take_over(&self) -> Result<Lock> {
        Lock::take(&self.path)
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
        Ok(Self { path: path.into(), overwrite: true })
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The path of a file in it.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }
}

/// A folder that pictures are drawn into.
#[derive(Debug)]
pub struct Pictures {
    mark: PathBuf,
    whole: HashSet<PathBuf>,
    others: bool,
    _lock: Lock,
}

impl Pictures {
    /// Those that are there already, whole.
    pub fn whole(&self) -> &HashSet<PathBuf> {
        &self.whole
    }

    /// Whether pictures were removed that an earlier process had begun to draw, of another run or in another way.
    pub fn replaced_others(&self) -> bool {
        self.others
    }

    /// All are drawn.
    ///
    /// # Errors
    /// [`Error::Io`] when the mark cannot be removed.
    pub fn complete(self) -> Result<()> {
        remove_if_there(&self.mark)
    }
}

/// Whether nothing but a lock is in a folder.
fn is_empty(folder: &Path) -> Result<bool> {
    let mut entries = fs::read_dir(folder).map_err(|e| Error::io("cannot read the folder", folder, e))?;
    Ok(entries.all(|entry| entry.is_ok_and(|entry| entry.file_name() == LOCK)))
}

/// Whether there is a folder with something in it besides a lock.
pub fn holds_something(folder: &Path) -> bool {
    folder.is_dir() && !is_empty(folder).unwrap_or(false)
}

/// Tries to write a file that vanishes again, in the folder or in the nearest one above it that exists.
fn probe(path: &Path) -> Result<()> {
    let refuse = |e| Error::io("cannot write into the folder", path, e);
    let absolute = std::path::absolute(path).map_err(refuse)?;
    let existing = absolute.ancestors().find(|a| a.exists()).unwrap_or(&absolute);
    tempfile::tempfile_in(existing).map(drop).map_err(refuse)
}

/// Removes the checkpoints of a run, and the trajectory that it was resumed from.
///
/// # Errors
/// [`Error::Io`] when one cannot be removed.
pub(super) fn clear_checkpoints(folder: &Path) -> Result<()> {
    for name in SLOTS {
        remove_if_there(&partial::name(&folder.join(name)))?;
        remove_if_there(&folder.join(name))?;
    }
    remove_if_there(&folder.join(RESUMED_FROM))
}

pub(super) fn remove_if_there(file: &Path) -> Result<()> {
    match fs::remove_file(file) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(Error::io("cannot remove", file, e)),
        _ => Ok(()),
    }
}

/// Removes numbered pictures from a folder but those that `is_whole` tells, which it gives; and the folder when nothing is
/// left in it.
fn clear_pictures(folder: &Path, is_whole: Option<&dyn Fn(&Path) -> bool>) -> Result<HashSet<PathBuf>> {
    let mut whole = HashSet::new();
    let Ok(entries) = fs::read_dir(folder) else {
        return Ok(whole);
    };
    for picture in entries.flatten().map(|entry| entry.path()).filter(|path| is_picture(path)) {
        if is_whole.is_some_and(|is_whole| is_whole(&picture)) {
            whole.insert(picture);
        } else {
            remove_if_there(&picture)?;
        }
    }
    // Fails when the user keeps something there, or a lock is, which is right.
    let _ = fs::remove_dir(folder);
    Ok(whole)
}

/// What an earlier process has begun to draw into `folder` and not completed; `None` where there is no such mark.
pub fn drawn_before(folder: &Path) -> Option<Digest> {
    marked(folder, DRAWN)?.parse().ok()
}

/// What a run writes whose own pictures in its folder `run` are not all drawn; `None` where they are, or none were asked for.
pub fn outputs_undrawn(run: &Path) -> Option<Outputs> {
    serde_json::from_str(&marked(&run.join(FRAMES), OUTPUTS)?).ok()
}

/// The line of the mark in a folder of pictures that begins with `key`, without it.
fn marked(folder: &Path, key: &str) -> Option<String> {
    let mark = regular::text_if_there(&folder.join(UNFINISHED), regular::LONGEST_TABLE).ok()??;
    mark.lines().find_map(|line| line.strip_prefix(key).map(str::to_owned))
}

/// Whether pictures in `folder` are not all that were to be drawn.
pub fn is_undrawn(folder: &Path) -> bool {
    folder.join(UNFINISHED).exists()
}

/// Whether a file is named as the frames are: a PNG (or the beginning of one) with a number in its name, or what a process
/// that was killed had begun to write.
fn is_picture(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    if name.starts_with(".frame-") && name.ends_with(".tmp") {
        return true;
    }
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
        for name in
            ["notes.txt", "curve.csv", "summary.json", "frames/0001.png", "frames/.frame-a1.tmp", "frames/mine.svg"]
        {
            fs::write(at(name), "x").unwrap();
        }
        let _lock = OutFolder::check(folder.path(), true).unwrap().open().unwrap();
        let left = |name: &str| at(name).exists();
        assert!(left("notes.txt") && left("frames/mine.svg"));
        assert!(!left("curve.csv") && !left("summary.json") && !left("frames/0001.png"));
        assert!(!left("frames/.frame-a1.tmp"));
    }

    #[test]
    fn a_folder_that_is_written_into_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let [first, second] = [0, 1].map(|_| OutFolder::check(folder.path(), false).unwrap());
        let lock = first.open().unwrap();
        let number = format!("process {} ", std::process::id());
        for error in [second.open().unwrap_err(), OutFolder::check(folder.path(), true).unwrap_err()] {
            assert!(error.to_string().contains(&number), "{error}");
        }
        fs::write(folder.path().join("curve.csv"), "found").unwrap();
        drop(lock);
        // Checked when it was empty: what came meanwhile stays.
        assert!(second.open().unwrap_err().to_string().contains("not empty"));
        assert_eq!(fs::read_to_string(folder.path().join("curve.csv")).unwrap(), "found");
    }

    #[test]
    fn a_run_does_not_replace_what_it_is_made_from() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at(SCENE), "mine").unwrap();
        fs::write(at("points.txt"), "mine").unwrap();
        let out = OutFolder::check(folder.path(), true).unwrap();
        assert!(out.spare(&at("points.txt")).is_ok() && out.spare(Path::new("ka4.toml")).is_ok());
        assert_eq!(out.spare(&folder.path().join(".").join(SCENE)).unwrap_err().exit_code(), 2);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_among_the_results_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink("/dev/null", folder.path().join("curve.csv.partial")).unwrap();
        assert!(OutFolder::check(folder.path(), true).unwrap_err().to_string().contains("is a link"));
    }

    #[test]
    fn pictures_are_unfinished_until_all_are_drawn() {
        let folder = tempfile::tempdir().unwrap();
        let out = || OutFolder::check(folder.path(), true).unwrap();
        let pictures = out().open_for_pictures(&Digest::of("a"), None, None).unwrap();
        assert!(folder.path().join(UNFINISHED).is_file());
        pictures.complete().unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn whole_pictures_of_the_same_stay_when_drawing_goes_on() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let is_whole = |path: &Path| fs::read_to_string(path).is_ok_and(|text| text == "whole");
        let (first, other) = (Digest::of("a run, a view"), Digest::of("another view"));
        let open = |drawn: &Digest, go_on: bool| {
            let is_whole: &dyn Fn(&Path) -> bool = &is_whole;
            let pictures = OutFolder::check(folder.path(), true).unwrap();
            let pictures = pictures.open_for_pictures(drawn, go_on.then_some(is_whole), None).unwrap();
            (pictures.whole().len(), pictures.replaced_others())
        };
        assert_eq!((drawn_before(folder.path()), open(&first, true)), (None, (0, false)));
        let draw = || {
            let names =
                [("frame_0000.png", "whole"), ("frame_0001.png", "half"), (".frame-a.tmp", "h"), ("mine.txt", "")];
            names.iter().for_each(|(name, text)| fs::write(at(name), text).unwrap());
        };
        draw();
        assert_eq!(drawn_before(folder.path()), Some(first));
        assert_eq!(open(&first, true), (1, false));
        assert!(at("frame_0000.png").exists() && at("mine.txt").exists());
        assert!(!at("frame_0001.png").exists() && !at(".frame-a.tmp").exists());
        // Nobody has asked to go on, or it is something else that is drawn.
        assert_eq!(open(&first, false), (0, false));
        draw();
        assert_eq!(open(&other, true), (0, true));
        assert!(!at("frame_0000.png").exists());
        assert_eq!(drawn_before(folder.path()), Some(other));
        fs::write(at(UNFINISHED), "changed").unwrap();
        assert_eq!(drawn_before(folder.path()), None);
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
