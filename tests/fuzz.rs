//! Inputs made at random from good ones: none may panic, hang or take more than a bound. What once went wrong stands in
//! `tests/scenes/bad` with its message.
//!
//! `cargo test --release --test fuzz -- --ignored` looks at fifty times as many.

mod synthetic;

use lz4_flex::frame::{FrameDecoder, FrameEncoder, FrameInfo};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{Config, FileFailurePersistence, RngAlgorithm, TestRng, TestRunner};
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use strandsnap::base::error::Error;
use strandsnap::engine::Engine;
use strandsnap::engine::view::{RunInfo, Sample};
use strandsnap::observe::Observer;
use strandsnap::observe::origin::Origin;
use strandsnap::observe::trajectory::{Trajectory, TrajectoryWriter};
use strandsnap::page::{self, Source};
use strandsnap::run::folder::SLOTS;
use strandsnap::run::{Resumable, RunOptions, assemble, cautions, run_watched};
use strandsnap::scene::plan::Plan;
use strandsnap::scene::{self, builtin, centreline_text, write};
use strandsnap::study::sweep::{Changes, Definition, definition};

/// Inputs of each kind in every run of the tests: 2,000 in all.
const SCENES: u32 = 1200;
const POINTS: u32 = 300;
const STUDIES: u32 = 150;
const TRAJECTORIES: u32 = 150;
const CHECKPOINTS: u32 = 100;
const COMMANDS: u32 = 100;
/// How many times as many are looked at when asked for.
const MORE: u32 = 50;
/// Memory that a scene may take here (bytes): small ones are built and stepped, others refused by their size.
const MEMORY: u64 = 4_000_000;
/// Longest time for one input: generous, for builds that are not optimised on machines that do other things.
const BOUND: Duration = Duration::from_secs(60);

/// What stands for a value: extremes of size, and of kind.
const VALUES: [&str; 46] = [
    "0",
    "-1",
    "1",
    "2",
    "7",
    "1e-300",
    "1e-9",
    "0.5",
    "1.5",
    "1e9",
    "1e18",
    "1e308",
    "-1e308",
    "nan",
    "inf",
    "-inf",
    "9223372036854775807",
    "-9223372036854775808",
    "4294967296",
    "65536",
    "true",
    "\"\"",
    "\"inf\"",
    "\"auto\"",
    "\"nan mm\"",
    "\"1e18 mm\"",
    "\"1e-18 mm\"",
    "\"-5 mm\"",
    "\"120 m\"",
    "\"0.1 mm\"",
    "\"1e300 GPa\"",
    "\"1e-300 GPa\"",
    "\"100 GPa\"",
    "\"5 m/s\"",
    "\"1e30 m/s\"",
    "\"1 ns\"",
    "\"1e-300 s\"",
    "\"20 %\"",
    "\"10000 %\"",
    "\"\\u0000µ\\n\"",
    "[]",
    "[1, 2, 3]",
    "[[[[[[[[[[[[]]]]]]]]]]]]",
    "[\"1 mm\", \"1e18 mm\", \"-1e18 mm\"]",
    "{}",
    "1979-05-27T07:32:00Z",
];

/// A change of a text.
#[derive(Debug, Clone)]
enum Change {
    /// Another value behind a `=`.
    Value(Index, usize),
    /// A line less, twice, or in another place.
    Drop(Index),
    Double(Index),
    Move(Index, Index),
    /// A line of another text.
    Graft(Index, Index),
    /// A byte more, or all bytes less from here.
    Byte(Index, u8),
    Cut(Index),
}

fn change() -> impl Strategy<Value = Change> {
    let at = any::<Index>;
    prop_oneof![
        12 => (at(), 0..VALUES.len()).prop_map(|(at, value)| Change::Value(at, value)),
        2 => at().prop_map(Change::Drop),
        1 => at().prop_map(Change::Double),
        1 => (at(), at()).prop_map(|(from, to)| Change::Move(from, to)),
        2 => (at(), at()).prop_map(|(at, of)| Change::Graft(at, of)),
        1 => (at(), any::<u8>()).prop_map(|(at, byte)| Change::Byte(at, byte)),
        1 => at().prop_map(Change::Cut),
    ]
}

