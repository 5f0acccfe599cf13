//! Files that were tampered with, folders that are not a run.

use crate::{STRAND, passed, run_into, scene, wrong};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Arc, OnceLock};
use strandsnap::engine::view::{BondState, Snapshot};
use strandsnap::observe::Observer;
use strandsnap::observe::origin::Origin;
use strandsnap::observe::trajectory::{Record, Trajectory, TrajectoryWriter};

/// One run for all tests here; each works on a copy.
fn template() -> &'static Path {
    static RUN: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = RUN.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        run_into(&scene(STRAND, &[]), &folder.path().join("run"));
        folder
    });
    Box::leak(folder.path().join("run").into_boxed_path())
}

/// A copy of a run that broke.
pub struct Copy {
    _folder: tempfile::TempDir,
    /// Its folder.
    pub run: PathBuf,
}

/// A fresh one.
pub fn copy() -> Copy {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    fs::create_dir(&run).unwrap();
    for entry in fs::read_dir(template()).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, run.join(path.file_name().unwrap())).unwrap();
    }
    Copy { _folder: folder, run }
}

impl Copy {
    /// Changes cells of a column, by row from 0.
    fn column(&self, file: &str, head: &str, change: impl Fn(usize, &str) -> String) {
        let path = self.run.join(file);
        let text = fs::read_to_string(&path).unwrap();
        let mut lines = text.lines();
        let heads = lines.next().unwrap();
        let k = heads.split(',').position(|h| h == head).unwrap_or_else(|| panic!("{file} has no {head}: {heads}"));
        let mut out = heads.to_owned() + "\n";
        for (row, line) in lines.enumerate() {
            let mut cells: Vec<String> = line.split(',').map(String::from).collect();
            cells[k] = change(row, &cells[k]);
            out += &(cells.join(",") + "\n");
        }
        fs::write(path, out).unwrap();
    }

    /// Writes the trajectory again with other snapshots.
    fn snapshots(&self, change: impl Fn(&mut Snapshot)) {
        let path = self.run.join("trajectory.bin");
        let old = Trajectory::open(&path).unwrap();
        let info = old.info().clone();
        let records: Vec<Record> = old.map(Result::unwrap).collect();
        let mut writer = TrajectoryWriter::new(&path, Origin::default()).unwrap();
        writer.start(&info).unwrap();
        for record in records {
            match record {
                Record::Sample(sample) => writer.sample(&sample).unwrap(),
                Record::Rupture(rupture) => writer.rupture(&rupture).unwrap(),
                Record::Notice(notice) => writer.notice(&notice).unwrap(),
                Record::Peaks(peaks) => writer.peaks(&peaks).unwrap(),
                Record::Snapshot(mut snapshot) => {
                    change(&mut snapshot);
                    writer.snapshot(&Arc::new(snapshot)).unwrap();
                }
            }
        }
        writer.finish().unwrap();
    }

    fn fails(&self, name: &str) -> bool {
        wrong(&self.run).iter().any(|w| w.starts_with(&format!("{name}: ")))
    }

    fn passes(&self, name: &str) -> bool {
        passed(&self.run).contains(&name)
    }
}

/// Asserts that each of `names` holds of the run as it is, and fails once `change` was made.
fn caught(names: &[&str], change: impl Fn(&Copy)) {
    let copy = copy();
    for name in names {
        assert!(copy.passes(name), "{name} of an honest run: {:?}", wrong(&copy.run));
    }
    change(&copy);
    for name in names {
        assert!(copy.fails(name), "{name} does not see it: {:?}", wrong(&copy.run));
    }
}

#[test]
fn one_digit_of_the_curve() {
    let last_digit = |row: usize, cell: &str| {
        let (head, last) = cell.split_at(cell.len() - 1);
        let other = if last == "3" { "4" } else { "3" };
        if row == 100 { format!("{head}{other}") } else { cell.to_owned() }
    };
    caught(&["curve-trajectory"], |run| run.column("curve.csv", "stress_outer_mpa", |row, cell| last_digit(row, cell)));
    let first_digit = |row: usize, cell: &str| if row == 100 { format!("1{cell}") } else { cell.to_owned() };
    caught(&["curve-trajectory", "stress-unit"], |run| run.column("curve.csv", "stress_mpa", first_digit));
}

