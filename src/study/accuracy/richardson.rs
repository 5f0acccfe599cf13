//! Richardson's extrapolation: where a number goes as a step, a speed or a spacing goes to zero, and how sure that is.
//!
//! Source: Richardson, Phil. Trans. R. Soc. A 210 (1911) 307; the uncertainty is Roache's grid convergence index, J.
//! Fluids Eng. 116 (1994) 405, with the observed order for levels of any ratio after Celik et al., J. Fluids Eng. 130
//! (2008) 078001.

/// Orders that are believed (-). Three levels that say anything else are not in the range where one term of the error
/// rules.
const ORDERS: [f64; 2] = [0.5, 4.0];
/// Safety factors of the grid convergence index (-): with an order that was observed, and with one that is assumed.
const OBSERVED: f64 = 1.25;
const ASSUMED: f64 = 3.0;

/// The limit of a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Where it goes.
    pub value: f64,
    /// Half the width of the interval that holds the limit with some confidence.
    pub uncertainty: f64,
    /// The order of convergence that three levels show (-); `None` when they show none, and then `value` is that of the
    /// finest level.
    pub order: Option<f64>,
    /// Of the two finest levels, how far to go on from the second through the first (-).
    pub weight: f64,
}

/// The limit for h → 0 of (h, value) at distinct h > 0, in any order. `None` with fewer than two levels.
pub fn limit(points: &[[f64; 2]]) -> Option<Limit> {
    let mut levels = points.to_vec();
    levels.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let [fine, next, rest @ ..] = &levels[..] else { return None };
    let order = rest.first().and_then(|coarse| observed_order([*fine, *next, *coarse]));
    let step = fine[1] - next[1];
    let Some(order) = order else {
        let spread = rest.first().map_or(0.0, |coarse| (next[1] - coarse[1]).abs());
        let (value, weight) = (fine[1], 0.0);
        let uncertainty = match rest.is_empty() {
            // First order, the least that any part of the engine has.
            true => ASSUMED * step.abs() * weight_of(fine[0], next[0], 1.0),
            // The levels scatter: no part of that says which way the limit lies.
            false => step.abs().max(spread),
        };
        return Some(Limit { value, uncertainty, order: None, weight });
    };
    let weight = weight_of(fine[0], next[0], order);
    let correction = weight * step;
    Some(Limit { value: fine[1] + correction, uncertainty: OBSERVED * correction.abs(), order: Some(order), weight })
}

/// Share of the difference of two levels that the finer one still lacks: 1/((h₂/h₁)^p − 1) (-).
fn weight_of(fine: f64, next: f64, order: f64) -> f64 {
    1.0 / ((next / fine).powf(order) - 1.0)
}

/// The order p for which q = q₀ + C h^p runs through three levels, from fine to coarse; `None` when there is none
/// within [`ORDERS`].
fn observed_order([fine, next, coarse]: [[f64; 2]; 3]) -> Option<f64> {
    let ratio = (coarse[1] - next[1]) / (next[1] - fine[1]);
    let excess = |p: f64| {
        let power = |level: [f64; 2]| (level[0] / fine[0]).powf(p);
        (power(coarse) - power(next)) / (power(next) - 1.0) - ratio
    };
    // The ratio of the differences grows with p.
    let [mut low, mut high] = ORDERS;
    if !ratio.is_finite() || excess(low) > 0.0 || excess(high) < 0.0 {
        return None;
    }
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 { high = middle } else { low = middle }
    }
    Some(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(levels: &[f64], limit: f64, order: f64) -> Vec<[f64; 2]> {
        levels.iter().map(|h| [*h, limit + 3.0 * h.powf(order)]).collect()
    }

    #[test]
    fn a_series_of_known_order_gives_its_exact_limit() {
        for order in [1.0, 1.5, 2.0] {
            for levels in [[0.2, 0.4, 0.8], [0.8, 0.3, 0.5], [0.1, 0.2, 1.0]] {
                let found = limit(&series(&levels, 311.0, order)).unwrap();
                assert!((found.value - 311.0).abs() < 1e-9, "{found:?}");
                assert!((found.order.unwrap() - order).abs() < 1e-9, "{found:?}");
            }
        }
    }

    #[test]
    fn only_the_three_finest_levels_count() {
        let mut points = series(&[0.1, 0.2, 0.4], 5.0, 2.0);
        points.push([3.2, 1e6]);
        assert!((limit(&points).unwrap().value - 5.0).abs() < 1e-9);
    }

    #[test]
    fn the_interval_holds_a_limit_with_a_second_term() {
        let value = |h: f64| 10.0 + 2.0 * h + 0.5 * h * h;
        let found = limit(&[0.25, 0.5, 1.0].map(|h| [h, value(h)])).unwrap();
        assert!((found.value - 10.0).abs() < found.uncertainty, "{found:?}");
        assert!((found.value - 10.0).abs() < 0.2 * (value(0.25) - 10.0), "{found:?}");
    }

    #[test]
    fn levels_that_scatter_are_not_extrapolated() {
        let found = limit(&[[0.25, 10.1], [0.5, 9.9], [1.0, 10.2]]).unwrap();
        assert_eq!((found.value, found.order), (10.1, None));
        assert!((found.uncertainty - 0.3).abs() < 1e-12);
    }

    #[test]
    fn two_levels_give_no_order_and_a_wide_interval() {
        let found = limit(&[[0.5, 10.0], [1.0, 11.0]]).unwrap();
        assert_eq!((found.value, found.order, found.uncertainty), (10.0, None, 3.0));
        assert_eq!(limit(&[[0.5, 10.0]]), None);
    }

    #[test]
    fn levels_that_agree_need_no_order() {
        let found = limit(&[[0.25, 7.0], [0.5, 7.0], [1.0, 7.0]]).unwrap();
        assert_eq!((found.value, found.uncertainty), (7.0, 0.0));
    }
}
