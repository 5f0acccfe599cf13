//! What must be the same in several files.

use super::finding::{InvariantOutcome, Search};
use super::folder::{CURVE as COLUMNS, Folder, energies};
use super::invariant::Invariant;
use super::rows::layer_heads;
use crate::engine::view::Sample;
use crate::observe::partial;
use crate::run::folder::RECORDING as RECORDED;
use crate::run::{StopReason, identity};

/// Numbers have nine digits.
const DIGITS: f64 = 1e-8;

pub const OWN: Invariant = Invariant {
    name: "own-files",
    about: "scene, summary, tables and trajectory are of one run, and as it wrote them",
    check: |run| {
        let mut search = Search::new();
        search.add(run.doubts.len() as f64, || identity::list(&run.doubts));
        search.end(0.0, "files", "")
    },
};

pub const CURVE: Invariant = Invariant {
    name: "curve-trajectory",
    about: "curve.csv has the trajectory's numbers at the same steps, in the units of its headings",
    check: curve,
};

pub const SNAPSHOTS: Invariant = Invariant {
    name: "snapshot-rows",
    about: "every snapshot has the numbers of the row at its step",
    check: |run| run.snapshots.rows.clone().end(0.0, "-", "there are no snapshots"),
};

pub const LAYERS: Invariant =
    Invariant { name: "layer-means", about: "the stress of a layer is the mean of its wires", check: layers };

pub const WIRES: Invariant = Invariant {
    name: "wires-rows",
    about: "wires.csv has each wire's greatest stress over the rows, or more, and its first rupture",
    check: wires,
};

pub const RUPTURES: Invariant = Invariant {
    name: "ruptures-trajectory",
    about: "ruptures.csv has the trajectory's ruptures, in the units of its headings",
    check: ruptures,
};

pub const SUMMARY: Invariant = Invariant {
    name: "summary-rows",
    about: "what the summary says of the end, of energy and of ruptures is what the rows say",
    check: summary,
};

pub const STRENGTH: Invariant = Invariant {
    name: "strength",
    about: "the summary's greatest stress is that of all rows, or more, its strength is that, and its strains come in order",
    check: strength,
};

pub const RECORDING: Invariant = Invariant {
    name: "recording",
    about: "recording.rrd is there if the run wrote it, and has the trajectory's stresses, counts and energies, and its last state",
    check: recording,
};

/// A row's value of each of [`COLUMNS`], in the unit of its heading.
fn values(row: &Sample) -> Vec<f64> {
    let state = [
        row.step as f64,
        row.time,
        row.strain * 100.0,
        row.stress / 1e6,
        row.grip_force[0],
        row.grip_force[1],
        row.torque * 1000.0,
        row.wires_broken as f64,
        row.bonds_broken as f64,
        row.contacts as f64,
        row.time_step,
    ];
    [&state[..], &energies(row), &[row.energy.residual()]].concat()
}

fn curve(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    let samples = &run.trajectory.samples;
    search.same(run.curve.rows.len(), samples.len(), || "rows of curve.csv".into());
    for head in layer_heads(run) {
        search.same(run.curve.has(&head), true, || format!("curve.csv has a column {head}"));
    }
    for (row, sample) in samples.iter().enumerate().take(run.curve.rows.len()) {
        let place = |head: &str| format!("curve.csv line {}, {head}", row + 2);
        for (head, right) in COLUMNS.iter().zip(values(sample)) {
            search.digits(run.curve.number(row, head), right, || place(head));
        }
        for (head, stress) in layer_heads(run).iter().zip(&sample.layer_stress) {
            let right = stress / 1e6;
            search.digits(run.curve.number(row, head), right, || place(head));
        }
    }
    search.end(0.0, "-", "")
}

fn layers(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    let info = &run.trajectory.info;
    for sample in &run.trajectory.samples {
        let greatest = sample.wire_stress.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
        for (k, stress) in sample.layer_stress.iter().enumerate() {
            let of: Vec<f64> =
                (0..info.wires.len()).filter(|w| info.wires[*w].layer == k).map(|w| sample.wire_stress[w]).collect();
            let mean = of.iter().sum::<f64>() / of.len() as f64;
            search.compare(*stress, mean, greatest, || format!("{} at step {} [Pa]", info.layers[k], sample.step));
        }
    }
    search.end(1e-12, "-", "no stress of layers is measured")
}

