//! `strandsnap accuracy` as a user runs it: what it writes, how it goes on after an interruption, what it refuses.

#[path = "common/program.rs"]
mod program;
#[path = "common/rows.rs"]
mod rows;

use program::{printed, strandsnap, text};
use rows::{number, rows};
use std::path::Path;
use std::process::Output;

/// A wire of 30 mm: a run takes a tenth of a second.
/// Short, and weak enough to break before the scene's limit on strain.
const WIRE: [&str; 8] = [
    "single-wire",
    "--set",
    "wire.0.to=[\"0 mm\", \"0 mm\", \"30 mm\"]",
    "--set",
    "grip.length=5 mm",
    "--set",
    "bond.rupture.strain=29 %",
    "--threads=1",
];

fn accuracy(folder: &Path, scene: &[&str], args: &[&str]) -> Output {
    strandsnap(folder, &[&["accuracy"], scene, args].concat())
}

#[test]
fn a_wire_is_compared_with_its_closed_form_and_a_second_study_makes_no_run() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["--vary", "safety,speed,recording"];
    let first = printed(&accuracy(folder.path(), &WIRE, &args));
    for part in ["Reference: closed form", "speed (5 m/s)", "1.25 m/s", "250 rows", "12 runs made, 0 kept"] {
        assert!(first.contains(part), "{part} is not in\n{first}");
    }
    let study = folder.path().join("out/accuracy/single-wire");
    let table = rows(&study.join("accuracy.csv"));
    assert_eq!(table.len(), 12);
    assert!(table.iter().all(|row| row["outcome"] == "ran"), "{table:?}");
    // The closed form is met, and the slower the pull the better.
    let speeds: Vec<&_> = table.iter().filter(|row| row["parameter"] == "speed").collect();
    let errors: Vec<f64> = speeds.iter().map(|row| number(row, "elongation_error_percent").abs()).collect();
    assert!(errors.windows(2).all(|pair| pair[0] < pair[1]) && errors[0] < 0.2, "{errors:?}");
    assert!(table.iter().all(|row| number(row, "strength_error_percent").abs() < 1.0));
    assert!(table.iter().all(|row| number(row, "plastic_work_error_percent").abs() < 0.1));
    assert!(table.iter().all(|row| row["same_first_wire"] == "yes"));
    assert!(table.iter().all(|row| number(row, "wall_s") > 0.0 && number(row, "steps") > 1000.0));
    let json: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(study.join("accuracy.json")).unwrap()).unwrap();
    assert_eq!((&json["reference"]["kind"], json["rows"].as_array().unwrap().len()), (&"closed-form".into(), 12));
    // First order in the speed of the pull, as far as this short wire lets it show.
    let order =
        json["reference"]["refinement"].as_array().unwrap().iter().find(|one| one["parameter"] == "speed").unwrap();
    assert!((order["order"][1].as_f64().unwrap() - 1.0).abs() < 0.4, "{order}");
    let svg = std::fs::read_to_string(study.join("accuracy.svg")).unwrap();
    for word in ["error of strength", "the scene as it stands", "best found (Pareto front)"] {
        assert!(svg.contains(word), "{word}");
    }
    assert!(study.join("accuracy.png").metadata().unwrap().len() > 10_000);

    let before = std::fs::read(study.join("accuracy.csv")).unwrap();
    let second = printed(&accuracy(folder.path(), &WIRE, &args));
    assert!(second.contains("0 runs made, 12 kept"), "{second}");
    assert_eq!(std::fs::read(study.join("accuracy.csv")).unwrap(), before);
    let none = printed(&accuracy(folder.path(), &WIRE, &["--vary", "mass", "--budget", "0s"]));
    assert!(
        none.contains("0 runs made, 1 kept") && none.contains("no room for") && none.contains("mass: 4 | 16"),
        "{none}"
    );
}

#[test]
fn a_strand_is_compared_with_its_own_refinement_seed_by_seed_and_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    let scene = ["strand-1x7", "--set", "strand.length=8 mm", "--set", "grip.length=1 mm", "--set", "grip.speed=4 m/s"];
    let args = ["--vary", "speed,tangential", "--seeds", "1,2", "--jobs", "2", "--out", "study"];
    let found = printed(&accuracy(folder.path(), &scene, &args));
    for part in ["limit of refinement in speed (Richardson)", "±", "another model, no error", "mean of 2 seeds"] {
        assert!(found.contains(part), "{part} is not in\n{found}");
    }
    // Bonds scatter: what is judged is the mean and the spread, and what two seeds cannot tell is said.
    for part in ["Errors are those of the mean over 2 seeds", "spread of strength", "not told from scatter"] {
        assert!(found.contains(part), "{part} is not in\n{found}");
    }
    let one = printed(&accuracy(folder.path(), &scene, &["--vary", "tangential", "--seed", "1", "--threads", "1"]));
    for part in ["One draw of the scatter (seed 1)", "one draw: not told from scatter"] {
        assert!(one.contains(part), "{part} is not in\n{one}");
    }
    let listed = accuracy(folder.path(), &scene, &["--vary", "tangential", "--list"]);
    assert!(listed.status.success(), "{}", text(&listed.stderr));
    let table = rows(&folder.path().join("study/accuracy.csv"));
    assert_eq!(table.len(), 14);
    assert!(table.iter().all(|row| row.contains_key("layer_error_percent:core")));
    assert!(table.iter().all(|row| number(row, "order_tau") <= 1.0));
    assert!(table.iter().filter(|row| row["parameter"] == "tangential").all(|row| row["role"] == "change of model"));
}

