//! [`CaseRunner`]: how every study runs its cases. Cases that are kept are not run again, those that the budget has no
//! room for are left out, and one that fails does not stop the others.

pub mod store;
pub mod unfinished;

use crate::base::error::{Error, Result};
use crate::run::in_pool;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
pub use store::{CaseStore, Identity, Record};
pub use unfinished::Unfinished;

/// Something to be run whose result a study needs.
pub trait Case: Sync {
    /// What running it gives; that it failed is a result too.
    type Output: Send;

    /// What it is called in the progress line.
    fn name(&self) -> String;

    /// The result that an earlier study kept.
    fn kept(&self) -> Option<Self::Output> {
        None
    }

    /// Runs it in the present thread pool.
    ///
    /// # Errors
    /// [`Error::Interrupted`] when `stop` ended it early; what the machine refuses, which ends the whole study.
    fn run(&self, stop: &AtomicBool) -> Result<Self::Output>;

    /// What it costs, in any unit that all cases share.
    fn work(&self) -> f64 {
        1.0
    }

    /// Whether it must be over before the others begin, because estimates go by it.
    fn leads(&self) -> bool {
        false
    }

    /// Wall time that a result took (s); `None` where estimates are not to go by it.
    fn wall_s(&self, _output: &Self::Output) -> Option<f64> {
        None
    }
}

/// Runs cases: how many at a time, for how long, and who hears of it.
pub struct CaseRunner<'a> {
    /// Cases side by side, each on one thread when there are several.
    pub jobs: usize,
    /// Threads of a case when they are run one by one; `None`: one per core.
    pub threads: Option<usize>,
    /// Wall time that all may take (s).
    pub budget: Option<f64>,
    /// Ends it early.
    pub stop: &'a AtomicBool,
    /// Hears of every case that begins or ends.
    pub tell: &'a (dyn Fn(&Progress) + Sync),
}

/// How far a study is.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// The case that was finished, or is about to be run.
    pub name: String,
    /// Cases finished, kept ones among them.
    pub finished: usize,
    /// Cases in all.
    pub of: usize,
    /// Share of the work done (-).
    pub share: f64,
    /// Time left (s); `None` before any case says how fast the machine is.
    pub left: Option<f64>,
}

/// What became of a case.
#[derive(Debug, Clone, PartialEq)]
pub enum Status<T> {
    /// It was run now.
    Run(T),
    /// An earlier study had run it.
    Kept(T),
    /// The budget has no room for it: what it would take (s).
    LeftOut(f64),
    /// The study was interrupted before it was over.
    Interrupted,
}

impl<T> Status<T> {
    /// Its result, if it has one.
    pub fn output(&self) -> Option<&T> {
        match self {
            Status::Run(output) | Status::Kept(output) => Some(output),
            Status::LeftOut(_) | Status::Interrupted => None,
        }
    }

    /// The same, taken out.
    pub fn into_output(self) -> Option<T> {
        match self {
            Status::Run(output) | Status::Kept(output) => Some(output),
            Status::LeftOut(_) | Status::Interrupted => None,
        }
    }
}

/// The results of cases of which none may be missing.
///
/// # Errors
/// [`Error::Interrupted`] when one is.
pub fn all_outputs<T>(statuses: Vec<Status<T>>) -> Result<Vec<T>> {
    statuses.into_iter().map(|status| status.into_output().ok_or(Error::Interrupted)).collect()
}

/// What the workers share.
struct Shared<T> {
    next: usize,
    statuses: Vec<Status<T>>,
    /// Wall time (s) and work of the cases that estimates go by: those run now, and before there are any, the kept ones
    /// that lead.
    pace: (f64, f64),
    /// Cases run now.
    run: usize,
    finished: usize,
    /// Cases of which it is known what became of them.
    entered: usize,
    /// Work of what is over, and of everything that is or will be run.
    done: f64,
    all: f64,
    failed: Option<Error>,
}

