//! `output.tables`: tables at snapshots, against closed forms.

use super::rows::{Row, column, number, rows};
use super::{strandsnap, text};
use std::f64::consts::PI;
use std::path::Path;

/// Runs a scene into `run` and gives the rows of the tables that it was asked for.
fn tables<const N: usize>(folder: &Path, scene: &str, wanted: [&str; N], set: &[&str]) -> [Vec<Row>; N] {
    let list = wanted.map(|table| format!("{table:?}")).join(", ");
    let key = format!("output.tables=[{list}]");
    let set = set.iter().flat_map(|key| ["--set", key]);
    let arguments = ["run", scene, "--no-frames", "--no-recording", "--overwrite", "--out", "run", "--set", &key];
    let output = strandsnap(folder, &arguments.into_iter().chain(set).collect::<Vec<_>>());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    wanted.map(|table| rows(&folder.join("run").join(format!("{table}.csv"))))
}

#[test]
fn a_clamp_bears_what_hangs_on_its_wire() {
    let folder = tempfile::tempdir().unwrap();
    let [holds, places] =
        tables(folder.path(), "cantilever", ["holds", "positions"], &["stop.time=6 ms", "bond.damping=0.3"]);
    // The last state, at rest: the clamp at the start takes the force back, and its moment about y over the length.
    let check = || strandsnap(folder.path(), &["check-run", "run"]);
    assert_eq!(check().status.code(), Some(0), "{}", text(&check()));
    let [clamp, tip] = [0, 1].map(|hold| holds.iter().rfind(|row| number(row, "hold") == f64::from(hold)).unwrap());
    let of = |row: &Row, column: &str| number(row, column);
    assert!((of(tip, "force_x_n") - 0.08).abs() < 1e-9, "{tip:?}");
    assert!((of(clamp, "force_x_n") + 0.08).abs() < 0.08 * 2e-3, "{clamp:?}");
    let last = of(tip, "step");
    let end = places.iter().rfind(|row| of(row, "step") == last).unwrap();
    let moment = -0.08 * of(end, "z_mm");
    assert!((of(clamp, "moment_y_n_mm") / moment - 1.0).abs() < 5e-3, "{clamp:?}, not {moment} N mm");
    for other in ["force_y_n", "moment_x_n_mm", "moment_z_n_mm"] {
        assert!(of(clamp, other).abs() < 1e-9, "{other} of {clamp:?}");
    }
    // Beam theory: P L³/(3 E I) + P L/(κ G A), with κ = 6 (1 + ν) / (7 + 6 ν).
    let (force, length, young, nu, r) = (0.08, 10e-3f64, 115e9, 0.34, 0.195e-3f64);
    let bent = force * length.powi(3) / (3.0 * young * PI / 4.0 * r.powi(4));
    let sheared = force * length / (6.0 * (1.0 + nu) / (7.0 + 6.0 * nu) * young / (2.0 * (1.0 + nu)) * PI * r * r);
    assert!((1e-3 * of(end, "x_mm") / (bent + sheared) - 1.0).abs() < 5e-3, "{end:?}, not {bent} + {sheared} m");
}

