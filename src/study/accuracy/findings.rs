//! What a study found: the rows with their runs, and what they are compared with.

use super::reference::Along;
use super::rows::Row;
use crate::study::statistics::Statistics;
use crate::study::tensile::TensileResult;

/// What a study found.
pub struct Study {
    /// Name of the scene.
    pub scene: String,
    /// Seeds that were run.
    pub seeds: Vec<u64>,
    /// Whether bonds scatter, so that one run is one draw.
    pub scatter: bool,
    /// Threads of the engine in each run.
    pub threads: usize,
    /// Runs side by side.
    pub jobs: usize,
    /// What the runs are compared with.
    pub reference: Reference,
    /// The scene as it stands, then every value of every parameter.
    pub rows: Vec<Row>,
    /// Parameters that the scene does not have, with the reason.
    pub absent: Vec<(&'static str, String)>,
    /// Runs that were there from before, of all that are done.
    pub kept: usize,
    /// Runs made now.
    pub made: usize,
    /// Kept runs of another build of the same revision.
    pub other_build: usize,
    /// Whether the user stopped it.
    pub interrupted: bool,
}

/// What runs are compared with.
pub struct Reference {
    /// Whether it is a closed form.
    pub closed_form: bool,
    /// What it is, in a sentence.
    pub words: String,
    /// Strength (MPa) and elongation (%), mean over seeds.
    pub value: [f64; 2],
    /// What refinement alone gives for them: the same, but beside a closed form.
    pub refined: [f64; 2],
    /// How sure refinement is of that (%): of the limit, and with several seeds of what scatter leaves open of it (95 %).
    pub uncertainty_percent: [f64; 2],
    /// Strength (MPa) and elongation (%) over seeds: what strands of other seeds may have.
    pub over_seeds: [Option<Statistics>; 2],
    /// What refinement along each parameter adds, by seed.
    pub along: Vec<(u64, Along)>,
}

impl Study {
    /// Names of the layers, inside out.
    pub fn layers(&self) -> Vec<String> {
        let first: Option<&TensileResult> = self.rows.iter().flat_map(|row| row.ran().map(|run| &*run.result)).next();
        first.map_or(Vec::new(), |run| run.layers.clone())
    }
}
