//! Published tests and simulations of strands: data sets in `assets/reference/`, which studies name to be compared with.
//!
//! Units are those of the publications (mm, MPa, %), named in each field, because that is what is compared and printed.

use serde::Deserialize;
use std::sync::LazyLock;

/// One publication.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Published {
    /// The strand that was tested.
    pub specimen: Specimen,
    /// The tensile test.
    pub experiment: Experiment,
    /// Its own simulations.
    pub simulation: Vec<Simulation>,
    /// Its fitted curves.
    pub fit: Vec<ExponentialFit>,
}

/// The strand that was tested.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Specimen {
    /// Wires per layer, inside out.
    pub wires_per_layer: Vec<usize>,
    /// Wire diameter (mm).
    pub wire_diameter_mm: f64,
    /// Pitch (mm).
    pub pitch_mm: f64,
    /// Lay radius of the outer layer (mm) (printed as a diameter; only a radius fits 18 wires).
    pub outer_lay_radius_mm: f64,
    /// Length (mm).
    pub length_mm: f64,
    /// Gauge length (mm).
    pub gauge_length_mm: f64,
    /// Speed of the test machine (mm/min).
    pub test_speed_mm_per_min: f64,
    /// Friction coefficient (-).
    pub friction: f64,
    /// Nominal section (mm²).
    pub nominal_area_mm2: f64,
}

/// Result of a tensile test.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// The built-in scene of the strand that was tested.
    pub scene: String,
    /// Tensile strength (MPa).
    pub tensile_strength_mpa: f64,
    /// Elongation at fracture (%).
    pub fracture_elongation_percent: f64,
}

/// A simulation of a strand of one pitch and wire diameter.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Simulation {
    /// Pitch (mm).
    pub pitch_mm: f64,
    /// Wire diameter (mm).
    pub wire_diameter_mm: f64,
    /// Tensile strength (MPa).
    pub tensile_strength_mpa: f64,
    /// Elongation at fracture (%).
    pub fracture_elongation_percent: f64,
    /// Error against the experiment, where the paper states it.
    pub error_against_experiment_percent: Option<RelativeError>,
}

/// Error against the experiment.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RelativeError {
    /// Of the tensile strength (%).
    pub strength: f64,
    /// Of the elongation at fracture (%).
    pub elongation: f64,
}

/// A curve that was fitted, y = a exp(b x) + c.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExponentialFit {
    /// Key of the scene that x is.
    pub key: String,
    /// Unit of x.
    pub unit: String,
    /// What y is: "strength" (MPa) or "elongation" (%).
    pub quantity: String,
    /// Amplitude, unit of y.
    pub a: f64,
    /// Rate, 1 over the unit of x.
    pub b: f64,
    /// Level, unit of y.
    pub c: f64,
    /// Mean squared error of leave-one-out cross-validation, as printed.
    pub loo_mse: f64,
}

impl ExponentialFit {
    /// The curve at `x`.
    pub fn value(&self, x: f64) -> f64 {
        self.a * (self.b * x).exp() + self.c
    }
}

impl Published {
    /// The simulation at `pitch_mm` (mm) and `wire_diameter_mm` (mm), if there is one.
    pub fn simulation_at(&self, pitch_mm: f64, wire_diameter_mm: f64) -> Option<&Simulation> {
        self.simulation
            .iter()
            .find(|s| (s.pitch_mm - pitch_mm).abs() < 1e-6 && (s.wire_diameter_mm - wire_diameter_mm).abs() < 1e-6)
    }

    /// The curve fitted to a quantity over a key of the scene in this unit, if there is one.
    pub fn fit_over(&self, key: &str, unit: &str, quantity: &str) -> Option<&ExponentialFit> {
        self.fit.iter().find(|fit| (&*fit.key, &*fit.unit, &*fit.quantity) == (key, unit, quantity))
    }
}

/// Name and text of the data sets that come with the program.
const DATA_SETS: [(&str, &str); 1] = [("zhao-2025", include_str!("../../assets/reference/zhao-2025.toml"))];
static PUBLISHED: LazyLock<Vec<(&str, Published)>> = LazyLock::new(|| {
    let parse = |text| toml::from_str(text).expect("data sets are compiled in, and a test reads them all");
    DATA_SETS.iter().map(|(name, text)| (*name, parse(text))).collect()
});

/// The data set that calibration meets where nothing else is asked for.
pub const CALIBRATED_ON: &str = "zhao-2025";

/// Names of all data sets.
pub fn names() -> impl Iterator<Item = &'static str> {
    DATA_SETS.iter().map(|(name, _)| *name)
}

/// The data set of this name.
pub fn find(name: &str) -> Option<&'static Published> {
    PUBLISHED.iter().find(|(known, _)| *known == name).map(|(_, published)| published)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn asset_parses_and_holds_the_experiment() {
        let paper = find(CALIBRATED_ON).unwrap();
        assert_eq!(paper.specimen.wires_per_layer, [5, 11, 18]);
        assert_eq!(paper.experiment.tensile_strength_mpa, 311.01);
        assert_eq!(paper.experiment.fracture_elongation_percent, 28.57);
        assert_eq!(paper.simulation.len(), 6);
        assert_eq!(paper.simulation_at(40.0, 0.39), None);
    }

    /// The paper's stated errors follow from its own numbers, so none of them is mistyped here.
    #[test]
    fn stated_errors_follow_from_the_numbers() {
        let paper = find(CALIBRATED_ON).unwrap();
        let simulation = paper.simulation_at(39.0, 0.39).unwrap();
        let stated = simulation.error_against_experiment_percent.unwrap();
        let error = |a: f64, b: f64| 100.0 * (b - a) / b;
        let strength = error(simulation.tensile_strength_mpa, paper.experiment.tensile_strength_mpa);
        let elongation = error(simulation.fracture_elongation_percent, paper.experiment.fracture_elongation_percent);
        assert!((strength - stated.strength).abs() < 0.01, "{strength}");
        assert!((elongation - stated.elongation).abs() < 0.01, "{elongation}");
    }

    /// The fitted curves pass near the simulations that they were fitted to.
    #[test]
    fn fits_pass_near_the_simulations() {
        let paper = find(CALIBRATED_ON).unwrap();
        for simulation in &paper.simulation {
            let (key, x) = match simulation.wire_diameter_mm == 0.39 {
                true => ("strand.pitch", simulation.pitch_mm),
                false => ("strand.wire_diameter", simulation.wire_diameter_mm),
            };
            let fit = paper.fit_over(key, "mm", "elongation").unwrap().value(x);
            let difference = fit - simulation.fracture_elongation_percent;
            assert!(difference.abs() < 0.2, "{simulation:?}: {fit}");
        }
    }
}