#[test]
fn two_spheres_press_as_hertz_says_and_keep_their_momentum() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["contact.normal=hertz", "contact.limiting_pressure=", "output.snapshots=60"];
    let [contacts, speeds] = tables(folder.path(), "two-spheres", ["contacts", "velocities"], &set);
    let modulus = 115e9 / (2.0 * (1.0 - 0.34f64 * 0.34));
    assert!(contacts.len() > 5, "{} contacts", contacts.len());
    for row in &contacts {
        let overlap = 1e-6 * number(row, "overlap_um");
        let hertz = 4.0 / 3.0 * modulus * (2.5e-3f64 * overlap.powi(3)).sqrt();
        assert!((number(row, "force_n") / hertz - 1.0).abs() < 1e-6, "{row:?}, not {hertz} N");
        let mean = 1e-6 * hertz / (PI * 2.5e-3 * overlap);
        assert!((number(row, "pressure_mpa") / mean - 1.0).abs() < 1e-6, "{row:?}, not {mean} MPa");
        assert!(number(row, "z_mm").abs() < 1e-9 && row["wire_a"].is_empty(), "{row:?}");
    }
    let last = column(&speeds, "vz_m_s");
    let [a, b] = [last[last.len() - 2], last[last.len() - 1]];
    let check = || strandsnap(folder.path(), &["check-run", "run"]);
    assert_eq!(check().status.code(), Some(0), "{}", text(&check()));
    // A table without one of its rows, and then none at all.
    let file = folder.path().join("run/contacts.csv");
    let whole = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, &whole[..=whole.trim_end().rfind('\n').unwrap()]).unwrap();
    for left in ["rows of contacts.csv at step", "contacts.csv: "] {
        assert_eq!(check().status.code(), Some(4), "{}", text(&check()));
        assert!(text(&check()).contains(left), "{left}: {}", text(&check()));
        let _ = std::fs::remove_file(&file);
    }
    // What is elastic gives everything back.
    assert!((a + b).abs() < 1e-9 && (a + 0.5).abs() < 1e-3, "{a} and {b} m/s after the impact");
}

#[test]
fn a_lay_grows_as_its_strand_is_stretched_and_a_grip_turns_as_it_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["stop.strain=2 %", "grip.speed=4 m/s"];
    let [grips] = tables(folder.path(), "strand-1x7", ["grips"], &set);
    let scene = strandsnap::scene::load("strand-1x7", &[]).unwrap().spec;
    let layer = &scene.strand.as_ref().unwrap().layers[1];
    let column_of = |what: &str| column(&grips, &format!("lay_{what}_{}_mm", layer.name));
    let (lengths, strains) = (column_of("length"), column(&grips, "strain_percent"));
    assert!((lengths[0] / (1e3 * layer.pitch) - 1.0).abs() < 1e-6, "{} mm at the start", lengths[0]);
    let (last, strain) = (lengths[lengths.len() - 1], 1e-2 * strains[strains.len() - 1]);
    // Wires that keep their number of turns between the grips.
    assert!((last / lengths[0] / (1.0 + strain) - 1.0).abs() < 2e-3, "{last} mm at {strain}");
    assert!(column(&grips, "lay_length_core_mm").iter().all(|length| length.is_nan()), "a straight core has no lay");
    let [grips] = tables(folder.path(), "torsion", ["grips"], &["stop.time=0.1 ms"]);
    let last = grips.last().unwrap();
    let right = (500.0 * number(last, "time_s")).to_degrees();
    assert!((number(last, "angle_deg") / right - 1.0).abs() < 1e-9, "{last:?}, not {right}°");
    assert!(!folder.path().join("run/holds.csv").exists(), "an earlier run's tables are gone");
}

#[test]
fn a_run_that_was_interrupted_has_the_tables_of_one_that_was_not() {
    let folder = tempfile::tempdir().unwrap();
    let set = [
        "--set",
        "output.tables=[\"holds\", \"velocities\"]",
        "--set",
        "output.checkpoint=1000",
        "--set",
        "stop.time=40 ms",
        "--set",
        "output.samples=200",
    ];
    let run = ["run", "cantilever", "--no-frames", "--no-recording", "--out"];
    let whole = strandsnap(folder.path(), &[&run[..], &["whole"], &set].concat());
    assert_eq!(whole.status.code(), Some(0), "{}", text(&whole));
    let part = strandsnap(folder.path(), &[&run[..], &["part"], &set, &["--time-limit", "0.2s"]].concat());
    assert_eq!(part.status.code(), Some(130), "{}", text(&part));
    let rest = strandsnap(folder.path(), &["resume", "part"]);
    assert_eq!(rest.status.code(), Some(0), "{}", text(&rest));
    for table in ["holds.csv", "velocities.csv", "curve.csv"] {
        let [whole, part] = ["whole", "part"].map(|run| std::fs::read(folder.path().join(run).join(table)).unwrap());
        assert!(whole == part && whole.len() > 1000, "{table}");
    }
}
