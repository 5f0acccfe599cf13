//! A run that is killed goes on from its last checkpoint, and writes what an uninterrupted one writes.

#[path = "common/strand.rs"]
mod strand;

use std::collections::BTreeMap;
use std::fs;
#[cfg(all(feature = "render", feature = "record"))]
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use strand::STRAND;
use strandsnap::base::random::uniform;
use strandsnap::engine::Engine;
use strandsnap::run;

fn scene(folder: &Path, text: &str) -> PathBuf {
    let path = folder.join("small.toml");
    fs::write(&path, text).unwrap();
    path
}

fn program(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_strandsnap"));
    command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn succeeds(arguments: &[&str]) -> String {
    let output = program(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {said}");
    said
}

/// Every file of a run by name, but for who holds the folder and what a summary says of time and threads.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let mut files: BTreeMap<String, Vec<u8>> = entries
        .filter(|entry| entry.path().is_file() && entry.file_name() != ".strandsnap.lock")
        .map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap()))
        .collect();
    if let Some(summary) = files.get_mut("summary.json") {
        let mut json: serde_json::Value = serde_json::from_slice(summary).unwrap();
        for of_time in ["wall_s", "cpu_s", "ms_per_step", "threads", "threads_available"] {
            json.as_object_mut().unwrap().remove(of_time).expect(of_time);
        }
        json["seal"].as_object_mut().unwrap().remove("summary").expect("its digest");
        *summary = json.to_string().into_bytes();
    }
    files
}

fn assert_same(a: &Path, b: &Path, what: &str) {
    let (a, b) = (files(a), files(b));
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>(), "{what}");
    for (name, content) in &a {
        assert!(content == &b[name], "{what}: {name} differs");
    }
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Starts the program and kills it after a while, if it has not ended by then.
fn killed_after(arguments: &[&str], while_: Duration) {
    let mut child: Child = program(arguments).spawn().unwrap();
    std::thread::sleep(while_);
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn a_run_that_is_killed_again_and_again_writes_what_an_uninterrupted_one_writes() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), STRAND);
    let (whole, out) = (folder.path().join("whole"), folder.path().join("out"));
    let lean = ["--no-frames", "--no-recording", "--quiet"];
    let run = |out: &Path, threads: &'static str| {
        let mut arguments = vec!["run".to_string(), text(&scene).into(), "--overwrite".into()];
        arguments.extend(["--out", text(out), "--threads", threads].map(String::from));
        arguments.extend(lean.map(String::from));
        arguments
    };
    let started = std::time::Instant::now();
    succeeds(&run(&whole, "2").iter().map(String::as_str).collect::<Vec<_>>());
    let long = started.elapsed();
    let kills: u64 = std::env::var("STRANDSNAP_KILLS").map_or(6, |kills| kills.parse().unwrap());
    let mut resumed = 0;
    for case in 0..kills {
        let moment = |k: u64| long.mul_f64(uniform(7, case, k));
        killed_after(&run(&out, "1").iter().map(String::as_str).collect::<Vec<_>>(), moment(0));
        // Killed once more while it goes on, at any moment from the first.
        for again in 1..=case % 3 {
            killed_after(&["resume", text(&out), "--quiet", "--threads", "1"], moment(again));
        }
        if run::checkpoint::latest(&out).is_ok() {
            resumed += 1;
            succeeds(&["resume", text(&out), "--quiet", "--threads", "2"]);
            assert_same(&whole, &out, &format!("case {case}"));
        }
    }
    assert!(resumed > 0, "of {kills} runs none was killed between its first checkpoint and its end");
}

