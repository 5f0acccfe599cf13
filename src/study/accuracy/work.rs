//! Makes the runs of a study: those that are kept are not made again, those that the budget has no room for are left
//! out, and one that fails does not stop the others.

use super::agenda::Item;
use super::case::{self, CpuClock, Found, Identity, Record};
use crate::base::error::{Error, Result};
use crate::run::in_pool;
use crate::scene::{self, Scene};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// How the runs are made.
pub struct Workshop<'a> {
    /// The scene by name or path.
    pub scene: &'a str,
    /// Its options.
    pub overrides: &'a [String],
    /// Folder of the study.
    pub folder: &'a Path,
    /// Runs side by side, each on one thread when there are several.
    pub jobs: usize,
    /// Threads of the engine when runs are made one by one; `None`: one per core.
    pub threads: Option<usize>,
    /// Wall time that the study may take [s].
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
    /// Share of the work done [-].
    pub share: f64,
    /// Time left [s]; `None` before the scene itself was run.
    pub left: Option<f64>,
}

/// What became of an item.
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
    /// The budget has no room for it: what it would take [s].
    LeftOut(f64),
    /// The study was interrupted before.
    NotReached,
}

/// What the workers share.
struct Shared {
    next: usize,
    became: Vec<Became>,
    /// Wall time [s] and work of the runs that estimates go by: those made now, and before there are any, the kept ones
    /// of the scene as it stands.
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
    /// Wall time of a run like that of the scene as it stands [s].
    fn wall_per_work(&self) -> Option<f64> {
        (self.pace.1 > 0.0).then(|| self.pace.0 / self.pace.1)
    }
}

impl Shared {
    /// Takes a run into the estimates. A busy machine shows in what is made now, so that counts more than what is kept.
    fn pace(&mut self, wall_s: f64, item: &Item, kept: bool) {
        if kept && (self.made > 0 || item.place.is_some()) {
            return;
        }
        if !kept {
            if self.made == 0 {
                self.pace = (0.0, 0.0);
            }
            self.made += 1;
        }
        self.pace = (self.pace.0 + wall_s, self.pace.1 + item.work);
    }
}

impl Workshop<'_> {
    /// Makes all runs, in the order of `items`.
    ///
    /// # Errors
    /// What the machine refuses: threads, files.
    pub fn make(&self, items: &[Item]) -> Result<Vec<Became>> {
        let all = items.iter().map(|item| item.work).sum();
        let shared = Mutex::new(Shared {
            next: 0,
            became: vec![Became::NotReached; items.len()],
            pace: (0.0, 0.0),
            made: 0,
            finished: 0,
            done: 0.0,
            all,
            failed: None,
        });
        // What the others cost is known only when the scene itself was run.
        let bases = items.iter().take_while(|item| item.place.is_none()).count();
        for end in [bases, items.len()] {
            std::thread::scope(|scope| {
                for _ in 0..self.jobs {
                    scope.spawn(|| self.worker(items, end, &shared));
                }
            });
        }
        let shared = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
        shared.failed.map_or(Ok(shared.became), Err)
    }

    /// Takes items until `end` as long as there are any.
    fn worker(&self, items: &[Item], end: usize, shared: &Mutex<Shared>) {
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
            self.say(&items[index].name, items.len(), &lock());
            let estimate = lock().wall_per_work().map(|wall| wall * items[index].work);
            let made = self.one(&items[index], estimate);
            let mut now = lock();
            match made {
                Ok(Some(became)) => self.book(index, &items[index], became, &mut now),
                Ok(None) => {}
                Err(error) => now.failed = Some(error),
            }
            self.say(&items[index].name, items.len(), &now);
        }
    }

    fn book(&self, index: usize, item: &Item, became: Became, now: &mut Shared) {
        match &became {
            Became::Done { record, kept } => {
                now.finished += 1;
                if let Found::Ran(measured) = &record.found {
                    now.pace(measured.wall_s, item, *kept);
                }
                // Kept runs say nothing of the time that is left.
                if *kept { now.all -= item.work } else { now.done += item.work }
            }
            _ => now.all -= item.work,
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

    /// One item; `None` when it was interrupted.
    fn one(&self, item: &Item, estimate: Option<f64>) -> Result<Option<Became>> {
        let overrides: Vec<String> = self.overrides.iter().chain(&item.set).cloned().collect();
        let scene = match scene::load(self.scene, &overrides) {
            Ok(scene) => scene,
            Err(error @ (Error::Scene(_) | Error::Input { .. })) => {
                return Ok(Some(Became::Refused(error.to_string())));
            }
            Err(error) => return Err(error),
        };
        let identity = Identity::of(&scene.spec, self.threads_of_a_run(), item.writes);
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
        in_pool(Some(identity.threads), || case::run(scene, identity, self.folder, clock, self.stop))?
    }

    /// Threads of the engine in each run.
    pub fn threads_of_a_run(&self) -> usize {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        if self.jobs > 1 { 1 } else { self.threads.unwrap_or_else(cores) }
    }
}
