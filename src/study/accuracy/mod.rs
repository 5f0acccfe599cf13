//! Error against run time: what each second buys.
//!
//! A study turns one knob at a time ([`knobs`]) away from the scene as it stands, runs every value, and
//! measures how far each run is from a reference ([`mod@reference`], [`closed_form`]). The runs are made and kept by
//! [`crate::study::cases`].

pub mod agenda;
pub mod closed_form;
mod columns;
mod csv;
pub mod ensemble;
pub mod errors;
mod json;
pub mod knobs;
pub mod pareto;
pub mod plots;
pub mod reference;
pub mod richardson;
pub mod rows;
pub mod table;
pub mod verified;

use crate::base::error::{Error, Result};
use crate::run::folder::ACCURACY_STUDY;
use crate::scene::spec::{DriveSpec, Spec};
use crate::scene::{self, Scene};
use crate::study::cases::measured::Measured;
use crate::study::cases::record::{self, Found};
use crate::study::cases::stat::Stat;
use crate::study::cases::workshop::{Became, Case, Progress, Workshop};
use agenda::{Item, Turned};
use errors::{Errors, Truth};
use knobs::{Knob, Role};
use reference::{Along, OfSeed, Refined, Series};
use rows::{Outcome, Row, Run};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Seeds where bonds scatter, nothing exact is known, and the user says nothing: the interval of a mean is then 1.6
/// standard deviations of what is compared, which the same seeds on both sides keep small.
pub const SEEDS: u64 = 4;

/// What to study and how.
pub struct Options {
    /// The scene by name or path.
    pub scene: String,
    /// Its options.
    pub overrides: Vec<String>,
    /// Seeds; empty for [`SEEDS`] where bonds scatter and there is no closed form, else the scene's own.
    pub seeds: Vec<u64>,
    /// Knobs to turn.
    pub vary: Vec<&'static Knob>,
    /// Wall time that it may take (s).
    pub budget: Option<f64>,
    /// Runs side by side.
    pub jobs: usize,
    /// Threads of the engine; `None`: one per core.
    pub threads: Option<usize>,
    /// Folder of the study.
    pub out: PathBuf,
    /// Make runs again that are kept.
    pub fresh: bool,
}

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
    /// The scene as it stands, then every value of every knob.
    pub rows: Vec<Row>,
    /// Knobs that the scene does not have, with the reason.
    pub absent: Vec<(&'static str, String)>,
    /// Runs that were there from before, of all that are done.
    pub kept: usize,
    /// Runs made now.
    pub made: usize,
    /// Kept runs of another build of the same physics.
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
    pub over_seeds: [Option<Stat>; 2],
    /// What refinement along each knob adds, by seed.
    pub along: Vec<(u64, Along)>,
}

/// The scene of a study, its seeds, and its knobs.
pub struct Subject {
    /// The scene as it stands.
    pub scene: Scene,
    /// Seeds.
    pub seeds: Vec<u64>,
    /// Knobs that it has.
    pub turned: Vec<Turned>,
    /// Knobs that it has not, with the reason.
    pub absent: Vec<(&'static str, String)>,
    /// Whether bonds scatter.
    pub scatter: bool,
    /// What the user should know.
    pub notes: Vec<String>,
    name: String,
    overrides: Vec<String>,
}

impl Subject {
    /// Reads the scene and sees which knobs it has.
    ///
    /// # Errors
    /// A scene that is wrong, or that no grip pulls.
    pub fn new(options: &Options) -> Result<Self> {
        let scene = scene::load(&options.scene, &options.overrides)?;
        if !is_pulled(&scene.spec) {
            let help = "study a scene that a grip pulls at a constant speed, such as ka4, or a verification case \
                        (`strandsnap verify --list`)";
            return Err(scene.source.error(
                "grip",
                "nothing is pulled here, so there is no strength to be wrong",
                help,
            ));
        }
        let (turned, absent) = agenda::turn(&options.vary, &scene.spec);
        let mut notes = Vec::new();
        let scatter = scene.plan.scatter;
        let mut seeds = options.seeds.clone();
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
        let (name, overrides) = (options.scene.clone(), options.overrides.clone());
        Ok(Self { scene, seeds, turned, absent, scatter, notes, name, overrides })
    }

