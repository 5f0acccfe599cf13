//! Mean over seeds, and how sure it is.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// A number over several seeds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Statistics {
    /// Arithmetic mean, in the unit of the number.
    pub mean: f64,
    /// Standard deviation from seed to seed; `None` for one seed.
    pub standard_deviation: Option<f64>,
    /// Standard error of the mean; `None` for one seed.
    pub standard_error: Option<f64>,
    /// Half the width of the interval that holds the mean with 95 % confidence (Student's t); `None` for one seed.
    pub interval_95: Option<f64>,
    /// How many seeds the mean is over.
    pub count: usize,
}

impl Statistics {
    /// Of values; `None` when there is none.
    pub fn of(values: &[f64]) -> Option<Self> {
        let n = values.len();
        if n == 0 {
            return None;
        }
        let mean = values.iter().sum::<f64>() / n as f64;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let standard_deviation = (n > 1).then(|| (squares / (n - 1) as f64).sqrt());
        let standard_error = standard_deviation.map(|deviation| deviation / (n as f64).sqrt());
        let interval_95 = standard_error.map(|error| t_95(n - 1) * error);
        Some(Self { mean, standard_deviation, standard_error, interval_95, count: n })
    }

    /// Mean ± half the 95 % interval; the mean alone with one seed.
    pub fn with_interval(&self, decimals: usize) -> String {
        let half = self.interval_95.map_or(String::new(), |half| format!(" ± {half:.decimals$}"));
        format!("{:.decimals$}{half}", self.mean)
    }

    /// As [`Self::with_deviation`]; where the interval leaves what the number can be, its ends are told in place of its half
    /// width, and stop there: `50 (0 to 100)`.
    pub fn within(&self, limits: Option<[f64; 2]>, decimals: usize) -> String {
        match (limits, self.interval_95) {
            (Some([least, most]), Some(half)) if self.mean - half < least || self.mean + half > most => {
                let [low, high] = [(self.mean - half).max(least), (self.mean + half).min(most)];
                format!("{:.decimals$} ({low:.decimals$} to {high:.decimals$})", self.mean)
            }
            _ => self.with_deviation(decimals),
        }
    }

    /// The same, with the standard deviation in brackets.
    pub fn with_deviation(&self, decimals: usize) -> String {
        let deviation = self.standard_deviation.map_or(String::new(), |deviation| format!(" ({deviation:.decimals$})"));
        self.with_interval(decimals) + &deviation
    }
}

/// Student's t for a two-sided interval of 95 % and `freedom` degrees of freedom, at least 1.
pub fn t_95(freedom: usize) -> f64 {
    let t = StudentsT::new(0.0, 1.0, freedom as f64).expect("a positive number of degrees of freedom");
    t.inverse_cdf(0.975)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_interval_of_three() {
        let stat = Statistics::of(&[1.0, 2.0, 3.0]).unwrap();
        assert_eq!((stat.mean, stat.count), (2.0, 3));
        assert!((stat.standard_error.unwrap() - 1.0 / 3f64.sqrt()).abs() < 1e-12);
        assert_eq!(stat.standard_deviation, Some(1.0));
        // 4.303 is what tables of Student's t have for two degrees of freedom.
        assert!((stat.interval_95.unwrap() - 4.303 / 3f64.sqrt()).abs() < 3e-4);
    }

    #[test]
    fn an_interval_ends_where_a_number_must() {
        let two = Statistics::of(&[33.0, 67.0]).unwrap();
        assert_eq!(two.within(Some([0.0, 100.0]), 0), "50 (0 to 100)");
        assert_eq!(two.within(None, 0), "50 ± 216 (24)");
        let many = Statistics::of(&[49.0, 50.0, 51.0, 50.0]).unwrap();
        assert_eq!(many.within(Some([0.0, 100.0]), 0), many.with_deviation(0));
        assert_eq!(
            Statistics::of(&[99.0, 100.0, 100.0, 98.0]).unwrap().within(Some([0.0, 100.0]), 1),
            "99.2 (97.7 to 100.0)"
        );
    }

    #[test]
    fn one_value_has_no_interval_and_none_no_mean() {
        assert_eq!(Statistics::of(&[4.0]).unwrap().interval_95, None);
        assert_eq!(Statistics::of(&[]), None);
    }
}
