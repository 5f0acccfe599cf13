//! A run in files for other programs: read back here, and in the programs themselves (`tests/export/*.py`).
//! `READERS_PYTHON` names a Python that has them; without it those tests say that they were skipped.

#[path = "export/also.rs"]
mod also;
#[path = "export/decode.rs"]
mod decode;
#[path = "export/details.rs"]
mod details;
#[path = "common/drive.rs"]
#[allow(unused, reason = "only the scene of the strand is needed")]
mod drive;
#[path = "common/rows.rs"]
mod rows;

use arrow_array::RecordBatch;
use arrow_array::cast::AsArray;
use arrow_array::types::{Float32Type, Float64Type, Int64Type};
use decode::{Vtp, floats, frames};
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::collections::HashMap;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Arc, OnceLock};
use strandsnap::base::units::{mm, mpa, percent};
use strandsnap::engine::view::{BondState, RunInfo, Rupture, Sample, Snapshot};
use strandsnap::observe::trajectory::{Record, Trajectory};

fn strandsnap(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_strandsnap")).args(arguments).current_dir(folder).output().expect("it starts")
}

fn text(output: &Output) -> String {
    let all = String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
    all.replace(['│', '\n'], " ").split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The folder of a run of a small strand that breaks; made once.
fn run() -> &'static Path {
    static RUN: OnceLock<PathBuf> = OnceLock::new();
    RUN.get_or_init(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("export");
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("strand.toml"), drive::STRAND).unwrap();
        let options = ["--set", "output.snapshots=8", "--set", "output.samples=60", "--no-frames", "--no-recording"];
        let output = strandsnap(&folder, &[&["run", "strand.toml", "--quiet", "--out", "run"][..], &options].concat());
        assert_eq!(output.status.code(), Some(0), "{}", text(&output));
        folder.join("run")
    })
}

/// Exports the run into a new folder.
fn export(format: &str, more: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let output = exported(run(), folder.path(), format, more);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    folder
}

fn exported(run: &Path, out: &Path, format: &str, more: &[&str]) -> Output {
    let paths = [run, out].map(|path| path.to_str().unwrap());
    strandsnap(Path::new("."), &[&["export", paths[0], "--format", format, "--out", paths[1]], more].concat())
}

/// What the trajectory of the run tells.
struct Told {
    info: Arc<RunInfo>,
    samples: Vec<Sample>,
    snapshots: Vec<Snapshot>,
    ruptures: Vec<Rupture>,
}

fn told() -> Told {
    let trajectory = Trajectory::open(&run().join("trajectory.bin")).unwrap();
    let info = trajectory.info().clone();
    let mut told = Told { info, samples: Vec::new(), snapshots: Vec::new(), ruptures: Vec::new() };
    for record in trajectory {
        match record.unwrap() {
            Record::Sample(sample) => told.samples.push(sample),
            Record::Snapshot(snapshot) => told.snapshots.push(snapshot),
            Record::Rupture(rupture) => told.ruptures.push(rupture),
            Record::Notice(_) | Record::Peaks(_) => {}
        }
    }
    assert!(told.snapshots.len() > 4 && told.ruptures.len() > 1, "the strand must break");
    told
}

/// All rows of a table, and the file's own metadata.
fn table(folder: &Path, name: &str) -> (RecordBatch, HashMap<String, String>) {
    let file = File::open(folder.join(format!("{name}.parquet"))).unwrap();
    let reader = ParquetRecordBatchReaderBuilder::try_new(file).unwrap().with_batch_size(1 << 24);
    let schema = reader.schema().clone();
    let about = schema.metadata().clone();
    let batch = reader.build().unwrap().next().unwrap().unwrap();
    (batch, about)
}

fn numbers(batch: &RecordBatch, name: &str) -> Vec<f64> {
    let column = batch.column_by_name(name).unwrap_or_else(|| panic!("no {name}"));
    if let Some(single) = column.as_primitive_opt::<Float32Type>() {
        return single.iter().map(|value| f64::from(value.unwrap())).collect();
    }
    if let Some(counts) = column.as_primitive_opt::<Int64Type>() {
        return counts.iter().map(|value| value.unwrap() as f64).collect();
    }
    column.as_primitive::<Float64Type>().iter().map(|value| value.unwrap()).collect()
}

