//! Drawing that was ended early, of `strandsnap render` and of a run: what it goes on with, and what it draws again. Needs a
//! graphics adapter; without one the tests say that they were skipped.

#[path = "common/program.rs"]
mod program;

use program::{strandsnap, text};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant, SystemTime};
use strandsnap::base::error::Result;
use strandsnap::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use strandsnap::observe::Observer;
use strandsnap::observe::animation::Animation;
use strandsnap::observe::peaks::Peaks;
use strandsnap::run::drawing::Undrawn;
use strandsnap::run::{self, RunOptions, StopReason};
use strandsnap::scene;
use strandsnap::study::check_run;

/// The pictures in a folder, and when each was written.
fn pictures(folder: &Path) -> BTreeMap<String, (Vec<u8>, SystemTime)> {
    let Ok(entries) = std::fs::read_dir(folder) else { return BTreeMap::new() };
    let named = entries.map(|entry| entry.unwrap()).filter_map(|entry| {
        let name = entry.file_name().into_string().unwrap();
        let written = entry.metadata().ok()?.modified().ok()?;
        name.starts_with("frame_").then(|| (name, (std::fs::read(entry.path()).unwrap(), written)))
    });
    named.collect()
}

#[test]
fn a_render_that_is_killed_draws_what_is_missing() {
    if strandsnap::render::check().is_err() {
        let _ =
            writeln!(std::io::stderr(), "SKIPPED (no graphics adapter): a_render_that_is_killed_draws_what_is_missing");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let call = |args: &[&str]| strandsnap(folder.path(), args);
    let wire = "wire.0.to=[\"0 mm\", \"0 mm\", \"30 mm\"]";
    let run = ["run", "single-wire", "--set", wire, "--set", "grip.length=5 mm", "--set", "output.snapshots=30"];
    let run =
        call(&[&run[..], &["--size", "640x360", "--no-frames", "--no-recording", "--quiet", "--out", "run"]].concat());
    assert!(run.status.success(), "{}", text(&run.stderr));
    assert!(call(&["render", "run", "--quiet", "--out", "whole"]).status.success());
    let whole = pictures(&folder.path().join("whole"));
    assert!(whole.len() > 20, "{}", whole.len());

    let out = folder.path().join("out");
    let begin = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_strandsnap"))
        .args(["render", "run", "--quiet", "--out", "out"])
        .current_dir(folder.path())
        .stderr(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    while pictures(&out).len() < 4 {
        assert!(begin.elapsed() < Duration::from_secs(60) && child.try_wait().unwrap().is_none(), "it is not killed");
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let drawn = pictures(&out);
    assert!(drawn.len() < whole.len(), "it had ended");
    // The power may go while a picture is written.
    std::fs::write(out.join("frame_0001.png"), &drawn["frame_0001.png"].0[..2000]).unwrap();

    let refused = call(&["render", "run", "--quiet", "--out", "out"]);
    assert_eq!(refused.status.code(), Some(2), "going on has to be asked for");
    let resume = ["render", "run", "--quiet", "--out", "out", "--resume"];
    let gone_on = call(&resume);
    let told = text(&gone_on.stderr);
    assert!(gone_on.status.success(), "{told}");
    let words = format!("{} of {} pictures were drawn before", drawn.len() - 1, whole.len());
    assert!(told.contains(&words), "no {words} in {told}");
    let all = pictures(&out);
    assert_eq!(all.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>());
    for (name, (bytes, written)) in &all {
        assert!(*bytes == whole[name].0, "{name} differs");
        let kept = drawn.get(name).is_some_and(|(_, before)| before == written);
        assert_eq!(kept, drawn.contains_key(name) && name != "frame_0001.png", "{name}");
    }
    assert!(!out.join("UNFINISHED.txt").exists());
    let finished = call(&resume);
    assert_eq!(finished.status.code(), Some(2));
    assert!(text(&finished.stderr).contains("no unfinished pictures"), "{}", text(&finished.stderr));
    // Another view: nothing of the first stays.
    let mark = "These pictures are not all.\ndrawn: 0000000000000000000000000000000000000000000000000000000000000000\n";
    std::fs::write(out.join("UNFINISHED.txt"), mark).unwrap();
    let other = call(&[&resume[..], &["--every", "10", "--theme", "light"]].concat());
    assert!(other.status.success() && text(&other.stderr).contains("all are drawn again"), "{}", text(&other.stderr));
    let other = pictures(&out);
    assert!(other.len() < whole.len() && other["frame_0000.png"].0 != whole["frame_0000.png"].0);
}

/// Sets a flag when a run has told its last.
struct StopAtTheEnd<'a>(&'a AtomicBool);

impl Observer for StopAtTheEnd<'_> {
    fn start(&mut self, _info: &Arc<RunInfo>) -> Result<()> {
        Ok(())
    }
    fn peaks(&mut self, _peaks: &Peaks) -> Result<()> {
        self.0.store(true, Ordering::Relaxed);
        Ok(())
    }
    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Passes on the first snapshots alone.
struct FirstOnes<'a> {
    inner: &'a mut dyn Observer,
    left: usize,
}

impl Observer for FirstOnes<'_> {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        self.inner.start(info)
    }
    fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.inner.sample(sample)
    }
    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.inner.rupture(rupture)
    }
    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        if self.left == 0 {
            return Ok(());
        }
        self.left -= 1;
        self.inner.snapshot(snapshot)
    }
    fn finish(&mut self) -> Result<()> {
        self.inner.finish()
    }
}

