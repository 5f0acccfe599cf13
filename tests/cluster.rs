//! Studies as arrays of batch systems, with the real ones (Debian's `slurm-wlm`, `munge` and `parallel`).

use std::path::Path;
use std::process::Command;

const PROGRAM: &str = env!("CARGO_BIN_EXE_strandsnap");

fn is_there(program: &str) -> bool {
    let folders = ["/usr/sbin", "/usr/bin", "/sbin", "/usr/local/bin"];
    folders.iter().any(|folder| Path::new(folder).join(program).is_file())
}

#[test]
fn a_study_runs_as_an_array_of_slurm_of_which_a_node_dies() {
    let missing: Vec<&str> = ["slurmctld", "slurmd", "munged"].into_iter().filter(|name| !is_there(name)).collect();
    if !missing.is_empty() {
        println!("SKIPPED (a_study_runs_as_an_array_of_slurm_of_which_a_node_dies: no {})", missing.join(", "));
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cluster/slurm.sh");
    let ran = Command::new("bash").arg(script).arg(PROGRAM).arg(folder.path().join("slurm")).output().unwrap();
    let said = String::from_utf8_lossy(&ran.stdout);
    println!("{said}");
    if ran.status.code() == Some(75) {
        println!("SKIPPED (a_study_runs_as_an_array_of_slurm_of_which_a_node_dies: its daemons do not come up here)");
        return;
    }
    assert!(ran.status.success(), "{said}\n{}", String::from_utf8_lossy(&ran.stderr));
    assert!(said.contains("50 cases of 50 are there"), "{said}");
}

/// A table but for what its cases took.
fn without_times(path: &Path) -> Vec<Vec<String>> {
    let mut table = csv::ReaderBuilder::new().has_headers(false).from_path(path).unwrap();
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let kept: Vec<usize> = (0..rows[0].len()).filter(|k| !rows[0][*k].ends_with("[s]")).collect();
    rows.iter().map(|row| kept.iter().map(|k| row[*k].to_owned()).collect()).collect()
}

const MANY: &str = r#"
about = "Some short wires."
base = "single-wire"
set = ["wire.0.to=[\"0 mm\", \"0 mm\", \"10 mm\"]", "grip.length=2 mm", "bond.rupture.strain=20 %", "stop.stress_fraction=", "stop.strain_after_drop=2 %"]
seeds = 3

[[axis]]
key = "grip.speed"
values = ["20 m/s", "30 m/s"]
"#;

#[test]
fn a_study_runs_side_by_side_with_gnu_parallel_and_what_failed_is_tried_again() {
    if !is_there("parallel") {
        println!("SKIPPED (a_study_runs_side_by_side_with_gnu_parallel_and_what_failed_is_tried_again: no parallel)");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("many.toml"), MANY).unwrap();
    let study = |rest: &[&str]| {
        let ran =
            Command::new(PROGRAM).args(["study", "many.toml"]).args(rest).current_dir(folder.path()).output().unwrap();
        assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
        String::from_utf8(ran.stdout).unwrap()
    };
    study(&["--out", "here"]);
    // One of them is there already.
    study(&["--out", "there", "--case", "2"]);
    let said = study(&["--out", "there", "--emit", "gnu-parallel"]);
    assert!(said.contains("5 cases to run") && said.contains("bash cases.sh"), "{said}");
    let cluster = folder.path().join("there/cluster");
    let ran = Command::new("bash").arg("cases.sh").current_dir(&cluster).output().unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    let mut tables = 0;
    for entry in std::fs::read_dir(folder.path().join("here")).unwrap().flatten() {
        let name = entry.file_name().into_string().unwrap();
        if name.ends_with(".csv") {
            let read = |out: &str| without_times(&folder.path().join(out).join(&name));
            assert_eq!(read("here"), read("there"), "{name}");
            tables += 1;
        }
    }
    assert_eq!(tables, 3);
    let said = study(&["--out", "there", "--emit", "slurm"]);
    assert!(said.contains("All 6 cases are there"), "{said}");
    // Again with one that is missing, in a folder whose name means something to parallel.
    std::fs::rename(folder.path().join("there"), folder.path().join("{} it's")).unwrap();
    let inside = |folder: &Path| std::fs::read_dir(folder).unwrap().next().unwrap().unwrap().path();
    std::fs::remove_dir_all(inside(&inside(&folder.path().join("{} it's/cases")))).unwrap();
    let said = study(&["--out", "{} it's", "--emit", "gnu-parallel"]);
    assert!(said.contains("1 case to run"), "{said}");
    let ran = Command::new("bash").arg(folder.path().join("{} it's/cluster/cases.sh")).output().unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    let said = study(&["--out", "{} it's", "--emit", "slurm"]);
    assert!(said.contains("All 6 cases are there"), "{said}");
}
