//! What physics asks of a run.

use super::drive;
use super::finding::{InvariantOutcome, Search};
use super::folder::Folder;
use super::invariant::Invariant;
use crate::base::finding::FindingKind;
use crate::engine::loading_rate::RISE_PASSAGES;
use crate::engine::view::Sample;
use crate::observe::guard::ENERGY_LIMIT;
use crate::observe::stiffness::{self, Row, Stiffness};
use crate::scene::spec::{DriveSpec, GripKind, Shape};
use crate::strand::theory::Theory;

pub const GRIP: Invariant = Invariant {
    name: "wires-and-grips",
    about: "what the wires carry along the strand is what the grips hold, before anything breaks",
    check: grips,
};

pub const WORK: Invariant =
    Invariant { name: "work", about: "the work done is the integral of the curve", check: work };

pub const LEDGER: Invariant = Invariant {
    name: "energy-ledger",
    about: "the energy ledger closes in every row, and its residual is what its terms leave",
    check: ledger,
};

pub const STIFFNESS: Invariant = Invariant {
    name: "initial-stiffness",
    about: "the summary's initial stiffness is the slope of curve.csv",
    check: initial_stiffness,
};

pub const STRAND_THEORY: Invariant =
    Invariant { name: "strand-theory", about: "the initial stiffness is that of strand theory", check: strand_theory };

/// Passages of an elastic wave after which a pull has settled (-).
const SETTLED: f64 = 2.0;

/// Rows from which on forces are compared over all of them together: more than one wave makes of one row.
const MANY: usize = 50;

/// Rows that show how a cycle goes (-).
const ROWS_OF_A_CYCLE: f64 = 8.0;

/// A little more than forces are smoothed over, in passages of an elastic wave (-).
const SMOOTHED: f64 = 0.3;

/// Force along the strand that the wires carry in a row (N): Σ N cos β′, β′ the lay angle of a strand that keeps its volume.
fn carried(run: &Folder, theory: &Theory, row: &Sample) -> f64 {
    // Wires given one by one are a layer each in theory; all of them are straight.
    let slope = |layer: usize| match run.spec.strand {
        Some(_) => theory.layers[layer].lay_angle().tan(),
        None => 0.0,
    };
    let wires = run.trajectory.info.wires.iter().zip(&row.wire_stress);
    wires
        .map(|(wire, stress)| {
            let area = std::f64::consts::FRAC_PI_4 * wire.diameter.powi(2);
            // tan β goes as R/(1 + ε), R as 1/√(1 + ε).
            stress * area / 1f64.hypot(slope(wire.layer) / (1.0 + row.strain).powf(1.5))
        })
        .sum()
}

/// What the wires carry against the mean of the two grips' forces. Wires are measured at mid-gauge and grips at the ends, so
/// that waves along the body, which yield, and grips that swing, set going, pull them apart: by no more than the two grips
/// differ, and than either force changes by while a wave passes, at its fastest in the rows within a passage. A row's own
/// change does not count for it. Waves of a pull come and go, those of a swing do not: over all rows of a pull together, where
/// there are many, the two are proportional to each other with a factor of one.
fn grips(run: &Folder) -> InvariantOutcome {
    let not = |why: &str| InvariantOutcome::NotApplicable(why.into());
    let Some(grip) = run.spec.grip.as_ref().filter(|grip| grip.kind == GripKind::All) else {
        return not("no grips hold every wire");
    };
    let (Some(theory), Some(passage)) = (&run.theory, stiffness::passage(&run.spec)) else {
        return not("the wires are neither laid in layers nor straight along z");
    };
    if !run.spec.holds.is_empty() {
        return not("there are other holds and loads");
    }
    if matches!(grip.drive, DriveSpec::Speed(0.0)) {
        return not("nothing is pulled");
    }
    let samples = &run.trajectory.samples;
    let held: Vec<f64> = samples.iter().map(|row| 0.5 * (row.grip_force[0] + row.grip_force[1])).collect();
    let carried: Vec<f64> = samples.iter().map(|row| carried(run, theory, row)).collect();
    let most = held.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
    // What a force changes by in a passage, from one row to the next.
    let change = |force: &[f64], row: usize| {
        (force[row] - force[row - 1]).abs() / (samples[row].time - samples[row - 1].time) * passage
    };
    let near = |row: usize, other: &usize| (samples[*other].time - samples[row].time).abs() <= passage;
    let mut search = Search::new();
    let (mut rows, mut squares, mut products) = (0, 0.0, 0.0);
    for row in 1..samples.len() {
        let now = &samples[row];
        let quiet = now.energy.kinetic <= run.spec.time.kinetic_limit * now.energy.internal();
        if now.time < SETTLED * passage || now.step >= run.first_rupture() || !quiet {
            continue;
        }
        let before = (1..row).rev().take_while(|other| near(row, other));
        let after = (row + 2..samples.len()).take_while(|other| near(row, other));
        let others = before.chain(after).map(|other| change(&held, other).max(change(&carried, other)));
        let changes = others.fold(change(&held, row), f64::max);
        let mismatch = (now.grip_force[1] - now.grip_force[0]).abs();
        let off = ((carried[row] - held[row]).abs() - changes - mismatch).max(0.0) / most;
        search.add(off, || {
            format!(
                "step {}: wires carry {:.3} N, grips {:.3} N; forces change by {changes:.3} N in a passage",
                now.step, carried[row], held[row]
            )
        });
        (rows, squares) = (rows + 1, squares + held[row] * held[row]);
        products += held[row] * carried[row];
    }
    if rows >= MANY && squares > 0.0 && matches!(grip.drive, DriveSpec::Speed(_)) {
        let factor = products / squares;
        search.add((factor - 1.0).abs(), || format!("over {rows} rows wires carry {factor:.5} of what the grips hold"));
    }
    search.end(0.02, "of the greatest force", "no row is settled, whole and quasi-static")
}

