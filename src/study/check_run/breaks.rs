//! What must hold of broken wires and bonds.

use super::finding::{InvariantOutcome, Search};
use super::folder::Folder;
use super::invariant::Invariant;
use std::collections::{BTreeMap, BTreeSet};

pub const COUNTS: Invariant = Invariant {
    name: "break-counts",
    about: "curve, wires, ruptures and summary have the same number of broken wires and bonds",
    check: counts,
};

pub const ROWS: Invariant =
    Invariant { name: "breaks-by-row", about: "each row of the curve counts the ruptures up to its step", check: rows };

pub const SILENT: Invariant = Invariant {
    name: "broken-bonds",
    about: "a broken bond carries exactly nothing in every snapshot from its break on",
    check: |run| run.snapshots.silent.clone().end(0.0, "MPa", "nothing was broken in any snapshot"),
};

pub const SILENT_WIRES: Invariant = Invariant {
    name: "broken-wires",
    about: "a wire whose bonds at mid-gauge are all broken has exactly no stress in any row",
    check: silent_wires,
};

fn counts(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    let told = &run.trajectory.ruptures;
    let broken: BTreeSet<usize> = told.iter().map(|r| r.wire).collect();
    let mut same = |found: usize, right: usize, place: &str| search.same(found, right, || place.into());
    let listed: BTreeSet<&str> = (0..run.ruptures.rows.len()).map(|row| run.ruptures.text(row, "wire")).collect();
    let marked = (0..run.wires.rows.len()).filter(|row| run.wires.text(*row, "broken") == "yes").count();
    same(run.ruptures.rows.len(), told.len(), "rows of ruptures.csv");
    same(run.summary.bonds_broken, told.len(), "bonds_broken in summary.json");
    same(run.summary.wires_broken, broken.len(), "wires_broken in summary.json");
    same(listed.len(), broken.len(), "wires in ruptures.csv");
    same(marked, broken.len(), "wires in wires.csv that are broken");
    same(run.wires.rows.len(), run.trajectory.info.wires.len(), "rows of wires.csv");
    let by_layer = &run.summary.wires_broken_by_layer;
    same(by_layer.values().map(|n| n.broken).sum(), broken.len(), "wires_broken_by_layer in summary.json");
    same(by_layer.values().map(|n| n.of).sum(), run.trajectory.info.wires.len(), "wires in wires_broken_by_layer");
    let firsts = run.summary.breaks_by_layer.values().map(Vec::len).sum();
    same(firsts, broken.len(), "breaks_by_layer in summary.json");
    search.end(0.0, "-", "")
}

fn rows(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    for row in 0..run.curve.rows.len() {
        let step = run.curve.number(row, "step");
        let until: Vec<usize> =
            (0..run.ruptures.rows.len()).filter(|r| run.ruptures.number(*r, "step") <= step).collect();
        let wires: BTreeSet<&str> = until.iter().map(|r| run.ruptures.text(*r, "wire")).collect();
        for (head, right) in [("bonds_broken", until.len()), ("wires_broken", wires.len())] {
            search.same(run.curve.number(row, head), right as f64, || format!("curve.csv line {}, {head}", row + 2));
        }
    }
    search.end(0.0, "-", "there are no rows")
}

fn silent_wires(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    let broken: BTreeMap<usize, u64> = run.trajectory.ruptures.iter().rev().map(|r| (r.bond, r.step)).collect();
    for w in 0..run.trajectory.info.wires.len() {
        let steps: Option<Vec<u64>> = run.middle(w).iter().map(|slot| broken.get(slot).copied()).collect();
        let Some(from) = steps.and_then(|steps| steps.into_iter().max()) else { continue };
        for sample in run.trajectory.samples.iter().filter(|sample| sample.step >= from) {
            let stress = sample.wire_stress.get(w).map_or(0.0, |stress| stress * 1e-6);
            search.add(stress.abs(), || format!("wire {} at step {}: {stress:.3} MPa", w + 1, sample.step));
        }
    }
    search.end(0.0, "MPa", "no wire has lost all its bonds at mid-gauge")
}
