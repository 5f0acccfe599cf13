//! Rows where bonds scatter: whether an error of the mean, or a change of the spread, is told from what scatter leaves open.
//!
//! Every row is run with the same seeds as the scene as it stands, so that runs are compared in pairs. The spread is
//! compared by Pitman's and Morgan's test of equal variances in pairs: x + y and x − y are uncorrelated where x and y vary
//! alike (Pitman, Biometrika 31 (1939) 9; Morgan, ibid. 13).

use super::errors::Errors;
use super::rows::Row;
use crate::study::statistics::{Statistics, t_95};
use crate::study::tensile::TensileResult;
use serde::Serialize;

/// A quantity that is judged over seeds.
pub struct Quantity {
    /// Its name in tables and files.
    pub name: &'static str,
    of: fn(&TensileResult) -> f64,
    /// Error against the reference (%).
    error: fn(&Errors) -> f64,
}

/// Strength (MPa) and elongation (%), in the order of every pair.
pub const QUANTITIES: [Quantity; 2] = [
    Quantity { name: "strength", of: |run| run.strength_mpa, error: |errors| errors.strength_percent },
    Quantity { name: "elongation", of: |run| run.elongation_percent, error: |errors| errors.elongation_percent },
];

/// Whether the error of a row's mean is told from scatter: zero lies outside its 95 % interval. `None` with fewer than two
/// seeds, of which nothing can be told, and where there is no error at all.
pub fn mean_is_told(row: &Row, quantity: &Quantity) -> Option<bool> {
    let error = row.of_errors(|errors| Some((quantity.error)(errors)))?;
    let half = error.interval_95?;
    (error.mean != 0.0 || half != 0.0).then(|| error.mean.abs() > half)
}

/// How the spread over seeds changes against the scene as it stands.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// Standard deviation over its mean (%).
    pub percent: f64,
    /// Change of the standard deviation over that of the same seeds at the scene as it stands (%).
    pub change_percent: Option<f64>,
    /// Whether that is told from chance (95 %); `None` with fewer than three pairs, or where nothing changed.
    pub told: Option<bool>,
}

/// The spread of a row beside that of `base`, the scene as it stands. `None` with fewer than two seeds.
pub fn spread(row: &Row, base: &Row, quantity: &Quantity) -> Option<Spread> {
    let stat = row.of_runs(|run| Some((quantity.of)(run)))?;
    let percent = 100.0 * stat.standard_deviation? / stat.mean;
    let pairs: Vec<[f64; 2]> = row.runs.iter().filter_map(|run| pair(run.seed, row, base, quantity)).collect();
    let deviation =
        |k: usize| Statistics::of(&pairs.iter().map(|pair| pair[k]).collect::<Vec<_>>())?.standard_deviation;
    let change_percent =
        deviation(0).zip(deviation(1)).filter(|(_, own)| *own > 0.0).map(|(a, b)| 100.0 * (a / b - 1.0));
    Some(Spread { percent, change_percent, told: variances_differ(&pairs) })
}

/// The run of a seed in a row, and in the scene as it stands.
fn pair(seed: u64, row: &Row, base: &Row, quantity: &Quantity) -> Option<[f64; 2]> {
    let of = |row: &Row| {
        let run = row.runs.iter().find(|run| run.seed == seed)?;
        Some((quantity.of)(&run.ran()?.result))
    };
    Some([of(row)?, of(base)?])
}

