//! Verification: the engine against closed forms (physics page, section 8). A case is a scene `verify/…`, a formula of
//! [`crate::reference`] and a function here that runs the one and compares it with the other; [`CASES`] lists them.

mod contacts;
pub mod finding;
pub mod support;

use crate::base::error::Result;
use crate::run::in_pool;
use finding::Finding;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
pub use support::Effort;
use support::Lab;

/// A case: one claim about the engine that a closed form decides.
pub struct Case {
    /// What the user calls it.
    pub name: &'static str,
    /// The claim in one line.
    pub about: &'static str,
    /// Where the equation comes from.
    pub source: &'static str,
    /// Runs what the case needs and compares.
    pub run: fn(&Lab) -> Result<Vec<Finding>>,
}

/// All cases, by theme.
pub const CASES: &[Case] = &[
    // Contacts of spheres
    contacts::HERTZ,
];

/// The case of this name.
pub fn find(name: &str) -> Option<&'static Case> {
    CASES.iter().find(|case| case.name == name)
}

/// What became of one case.
pub struct Report {
    /// The case.
    pub case: &'static Case,
    /// What it found, its energy ledger last; or why it could not be run.
    pub result: Result<Vec<Finding>>,
    /// Wall time [s].
    pub wall_s: f64,
}

/// Runs one case on the present thread pool. `stop` ends it early, as an error.
pub fn run_one(case: &'static Case, effort: Effort, stop: &AtomicBool) -> Report {
    let began = Instant::now();
    let lab = Lab::new(effort, stop);
    let result = (case.run)(&lab).map(|mut findings| {
        findings.extend(lab.ledger());
        findings
    });
    Report { case, result, wall_s: began.elapsed().as_secs_f64() }
}

/// Runs cases side by side, each on a thread of its own: they are small, and sharing one out over threads would only
/// cost. Calls `done` after each. Reports come in the order of `cases`; those that `stop` cut short are left out.
///
/// # Errors
/// When a thread cannot be started.
pub fn run_all(
    cases: &[&'static Case],
    effort: Effort,
    threads: usize,
    stop: &AtomicBool,
    done: &(dyn Fn(&Report) + Sync),
) -> Result<Vec<Report>> {
    let next = AtomicUsize::new(0);
    let reports = Mutex::new(Vec::new());
    let work = || -> Result<()> {
        while !stop.load(Ordering::Relaxed) {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(case) = cases.get(index) else { break };
            let report = in_pool(Some(1), || run_one(case, effort, stop))?;
            if report.result.is_ok() || !stop.load(Ordering::Relaxed) {
                done(&report);
                reports.lock().unwrap_or_else(PoisonError::into_inner).push((index, report));
            }
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.clamp(1, cases.len().max(1))).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .try_for_each(|worker| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })?;
    let mut reports = reports.into_inner().unwrap_or_else(PoisonError::into_inner);
    reports.sort_by_key(|(index, _)| *index);
    Ok(reports.into_iter().map(|(_, report)| report).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn names_are_unique_and_every_case_says_what_it_claims() {
        let mut seen = HashSet::new();
        for case in CASES {
            assert!(seen.insert(case.name), "{} is there twice", case.name);
            assert!(
                case.name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'),
                "{}",
                case.name
            );
            assert!(!case.about.is_empty() && !case.source.is_empty(), "{}", case.name);
        }
    }
}
