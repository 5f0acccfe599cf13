//! What must hold of the rows of the tables by themselves.

use super::finding::{InvariantOutcome, Search};
use super::folder::Folder;
use super::invariant::Invariant;

pub const FINITE: Invariant =
    Invariant { name: "finite", about: "every number in the tables is finite", check: finite };

pub const TIME: Invariant =
    Invariant { name: "time", about: "steps and times rise from row to row and from rupture to rupture", check: time };

pub const TIME_STEP: Invariant = Invariant {
    name: "time-step",
    about: "time over steps lies between the least and the greatest time step of the summary",
    check: time_step,
};

pub const FORCE: Invariant = Invariant {
    name: "stress-unit",
    about: "stress in MPa is the upper grip's force in N over the wires' sections in mm²",
    check: force,
};

/// Heads of the layers' columns in `curve.csv`.
pub fn layer_heads(run: &Folder) -> Vec<String> {
    run.trajectory.info.layers.iter().map(|name| format!("stress_{}_mpa", name.replace(' ', "_"))).collect()
}

fn finite(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    for table in [&run.curve, &run.wires, &run.ruptures] {
        for (value, line, head) in table.numbers() {
            let off = if value.is_finite() { 0.0 } else { 1.0 };
            search.add(off, || format!("{} line {line}, {head}: {value}", table.name));
        }
    }
    search.end(0.0, "-", "the tables are empty")
}

fn time(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    let mut rising = |table: &super::tables::Table, head: &str, strictly: bool| {
        for row in 1..table.rows.len() {
            let rise = table.number(row, head) - table.number(row - 1, head);
            let holds = if strictly { rise > 0.0 } else { rise >= 0.0 };
            search.add(f64::from(u8::from(!holds)), || {
                format!("{} line {}, {head} changes by {rise}", table.name, row + 2)
            });
        }
    };
    for head in ["step", "time_s"] {
        rising(&run.curve, head, true);
        rising(&run.ruptures, head, false);
    }
    rising(&run.ruptures, "order", true);
    search.end(0.0, "-", "there is one row")
}

fn time_step(run: &Folder) -> InvariantOutcome {
    let limits = &run.summary.limits;
    let (least, greatest) = (limits.least_time_step.seconds, limits.greatest_time_step.seconds);
    let mut search = Search::new();
    for row in 1..run.curve.rows.len() {
        let rise = |head: &str| run.curve.number(row, head) - run.curve.number(row - 1, head);
        let mean = rise("time_s") / rise("step");
        // Times have nine digits.
        let rounding = 1e-8 * run.curve.number(row, "time_s") / rise("step");
        let off = (least - mean).max(mean - greatest) - rounding;
        search.add(off / greatest, || {
            format!("curve.csv line {}: {mean:e} s a step, summary.json has {least:e} to {greatest:e} s", row + 2)
        });
    }
    search.end(1e-6, "-", "there is one row")
}

fn force(run: &Folder) -> InvariantOutcome {
    let area = run.area();
    if !run.is_gripped() || area == 0.0 {
        return InvariantOutcome::NotApplicable("no grips hold this body".into());
    }
    let mut search = Search::new();
    for row in 0..run.curve.rows.len() {
        let stress = run.curve.number(row, "stress_mpa");
        let force = run.curve.number(row, "grip_force_upper_n");
        search
            .compare(stress, force / (area * 1e6), stress.abs(), || format!("curve.csv line {}, stress_mpa", row + 2));
    }
    search.end(1e-6, "-", "there are no rows")
}
