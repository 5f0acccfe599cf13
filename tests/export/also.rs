//! `output.also`: files for other programs that a run makes of itself, and the tables of a study as Parquet.

use super::{strandsnap, text};
use std::fs;
use std::path::Path;

/// A wire of 30 mm that breaks within a tenth of a second.
const WIRE: [&str; 6] = [
    "wire.0.to=[\"0 mm\", \"0 mm\", \"30 mm\"]",
    "grip.length=5 mm",
    "bond.rupture.strain=20 %",
    "grip.speed=20 m/s",
    "output.samples=40",
    "output.snapshots=4",
];

/// Runs the wire into `out`, with more options.
fn wire(folder: &Path, out: &str, more: &[&str]) -> std::process::Output {
    let set: Vec<&str> = WIRE.iter().flat_map(|key| ["--set", key]).collect();
    let command = ["run", "single-wire", "--no-frames", "--no-recording", "--out", out];
    strandsnap(folder, &[&command[..], &set, more].concat())
}

/// Names and contents of a folder's files.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let mut all: Vec<_> = entries
        .filter(|entry| entry.path().is_file())
        .map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap()))
        .collect();
    all.sort();
    all
}

#[test]
fn a_run_makes_the_files_that_an_export_makes() {
    let folder = tempfile::tempdir().unwrap();
    let also = ["--set", "output.also=[\"parquet\", \"xyz\"]"];
    let output = wire(folder.path(), "run", &also);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    assert!(
        text(&output).contains("run/parquet: 5 files") && text(&output).contains("run/xyz: 1 file"),
        "{}",
        text(&output)
    );
    for format in ["parquet", "xyz"] {
        let output = strandsnap(folder.path(), &["export", "run", "--format", format, "--out", "anew"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output));
        assert_eq!(files(&folder.path().join("run").join(format)), files(&folder.path().join("anew")), "{format}");
        fs::remove_dir_all(folder.path().join("anew")).unwrap();
    }
    // A run in place of the first replaces its files too, and a scene keeps the key.
    let first = files(&folder.path().join("run/parquet"));
    let output = wire(folder.path(), "run", &["--set", "output.also=[\"parquet\"]", "--seed", "9", "--overwrite"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let second = files(&folder.path().join("run/parquet"));
    assert!(first.len() == 5 && second.len() == 5 && first != second);
    assert!(!folder.path().join("run/xyz").exists(), "what was exported of the first run is of no other");
    let scene = fs::read_to_string(folder.path().join("run/scene.toml")).unwrap();
    assert!(scene.contains("also = [\"parquet\"]"), "{scene}");
}

#[test]
fn a_run_that_was_interrupted_makes_them_when_it_has_been_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let slow = ["--set", "output.also=[\"lammps\"]", "--set", "grip.speed=5 cm/s", "--time-limit", "0.3s"];
    let output = wire(folder.path(), "run", &slow);
    assert_eq!(output.status.code(), Some(130), "{}", text(&output));
    assert!(!folder.path().join("run/lammps").exists());
    let output = strandsnap(folder.path(), &["resume", "run"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    assert_eq!(files(&folder.path().join("run/lammps")).len(), 3);
}

#[test]
fn what_stands_in_the_way_is_told_before_the_run_and_what_is_not_its_own_stays() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    fs::create_dir_all(run.join("xyz")).unwrap();
    fs::write(run.join("xyz/notes.txt"), "mine").unwrap();
    fs::write(run.join("parquet"), "mine").unwrap();
    let with = |formats: &str| wire(folder.path(), "run", &["--overwrite", "--set", &format!("output.also={formats}")]);
    let output = with("[\"parquet\"]");
    assert_eq!(output.status.code(), Some(2), "{}", text(&output));
    assert!(
        text(&output).contains("run/parquet is not a folder") && !run.join("curve.csv").exists(),
        "{}",
        text(&output)
    );
    let output = with("[\"xyz\"]");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    assert_eq!(fs::read_to_string(run.join("xyz/notes.txt")).unwrap(), "mine");
    assert_eq!(fs::read_to_string(run.join("parquet")).unwrap(), "mine");
    assert!(run.join("xyz/particles.xyz").is_file());
}

#[test]
fn what_is_wrong_in_the_key_is_told_before_anything_is_run() {
    let folder = tempfile::tempdir().unwrap();
    for (value, said) in [
        ("[\"parquet\", \"vtk\", \"parquet\"]", "`also` names \"parquet\" twice"),
        ("[\"csv\"]", "parquet"),
        ("\"parquet\"", "expected an array"),
    ] {
        let output = wire(folder.path(), "run", &["--set", &format!("output.also={value}")]);
        assert_eq!(output.status.code(), Some(2), "{value}: {}", text(&output));
        assert!(text(&output).contains("also") && text(&output).contains(said), "{value}: {}", text(&output));
        assert!(!folder.path().join("run").exists());
    }
}

/// A study of two speeds and two seeds.
const STUDY: &str = r#"
about = "How the speed of the pull changes a wire."
base = "single-wire"
set = ["wire.0.to=[\"0 mm\", \"0 mm\", \"30 mm\"]", "grip.length=5 mm", "bond.rupture.strain=20 %", "stop.stress_fraction=", "stop.strain_after_drop=2 %"]
seeds = 2

[[axis]]
key = "grip.speed"
values = ["15 m/s", "20 m/s"]
"#;

#[test]
fn the_tables_of_a_study_in_pandas_and_polars() {
    let test = "the_tables_of_a_study_in_pandas_and_polars";
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("own.toml"), STUDY).unwrap();
    let output = strandsnap(folder.path(), &["study", "own.toml", "--parquet"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    assert!(text(&output).contains("cases.parquet") && text(&output).contains("breaks.parquet"), "{}", text(&output));
    let out = folder.path().join("out/study/own");
    assert!(files(&out).iter().all(|(name, _)| !name.ends_with(".partial")));
    // With fewer seeds, and without being asked for again, they go along with the CSV files.
    let before = fs::read(out.join("cases.parquet")).unwrap();
    let output = strandsnap(folder.path(), &["study", "own.toml", "--seeds", "1"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    assert_ne!(fs::read(out.join("cases.parquet")).unwrap(), before);
    let output = strandsnap(folder.path(), &["study", "own.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let Some(python) = super::readers(test) else { return };
    super::script(&python, test, "study_tables.py", &[&out]);
}

#[cfg(feature = "record")]
#[test]
fn the_recording_is_a_table_by_the_lines_of_the_document() {
    let test = "the_recording_is_a_table_by_the_lines_of_the_document";
    let Some(python) = super::readers(test) else { return };
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("strand.toml"), crate::drive::STRAND).unwrap();
    let set = ["--set", "output.also=[\"parquet\"]", "--set", "output.samples=60", "--set", "output.snapshots=4"];
    let command = ["run", "strand.toml", "--no-frames", "--quiet", "--out", "run"];
    let output = strandsnap(folder.path(), &[&command[..], &set].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let document = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/results/files.md");
    let run = folder.path().join("run");
    let layer = fs::read_to_string(run.join("wires.csv")).unwrap();
    let layer = layer.lines().nth(2).and_then(|row| row.split(',').nth(1)).unwrap().to_owned();
    let series = run.join("parquet/wire_series.parquet");
    let arguments = [&document, &run.join("recording.rrd"), Path::new(&layer), &series];
    super::script(&python, test, "recording_table.py", &arguments);
}
