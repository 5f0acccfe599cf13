//! `strandsnap verify` as a user runs it: exit codes, files, messages.

#[path = "common/program.rs"]
mod program;

use program::{strandsnap, text};
use std::path::Path;
use std::process::Output;

fn verify(folder: &Path, args: &[&str]) -> Output {
    strandsnap(folder, &[&["verify"], args].concat())
}

#[test]
fn verify_writes_table_json_and_plots() {
    let folder = tempfile::tempdir().unwrap();
    let output = verify(folder.path(), &["hertz", "bond-bent", "--quick", "--json", "results/found.json"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    for part in ["contact time [s]", "2.01 (2.00)", "plastic moment [N m]", "2 of 2 cases agree"] {
        assert!(table.contains(part), "{part} is not in\n{table}");
    }
    let json = std::fs::read_to_string(folder.path().join("results/found.json")).unwrap();
    let rows: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(rows.as_array().unwrap().iter().all(|row| row["outcome"] == "pass"), "{json}");
    for file in ["hertz.svg", "hertz.png"] {
        assert!(folder.path().join("out/verify").join(file).metadata().unwrap().len() > 1000, "{file}");
    }
}

#[test]
fn verify_refuses_what_it_does_not_know_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let output = verify(folder.path(), &["hertzz"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("did you mean `hertz`?"), "{}", text(&output.stderr));
    let output = verify(folder.path(), &["hertz", "--quick", "--no-plots", "--json", "."]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn verify_lists_cases_with_their_sources() {
    let output = verify(Path::new("."), &["--list"]);
    let list = text(&output.stdout);
    assert!(output.status.success() && list.contains("hertz ") && list.contains("Johnson"), "{list}");
}

/// Their scenes come with the program, and run like any other.
#[test]
fn verification_scenes_are_found_from_anywhere() {
    let folder = tempfile::tempdir().unwrap();
    let output = strandsnap(folder.path(), &["scene", "check", "verify/hertz"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

/// One that is killed goes on with the cases that are left, and one that came to its end leaves nothing to go on with.
#[test]
fn verify_goes_on_where_it_was_killed() {
    let folder = tempfile::tempdir().unwrap();
    let known = ["hertz", "thornton", "capstan", "bond-bent", "bond-twisted"];
    let args = [&known[..], &["--quick", "--threads", "1"]].concat();
    let kept = folder.path().join("out/verify/unfinished-verify");
    // A case counts once its record is there, which comes last.
    let within = |folder| std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let count = || within(kept.clone()).flat_map(within).filter(|case| case.join("case.json").is_file()).count();
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_strandsnap"))
        .args([&["verify"], &args[..]].concat())
        .current_dir(folder.path())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    while count() == 0 && child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!((1..known.len()).contains(&count()), "it was not killed in the middle of its cases");
    let again = verify(folder.path(), &args);
    let told = text(&again.stderr);
    assert!(again.status.success(), "{told}{}", text(&again.stdout));
    assert!(told.contains(&format!(" of {} cases were finished before", known.len())), "{told}");
    assert!(text(&again.stdout).contains(&format!("{0} of {0} cases agree", known.len())), "{}", text(&again.stdout));
    assert!(!kept.exists(), "what is over is not gone on with");
    let third = verify(folder.path(), &args);
    assert!(!text(&third.stderr).contains("finished before"), "{}", text(&third.stderr));
}