const TABLES: [&str; 5] = ["curve", "wires", "ruptures", "wire_series", "bond_series"];

#[test]
fn parquet_holds_what_the_trajectory_tells() {
    let folder = export("parquet", &[]);
    let told = told();
    let (curve, about) = table(folder.path(), "curve");
    assert!(about["strandsnap.run"].contains("strand") && about["strandsnap.run_id"].len() == 64, "{about:?}");
    let strain: Vec<f64> = told.samples.iter().map(|s| percent(s.strain)).collect();
    assert_eq!(numbers(&curve, "strain_percent"), strain);
    assert_eq!(numbers(&curve, "work_j"), told.samples.iter().map(|s| s.energy.work).collect::<Vec<_>>());
    let (ruptures, _) = table(folder.path(), "ruptures");
    assert_eq!(numbers(&ruptures, "stress_mpa"), told.ruptures.iter().map(|r| mpa(r.stress)).collect::<Vec<_>>());
    let (wires, _) = table(folder.path(), "wires");
    let broken: Vec<bool> = wires.column_by_name("broken").unwrap().as_boolean().iter().map(Option::unwrap).collect();
    let is_broken = |wire| told.ruptures.iter().any(|rupture| rupture.wire == wire);
    assert_eq!(broken, (0..told.info.wires.len()).map(is_broken).collect::<Vec<_>>());

    let (bonds, _) = table(folder.path(), "bond_series");
    let slots: Vec<usize> = told.info.wires.iter().flat_map(|wire| wire.bonds()).collect();
    assert_eq!(bonds.num_rows(), slots.len() * told.snapshots.len());
    let every = || told.snapshots.iter().flat_map(|snapshot| slots.iter().map(move |slot| (snapshot, *slot)));
    for (axis, name) in ["x_mm", "y_mm", "z_mm"].iter().enumerate() {
        let centre = |(s, slot): (&Snapshot, usize)| {
            let [a, b] = [slot, slot + 1].map(|p| f64::from(s.position[p][axis]));
            f64::from(mm((a + b) / 2.0) as f32)
        };
        assert!(numbers(&bonds, name) == every().map(centre).collect::<Vec<_>>(), "{name}");
    }
    let stress = |(s, slot): (&Snapshot, usize)| f64::from(mpa(f64::from(s.bond_stress[slot])) as f32);
    assert!(numbers(&bonds, "stress_mpa") == every().map(stress).collect::<Vec<_>>());
    let states = bonds.column_by_name("state").unwrap().as_string::<i32>();
    let word = |(s, slot): (&Snapshot, usize)| match s.bond_state[slot] {
        BondState::Whole => "whole",
        BondState::Yielding => "yielding",
        BondState::Broken => "broken",
        BondState::Absent => "absent",
    };
    assert!(states.iter().map(Option::unwrap).eq(every().map(word)));

    let (series, _) = table(folder.path(), "wire_series");
    let stress: Vec<f64> = told.samples.iter().flat_map(|s| s.wire_stress.iter().map(|x| mpa(*x))).collect();
    assert_eq!(numbers(&series, "stress_mpa"), stress);
}

/// The document names every column with its unit.
#[test]
fn the_document_lists_every_column() {
    let folder = export("parquet", &[]);
    let document = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/results/files.md")).unwrap();
    for name in TABLES {
        let section = document.split(&format!("### `{name}`")).nth(1).unwrap_or_else(|| panic!("no {name}"));
        let section = section.split("\n#").next().unwrap();
        for field in table(folder.path(), name).0.schema().fields() {
            // A column for each layer stands there once.
            let shown = match field.name().as_str() {
                "stress_core_mpa" | "stress_outer_mpa" => "stress_LAYER_mpa",
                other => other,
            };
            let row = section.lines().find(|line| line.contains(&format!("| `{shown}` |")));
            let row = row.unwrap_or_else(|| panic!("{name} of the document has no {shown}"));
            let unit = field.metadata().get("unit").map_or("", String::as_str);
            assert_eq!(row.split('|').nth(2).unwrap().trim(), unit, "{name}: {shown}");
        }
    }
}