#[test]
fn what_was_changed_or_is_not_there_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), STRAND);
    let out = folder.path().join("out");
    let refused = |status: i32| {
        let output = program(&["resume", text(&out)]).output().unwrap();
        assert_eq!(output.status.code(), Some(status));
        // Lines of a message are broken at the width of a terminal.
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        said.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
    };
    assert!(refused(2).contains("not a folder"));
    // Stops by itself at the end of its steps, having nothing to go on from.
    let short = ["--set", "stop.steps=400", "--no-frames", "--no-recording", "--quiet"];
    let mut arguments = vec!["run", text(&scene), "--out", text(&out)];
    arguments.extend(short);
    succeeds(&arguments);
    assert!(refused(2).contains("no checkpoint"));

    // A checkpoint of another scene, as if scene.toml had been edited.
    let loaded = strandsnap::scene::load(text(&scene), &[]).unwrap();
    let resolved = strandsnap::scene::write::to_toml(&loaded.spec);
    let outputs =
        run::Outputs { frames: false, recording: false, animation: None, device: run::DeviceChoice::Processor };
    let identity = run::checkpoint::Identity::new(resolved);
    fs::write(out.join("trajectory.bin.partial"), "").unwrap();
    let mut keeper = run::checkpoint::Keeper::new(&out, loaded.spec.output.checkpoint, identity, outputs, None);
    let now = run::checkpoint::LoopPosition {
        step: 150,
        driver: Vec::new(),
        engine: Vec::new(),
        stepping: Duration::ZERO,
        observing: Duration::ZERO,
    };
    keeper.keep(now).unwrap();
    let said = refused(2);
    assert!(said.contains("another run") && said.contains("steps = 400"), "{said}");
}

/// A run that was killed after two checkpoints or more.
fn killed(folder: &Path, out: &Path) {
    let scene = scene(folder, STRAND);
    killed_run(&[text(&scene)], out);
}

/// The same of any scene, with options.
fn killed_run(scene: &[&str], out: &Path) {
    let lean = ["--out", text(out), "--quiet", "--no-frames", "--no-recording", "--threads", "1"];
    let mut child = program(&[&["run"], scene, &lean[..]].concat()).spawn().unwrap();
    let second = || run::checkpoint::latest(out).is_ok_and(|(checkpoint, _)| checkpoint.number >= 3);
    while !second() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before its third checkpoint");
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn a_resume_that_is_refused_touches_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    killed(folder.path(), &out);
    let growing = out.join("trajectory.bin.partial");
    let whole = fs::read(&growing).unwrap();
    fs::write(&growing, &whole[..whole.len() / 20]).unwrap();
    let before = files(&out);
    let output = program(&["resume", text(&out), "--quiet"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("no trajectory of the run") && !said.contains("going on from"), "{said}");
    let mut after = files(&out);
    after.retain(|name, _| before.contains_key(name));
    assert!(before == after, "a file was changed or removed");
}

/// The power may go at any moment: between a new checkpoint and the removal of the old trajectory there are two, of which
/// only the new one reaches as far; while the old one is told again, only the old one does.
#[test]
fn of_two_trajectories_the_one_that_reaches_the_checkpoint_is_taken() {
    let folder = tempfile::tempdir().unwrap();
    let (out, whole) = (folder.path().join("out"), folder.path().join("whole"));
    let scene = scene(folder.path(), STRAND);
    let lean = ["--quiet", "--no-frames", "--no-recording", "--threads", "2"];
    succeeds(&[&["run", text(&scene), "--out", text(&whole)], &lean[..]].concat());
    for short in ["trajectory.bin.partial", "trajectory.before-resume.bin"] {
        killed(folder.path(), &out);
        let long = if short.ends_with("partial") { "trajectory.before-resume.bin" } else { "trajectory.bin.partial" };
        let content = fs::read(out.join("trajectory.bin.partial")).unwrap();
        fs::write(out.join(long), &content).unwrap();
        fs::write(out.join(short), &content[..content.len() / 20]).unwrap();
        succeeds(&["resume", text(&out), "--quiet"]);
        assert_same(&whole, &out, short);
        fs::remove_dir_all(&out).unwrap();
    }
}

/// Every file in a folder, by its name there.
#[cfg(feature = "render")]
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.map(|path| (path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap())).collect()
}

