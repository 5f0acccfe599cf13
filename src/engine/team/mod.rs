//! The threads that share the loops of a step.
//!
//! A step has half a dozen parallel loops of some 10 to 100 µs each. A pool that hands out tasks through queues and lets
//! its threads sleep in between takes as long to wake them as such a loop lasts. A [`Team`] keeps its threads at hand:
//! for a moment after each loop they look for the next one, then they sleep, so that a long pause (a picture, a
//! row, the end of a run) costs no core. Every thread begins with a share of the items that is its own and the same in
//! every loop, so that they stay in its caches, and helps others when it is done: a thread that the system takes away
//! for a while holds up no more than the item that it was at.
//!
//! What an item gives does not depend on who works at it, and what has to be added up is added up in the order of items
//! afterwards: the bits are the same on any number of threads.

mod threads;
mod tuning;

use crate::base::error::Result;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use threads::Threads;
pub use tuning::Tuning;

/// Threads that work at loops together: the one that asks for it, and helpers.
pub struct Team {
    /// None where there is nobody to help.
    helpers: Option<Threads>,
    /// How many work, the one that asks included.
    working: usize,
}

/// Items of a loop that one thread begins with, and how many of them somebody has taken. On a cache line of its own: all
/// of a loop's traffic between threads is here.
#[repr(align(128))]
struct Share {
    first: usize,
    end: usize,
    taken: AtomicUsize,
}

impl Share {
    fn take(&self) -> Option<usize> {
        // Looked at before it is raised, so that those who come by again and again do not overflow it.
        let at = self.first + self.taken.load(Ordering::Relaxed);
        let at = if at < self.end { self.first + self.taken.fetch_add(1, Ordering::Relaxed) } else { at };
        (at < self.end).then_some(at)
    }
}

impl Team {
    /// A team of one.
    pub fn alone() -> Self {
        Self { helpers: None, working: 1 }
    }

    /// A team of `threads`, of which the caller is one.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Missing`] when the system refuses the threads.
    pub fn new(threads: usize) -> Result<Self> {
        let helpers = if threads > 1 { Some(Threads::start(threads - 1)?) } else { None };
        Ok(Self { helpers, working: threads.max(1) })
    }

    /// Threads of the team, whether they work or not.
    pub fn size(&self) -> usize {
        1 + self.helpers.as_ref().map_or(0, Threads::count)
    }

    /// Threads that work at the loops.
    pub fn working(&self) -> usize {
        self.working
    }

    /// Lets `threads` of the team work at the loops from now on, at least one; the others sleep.
    pub fn set_working(&mut self, threads: usize) {
        self.working = threads.clamp(1, self.size());
    }

    /// Calls `work` with the number of each of `items` and the item, each once, on all threads that work.
    pub fn for_each<I: Send>(&self, items: impl ExactSizeIterator<Item = I>, work: impl Fn(usize, I) + Sync) {
        let count = items.len();
        let working = self.working.min(count);
        let helpers = match &self.helpers {
            Some(helpers) if working > 1 => helpers,
            _ => return items.enumerate().for_each(|(k, item)| work(k, item)),
        };
        // Whoever takes an item is alone with it: its lock is never waited for.
        let items: Vec<Mutex<Option<I>>> = items.map(|item| Mutex::new(Some(item))).collect();
        let share = |thread: usize| thread * count / working;
        let shares: Vec<Share> =
            (0..working).map(|t| Share { first: share(t), end: share(t + 1), taken: AtomicUsize::new(0) }).collect();
        helpers.run(working - 1, &|thread| {
            for share in shares[thread..].iter().chain(&shares[..thread]) {
                while let Some(k) = share.take() {
                    let item = items[k].lock().unwrap_or_else(PoisonError::into_inner).take();
                    item.into_iter().for_each(|item| work(k, item));
                }
            }
        });
    }

