//! What a study is made of: the scene, its seeds and its parameters.

use super::closed_form;
use super::errors::Truth;
use super::parameters::{self, Parameter};
use super::schedule::{self, PlannedRun, Varied};
use crate::base::error::Result;
use crate::scene::Scene;
use crate::study::runner::{CaseRunner, CaseStore};
use crate::study::tensile::{TensileCase, with_seed};
use std::collections::BTreeSet;

/// Seeds where bonds scatter, nothing exact is known, and the user says nothing: the interval of a mean is then 1.6
/// standard deviations of what is compared, which the same seeds on both sides keep small.
pub const SEEDS: u64 = 4;

/// The scene of a study, its seeds, and its parameters.
pub struct Subject {
    /// The scene as it stands.
    pub scene: Scene,
    /// Seeds that every row is run with, each once.
    pub seeds: Vec<u64>,
    /// Parameters that it has.
    pub varied: Vec<Varied>,
    /// Parameters that it has not, with the reason.
    pub absent: Vec<(&'static str, String)>,
    /// Whether bonds scatter.
    pub scatter: bool,
    /// What the user should know.
    pub notes: Vec<String>,
}

impl Subject {
    /// Sees which of the parameters in `vary` the scene has. Without `seeds` it takes the first [`SEEDS`] where bonds scatter and
    /// there is no closed form, else the scene's own.
    ///
    /// # Errors
    /// A scene that no grip pulls.
    pub fn new(scene: Scene, vary: &[&'static Parameter], mut seeds: Vec<u64>) -> Result<Self> {
        if parameters::pull_speed(&scene.spec).is_none() {
            let help = "study a scene that a grip pulls at a constant speed, such as ka4, or a verification case \
                        (`strandsnap verify --list`)";
            return Err(scene.source.error(
                "grip",
                "nothing is pulled here, so there is no strength to be wrong",
                help,
            ));
        }
        let (varied, absent) = schedule::vary(vary, &scene);
        let mut notes = Vec::new();
        let scatter = scene.plan.scatter;
        if seeds.is_empty() && scatter && closed_form::truth(&scene).is_err() {
            seeds = (1..=SEEDS).collect();
            notes.push(format!(
                "bonds scatter, so one run is one draw: errors are those of the mean over {SEEDS} seeds and of their \
                 spread, and every run is made {SEEDS} times; --seeds takes more, --seed N is one draw"
            ));
        } else if seeds.is_empty() {
            seeds = vec![scene.spec.seed];
        }
        let mut seen = BTreeSet::new();
        seeds.retain(|seed| seen.insert(*seed));
        if seeds.len() > 1 && !scatter {
            notes.push("every bond is as strong as the other in this scene, so one seed is enough".into());
            seeds.truncate(1);
        }
        Ok(Self { scene, seeds, varied, absent, scatter, notes })
    }

    /// The scene at a place: with a value of a parameter, or as it stands.
    pub(super) fn scene_at(&self, place: Option<[usize; 2]>) -> &Scene {
        place.map_or(&self.scene, |[k, l]| &self.varied[k].variation.levels[l].scene)
    }

    /// The exact answer to the scene at a place with this seed; `None` where there is no closed form.
    pub(super) fn truth(&self, place: Option<[usize; 2]>, seed: u64) -> Option<Truth> {
        closed_form::truth(&with_seed(self.scene_at(place), seed)).ok()
    }

    /// A run as a case that `runner` is to run.
    pub(super) fn case<'a>(&'a self, run: PlannedRun, store: &'a CaseStore, runner: &CaseRunner) -> TensileCase<'a> {
        TensileCase {
            work: run.work,
            leads: run.place.is_none(),
            writes: run.writes,
            threads: Some(runner.threads_per_case()),
            ..TensileCase::new(run.name, Ok(self.scene_at(run.place)), run.seed, store)
        }
    }
}
