//! A run that is killed goes on from its last checkpoint, and writes what an uninterrupted one writes.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use strandsnap::base::random::uniform;
use strandsnap::engine::Engine;
use strandsnap::run;

/// Two layers that break, rub and yield within seconds, pulled adaptively.
const STRAND: &str = r#"
about = "Six wires pulled to fracture."
seed = 3
[material]
density = "8960 kg/m^3"
[bond]
law = "elasto-plastic"
damping = 0.02
hardening = { form = "voce", yield_stress = "100 MPa", saturation = "100 MPa", rate = 12, linear = "500 MPa" }
rupture = { criterion = "plastic-strain", strain = "4 %", weibull_modulus = 8 }
[contact]
normal = "thornton"
tangential = "mindlin"
friction = 0.2
hardness_strain = "8 %"
[strand]
length = "8 mm"
[[strand.layer]]
wires = 1
wire_diameter = "0.39 mm"
[[strand.layer]]
wires = 5
wire_diameter = "0.39 mm"
pitch = "12 mm"
[grip]
length = "0.8 mm"
speed = "20 m/s"
[stop]
strain = 0.07
[output]
samples = 60
snapshots = 6
checkpoint = 150
"#;

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

/// Every file of a run that does not tell the time, by name.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let mut files: BTreeMap<String, Vec<u8>> = entries
        .filter(|entry| entry.path().is_file())
        .map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap()))
        .collect();
    if let Some(summary) = files.get_mut("summary.json") {
        let mut json: serde_json::Value = serde_json::from_slice(summary).unwrap();
        json.as_object_mut().unwrap().remove("cost").unwrap();
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
    let outputs = run::Outputs { frames: false, recording: false, animation: None };
    let identity = run::checkpoint::Identity::new(resolved);
    fs::write(out.join("trajectory.bin.partial"), "").unwrap();
    let mut keeper = run::checkpoint::Keeper::new(&out, loaded.spec.output.checkpoint, identity, outputs, None);
    let now = run::checkpoint::Now {
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
    goes_on_alike(&change("speed = \"20 m/s\"", "speed = \"20 m/s\"\nfree_rotation = true"), 300, 200);
    // One wire, whose contacts come in when it breaks.
    let wire = change("wires = 1", "wires = 1 # alone");
    let second = wire.find("[[strand.layer]]\nwires = 5").unwrap();
    let grip = wire.find("[grip]").unwrap();
    goes_on_alike(&[&wire[..second], &wire[grip..]].concat(), 1300, 400);
}
