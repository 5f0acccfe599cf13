//! What a study stands beside: the reference paper's simulations, its fitted curves, and strand theory.
//!
//! Strand theory is calibrated as the engine is, on the reference experiment alone: the strength and elongation of a wire
//! are those that make the experiment's strand as strong and as long as it was. Its other strands follow from geometry:
//! strength as Σ n A cos β/Σ n A, elongation by the wires that are strained most, which are the innermost.

use super::axis::Axis;
use super::definition::{Beside, Definition};
use super::gather::Gathered;
use super::quantity::Quantity;
use crate::base::error::Result;
use crate::base::units::{mm, percent};
use crate::reference::paper::{ExponentialFit, Simulation, paper};
use crate::reference::strand::{self, Layer};
use crate::scene;
use crate::scene::spec::Spec;
use crate::strand::lay_radius;
use crate::study::cases::stat::Stat;
use serde::Serialize;

/// Strength (MPa) and elongation (%), in this order; also what they are called.
pub const QUANTITIES: [&str; 2] = ["strength", "elongation"];

/// Lengths that agree so well are the same (mm).
const SAME_MM: f64 = 1e-6;

/// A point of a study beside the paper and theory.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PointBeside {
    /// Number of the point.
    pub point: usize,
    /// Ours, over seeds: strength (MPa) and elongation (%).
    pub ours: [Option<Stat>; 2],
    /// The paper's simulation of the same strand.
    pub paper: Option<[f64; 2]>,
    /// The experiment, where this is its strand.
    pub experiment: Option<[f64; 2]>,
    /// Strand theory.
    pub theory: Option<[f64; 2]>,
}

impl PointBeside {
    /// How far ours is from another value (%).
    pub fn error(&self, k: usize, other: Option<[f64; 2]>) -> Option<f64> {
        Some(100.0 * (self.ours[k]?.mean / other?[k] - 1.0))
    }
}

/// Every point beside what the study asks for; empty when it asks for nothing.
///
/// # Errors
/// When the experiment's strand cannot be laid up.
pub fn points(definition: &Definition, gathered: &Gathered) -> Result<Vec<PointBeside>> {
    if definition.compare.is_empty() {
        return Ok(Vec::new());
    }
    let wire = Wire::of_the_experiment()?;
    let asks = |beside| definition.compare.contains(&beside);
    let one = |point: usize| {
        let layers = gathered.spec(point).and_then(layers);
        let simulation = layers.as_deref().and_then(simulation_of).filter(|_| asks(Beside::Paper));
        PointBeside {
            point,
            ours: QUANTITIES.map(|name| gathered.stat(point, quantity(name))),
            paper: simulation.map(|s| [s.tensile_strength_mpa, s.fracture_elongation_percent]),
            // The paper compares one of its simulations with the experiment: the one of the strand that was tested.
            experiment: simulation.filter(|s| s.error_against_experiment_percent.is_some()).map(|_| {
                let experiment = &paper().experiment;
                [experiment.tensile_strength_mpa, experiment.fracture_elongation_percent]
            }),
            theory: layers.filter(|_| asks(Beside::StrandTheory)).map(|layers| wire.strand(&layers)),
        }
    };
    Ok((0..definition.points.len()).map(one).collect())
}

fn quantity(name: &str) -> &'static Quantity {
    super::quantity::find(name).expect("strength and elongation are always there")
}

/// The paper's fitted curve over this axis, if it prints one, for strength or elongation.
pub fn curve_over(axis: &Axis, quantity: &str) -> Option<ExponentialFit> {
    let fits = &paper().fit;
    match (axis.key.as_deref()?, axis.unit.as_str(), quantity) {
        ("strand.pitch", "mm", "elongation") => Some(fits.elongation_over_pitch),
        ("strand.wire_diameter", "mm", "elongation") => Some(fits.elongation_over_diameter),
        _ => None,
    }
}

/// How a quantity goes from one end of the axis to the other.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trend {
    /// Strength or elongation.
    pub quantity: &'static str,
    /// Last value of the axis less the first: ours, with its 95 % interval.
    pub ours: f64,
    /// Half its width; `None` with one seed.
    pub interval_95: Option<f64>,
    /// The paper's, between the same ends.
    pub paper: Option<f64>,
    /// Strand theory's.
    pub theory: Option<f64>,
}