impl<T> Shared<T> {
    /// Wall time of one unit of work (s).
    fn wall_per_work(&self) -> Option<f64> {
        (self.pace.1 > 0.0).then(|| self.pace.0 / self.pace.1)
    }

    /// Takes a case into the estimates. A busy machine shows in what is run now, so that counts more than what is kept.
    fn set_pace(&mut self, wall_s: f64, work: f64, leads: bool, kept: bool) {
        if kept && (self.run > 0 || !leads) {
            return;
        }
        if !kept {
            if self.run == 0 {
                self.pace = (0.0, 0.0);
            }
            self.run += 1;
        }
        self.pace = (self.pace.0 + wall_s, self.pace.1 + work);
    }

    /// Enters what became of a case.
    fn enter<C: Case<Output = T>>(&mut self, index: usize, case: &C, status: Status<T>) {
        let kept = matches!(status, Status::Kept(_));
        self.entered += 1;
        match status.output() {
            Some(output) => {
                self.finished += 1;
                if let Some(wall_s) = case.wall_s(output) {
                    self.set_pace(wall_s, case.work(), case.leads(), kept);
                }
                // Kept cases say nothing of the time that is left.
                if kept { self.all -= case.work() } else { self.done += case.work() }
            }
            None => self.all -= case.work(),
        }
        self.statuses[index] = status;
    }
}

impl CaseRunner<'_> {
    /// Runs all cases and says what became of each, in the order of `cases`.
    ///
    /// # Errors
    /// What the machine refuses: threads, files.
    pub fn run<C: Case>(&self, cases: &[C]) -> Result<Vec<Status<C::Output>>> {
        let shared = Mutex::new(Shared {
            next: 0,
            statuses: cases.iter().map(|_| Status::Interrupted).collect(),
            pace: (0.0, 0.0),
            run: 0,
            finished: 0,
            entered: 0,
            done: 0.0,
            all: cases.iter().map(C::work).sum(),
            failed: None,
        });
        let began = Instant::now();
        // What the others cost is known only when those that lead were run.
        let leading = cases.iter().take_while(|case| case.leads()).count();
        for end in [leading, cases.len()] {
            std::thread::scope(|scope| {
                for _ in 0..self.jobs.min(cases.len()) {
                    scope.spawn(|| self.work(cases, end, began, &shared));
                }
            });
        }
        let shared = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
        shared.failed.map_or(Ok(shared.statuses), Err)
    }

    /// Takes cases until `end` as long as there are any.
    fn work<C: Case>(&self, cases: &[C], end: usize, began: Instant, shared: &Mutex<Shared<C::Output>>) {
        let lock = || shared.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            let index = {
                let mut now = lock();
                if self.stop.load(Ordering::Relaxed) || now.failed.is_some() || now.next == end {
                    return;
                }
                now.next += 1;
                now.next - 1
            };
            let case = &cases[index];
            self.say(case.name(), cases.len(), began, &lock());
            let estimate = lock().wall_per_work().map(|wall| wall * case.work());
            let status = self.one(case, estimate, began);
            let mut now = lock();
            match status {
                Ok(status) => now.enter(index, case, status),
                Err(error) => now.failed = Some(error),
            }
            self.say(case.name(), cases.len(), began, &now);
        }
    }

    fn one<C: Case>(&self, case: &C, estimate: Option<f64>, began: Instant) -> Result<Status<C::Output>> {
        if let Some(output) = case.kept() {
            return Ok(Status::Kept(output));
        }
        if let Some((budget, estimate)) = self.budget.zip(estimate)
            && began.elapsed().as_secs_f64() + estimate > budget
        {
            return Ok(Status::LeftOut(estimate));
        }
        match in_pool(Some(self.threads_per_case()), || case.run(self.stop))? {
            Ok(output) => Ok(Status::Run(output)),
            Err(Error::Interrupted) => Ok(Status::Interrupted),
            Err(error) => Err(error),
        }
    }

    fn say<T>(&self, name: String, of: usize, began: Instant, now: &Shared<T>) {
        // Two sums of the same works in another order may differ by a bit.
        let share = if now.entered == of || now.all <= 0.0 { 1.0 } else { (now.done / now.all).clamp(0.0, 1.0) };
        let work = (now.all - now.done).max(0.0) / self.jobs as f64;
        let within = |left: f64| match self.budget {
            Some(budget) => left.min((budget - began.elapsed().as_secs_f64()).max(0.0)),
            None => left,
        };
        let left = now.wall_per_work().map(|wall| within(wall * work));
        (self.tell)(&Progress { name, finished: now.finished, of, share, left });
    }

    /// Threads of each case.
    pub fn threads_per_case(&self) -> usize {
        if self.jobs > 1 { 1 } else { self.threads.unwrap_or_else(cores) }
    }
}

