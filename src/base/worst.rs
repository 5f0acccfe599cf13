//! Findings at their worst: what grows worse is told when it is first found, and kept as it was when it was worst.

use super::finding::{FindingKind, Notice};
use std::collections::BTreeMap;

/// The findings of a run, each kind at its worst: the first of a kind is to be told at once, the worst at the end.
#[derive(Debug, Clone, Default)]
pub struct Worst {
    /// How bad it is, whether it was told, and what.
    made: BTreeMap<FindingKind, (f64, bool, Notice)>,
}

impl Worst {
    /// Whether a finding of this kind and measure is worse than what is known; of what cannot get worse, the measure is 0.
    pub fn tops(&self, kind: FindingKind, measure: f64) -> bool {
        self.made.get(&kind).is_none_or(|(known, ..)| measure > *known)
    }

    /// Takes in the worst of its kind so far, and gives it back if it is the first.
    pub fn put(&mut self, measure: f64, notice: Notice) -> Option<Notice> {
        let before = self.made.insert(notice.finding.kind(), (measure, false, notice.clone()));
        before.is_none().then(|| {
            self.made.entry(notice.finding.kind()).and_modify(|made| made.1 = true);
            notice
        })
    }

    /// Those that have become worse since they were told.
    pub fn take_worse(&mut self) -> Vec<Notice> {
        let untold = self.made.values_mut().filter(|made| !made.1);
        let told = untold.map(|made| {
            made.1 = true;
            made.2.clone()
        });
        told.collect()
    }
}

/// Adds a notice to a list, in the place of an earlier one of its kind.
pub fn renew(notices: &mut Vec<Notice>, notice: &Notice) {
    notices.retain(|earlier| earlier.finding.kind() != notice.finding.kind());
    notices.push(notice.clone());
}

#[cfg(test)]
mod tests {
    use super::super::finding::{Finding, Instant};
    use super::*;

    #[test]
    fn the_first_of_a_kind_is_told_at_once_and_the_worst_at_the_end() {
        let notice = |step, share| {
            let at = Instant { step, time: 0.0, strain: None };
            Notice { at, finding: Finding::LedgerOpen { missing_j: 1.0, over_work: share } }
        };
        let mut worst = Worst::default();
        assert_eq!(worst.put(0.02, notice(1, 0.02)), Some(notice(1, 0.02)));
        assert!(worst.tops(FindingKind::LedgerOpen, 0.1) && !worst.tops(FindingKind::LedgerOpen, 0.01));
        assert_eq!(worst.put(0.1, notice(2, 0.1)), None);
        assert_eq!(worst.take_worse(), [notice(2, 0.1)]);
        assert_eq!(worst.take_worse(), []);
        let mut list = vec![notice(1, 0.02)];
        renew(&mut list, &notice(2, 0.1));
        assert_eq!(list, [notice(2, 0.1)]);
    }
}