/// ∫ F du + ∫ M dφ of the driven grip by the trapezoid rule on all rows. The rule on every other row tells how well that can be
/// known, and few rows tell no more than a force that rises or falls from one to the next: then the rule is off by half of
/// what the force changes by times the way. An adaptive pull changes the speed of all of the body, which no grip's force
/// shows, as far as its speed can be known from rows. Forces of rows are smoothed over a quarter of a wave's passage, so what the greatest force does in
/// [`SMOOTHED`] may be missing.
fn work(run: &Folder) -> InvariantOutcome {
    let not = |why: &str| InvariantOutcome::NotApplicable(why.into());
    let Some(grip) = run.spec.grip.as_ref().filter(|grip| grip.kind == GripKind::All) else {
        return not("no grips hold every wire, or clamps do work too");
    };
    if !run.spec.holds.is_empty() {
        return not("other holds and loads do work too");
    }
    if !run.spec.rigids.is_empty() {
        return not("rigid bodies do work too");
    }
    let Some(free) = run.free_length else { return not("there is no gauge") };
    if let DriveSpec::Cyclic { frequency, .. } = grip.drive
        && (run.curve.rows.len() as f64)
            < ROWS_OF_A_CYCLE * frequency * run.trajectory.samples.last().map_or(0.0, |row| row.time)
    {
        return not("there are too few rows in a cycle");
    }
    let number = |row: usize, head: &str| run.curve.number(row, head);
    let piece = |a: usize, b: usize| {
        let mean = |head: &str| 0.5 * (number(a, head) + number(b, head));
        let way = (number(b, "strain_percent") - number(a, "strain_percent")) * 1e-2 * free;
        let turn = (number(b, "time_s") - number(a, "time_s")) * grip.rotation_rate;
        mean("grip_force_upper_n") * way + mean("torque_n_mm") * 1e-3 * turn
    };
    let between = |a: usize, b: usize| {
        let change = |head: &str| (number(b, head) - number(a, head)).abs();
        let way = change("strain_percent") * 1e-2 * free;
        0.5 * (change("grip_force_upper_n") * way
            + change("torque_n_mm") * 1e-3 * change("time_s") * grip.rotation_rate.abs())
    };
    let rows = run.curve.rows.len();
    let most = (0..rows).map(|row| number(row, "work_j").abs()).fold(0.0, f64::max);
    let passage = stiffness::passage(&run.spec).unwrap_or(0.0);
    let power = |row: usize| {
        let way = (number(row, "strain_percent") - number(row - 1, "strain_percent")) * 1e-2 * free;
        let time = number(row, "time_s") - number(row - 1, "time_s");
        let force = number(row, "grip_force_upper_n").abs().max(number(row - 1, "grip_force_upper_n").abs());
        (force * way / time).abs() + (number(row, "torque_n_mm") * 1e-3 * grip.rotation_rate).abs()
    };
    // The first rows are smoothed most, so the whole run's greatest power counts from the start.
    let greatest = (1..rows).map(power).filter(|power| power.is_finite()).fold(0.0, f64::max);
    let hastened = |row: usize| match (&grip.adaptive, grip.drive) {
        (Some(adaptive), DriveSpec::Speed(slow)) => {
            let [speed, off] = adaptive_speed(run, row, free, [slow.abs(), adaptive.fastest]);
            [0.5 * (speed.powi(2) - slow.powi(2)), speed * off].map(|square| square * run.affine_mass)
        }
        _ => [0.0; 2],
    };
    let (mut fine, mut coarse, mut widest) = (0.0, 0.0, 0.0);
    let mut search = Search::new();
    for row in (2..rows).step_by(2) {
        fine += piece(row - 2, row - 1) + piece(row - 1, row);
        coarse += piece(row - 2, row);
        widest += between(row - 2, row - 1) + between(row - 1, row);
        let done = number(row, "work_j") - number(0, "work_j");
        let [hastened, uncertain] = hastened(row);
        let right = fine + hastened;
        // Simpson's estimate of the trapezoid's error is a third of the difference.
        let rule = (fine - coarse).abs().max(widest);
        let slack = rule + uncertain + greatest * SMOOTHED * passage;
        let off = ((right - done).abs() - slack).max(0.0) / most;
        search.add(off, || format!("curve.csv line {}: {done:.6e} J, integral {right:.6e} J", row + 2));
    }
    search.end(0.01, "of the work", "there are fewer than three rows")
}

