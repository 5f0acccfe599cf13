//! The numbers that the reference paper prints, from `assets/reference/paper.toml`.
//!
//! Zhao, Bai, Zhang, Lin, Liu: discrete element modeling and tensile fracture of the control unit stranded wire of
//! shearer cables. Scientific Reports 15, 11756 (2025), doi 10.1038/s41598-025-94961-8.
//!
//! Units are those of the paper (mm, MPa, %), named in each field, because that is what is compared and printed.

use serde::Deserialize;
use std::sync::LazyLock;

/// Everything that the paper prints.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Paper {
    /// The strand that was tested.
    pub specimen: Specimen,
    /// The tensile test.
    pub experiment: Strength,
    /// The paper's own simulations.
    pub simulation: Vec<Simulation>,
    /// Its fitted curves.
    pub fit: Fits,
    /// What it says of the fracture.
    pub fracture: Fracture,
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
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Strength {
    /// Tensile strength (MPa).
    pub tensile_strength_mpa: f64,
    /// Elongation at fracture (%).
    pub fracture_elongation_percent: f64,
}

/// One of the paper's simulations.
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

/// The paper's fitted curves.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fits {
    /// Elongation at fracture (%) over pitch (mm).
    pub elongation_over_pitch: ExponentialFit,
    /// Elongation at fracture (%) over wire diameter (mm).
    pub elongation_over_diameter: ExponentialFit,
}

/// y = a exp(b x) + c.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExponentialFit {
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

/// What the paper says of the fracture.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fracture {
    /// Where the strand breaks.
    pub r#where: String,
    /// Which wires break.
    pub wires: String,
    /// What is left of the stress.
    pub residual_stress: String,
    /// Whether outer wires are stressed more than inner ones.
    pub outer_stress_above_inner: bool,
}

impl Paper {
    /// The simulation at `pitch_mm` (mm) and `wire_diameter_mm` (mm), if the paper has it.
    pub fn simulation_at(&self, pitch_mm: f64, wire_diameter_mm: f64) -> Option<&Simulation> {
        self.simulation
            .iter()
            .find(|s| (s.pitch_mm - pitch_mm).abs() < 1e-6 && (s.wire_diameter_mm - wire_diameter_mm).abs() < 1e-6)
    }
}

/// The paper's numbers.
pub fn paper() -> &'static Paper {
    static PAPER: LazyLock<Paper> = LazyLock::new(|| {
        toml::from_str(include_str!("../../assets/reference/paper.toml"))
            .expect("assets/reference/paper.toml is compiled in and checked by a test")
    });
    &PAPER
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn asset_parses_and_holds_the_experiment() {
        let paper = paper();
        assert_eq!(paper.specimen.wires_per_layer, [5, 11, 18]);
        assert_eq!(paper.experiment.tensile_strength_mpa, 311.01);
        assert_eq!(paper.experiment.fracture_elongation_percent, 28.57);
        assert_eq!(paper.simulation.len(), 6);
        assert_eq!(paper.simulation_at(40.0, 0.39), None);
    }

    /// The paper's stated errors follow from its own numbers, so none of them is mistyped here.
    #[test]
    fn stated_errors_follow_from_the_numbers() {
        let paper = paper();
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
        let paper = paper();
        for simulation in &paper.simulation {
            let fit = if simulation.wire_diameter_mm == 0.39 {
                paper.fit.elongation_over_pitch.value(simulation.pitch_mm)
            } else {
                paper.fit.elongation_over_diameter.value(simulation.wire_diameter_mm)
            };
            let difference = fit - simulation.fracture_elongation_percent;
            assert!(difference.abs() < 0.2, "{simulation:?}: {fit}");
        }
    }
}