/// A batch system gives seconds between the first signal and the last.
#[test]
fn a_run_that_is_stopped_while_it_draws_keeps_its_results_and_is_drawn_later() {
    const NAME: &str = "a_run_that_is_stopped_while_it_draws_keeps_its_results_and_is_drawn_later";
    if strandsnap::render::check().is_err() {
        let _ = writeln!(std::io::stderr(), "SKIPPED (no graphics adapter): {NAME}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let set = [
        "wire.0.to=[\"0 mm\", \"0 mm\", \"30 mm\"]",
        "grip.length=5 mm",
        "output.snapshots=30",
        "output.frame_size=[640, 360]",
    ];
    let scene = scene::load("single-wire", &set.map(String::from)).unwrap();
    let at = |name: &str| folder.path().join(name);
    let options = |name: &str| {
        let animation = Some(Animation { file: at(name).join("frames.gif"), width: Some(160) });
        RunOptions { frames: true, animation, threads: Some(1), ..RunOptions::tables(&at(name)) }
    };
    run::run(&scene, &options("whole"), &AtomicBool::new(false)).unwrap();
    let whole = pictures(&at("whole/frames"));
    let stop = AtomicBool::new(false);
    let summary = run::run_watched(&scene, &options("cut"), vec![&mut StopAtTheEnd(&stop)], &stop).unwrap();
    let left = summary.cost.frames.unwrap().not_drawn as usize;
    assert!(left > 0 && summary.stopped != StopReason::Interrupted, "{left} left, {}", summary.stopped);
    let drawn = pictures(&at("cut/frames"));
    assert_eq!(drawn.len() + left, whole.len());
    assert!(at("cut/frames/UNFINISHED.txt").is_file() && !at("cut/frames.gif").exists());
    let stopped = AtomicBool::new;
    let agrees = |name: &str| {
        let checks = check_run::check(&at(name)).unwrap();
        let wrong = checks.iter().filter(|check| check.failed()).map(|check| &check.outcome).collect::<Vec<_>>();
        assert!(wrong.is_empty(), "{name}: {wrong:?}");
    };
    agrees("cut");
    // The program is another build than this test, so it begins with the pictures anew.
    std::fs::create_dir_all(at("copy/frames")).unwrap();
    for part in ["", "frames"] {
        for file in std::fs::read_dir(at("cut").join(part)).unwrap().map(|file| file.unwrap().path()) {
            if file.is_file() {
                std::fs::copy(&file, at("copy").join(part).join(file.file_name().unwrap())).unwrap();
            }
        }
    }
    let resumed = strandsnap(folder.path(), &["resume", "copy", "--quiet"]);
    assert!(resumed.status.success(), "{}", text(&resumed.stderr));
    // The power goes when all is drawn and nothing is told.
    let mut drawing = Undrawn::find(&at("cut")).unwrap().expect("pictures are missing").begin().unwrap();
    let snapshots = drawing.replay.count();
    drawing
        .replay
        .show(&mut FirstOnes { inner: &mut *drawing.writer, left: drawn.len() + 3 }, &stopped(false))
        .unwrap();
    drop(drawing);
    assert_eq!(pictures(&at("cut/frames")).len(), drawn.len() + 3);
    agrees("cut");
    // Stopped once more, and then not.
    for stop in [true, false] {
        let undrawn = Undrawn::find(&at("cut")).unwrap().expect("pictures are missing");
        let mut drawing = undrawn.begin().unwrap();
        drawing.replay.show(&mut *drawing.writer, &stopped(stop)).unwrap();
        let frames = drawing.end().unwrap().cost.frames.unwrap();
        assert_eq!((frames.not_drawn > 0, frames.not_animated), (stop, stop));
        assert_eq!((frames.frames + frames.not_drawn) as usize, snapshots);
        agrees("cut");
    }
    assert!(Undrawn::find(&at("cut")).unwrap().is_none());
    for name in ["cut", "copy"] {
        let all = pictures(&at(name).join("frames"));
        assert_eq!(all.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>());
        assert!(all.iter().all(|(picture, (bytes, _))| *bytes == whole[picture].0), "{name}");
        assert!(name == "copy" || drawn.iter().all(|(picture, (_, written))| all[picture].1 == *written));
        assert!(std::fs::read(at(name).join("frames.gif")).ok() == std::fs::read(at("whole/frames.gif")).ok());
        assert!(!at(name).join("frames/UNFINISHED.txt").exists());
        agrees(name);
    }
}

/// Nothing but its simulation can go on.
#[test]
fn a_run_that_was_interrupted_before_its_end_is_not_only_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene::load("single-wire", &["output.checkpoint=none".into()]).unwrap();
    let out = folder.path().join("out");
    if strandsnap::render::check().is_err() {
        let _ = writeln!(
            std::io::stderr(),
            "SKIPPED (no graphics adapter): a_run_that_was_interrupted_before_its_end_is_not_only_drawn"
        );
        return;
    }
    let options = RunOptions { frames: true, threads: Some(1), ..RunOptions::tables(&out) };
    let summary = run::run(&scene, &options, &AtomicBool::new(true)).unwrap();
    assert_eq!(summary.stopped, StopReason::Interrupted);
    assert!(out.join("frames/UNFINISHED.txt").is_file());
    assert!(Undrawn::find(&out).unwrap().is_none());
}