/// Trends of strength and elongation over the axis; empty without one.
pub fn trends(definition: &Definition, points: &[PointBeside]) -> Vec<Trend> {
    let (Some(_), [first, .., last]) = (definition.abscissa(), points) else { return Vec::new() };
    let trend = |k: usize| {
        let ends = [first.ours[k]?, last.ours[k]?];
        let half = ends[0].interval_95.zip(ends[1].interval_95).map(|(a, b)| a.hypot(b));
        let other = |value: fn(&PointBeside) -> Option<[f64; 2]>| Some(value(last)?[k] - value(first)?[k]);
        Some(Trend {
            quantity: QUANTITIES[k],
            ours: ends[1].mean - ends[0].mean,
            interval_95: half,
            paper: other(|point| point.paper),
            theory: other(|point| point.theory),
        })
    };
    (0..QUANTITIES.len()).filter_map(trend).collect()
}

/// What a wire must bear and how far it must stretch for the experiment to come out.
struct Wire {
    /// Nominal strength (MPa).
    strength_mpa: f64,
    /// Elongation at fracture (-).
    elongation: f64,
}

impl Wire {
    fn of_the_experiment() -> Result<Self> {
        let spec = scene::load("ka4", &[])?.spec;
        let layers = layers(&spec).expect("ka4 is a strand that can be laid up");
        let experiment = &paper().experiment;
        let strain = 0.01 * experiment.fracture_elongation_percent;
        let contraction = 1.0 / (1.0 + strain).sqrt();
        let most = layers.iter().map(|layer| strand::wire_strain(strain, layer.lay_angle(), contraction));
        Ok(Self {
            strength_mpa: experiment.tensile_strength_mpa / strand::strength_factor(&layers),
            elongation: most.fold(f64::MIN, f64::max),
        })
    }

    /// Strength (MPa) and elongation (%) of a strand of such wires.
    fn strand(&self, layers: &[Layer]) -> [f64; 2] {
        [self.strength_mpa * strand::strength_factor(layers), percent(strand::elongation(layers, self.elongation))]
    }
}

/// The strand of a scene as strand theory sees it; `None` without one, or when it cannot be laid up.
fn layers(spec: &Spec) -> Option<Vec<Layer>> {
    let layers = &spec.strand.as_ref()?.layers;
    let radii = lay_radius::resolve(layers).ok()?;
    let layer = |(layer, radius): (&scene::spec::LayerSpec, f64)| Layer {
        wires: layer.wires,
        diameter: layer.wire_diameter,
        radius,
        pitch: layer.pitch,
        lay: layer.lay,
    };
    Some(layers.iter().zip(radii).map(layer).collect())
}

/// The paper's simulation of a strand of one pitch and wire diameter.
fn simulation_of(layers: &[Layer]) -> Option<&'static Simulation> {
    let first = layers.first()?;
    let same = |a: f64, b: f64| (mm(a) - mm(b)).abs() < SAME_MM;
    let alike = layers.iter().all(|layer| same(layer.pitch, first.pitch) && same(layer.diameter, first.diameter));
    paper().simulation_at(mm(first.pitch), mm(first.diameter)).filter(|_| alike)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::sweep::Changes;
    use std::path::Path;

    fn of(text: &str) -> Vec<PointBeside> {
        let text = format!("about = \"a test\"\nbase = \"ka4\"\ncompare = [\"paper\", \"strand-theory\"]\n{text}");
        let definition = Definition::parse(&text, "test.toml", Path::new("."), &Changes::default()).unwrap();
        let folder = tempfile::tempdir().unwrap();
        points(&definition, &Gathered::read(&definition, folder.path()).unwrap()).unwrap()
    }

    /// Strand theory gives back what it was calibrated on, and 0.6 % less than at 54 mm (physics page, section 9, whose lay
    /// radii are spread evenly: these layers lie a little further in).
    #[test]
    fn theory_comes_back_to_the_experiment() {
        let points = of("[[axis]]\nkey = \"strand.pitch\"\nvalues = [\"39 mm\", \"54 mm\"]");
        let [short, long] = [0, 1].map(|k: usize| points[k].theory.unwrap());
        assert!((short[0] - 311.01).abs() < 1e-9 && (short[1] - 28.57).abs() < 1e-9, "{short:?}");
        assert!((short[0] / long[0] - 0.9943).abs() < 5e-4 && long[1] < short[1], "{long:?}");
    }

    #[test]
    fn the_papers_strands_are_found_by_pitch_and_diameter() {
        let points = of("[[axis]]\nkey = \"strand.pitch\"\nvalues = [\"44 mm\", \"45 mm\"]");
        assert_eq!(points[0].paper, Some([282.12, 26.24]));
        assert_eq!((points[0].experiment, points[1].paper), (None, None));
        let thin = "set = [\"strand.layer=\", \"strand.construction=auto\", \"strand.area=4 mm^2\"]\n\
                    [[axis]]\nkey = \"strand.wire_diameter\"\nvalues = [\"0.25 mm\"]";
        assert_eq!(of(thin)[0].paper, Some([263.46, 23.93]));
    }
}