#[test]
fn a_file_that_is_not_the_runs_own() {
    let edit = |run: &Copy, file: &str, from: &str, to: &str| {
        let text = fs::read_to_string(run.run.join(file)).unwrap();
        assert!(text.contains(from), "{text}");
        fs::write(run.run.join(file), text.replacen(from, to, 1)).unwrap();
    };
    // The first digit of the seed's line only, so that all else still agrees.
    caught(&["own-files"], |run| edit(run, "scene.toml", "seed = 3", "seed = 2"));
    caught(&["own-files"], |run| edit(run, "summary.json", "\"wall_s\": ", "\"wall_s\": 1"));
    caught(&["own-files"], |run| edit(run, "wires.csv", "yes", "no"));
    caught(&["own-files"], |run| run.snapshots(|_| {}));
}

#[test]
fn the_stress_of_a_broken_bond() {
    let copy = copy();
    let set = |stress: f32| {
        move |snapshot: &mut Snapshot| {
            for (slot, state) in snapshot.bond_state.iter().enumerate() {
                if *state == BondState::Broken {
                    snapshot.bond_stress[slot] = stress;
                }
            }
        }
    };
    copy.snapshots(set(0.0));
    assert!(copy.passes("broken-bonds"), "{:?}", wrong(&copy.run));
    copy.snapshots(set(9614e6));
    assert!(copy.fails("broken-bonds"));
}

#[test]
fn a_bond_above_its_law() {
    // A bond that flows is at its yield stress.
    let more = |snapshot: &mut Snapshot| {
        if let Some(slot) = snapshot.bond_state.iter().position(|state| *state == BondState::Yielding) {
            snapshot.bond_stress[slot] = 500e6;
        }
    };
    caught(&["bond-law"], |run| run.snapshots(more));
}

#[test]
fn strain_that_is_no_percentage() {
    let share = |_: usize, cell: &str| (cell.parse::<f64>().unwrap() * 0.01).to_string();
    caught(&["curve-trajectory", "strain-unit"], |run| run.column("curve.csv", "strain_percent", share));
}

#[test]
fn a_row_out_of_order_and_a_value_that_is_none() {
    let back = |row: usize, cell: &str| if row == 50 { "1".into() } else { cell.to_owned() };
    caught(&["time"], |run| run.column("curve.csv", "step", back));
    let nan = |row: usize, cell: &str| if row == 50 { "NaN".into() } else { cell.to_owned() };
    caught(&["finite", "curve-trajectory"], |run| run.column("curve.csv", "torque_n_mm", nan));
}

#[test]
fn breaks_that_are_not_counted() {
    let less = |row: usize, cell: &str| if row == 0 { "no".into() } else { cell.replace("yes", "no") };
    caught(&["break-counts", "wires-rows"], |run| run.column("wires.csv", "broken", less));
    let zero = |_: usize, _: &str| "0".to_owned();
    caught(&["breaks-by-row"], |run| run.column("curve.csv", "bonds_broken", zero));
    let later = |_: usize, cell: &str| format!("{cell}1");
    caught(&["ruptures-trajectory"], |run| run.column("ruptures.csv", "stress_mpa", later));
}

#[test]
fn work_that_was_not_done() {
    let twice = |_: usize, cell: &str| (2.0 * cell.parse::<f64>().unwrap()).to_string();
    caught(&["work", "energy-ledger"], |run| run.column("curve.csv", "work_j", twice));
}

#[test]
fn a_summary_of_another_strength() {
    caught(&["strength", "summary-rows"], |run| {
        let path = run.run.join("summary.json");
        let mut summary: serde_json::Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
        let strength = summary["greatest_stress_mpa"].as_f64().unwrap();
        summary["greatest_stress_mpa"] = (0.99 * strength).into();
        summary["residual_stress_mpa"] = 1.0.into();
        fs::write(&path, summary.to_string()).unwrap();
    });
}

