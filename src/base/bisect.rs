//! Bisection.

/// Where `before` turns from true to false between `low`, at which it holds, and `high`, at which it does not: two numbers
/// around that place, apart by at most `tolerance` times the greater (-), or neighbours when that is 0.
pub fn bisect(low: f64, high: f64, tolerance: f64, before: impl Fn(f64) -> bool) -> [f64; 2] {
    let (mut low, mut high) = (low, high);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if high - low <= tolerance * high || middle <= low || middle >= high {
            break;
        }
        if before(middle) { low = middle } else { high = middle }
    }
    [low, high]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_is_found_to_the_last_bit_or_to_a_tolerance() {
        let [low, high] = bisect(1.0, 2.0, 0.0, |x| x * x < 2.0);
        assert!(low <= 2.0f64.sqrt() && 2.0f64.sqrt() <= high && high == low.next_up());
        let [low, high] = bisect(1.0, 2.0, 1e-3, |x| x * x < 2.0);
        assert!(low < 2.0f64.sqrt() && 2.0f64.sqrt() < high && high - low > 1e-4);
        assert_eq!(bisect(0.0, 1.0, 0.0, |_| false)[0], 0.0);
    }
}