fn wires(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    let info = &run.trajectory.info;
    for row in 0..run.wires.rows.len().min(info.wires.len()) {
        let place = |head: &str| format!("wires.csv line {}, {head}", row + 2);
        let number = |head: &str| run.wires.number(row, head);
        let wire = &info.wires[row];
        search.same(number("wire"), (row + 1) as f64, || place("wire"));
        search.same(run.wires.text(row, "layer"), info.layers[wire.layer].as_str(), || place("layer"));
        // The table has it in single precision.
        search.same(number("diameter_mm") as f32, (wire.diameter * 1e3) as f32, || place("diameter_mm"));
        let most = run.trajectory.samples.iter().filter_map(|s| s.wire_stress.get(row)).map(|s| s / 1e6);
        if let Some(most) = most.reduce(f64::max).filter(|_| !run.wires.text(row, "greatest_stress_mpa").is_empty()) {
            // Peaks may be seen between rows.
            let short = (most - number("greatest_stress_mpa")) / most.abs().max(f64::MIN_POSITIVE);
            search.add(short, || {
                format!(
                    "{}: {} against {most} in the rows",
                    place("greatest_stress_mpa"),
                    number("greatest_stress_mpa")
                )
            });
        }
        let first = (0..run.ruptures.rows.len()).find(|r| run.ruptures.number(*r, "wire") == (row + 1) as f64);
        search.same(run.wires.text(row, "broken"), if first.is_some() { "yes" } else { "no" }, || place("broken"));
        if let Some(first) = first {
            let same = [
                ("first_rupture_z_mm", "z_mm"),
                ("first_rupture_strain_percent", "strain_percent"),
                ("first_rupture_order", "order"),
                ("first_rupture_cause", "cause"),
            ];
            for (head, in_ruptures) in same {
                search.same(run.wires.text(row, head), run.ruptures.text(first, in_ruptures), || place(head));
            }
        }
    }
    search.end(DIGITS, "-", "there are no wires")
}

fn ruptures(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    let told = &run.trajectory.ruptures;
    if told.is_empty() && run.ruptures.rows.is_empty() {
        return InvariantOutcome::NotApplicable("nothing broke".into());
    }
    let info = &run.trajectory.info;
    search.same(run.ruptures.rows.len(), told.len(), || "rows of ruptures.csv".into());
    for (row, rupture) in told.iter().enumerate() {
        let numbers = [
            ("order", rupture.order as f64),
            ("step", rupture.step as f64),
            ("time_s", rupture.time),
            ("strain_percent", rupture.strain * 100.0),
            ("wire", (rupture.wire + 1) as f64),
            ("bond", (rupture.bond_in_wire + 1) as f64),
            ("z_mm", rupture.position[2] * 1e3),
            ("rest_z_mm", rupture.rest_z * 1e3),
            ("stress_mpa", rupture.stress / 1e6),
            ("body_stress_mpa", rupture.body_stress / 1e6),
        ];
        for (head, right) in numbers {
            search.digits(run.ruptures.number(row, head), right, || format!("ruptures.csv line {}, {head}", row + 2));
        }
        let layer = info.layers[info.wires[rupture.wire].layer].as_str();
        search.same(run.ruptures.text(row, "layer"), layer, || format!("ruptures.csv line {}, layer", row + 2));
    }
    search.end(0.0, "-", "")
}

