//! Studies that vary a scene: which cases there are ([`definition`]), what became of them ([`gather`]), and what follows
//! from them. Every case is a run that is kept ([`crate::study::cases`]), so that an interrupted study goes on where it
//! stopped, and cases may be run one by one on many machines and gathered afterwards.

pub mod axis;
pub mod beside;
pub mod breaks;
mod conflicts;
pub mod definition;
pub mod gather;
pub mod quantity;
mod raw;
pub mod report;

pub use definition::{Changes, Definition};
pub use gather::{CaseResult, Gathered, State};

use crate::base::error::{Error, Result};
use crate::run::{assemble, estimate, in_pool};
use crate::scene;
use crate::study::cases::record::{self, Found, Identity, Record};
use crate::study::cases::workshop::{Case, Progress, Workshop};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// How the cases are made.
pub struct Making<'a> {
    /// Folder of the study.
    pub folder: &'a Path,
    /// Cases side by side, each on one thread; several cases on one thread each are faster than one case on several.
    pub jobs: usize,
    /// Threads of the engine when cases are made one by one; `None`: one per core.
    pub threads: Option<usize>,
    /// Ends it early.
    pub stop: &'a AtomicBool,
    /// Hears of every case.
    pub tell: &'a (dyn Fn(&Progress) + Sync),
}

/// What a case is expected to cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cost {
    /// It is done.
    Done,
    /// Wall time on one thread (s).
    Takes(f64),
    /// Its scene is refused, or does not say when it ends.
    Unknown,
}

/// What all cases are expected to cost.
pub struct Costs {
    /// Case by case, in their order.
    pub cases: Vec<Cost>,
    /// What finished cases took over what their first steps said (-); `None` when none is finished. It is in the costs.
    pub ratio: Option<f64>,
}

impl Costs {
    /// Wall time of what is left, on one thread (s).
    pub fn left(&self) -> f64 {
        self.cases.iter().map(|cost| if let Cost::Takes(seconds) = cost { *seconds } else { 0.0 }).sum()
    }
}

/// What every case is expected to cost, by its first steps, and by what finished cases took over theirs. Seeds of a point
/// cost the same. `tell` hears of every point.
///
/// # Errors
/// When the machine refuses threads.
pub fn costs(definition: &Definition, folder: &Path, tell: &dyn Fn(usize)) -> Result<Costs> {
    let mut of_points: Vec<Option<Cost>> = vec![None; definition.points.len()];
    let mut costs = Costs { cases: Vec::new(), ratio: None };
    for (point, seed) in definition.cases() {
        let Ok(scene) = scene::load(&definition.base, &definition.overrides(point, seed)) else {
            costs.cases.push(Cost::Unknown);
            continue;
        };
        let kept = Record::kept(&Identity::of(&scene.spec, None, false), folder);
        // One finished case tells how much dearer later steps are than the first.
        let tells = costs.ratio.is_none() && matches!(kept, Some(Record { found: Found::Ran(_), .. }));
        if kept.is_none() || tells {
            if of_points[point].is_none() {
                tell(point);
                of_points[point] = Some(in_pool(Some(1), || expected(&scene))?);
            }
            if let Some((Record { found: Found::Ran(measured), .. }, Cost::Takes(seconds))) =
                kept.as_ref().zip(of_points[point])
            {
                costs.ratio = Some(measured.cpu_s.unwrap_or(measured.wall_s) / seconds);
            }
        }
        costs.cases.push(if kept.is_some() { Cost::Done } else { of_points[point].unwrap_or(Cost::Unknown) });
    }
    if let Some(ratio) = costs.ratio {
        for cost in &mut costs.cases {
            if let Cost::Takes(seconds) = cost {
                *seconds *= ratio;
            }
        }
    }
    Ok(costs)
}

fn expected(scene: &scene::Scene) -> Cost {
    let estimate = assemble(scene).and_then(|assembly| estimate::estimate(&scene.spec, &scene.plan, assembly));
    let wall = estimate.ok().and_then(|estimate| Some(estimate.steps? * estimate.step_wall));
    wall.map_or(Cost::Unknown, Cost::Takes)
}

/// Makes all cases that are missing.
///
/// # Errors
/// What the machine refuses: threads, files. What a scene, the engine or the guard refuse is a result.
pub fn make(definition: &Definition, costs: &Costs, making: &Making) -> Result<()> {
    let cases: Vec<Case> = definition
        .cases()
        .iter()
        .zip(&costs.cases)
        .map(|((point, seed), cost)| {
            let work = match cost {
                Cost::Takes(seconds) => *seconds,
                Cost::Done | Cost::Unknown => 0.0,
            };
            case(definition, *point, *seed, work)
        })
        .collect();
    workshop(definition, making).make(&cases).map(|_| ())
}

/// Makes the case with this number, from 1, alone; one that is kept is not made again.
///
/// # Errors
/// A number that no case has; what the machine refuses.
pub fn make_one(definition: &Definition, number: usize, making: &Making) -> Result<()> {
    let cases = definition.cases();
    let Some((point, seed)) = number.checked_sub(1).and_then(|index| cases.get(index)) else {
        let what = format!("the study has no case {number}");
        return Err(Error::input(what, format!("its cases are numbered from 1 to {}; see --dry-run", cases.len())));
    };
    workshop(definition, making).make(&[case(definition, *point, *seed, 1.0)]).map(|_| ())
}

fn case(definition: &Definition, point: usize, seed: u64, work: f64) -> Case {
    Case {
        name: definition.case_name(point, seed),
        overrides: definition.overrides(point, seed),
        work,
        writes: false,
        leads: false,
    }
}

fn workshop<'a>(definition: &'a Definition, making: &Making<'a>) -> Workshop<'a> {
    Workshop {
        scene: &definition.base,
        folder: making.folder,
        jobs: making.jobs,
        threads: making.threads,
        // What is studied is the answer, not the time: any number of threads gives the same.
        costs: false,
        budget: None,
        began: Instant::now(),
        stop: making.stop,
        tell: making.tell,
    }
}

/// Refuses a study none of whose points has a scene that can be read; a single one that is refused is told as a case.
///
/// # Errors
/// The error of the first point.
pub fn check(definition: &Definition) -> Result<()> {
    let Some(seed) = definition.seeds.first() else { return Ok(()) };
    let mut first = None;
    for point in 0..definition.points.len() {
        match scene::load(&definition.base, &definition.overrides(point, *seed)) {
            Ok(_) => return Ok(()),
            Err(error) => first = first.or(Some(error)),
        }
    }
    first.map_or(Ok(()), Err)
}

/// Makes the folder of a study; `fresh` removes the cases that are there.
///
/// # Errors
/// When the folder cannot be made or a record cannot be removed.
pub fn open(folder: &Path, fresh: bool) -> Result<()> {
    record::open(folder, fresh)
}
