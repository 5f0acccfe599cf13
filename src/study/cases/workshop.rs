//! Makes the runs of a study: those that are kept are not made again, those that the budget has no room for are left
//! out, and one that fails does not stop the others.

use super::record::{self, CpuClock, Found, Identity, Record};
use crate::base::error::{Error, Result};
use crate::run::in_pool;
use crate::scene::{self, Scene};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// A run that is to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// What it is called.
    pub name: String,
    /// Options of the scene, in the order in which they win.
    pub overrides: Vec<String>,
    /// What it will cost, in any unit that all cases share.
    pub work: f64,
    /// Whether it is written to disk.
    pub writes: bool,
    /// Whether it must be over before the others begin, because estimates go by it.
    pub leads: bool,
}

/// How the runs are made.
pub struct Workshop<'a> {
    /// The scene by name or path.
    pub scene: &'a str,
    /// Folder of the study.
    pub folder: &'a Path,
    /// Runs side by side, each on one thread when there are several.
    pub jobs: usize,
    /// Threads of the engine when runs are made one by one; `None`: one per core.
    pub threads: Option<usize>,
    /// Whether the cost of runs is what is studied: then a run on another number of threads is another run.
    pub costs: bool,
    /// Wall time that the study may take (s).
    pub budget: Option<f64>,
    /// When it began.
    pub began: Instant,
    /// Ends it early.
    pub stop: &'a AtomicBool,
    /// Hears of every run.
    pub tell: &'a (dyn Fn(&Progress) + Sync),
}

/// How far the study is.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// What was finished, or is about to be made.
    pub name: String,
    /// Runs finished, kept ones among them.
    pub finished: usize,
    /// Runs in all.
    pub of: usize,
    /// Share of the work done (-).
    pub share: f64,
    /// Time left (s); `None` before any run says how fast the machine is.
    pub left: Option<f64>,
}

/// What became of a case.
#[derive(Debug, Clone, PartialEq)]
pub enum Became {
    /// It is over; `kept` when an earlier study had made it.
    Done {
        /// The record.
        record: Box<Record>,
        /// Whether it was there already.
        kept: bool,
    },
    /// The scene refused the values: why.
    Refused(String),
    /// The budget has no room for it: what it would take (s).
    LeftOut(f64),
    /// The study was interrupted before.
    NotReached,
}

/// What the workers share.
struct Shared {
    next: usize,
    became: Vec<Became>,
    /// Wall time (s) and work of the runs that estimates go by: those made now, and before there are any, the kept ones
    /// that lead.
    pace: (f64, f64),
    /// Runs made now.
    made: usize,
    finished: usize,
    /// Work of what is over, and of everything that is or will be made.
    done: f64,
    all: f64,
    failed: Option<Error>,
}

impl Shared {
    /// Wall time of a run of one unit of work (s).
    fn wall_per_work(&self) -> Option<f64> {
        (self.pace.1 > 0.0).then(|| self.pace.0 / self.pace.1)
    }
}

impl Shared {
    /// Takes a run into the estimates. A busy machine shows in what is made now, so that counts more than what is kept.
    fn pace(&mut self, wall_s: f64, case: &Case, kept: bool) {
        if kept && (self.made > 0 || !case.leads) {
            return;
        }
        if !kept {
            if self.made == 0 {
                self.pace = (0.0, 0.0);
            }
            self.made += 1;
        }
        self.pace = (self.pace.0 + wall_s, self.pace.1 + case.work);
    }
}

impl Workshop<'_> {
    /// Makes all runs, in the order of `cases`.
    ///
    /// # Errors
    /// What the machine refuses: threads, files.
    pub fn make(&self, cases: &[Case]) -> Result<Vec<Became>> {
        let all = cases.iter().map(|case| case.work).sum();
        let shared = Mutex::new(Shared {
            next: 0,
            became: vec![Became::NotReached; cases.len()],
            pace: (0.0, 0.0),
            made: 0,
            finished: 0,
            done: 0.0,
            all,
            failed: None,
        });
        // What the others cost is known only when those that lead were run.
        let leading = cases.iter().take_while(|case| case.leads).count();
        for end in [leading, cases.len()] {
            std::thread::scope(|scope| {
                for _ in 0..self.jobs {
                    scope.spawn(|| self.worker(cases, end, &shared));
                }
            });
        }
        let shared = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
        shared.failed.map_or(Ok(shared.became), Err)
    }

    /// Takes cases until `end` as long as there are any.
    fn worker(&self, cases: &[Case], end: usize, shared: &Mutex<Shared>) {
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
            self.say(&cases[index].name, cases.len(), &lock());
            let estimate = lock().wall_per_work().map(|wall| wall * cases[index].work);
            let made = self.one(&cases[index], estimate);
            let mut now = lock();
            match made {
                Ok(Some(became)) => self.book(index, &cases[index], became, &mut now),
                Ok(None) => {}
                Err(error) => now.failed = Some(error),
            }
            self.say(&cases[index].name, cases.len(), &now);
        }
    }

    fn book(&self, index: usize, case: &Case, became: Became, now: &mut Shared) {
        match &became {
            Became::Done { record, kept } => {
                now.finished += 1;
                if let Found::Ran(measured) = &record.found {
                    now.pace(measured.wall_s, case, *kept);
                }
                // Kept runs say nothing of the time that is left.
                if *kept { now.all -= case.work } else { now.done += case.work }
            }
            _ => now.all -= case.work,
        }
        now.became[index] = became;
    }

    fn say(&self, name: &str, of: usize, now: &Shared) {
        let wall = now.wall_per_work();
        let share = if now.all > 0.0 { now.done / now.all } else { 1.0 };
        let work = (now.all - now.done).max(0.0) / self.jobs as f64;
        let within = |left: f64| match self.budget {
            Some(budget) => left.min((budget - self.began.elapsed().as_secs_f64()).max(0.0)),
            None => left,
        };
        let left = wall.map(|wall| within(wall * work));
        (self.tell)(&Progress { name: name.into(), finished: now.finished, of, share, left });
    }

    /// One case; `None` when it was interrupted.
    fn one(&self, case: &Case, estimate: Option<f64>) -> Result<Option<Became>> {
        let scene = match scene::load(self.scene, &case.overrides) {
            Ok(scene) => scene,
            Err(error @ (Error::Scene(_) | Error::Input { .. })) => {
                return Ok(Some(Became::Refused(error.to_string())));
            }
            Err(error) => return Err(error),
        };
        let threads = self.costs.then(|| self.threads_of_a_run());
        let identity = Identity::of(&scene.spec, threads, case.writes);
        if let Some(record) = Record::kept(&identity, self.folder) {
            return Ok(Some(Became::Done { record: Box::new(record), kept: true }));
        }
        if let Some((budget, estimate)) = self.budget.zip(estimate)
            && self.began.elapsed().as_secs_f64() + estimate > budget
        {
            return Ok(Some(Became::LeftOut(estimate)));
        }
        let record = self.run(&scene, &identity)?;
        Ok(record.map(|record| Became::Done { record: Box::new(record), kept: false }))
    }

    fn run(&self, scene: &Scene, identity: &Identity) -> Result<Option<Record>> {
        let clock = if self.jobs > 1 { CpuClock::Thread } else { CpuClock::Process };
        in_pool(Some(self.threads_of_a_run()), || record::run(scene, identity, self.folder, clock, self.stop))?
    }

    /// Threads of the engine in each run.
    pub fn threads_of_a_run(&self) -> usize {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        if self.jobs > 1 { 1 } else { self.threads.unwrap_or_else(cores) }
    }
}
