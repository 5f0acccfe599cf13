//! `strandsnap calibrate` as a user runs it.

#[path = "common/program.rs"]
mod program;

use program::{printed, strandsnap, text};
use std::path::Path;
use std::process::Output;

/// A wire of 30 mm whose bonds scatter widely; a run takes a fraction of a second.
const WIRE: [&str; 13] = [
    "calibrate",
    "single-wire",
    "--set",
    "wire.0.to=[\"0 mm\", \"0 mm\", \"30 mm\"]",
    "--set",
    "grip.length=5 mm",
    "--set",
    "bond.rupture.strain=4 %",
    "--set",
    "bond.rupture.weibull_modulus=8",
    "--strength=150",
    "--elongation=5",
    "--tolerance=1",
];

fn calibrate(folder: &Path, args: &[&str]) -> Output {
    strandsnap(folder, &[&WIRE, args].concat())
}

#[test]
fn a_mean_over_seeds_is_fitted_with_its_interval_and_runs_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let calibrate = |args: &[&str]| printed(&calibrate(folder.path(), args));
    let first = calibrate(&["--seeds", "4", "--jobs", "2"]);
    for part in ["target: 150.00 MPa at 5.00 %", "Mean of 4 seeds: strength", "±", "bond.rupture.strain="] {
        assert!(first.contains(part), "{part} is not in\n{first}");
    }
    let file = folder.path().join("out/calibration/single-wire/calibration.json");
    let read = || -> serde_json::Value { serde_json::from_str(&std::fs::read_to_string(&file).unwrap()).unwrap() };
    let json = read();
    let last = json["trials"].as_array().unwrap().last().unwrap().clone();
    assert_eq!((&last["strength"]["count"], json["seeds"].as_array().unwrap().len()), (&4.into(), 4));
    assert!((last["elongation"]["mean"].as_f64().unwrap() / 5.0 - 1.0).abs() <= 0.01, "{last}");
    assert!(last["elongation"]["interval_95"].as_f64().unwrap() > 0.0);
    let second = calibrate(&["--seeds", "1..4", "--threads", "1"]);
    assert!(second.contains("Already there: "), "{second}");
    let again = read();
    let setting = |json: &serde_json::Value| json["trials"].as_array().unwrap().last().unwrap()["setting"].clone();
    assert_eq!(setting(&again), setting(&json));
    assert_eq!(again["trials"].as_array().unwrap().last().unwrap()["kept"], 4);
    let one = calibrate(&["--seed", "3", "--threads", "1"]);
    assert!(one.contains("One strand was fitted (seed 3)"), "{one}");
}

#[test]
fn seeds_that_mean_nothing_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (seeds, why) in
        [("0", "none is not enough"), ("6..4", "ends before it begins"), ("1,1", "listed twice"), ("a", "how many")]
    {
        let output = calibrate(folder.path(), &["--seeds", seeds]);
        assert_eq!(output.status.code(), Some(2), "{seeds}");
        assert!(text(&output.stderr).contains(why), "{seeds}: {}", text(&output.stderr));
    }
    assert!(!folder.path().join("out").exists(), "nothing is written");
}
