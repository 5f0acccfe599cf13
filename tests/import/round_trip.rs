//! From a model to a run.

use super::*;
use program::{printed, strandsnap, text};
use std::fs;

/// Words of an error, whatever its lines.
fn told(bytes: &[u8]) -> String {
    text(bytes).replace(" │ ", " ").split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn an_imported_strand_is_checked_and_runs() {
    let folder = tempfile::tempdir().unwrap();
    let assembly = model("assembly.step");
    let said = printed(&strandsnap(folder.path(), &["import", assembly.to_str().unwrap(), "--out", "strand.toml"]));
    for words in
        ["7 wires", "layer 1", "left (S)", "straight", "overlaps: none", "turned and moved to z", "strand.toml written"]
    {
        assert!(said.contains(words), "{words}\n{said}");
    }
    let scene = fs::read_to_string(folder.path().join("strand.toml")).unwrap();
    assert!(scene.contains("# layer 1  6") && scene.contains("left (S)"), "{scene}");
    let checked = printed(&strandsnap(folder.path(), &["scene", "check", "strand.toml"]));
    assert!(checked.contains("strand.toml is fine: 7 wires") && !checked.contains("WARNING"), "{checked}");
    // The core is told by its own diameter: strand theory has nothing to say of wires by points, the stiffness has.
    let run = ["run", "strand.toml", "--no-frames", "--no-recording", "--quiet", "--set", "stop.strain=0.2 %"];
    let ran = strandsnap(folder.path(), &run);
    assert!(ran.status.success(), "{}{}", text(&ran.stdout), text(&ran.stderr));
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("out/strand/summary.json")).unwrap()).unwrap();
    assert_eq!(summary["wires"].as_array().map_or(7, Vec::len), 7);
    let wires = fs::read_to_string(folder.path().join("out/strand/wires.csv")).unwrap();
    assert_eq!(wires.lines().filter(|line| line.contains("layer 1")).count(), 6, "{wires}");
}

#[test]
fn a_bent_wire_gets_a_scene_without_grips() {
    let folder = tempfile::tempdir().unwrap();
    let bent = model("bent-tube.step");
    let said = printed(&strandsnap(folder.path(), &["import", bent.to_str().unwrap()]));
    assert!(said.contains("not laid about one straight axis"), "{said}");
    printed(&strandsnap(folder.path(), &["scene", "check", "bent-tube.toml"]));
    let scene = fs::read_to_string(folder.path().join("bent-tube.toml")).unwrap();
    assert!(!scene.contains("[grip]"), "{scene}");
    printed(&strandsnap(folder.path(), &["run", "bent-tube.toml", "--no-frames", "--no-recording", "--quiet"]));
}

#[test]
fn nothing_is_replaced_unasked_and_nothing_is_left_of_a_refusal() {
    let folder = tempfile::tempdir().unwrap();
    let curves = model("curves.step");
    let curves = curves.to_str().unwrap();
    let files = || -> Vec<String> {
        let names = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    };
    let refused = |args: &[&str], words: &str| {
        let output = strandsnap(folder.path(), args);
        assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
        assert!(told(&output.stderr).contains(words), "{words}\n{}", told(&output.stderr));
    };
    // Without a diameter there is no scene, but a hint: neighbours on the lay radius are just so far apart.
    refused(&["import", curves], "give --diameter; wires that just touch would have \"0.39");
    refused(&["import", curves, "--diameter", "0 mm"], "greater than 0");
    refused(&["import", curves, "--diameter", "0.39"], "0.39");
    refused(&["import", curves, "--diameter", "0.39 mm", "--out", "a b.toml"], "is no name for a scene");
    assert!(files().is_empty(), "{:?}", files());
    let import = ["import", curves, "--diameter", "0.39 mm", "--out", "a.toml"];
    printed(&strandsnap(folder.path(), &import));
    assert_eq!(files(), ["a.points.txt", "a.toml"]);
    refused(&import, "a.toml exists");
    fs::remove_file(folder.path().join("a.toml")).unwrap();
    refused(&import, "a.points.txt exists");
    printed(&strandsnap(folder.path(), &[&import[..], &["--overwrite"]].concat()));
    assert_eq!(files(), ["a.points.txt", "a.toml"]);
    refused(&["import", "a.points.txt", "--out", "a.toml", "--overwrite"], "is the model itself");
    let none = strandsnap(folder.path(), &["import", "none.step", "--diameter", "1 mm"]);
    assert_eq!(none.status.code(), Some(1));
}

#[test]
fn what_is_not_used_is_said_on_standard_error() {
    let folder = tempfile::tempdir().unwrap();
    let others = model("others.step");
    let output = strandsnap(folder.path(), &["import", others.to_str().unwrap(), "--diameter", "0.41 mm"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let said = text(&output.stderr);
    assert!(
        said.contains("NOT USED: ") && said.contains("MANIFOLD_SOLID_BREP #") && said.contains(", line "),
        "{said}"
    );
    let scene = fs::read_to_string(folder.path().join("others.toml")).unwrap();
    assert!(scene.contains("# NOT USED: "), "{scene}");
}
