//! No bond above its law.

use super::finding::{InvariantOutcome, Search};
use super::folder::{Folder, bond};
use super::invariant::Invariant;
use super::limits::{Bounds, Limits};
use super::rows;

pub const BONDS: Invariant = Invariant {
    name: "bond-law",
    about: "no bond of a snapshot carries more true stress than its law gives at its plastic strain or its stretch",
    // Snapshots are in single precision.
    check: |run| run.snapshots.law.clone().end(1e-3, "-", "no snapshot has a bond that holds"),
};

pub const WIRES: Invariant = Invariant {
    name: "wire-law",
    about: "no wire and no layer of any row or table carries more than the law gives before it breaks, pulled or pushed",
    check: wires,
};

pub const RUPTURES: Invariant = Invariant {
    name: "rupture-law",
    about: "bonds break at their limit: none holds beyond it, none breaks at more stress than its law has there",
    check: ruptures,
};

fn wires(run: &Folder) -> InvariantOutcome {
    let info = &run.trajectory.info;
    let limits = Limits::new(&run.spec, info, run.longest_step());
    let of_material: Vec<Bounds> = (0..info.materials.len()).map(|number| limits.wire(number)).collect();
    if !of_material.iter().any(|bounds| bounds.limits()) {
        return InvariantOutcome::NotApplicable("nothing limits what the bonds of this scene carry".into());
    }
    let mut search = Search::new();
    // A table may have rows that belong to no wire, which another invariant tells.
    let wire = |w: usize| info.wires.get(w).map_or(Bounds::NONE, |wire| of_material[wire.material]);
    let mut add = |stress: f64, bounds: Bounds, place: &dyn Fn() -> String| {
        let over = || format!("{}: {stress:.2} MPa, wires carry {:.2}", place(), bounds.of(stress));
        search.add(bounds.over(stress), over);
    };
    for row in 0..run.curve.rows.len() {
        for (layer, head) in rows::layer_heads(run).into_iter().enumerate() {
            let stress = run.curve.number(row, &head);
            if !run.curve.text(row, &head).is_empty() {
                let bounds = info.wires_of(layer).map(|(w, _)| wire(w)).reduce(Bounds::wider).unwrap_or(Bounds::NONE);
                add(stress, bounds, &|| format!("curve.csv line {}, {head}", row + 2));
            }
        }
    }
    for row in 0..run.wires.rows.len() {
        if !run.wires.text(row, "greatest_stress_mpa").is_empty() {
            add(run.wires.number(row, "greatest_stress_mpa"), wire(row), &|| {
                format!("wires.csv line {}, greatest_stress_mpa", row + 2)
            });
        }
    }
    for sample in &run.trajectory.samples {
        for (w, stress) in sample.wire_stress.iter().enumerate() {
            add(stress * 1e-6, wire(w), &|| format!("trajectory at step {}, wire {}", sample.step, w + 1));
        }
    }
    search.end(1e-3, "-", "no stress of wires is measured")
}

fn ruptures(run: &Folder) -> InvariantOutcome {
    let info = &run.trajectory.info;
    let limits = Limits::new(&run.spec, info, run.longest_step());
    let mut search = run.snapshots.rupture.clone();
    for (k, rupture) in run.trajectory.ruptures.iter().enumerate() {
        let (bounds, stress) = (limits.breaking(rupture.bond, k == 0), rupture.stress * 1e-6);
        if bounds.limits() {
            let place = || format!("rupture {} ({})", rupture.order, bond(info, rupture.bond));
            let over = || format!("{}: {stress:.2} MPa, its law has {:.2}", place(), bounds.of(stress));
            search.add(bounds.over(stress), over);
        }
    }
    search.end(1e-3, "-", "nothing breaks in this scene")
}