fn changed(text: &str, all: &[String], changes: &[Change]) -> String {
    let mut lines: Vec<String> = text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect();
    for change in changes {
        if lines.is_empty() {
            break;
        }
        let n = lines.len();
        match change {
            Change::Value(at, value) => {
                let keys: Vec<usize> = (0..n).filter(|k| lines[*k].contains('=')).collect();
                if let Some(k) = (!keys.is_empty()).then(|| keys[at.index(keys.len())]) {
                    // Of an inline table, any of its values.
                    let places: Vec<usize> = lines[k].match_indices('=').map(|(i, _)| i + 1).collect();
                    let from = places[at.index(places.len())];
                    let rest = &lines[k][from..];
                    let inline = places.len() > 1 && places[0] != from;
                    let to = if inline {
                        rest.find([',', '}']).map_or(lines[k].len(), |end| from + end)
                    } else {
                        lines[k].len()
                    };
                    lines[k].replace_range(from..to, &format!(" {} ", VALUES[*value]));
                }
            }
            Change::Drop(at) => drop(lines.remove(at.index(n))),
            Change::Double(at) => lines.insert(at.index(n), lines[at.index(n)].clone()),
            Change::Move(from, to) => {
                let line = lines.remove(from.index(n));
                lines.insert(to.index(n), line);
            }
            Change::Graft(at, of) => {
                let others: Vec<&str> = all[of.index(all.len())].lines().filter(|line| !line.is_empty()).collect();
                lines.insert(at.index(n + 1), others[at.index(others.len())].to_owned());
            }
            Change::Byte(at, byte) => {
                let mut bytes = lines.join("\n").into_bytes();
                bytes.insert(at.index(bytes.len() + 1), *byte);
                lines = String::from_utf8_lossy(&bytes).lines().map(str::to_owned).collect();
            }
            Change::Cut(at) => {
                let mut bytes = lines.join("\n").into_bytes();
                bytes.truncate(at.index(bytes.len() + 1));
                lines = String::from_utf8_lossy(&bytes).lines().map(str::to_owned).collect();
            }
        }
    }
    lines.join("\n") + "\n"
}

/// The input in hand, and since when: whoever takes too long ends the tests with it in words.
static NOW: Mutex<Option<(Instant, String)>> = Mutex::new(None);

fn watch() {
    static STARTED: std::sync::Once = std::sync::Once::new();
    STARTED.call_once(|| {
        std::thread::spawn(|| {
            loop {
                std::thread::sleep(Duration::from_secs(1));
                let now = NOW.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                if let Some((_, input)) = now.as_ref().filter(|(begin, _)| begin.elapsed() > BOUND) {
                    // Straight to standard error: what a test prints is kept back until it ends.
                    let _ = writeln!(std::io::stderr(), "longer than {BOUND:?}:\n{input}");
                    std::process::abort();
                }
            }
        });
    });
}

