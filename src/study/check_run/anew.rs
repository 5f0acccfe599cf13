//! What the program makes of a run's scene and trajectory, against what lies in the folder.

use super::finding::{InvariantOutcome, Search};
use super::folder::Folder;
use super::invariant::Invariant;
use crate::engine::REVISION;
use crate::engine::view::RunInfo;
use serde_json::Value;

pub const TABLES: Invariant = Invariant {
    name: "tables",
    about: "curve.csv, wires.csv, ruptures.csv and bodies.csv are those that the trajectory gives, cell by cell",
    check: tables,
};

/// What only the run itself knew is taken from the file: what it cost, how near it came to its limits, its quasi-static
/// measures, which are of more instants than its rows, and what ended it.
pub const SUMMARY: Invariant = Invariant {
    name: "summary",
    about: "summary.json is that which scene and trajectory give, but for cost, limits, quasi-static measures and what ended the run",
    check: summary,
};

/// Positions are compared in radii: cosines of another machine differ in their last digit. Ranges of colours are no bodies,
/// and another revision of the physics may build others.
pub const BODIES: Invariant = Invariant {
    name: "bodies",
    about: "layers, wires, particles and gauge of the trajectory are those that the scene builds",
    check: bodies,
};

/// Numbers that are computed again may differ by rounding, on another machine.
const ROUNDING: f64 = 1e-9;

fn tables(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    let found = [&run.curve, &run.wires, &run.ruptures].into_iter().chain(&run.bodies);
    for (found, right) in found.zip(run.anew.tables.iter().chain(&run.anew.bodies)) {
        let name = found.name;
        search.same(found.heads.join(","), right.heads.join(","), || format!("columns of {name}"));
        search.same(found.rows.len(), right.rows.len(), || format!("rows of {name}"));
        let heads = &found.heads;
        for (row, (found, right)) in found.rows.iter().zip(&right.rows).enumerate() {
            for (cell, head) in found.iter().zip(right).zip(heads) {
                search.same(cell.0, cell.1, || format!("{name} line {}, {head}", row + 2));
            }
        }
    }
    search.end(0.0, "-", "")
}

fn summary(run: &Folder) -> InvariantOutcome {
    let (mut found, mut right) = (run.summary_as_written.clone(), run.anew.summary.clone());
    // The seal is what `own-files` looks at; times are kept to the nanosecond, and written per frame.
    if let (Value::Object(found), Value::Object(right)) = (&mut found, &mut right) {
        found.remove("seal");
        found.remove("frames");
        right.remove("frames");
    }
    let mut search = Search::new();
    leaves(&found, &right, "summary.json", &mut search);
    search.end(ROUNDING, "-", "")
}

fn bodies(run: &Folder) -> InvariantOutcome {
    let (told, made) = (&run.trajectory.info, &run.made);
    let revision = run.trajectory.origin.revision;
    if revision != REVISION {
        return InvariantOutcome::NotApplicable(format!(
            "the run is of revision {revision} of the physics, this is {REVISION}"
        ));
    }
    let mut search = Search::new();
    let rest = |info: &RunInfo| {
        let [stress_range, plastic_strain_range, speed_range, contact_pressure_range] = [[0.0; 2]; 4];
        let ranges =
            RunInfo { stress_range, plastic_strain_range, speed_range, contact_pressure_range, ..info.clone() };
        let bare = RunInfo { rest_position: Vec::new(), ..ranges };
        serde_json::to_value(bare).unwrap_or_default()
    };
    leaves(&rest(told), &rest(made), "head of trajectory.bin", &mut search);
    search.same(told.rest_position.len(), made.rest_position.len(), || "particles of trajectory.bin".into());
    for (p, (found, right)) in told.rest_position.iter().zip(&made.rest_position).enumerate() {
        let off = glam::Vec3::from(*found).distance(glam::Vec3::from(*right));
        let furthest = right.iter().fold(0.0, |most: f32, x| most.max(x.abs()));
        // Positions are in single precision.
        let off = (off - furthest * f32::EPSILON).max(0.0) / made.radius.get(p).copied().unwrap_or(1.0);
        search.add(f64::from(off), || format!("particle {p} at {found:?} m, the scene puts it at {right:?}"));
    }
    search.end(1e-6, "-", "")
}

/// Compares all numbers and words of two JSON values; what is missing is null.
fn leaves(found: &Value, right: &Value, path: &str, search: &mut Search) {
    match (found, right) {
        (Value::Object(a), Value::Object(b)) => {
            for key in a.keys().chain(b.keys().filter(|key| !a.contains_key(*key))) {
                let of = |map: &serde_json::Map<String, Value>| map.get(key).cloned().unwrap_or_default();
                leaves(&of(a), &of(b), &format!("{path}, {key}"), search);
            }
        }
        (Value::Array(a), Value::Array(b)) => {
            search.same(a.len(), b.len(), || format!("entries of {path}"));
            a.iter().zip(b).enumerate().for_each(|(k, (a, b))| leaves(a, b, &format!("{path} {}", k + 1), search));
        }
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64().unwrap_or(f64::NAN), b.as_f64().unwrap_or(f64::NAN));
            search.compare(a, b, a.abs().max(b.abs()), || path.into());
        }
        _ => search.same(found.to_string(), right.to_string(), || path.into()),
    }
}
