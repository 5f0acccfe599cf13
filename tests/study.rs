//! `strandsnap study` as a user runs it: a tiny study end to end, resumed, run case by case, with cases that fail, and
//! what it refuses.

#[path = "common/program.rs"]
mod program;
#[path = "common/rows.rs"]
mod rows;

use program::{printed, strandsnap, text};
use rows::{Row, number, rows};
use std::path::Path;
use std::process::Output;

/// A wire of 30 mm over three pull speeds and two seeds: a run takes a tenth of a second.
const SPEEDS: &str = r#"
about = "How the speed of the pull changes a wire."
base = "single-wire"
set = ["wire.0.to=[\"0 mm\", \"0 mm\", \"30 mm\"]", "grip.length=5 mm", "bond.rupture.strain=20 %", "stop.stress_fraction=", "stop.strain_after_drop=2 %"]
seeds = 2
fits = ["elongation"]
compare = ["zhao-2025", "strand-theory"]

[[axis]]
key = "grip.speed"
from = "5 m/s"
to = "20 m/s"
points = 4
"#;

/// Runs a study from its text, in a folder that keeps its results.
fn study(folder: &Path, text: &str, args: &[&str]) -> Output {
    std::fs::write(folder.join("own.toml"), text).unwrap();
    strandsnap(folder, &[&["study", "own.toml"], args].concat())
}

#[test]
fn a_tiny_study_runs_is_not_run_twice_and_writes_everything() {
    let folder = tempfile::tempdir().unwrap();
    let first = printed(&study(folder.path(), SPEEDS, &[]));
    for part in
        ["Means over seeds", "Which layer breaks first", "A exp(B x) + C", "8 cases at standard quality: 8 ran."]
    {
        assert!(first.contains(part), "{part} is not in\n{first}");
    }
    assert!(first.contains("[MPa]") && !first.contains("]]"), "{first}");
    let out = folder.path().join("out/study/own");
    let cases = rows(&out.join("cases.csv"));
    assert_eq!(cases.len(), 8);
    assert!(cases.iter().all(|row| row["outcome"] == "ran" && row["first layer"] == "wire"), "{cases:?}");
    // Every case has a folder named by the hash of its scene, and the scene in it.
    for row in &cases {
        let scene = std::fs::read_to_string(out.join("cases").join(&row["folder"]).join("scene.toml")).unwrap();
        assert!(scene.contains(&format!("seed = {}", row["seed"])), "{scene}");
    }
    let strength: Vec<f64> = cases.iter().map(|row| number(row, "strength [MPa]")).collect();
    let points = rows(&out.join("points.csv"));
    let mean = points.iter().find(|row| row["quantity"] == "strength" && row["speed [m/s]"] == "5").unwrap();
    assert!((number(mean, "mean") - 0.5 * (strength[0] + strength[4])).abs() < 1e-9, "{mean:?}");
    assert!((number(mean, "standard deviation") - (strength[0] - strength[4]).abs() / 2f64.sqrt()).abs() < 1e-9);
    let json: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(out.join("study.json")).unwrap()).unwrap();
    assert_eq!(json["points"].as_array().unwrap().len(), 4);
    assert_eq!(json["fits"][0]["quantity"], "elongation");
    for name in ["curves", "trends"] {
        assert!(std::fs::read_to_string(out.join(format!("{name}.svg"))).unwrap().contains("</svg>"));
        assert!(out.join(format!("{name}.png")).metadata().unwrap().len() > 10_000);
    }
    let page = std::fs::read_to_string(out.join("study.html")).unwrap();
    assert!(
        page.contains("data:image/svg+xml;base64,") && page.contains("Means over seeds") && !page.contains("http://")
    );

    let tables = ["cases.csv", "points.csv", "breaks.csv", "study.json", "study.html"];
    let before: Vec<Vec<u8>> = tables.iter().map(|name| std::fs::read(out.join(name)).unwrap()).collect();
    let second = printed(&study(folder.path(), SPEEDS, &[]));
    assert_eq!(second, first);
    let after: Vec<Vec<u8>> = tables.iter().map(|name| std::fs::read(out.join(name)).unwrap()).collect();
    assert_eq!(after, before, "a study that is run again makes no case again, so even run times are the same");
}