fn summary(run: &Folder) -> InvariantOutcome {
    let (s, last) = (&run.summary, run.curve.rows.len() - usize::from(!run.curve.rows.is_empty()));
    let number = |head: &str| run.curve.number(last, head);
    let mut search = Search::new();
    let e = &s.energy;
    // A run that failed may have gone on after its last row, which would not have been finite.
    let went_on = s.stopped == StopReason::Failed;
    for (name, value, head) in [("steps", s.cost.steps as f64, "step"), ("simulated_s", s.cost.simulated_s, "time_s")] {
        let right = number(head);
        let value = if went_on { value.min(right) } else { value };
        search.digits(right, value, || format!("{name}, last row's {head}"));
    }
    let pairs = [
        ("final_strain_percent", s.final_strain_percent, "strain_percent"),
        ("residual_stress_mpa", s.residual_stress_mpa, "stress_mpa"),
        ("energy.work", Some(e.work), "work_j"),
        ("energy.kinetic", Some(e.kinetic), "kinetic_j"),
        ("energy.elastic_bonds", Some(e.elastic_bonds), "elastic_bonds_j"),
        ("energy.elastic_contacts", Some(e.elastic_contacts), "elastic_contacts_j"),
        ("energy.plastic_bonds", Some(e.plastic_bonds), "plastic_bonds_j"),
        ("energy.plastic_contacts", Some(e.plastic_contacts), "plastic_contacts_j"),
        ("energy.plastic_thinning", Some(e.plastic_thinning), "plastic_thinning_j"),
        ("energy.friction", Some(e.friction), "friction_j"),
        ("energy.damping", Some(e.damping), "damping_j"),
        ("energy.released", Some(e.released), "released_j"),
    ];
    for (name, value, head) in pairs {
        if let Some(value) = value {
            search.digits(number(head), value, || format!("{name}, last row's {head}"));
        }
    }
    if let Some(first) = &s.first_rupture {
        let pairs = [
            ("order", first.order as f64, "order"),
            ("wire", first.wire as f64, "wire"),
            ("z_mm", first.z_mm, "z_mm"),
            ("strain_percent", first.strain_percent, "strain_percent"),
            ("stress_mpa", first.stress_mpa, "stress_mpa"),
        ];
        for (name, value, head) in pairs {
            let right = run.ruptures.number(0, head);
            search.digits(right, value, || format!("first_rupture.{name}"));
        }
    }
    search.same(s.first_rupture.is_some(), !run.ruptures.rows.is_empty(), || "first_rupture is there".into());
    search.end(0.0, "-", "")
}

fn strength(run: &Folder) -> InvariantOutcome {
    let s = &run.summary;
    let Some(strength) = s.greatest_stress_mpa else {
        return InvariantOutcome::NotApplicable("the summary gives no greatest stress".into());
    };
    let mut search = Search::new();
    for row in 0..run.curve.rows.len() {
        let stress = run.curve.number(row, "stress_mpa");
        search.add((stress - strength) / strength.abs().max(f64::MIN_POSITIVE), || {
            format!("curve.csv line {}: {stress} MPa, summary.json has {strength}", row + 2)
        });
    }
    if let Some(told) = s.tensile_strength_mpa {
        search.compare(told, strength, strength.abs(), || "tensile_strength_mpa against greatest_stress_mpa".into());
    }
    let ends = [s.strain_at_greatest_stress_percent, s.elongation_at_20_percent_drop_percent, s.final_strain_percent];
    let ends: Vec<f64> = ends.into_iter().flatten().collect();
    for pair in ends.windows(2) {
        search.add((pair[0] - pair[1]) / pair[1].abs().max(f64::MIN_POSITIVE), || {
            format!("elongation, its drop and the end are {ends:?} %")
        });
    }
    search.end(DIGITS, "-", "there are no rows")
}

fn recording(run: &Folder) -> InvariantOutcome {
    let file = run.path.join(RECORDED);
    if file.is_file() {
        return look_into_recording(run);
    }
    let mut search = Search::new();
    if partial::name(&file).exists() {
        search.add(1.0, || format!("{RECORDED} is unfinished; `strandsnap record` writes it again"));
    } else if run.summary.written.as_ref().is_some_and(|written| written.recording) {
        search.add(1.0, || format!("{RECORDED} is missing, which the run wrote; `strandsnap record` writes it again"));
    }
    search.end(0.0, "-", "the run wrote no recording")
}

#[cfg(feature = "record")]
fn look_into_recording(run: &Folder) -> InvariantOutcome {
    super::recording::check(run)
}

#[cfg(not(feature = "record"))]
fn look_into_recording(_run: &Folder) -> InvariantOutcome {
    InvariantOutcome::NotApplicable("this program was built without recordings".into())
}
