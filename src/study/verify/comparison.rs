//! What a case finds: a computed number beside its closed form, and whether the two agree.

use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::iter::Sum;
use std::ops::Add;

/// What simulating took.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Spent {
    /// Steps of all runs behind it.
    pub steps: u64,
    /// Wall time (s).
    pub wall_s: f64,
}

impl Add for Spent {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { steps: self.steps + other.steps, wall_s: self.wall_s + other.wall_s }
    }
}

impl Sum for Spent {
    fn sum<I: Iterator<Item = Self>>(items: I) -> Self {
        items.fold(Self::default(), Add::add)
    }
}

/// One run of a case that is repeated at several resolutions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Spacing, step or load per particle over what it is measured by (-).
    pub resolution: f64,
    /// Relative error, signed (-).
    pub error: f64,
    /// What the run took.
    pub spent: Spent,
}

/// Error over resolution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Convergence {
    /// What the resolution is, such as "a/L".
    pub axis: Cow<'static, str>,
    /// From coarse to fine.
    pub points: Vec<Point>,
}

impl Convergence {
    /// Orders between neighbours, ln(e₁/e₂)/ln(h₁/h₂) (-).
    pub fn orders(&self) -> Vec<f64> {
        let between = |p: &[Point]| (p[0].error / p[1].error).abs().ln() / (p[0].resolution / p[1].resolution).ln();
        self.points.windows(2).map(between).collect()
    }
}

/// Order of convergence.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Order {
    /// The one between neighbouring resolutions that is furthest from theory (-).
    pub observed: f64,
    /// What theory says (-).
    pub theory: f64,
    /// Allowed difference (-).
    pub tolerance: f64,
}

impl Order {
    /// Of the `observed` orders the one furthest from `theory`; NaN when there is none.
    pub fn worst(observed: &[f64], theory: f64, tolerance: f64) -> Self {
        let off = |p: &f64| if p.is_nan() { f64::INFINITY } else { (p - theory).abs() };
        let observed = observed.iter().copied().max_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(f64::NAN);
        Self { observed, theory, tolerance }
    }

    /// Whether observation and theory agree.
    pub fn holds(&self) -> bool {
        (self.observed - self.theory).abs() <= self.tolerance
    }
}

/// Whether a comparison agrees with its closed form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Error and order are within their targets.
    Pass,
    /// One of them is not, or is not a number.
    Miss,
}

impl Verdict {
    /// In a word, for programs.
    pub fn word(self) -> &'static str {
        match self {
            Verdict::Pass => "pass",
            Verdict::Miss => "miss",
        }
    }
}

/// A computed number beside its closed form.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// What was computed.
    pub what: String,
    /// Its unit, SI; "-" for none.
    pub unit: Cow<'static, str>,
    /// The engine's number, in `unit`.
    pub computed: f64,
    /// The closed form's, in `unit`.
    pub exact: f64,
    /// What the error is relative to, in `unit`: |exact| unless that is 0 or says nothing.
    pub scale: f64,
    /// Least and greatest relative error allowed (-). Nothing but 0 until [`Comparison::within`] or
    /// [`Comparison::between`] says more.
    #[serde(with = "limits")]
    pub allowed: [f64; 2],
    /// Order of convergence, where there is one.
    pub order: Option<Order>,
    /// Error over resolution, where it was varied.
    pub convergence: Option<Convergence>,
    /// What the runs behind it took.
    pub spent: Spent,
    /// Where the model itself differs from the closed form: by how much and why.
    pub note: Option<String>,
}

impl Comparison {
    /// `computed` against `exact`, both in `unit`, from runs that took `spent`.
    pub fn new(what: impl Into<String>, unit: &'static str, computed: f64, exact: f64, spent: Spent) -> Self {
        Self {
            what: what.into(),
            unit: unit.into(),
            computed,
            exact,
            scale: exact.abs(),
            allowed: [0.0; 2],
            order: None,
            convergence: None,
            spent,
            note: None,
        }
    }

    /// A number that must reach `least`.
    pub fn at_least(what: impl Into<String>, unit: &'static str, computed: f64, least: f64, spent: Spent) -> Self {
        Self::new(what, unit, computed, least, spent).between(0.0, f64::INFINITY)
    }

    /// Allows a relative error of ±`target` (-).
    pub fn within(self, target: f64) -> Self {
        self.between(-target, target)
    }

    /// Allows relative errors from `low` to `high` (-).
    pub fn between(mut self, low: f64, high: f64) -> Self {
        self.allowed = [low, high];
        self
    }

    /// Measures the error by `scale`, in the finding's unit, where exact is 0 or says nothing.
    pub fn relative_to(mut self, scale: f64) -> Self {
        self.scale = scale;
        self
    }

    /// Asks for an order of convergence of `theory` ± `tolerance` (-) between all neighbours, and counts what the
    /// points took as spent.
    pub fn converging(self, axis: &'static str, points: Vec<Point>, theory: f64, tolerance: f64) -> Self {
        let found = self.over(axis, points);
        let orders = found.convergence.as_ref().map(Convergence::orders).unwrap_or_default();
        Self { order: Some(Order::worst(&orders, theory, tolerance)), ..found }
    }