#[test]
fn cases_may_be_run_one_by_one_and_gathered() {
    let folder = tempfile::tempdir().unwrap();
    let dry = printed(&study(folder.path(), SPEEDS, &["--dry-run"]));
    assert!(dry.contains("8 cases, 0 of them done") && dry.contains("15 m/s"), "{dry}");
    assert!(!folder.path().join("out").exists(), "a dry run writes nothing");
    let none = study(folder.path(), SPEEDS, &["--collect"]);
    assert_eq!(none.status.code(), Some(2));
    assert!(text(&none.stderr).contains("none was run yet"), "{}", text(&none.stderr));
    for case in ["3", "7"] {
        let one = printed(&study(folder.path(), SPEEDS, &["--case", case]));
        assert!(one.contains(&format!("case {case} (speed 15 m/s")), "{one}");
    }
    let gathered = printed(&study(folder.path(), SPEEDS, &["--collect"]));
    assert!(gathered.contains("2 ran, 6 are missing"), "{gathered}");
    let dry = printed(&study(folder.path(), SPEEDS, &["--dry-run"]));
    assert!(dry.contains("2 of them done") && dry.contains("which is what a finished case took"), "{dry}");
    // The whole study makes the rest, and gives the same numbers as if it had made all.
    printed(&study(folder.path(), SPEEDS, &["--jobs", "1"]));
    let whole = tempfile::tempdir().unwrap();
    printed(&study(whole.path(), SPEEDS, &["--jobs", "2"]));
    let [a, b] = [&folder, &whole].map(|folder| std::fs::read(folder.path().join("out/study/own/points.csv")).unwrap());
    assert_eq!(text(&a), text(&b));
    let wrong = study(folder.path(), SPEEDS, &["--case", "9"]);
    assert!(text(&wrong.stderr).contains("numbered from 1 to 8"), "{}", text(&wrong.stderr));
}

/// Kills a study as soon as one of its runs has a checkpoint that the kill before did not leave. Whether it had one.
fn kill_at_a_checkpoint(folder: &Path) -> bool {
    let cases = folder.join("out/study/own/cases");
    let unfinished = || -> Vec<std::path::PathBuf> {
        let within = |folder| std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        within(cases.clone()).flat_map(within).map(|case| case.join("unfinished")).collect()
    };
    let newest = || {
        let kept = unfinished().into_iter().filter_map(|run| strandsnap::run::checkpoint::latest(&run).ok());
        kept.map(|(checkpoint, _)| (checkpoint.identity.scene, checkpoint.number)).max()
    };
    let before = newest();
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_strandsnap"));
    command.args(["study", "own.toml", "--jobs", "1"]).current_dir(folder);
    command.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::null());
    let mut child = command.spawn().unwrap();
    let reached = loop {
        let now = newest();
        if now.is_some() && now != before {
            break true;
        }
        if child.try_wait().unwrap().is_some() {
            break false;
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    };
    child.kill().unwrap();
    child.wait().unwrap();
    reached
}

#[test]
fn a_study_that_is_killed_goes_on_within_a_case_to_the_same_tables() {
    let [folder, whole] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let text = SPEEDS.replace("set = [", "set = [\"output.checkpoint=300\", ").replace("points = 4", "points = 2");
    printed(&study(whole.path(), &text, &[]));
    std::fs::write(folder.path().join("own.toml"), &text).unwrap();
    let kills = (0..5).filter(|_| kill_at_a_checkpoint(folder.path())).count();
    assert!(kills > 1, "only {kills} times was a run killed that had a checkpoint");
    printed(&study(folder.path(), &text, &[]));
    for table in ["points.csv", "breaks.csv", "curves.svg"] {
        let [a, b] = [&folder, &whole].map(|f| std::fs::read(f.path().join("out/study/own").join(table)).unwrap());
        assert!(a == b, "{table} differs");
    }
    let cases = |folder: &Path| -> Vec<Row> {
        let mut rows = rows(&folder.join("out/study/own/cases.csv"));
        for row in &mut rows {
            row.retain(|column, _| !["run time [s]", "CPU [s]"].contains(&column.as_str()));
        }
        rows
    };
    assert_eq!(cases(folder.path()), cases(whole.path()));
    for row in rows(&folder.path().join("out/study/own/cases.csv")) {
        let case = folder.path().join("out/study/own/cases").join(&row["folder"]);
        assert!(!case.join("unfinished").exists(), "{} was left behind", case.display());
    }
}

#[test]
fn a_damaged_record_is_told_and_its_case_run_again() {
    let folder = tempfile::tempdir().unwrap();
    let first = printed(&study(folder.path(), SPEEDS, &[]));
    let cases = folder.path().join("out/study/own/cases");
    let case = rows(&folder.path().join("out/study/own/cases.csv"))[0]["folder"].clone();
    let record = cases.join(&case).join("case.json");
    let whole = std::fs::read_to_string(&record).unwrap();
    std::fs::write(&record, &whole[..whole.len() / 3]).unwrap();
    for (args, fate) in
        [(&["--dry-run"][..], "is computed again"), (&["--collect"], "counts as not run"), (&[], "is computed again")]
    {
        let output = study(folder.path(), SPEEDS, args);
        let told = text(&output.stderr);
        assert!(output.status.success(), "{told}");
        assert!(told.contains(&format!("{case}/case.json is damaged")) && told.contains(fate), "{args:?}: {told}");
    }
    let again = study(folder.path(), SPEEDS, &[]);
    assert!(!text(&again.stderr).contains("damaged"), "{}", text(&again.stderr));
    let results = |printed: &str| printed.lines().filter(|line| line.contains("MPa")).count();
    assert_eq!(results(&printed(&again)), results(&first));
}

