//! Exact critical step of the central-difference (leapfrog) scheme on a uniform chain of equal springs.
//!
//! The scheme is stable up to Δt = 2/ω_max (Belytschko, Liu & Moran, *Nonlinear Finite Elements*, section 6.2);
//! the frequencies are those of the linear chain (Brillouin, *Wave Propagation in Periodic Structures*, chapter 2).

use std::f64::consts::PI;

/// Critical step 2/ω_max (s) of `masses` ≥ 1 moving masses of `mass` (kg) between two walls, with masses + 1 springs of
/// `stiffness` (N/m).
///
/// ω_max = 2 √(k/m) sin(q/2) with the greatest admissible phase q per spring, n π/(n + 1).
pub fn critical_step(masses: usize, stiffness: f64, mass: f64) -> f64 {
    let n = masses as f64;
    let phase = n * PI / (n + 1.0);
    2.0 / (2.0 * (stiffness / mass).sqrt() * (0.5 * phase).sin())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Accelerations of a chain of unit springs and masses between walls at displacements `u`.
    fn accelerations(u: &[f64]) -> Vec<f64> {
        let at = |i: Option<usize>| i.and_then(|i| u.get(i)).copied().unwrap_or(0.0);
        (0..u.len()).map(|i| at(i.checked_sub(1)) + at(Some(i + 1)) - 2.0 * u[i]).collect()
    }

    /// Power iteration on the chain's own equations of motion finds the same greatest frequency.
    #[test]
    fn closed_form_is_the_greatest_eigenvalue() {
        for n in [2, 3, 7, 12] {
            let mut u: Vec<f64> = (0..n).map(|i| (1.0 + 0.1 * i as f64) * [1.0, -1.0][i % 2]).collect();
            let mut eigenvalue = 0.0;
            for _ in 0..20_000 {
                let a = accelerations(&u);
                let norm = a.iter().map(|x| x * x).sum::<f64>().sqrt();
                eigenvalue = norm / u.iter().map(|x| x * x).sum::<f64>().sqrt();
                u = a.iter().map(|x| x / norm).collect();
            }
            let step = critical_step(n, 1.0, 1.0);
            assert!((eigenvalue.sqrt() * step / 2.0 - 1.0).abs() < 1e-9, "{n}: {} {step}", eigenvalue.sqrt());
        }
    }

    /// √(m/k) of an endless chain.
    #[test]
    fn a_long_chain_approaches_the_limit_from_above() {
        let (step, limit) = (critical_step(1000, 4e6, 1e-6), 0.5e-6);
        assert!(step >= limit * (1.0 - 1e-12) && step < limit * 1.00001);
    }
}
