//! The numbers of every run: one list, from which the tables, `accuracy.csv` and `accuracy.json` take name, unit, digits and
//! value.

use super::errors::Errors;
use super::rows::{Compared, Row};
use crate::study::column::Column;
use crate::study::statistics::Statistics;
use crate::study::tensile::TensileResult;
use std::sync::LazyLock;

/// A number of a run, and how its mean over seeds is written.
pub struct MeanColumn {
    /// Its name, unit and value for one run.
    pub column: Column<'static, Compared>,
    format: Format,
}

/// How a mean over seeds is written for people.
#[derive(Clone, Copy)]
enum Format {
    /// With the column's decimals.
    Mean,
    /// With its sign, three decimals and its 95 % interval.
    Signed,
    /// The same without a sign.
    Unsigned,
}

/// All of them, in the order of the files.
pub static COLUMNS: LazyLock<[MeanColumn; 16]> = LazyLock::new(|| {
    use Format::{Mean, Signed, Unsigned};
    [
        run("wall_s", "run time", "s", 2, Mean, |run| Some(run.wall_s)),
        run("cpu_s", "CPU", "s", 2, Mean, |run| run.cpu_s),
        run("steps", "steps", "", 0, Mean, |run| Some(run.steps as f64)),
        run("ms_per_step", "ms/step", "", 3, Mean, |run| run.ms_per_step),
        run("particles", "", "", 0, Mean, |run| Some(run.particles as f64)),
        run("strength_mpa", "strength", "MPa", 2, Mean, |run| Some(run.strength_mpa)),
        error("strength_error_percent", "error", "%", Signed, |errors| Some(errors.strength_percent)),
        run("elongation_percent", "elongation", "%", 3, Mean, |run| Some(run.elongation_percent)),
        error("elongation_error_percent", "error", "%", Signed, |errors| Some(errors.elongation_percent)),
        error("curve_error_percent", "curve", "%", Unsigned, |errors| errors.curve_percent),
        error("plastic_work_error_percent", "plastic work", "%", Signed, |errors| errors.plastic_work_percent),
        error("first_break_off_mm", "", "mm", Signed, |errors| errors.first_break_off_mm),
        error("order_tau", "break order τ", "-", Mean, |errors| errors.order_tau),
        run("energy_residual_percent", "energy residual", "%", 3, Signed, |run| run.energy_residual_percent),
        run("kinetic_over_internal", "kinetic/internal", "-", 4, Mean, |run| run.kinetic_over_internal),
        run("grip_mismatch_percent", "grip mismatch", "%", 2, Mean, |run| run.grip_mismatch_percent),
    ]
});

type Head = &'static str;

fn run(
    name: Head,
    heading: Head,
    unit: Head,
    decimals: usize,
    format: Format,
    of: fn(&TensileResult) -> Option<f64>,
) -> MeanColumn {
    MeanColumn { column: Column::new(name, heading, unit, decimals, move |run: &Compared| of(&run.result)), format }
}

fn error(name: Head, heading: Head, unit: Head, format: Format, of: fn(&Errors) -> Option<f64>) -> MeanColumn {
    let of = move |run: &Compared| run.errors.as_ref().and_then(of);
    MeanColumn { column: Column::new(name, heading, unit, 2, of), format }
}

impl MeanColumn {
    /// The mean over the seeds of a row that ran. The same seed gives the same bonds the same strengths, so that the errors
    /// of one seed compare like with like.
    pub fn of_row(&self, row: &Row) -> Option<Statistics> {
        Statistics::of(&row.ran().filter_map(|run| self.column.number(run)).collect::<Vec<_>>())
    }

    /// The mean as people read it; empty where there is none.
    pub fn cell(&self, row: &Row) -> String {
        let Some(stat) = self.of_row(row) else { return String::new() };
        let text = match self.format {
            Format::Mean => return format!("{:.*}", self.column.decimals, stat.mean),
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
pub fn named(name: &str) -> &'static MeanColumn {
    COLUMNS.iter().find(|one| one.column.name == name).unwrap_or_else(|| panic!("no column {name}"))
}
