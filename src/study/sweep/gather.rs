//! What became of the cases of a study, and means over seeds.

use super::definition::Definition;
use super::quantity::Quantity;
use crate::base::error::{Error, Result};
use crate::base::units::{self, Dimension};
use crate::scene::spec::{LayerSpec, Spec};
use crate::scene::{self, Scene};
use crate::study::cases::measured::Measured;
use crate::study::cases::record::{self, Found, Identity, Record};
use crate::study::cases::stat::Stat;
use std::path::Path;

/// What became of a case.
#[derive(Debug, Clone, PartialEq)]
pub enum State {
    /// It ran to its end.
    Ran(Box<Measured>),
    /// The engine or the guard stopped it: why.
    Failed(String),
    /// Its scene is refused: why.
    Refused(String),
    /// It was not made yet.
    Missing,
}

impl State {
    /// In a word.
    pub fn word(&self) -> &'static str {
        match self {
            State::Ran(_) => "ran",
            State::Failed(_) => "failed",
            State::Refused(_) => "refused",
            State::Missing => "missing",
        }
    }

    /// Why there is no answer, where there is none.
    pub fn cause(&self) -> Option<&str> {
        match self {
            State::Failed(cause) | State::Refused(cause) => Some(cause),
            State::Ran(_) | State::Missing => None,
        }
    }
}

/// A case.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseResult {
    /// Number, from 1.
    pub number: usize,
    /// Its point.
    pub point: usize,
    /// Its seed.
    pub seed: u64,
    /// Name of its folder, the hash of its resolved scene; empty when the scene is refused.
    pub folder: String,
    /// What became of it.
    pub state: State,
}

impl CaseResult {
    /// What it measured, if it ran.
    pub fn measured(&self) -> Option<&Measured> {
        match &self.state {
            State::Ran(measured) => Some(measured),
            _ => None,
        }
    }
}

/// Everything that is there of a study.
pub struct Gathered {
    /// Its cases, in their order.
    pub cases: Vec<CaseResult>,
    /// The scene of every point, with the first seed; `None` where it is refused.
    pub scenes: Vec<Option<Scene>>,
    /// Kept cases that another build of the same physics made.
    pub other_build: usize,
}

impl Gathered {
    /// Reads what is kept in the study's folder.
    ///
    /// # Errors
    /// When a centreline file of the scene cannot be read.
    pub fn read(definition: &Definition, folder: &Path) -> Result<Self> {
        let build = record::build();
        let mut scenes = vec![None; definition.points.len()];
        let (mut cases, mut other_build) = (Vec::new(), 0);
        for (index, (point, seed)) in definition.cases().into_iter().enumerate() {
            let (name, state) = match scene::load(&definition.base, &definition.overrides(point, seed)) {
                Ok(scene) => {
                    let identity = Identity::of(&scene.spec, None, false);
                    scenes[point].get_or_insert(scene);
                    let record = Record::kept(&identity, folder);
                    other_build += usize::from(record.as_ref().is_some_and(|record| record.build != build));
                    (identity.name(), state(record))
                }
                Err(error @ (Error::Scene(_) | Error::Input { .. })) => {
                    (String::new(), State::Refused(error.to_string()))
                }
                Err(error) => return Err(error),
            };
            cases.push(CaseResult { number: index + 1, point, seed, folder: name, state });
        }
        Ok(Self { cases, scenes, other_build })
    }

    /// The runs of a point, by seed.
    pub fn runs(&self, point: usize) -> impl Iterator<Item = &Measured> {
        self.cases.iter().filter(move |case| case.point == point).filter_map(CaseResult::measured)
    }

    /// A quantity over the seeds of a point; `None` where no run has it.
    pub fn stat(&self, point: usize, quantity: &Quantity) -> Option<Stat> {
        let values: Vec<f64> = self.runs(point).filter_map(quantity.of).collect();
        Stat::of(&values)
    }

    /// Cases that ran.
    pub fn ran(&self) -> usize {
        self.cases.iter().filter(|case| matches!(case.state, State::Ran(_))).count()
    }

    /// Cases that are not made yet.
    pub fn missing(&self) -> usize {
        self.cases.iter().filter(|case| case.state == State::Missing).count()
    }

    /// The scene of a point.
    pub fn spec(&self, point: usize) -> Option<&Spec> {
        self.scenes[point].as_ref().map(|scene| &scene.spec)
    }
}

fn state(record: Option<Record>) -> State {
    match record.map(|record| record.found) {
        Some(Found::Ran(measured)) => State::Ran(measured),
        Some(Found::Failed(cause)) => State::Failed(cause),
        None => State::Missing,
    }
}

/// What a strand is made of, as people write it: "5 + 11 + 18 wires of 0.39 mm, 4.062 mm²"; empty without one.
pub fn construction(spec: &Spec) -> String {
    let Some(strand) = &spec.strand else { return String::new() };
    let wires: Vec<String> = strand.layers.iter().map(|layer| layer.wires.to_string()).collect();
    let area: f64 = strand.layers.iter().map(copper).sum();
    let mut diameters: Vec<f64> = strand.layers.iter().map(|layer| layer.wire_diameter).collect();
    diameters.dedup();
    let diameters: Vec<String> = diameters.iter().map(|d| units::format(*d, Dimension::Length)).collect();
    format!("{} wires of {}, {:.3} mm²", wires.join(" + "), diameters.join(", "), area * 1e6)
}

/// Section of a layer's wires (m²).
fn copper(layer: &LayerSpec) -> f64 {
    layer.wires as f64 * std::f64::consts::FRAC_PI_4 * layer.wire_diameter.powi(2)
}
