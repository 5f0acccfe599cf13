//! The tables at snapshots that a scene asks for (`output.tables`).

use super::finding::{InvariantOutcome, Search};
use super::folder::Folder;
use super::invariant::Invariant;
use crate::observe::details::file;
use crate::scene::look::Table;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// A clean interruption makes them whole too.
pub const DETAILS: Invariant = Invariant {
    name: "tables-at-snapshots",
    about: "tables that the scene asks for have rows of every snapshot and no other, contacts as many as the curve tells of",
    check: details,
};

fn details(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    for table in &run.spec.output.tables {
        let name = file(*table);
        match rows_per_step(&run.path.join(name)) {
            Err(what) => search.add(f64::NAN, || format!("{name}: {what}")),
            // The curve counts contacts with rigid bodies too, which are not in this table.
            Ok(_) if *table == Table::Contacts && !run.spec.rigids.is_empty() => {}
            Ok(found) => {
                let expected = expected(run, *table);
                let steps = || expected.keys().chain(found.keys().filter(|step| !expected.contains_key(step)));
                for step in steps() {
                    let [found, right] = [&found, &expected].map(|rows| rows.get(step).copied().unwrap_or(0));
                    search.same(found, right, || format!("rows of {name} at step {step}"));
                }
            }
        }
    }
    search.end(0.0, "-", "the scene asks for no tables")
}

/// How many rows a table has at each snapshot's step.
fn expected(run: &Folder, table: Table) -> BTreeMap<u64, usize> {
    let info = &run.trajectory.info;
    let contacts: HashMap<u64, usize> = run.trajectory.samples.iter().map(|row| (row.step, row.contacts)).collect();
    let rows = |step: u64| match table {
        Table::Positions | Table::Velocities | Table::Spins => info.particles,
        Table::Holds => run.spec.holds.len(),
        Table::Grips => usize::from(info.gauge.is_some()),
        Table::Contacts => contacts.get(&step).copied().unwrap_or(0),
    };
    run.trajectory.snapshots.iter().map(|step| (*step, rows(*step))).collect()
}

fn rows_per_step(path: &Path) -> Result<BTreeMap<u64, usize>, String> {
    let mut reader = csv::Reader::from_path(path).map_err(|e| e.to_string())?;
    let mut rows = BTreeMap::new();
    for record in reader.records() {
        let record = record.map_err(|e| e.to_string())?;
        let step = record.get(0).and_then(|cell| cell.parse().ok()).ok_or("a row has no step")?;
        *rows.entry(step).or_insert(0) += 1;
    }
    Ok(rows)
}