/// Shows `look` inputs, each by itself, always the same ones; what fails is made smaller before it is told.
fn each<S: Strategy>(count: u32, strategy: S, text: impl Fn(&S::Value) -> String, look: impl Fn(S::Value))
where
    S::Value: Clone,
{
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _turn = ONE_AT_A_TIME.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    watch();
    let persistence: Option<Box<FileFailurePersistence>> = None;
    let config = Config { cases: count, failure_persistence: persistence.map(|p| p as _), ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let set = |to| *NOW.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = to;
    let done = runner.run(&strategy, |input| {
        set(Some((Instant::now(), text(&input))));
        look(input.clone());
        set(None);
        Ok(())
    });
    if let Err(proptest::test_runner::TestError::Fail(why, input)) = &done {
        panic!("{why}\n{}", text(input));
    }
    done.unwrap_or_else(|error| panic!("{error}"));
}

/// An error is one that its user can act on, in words that are not this program's.
fn is_for_people(error: &Error) {
    let message = error.to_string();
    for word in ["Raw", "struct ", "i64", "u64", "usize", "f64", "enum ", "untagged"] {
        assert!(!message.contains(word), "`{word}` in: {message}");
    }
    assert!([1, 2, 4].contains(&error.exit_code()), "{message}");
}

fn scene_is_harmless(text: &str) {
    let mut scene = match scene::parse(text, "fuzz.toml", Path::new("tests/scenes/good"), &[]) {
        Ok(scene) => scene,
        Err(error) => return is_for_people(&error),
    };
    scene.memory = Some(MEMORY);
    assert!(!Plan::new(&scene.spec).to_string().is_empty());
    let again = scene::parse(&write::to_toml(&scene.spec), "scene.toml", Path::new("."), &[]);
    let again = again.unwrap_or_else(|error| panic!("what was resolved cannot be read: {error}")).spec;
    assert_eq!(Origin::of(&again), Origin::of(&scene.spec), "what was resolved reads back as another scene");
    let assembly = match assemble(&scene) {
        Ok(assembly) => assembly,
        Err(error) => return is_for_people(&error),
    };
    let _ = cautions::of_scene(&scene, &assembly);
    match Engine::new(&scene.spec, &scene.plan, assembly) {
        Ok(mut engine) => {
            for _ in 0..3 {
                if let Err(error) = engine.step() {
                    is_for_people(&error);
                    break;
                }
            }
        }
        Err(error) => is_for_people(&error),
    }
}

fn scenes(count: u32) {
    let good = std::fs::read_dir("tests/scenes/good").unwrap().map(|entry| entry.unwrap().path());
    let mut good: Vec<_> = good.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    good.sort();
    let shipped = builtin::list().iter().map(|(_, text)| text.to_string());
    let all: Vec<String> = good.iter().map(|path| std::fs::read_to_string(path).unwrap()).chain(shipped).collect();
    let strategy = (any::<Index>(), prop::collection::vec(change(), 1..5));
    let text = |(of, changes): &(Index, Vec<Change>)| changed(&all[of.index(all.len())], &all, changes);
    each(count, strategy, text, |input| scene_is_harmless(&text(&input)));
}

fn points(count: u32) {
    let good = "# wire 1 layer inner diameter 0.39 mm\n0 0 0\n0 0.1 1\n0 0 2\n\n# wire 2\n1 0 0\n1,5 0 1\n1 0 2\n";
    let words = [
        "0",
        "1e30",
        "nan",
        "inf",
        "-1e-300",
        ",",
        ";",
        "\t",
        "#",
        "# wire x diameter -1 mm",
        "\u{feff}",
        "é",
        "1,5",
        "1e",
        "\n\n",
    ];
    let edit = (any::<Index>(), 0..words.len(), any::<bool>());
    let text = |edits: &Vec<(Index, usize, bool)>| {
        let mut text: Vec<char> = good.chars().collect();
        for (at, word, replace) in edits {
            let k = at.index(text.len());
            text.splice(k..k + usize::from(*replace), words[*word].chars());
        }
        text.into_iter().collect::<String>()
    };
    each(count, prop::collection::vec(edit, 1..12), text, |edits| {
        let text = text(&edits);
        for bytes in [text.as_bytes().to_vec(), text.bytes().map(|b| b.wrapping_add(128)).collect()] {
            let Some(text) = centreline_text::decode(&bytes) else { continue };
            if let Err(error) = centreline_text::parse(&text, Path::new("points.txt")) {
                is_for_people(&error);
            }
        }
    });
}

fn studies(count: u32) {
    // Looking for a good design takes minutes without optimisation.
    let quick = |text: &&str| !cfg!(debug_assertions) || !text.contains("[design]");
    let all: Vec<String> = definition::STUDIES.iter().map(|(_, text)| *text).filter(quick).map(str::to_owned).collect();
    let text = |(of, changes): &(Index, Vec<Change>)| changed(&all[of.index(all.len())], &all, changes);
    let strategy = (any::<Index>(), prop::collection::vec(change(), 1..5));
    each(count, strategy, text, |input| {
        match Definition::parse(&text(&input), "fuzz.toml", Path::new("."), &Changes::default()) {
            Ok(definition) => drop(definition.cases()),
            Err(error) => is_for_people(&error),
        }
    });
}

/// Bytes that are changed before they are packed behind a head, so that checksums of the packing do not help, or after that.
#[derive(Debug, Clone)]
struct Damage {
    edits: Vec<(usize, u8, u8)>,
    packed: bool,
}

fn damage() -> impl Strategy<Value = Damage> {
    // Lengths and counts stand at the beginning of records.
    let place = prop_oneof![3 => (0_usize..400).boxed(), 1 => any::<Index>().prop_map(|at| at.index(1 << 20)).boxed()];
    (prop::collection::vec((place, any::<u8>(), 0..3_u8), 1..5), any::<bool>())
        .prop_map(|(edits, packed)| Damage { edits, packed })
}

impl Damage {
    /// What becomes of a file with a head of so many bytes.
    fn of(&self, bytes: &[u8], head: usize) -> Vec<u8> {
        let mut changed = bytes.to_vec();
        if !self.packed {
            changed.clear();
            FrameDecoder::new(&bytes[head..]).read_to_end(&mut changed).unwrap();
        }
        for (at, byte, kind) in &self.edits {
            let at = at % changed.len();
            match kind {
                0 => changed[at] = *byte,
                1 => changed.insert(at, *byte),
                _ => changed.truncate(at + 1),
            }
        }
        if self.packed {
            return changed;
        }
        let mut encoder = FrameEncoder::with_frame_info(FrameInfo::new(), bytes[..head].to_vec());
        encoder.write_all(&changed).unwrap();
        encoder.finish().unwrap()
    }
}

fn trajectories(count: u32) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("trajectory.bin");
    let spec = scene::load("strand-1x7", &[]).unwrap().spec;
    synthetic::Run::new(2).show(&mut TrajectoryWriter::new(&file, Origin::of(&spec)).unwrap()).unwrap();
    std::fs::write(folder.path().join("scene.toml"), write::to_toml(&spec)).unwrap();
    let bytes = std::fs::read(&file).unwrap();
    each(
        count,
        damage(),
        |input| format!("{input:?}"),
        |damage| {
            std::fs::write(&file, damage.of(&bytes, 16 + Origin::LEN)).unwrap();
            if let Ok(trajectory) = Trajectory::open(&file) {
                assert!(trajectory.count() < 1_000_000);
            }
            if let Ok(source) = Source::read(folder.path()) {
                page::html(&source).unwrap();
            }
        },
    );
}

