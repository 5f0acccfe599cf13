//! What became of an invariant, with its numbers.

/// Whether an invariant holds.
#[derive(Debug, Clone, PartialEq)]
pub enum InvariantOutcome {
    /// It holds for everything that was looked at.
    Passed(Deviation),
    /// It does not.
    Failed(Deviation),
    /// The run has nothing that it speaks of; why.
    NotApplicable(String),
}

/// What was looked at.
#[derive(Debug, Clone, PartialEq)]
pub struct Deviation {
    /// How many values.
    pub values: usize,
    /// The one that is furthest off, in `unit`; NaN when one is not a number.
    pub worst: f64,
    /// How far off it may be, in `unit`.
    pub allowed: f64,
    /// Unit; "-" for none.
    pub unit: &'static str,
    /// Where the furthest is, with the two values.
    pub place: String,
}

/// Looks for the value that is furthest off.
#[derive(Debug, Clone)]
pub struct Search {
    values: usize,
    worst: f64,
    place: String,
}

impl Search {
    /// Nothing seen yet.
    pub fn new() -> Self {
        Self { values: 0, worst: f64::NEG_INFINITY, place: String::new() }
    }

    /// A value that is `off` by so much; `place` says which.
    pub fn add(&mut self, off: f64, place: impl FnOnce() -> String) {
        self.values += 1;
        // Not `>`, which a NaN never is; the first NaN stays.
        if !self.worst.is_nan() && (off.is_nan() || off > self.worst) {
            self.worst = off;
            self.place = place();
        }
    }

    /// `found` against `right`, over `scale`.
    pub fn compare(&mut self, found: f64, right: f64, scale: f64, place: impl FnOnce() -> String) {
        let off = if found == right { 0.0 } else { (found - right).abs() / scale };
        self.add(off, || format!("{}: {found:.9} against {right:.9}", place()));
    }

    /// `found` in a table, which has nine digits, against `right`; 0 when every digit agrees.
    pub fn digits(&mut self, found: f64, right: f64, place: impl FnOnce() -> String) {
        let rounded = format!("{right:.8e}").parse().unwrap_or(f64::NAN);
        // Counts are written in full.
        let off = if found == rounded || found == right { 0.0 } else { (found - right).abs() / right.abs() };
        self.add(off, || format!("{}: {found:.9} against {right:.9}", place()));
    }

    /// Two that must be the same; counts as 1 when they are not.
    pub fn same<T: PartialEq + std::fmt::Display>(&mut self, found: T, right: T, place: impl FnOnce() -> String) {
        let off = if found == right { 0.0 } else { 1.0 };
        self.add(off, || format!("{}: {found} against {right}", place()));
    }

    /// Whether nothing is off at all.
    pub fn holds(&self) -> bool {
        self.worst <= 0.0
    }

    /// Passed when nothing is further off than `allowed`, in `unit`; not applicable, for the reason `nothing`, when nothing
    /// was seen.
    pub fn end(self, allowed: f64, unit: &'static str, nothing: &str) -> InvariantOutcome {
        if self.values == 0 {
            return InvariantOutcome::NotApplicable(nothing.into());
        }
        let holds = self.worst <= allowed;
        let seen = Deviation { values: self.values, worst: self.worst, allowed, unit, place: self.place };
        if holds { InvariantOutcome::Passed(seen) } else { InvariantOutcome::Failed(seen) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end(values: &[f64]) -> InvariantOutcome {
        let mut search = Search::new();
        values.iter().for_each(|v| search.add(*v, || format!("at {v}")));
        search.end(1.0, "-", "nothing")
    }

    #[test]
    fn the_furthest_decides_and_a_nan_is_furthest() {
        assert!(matches!(end(&[0.5, 1.0, 0.2]), InvariantOutcome::Passed(Deviation { values: 3, .. })));
        let InvariantOutcome::Failed(seen) = end(&[0.5, 1.5, 0.2]) else { panic!() };
        assert_eq!((seen.worst, seen.place.as_str()), (1.5, "at 1.5"));
        let InvariantOutcome::Failed(seen) = end(&[0.5, f64::NAN, 7.0]) else { panic!() };
        assert!(seen.worst.is_nan() && seen.place == "at NaN");
        assert_eq!(end(&[]), InvariantOutcome::NotApplicable("nothing".into()));
    }

    #[test]
    fn equal_infinities_and_zeros_need_no_scale() {
        let mut search = Search::new();
        search.compare(0.0, 0.0, 0.0, String::new);
        assert!(matches!(search.end(0.0, "-", ""), InvariantOutcome::Passed(_)));
        let mut search = Search::new();
        search.compare(f64::NAN, 1.0, 1.0, String::new);
        assert!(matches!(search.end(1.0, "-", ""), InvariantOutcome::Failed(_)));
    }
}
