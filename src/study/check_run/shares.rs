//! Who carries the load, where wires are of several materials.

use super::finding::{InvariantOutcome, Search};
use super::folder::Folder;
use super::invariant::Invariant;
use crate::observe::materials::GreatestForce;

pub const SHARES: Invariant = Invariant {
    name: "shares",
    about: "forces by layer and by material add up to the same; stress by material is its wires' force over their sections; forces \
            of the summary are its stresses over all sections",
    check: shares,
};

/// Digits of a table (-).
const DIGITS: f64 = 1e-7;

fn shares(run: &Folder) -> InvariantOutcome {
    let info = &run.trajectory.info;
    let area: f64 = info.wires.iter().map(|wire| section(wire.diameter)).sum();
    let s = &run.summary;
    let mut search = Search::new();
    let forces = [
        ("breaking_force_n", s.breaking_force_n, s.tensile_strength_mpa),
        ("greatest_force_n", s.greatest_force_n, s.greatest_stress_mpa),
    ];
    for (name, force, stress) in forces {
        if let (Some(force), Some(stress)) = (force, stress) {
            let right = stress * 1e6 * area;
            search.compare(force, right, right.abs(), || name.into());
        }
    }
    if info.materials.len() > 1 {
        rows(run, &mut search);
        summary(run, &mut search);
    }
    search.end(DIGITS, "-", "the summary has no force, and wires are of one material")
}

fn section(diameter: f64) -> f64 {
    std::f64::consts::FRAC_PI_4 * diameter * diameter
}

/// Rows of `curve.csv` against the wires of the trajectory.
fn rows(run: &Folder, search: &mut Search) {
    let info = &run.trajectory.info;
    let of_layer = |k: usize| format!("force_{}_n", info.layers[k].replace(' ', "_"));
    let with_wires = |k: &usize| info.wires.iter().any(|wire| wire.material == *k);
    let materials: Vec<usize> = (0..info.materials.len()).filter(with_wires).collect();
    for (row, sample) in run.trajectory.samples.iter().enumerate().take(run.curve.rows.len()) {
        if sample.wire_pull.is_empty() {
            continue;
        }
        let place = |head: &str| format!("curve.csv line {}, {head}", row + 2);
        let most = sample.wire_pull.iter().map(|force| force.abs()).sum::<f64>();
        let number = |head: &str| run.curve.number(row, head);
        for k in 0..info.layers.len() {
            let wires = info.wires.iter().zip(&sample.wire_pull).filter(|(wire, _)| wire.layer == k);
            let right = wires.map(|(_, force)| force).sum();
            search.compare(number(&of_layer(k)), right, most, || place(&of_layer(k)));
        }
        let layers: f64 = (0..info.layers.len()).map(|k| number(&of_layer(k))).sum();
        let together: f64 = materials.iter().map(|k| number(&format!("material_{}_n", info.materials[*k]))).sum();
        search.compare(together, layers, most, || place("materials together, against layers"));
        for k in &materials {
            let head = format!("material_{}_mpa", info.materials[*k]);
            let wires = || info.wires.iter().zip(&sample.wire_stress).filter(|(wire, _)| wire.material == *k);
            let force: f64 = wires().map(|(wire, stress)| stress * section(wire.diameter)).sum();
            let sections: f64 = wires().map(|(wire, _)| section(wire.diameter)).sum();
            let right = force / sections * 1e-6;
            search.compare(number(&head), right, most / sections * 1e-6, || place(&head));
        }
    }
}

/// The shares of the summary against the row that they are of.
fn summary(run: &Folder, search: &mut Search) {
    let Some(shares) = &run.summary.shares_at_greatest_stress else { return };
    let force = |row: usize| run.curve.number(row, "grip_force_upper_n");
    let mut greatest = GreatestForce::default();
    let rows = run.trajectory.samples.iter().take(run.curve.rows.len()).enumerate();
    let seen = rows.filter(|(_, sample)| greatest.see(&run.trajectory.info, sample));
    let Some((row, _)) = seen.last() else { return };
    search.compare(shares.force_n, force(row), force(row).abs(), || "force_n of shares_at_greatest_stress".into());
    for share in &shares.materials {
        let told = run.curve.number(row, &format!("material_{}_n", share.name));
        search.compare(share.force_n, told, force(row).abs(), || format!("share of {}", share.name));
    }
    for share in &shares.layers {
        let told = run.curve.number(row, &format!("force_{}_n", share.name.replace(' ', "_")));
        search.compare(share.force_n, told, force(row).abs(), || format!("share of layer {}", share.name));
    }
}