/// Speed of an adaptive pull at a row, between its slow and its fastest one, and by how much it may be off (m/s): the way of the
/// rows of one passage over their time. Steps decide on which instants a row's mean is made of, so that a way may be what the
/// grip does in two of them off; and within a passage the speed itself changes, by no more than the law of it allows.
fn adaptive_speed(run: &Folder, row: usize, free: f64, [slow, fastest]: [f64; 2]) -> [f64; 2] {
    let passage = run.trajectory.info.wave_passage;
    let time =
        |row: usize| run.curve.number(row, "time_s") - 0.5 * drive::smoothed(run, run.curve.number(row, "time_s"));
    let first = (0..row).rev().find(|first| time(row) - time(*first) >= passage).unwrap_or(0);
    let (way, passed) =
        (run.curve.number(row, "strain_percent") - run.curve.number(first, "strain_percent"), time(row) - time(first));
    let speed = (way.abs() * 1e-2 * free / passed).clamp(slow, fastest);
    let off = fastest * (2.0 * run.longest_step() / passed + passed / (RISE_PASSAGES * passage));
    [speed, off.min(fastest - slow)]
}

/// Energy that is nothing (J): an elastic strain of 1e-9 everywhere.
fn negligible(run: &Folder) -> f64 {
    let info = &run.trajectory.info;
    let young = |number: usize| run.spec.material_at(number).material.young;
    let stiffness: f64 = info
        .wires
        .iter()
        .map(|wire| {
            let points = &info.rest_position[wire.first..wire.first + wire.len];
            let length: f64 = points
                .windows(2)
                .map(|p| (0..3).map(|k| f64::from(p[1][k] - p[0][k]).powi(2)).sum::<f64>().sqrt())
                .sum();
            young(wire.material) * std::f64::consts::FRAC_PI_4 * wire.diameter.powi(2) * length
        })
        .chain(run.spec.spheres.iter().map(|s| young(s.material) * std::f64::consts::PI / 6.0 * s.diameter.powi(3)))
        .sum();
    0.5 * 1e-18 * stiffness
}

fn ledger(run: &Folder) -> InvariantOutcome {
    let terms = [
        "kinetic_j",
        "elastic_bonds_j",
        "elastic_contacts_j",
        "plastic_bonds_j",
        "plastic_contacts_j",
        "plastic_thinning_j",
        "friction_j",
        "damping_j",
        "released_j",
    ];
    let nothing = negligible(run);
    let mut most = 0.0f64;
    let mut search = Search::new();
    for row in 0..run.curve.rows.len() {
        let number = |head: &str| run.curve.number(row, head);
        most = most.max(number("work_j").abs());
        let left = number("work_j") - terms.iter().map(|head| number(head)).sum::<f64>();
        let place = || format!("curve.csv line {}", row + 2);
        let off = if left.abs() <= nothing { 0.0 } else { left.abs() / most };
        search.add(off, || format!("{}: {left:.4e} J of {most:.4e} J are unaccounted for", place()));
        // Terms have nine digits each.
        let sum: f64 = terms.iter().map(|head| number(head).abs()).sum::<f64>() + number("work_j").abs();
        let told = (number("residual_j") - left).abs();
        let off = if told <= 1e-8 * sum + nothing * 1e-9 { 0.0 } else { 1.0 };
        search
            .add(off, || format!("{}: residual_j is {:e}, its terms leave {left:e} J", place(), number("residual_j")));
    }
    search.end(ENERGY_LIMIT, "of the work", "there are no rows")
}

