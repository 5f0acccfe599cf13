//! How many threads of a team are worth having: found by trying while a run goes on.

/// Steps of one trial. The fastest counts: a step with a neighbour search in it, or one from which the system took the
/// cores, says nothing about the loops.
const STEPS: usize = 24;
/// Steps from the end of one round of trials to the next: what there is to do changes as contacts close and wires break.
const HOLD: usize = 4096;
/// Fewer threads are taken for as fast when their steps take at most this much longer (-).
const AS_FAST: f64 = 1.05;
/// With fewer threads than those whose steps take this much longer than the best, it is slower still (-).
const TOO_SLOW: f64 = 1.3;

/// Tries numbers of threads from all of them down, and takes the fewest that are as fast as the fastest. Bits do not depend
/// on it.
pub struct Tuning {
    /// Numbers that come into question, falling.
    counts: Vec<usize>,
    /// Which of them works now.
    at: usize,
    round: Round,
}

enum Round {
    /// So many steps are left with the number found.
    Hold(usize),
    /// The numbers up to and without the second place are tried.
    Trial {
        /// Least time of a step with each number tried so far (s), from the first place of this round on.
        least: Vec<f64>,
        /// Where the round began among the numbers.
        first: usize,
        /// Where it ends.
        end: usize,
        /// Steps done of the present trial.
        steps: usize,
    },
}

impl Tuning {
    /// For a team of `threads`: begins with all of them.
    pub fn new(threads: usize) -> Self {
        // Steps of a quarter to a third: 16, 12, 8, 6, 4, 3, 2, 1.
        let usual = (0..16).flat_map(|k| [4usize << k, 3 << k]).chain([1, 2]).filter(|n| *n < threads);
        let mut counts: Vec<usize> = usual.chain([threads.max(1)]).collect();
        counts.sort_unstable_by(|a, b| b.cmp(a));
        let end = counts.len();
        Self { counts, at: 0, round: Round::Trial { least: Vec::new(), first: 0, end, steps: 0 } }
    }

    /// Takes in how long a step took (s); answers with how many threads are to do the next one.
    pub fn after_step(&mut self, seconds: f64) -> usize {
        match &mut self.round {
            Round::Hold(0) => {
                // From now on the neighbours alone: the next larger number, this one, the next smaller.
                let (first, end) = (self.at.saturating_sub(1), (self.at + 2).min(self.counts.len()));
                self.at = first;
                self.round = Round::Trial { least: Vec::new(), first, end, steps: 0 };
            }
            Round::Hold(left) => *left -= 1,
            Round::Trial { least, first, end, steps } => {
                match least.get_mut(self.at - *first) {
                    Some(least) => *least = least.min(seconds),
                    None => least.push(seconds),
                }
                *steps += 1;
                if *steps == STEPS {
                    *steps = 0;
                    let best = least.iter().copied().fold(f64::INFINITY, f64::min);
                    let hopeless = least.last().is_some_and(|last| *last > TOO_SLOW * best);
                    self.at += 1;
                    if self.at == *end || hopeless {
                        let fewest = least.iter().rposition(|time| *time <= AS_FAST * best).unwrap_or(0);
                        self.at = *first + fewest;
                        self.round = Round::Hold(HOLD);
                    }
                }
            }
        }
        self.counts[self.at]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number of threads after `steps` steps that take what `time` says of their threads.
    fn found(tuning: &mut Tuning, threads: usize, steps: usize, time: impl Fn(usize) -> f64) -> usize {
        (0..steps).fold(threads, |threads, step| {
            // Every seventh step takes long for other reasons.
            tuning.after_step(time(threads) * if step % 7 == 0 { 3.0 } else { 1.0 })
        })
    }

    /// Work that is shared beside work that is not, and a cost per thread (s).
    fn step(shared: f64, alone: f64, per_thread: f64) -> impl Fn(usize) -> f64 {
        move |threads| alone + shared / threads as f64 + per_thread * threads as f64
    }

    #[test]
    fn numbers_come_in_steps_of_a_quarter_to_a_third() {
        assert_eq!(Tuning::new(16).counts, [16, 12, 8, 6, 4, 3, 2, 1]);
        assert_eq!(Tuning::new(10).counts, [10, 8, 6, 4, 3, 2, 1]);
        assert_eq!(Tuning::new(2).counts, [2, 1]);
        assert_eq!(Tuning::new(1).counts, [1]);
        assert_eq!(Tuning::new(0).counts, [1]);
    }

    #[test]
    fn as_many_threads_as_help_and_no_more() {
        // All shared: all threads.
        assert_eq!(found(&mut Tuning::new(16), 16, 1000, step(1e-3, 0.0, 0.0)), 16);
        // Nothing shared: one.
        assert_eq!(found(&mut Tuning::new(16), 16, 1000, step(0.0, 1e-3, 0.0)), 1);
        // Each thread costs: √(1000/16) = 7.9 would be best.
        assert_eq!(found(&mut Tuning::new(16), 16, 1000, step(1e-3, 0.0, 16e-6)), 6);
        // Two threads that are no faster than one.
        assert_eq!(found(&mut Tuning::new(2), 2, 1000, step(5e-6, 0.0, 3e-6)), 1);
        assert_eq!(found(&mut Tuning::new(2), 2, 1000, step(500e-6, 20e-6, 3e-6)), 2);
    }

    #[test]
    fn follows_the_work() {
        let mut tuning = Tuning::new(16);
        let few = found(&mut tuning, 16, 1000, step(20e-6, 0.0, 2e-6));
        assert_eq!(few, 3);
        let later = found(&mut tuning, few, 40_000, step(2e-3, 0.0, 2e-6));
        assert_eq!(later, 16);
        assert_eq!(found(&mut tuning, later, 40_000, step(20e-6, 0.0, 2e-6)), 3);
        // One round of three trials in HOLD steps is all that it costs.
        let mut changes = 0;
        let mut threads = 3;
        for _ in 0..HOLD {
            let next = tuning.after_step(step(20e-6, 0.0, 2e-6)(threads));
            changes += usize::from(next != threads);
            threads = next;
        }
        assert!(changes <= 4, "{changes}");
    }
}