    /// Shows the error over resolution where theory knows no order, and counts what the points took as spent.
    pub fn over(mut self, axis: &'static str, points: Vec<Point>) -> Self {
        self.spent = points.iter().map(|p| p.spent).sum();
        self.convergence = Some(Convergence { axis: axis.into(), points });
        self
    }

    /// Says where the model itself differs from the closed form.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.note = Some(note.into());
        self
    }

    /// (computed − exact)/scale (-).
    pub fn error(&self) -> f64 {
        (self.computed - self.exact) / self.scale
    }

    /// Pass when error and order are within their targets.
    pub fn verdict(&self) -> Verdict {
        let [low, high] = self.allowed;
        let error = self.error();
        let near = low <= error && error <= high;
        if near && self.order.is_none_or(|order| order.holds()) { Verdict::Pass } else { Verdict::Miss }
    }

    /// Of several comparisons of one kind the one that uses most of what it is allowed, with what all of them took.
    ///
    /// # Panics
    /// When there is none.
    pub fn worst(comparisons: Vec<Comparison>) -> Self {
        let spent = comparisons.iter().map(|f| f.spent).sum();
        let use_of = |f: &Comparison| {
            let [low, high] = f.allowed;
            let off = f.error() - 0.5 * (low + high);
            let used = off.abs() / (0.5 * (high - low));
            if used.is_nan() { f64::INFINITY } else { used }
        };
        let worst = comparisons.into_iter().max_by(|a, b| use_of(a).total_cmp(&use_of(b)));
        Self { spent, ..worst.expect("a case has at least one point") }
    }
}

/// For serde's `with`: limits, of which the lower or the upper one may be infinite, which JSON has no number for.
mod limits {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    const OPEN: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

    pub fn serialize<S: Serializer>(limits: &[f64; 2], serializer: S) -> Result<S::Ok, S::Error> {
        limits.map(|limit| limit.is_finite().then_some(limit)).serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 2], D::Error> {
        let limits = <[Option<f64>; 2]>::deserialize(deserializer)?;
        Ok([0, 1].map(|end| limits[end].unwrap_or(OPEN[end])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(computed: f64, exact: f64) -> Comparison {
        Comparison::new("a length", "m", computed, exact, Spent::default())
    }

    #[test]
    fn outcome_follows_from_the_numbers() {
        assert_eq!(finding(1.004, 1.0).within(5e-3).verdict(), Verdict::Pass);
        assert_eq!(finding(0.994, 1.0).within(5e-3).verdict(), Verdict::Miss);
        assert_eq!(finding(1.01, 1.0).between(-0.2, 0.0).verdict(), Verdict::Miss);
        assert_eq!(finding(f64::NAN, 1.0).within(1.0).verdict(), Verdict::Miss);
        assert_eq!(finding(0.0, 0.0).within(1.0).verdict(), Verdict::Miss, "zero needs a scale");
        assert_eq!(finding(1e-9, 0.0).relative_to(1.0).within(1e-8).verdict(), Verdict::Pass);
        assert_eq!(finding(1.0 + 1e-15, 1.0).verdict(), Verdict::Miss, "nothing is allowed until it is said");
    }

    #[test]
    fn an_order_is_the_one_furthest_from_theory() {
        let point = |resolution: f64, error: f64| Point { resolution, error, spent: Spent { steps: 1, wall_s: 0.5 } };
        let points = vec![point(0.4, -0.16), point(0.2, -0.04), point(0.1, -0.02)];
        let f = finding(0.98, 1.0).within(0.05).converging("a/L", points, 2.0, 0.1);
        assert!((f.order.unwrap().observed - 1.0).abs() < 1e-12);
        assert_eq!(f.spent, Spent { steps: 3, wall_s: 1.5 });
        assert_eq!(f.verdict(), Verdict::Miss);
        assert!(!Order::worst(&[], 2.0, 1.0).holds());
    }

    #[test]
    fn the_worst_finding_uses_most_of_its_allowance() {
        let worst = Comparison::worst(vec![finding(1.1, 1.0).within(0.2), finding(0.99, 1.0).within(0.01)]);
        assert_eq!(worst.computed, 0.99);
        let worst = Comparison::worst(vec![finding(1.0, 1.0).within(0.2), finding(f64::NAN, 1.0).within(0.01)]);
        assert!(worst.computed.is_nan());
    }

    #[test]
    fn a_comparison_that_passes_comes_back_from_json_as_it_is() {
        let point =
            |resolution: f64| Point { resolution, error: -resolution.powi(2), spent: Spent { steps: 1, wall_s: 0.1 } };
        let points = vec![point(0.1 + 0.2), point(0.05)];
        let with_order = finding(1.001, 1.0).within(0.1).converging("a/L", points, 2.0, 0.1).note("why");
        let least = Comparison::at_least("a share", "-", 0.9, 0.8, Spent::default());
        for found in [with_order, least] {
            let text = serde_json::to_string(&found).unwrap();
            assert_eq!(serde_json::from_str::<Comparison>(&text).unwrap(), found, "{text}");
        }
    }
}