#[test]
fn a_case_that_fails_is_told_with_its_cause_and_stops_no_other() {
    let folder = tempfile::tempdir().unwrap();
    // Bonds of 6 mm may whip too far in a step once the wire has snapped, which one of the two seeds does; a spacing below
    // zero is refused before anything runs.
    let failing = SPEEDS.replace(
        "key = \"grip.speed\"\nfrom = \"5 m/s\"\nto = \"20 m/s\"\npoints = 4",
        "key = \"spacing\"\nvalues = [1, 16, -1]",
    );
    let failing = failing.replace("fits = [\"elongation\"]", "");
    let found = printed(&study(folder.path(), &failing, &[]));
    assert!(found.contains("case 5 (spacing 16, seed 2) failed: stopped at step"), "{found}");
    assert!(found.contains("spacing -1, seed 2) refused: `spacing` is -1"), "{found}");
    let cases = rows(&folder.path().join("out/study/own/cases.csv"));
    let of = |outcome: &str| cases.iter().filter(|row| row["outcome"] == outcome).count();
    assert_eq!((of("ran"), of("failed"), of("refused")), (3, 1, 2));
    let alone = study(folder.path(), &failing, &["--case", "5"]);
    assert_eq!(alone.status.code(), Some(4));
    assert!(text(&alone.stdout).contains("failed: stopped at step"), "{}", text(&alone.stdout));
    let refused = study(folder.path(), &failing, &["--case", "6"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("is refused: `spacing` is -1"), "{}", text(&refused.stderr));
}

#[test]
fn axes_that_zip_go_along_and_a_design_tells_effects() {
    let folder = tempfile::tempdir().unwrap();
    let axes = r#"
about = "Two factors of a wire."
base = "single-wire"
set = ["wire.0.to=[\"0 mm\", \"0 mm\", \"30 mm\"]", "grip.length=5 mm", "grip.speed=20 m/s"]
seeds = [3, 4]

[[axis]]
name = "strain at rupture"
key = "bond.rupture.strain"
values = ["10 %", "20 %"]

[[axis]]
key = "stop.strain"
values = ["30 %", "41 %"]
zip = true

[[axis]]
name = "scatter"
[[axis.levels]]
name = "none"
set = ["bond.rupture.weibull_modulus=inf"]
[[axis.levels]]
name = "modulus 8"
set = ["bond.rupture.weibull_modulus=8"]

[design]
points = 4
interactions = [["strain at rupture", "scatter"]]
"#;
    let found = printed(&study(folder.path(), axes, &[]));
    // Without scatter one seed is enough.
    assert!(found.contains("6 cases at standard quality: 6 ran."), "{found}");
    let out = folder.path().join("out/study/own");
    let cases = rows(&out.join("cases.csv"));
    let elongation = |strain: &str, scatter: &str| {
        let row = cases.iter().find(|row| row["strain at rupture [%]"] == strain && row["scatter"] == scatter).unwrap();
        number(row, "elongation [%]")
    };
    // Twice the strain at rupture, twice as far; a wire shorter than the 100 mm that scatter is normalised to gains by it.
    assert!(elongation("20", "none") > 1.9 * elongation("10", "none"));
    assert!(elongation("20", "modulus 8") > elongation("20", "none"));
    let moved = || {
        let text = std::fs::read_to_string(out.join("study.json")).unwrap();
        let mut json: serde_json::Value = serde_json::from_str(&text).unwrap();
        let all = json["effects"].as_array_mut().unwrap();
        all.drain(..).find(|one| one["quantity"] == "elongation").unwrap()
    };
    let by_runs = moved();
    let effects = &by_runs["effects"]["Ok"];
    // Four points for four parameters: only seeds are left to judge by.
    assert_eq!((&by_runs["by_points"], &effects["rows"]), (&false.into(), &6.into()), "{by_runs}");
    assert_eq!(effects["terms"][0]["factors"], serde_json::json!([0]), "{by_runs}");
    let change = effects["factors"][0]["levels"][1]["from_first"]["value"].as_f64().unwrap();
    assert!(change > 8.0 && change < 20.0, "{change}");
    assert!(found.contains("Effect of strain at rupture at each level of scatter"), "{found}");
    assert!(out.join("effects.svg").is_file());

    // Without the interaction a point is left over, and seeds that share what the model leaves out do not count twice.
    let mains = axes.replace("interactions = [[\"strain at rupture\", \"scatter\"]]", "");
    printed(&study(folder.path(), &mains, &["--collect"]));
    let by_points = moved();
    assert_eq!(
        (&by_points["by_points"], &by_points["effects"]["Ok"]["rows"]),
        (&true.into(), &4.into()),
        "{by_points}"
    );
    let seeds = |strain: &str| -> Vec<f64> {
        let own = |row: &&Row| row["strain at rupture [%]"] == strain && row["scatter"] == "modulus 8";
        cases.iter().filter(own).map(|row| number(row, "elongation [%]")).collect()
    };
    let [pair, other] = ["10", "20"].map(seeds);
    let pooled = (0.25 * ((pair[0] - pair[1]).powi(2) + (other[0] - other[1]).powi(2))).sqrt();
    assert!((by_points["seeds_deviation"].as_f64().unwrap() - pooled).abs() < 1e-9, "{by_points}");
}

#[test]
fn what_is_wrong_in_a_study_is_told_with_its_line_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    for (from, to, words) in [
        ("base = \"single-wire\"", "base = \"singel-wire\"", "did you mean `single-wire`?"),
        ("base = \"single-wire\"", "", "`base` is missing"),
        ("seeds = 2", "seeds = 0", "there must be at least one"),
        ("seeds = 2", "seeds = 4294967296", "more than 20000 cases"),
        ("seeds = 2", "seads = 2", "unknown key `seads` in a study"),
        ("fits = [\"elongation\"]", "fits = [\"elongaton\"]", "did you mean `elongation`?"),
        ("compare = [\"zhao-2025\"", "compare = [\"zhao-2026\"", "`zhao-2026` is nothing to compare with"),
        ("compare = [\"zhao-2025\", ", "compare = [", "strand theory is calibrated on an experiment"),
        ("to = \"20 m/s\"", "to = \"20 mm/s\"", "give both in one unit"),
        ("points = 4", "points = 1", "a range has at least 2"),
        ("points = 4", "points = 9223372036854775807", "more than 20000 cases"),
        ("key = \"grip.speed\"", "", "the axis does not say what it varies"),
        ("points = 4", "points = 4\nvalues = [\"5 m/s\"]", "does not go with a range"),
        (
            "points = 4",
            "points = 4\n[[axis]]\nname = \"speed\"\nkey = \"seed\"\nvalues = [1]",
            "two axes are called `speed`",
        ),
        (
            "points = 4",
            "points = 4\n[[axis]]\nkey = \"seed\"\nvalues = [1]\nzip = true",
            "`speed`, which it goes along with, has 4",
        ),
        ("points = 4", "points = 4\n[design]\npoints = 3", "3 points cannot tell 4 parameters apart"),
        (
            "points = 4",
            "points = 4\n[design]\npoints = 4\ninteractions = [[\"speed\", \"pich\"]]",
            "no axis is called `pich`",
        ),
    ] {
        let wrong = study(folder.path(), &SPEEDS.replace(from, to), &[]);
        let said = text(&wrong.stderr);
        assert_eq!(wrong.status.code(), Some(2), "{to}: {said}");
        assert!(said.contains(words), "{to}: {words} is not in\n{said}");
    }
    let unknown = strandsnap(folder.path(), &["study", "pich"]);
    assert!(text(&unknown.stderr).contains("did you mean `pitch`?"), "{}", text(&unknown.stderr));
    let option = study(folder.path(), SPEEDS, &["--set", "material.yuong=3 GPa"]);
    assert_eq!(option.status.code(), Some(2));
    assert!(text(&option.stderr).contains("unknown key `yuong`"), "{}", text(&option.stderr));
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_point_without_scatter_is_run_once() {
    let folder = tempfile::tempdir().unwrap();
    let axis = "key = \"grip.speed\"\nfrom = \"5 m/s\"\nto = \"20 m/s\"\npoints = 4";
    let scatter = SPEEDS.replace(axis, "key = \"bond.rupture.weibull_modulus\"\nvalues = [\"inf\", 12]");
    let dry = printed(&study(folder.path(), &scatter.replace("fits = [\"elongation\"]", ""), &["--dry-run"]));
    // Both points with seed 1, and only the one whose bonds differ with seed 2.
    assert!(dry.contains("3 cases, 0 of them done"), "{dry}");
}

#[test]
fn the_studies_that_come_along_have_their_cases() {
    let folder = tempfile::tempdir().unwrap();
    let list = printed(&strandsnap(folder.path(), &["study", "--list"]));
    // 64 points of which 16 have no scatter, so that their second seed is none.
    let cases = [("pitch", 35), ("diameter", 21), ("seeds", 16), ("mechanism", 112)];
    for (name, count) in cases {
        let line =
            list.lines().find(|line| line.split_whitespace().next() == Some(name)).expect("every name is listed");
        assert!(line.ends_with(&format!("({count} cases)")), "{line}");
    }
}
