//! What became of the cases of a study, and means over seeds.

use super::definition::Definition;
use super::quantity::Quantity;
use crate::base::units::{self, Dimension};
use crate::run::build::build;
use crate::scene::spec::{LayerSpec, Spec};
use crate::study::runner::{CaseStore, Record};
use crate::study::statistics::Statistics;
use crate::study::tensile::{TensileOutcome, TensileResult, identity};

/// A case.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseResult {
    /// Number, from 1.
    pub number: usize,
    /// Number of its point among those of the study, from 0.
    pub point: usize,
    /// Seed of its scatter.
    pub seed: u64,
    /// Name of its folder, the hash of its identity; empty when the scene is refused.
    pub folder: String,
    /// What became of it; `None` when it was not run yet.
    pub outcome: Option<TensileOutcome>,
}

impl CaseResult {
    /// What it gave, if it ran.
    pub fn result(&self) -> Option<&TensileResult> {
        self.outcome.as_ref()?.result()
    }

    /// Why there is no answer, where there is none.
    pub fn cause(&self) -> Option<&str> {
        self.outcome.as_ref()?.cause()
    }

    /// What became of it, in a word.
    pub fn word(&self) -> &'static str {
        match &self.outcome {
            Some(TensileOutcome::Ran(_)) => "ran",
            Some(TensileOutcome::Failed(_)) => "failed",
            Some(TensileOutcome::Refused(_)) => "refused",
            None => "missing",
        }
    }
}

/// The cases of a study with what is kept of them.
pub struct Gathered<'a> {
    definition: &'a Definition,
    /// Its cases, in their order.
    pub cases: Vec<CaseResult>,
    /// Kept cases that another build of the same revision had run.
    pub other_build: usize,
}

impl<'a> Gathered<'a> {
    /// Reads what is kept in a store.
    pub fn read(definition: &'a Definition, store: &CaseStore) -> Self {
        let build = build();
        let (mut cases, mut other_build) = (Vec::new(), 0);
        for (index, (point, seed)) in definition.cases().into_iter().enumerate() {
            let (folder, outcome) = match &definition.scenes[point] {
                Ok(scene) => {
                    let identity = identity(scene, seed).on(store.device());
                    let record: Option<Record<TensileOutcome>> = store.find(&identity);
                    other_build += usize::from(record.as_ref().is_some_and(|record| record.build != build));
                    (identity.name(), record.map(|record| record.result))
                }
                Err(cause) => (String::new(), Some(TensileOutcome::Refused(cause.clone()))),
            };
            cases.push(CaseResult { number: index + 1, point, seed, folder, outcome });
        }
        Self { definition, cases, other_build }
    }

    /// The runs of a point, by seed.
    pub fn runs(&self, point: usize) -> impl Iterator<Item = &TensileResult> {
        self.cases.iter().filter(move |case| case.point == point).filter_map(CaseResult::result)
    }

    /// A quantity over the seeds of a point; `None` where no run has it.
    pub fn stat(&self, point: usize, quantity: &Quantity) -> Option<Statistics> {
        let values: Vec<f64> = self.runs(point).filter_map(|run| quantity.number(run)).collect();
        Statistics::of(&values)
    }

    /// Cases that ran.
    pub fn ran(&self) -> usize {
        self.cases.iter().filter(|case| case.result().is_some()).count()
    }

    /// Cases that were not run yet.
    pub fn missing(&self) -> usize {
        self.cases.iter().filter(|case| case.outcome.is_none()).count()
    }

    /// The scene of a point, if it is not refused.
    pub fn spec(&self, point: usize) -> Option<&Spec> {
        self.definition.scenes[point].as_ref().ok().map(|scene| &scene.spec)
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