    /// The exact answer to the scene with these options and this seed; `None` where there is no closed form.
    fn truth(&self, set: &[String], seed: u64) -> Option<Truth> {
        let seed = [format!("seed={seed}")];
        let overrides: Vec<String> = self.overrides.iter().chain(set).chain(&seed).cloned().collect();
        closed_form::truth(&scene::load(&self.name, &overrides).ok()?).ok()
    }
}

fn is_pulled(spec: &Spec) -> bool {
    spec.grip.as_ref().is_some_and(|grip| matches!(grip.drive, DriveSpec::Speed(speed) if speed != 0.0))
}

/// Makes the runs and compares them. `tell` hears of every run.
///
/// # Errors
/// When the scene itself cannot be run to its end; when the machine refuses something.
pub fn study(
    options: &Options,
    subject: &Subject,
    stop: &AtomicBool,
    tell: &(dyn Fn(&Progress) + Sync),
) -> Result<Study> {
    record::open(&options.out, options.fresh)?;
    let items = agenda::items(&subject.turned, &subject.seeds);
    let workshop = Workshop {
        scene: &options.scene,
        folder: &options.out,
        jobs: options.jobs,
        threads: options.threads,
        costs: true,
        budget: options.budget,
        began: Instant::now(),
        stop,
        tell,
    };
    let cases: Vec<Case> = items.iter().map(|item| item.case(&options.overrides)).collect();
    let became = workshop.make(&cases)?;
    let done = |was_kept: bool| {
        let is = move |one: &&Became| matches!(one, Became::Done { kept, .. } if *kept == was_kept);
        became.iter().filter(is).count()
    };
    let (kept, made) = (done(true), done(false));
    let build = record::build();
    let other = |one: &&Became| matches!(one, Became::Done { record, .. } if record.build != build);
    let other_build = became.iter().filter(other).count();
    let mut runs = Runs::new(&items, became);
    let interrupted = stop.load(Ordering::Relaxed);
    runs.check_base(options, interrupted)?;
    let references = references(subject, &runs);
    let reference = describe(subject, &references);
    let rows = rows(subject, &mut runs, &references);
    Ok(Study {
        scene: subject.scene.spec.name.clone(),
        seeds: subject.seeds.clone(),
        scatter: subject.scatter,
        threads: workshop.threads_of_a_run(),
        jobs: options.jobs,
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

/// What became of every run, by place and seed.
struct Runs {
    by_place: BTreeMap<(Option<[usize; 2]>, u64), Became>,
}

impl Runs {
    fn new(items: &[Item], became: Vec<Became>) -> Self {
        Self { by_place: items.iter().map(|item| (item.place, item.seed)).zip(became).collect() }
    }

    fn measured(&self, place: Option<[usize; 2]>, seed: u64) -> Option<&Measured> {
        match self.by_place.get(&(place, seed)) {
            Some(Became::Done { record, .. }) => match &record.found {
                Found::Ran(measured) => Some(measured),
                Found::Failed(_) => None,
            },
            _ => None,
        }
    }

    /// Without a single run of the scene itself there is nothing to compare.
    fn check_base(&self, options: &Options, interrupted: bool) -> Result<()> {
        let bases = || self.by_place.iter().filter(|((place, _), _)| place.is_none()).map(|(_, became)| became);
        let ran =
            |became: &Became| matches!(became, Became::Done { record, .. } if matches!(record.found, Found::Ran(_)));
        if bases().any(ran) {
            return Ok(());
        }
        let cause = bases().find_map(|became| match became {
            Became::Done { record, .. } => match &record.found {
                Found::Failed(cause) => Some(cause.clone()),
                Found::Ran(_) => None,
            },
            Became::Refused(cause) => Some(cause.clone()),
            _ => None,
        });
        Err(match cause {
            Some(cause) => Error::input(
                format!("{} cannot be run as it stands: {cause}", options.scene),
                "study a scene that runs to its end; `strandsnap run` shows where it stops",
            ),
            None if interrupted => Error::input(
                "interrupted before the scene itself was run once",
                "run it again; the runs that were finished are kept",
            ),
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
        let base = runs.measured(None, *seed)?;
        Some((*seed, (base, series(subject, runs, *seed, base))))
    };
    let (seeds, of_seeds): (Vec<u64>, Vec<OfSeed>) = subject.seeds.iter().filter_map(of_seed).unzip();
    let laws = (of_seeds.len() > 1).then(|| reference::laws(&of_seeds));
    for (seed, (base, series)) in seeds.iter().zip(&of_seeds) {
        let refined = match &laws {
            Some(laws) => reference::refine_as(laws, base, series),
            None => reference::refine(base, series),
        };
        let closed = subject.truth(&[], *seed);
        references.insert(*seed, Against { refined, closed });
    }
    references
}

/// The runs of one seed along every knob.
fn series<'a>(subject: &Subject, runs: &'a Runs, seed: u64, base: &'a Measured) -> Vec<Series<'a>> {
    let along = |(k, turned): (usize, &Turned)| {
        let own = turned.ladder.base.number.map(|number| (number, base));
        let others = turned.ladder.levels.iter().enumerate();
        let others = others.filter_map(|(l, level)| Some((level.value.number?, runs.measured(Some([k, l]), seed)?)));
        Series { knob: turned.knob.name, role: turned.ladder.role, levels: own.into_iter().chain(others).collect() }
    };
    subject.turned.iter().enumerate().map(along).collect()
}

/// All rows with the errors of their runs.
fn rows(subject: &Subject, runs: &mut Runs, references: &BTreeMap<u64, Against>) -> Vec<Row> {
    let mut rows = Vec::new();
    for place in rows::places(&subject.turned) {
        let mut row = rows::empty(&subject.turned, place);
        let set: &[String] = place.map_or(&[], |[k, l]| &subject.turned[k].ladder.levels[l].set);
        for seed in &subject.seeds {
            let outcome = match runs.by_place.remove(&(place, *seed)) {
                Some(Became::Done { record, .. }) => match record.found {
                    Found::Ran(measured) => {
                        let errors = references.get(seed).and_then(|against| match &against.closed {
                            Some(_) => subject.truth(set, *seed).map(|truth| Errors::new(&measured, &truth)),
                            None => Some(Errors::new(&measured, &against.refined.truth)),
                        });
                        Outcome::Ran { measured, errors }
                    }
                    Found::Failed(cause) => Outcome::Failed(cause),
                },
                Some(Became::Refused(cause)) => Outcome::Failed(cause),
                Some(Became::LeftOut(seconds)) => Outcome::LeftOut(seconds),
                Some(Became::NotReached) | None => Outcome::NotReached,
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
        over_seeds: [0, 1].map(|k| Stat::of(&references.values().map(|against| truth(against)[k]).collect::<Vec<_>>())),
        along,
    }
}

/// Half the 95 % interval of what refinement adds to the mean of strength or elongation, from seed to seed (%); 0 with one
/// seed. The seeds themselves are given: what differs is how each of them is refined.
fn left_open(references: &BTreeMap<u64, Against>, k: usize) -> f64 {
    let added = |against: &Against| against.refined.along.iter().map(|along| along.correction_percent[k]).sum();
    let added: Vec<f64> = references.values().map(added).collect();
    Stat::of(&added).and_then(|stat| stat.interval_95).unwrap_or(0.0)
}

/// What a reference by refinement is, in a sentence.
fn words(subject: &Subject, along: &[(u64, Along)]) -> String {
    let mut knobs: Vec<&str> = Vec::new();
    for (_, along) in along {
        if !knobs.contains(&along.knob) {
            knobs.push(along.knob);
        }
    }
    if knobs.is_empty() {
        return "the scene as it stands: no knob that converges has two runs, so rows show differences from it, not \
                errors"
            .into();
    }
    let fixed = subject.turned.iter().filter(|turned| turned.ladder.role == Role::Refines);
    let fixed: Vec<&str> = fixed.map(|turned| turned.knob.name).filter(|name| !knobs.contains(name)).collect();
    let missing = match &fixed[..] {
        [] => String::new(),
        names => format!("; {} could not be refined", names.join(", ")),
    };
    format!(
        "the limit of refinement in {} (Richardson), one at a time from the scene as it stands{missing}",
        knobs.join(" and ")
    )
}
