//! A run that is watched while it goes on: nothing of it depends on who looks, and it ends as runs end.

use crate::browser::{self, Browser};
use crate::program::{printed, strandsnap, text};
use crate::shown::{At, PATIENCE, SIZE, close_up, folder, json_of, next_picture, next_words, say, skipped};
use crate::strand::STRAND;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use strandsnap::explore::View;
use tempfile::TempDir;
use tungstenite::WebSocket;

/// A strand that breaks within seconds, with states to look at.
fn scene() -> String {
    let (few, more) = ("snapshots = 6", "snapshots = 24");
    assert!(STRAND.contains(few));
    STRAND.replace(few, more)
}

/// What a run writes and nothing else changes; its summary also says what it cost.
const FILES: [&str; 5] = ["trajectory.bin", "curve.csv", "wires.csv", "ruptures.csv", "scene.toml"];

/// A run of the program that is watched.
struct Going {
    child: Child,
    at: At,
    out: PathBuf,
    _folder: TempDir,
}

/// `None`, said aloud, when there is no graphics adapter.
fn going(test: &str, more: &[&str]) -> Option<Going> {
    if strandsnap::render::check().is_err() {
        skipped(test, "no graphics adapter");
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let (file, out) = (folder.path().join("strand.toml"), folder.path().join("out"));
    std::fs::write(&file, scene()).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_strandsnap"))
        .arg("run")
        .arg(&file)
        .args(["--explore", "--no-open", "--no-frames", "--no-recording", "--threads", "1", "--out"])
        .arg(&out)
        .args(more)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut line = String::new();
    let mut said = BufReader::new(child.stdout.take().unwrap());
    said.read_line(&mut line).unwrap();
    let address = line.split_whitespace().find(|word| word.starts_with("http://")).expect("an address is printed");
    let at = At(address.to_owned());
    // What else it says is not needed, but must be taken.
    std::thread::spawn(move || said.read_to_string(&mut String::new()));
    Some(Going { child, at, out, _folder: folder })
}

impl Going {
    /// The exit code, when it has ended by itself.
    fn ended(&mut self) -> Option<i32> {
        let begin = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status.code();
            }
            assert!(begin.elapsed() < PATIENCE, "the run does not end");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Drop for Going {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Holds the run and waits until it is held; what it is told of then.
fn hold(socket: &mut WebSocket<std::net::TcpStream>, pace: &str) -> Value {
    say(socket, json!({ "pace": pace }));
    loop {
        let told = next_words(socket, "live");
        if told["pace"] == "held" {
            return told;
        }
    }
}

fn states(at: &At) -> usize {
    json_of(&at.fetch("/run.json"))["states"].as_array().unwrap().len()
}

/// What an undisturbed run of the same scene writes.
fn alone(folder: &Path) -> PathBuf {
    let out = folder.join("alone");
    std::fs::write(folder.join("strand.toml"), scene()).unwrap();
    let arguments = ["run", "strand.toml", "--no-frames", "--no-recording", "--threads", "1", "--out", "alone"];
    printed(&strandsnap(folder, &arguments));
    out
}

#[test]
fn what_a_run_writes_does_not_depend_on_who_looks() {
    let Some(mut run) = going("what_a_run_writes_does_not_depend_on_who_looks", &[]) else { return };
    let mut socket = run.at.socket();
    hold(&mut socket, "held");
    let held = states(&run.at);
    std::thread::sleep(Duration::from_millis(400));
    assert_eq!(states(&run.at), held, "a held run goes on");
    // Two states, one after the other, each drawn as soon as it is there.
    for number in 1..=2 {
        hold(&mut socket, "step");
        assert_eq!(states(&run.at), held + number, "a step is one state");
        let view = View { state: (held + number - 1) as f64, follow: None, centre: [0.0, 0.0, 8.0], ..close_up(0.0) };
        say(&mut socket, json!({ "look": { "number": number, "size": SIZE, "view": view } }));
        assert_eq!(next_picture(&mut socket, 0).0 as usize, number);
        say(&mut socket, json!({ "shown": number }));
    }
    say(&mut socket, json!({ "pace": "going" }));
    let end = loop {
        let told = next_words(&mut socket, "live");
        if !told["end"].is_null() {
            break told;
        }
    };
    // The page stays, with all that the run's files hold.
    let facts = json_of(&run.at.fetch("/run.json"));
    let summary: Value = serde_json::from_slice(&std::fs::read(run.out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(end["end"], summary["stopped_because"]);
    assert_eq!(facts["ruptures"].as_array().unwrap().len() as u64, summary["bonds_broken"].as_u64().unwrap());
    assert!(facts["ruptures"].as_array().unwrap().len() > 1, "nothing broke");
    let first = &summary["first_rupture"];
    assert_eq!(facts["ruptures"][0]["wire"].as_u64().unwrap() + 1, first["wire"].as_u64().unwrap());
    let written = strandsnap::page::Source::read(&run.out).unwrap();
    assert_eq!(facts["states"].as_array().unwrap().len(), written.snapshots);
    assert!(facts["headline"].as_str().unwrap().contains("snapped first"));
    drop(socket);
    assert_eq!(run.ended(), Some(0));
    let folder = tempfile::tempdir().unwrap();
    let alone = alone(folder.path());
    for file in FILES {
        assert!(
            std::fs::read(run.out.join(file)).unwrap() == std::fs::read(alone.join(file)).unwrap(),
            "{file} differs"
        );
    }
}

/// Its files are whole, and going on from them gives what an undisturbed run writes.
fn goes_on(out: &Path) {
    for file in FILES {
        assert!(out.join(file).is_file(), "{file}");
        assert!(!out.join(format!("{file}.partial")).exists(), "{file} is not whole");
    }
    let summary: Value = serde_json::from_slice(&std::fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["stopped"]["kind"], "interrupted");
    printed(&strandsnap(out, &["check-run", "."]));
    printed(&strandsnap(out, &["resume", ".", "--threads", "1"]));
    let folder = tempfile::tempdir().unwrap();
    let alone = alone(folder.path());
    for file in FILES {
        assert!(std::fs::read(out.join(file)).unwrap() == std::fs::read(alone.join(file)).unwrap(), "{file} differs");
    }
}

#[test]
fn a_page_stops_a_run_as_ctrl_c_does() {
    let Some(mut run) = going("a_page_stops_a_run_as_ctrl_c_does", &[]) else { return };
    let mut socket = run.at.socket();
    hold(&mut socket, "held");
    say(&mut socket, json!({ "stop": null }));
    while next_words(&mut socket, "live")["end"].is_null() {}
    // What there is can still be looked at.
    let view = View { follow: None, centre: [0.0, 0.0, 8.0], ..close_up(0.0) };
    say(&mut socket, json!({ "look": { "number": 3, "size": SIZE, "view": view } }));
    assert_eq!(next_picture(&mut socket, 0).0, 3);
    drop(socket);
    assert_eq!(run.ended(), Some(130));
    goes_on(&run.out);
}

#[test]
fn ctrl_c_ends_a_held_run_at_once_whoever_looks() {
    let Some(mut run) = going("ctrl_c_ends_a_held_run_at_once_whoever_looks", &[]) else { return };
    let mut socket = run.at.socket();
    hold(&mut socket, "held");
    let kill = Command::new("kill").args(["-INT", &run.child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let begin = Instant::now();
    assert_eq!(run.ended(), Some(130));
    assert!(begin.elapsed() < Duration::from_secs(10), "{:?}", begin.elapsed());
    goes_on(&run.out);
}

#[test]
fn a_run_that_nobody_looks_at_ends_by_itself() {
    let Some(mut run) = going("a_run_that_nobody_looks_at_ends_by_itself", &["--quiet"]) else { return };
    assert_eq!(run.ended(), Some(0));
}

#[test]
fn a_scene_is_told_how_it_is_watched() {
    let folder = folder(2);
    for scene in ["ka4", "scene.toml"] {
        let output = strandsnap(folder.path(), &["explore", scene]);
        assert_eq!(output.status.code(), Some(2));
        let words = text(&output.stderr).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(&format!("strandsnap run {scene} --explore")), "{words}");
    }
}

#[test]
fn a_person_watches_a_run_holds_it_and_stops_it() {
    const NAME: &str = "a_person_watches_a_run_holds_it_and_stops_it";
    let Some(program) = browser::find() else { return skipped(NAME, "no Chromium") };
    let mut page = Browser::start(&program);
    // Long enough for a browser that is slow to open a page.
    let Some(mut run) = going(NAME, &["--set", "strand.length=32 mm"]) else { return };
    page.visit(&run.at.0, "dark");
    page.wait_for("String(document.querySelector('#hold').disabled)", "false");
    page.value("document.querySelector('#hold').click()");
    page.wait_for("document.querySelector('#hold').textContent", "Go on");
    let state = "explore.view.state";
    // The page hears of states a little after the run has written them.
    let begin = Instant::now();
    let before = loop {
        let held = states(&run.at);
        std::thread::sleep(Duration::from_millis(1000));
        let shown = page.value(state).as_f64().unwrap();
        if states(&run.at) == held && shown == held as f64 - 1.0 {
            break shown;
        }
        assert!(begin.elapsed() < PATIENCE, "a run that is held goes on, or its newest state is not shown");
    };
    page.value("document.querySelector('#step').click()");
    page.wait_for(&format!("String({state} > {before})"), "true");
    page.wait_for("document.querySelector('#hold').textContent", "Go on");
    assert_eq!(page.value(state).as_f64().unwrap(), before + 1.0, "the newest state is followed, and is one more");
    // The moment in the words is that of the run's newest state.
    let at = states(&run.at) - 1;
    let facts = json_of(&run.at.fetch("/run.json"));
    let strain = format!("{:.2} % strain", facts["states"][at]["x"].as_f64().unwrap());
    page.wait_for(&format!("String(document.querySelector('#now').textContent.startsWith('{strain}'))"), "true");
    assert_eq!(page.violations().unwrap_or_default(), Vec::<String>::new());
    page.value("document.querySelector('#stop').click()");
    assert_eq!(page.value("explore.live.known.stopping"), false, "one press is not enough");
    page.value("document.querySelector('#stop').click()");
    page.wait_for("String(explore.live.ended)", "true");
    let told = page.value("document.querySelector('#live-text').textContent");
    assert!(told.as_str().unwrap().starts_with("The run is over: "), "{told}");
    assert_eq!(page.complaints(), Vec::<Value>::new(), "the console has complaints");
    drop(page);
    assert_eq!(run.ended(), Some(130));
}