    /// What `work` gives for each of `items`, in their order.
    pub fn map<I: Send, R: Send>(
        &self,
        items: impl ExactSizeIterator<Item = I>,
        work: impl Fn(usize, I) -> R + Sync,
    ) -> Vec<R> {
        let mut results: Vec<Option<R>> = (0..items.len()).map(|_| None).collect();
        self.for_each(items.zip(results.iter_mut()), |k, (item, result)| *result = Some(work(k, item)));
        results.into_iter().flatten().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicBool;
    use std::time::Duration;

    #[test]
    fn every_item_comes_once_with_its_number_and_results_stand_in_order() {
        for threads in [1, 2, 3, 8] {
            let team = Team::new(threads).unwrap();
            assert_eq!((team.size(), team.working()), (threads, threads));
            for count in [0, 1, 2, 7, 100, 1000] {
                let mut numbers = vec![0usize; count];
                for round in 1..=20 {
                    team.for_each(numbers.iter_mut(), |k, n| *n += k + 1);
                    assert!(numbers.iter().enumerate().all(|(k, n)| *n == round * (k + 1)), "{threads} {count}");
                }
                let squares = team.map(0..count, |k, i| (k, i * i));
                assert!(squares.into_iter().eq((0..count).map(|k| (k, k * k))));
            }
        }
    }

    #[test]
    fn all_threads_that_work_take_part_and_no_other() {
        let mut team = Team::new(4).unwrap();
        for working in [4, 2, 3, 1] {
            team.set_working(working);
            let all = AtomicBool::new(false);
            let (here, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
            // As many items as threads, each of which waits for all others: it ends only when all are there at once.
            team.for_each(0..working, |_, _| {
                let now = here.fetch_add(1, Ordering::SeqCst) + 1;
                most.fetch_max(now, Ordering::SeqCst);
                all.fetch_or(now == working, Ordering::SeqCst);
                while !all.load(Ordering::SeqCst) {
                    std::thread::yield_now();
                }
            });
            assert_eq!(most.into_inner(), working);
            // However many items there are, no more threads than that.
            let (here, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
            team.for_each(0..200, |_, _| {
                most.fetch_max(here.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                std::thread::sleep(Duration::from_micros(20));
                here.fetch_sub(1, Ordering::SeqCst);
            });
            assert!(most.into_inner() <= working);
        }
    }

    #[test]
    fn a_loop_within_a_loop_and_loops_of_two_threads_at_once_end() {
        let team = Team::new(3).unwrap();
        let sums = team.map(0..10usize, |_, i| team.map(0..10usize, |_, j| i * j).iter().sum::<usize>());
        assert!(sums.into_iter().eq((0..10).map(|i| 45 * i)));
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..200 {
                        assert_eq!(team.map(0..50usize, |_, i| i).into_iter().sum::<usize>(), 1225);
                    }
                });
            }
        });
    }

    #[test]
    fn teams_end_whatever_their_helpers_are_at() {
        for round in 0..200u64 {
            let team = Team::new(4).unwrap();
            if round % 2 == 0 {
                assert_eq!(team.map(0..20usize, |k, _| k).len(), 20);
            }
            std::thread::sleep(Duration::from_micros(round * 7 % 500));
        }
    }

    #[test]
    fn helpers_that_slept_wake_up_again() {
        let team = Team::new(2).unwrap();
        for _ in 0..5 {
            std::thread::sleep(Duration::from_millis(5));
            let all = AtomicUsize::new(0);
            team.for_each(0..2, |_, _| {
                all.fetch_add(1, Ordering::SeqCst);
                while all.load(Ordering::SeqCst) < 2 {
                    std::thread::yield_now();
                }
            });
        }
    }

    #[test]
    fn a_panic_in_a_loop_reaches_the_one_that_asked_and_the_team_lives_on() {
        let team = Team::new(3).unwrap();
        for bad in [0, 5, 9] {
            let asked = std::panic::AssertUnwindSafe(|| {
                team.for_each(0..10, |k, _| assert!(k != bad, "item {bad}"));
            });
            let told = std::panic::catch_unwind(asked).unwrap_err();
            assert_eq!(told.downcast_ref::<String>().map(String::as_str), Some(&*format!("item {bad}")));
            assert_eq!(team.map(0..5usize, |k, _| k), [0, 1, 2, 3, 4]);
        }
    }
}