/// Frames are drawn and samples recorded again up to the checkpoint, so that nothing of the killed process stays in them.
#[test]
#[cfg(all(feature = "render", feature = "record"))]
fn frames_and_recording_are_those_of_an_uninterrupted_run() {
    let test = "frames_and_recording_are_those_of_an_uninterrupted_run";
    let folder = tempfile::tempdir().unwrap();
    let (out, whole) = (folder.path().join("out"), folder.path().join("whole"));
    let scene = scene(folder.path(), STRAND);
    let run = |out: &Path| {
        let set = ["--set", "output.snapshots=8", "--set", "output.checkpoint=150", "--quiet", "--threads", "1"];
        let arguments = [&["run", text(&scene), "--out", text(out)], &set[..]].concat();
        arguments.into_iter().map(String::from).collect::<Vec<_>>()
    };
    if strandsnap::render::check().is_err() {
        let _ = writeln!(std::io::stderr(), "SKIPPED (no graphics adapter): {test}");
        return;
    }
    let arguments = run(&whole);
    succeeds(&arguments.iter().map(String::as_str).collect::<Vec<_>>());

    let arguments = run(&out);
    let mut child = program(&arguments.iter().map(String::as_str).collect::<Vec<_>>()).spawn().unwrap();
    let late = || run::checkpoint::latest(&out).is_ok_and(|(checkpoint, _)| checkpoint.number >= 8);
    while !late() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before the checkpoint");
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    succeeds(&["resume", text(&out), "--quiet"]);

    let [of_whole, of_resumed] = [&whole, &out].map(|run| contents(&run.join("frames")));
    assert_eq!(of_whole.keys().collect::<Vec<_>>(), of_resumed.keys().collect::<Vec<_>>());
    assert!(of_whole.len() > 8);
    for (name, picture) in &of_whole {
        assert!(picture == &of_resumed[name], "{} differs", name.display());
    }
    for table in ["curve.csv", "wires.csv", "ruptures.csv", "trajectory.bin"] {
        assert!(fs::read(whole.join(table)).unwrap() == fs::read(out.join(table)).unwrap(), "{table} differs");
    }
    let Some(tool) = std::env::var_os("RERUN_CLI").filter(|tool| !tool.is_empty()) else {
        let _ = writeln!(std::io::stderr(), "SKIPPED (RERUN_CLI does not name Rerun's tool): {test}, the recording");
        return;
    };
    let [a, b] = [&whole, &out].map(|run| run.join("recording.rrd"));
    let compared = Command::new(tool).args(["rrd", "compare", "--unordered"]).args([&a, &b]).output().unwrap();
    assert!(compared.status.success(), "{}", String::from_utf8_lossy(&compared.stderr));
}

