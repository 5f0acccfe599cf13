//! The stress-strain curve as recording, frames and page draw it: what is plotted, in the units of its axes, % and MPa.

use super::wording::layer_words;
use crate::base::units::{mpa, percent};
use crate::engine::view::{RunInfo, Rupture, Sample};

/// Title of the horizontal axis.
pub const STRAIN: &str = "nominal strain (%)";
/// Title of the vertical axis.
pub const STRESS: &str = "nominal stress (MPa)";

/// A curve.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Series {
    /// Its name.
    pub name: String,
    /// The layer whose mean it is; `None` for the body.
    pub layer: Option<usize>,
}

/// The curve of the body, then those of its layers where there are several: one alone has the curve of the body.
pub fn series(info: &RunInfo) -> Vec<Series> {
    let body = Series { name: if info.wires.len() > 1 { "strand" } else { "wire" }.to_owned(), layer: None };
    let layers = (0..info.layers.len()).filter(|_| info.layers.len() > 1);
    std::iter::once(body)
        .chain(layers.map(|layer| Series { name: layer_words(info, layer), layer: Some(layer) }))
        .collect()
}

/// A place in the chart (%, MPa), from strain (-) and nominal stress (Pa).
pub fn place(strain: f64, stress: f64) -> [f64; 2] {
    [percent(strain), mpa(stress)]
}

/// A row's point of a series (%, MPa); NaN where its stress is not measured.
pub fn point(series: &Series, sample: &Sample) -> [f64; 2] {
    let stress = match series.layer {
        None => sample.stress,
        Some(layer) => sample.layer_stress.get(layer).copied().unwrap_or(f64::NAN),
    };
    place(sample.strain, stress)
}

/// Where a rupture is marked (%, MPa): on the curve of the body, as it was just before.
pub fn mark(rupture: &Rupture) -> [f64; 2] {
    place(rupture.strain, rupture.body_stress)
}

/// Where the run is expected to end, and the greatest nominal stress until then (%, MPa): what the axes must hold. 0 % where
/// the end is not known.
pub fn expected(info: &RunInfo) -> [f64; 2] {
    let end = info.strain_end.unwrap_or(0.0);
    // True stress over stretch is nominal stress.
    place(end, info.body_stress_end.unwrap_or(info.stress_range[1] / (1.0 + end)))
}
