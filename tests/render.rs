//! `strandsnap render` that was killed: what it goes on with, and what it draws again. Needs a graphics adapter; without
//! one the test says that it was skipped.

#[path = "common/program.rs"]
mod program;

use program::{strandsnap, text};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

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