#[test]
fn one_command_starts_a_run_and_starts_it_again() {
    let folder = tempfile::tempdir().unwrap();
    let (out, whole) = (folder.path().join("out"), folder.path().join("whole"));
    let scene = scene(folder.path(), STRAND);
    let run = |out: &Path, others: &[&str]| {
        let lean = ["run", text(&scene), "--out", text(out), "--quiet", "--no-frames", "--no-recording"];
        program(&[&lean[..], others].concat()).output().unwrap()
    };
    assert!(run(&whole, &["--resume"]).status.success());
    let again = run(&whole, &["--resume"]);
    assert_eq!(again.status.code(), Some(2), "a finished run is not replaced");
    let said = String::from_utf8_lossy(&again.stderr).into_owned();
    assert!(said.contains("has come to its end"), "{said}");

    // A time limit ends it as Ctrl-C does.
    let limited = run(&out, &["--resume", "--time-limit", "0.1s", "--threads", "1", "--set", "output.checkpoint=20"]);
    let said = String::from_utf8_lossy(&limited.stderr).into_owned();
    assert_eq!(limited.status.code(), Some(130), "{said}");
    assert!(said.contains("the time limit of 0.1 s is reached"), "{said}");
    let other = run(&out, &["--resume", "--seed", "4", "--set", "output.checkpoint=20"]);
    let said = String::from_utf8_lossy(&other.stderr).into_owned();
    assert_eq!(other.status.code(), Some(2), "{said}");
    assert!(said.contains("another run"), "{said}");
    let again = run(&out, &["--resume", "--set", "output.checkpoint=20"]);
    let said = String::from_utf8_lossy(&again.stderr).into_owned();
    assert!(again.status.success() && said.contains("going on from step"), "{said}");
    for table in ["curve.csv", "wires.csv", "ruptures.csv"] {
        assert!(fs::read(whole.join(table)).unwrap() == fs::read(out.join(table)).unwrap(), "{table} differs");
    }

    // Killed before its first checkpoint, and when all was written but the summary: it begins anew.
    fs::remove_file(out.join("summary.json")).unwrap();
    assert_eq!(run(&out, &[]).status.code(), Some(2));
    assert!(run(&out, &["--resume"]).status.success());
    assert_same(&whole, &out, "without a summary");
    fs::remove_dir_all(&out).unwrap();
    fs::create_dir(&out).unwrap();
    fs::write(out.join("trajectory.bin.partial"), "").unwrap();
    assert_eq!(run(&out, &[]).status.code(), Some(2));
    assert!(run(&out, &["--resume"]).status.success());
    assert_same(&whole, &out, "anew");
}

/// What `nohup` starts goes on when its terminal is closed.
#[cfg(unix)]
#[test]
fn a_hang_up_that_was_ignored_from_the_start_stays_ignored() {
    use rustix::process::{Pid, Signal, kill_process};
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), STRAND);
    let out = folder.path().join("out");
    let mut child = Command::new("sh")
        .args(["-c", r#"trap "" HUP; exec "$0" "$@""#, env!("CARGO_BIN_EXE_strandsnap"), "run", text(&scene)])
        .args(["--out", text(&out), "--quiet", "--no-frames", "--no-recording"])
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    while !out.join("curve.csv.partial").exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it could be signalled");
        std::thread::sleep(Duration::from_millis(1));
    }
    kill_process(Pid::from_child(&child), Signal::HUP).unwrap();
    assert!(child.wait().unwrap().success());
}

#[test]
fn a_damaged_checkpoint_falls_back_to_the_other_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let (out, whole) = (folder.path().join("out"), folder.path().join("whole"));
    killed(folder.path(), &out);
    let scene = folder.path().join("small.toml");
    succeeds(&["run", text(&scene), "--out", text(&whole), "--quiet", "--no-frames", "--no-recording"]);
    let newest = run::checkpoint::latest(&out).unwrap().0.number;
    let slot = out.join(if newest.is_multiple_of(2) { "checkpoint-1.bin" } else { "checkpoint-2.bin" });
    let mut bytes = fs::read(&slot).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    fs::write(&slot, bytes).unwrap();
    let said = succeeds(&["resume", text(&out), "--quiet"]);
    let said: String = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("is damaged") && said.contains("going on from the other one"), "{said}");
    assert_same(&whole, &out, "from the older checkpoint");
}

/// Two engines side by side, one of which is saved into a third: all go on alike.
fn goes_on_alike(text: &str, before: usize, after: usize) {
    let folder = tempfile::tempdir().unwrap();
    let loaded = strandsnap::scene::load(self::text(&scene(folder.path(), text)), &[]).unwrap();
    let engine = || Engine::new(&loaded.spec, &loaded.plan, run::assemble(&loaded).unwrap()).unwrap();
    let mut first = engine();
    (0..before).for_each(|_| first.step().unwrap());
    let mut second = engine();
    second.restore(&first.save()).unwrap();
    assert_eq!(first.save(), second.save(), "what was restored is what was saved");
    for step in 0..after {
        first.step().unwrap();
        second.step().unwrap();
        if step % 50 == 0 || step + 1 == after {
            assert!(first.save() == second.save(), "after {step} steps");
            assert_eq!(first.snapshot(), second.snapshot(), "after {step} steps");
        }
    }
    assert_eq!(first.findings(), second.findings());
}