/// Cores that this program may use.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A case whose run gives its number, or is interrupted as a user would.
    struct Counted {
        number: u32,
        work: f64,
        interrupts: bool,
    }

    impl Case for Counted {
        type Output = u32;

        fn name(&self) -> String {
            self.number.to_string()
        }

        fn kept(&self) -> Option<u32> {
            (self.number == 0).then_some(0)
        }

        fn run(&self, stop: &AtomicBool) -> Result<u32> {
            if self.interrupts {
                stop.store(true, Ordering::Relaxed);
                return Err(Error::Interrupted);
            }
            Ok(self.number)
        }

        fn work(&self) -> f64 {
            self.work
        }

        fn wall_s(&self, _: &u32) -> Option<f64> {
            Some(10.0)
        }
    }

    fn run(cases: &[Counted], budget: Option<f64>) -> Vec<Status<u32>> {
        let stop = AtomicBool::new(false);
        CaseRunner { jobs: 1, threads: Some(1), budget, stop: &stop, tell: &|_| {} }.run(cases).unwrap()
    }

    fn cases(interrupts: Option<u32>) -> Vec<Counted> {
        (0..4).map(|number| Counted { number, work: 1.0, interrupts: interrupts == Some(number) }).collect()
    }

    #[test]
    fn what_is_kept_is_not_run_and_what_the_budget_lacks_is_left_out() {
        assert_eq!(run(&cases(None), None), [Status::Kept(0), Status::Run(1), Status::Run(2), Status::Run(3)]);
        // The first that is run says how long the others take.
        let left = [Status::Kept(0), Status::Run(1), Status::LeftOut(10.0), Status::LeftOut(10.0)];
        assert_eq!(run(&cases(None), Some(5.0)), left);
    }

    #[test]
    fn all_that_is_over_is_the_whole_to_the_bit() {
        // In doubles 0.1 + 0.7 + 0.2 − 0.1 is not 0.7 + 0.2.
        let cases: Vec<Counted> = [0.1, 0.7, 0.2]
            .into_iter()
            .zip(0..)
            .map(|(work, number)| Counted { number, work, interrupts: false })
            .collect();
        let (stop, shares) = (AtomicBool::new(false), Mutex::new(Vec::new()));
        let tell = |progress: &Progress| shares.lock().unwrap().push(progress.share);
        CaseRunner { jobs: 1, threads: Some(1), budget: None, stop: &stop, tell: &tell }.run(&cases).unwrap();
        let shares = shares.into_inner().unwrap();
        assert!(shares.is_sorted() && shares.last() == Some(&1.0), "{shares:?}");
    }

    #[test]
    fn an_interruption_leaves_what_is_over_and_is_an_error_of_its_own_where_all_is_needed() {
        let statuses = run(&cases(Some(2)), None);
        assert_eq!(statuses, [Status::Kept(0), Status::Run(1), Status::Interrupted, Status::Interrupted]);
        assert!(matches!(all_outputs(statuses), Err(Error::Interrupted)));
        assert_eq!(all_outputs(run(&cases(None), None)).unwrap(), [0, 1, 2, 3]);
    }
}
