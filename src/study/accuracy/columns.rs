//! What is told of every run in numbers: one list, from which the tables, `accuracy.csv` and `accuracy.json` take name,
//! unit, digits and value.

use super::errors::Errors;
use super::rows::Row;
use crate::study::cases::measured::Measured;
use crate::study::cases::stat::Stat;
use serde::{Serialize, Serializer, ser::SerializeMap};

/// A number of a run.
pub struct Column {
    /// Name in files, with its unit.
    pub name: &'static str,
    /// Head in tables, with its unit; empty for what only stands in files.
    pub head: &'static str,
    /// How its mean over seeds is written.
    format: Format,
    /// Where it comes from.
    of: Of,
}

/// How a mean over seeds is written for people.
#[derive(Clone, Copy)]
enum Format {
    /// With this many decimals.
    Mean(usize),
    /// With its sign, three decimals and its interval.
    Signed,
    /// The same without a sign.
    Unsigned,
}

/// Where a number comes from.
enum Of {
    Run(fn(&Measured) -> Option<f64>),
    Error(fn(&Errors) -> Option<f64>),
}

/// All of them, in the order of the files.
pub const COLUMNS: [Column; 16] = [
    run("wall_s", "run time [s]", Format::Mean(2), |run| Some(run.wall_s)),
    run("cpu_s", "CPU [s]", Format::Mean(2), |run| run.cpu_s),
    run("steps", "steps", Format::Mean(0), |run| Some(run.steps as f64)),
    run("ms_per_step", "ms/step", Format::Mean(3), |run| run.ms_per_step),
    run("particles", "", Format::Mean(0), |run| Some(run.particles as f64)),
    run("strength_mpa", "strength [MPa]", Format::Mean(2), |run| Some(run.strength_mpa)),
    error("strength_error_percent", "error [%]", Format::Signed, |errors| Some(errors.strength_percent)),
    run("elongation_percent", "elongation [%]", Format::Mean(3), |run| Some(run.elongation_percent)),
    error("elongation_error_percent", "error [%]", Format::Signed, |errors| Some(errors.elongation_percent)),
    error("curve_error_percent", "curve [%]", Format::Unsigned, |errors| errors.curve_percent),
    error("plastic_work_error_percent", "plastic work [%]", Format::Signed, |errors| errors.plastic_work_percent),
    error("first_break_off_mm", "", Format::Signed, |errors| errors.first_break_off_mm),
    error("order_tau", "break order τ [-]", Format::Mean(2), |errors| errors.order_tau),
    run("energy_residual_percent", "energy residual [%]", Format::Signed, |run| run.energy_residual_percent),
    run("kinetic_over_internal", "kinetic/internal [-]", Format::Mean(4), |run| run.kinetic_over_internal),
    run("grip_mismatch_percent", "grip mismatch [%]", Format::Mean(2), |run| run.grip_mismatch_percent),
];

const fn run(name: &'static str, head: &'static str, format: Format, value: fn(&Measured) -> Option<f64>) -> Column {
    Column { name, head, format, of: Of::Run(value) }
}

const fn error(name: &'static str, head: &'static str, format: Format, value: fn(&Errors) -> Option<f64>) -> Column {
    Column { name, head, format, of: Of::Error(value) }
}

impl Column {
    /// The value of one run; `errors` where its seed has a reference.
    pub fn of_run(&self, measured: &Measured, errors: Option<&Errors>) -> Option<f64> {
        match self.of {
            Of::Run(value) => value(measured),
            Of::Error(value) => errors.and_then(value),
        }
    }

    /// The mean over the seeds of a row that ran. The same seed gives the same bonds the same strengths, so that the errors
    /// of one seed compare like with like.
    pub fn of_row(&self, row: &Row) -> Option<Stat> {
        let values = row.ran().filter_map(|(measured, errors)| self.of_run(measured, errors));
        Stat::of(&values.collect::<Vec<_>>())
    }

    /// The mean as people read it; empty where there is none.
    pub fn cell(&self, row: &Row) -> String {
        let Some(stat) = self.of_row(row) else { return String::new() };
        let text = match self.format {
            Format::Mean(decimals) => return format!("{:.decimals$}", stat.mean),
            Format::Signed => signed(stat.mean),
            Format::Unsigned => format!("{:.3}", stat.mean),
        };
        stat.interval_95.map_or(text.clone(), |half| format!("{text} ± {half:.3}"))
    }
}

/// With its sign and three decimals; what rounds to nothing has no sign.
pub fn signed(value: f64) -> String {
    match format!("{value:+.3}").as_str() {
        "+0.000" | "-0.000" => "0.000".into(),
        text => text.into(),
    }
}

/// Column by its name in files.
///
/// # Panics
/// When there is none of that name, which a test of every table sees.
pub fn named(name: &str) -> &'static Column {
    COLUMNS.iter().find(|column| column.name == name).unwrap_or_else(|| panic!("no column {name}"))
}

/// The means of a row by the names of their columns.
pub struct Means<'a>(pub &'a Row);

impl Serialize for Means<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(COLUMNS.len()))?;
        for column in &COLUMNS {
            map.serialize_entry(column.name, &column.of_row(self.0))?;
        }
        map.end()
    }
}