#[test]
fn an_engine_goes_on_to_the_bit_whatever_it_computes() {
    let change = |from: &str, to: &str| {
        assert!(STRAND.contains(from), "{from}");
        STRAND.replace(from, to)
    };
    goes_on_alike(STRAND, 900, 400);
    goes_on_alike(STRAND, 1, 200);
    goes_on_alike(
        &change("tangential = \"mindlin\"", "tangential = \"mindlin-deresiewicz\"\nshape = \"wire\""),
        700,
        300,
    );
    goes_on_alike(
        &change("normal = \"thornton\"", "normal = \"hertz\"").replace("hardness_strain = \"8 %\"\n", ""),
        333,
        200,
    );
    goes_on_alike(&change("speed = \"2 m/s\"", "speed = \"2 m/s\"\nfree_rotation = true"), 300, 200);
    // One wire, whose contacts come in when it breaks.
    let second = STRAND.find("[[strand.layer]]\nwires = 5").unwrap();
    let grip = STRAND.find("[grip]").unwrap();
    goes_on_alike(&[&STRAND[..second], &STRAND[grip..]].concat(), 1300, 400);
}

/// Rigid bodies remember where they are and what they hold; their table is written again as well.
#[test]
fn a_run_with_rigid_bodies_goes_on_to_the_same_tables() {
    let folder = tempfile::tempdir().unwrap();
    let (out, whole) = (folder.path().join("out"), folder.path().join("whole"));
    let bend = ["bend3", "--set", "stop.time=1.5 ms", "--set", "output.checkpoint=1500"];
    succeeds(&[&["run"], &bend[..], &["--out", text(&whole), "--quiet", "--no-frames", "--no-recording"]].concat());
    killed_run(&bend, &out);
    succeeds(&["resume", text(&out), "--quiet", "--threads", "2"]);
    assert_same(&whole, &out, "bend3");
    let table = fs::read_to_string(whole.join("bodies.csv")).unwrap();
    let heads = "step,time_s,strain_percent,body,force_x_n,force_y_n,force_z_n,moment_x_n_mm,moment_y_n_mm,moment_z_n_mm,x_mm,y_mm,z_mm,angle_deg";
    assert_eq!(table.lines().next(), Some(heads));
    let rows: Vec<Vec<&str>> = table.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let curve = fs::read_to_string(whole.join("curve.csv")).unwrap().lines().count() - 1;
    assert_eq!(rows.len(), 3 * curve);
    let number = |row: &[&str], column: usize| row[column].parse::<f64>().unwrap();
    let [left, right, middle] = [&rows[rows.len() - 3], &rows[rows.len() - 2], &rows[rows.len() - 1]];
    assert_eq!([left[3], right[3], middle[3]], ["left", "right", "middle"]);
    // The pins carry what the one between them presses with, but for a tenth by which the wire swings.
    let [left, right, pressed] = [left, right, middle].map(|row| number(row, 5));
    assert!(pressed > 0.2 && (left + right + pressed).abs() < 0.2 * pressed, "{left} {right} {pressed}");
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(whole.join("summary.json")).unwrap()).unwrap();
    let greatest = rows.iter().filter(|row| row[3] == "middle").map(|row| {
        let [x, y, z] = [4, 5, 6].map(|column| number(row, column));
        (x * x + y * y + z * z).sqrt()
    });
    let told = summary["bodies"][2]["greatest_force_n"].as_f64().unwrap();
    assert!((greatest.fold(0.0, f64::max) / told - 1.0).abs() < 1e-6, "{told}");
    assert_eq!(summary["bodies"][2]["name"], "middle");
}
