//! Randomness indexed by what it belongs to, so that it does not depend on threads or on order.

/// Uniform number in the open interval (0, 1) (-) that belongs to (seed, wire, bond).
///
/// Counter-based: the three indices are hashed with the SplitMix64 finaliser (Steele, Lea & Flood 2014), one round
/// per index, so neighbouring indices give independent values.
pub fn uniform(seed: u64, wire: u64, bond: u64) -> f64 {
    let h = mix(mix(mix(seed).wrapping_add(wire)).wrapping_add(bond));
    // 53 random bits, shifted by half a unit so that neither 0 nor 1 can appear.
    ((h >> 11) as f64 + 0.5) * (1.0 / (1u64 << 53) as f64)
}

fn mix(x: u64) -> u64 {
    let z = x.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_variance_are_those_of_a_uniform_distribution() {
        let n = 20_000;
        let values: Vec<f64> = (0..n).map(|b| uniform(7, 3, b)).collect();
        let mean = values.iter().sum::<f64>() / n as f64;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n as f64;
        assert!((mean - 0.5).abs() < 0.01, "{mean}");
        assert!((variance - 1.0 / 12.0).abs() < 0.002, "{variance}");
    }

    #[test]
    fn every_index_matters() {
        assert_ne!(uniform(1, 0, 0), uniform(0, 1, 0));
        assert_ne!(uniform(0, 1, 0), uniform(0, 0, 1));
        assert_eq!(uniform(5, 6, 7), uniform(5, 6, 7));
    }
}
