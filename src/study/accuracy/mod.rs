//! Error against run time: what each second buys.
//!
//! A study varies one numerical parameter at a time ([`parameters`]) from the scene as it stands, runs every value, and
//! measures how far each run is from a reference ([`mod@reference`], [`closed_form`]).

pub mod closed_form;
mod columns;
mod csv;
pub mod ensemble;
pub mod errors;
mod findings;
mod json;
pub mod parameters;
pub mod pareto;
pub mod plots;
pub mod reference;
pub mod richardson;
pub mod rows;
pub mod schedule;
mod subject;
pub mod table;
pub mod verified;

pub use findings::{Reference, Study};
pub use subject::{SEEDS, Subject};

use crate::base::error::{Error, Result};
use crate::run::folder::ACCURACY_STUDY;
use crate::scene::Scene;
use crate::study::runner::{CaseRunner, CaseStore, Record, Status};
use crate::study::statistics::Statistics;
use crate::study::tensile::{TensileCase, TensileOutcome, TensileResult, count_kept};
use errors::{Errors, Truth};
use parameters::Role;
use reference::{Along, OfSeed, Refined, Series};
use rows::{Compared, Row, Run, RunStatus};
use schedule::Varied;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Makes the runs and compares them.
///
/// # Errors
/// When the scene itself cannot be run to its end; when the machine refuses something.
pub fn study(subject: &Subject, store: &CaseStore, runner: &CaseRunner) -> Result<Study> {
    let runs = schedule::runs(&subject.varied, &subject.seeds);
    let places: Vec<_> = runs.iter().map(|run| (run.place, run.seed)).collect();
    let cases: Vec<TensileCase> = runs.into_iter().map(|run| subject.case(run, store, runner)).collect();
    let statuses = runner.run(&cases)?;
    let [kept, other_build] = count_kept(&statuses);
    let made = statuses.iter().filter(|status| matches!(status, Status::Run(_))).count();
    let interrupted = statuses.iter().any(|status| matches!(status, Status::Interrupted));
    let mut runs = Runs { by_place: places.into_iter().zip(statuses).collect() };
    runs.check_base(&subject.scene)?;
    let references = references(subject, &runs);
    let reference = describe(subject, &references);
    let rows = rows(subject, &mut runs, &references);
    Ok(Study {
        scene: subject.scene.spec.name.clone(),
        seeds: subject.seeds.clone(),
        scatter: subject.scatter,
        threads: runner.threads_per_case(),
        jobs: runner.jobs,
        reference,
        rows,
        absent: subject.absent.clone(),
        kept,
        made,
        other_build,
        interrupted,
    })
}

/// Writes table, plot and all numbers into the study's folder; `command` is what the user typed. Gives the files.
///
/// # Errors
/// When the folder cannot be written.
pub fn write(study: &Study, command: &str, folder: &Path) -> Result<Vec<PathBuf>> {
    let (csv, json) = (folder.join("accuracy.csv"), folder.join(ACCURACY_STUDY));
    csv::write(study, &csv)?;
    json::write(study, command, &json)?;
    let plots = plots::write(study, folder)?;
    Ok([csv, json].into_iter().chain(plots).collect())
}

/// Place of a run among the rows, `None` for the reference, and its seed.
type Place = (Option<[usize; 2]>, u64);

/// What became of every run, by place and seed.
struct Runs {
    by_place: BTreeMap<Place, Status<Record<TensileOutcome>>>,
}

impl Runs {
    fn result(&self, place: Option<[usize; 2]>, seed: u64) -> Option<&TensileResult> {
        self.by_place.get(&(place, seed))?.output()?.result.result()
    }

    /// Without a single run of the scene itself there is nothing to compare.
    fn check_base(&self, scene: &Scene) -> Result<()> {
        let bases = || self.by_place.iter().filter(|((place, _), _)| place.is_none()).map(|(_, status)| status);
        let outcomes = || bases().filter_map(Status::output).map(|record| &record.result);
        if outcomes().any(|outcome| outcome.result().is_some()) {
            return Ok(());
        }
        Err(match outcomes().find_map(TensileOutcome::cause) {
            Some(cause) => Error::input(
                format!("{} cannot be run as it stands: {cause}", scene.spec.name),
                "study a scene that runs to its end; `strandsnap run` shows where it stops",
            ),
            None if bases().any(|status| matches!(status, Status::Interrupted)) => Error::Interrupted,
            None => Error::input("the scene itself was not run", "give a larger --budget"),
        })
    }
}

/// What the runs of one seed are compared with, and what refinement says of it.
struct Against {
    refined: Refined,
    /// Each run is compared with the exact answer to its own scene instead.
    closed: Option<Truth>,
}

