//! Against what the charts of a run are drawn: strain where a body is pulled, time where it is not.

use super::source::Source;
use crate::base::units::{ms, percent};
use crate::engine::view::{RunInfo, Rupture, Sample};
use crate::observe::stress_strain::STRAIN;

/// The quantity along the horizontal axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Abscissa {
    /// Strain of the body (%).
    Strain,
    /// Simulated time (ms).
    Time,
}

impl Abscissa {
    /// That of a run.
    pub fn of(source: &Source) -> Self {
        Self::of_run(&source.info)
    }

    /// The same of a run that has no folder yet.
    pub fn of_run(info: &RunInfo) -> Self {
        if info.is_pulled() { Self::Strain } else { Self::Time }
    }

    /// Title of the axis, with its unit.
    pub fn title(self) -> &'static str {
        match self {
            Self::Strain => STRAIN,
            Self::Time => "time (ms)",
        }
    }

    /// How a chart tells its value, as Plotly writes it.
    pub fn hover(self) -> &'static str {
        match self {
            Self::Strain => "strain %{x:.3f} %",
            Self::Time => "time %{x:.4f} ms",
        }
    }

    /// Its value in a row, in the unit of the title.
    pub fn value(self, row: &Sample) -> f64 {
        self.either(row.strain, row.time)
    }

    /// Its value at a rupture.
    pub fn at(self, rupture: &Rupture) -> f64 {
        self.either(rupture.strain, rupture.time)
    }

    /// A moment for people: `27.99 % strain`, `0.4100 ms`.
    pub fn moment(self, value: f64) -> String {
        match self {
            Self::Strain => format!("{value:.2} % strain"),
            Self::Time => format!("{value:.4} ms"),
        }
    }

    fn either(self, strain: f64, time: f64) -> f64 {
        match self {
            Self::Strain => percent(strain),
            Self::Time => ms(time),
        }
    }
}