#[test]
fn a_page_of_another_run() {
    let other = tempfile::tempdir().unwrap();
    run_into(&scene(STRAND, &["seed=4", "grip.speed=9 m/s"]), &other.path().join("run"));
    caught(&["page"], |run| {
        fs::copy(other.path().join("run/report.html"), run.run.join("report.html")).unwrap();
    });
}

#[cfg(feature = "record")]
#[test]
fn a_recording_of_another_run() {
    let other = tempfile::tempdir().unwrap();
    run_into(&scene(STRAND, &["seed=4"]), &other.path().join("run"));
    caught(&["recording"], |run| {
        fs::copy(other.path().join("run/recording.rrd"), run.run.join("recording.rrd")).unwrap();
    });
}

fn command(run: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_strandsnap")).arg("check-run").arg(run).args(more).output().unwrap()
}

#[test]
fn the_command_says_what_fails_and_exits_with_4() {
    let copy = copy();
    copy.column("curve.csv", "stress_mpa", |row, cell| if row == 9 { format!("1{cell}") } else { cell.to_owned() });
    let json = copy.run.join("found.json");
    let output = command(&copy.run, &["--json", json.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(4));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("FAILED curve-trajectory") && text.contains("curve.csv line 11, stress_mpa"), "{text}");
    let rows: serde_json::Value = serde_json::from_str(&fs::read_to_string(json).unwrap()).unwrap();
    let row = rows.as_array().unwrap().iter().find(|row| row["invariant"] == "stress-unit").unwrap();
    assert_eq!((row["outcome"].as_str(), row["unit"].as_str()), (Some("failed"), Some("-")));
    assert!(row["worst"].as_f64().unwrap() > row["allowed"].as_f64().unwrap());
}

#[test]
fn the_command_exits_with_0_on_an_honest_run() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    run_into(&scene(STRAND, &["bond.rupture="]), &out);
    let output = command(&out, &[]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stdout));
    assert!(String::from_utf8_lossy(&output.stdout).contains("invariants hold"));
}

#[test]
fn what_is_no_run_is_refused_with_2() {
    let refused = |run: &Path, words: &[&str]| {
        let output = command(run, &[]);
        let text = String::from_utf8_lossy(&output.stderr).replace(['\n', '│'], " ");
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(output.status.code(), Some(2), "{text}");
        words.iter().for_each(|word| assert!(text.contains(word), "{word}: {text}"));
    };
    let empty = tempfile::tempdir().unwrap();
    refused(empty.path(), &["holds no scene.toml", "no curve.csv"]);
    refused(&empty.path().join("nowhere"), &["does not exist"]);
    let cut = copy();
    fs::rename(cut.run.join("curve.csv"), cut.run.join("curve.csv.partial")).unwrap();
    refused(&cut.run, &["has not ended", "curve.csv is unfinished", "run the scene again"]);
    fs::rename(cut.run.join("trajectory.bin"), cut.run.join("trajectory.bin.partial")).unwrap();
    refused(&cut.run, &["trajectory.bin and curve.csv are unfinished", "no checkpoint"]);
    fs::write(cut.run.join("checkpoint-1.bin"), "").unwrap();
    refused(&cut.run, &["strandsnap resume"]);
    let foreign = copy();
    fs::write(foreign.run.join("trajectory.bin"), "nothing of the kind").unwrap();
    refused(&foreign.run, &["trajectory.bin", "damaged"]);
    let words = copy();
    words.column("curve.csv", "time_s", |row, cell| if row == 4 { "soon".into() } else { cell.to_owned() });
    refused(&words.run, &["line 6", "time_s", "`soon` is no number"]);
    let short = copy();
    let bytes = fs::read(short.run.join("trajectory.bin")).unwrap();
    fs::write(short.run.join("trajectory.bin"), &bytes[..bytes.len() / 2]).unwrap();
    refused(&short.run, &["trajectory.bin", "damaged"]);
}