#[test]
fn vtk_holds_what_the_trajectory_tells() {
    let folder = export("vtk", &[]);
    let told = told();
    for (number, snapshot) in told.snapshots.iter().enumerate() {
        let wires = Vtp::read(&folder.path().join(format!("wires-{number:04}.vtp")));
        let positions: Vec<f32> = snapshot.position.iter().flatten().map(|x| mm(f64::from(*x)) as f32).collect();
        assert!(wires.array::<f32>("Points", "Points") == positions, "positions of snapshot {number}");
        assert_eq!(wires.array::<f32>("PointData", "speed_m_s"), snapshot.speed);
        // Following the lines passes every bond that holds, and no other.
        let (connectivity, offsets) =
            (wires.array::<i64>("Lines", "connectivity"), wires.array::<i64>("Lines", "offsets"));
        let mut passed = vec![false; snapshot.position.len()];
        let mut begin = 0;
        for end in offsets.iter().map(|end| *end as usize) {
            for pair in connectivity[begin..end].windows(2) {
                assert_eq!(pair[1], pair[0] + 1);
                passed[pair[0] as usize] = true;
            }
            begin = end;
        }
        assert!(passed.iter().eq(snapshot.bond_state.iter().map(|state| state.holds()).collect::<Vec<_>>().iter()));

        let bonds = Vtp::read(&folder.path().join(format!("bonds-{number:04}.vtp")));
        let slots: Vec<usize> = told.info.wires.iter().flat_map(|wire| wire.bonds()).collect();
        let states: Vec<u8> = slots.iter().map(|slot| snapshot.bond_state[*slot] as u8).collect();
        assert_eq!(bonds.array::<u8>("CellData", "state"), states);
        let ends: Vec<i64> = slots.iter().flat_map(|slot| [*slot as i64, *slot as i64 + 1]).collect();
        assert_eq!(bonds.array::<i64>("Lines", "connectivity"), ends);
    }
    let index = fs::read_to_string(folder.path().join("wires.pvd")).unwrap();
    for (number, snapshot) in told.snapshots.iter().enumerate() {
        let entry = format!("timestep=\"{:e}\" part=\"0\" file=\"wires-{number:04}.vtp\"", snapshot.sample.time);
        assert!(index.contains(&entry), "{entry} in {index}");
    }
}

/// Numbers in the precision of a snapshot.
fn single(row: &[f64]) -> Vec<f32> {
    row.iter().map(|number| *number as f32).collect()
}

#[test]
fn lammps_and_xyz_hold_what_the_trajectory_tells() {
    let [lammps, xyz] = [export("lammps", &[]), export("xyz", &[])];
    let told = told();
    let read = |folder: &tempfile::TempDir, name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let particles = told.info.particles;
    let atoms = read(&lammps, "particles.dump");
    for (frame, snapshot) in frames(&atoms, "ITEM: TIME\n").zip(&told.snapshots) {
        assert!(frame.contains(&format!("ITEM: TIMESTEP\n{}\n", snapshot.sample.step)));
        let rows = floats(frame.split_once("contact_pressure\n").unwrap().1);
        assert_eq!(rows.len(), particles);
        for (row, (position, radius)) in rows.iter().zip(snapshot.position.iter().zip(&snapshot.radius)) {
            let now = [position[0], position[1], position[2], *radius];
            assert_eq!(single(&row[3..7]), now);
        }
    }
    let bonds = read(&lammps, "bonds.dump");
    for (frame, snapshot) in frames(&bonds, "ITEM: TIME\n").zip(&told.snapshots) {
        let rows = floats(frame.split_once("state\n").unwrap().1);
        assert_eq!(rows.len(), told.info.wires.iter().map(|wire| wire.bonds().len()).sum::<usize>());
        for row in rows {
            let slot = row[1] as usize - 1;
            let now = (snapshot.bond_stress[slot], f64::from(snapshot.bond_state[slot] as u8));
            assert_eq!((row[2] as usize, row[4] as f32, row[7]), (slot + 2, now.0, now.1));
        }
    }
    let data = read(&lammps, "particles.data");
    let rest = floats(data.split_once("Atoms # bond\n\n").unwrap().1.split_once("\n\nBonds").unwrap().0);
    for (row, position) in rest.iter().zip(&told.info.rest_position) {
        assert_eq!(single(&row[3..]), position);
    }
    let text = read(&xyz, "particles.xyz");
    let count = format!("{particles}\n");
    assert_eq!(frames(&text, &count).count(), told.snapshots.len());
    for (frame, snapshot) in frames(&text, &count).zip(&told.snapshots) {
        let (head, rows) = frame.split_once('\n').unwrap();
        assert!(head.contains(&format!("time_s={:e} ", snapshot.sample.time)) && !head.contains("Lattice"), "{head}");
        let columns: usize = head
            .split("Properties=")
            .nth(1)
            .unwrap()
            .split(' ')
            .next()
            .unwrap()
            .split(':')
            .skip(2)
            .step_by(3)
            .map(|number| number.parse::<usize>().unwrap())
            .sum();
        for (row, position) in rows.lines().zip(&snapshot.position) {
            let row: Vec<&str> = row.split(' ').collect();
            assert_eq!(row.len(), columns);
            let shown: Vec<f32> = row[1..4].iter().map(|x| x.parse().unwrap()).collect();
            assert_eq!(shown, position.map(|x| mm(f64::from(x)) as f32));
        }
    }
}