/// The stiffness by `curve.csv` itself.
fn measured(run: &Folder) -> Option<Stiffness> {
    let number = |row: usize, head: &str| run.curve.number(row, head);
    let rows: Vec<Row> = (0..run.curve.rows.len())
        .take_while(|row| number(*row, "bonds_broken") == 0.0)
        .map(|row| Row {
            time: number(row, "time_s"),
            strain: number(row, "strain_percent") * 1e-2,
            stress: number(row, "stress_mpa") * 1e6,
            torque: number(row, "torque_n_mm") * 1e-3,
        })
        .collect();
    stiffness::measure(&rows, &run.spec)
}

fn initial_stiffness(run: &Folder) -> InvariantOutcome {
    let (Some(found), Some(told)) = (measured(run), &run.summary.stiffness) else {
        let both = measured(run).is_some() == run.summary.stiffness.is_some();
        let mut search = Search::new();
        if !both {
            search.add(1.0, || "strand theory has something to say, or not, and the summary the other".into());
        }
        return search.end(0.0, "-", "this is no pull that strand theory speaks of");
    };
    let mut search = Search::new();
    search.compare(told.expected_gpa, found.expected_gpa, found.expected_gpa, || "expected_gpa".into());
    search.same(told.not_measured.is_some(), found.not_measured.is_some(), || "not_measured is there".into());
    let pairs = [(told.measured_gpa, found.measured_gpa), (told.measured_torque_n_m, found.measured_torque_n_m)];
    for ((told, found), name) in pairs.into_iter().zip(["measured_gpa", "measured_torque_n_m"]) {
        if let (Some(told), Some(found)) = (told, found) {
            search.compare(told, found, found.abs(), || name.into());
        }
    }
    search.end(1e-5, "-", "")
}

fn strand_theory(run: &Folder) -> InvariantOutcome {
    let Some(found) = measured(run) else {
        return InvariantOutcome::NotApplicable("this is no pull that strand theory speaks of".into());
    };
    let [from, to] = found.window_percent;
    let Some(deviation) = found.deviation_percent else {
        let why = found.not_measured.map_or("", |why| why.word());
        return InvariantOutcome::NotApplicable(format!("{why} (window {from:.3} to {to:.3} %)"));
    };
    let said = run.summary.findings.iter().any(|found| found.finding.kind() == FindingKind::Stiffness);
    let spheres = run.spec.contact.as_ref().is_some_and(|c| c.shape == Shape::Sphere);
    if spheres && said && deviation < 0.0 {
        return InvariantOutcome::NotApplicable(format!(
            "touching spheres are softer than smooth wires: {deviation:.1} %, which the summary says"
        ));
    }
    let mut search = Search::new();
    search.add(deviation.abs() * 1e-2, || {
        let measured = found.measured_gpa.unwrap_or(f64::NAN);
        format!("{measured:.2} GPa measured, {:.2} GPa expected ({deviation:+.2} %)", found.expected_gpa)
    });
    search.end(stiffness::LIMIT, "-", "")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::{RunOptions, run};
    use crate::scene;
    use std::sync::atomic::AtomicBool;

    /// What all wires show too much of all the time hides in no wave.
    #[test]
    fn three_per_cent_of_all_wires_in_all_rows_are_seen() {
        let set =
            ["strand.length=20 mm", "grip.length=4 mm", "grip.speed=8 m/s", "stop.strain=4 %", "output.samples=300"];
        let scene = scene::load("strand-1x7", &set.map(String::from)).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("run");
        run(&scene, &RunOptions { threads: Some(1), ..RunOptions::tables(&out) }, &AtomicBool::new(false)).unwrap();
        let mut seen = Folder::read(&out).unwrap();
        assert!(matches!(grips(&seen), InvariantOutcome::Passed(_)), "{:?}", grips(&seen));
        for factor in [0.97, 1.03] {
            let before = seen.trajectory.samples.clone();
            let stresses = seen.trajectory.samples.iter_mut().flat_map(|row| &mut row.wire_stress);
            stresses.for_each(|stress| *stress *= factor);
            let InvariantOutcome::Failed(found) = grips(&seen) else { panic!("{factor}: {:?}", grips(&seen)) };
            assert!(found.place.contains("wires carry"), "{}", found.place);
            seen.trajectory.samples = before;
        }
    }
}