#[test]
fn a_run_that_fails_has_its_row_and_stops_no_other() {
    let folder = tempfile::tempdir().unwrap();
    // Bonds of 6 mm: their free ends whip too far in a step once the wire has snapped.
    let args = ["--set", "spacing=4", "--vary", "spacing"];
    let found = printed(&accuracy(folder.path(), &WIRE, &args));
    assert!(found.contains("spacing 16 failed: stopped at step"), "{found}");
    let table = rows(&folder.path().join("out/accuracy/single-wire/accuracy.csv"));
    let (failed, ran): (Vec<_>, Vec<_>) = table.iter().partition(|row| row["outcome"] == "failed");
    assert!(!failed.is_empty() && ran.len() >= 2, "{table:?}");
    assert!(failed.iter().all(|row| row["cause"].contains("moved") && row["wall_s"].is_empty()));
}

#[test]
fn what_cannot_be_studied_is_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    for (args, words) in [
        (&["accuracy", "ka4", "--vary", "saftey"][..], "did you mean `safety`?"),
        (&["accuracy", "two-spheres"], "nothing is pulled here"),
        (&["accuracy", "ka4", "--budget", "20"], "with its unit"),
        (&["accuracy", "ka4", "--jobs", "2", "--threads", "2"], "cannot be used with"),
        (&["accuracy", "ka4", "--quality", "fien"], "fine"),
        (&["accuracy", "hertz", "--vary", "speed"], "take no --vary"),
        (&["accuracy", "ka4", "--quick"], "--quick is for verification cases"),
    ] {
        let output = strandsnap(folder.path(), args);
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        assert!(text(&output.stderr).contains(words), "{args:?}: {}", text(&output.stderr));
    }
    let list = printed(&strandsnap(folder.path(), &["accuracy", "ka4", "--list"]));
    assert!(list.contains("time.safety") && list.contains("wire, spacing 2"), "{list}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn verification_cases_show_their_order_and_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["accuracy", "cantilever-shared", "--quick"];
    let first = printed(&strandsnap(folder.path(), &args));
    assert!(first.contains("1 case run, 0 kept") && first.contains("Timoshenko"), "{first}");
    let study = folder.path().join("out/accuracy/cantilever-shared");
    let table = rows(&study.join("accuracy.csv"));
    let orders: Vec<f64> = table.iter().filter_map(|row| row["order"].parse().ok()).collect();
    assert!(orders.len() >= 2 && orders.iter().all(|order| (order - 1.0).abs() < 0.1), "{orders:?}");
    assert!(study.join("accuracy.png").exists() && study.join("accuracy.svg").exists());
    let before = std::fs::read(study.join("accuracy.csv")).unwrap();
    assert!(printed(&strandsnap(folder.path(), &args)).contains("0 cases run, 1 kept"));
    assert_eq!(std::fs::read(study.join("accuracy.csv")).unwrap(), before);
}

#[test]
fn a_page_shows_the_study_of_its_scene() {
    let folder = tempfile::tempdir().unwrap();
    printed(&accuracy(folder.path(), &WIRE, &["--vary", "speed", "--out", "study"]));
    let scene = &WIRE[..5];
    let options = ["--quality", "draft", "--no-frames", "--no-recording", "--quiet"];
    printed(&strandsnap(folder.path(), &[&["run"], scene, &options].concat()));
    let resolved = std::fs::read_to_string(folder.path().join("out/single-wire/scene.toml")).unwrap();
    assert!(resolved.contains("speed = ") && !resolved.contains("speed = \"5 m/s\""), "{resolved}");
    printed(&strandsnap(folder.path(), &["report", "out/single-wire", "--accuracy", "study"]));
    let page = std::fs::read_to_string(folder.path().join("out/single-wire/report.html")).unwrap();
    for part in ["Error against run time", "data:image/svg+xml;base64,", "--vary speed", "1.25 m/s"] {
        assert!(page.contains(part), "{part}");
    }
    let missing = strandsnap(folder.path(), &["report", "out/single-wire", "--overwrite", "--accuracy", "out"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(text(&missing.stderr).contains("holds no study"), "{}", text(&missing.stderr));
}

/// Presets come before `--set`, which wins.
#[test]
fn a_preset_gives_way_to_what_is_set() {
    let show = |args: &[&str]| printed(&strandsnap(Path::new("."), &[&["plan", "single-wire"], args].concat()));
    let draft = show(&["--quality", "draft"]);
    assert!(draft.contains("quality: draft (") && draft.contains("grip.speed="), "{draft}");
    assert!(show(&[]).contains("quality: standard (the scene as it is written)"));
    let simulated = |text: &str| {
        let line = text.lines().find(|line| line.starts_with("simulated time")).expect("plan says it").to_string();
        line.split_whitespace().nth(2).unwrap().parse::<f64>().unwrap()
    };
    let set = simulated(&show(&["--quality", "draft", "--set", "grip.speed=5 m/s"]));
    assert!((set / simulated(&show(&[])) - 1.0).abs() < 1e-3);
    assert!(simulated(&draft) < 0.9 * set && simulated(&show(&["--quality", "fine"])) > 1.1 * set);
}
