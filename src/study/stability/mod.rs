//! Numerical stability on stiff and extreme cases: a matrix of scenes, each run and judged.
//!
//! Every case must end `stable`, with its energy ledger closed and the number right where one is known, or `refused`
//! or `stopped` by a message that names cause and remedy. Everything else is `FAILED`: a value that is not finite, a
//! hang, an open ledger, a wrong number, a panic.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`matrix`] | the table of cases |
//! | [`case`] | what a case is |
//! | [`run`] | runs one, on a thread of its own, and watches it |
//! | [`measure`] | known numbers |
//! | [`critical`] | the empirical critical time step by bisection |
//! | [`outcome`] | how a case ended |

pub mod case;
pub mod critical;
pub mod matrix;
pub mod measure;
pub mod outcome;
pub mod run;
pub mod table;

use crate::base::error::{Error, Result};
use crate::scene::suggest::nearest;
use case::Case;
use outcome::Report;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// The cases of these names, all when there is none; a name that ends in `*` takes all that begin so.
///
/// # Errors
/// A name that no case has; the nearest is suggested.
pub fn select(names: &[String]) -> Result<Vec<Case>> {
    let all = matrix::cases();
    if let Some(name) = names.iter().find(|name| !all.iter().any(|case| matches(name, case))) {
        let help = match nearest(name, all.iter().map(|case| case.name.as_str())) {
            Some(near) => format!("did you mean `{near}`? `strandsnap stability --list` names them all"),
            None => "`strandsnap stability --list` names them all; `friction-*` takes all that begin so".into(),
        };
        return Err(Error::input(format!("there is no stability case `{name}`"), help));
    }
    let wanted = |case: &Case| names.is_empty() || names.iter().any(|name| matches(name, case));
    Ok(all.into_iter().filter(wanted).collect())
}

fn matches(name: &str, case: &Case) -> bool {
    match name.strip_suffix('*') {
        Some(start) => case.name.starts_with(start),
        None => case.name == name,
    }
}

/// Runs cases, `threads` at a time and each on one thread; `tell` hears of each in the order of the list. Returns the
/// reports in that order; those that `cancel` cut off are not among them.
pub fn run_all(
    cases: &[Case],
    quick: bool,
    threads: usize,
    cancel: &AtomicBool,
    tell: &mut (dyn FnMut(&Report) + Send),
) -> Vec<Report> {
    let next = AtomicUsize::new(0);
    let line = Mutex::new(Line { waiting: cases.iter().map(|_| None).collect(), told: Vec::new(), tell });
    std::thread::scope(|scope| {
        for _ in 0..threads.max(1) {
            scope.spawn(|| {
                while !cancel.load(Ordering::Relaxed) {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(case) = cases.get(index) else { break };
                    let Some(report) = run::run_case(case, quick, cancel) else { break };
                    line.lock().unwrap_or_else(|held| held.into_inner()).take(index, report);
                }
            });
        }
    });
    line.into_inner().unwrap_or_else(|held| held.into_inner()).told
}

/// Reports that wait for those before them.
struct Line<'a> {
    waiting: Vec<Option<Report>>,
    told: Vec<Report>,
    tell: &'a mut (dyn FnMut(&Report) + Send),
}

impl Line<'_> {
    fn take(&mut self, index: usize, report: Report) {
        self.waiting[index] = Some(report);
        while let Some(report) = self.waiting.get_mut(self.told.len()).and_then(Option::take) {
            (self.tell)(&report);
            self.told.push(report);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_are_found_by_name_and_by_beginning() {
        let find = |name: &str| select(&[name.to_string()]);
        assert_eq!(find("friction-0-sphere").unwrap().len(), 1);
        assert!(find("friction-*").unwrap().len() >= 8);
        let error = format!("{:?}", miette::Report::new(find("frition-0-sphere").unwrap_err()));
        assert!(error.contains("friction-0-sphere"), "{error}");
        assert_eq!(select(&[]).unwrap().len(), matrix::cases().len());
    }

    #[test]
    fn no_two_cases_have_one_name() {
        let mut names: Vec<String> = matrix::cases().into_iter().map(|case| case.name).collect();
        names.sort();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?}");
    }
}
