//! Tick values at round numbers.

/// Ticks of an axis: values and how many decimals their labels need.
#[derive(Debug, Clone, PartialEq)]
pub struct Ticks {
    /// Tick values, ascending, in the axis' unit.
    pub values: Vec<f64>,
    /// Decimals of the labels (-).
    pub decimals: usize,
    /// Distance between ticks, in the axis' unit.
    pub step: f64,
}

/// Ticks in `[low, high]` at multiples of 1, 2 or 5 times a power of ten, about `count` of them.
///
/// An empty or non-finite range gives one tick at `low`.
pub fn ticks(low: f64, high: f64, count: usize) -> Ticks {
    let span = high - low;
    if !span.is_finite() || span <= 0.0 {
        return Ticks { values: vec![low], decimals: 0, step: 1.0 };
    }
    let step = round_step(span / count.max(1) as f64);
    // A ten-thousandth of a step keeps a tick that rounding put just outside.
    let first = (low / step - 1e-4).ceil() as i64;
    let last = (high / step + 1e-4).floor() as i64;
    let values = (first..=last).map(|k| k as f64 * step).collect();
    let decimals = (-step.log10() + 1e-9).ceil().max(0.0) as usize;
    Ticks { values, decimals, step }
}

/// The smallest of 1, 2, 5 × 10^k that is not below `raw`.
pub fn round_step(raw: f64) -> f64 {
    let power = 10f64.powf(raw.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0];
    let factor = steps.into_iter().find(|s| s * power >= raw * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

/// `value` with `decimals` decimals and a real minus sign; never "−0".
pub fn label(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let zero = text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.'));
    match text.strip_prefix('-') {
        Some(rest) if zero => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside_the_range() {
        let t = ticks(0.0, 420.0, 5);
        assert_eq!(t.values, vec![0.0, 100.0, 200.0, 300.0, 400.0]);
        assert_eq!(t.decimals, 0);
        let t = ticks(-0.31, 0.29, 4);
        assert_eq!(t.step, 0.2);
        assert_eq!(t.decimals, 1);
        assert!(t.values.iter().all(|v| (-0.31..=0.29).contains(v)));
    }

    #[test]
    fn labels_carry_a_minus_sign_but_no_negative_zero() {
        assert_eq!(label(-12.5, 1), "−12.5");
        assert_eq!(label(-0.001, 1), "0.0");
        assert_eq!(label(3.0, 0), "3");
    }

    #[test]
    fn an_empty_range_has_one_tick() {
        assert_eq!(ticks(2.0, 2.0, 5).values, vec![2.0]);
    }
}