#[test]
fn a_range_of_strain_and_a_stride_choose() {
    let told = told();
    let strains: Vec<f64> = told.snapshots.iter().map(|s| percent(s.sample.strain)).collect();
    let [low, high] = [strains[2], strains[strains.len() - 2]];
    let range = format!("{low}..{high}");
    // A range may round at its ends: what is well inside decides.
    let widened = format!("{}..{}", low - 1e-6, high + 1e-6);
    let folder = export("vtk", &["--strain", &widened, "--stride", "2"]);
    let inside = strains.iter().filter(|strain| (low - 1e-6..=high + 1e-6).contains(*strain)).count();
    let files = fs::read_dir(folder.path())
        .unwrap()
        .filter(|entry| entry.as_ref().unwrap().file_name().to_string_lossy().starts_with("wires-"));
    assert_eq!(files.count(), inside.div_ceil(2), "{range}");
    let folder = export("parquet", &["--strain", &widened]);
    let series = numbers(&table(folder.path(), "wire_series").0, "strain_percent");
    assert!(!series.is_empty() && series.iter().all(|strain| (low - 1e-5..high + 1e-5).contains(strain)));
    assert_eq!(table(folder.path(), "curve").0.num_rows(), told.samples.len(), "tables are whole");
    let out = tempfile::tempdir().unwrap();
    let none = exported(run(), &out.path().join("none"), "xyz", &["--strain", "900..901"]);
    assert_eq!(none.status.code(), Some(2), "{}", text(&none));
    assert!(!out.path().join("none").exists());
}

#[test]
fn earlier_files_are_replaced_only_when_that_is_asked_for() {
    let folder = export("vtk", &[]);
    let at = |name: &str| folder.path().join(name);
    let before = fs::read(at("wires-0000.vtp")).unwrap();
    let refused = exported(run(), folder.path(), "vtk", &["--stride", "3"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused).contains("--overwrite"), "{}", text(&refused));
    fs::write(at("mine.txt"), "kept").unwrap();
    let again = exported(run(), folder.path(), "vtk", &["--stride", "3", "--overwrite"]);
    assert_eq!(again.status.code(), Some(0), "{}", text(&again));
    // The same first snapshot, none of those that the stride leaves out, and what is not an export's.
    assert_eq!(fs::read(at("wires-0000.vtp")).unwrap(), before);
    let kept = told().snapshots.len().div_ceil(3);
    assert!(at(&format!("wires-{:04}.vtp", kept - 1)).exists() && !at(&format!("wires-{kept:04}.vtp")).exists());
    assert_eq!(fs::read_to_string(at("mine.txt")).unwrap(), "kept");
    let hidden = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name().to_string_lossy().starts_with('.');
    assert!(!fs::read_dir(folder.path()).unwrap().any(hidden), "nothing that grew is left");
    // What is no file is not replaced, and then nothing is.
    fs::remove_file(at("bonds-0000.vtp")).unwrap();
    fs::create_dir(at("bonds-0000.vtp")).unwrap();
    let refused = exported(run(), folder.path(), "vtk", &["--overwrite"]);
    assert_eq!(refused.status.code(), Some(2), "{}", text(&refused));
    assert!(text(&refused).contains("a folder") && !at(&format!("wires-{kept:04}.vtp")).exists());
}