/// Whether the two members of pairs vary by different amounts (Pitman and Morgan, 95 %); `None` with fewer than three
/// pairs, or where the members are equal.
fn variances_differ(pairs: &[[f64; 2]]) -> Option<bool> {
    let n = pairs.len();
    if n < 3 {
        return None;
    }
    let mean = |of: &dyn Fn(&[f64; 2]) -> f64| pairs.iter().map(of).sum::<f64>() / n as f64;
    let (sum, difference) = (|pair: &[f64; 2]| pair[0] + pair[1], |pair: &[f64; 2]| pair[0] - pair[1]);
    let (s, d) = (mean(&sum), mean(&difference));
    let covariance = mean(&|pair| (sum(pair) - s) * (difference(pair) - d));
    let squares = mean(&|pair| (sum(pair) - s).powi(2)) * mean(&|pair| (difference(pair) - d).powi(2));
    if squares == 0.0 {
        return None;
    }
    let r = covariance / squares.sqrt();
    let t = r.abs() * ((n - 2) as f64).sqrt() / (1.0 - r * r).max(f64::MIN_POSITIVE).sqrt();
    Some(t > t_95(n - 2))
}

/// What scatter leaves open of a row, in a few words; empty when there is nothing. `seeds` were asked for.
pub fn note(row: &Row, seeds: usize) -> String {
    if row.ran().count() == 0 {
        return String::new();
    }
    if seeds == 1 {
        return match row.parameter {
            None => String::new(),
            Some(_) => "one draw: not told from scatter".into(),
        };
    }
    let open = QUANTITIES.iter().filter(|quantity| mean_is_told(row, quantity) == Some(false));
    match &open.map(|quantity| quantity.name).collect::<Vec<_>>()[..] {
        [] if row.ran().count() == 1 => "one seed only: not told from scatter".into(),
        [] => String::new(),
        open => format!("not told from scatter: {}", open.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::super::rows::{Compared, Run, RunStatus};
    use super::*;

    fn row(strengths: &[f64], errors: &[f64]) -> Row {
        let run = |(k, (strength, error)): (usize, (&f64, &f64))| Run {
            seed: k as u64,
            outcome: RunStatus::Ran(Compared {
                result: Box::new(TensileResult { strength_mpa: *strength, ..TensileResult::default() }),
                errors: Some(Errors { strength_percent: *error, ..Errors::default() }),
            }),
        };
        Row { parameter: None, value: String::new(), runs: strengths.iter().zip(errors).enumerate().map(run).collect() }
    }

    #[test]
    fn an_error_within_its_interval_is_not_told_from_scatter() {
        let told = |errors: &[f64]| mean_is_told(&row(&[300.0; 4][..errors.len()], errors), &QUANTITIES[0]);
        assert_eq!(told(&[1.0, 1.1, 0.9, 1.0]), Some(true));
        assert_eq!(told(&[1.0, -2.0, 3.0, 0.5]), Some(false));
        assert_eq!(told(&[1.0]), None, "one draw tells nothing");
        assert_eq!(told(&[0.0; 4]), None, "what is the same has no error");
        assert_eq!(note(&row(&[300.0; 4], &[1.0, -2.0, 3.0, 0.5]), 4), "not told from scatter: strength");
    }

    /// Twice the spread about the same mean: told with eight pairs that go together, not with three that do not.
    #[test]
    fn spreads_are_compared_in_pairs() {
        let base = [298.0, 304.0, 301.0, 295.0, 299.5, 303.0, 297.0, 302.5];
        let wide: Vec<f64> = base.iter().enumerate().map(|(k, s)| 300.0 + 2.0 * (s - 300.0) + 0.1 * k as f64).collect();
        let found = spread(&row(&wide, &[0.0; 8]), &row(&base, &[0.0; 8]), &QUANTITIES[0]).unwrap();
        assert!((found.change_percent.unwrap() - 100.0).abs() < 10.0 && found.told == Some(true), "{found:?}");
        let other = row(&[300.0, 305.0, 304.0], &[0.0; 3]);
        let found = spread(&other, &row(&base[..3], &[0.0; 3]), &QUANTITIES[0]).unwrap();
        assert_eq!(found.told, Some(false), "{found:?}");
        let same = spread(&row(&base, &[0.0; 8]), &row(&base, &[0.0; 8]), &QUANTITIES[0]).unwrap();
        assert_eq!((same.told, same.change_percent), (None, Some(0.0)));
    }
}
