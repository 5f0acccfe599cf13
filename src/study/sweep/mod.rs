//! Studies that vary a scene: which cases there are ([`definition`]), what became of them ([`gather`]), and what follows
//! from them. Every case is a run that is kept ([`CaseStore`]), so that an interrupted study goes on where it stopped, and
//! cases may be run one by one on many machines and gathered afterwards.

pub mod axis;
pub mod breaks;
mod changes;
pub mod cluster;
pub mod comparison;
mod conflicts;
pub mod definition;
pub mod gather;
pub mod quantity;
mod raw;
pub mod report;

pub use changes::Changes;
pub use definition::Definition;
pub use gather::{CaseResult, Gathered};

use crate::base::error::{Error, Result};
use crate::run::{assemble, estimate, in_pool};
use crate::scene::Scene;
use crate::strand::size::Size;
use crate::study::runner::{CaseRunner, CaseStore, Record, Status};
use crate::study::tensile::TensileOutcome;

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
pub fn costs(definition: &Definition, gathered: &Gathered, tell: &dyn Fn(usize)) -> Result<Costs> {
    let mut of_points: Vec<Option<Cost>> = vec![None; definition.points.len()];
    let mut costs = Costs { cases: Vec::new(), ratio: None };
    for case in &gathered.cases {
        let Ok(scene) = &definition.scenes[case.point] else {
            costs.cases.push(Cost::Unknown);
            continue;
        };
        // One finished case tells how much dearer later steps are than the first.
        let tells = costs.ratio.is_none() && case.result().is_some();
        let of_point = &mut of_points[case.point];
        if of_point.is_none() && (case.outcome.is_none() || tells) {
            tell(case.point);
            *of_point = Some(in_pool(Some(1), || expected(scene))?);
        }
        if let Some((result, Cost::Takes(seconds))) = case.result().filter(|_| tells).zip(*of_point) {
            costs.ratio = Some(result.cpu_s.unwrap_or(result.wall_s) / seconds);
        }
        costs.cases.push(if case.outcome.is_some() { Cost::Done } else { of_point.unwrap_or(Cost::Unknown) });
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

fn expected(scene: &Scene) -> Cost {
    let estimate = assemble(scene).and_then(|assembly| estimate::estimate(&scene.spec, &scene.plan, assembly));
    let wall = estimate.ok().and_then(|estimate| Some(estimate.steps? * estimate.step_wall));
    wall.map_or(Cost::Unknown, Cost::Takes)
}

/// Memory that the largest case needs (bytes).
pub fn memory(definition: &Definition) -> f64 {
    let scenes = definition.scenes.iter().flatten();
    scenes.map(|scene| Size::of(&scene.spec).memory).fold(0.0, f64::max)
}

/// Runs all cases that are missing.
///
/// # Errors
/// What the machine refuses: threads, files. What a scene, the engine or the guard refuse is a result.
pub fn run(
    definition: &Definition,
    costs: &Costs,
    store: &CaseStore,
    runner: &CaseRunner,
) -> Result<Vec<Status<Record<TensileOutcome>>>> {
    let case = |(case, cost): ((usize, u64), &Cost)| {
        let work = if let Cost::Takes(seconds) = cost { *seconds } else { 0.0 };
        definition.case(case, work, store)
    };
    runner.run(&definition.cases().into_iter().zip(&costs.cases).map(case).collect::<Vec<_>>())
}

/// Point and seed of the case with this number, from 1.
///
/// # Errors
/// A number that no case has.
pub fn numbered(definition: &Definition, number: usize) -> Result<(usize, u64)> {
    let cases = definition.cases();
    number.checked_sub(1).and_then(|index| cases.get(index).copied()).ok_or_else(|| {
        let help = format!("its cases are numbered from 1 to {}; see --dry-run", cases.len());
        Error::input(format!("the study has no case {number}"), help)
    })
}
