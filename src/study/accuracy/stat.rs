//! Mean over seeds, and how sure it is.

use serde::Serialize;

/// A number over several seeds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Stat {
    /// Mean.
    pub mean: f64,
    /// Standard error of the mean; `None` for one seed.
    pub standard_error: Option<f64>,
    /// Half the width of the interval that holds the mean with 95 % confidence (Student's t); `None` for one seed.
    pub interval_95: Option<f64>,
    /// Seeds.
    pub count: usize,
}

/// Student's t for a two-sided interval of 95 %, by degrees of freedom from 1.
const T_95: [f64; 15] =
    [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131];
/// The same for more, a little too wide.
const T_95_BEYOND: f64 = 2.13;

impl Stat {
    /// Of values; `None` when there is none.
    pub fn of(values: &[f64]) -> Option<Self> {
        let n = values.len();
        if n == 0 {
            return None;
        }
        let mean = values.iter().sum::<f64>() / n as f64;
        let variance = || values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1) as f64;
        let standard_error = (n > 1).then(|| (variance() / n as f64).sqrt());
        let t = T_95.get(n.saturating_sub(2)).copied().unwrap_or(T_95_BEYOND);
        Some(Self { mean, standard_error, interval_95: standard_error.map(|error| t * error), count: n })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_interval_of_three() {
        let stat = Stat::of(&[1.0, 2.0, 3.0]).unwrap();
        assert_eq!((stat.mean, stat.count), (2.0, 3));
        assert!((stat.standard_error.unwrap() - 1.0 / 3f64.sqrt()).abs() < 1e-12);
        assert!((stat.interval_95.unwrap() - 4.303 / 3f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn one_value_has_no_interval_and_none_no_mean() {
        assert_eq!(Stat::of(&[4.0]).unwrap().interval_95, None);
        assert_eq!(Stat::of(&[]), None);
    }
}