#[test]
fn files_that_do_not_agree_are_refused_or_marked() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["scene.toml", "summary.json", "trajectory.bin", "curve.csv", "wires.csv", "ruptures.csv"] {
        fs::copy(run().join(name), folder.path().join(name)).unwrap();
    }
    let curve = fs::read_to_string(folder.path().join("curve.csv")).unwrap();
    fs::write(folder.path().join("curve.csv"), curve + "\n").unwrap();
    let out = folder.path().join("xyz");
    let refused = exported(folder.path(), &out, "xyz", &[]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused).contains("curve.csv was changed") && !out.exists(), "{}", text(&refused));
    let anyway = exported(folder.path(), &out, "xyz", &["--anyway"]);
    assert_eq!(anyway.status.code(), Some(0), "{}", text(&anyway));
    assert!(fs::read_to_string(out.join("particles.xyz")).unwrap().contains("files changed since the run"));
}

/// A Python with the programs that read exports; `None`, said aloud, when there is none.
fn readers(test: &str) -> Option<PathBuf> {
    let python = std::env::var_os("READERS_PYTHON").filter(|python| !python.is_empty());
    if python.is_none() {
        let why = "READERS_PYTHON does not name a Python with pyarrow, pandas, polars, duckdb, vtk and ovito";
        let _ = writeln!(std::io::stderr(), "SKIPPED ({why}): {test}");
    }
    python.map(PathBuf::from)
}

/// Runs a script of `tests/export/`; it ends with 3 where all is well but nothing can be drawn.
fn script(python: &Path, test: &str, name: &str, arguments: &[&Path]) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/export").join(name);
    let output = Command::new(python).arg(script).args(arguments).output().expect("Python starts");
    let said = text(&output);
    if output.status.code() == Some(3) {
        let _ = writeln!(std::io::stderr(), "SKIPPED ({said}): {test}, all but the picture");
        return;
    }
    assert!(output.status.success(), "{}{said}", String::from_utf8_lossy(&output.stderr));
    println!("{said}");
}

/// Where pictures are kept, for people to look at.
fn picture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

#[test]
fn pandas_polars_and_duckdb_read_the_tables() {
    let test = "pandas_polars_and_duckdb_read_the_tables";
    let Some(python) = readers(test) else { return };
    script(&python, test, "parquet_tables.py", &[run(), export("parquet", &[]).path()]);
}

#[test]
fn vtk_opens_and_draws_the_series() {
    let test = "vtk_opens_and_draws_the_series";
    let Some(python) = readers(test) else { return };
    script(&python, test, "vtk_series.py", &[run(), export("vtk", &[]).path(), &picture("vtk.png")]);
}

#[test]
fn ovito_opens_and_draws_the_files() {
    let test = "ovito_opens_and_draws_the_files";
    let Some(python) = readers(test) else { return };
    let [lammps, xyz] = [export("lammps", &[]), export("xyz", &[])];
    script(&python, test, "ovito_files.py", &[run(), lammps.path(), xyz.path(), &picture("ovito.png")]);
}

/// No file may become longer than a limit: every write past it fails, as on a full disk.
#[cfg(target_os = "linux")]
#[test]
fn a_file_that_cannot_grow_has_the_name_that_was_asked_for() {
    for format in ["parquet", "vtk", "lammps", "xyz"] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        // One block of 1024 bytes; the signal would end the program before it can say anything.
        let script = "trap '' XFSZ; ulimit -f 1; exec \"$0\" \"$@\"";
        let mut command = Command::new("bash");
        command.args(["-c", script, env!("CARGO_BIN_EXE_strandsnap"), "export"]).arg(run());
        let output = command.args(["--format", format, "--out"]).arg(&out).output().unwrap();
        let told = text(&output);
        assert_eq!(output.status.code(), Some(1), "{format}: {told}");
        // Long paths are broken into lines.
        let joined = told.replace(' ', "");
        let named = format!("{}/", out.display());
        assert!(joined.contains(&named) && joined.contains("Filetoolarge"), "{format}: {told}");
        assert!(!joined.contains(".strandsnap-"), "{format}: {told}");
        assert!(fs::read_dir(&out).map_or(0, |entries| entries.count()) == 0, "{format}: something is left");
    }
}