/// The reference of every seed that has one.
fn references(subject: &Subject, runs: &Runs) -> BTreeMap<u64, Against> {
    let mut references = BTreeMap::new();
    let of_seed = |seed: &u64| {
        let base = runs.result(None, *seed)?;
        Some((*seed, (base, series(subject, runs, *seed, base))))
    };
    let (seeds, of_seeds): (Vec<u64>, Vec<OfSeed>) = subject.seeds.iter().filter_map(of_seed).unzip();
    let laws = (of_seeds.len() > 1).then(|| reference::laws(&of_seeds));
    for (seed, (base, series)) in seeds.iter().zip(&of_seeds) {
        let refined = match &laws {
            Some(laws) => reference::refine_as(laws, base, series),
            None => reference::refine(base, series),
        };
        let closed = subject.truth(None, *seed);
        references.insert(*seed, Against { refined, closed });
    }
    references
}

/// The runs of one seed along every parameter.
fn series<'a>(subject: &Subject, runs: &'a Runs, seed: u64, base: &'a TensileResult) -> Vec<Series<'a>> {
    let along = |(k, Varied { parameter, variation }): (usize, &Varied)| {
        let own = variation.base.number.map(|number| (number, base));
        let others = variation.levels.iter().enumerate();
        let others = others.filter_map(|(l, level)| Some((level.value.number?, runs.result(Some([k, l]), seed)?)));
        Series { parameter: parameter.name, role: variation.role, levels: own.into_iter().chain(others).collect() }
    };
    subject.varied.iter().enumerate().map(along).collect()
}

/// All rows with the errors of their runs.
fn rows(subject: &Subject, runs: &mut Runs, references: &BTreeMap<u64, Against>) -> Vec<Row> {
    let mut rows = Vec::new();
    for place in rows::places(&subject.varied) {
        let mut row = rows::empty(&subject.varied, place);
        for seed in &subject.seeds {
            let outcome = match runs.by_place.remove(&(place, *seed)) {
                Some(Status::Run(record) | Status::Kept(record)) => match record.result {
                    TensileOutcome::Ran(result) => {
                        let errors = references.get(seed).and_then(|against| match &against.closed {
                            Some(_) => subject.truth(place, *seed).map(|truth| Errors::new(&result, &truth)),
                            None => Some(Errors::new(&result, &against.refined.truth)),
                        });
                        RunStatus::Ran(Compared { result, errors })
                    }
                    TensileOutcome::Failed(cause) | TensileOutcome::Refused(cause) => RunStatus::Failed(cause),
                },
                Some(Status::LeftOut(seconds)) => RunStatus::LeftOut(seconds),
                Some(Status::Interrupted) | None => RunStatus::NotReached,
            };
            row.runs.push(Run { seed: *seed, outcome });
        }
        rows.push(row);
    }
    rows
}

fn describe(subject: &Subject, references: &BTreeMap<u64, Against>) -> Reference {
    let truth = |against: &Against| {
        let truth = against.closed.as_ref().unwrap_or(&against.refined.truth);
        [truth.strength_mpa, truth.elongation_percent]
    };
    let mean = |value: &dyn Fn(&Against) -> f64| references.values().map(value).sum::<f64>() / references.len() as f64;
    let closed_form = references.values().any(|against| against.closed.is_some());
    let refined = |k: usize| {
        mean(&|against: &Against| [against.refined.truth.strength_mpa, against.refined.truth.elongation_percent][k])
    };
    let along: Vec<(u64, Along)> = references
        .iter()
        .flat_map(|(seed, against)| against.refined.along.iter().map(|along| (*seed, along.clone())))
        .collect();
    Reference {
        closed_form,
        words: if closed_form { closed_form::WORDS.into() } else { words(subject, &along) },
        value: [0, 1].map(|k| mean(&|against| truth(against)[k])),
        refined: [0, 1].map(refined),
        uncertainty_percent: [0, 1].map(|k| {
            let limit = mean(&|against| against.refined.uncertainty_percent[k]);
            limit.hypot(left_open(references, k))
        }),
        over_seeds: [0, 1]
            .map(|k| Statistics::of(&references.values().map(|against| truth(against)[k]).collect::<Vec<_>>())),
        along,
    }
}

/// Half the 95 % interval of what refinement adds to the mean of strength or elongation, from seed to seed (%); 0 with one
/// seed. The seeds themselves are given: what differs is how each of them is refined.
fn left_open(references: &BTreeMap<u64, Against>, k: usize) -> f64 {
    let added = |against: &Against| against.refined.along.iter().map(|along| along.correction_percent[k]).sum();
    let added: Vec<f64> = references.values().map(added).collect();
    Statistics::of(&added).and_then(|stat| stat.interval_95).unwrap_or(0.0)
}

/// What a reference by refinement is, in a sentence.
fn words(subject: &Subject, along: &[(u64, Along)]) -> String {
    let refined = reference::refined_parameters(along);
    if refined.is_empty() {
        return "the scene as it stands: no parameter that converges has two runs, so rows show differences from it, not \
                errors"
            .into();
    }
    let fixed = subject.varied.iter().filter(|varied| varied.variation.role == Role::Refines);
    let fixed: Vec<&str> = fixed.map(|varied| varied.parameter.name).filter(|name| !refined.contains(name)).collect();
    let missing = match &fixed[..] {
        [] => String::new(),
        names => format!("; {} could not be refined", names.join(", ")),
    };
    format!(
        "the limit of refinement in {} (Richardson), one at a time from the scene as it stands{missing}",
        refined.join(" and ")
    )
}