/// A run that was interrupted goes on from a checkpoint of its own, or says why it cannot.
fn checkpoints(count: u32) {
    let folder = tempfile::tempdir().unwrap();
    let (base, out) = (folder.path().join("base"), folder.path().join("out"));
    let set = ["strand.length=10 mm", "grip.length=2 mm", "stop.steps=60", "output.checkpoint=20", "output.samples=6"];
    let scene = scene::load("strand-1x7", &set.map(String::from)).unwrap();
    let stop = AtomicBool::new(false);
    let options = RunOptions { threads: Some(1), ..RunOptions::tables(&base) };
    run_watched(&scene, &options, vec![&mut StopsAt { step: 40, stop: &stop }], &stop).unwrap();
    let slots = SLOTS.map(|name| base.join(name));
    let slot = slots.iter().find(|slot| slot.is_file()).expect("an interrupted run keeps a checkpoint");
    let bytes = std::fs::read(slot).unwrap();
    each(
        count,
        damage(),
        |input| format!("{input:?}"),
        |damage| {
            let _ = std::fs::remove_dir_all(&out);
            std::fs::create_dir(&out).unwrap();
            for file in std::fs::read_dir(&base).unwrap().map(|file| file.unwrap().path()) {
                if !slots.contains(&file) {
                    std::fs::copy(&file, out.join(file.file_name().unwrap())).unwrap();
                }
            }
            std::fs::write(out.join(SLOTS[0]), damage.of(&bytes, 16)).unwrap();
            let resumed = Resumable::open(&out, Some(1), None);
            if let Err(error) = resumed.and_then(|run| run.go_on(&|_| {}, Vec::new(), &AtomicBool::new(true))) {
                is_for_people(&error);
            }
        },
    );
}

