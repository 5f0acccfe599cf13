//! Which rows and which snapshots a page shows: all of a long run would make it heavy.

use crate::engine::view::{Rupture, Sample};

/// Snapshots on a page at most; frames weigh about 150 kB each.
const MOST_STATES: usize = 50;
/// Of those, as many as this after the first rupture.
const AFTER_RUPTURE: usize = 32;

/// Particles times states at most whose places are on a page: 8 MB before they are made small, about a third of that on the page.
const MOST_PLACES: usize = 900_000;

/// A snapshot that was chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SelectedSnapshot {
    /// Which one, from 0.
    pub number: usize,
    /// What is special about it.
    pub label: Option<&'static str>,
}

/// Whether the places of so many particles in so many states are few enough for a page.
pub fn places_fit(particles: usize, states: usize) -> bool {
    particles > 0 && particles * states <= MOST_PLACES
}

/// At most `most` numbers of `from..to`, evenly spread, first and last among them.
pub fn spread(from: usize, to: usize, most: usize) -> Vec<usize> {
    let count = to.saturating_sub(from);
    if count <= most {
        return (from..to).collect();
    }
    if most < 2 {
        return (to - most..to).collect();
    }
    (0..most).map(|i| from + (i * (count - 1) + (most - 1) / 2) / (most - 1)).collect()
}

/// The snapshots to show, in order: dense after the first rupture, sparse before it, with the states that people look
/// for. `steps` are the steps of the snapshots.
pub fn states(samples: &[Sample], ruptures: &[Rupture], steps: &[u64], pulled: bool) -> Vec<SelectedSnapshot> {
    if steps.is_empty() {
        return Vec::new();
    }
    let first_broken = ruptures.first().map(|first| steps.partition_point(|step| *step < first.step));
    let split = first_broken.unwrap_or(steps.len());
    let after = AFTER_RUPTURE.max(MOST_STATES - 1 - split.min(MOST_STATES - 1));
    let after = spread(split, steps.len(), after);
    let before = spread(0, split, MOST_STATES - 1 - after.len());
    let mut numbers = [before, after].concat();
    let peak = peak_step(samples).filter(|_| pulled).map(|step| nearest(steps, step));
    numbers.extend(peak);
    numbers.sort_unstable();
    numbers.dedup();
    let label = |number: usize| match number {
        _ if Some(number) == first_broken => Some("first rupture"),
        _ if first_broken.is_some_and(|first| number + 1 == first) => Some("before the first rupture"),
        _ if number + 1 == steps.len() => Some("last"),
        _ if Some(number) == peak => Some("nearest to the peak"),
        0 => Some("start"),
        _ => None,
    };
    numbers.into_iter().map(|number| SelectedSnapshot { number, label: label(number) }).collect()
}

fn peak_step(samples: &[Sample]) -> Option<u64> {
    samples.iter().reduce(|best, row| if row.stress > best.stress { row } else { best }).map(|row| row.step)
}

fn nearest(steps: &[u64], step: u64) -> usize {
    (0..steps.len()).min_by_key(|i| steps[*i].abs_diff(step)).unwrap_or(0)
}

/// At most `most` rows (and the one of the peak), half of them after `step`, where everything happens.
pub fn rows(samples: &[Sample], step: Option<u64>, most: usize) -> Vec<&Sample> {
    let split = step.map_or(samples.len(), |step| samples.partition_point(|row| row.step < step));
    let after = spread(split, samples.len(), (most / 2).max(most - split.min(most)));
    let before = spread(0, split, most - after.len());
    let mut numbers = [before, after].concat();
    numbers.extend(peak_step(samples).map(|peak| samples.partition_point(|row| row.step < peak)));
    numbers.sort_unstable();
    numbers.dedup();
    numbers.into_iter().filter_map(|i| samples.get(i)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreading_keeps_both_ends_and_the_count() {
        for (from, to, most) in [(0, 100, 7), (3, 50, 46), (0, 10, 10), (5, 1000, 2)] {
            let numbers = spread(from, to, most);
            assert_eq!(numbers.len(), most.min(to - from), "{from}..{to} in {most}");
            assert_eq!((numbers[0], numbers[numbers.len() - 1]), (from, to - 1));
            assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]), "{numbers:?}");
        }
        assert_eq!(spread(0, 5, 9), [0, 1, 2, 3, 4]);
        assert_eq!((spread(0, 5, 1), spread(0, 5, 0), spread(4, 4, 3)), (vec![4], vec![], vec![]));
    }

    fn run(rows: u64) -> Vec<Sample> {
        (0..rows).map(|step| Sample { step, stress: step as f64, ..Sample::default() }).collect()
    }

    fn broken_at(step: u64) -> Rupture {
        Rupture { order: 1, step, first_of_wire: true, ..Rupture::default() }
    }

    #[test]
    fn states_are_dense_after_the_first_rupture_and_name_what_people_look_for() {
        let steps: Vec<u64> = (0..400).map(|i| 10 * i).collect();
        let mut samples = run(4000);
        samples[3456].stress = 1e9;
        let chosen = states(&samples, &[broken_at(3001)], &steps, true);
        assert!(chosen.len() <= MOST_STATES, "{}", chosen.len());
        let at = |label: &str| chosen.iter().find(|c| c.label == Some(label)).map(|c| c.number);
        assert_eq!(at("start"), Some(0));
        assert_eq!(at("before the first rupture"), Some(300));
        assert_eq!(at("first rupture"), Some(301));
        assert_eq!(at("nearest to the peak"), Some(346));
        assert_eq!(at("last"), Some(399));
        assert!(chosen.iter().filter(|c| c.number > 300).count() >= AFTER_RUPTURE);
    }

    #[test]
    fn a_short_run_is_shown_whole() {
        let steps: Vec<u64> = (0..40).collect();
        for ruptures in [vec![], vec![broken_at(0)], vec![broken_at(39)], vec![broken_at(12)]] {
            assert_eq!(states(&run(40), &ruptures, &steps, true).len(), 40);
        }
        assert_eq!(states(&run(40), &[], &[], true), []);
    }

    #[test]
    fn rows_are_bounded_and_keep_the_peak() {
        let mut samples = run(5000);
        samples[2345].stress = 1e9;
        for step in [None, Some(0), Some(4000), Some(9999)] {
            let chosen = rows(&samples, step, 500);
            assert!((490..=501).contains(&chosen.len()), "{} for {step:?}", chosen.len());
            assert!(chosen.iter().any(|row| row.step == 2345), "{step:?}");
            assert_eq!((chosen[0].step, chosen[chosen.len() - 1].step), (0, 4999), "{step:?}");
        }
    }
}