/// Ends a run at a step.
struct StopsAt<'a> {
    step: u64,
    stop: &'a AtomicBool,
}

impl Observer for StopsAt<'_> {
    fn start(&mut self, _info: &Arc<RunInfo>) -> Result<(), Error> {
        Ok(())
    }
    fn sample(&mut self, sample: &Sample) -> Result<(), Error> {
        self.stop.fetch_or(sample.step >= self.step, Ordering::Relaxed);
        Ok(())
    }
    fn finish(&mut self) -> Result<(), Error> {
        Ok(())
    }
}

fn commands(count: u32) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("text.txt"), "0 0 0\n0 0 1\n").unwrap();
    let words = [
        "scene",
        "check",
        "show",
        "keys",
        "list",
        "plan",
        "run",
        "render",
        "record",
        "report",
        "view",
        "export",
        "check-run",
        "single-wire",
        "two-spheres",
        "--set",
        "--set",
        "stop.steps=2",
        "seed=-1",
        "a.b.c=[",
        "=",
        "--seed",
        "18446744073709551615",
        "--out",
        "x",
        ".",
        "/dev/null",
        "/dev/zero",
        "text.txt",
        "--threads",
        "1",
        "1000",
        "65536",
        "--quiet",
        "--no-frames",
        "--no-recording",
        "--overwrite",
        "--azimuth",
        "nan",
        "--zoom",
        "1e30",
        "--focus-z",
        "inf",
        "--size",
        "16x16",
        "99999999x1",
        "--memory",
        "1MB",
        "-1",
        "",
        "\u{fffd}",
        "--quality",
        "fine",
        "--json",
        "--anyway",
        "--format",
        "lammps",
        "centrelines",
    ];
    // A command first, or hardly anything is looked at.
    let strategy = (0..13_usize, prop::collection::vec(0..words.len(), 0..8));
    let arguments = |(first, others): &(usize, Vec<usize>)| {
        let all = std::iter::once(first).chain(others).map(|k| words[*k]);
        all.map(str::to_owned).collect::<Vec<String>>()
    };
    each(
        count,
        strategy,
        |input| arguments(input).join(" "),
        |input| {
            // Every run is short: the last `--set` wins.
            let mut arguments = arguments(&input);
            if ["run", "plan"].contains(&arguments[0].as_str()) {
                arguments.extend(["--set".into(), "stop.steps=2".into()]);
            }
            let mut child = Command::new(env!("CARGO_BIN_EXE_strandsnap"))
                .args(&arguments)
                .current_dir(folder.path())
                .env("RERUN_CLI", "/bin/false")
                .stdin(Stdio::null())
                .stdout(Stdio::null())
                .stderr(Stdio::piped())
                .spawn()
                .unwrap();
            let mut told = String::new();
            child.stderr.take().unwrap().read_to_string(&mut told).unwrap();
            let code = child.wait().unwrap().code();
            assert!(code.is_some_and(|code| [0, 1, 2, 3, 4].contains(&code)), "{code:?}: {told}");
            assert!(!told.contains("panicked"), "{told}");
        },
    );
}

#[test]
fn scenes_at_random() {
    scenes(SCENES);
}

#[test]
fn centre_points_at_random() {
    points(POINTS);
}

#[test]
fn studies_at_random() {
    studies(STUDIES);
}

#[test]
fn trajectories_at_random() {
    trajectories(TRAJECTORIES);
}

#[test]
fn checkpoints_at_random() {
    checkpoints(CHECKPOINTS);
}

#[test]
fn command_lines_at_random() {
    commands(COMMANDS);
}

#[test]
#[ignore = "100,000 inputs: for a release build, on request"]
fn many_more_at_random() {
    scenes(MORE * SCENES);
    points(MORE * POINTS);
    studies(MORE * STUDIES);
    trajectories(MORE * TRAJECTORIES);
    checkpoints(MORE * CHECKPOINTS);
    commands(MORE * COMMANDS);
}
