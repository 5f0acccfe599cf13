//! Exact critical steps of the central-difference (leapfrog) scheme on uniform chains of equal springs.
//!
//! The scheme is stable up to Δt = 2/ω_max (Belytschko, Liu & Moran, *Nonlinear Finite Elements*, section 6.2);
//! the frequencies are those of the linear chain (Brillouin, *Wave Propagation in Periodic Structures*, chapter 2).

use std::f64::consts::PI;

/// A chain of equal springs and masses; what its ends are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// `masses` moving masses between two walls: masses + 1 springs.
    FixedFixed,
    /// A wall at one end: as many springs as masses, all masses equal.
    FixedFree,
    /// No wall, all masses equal: masses − 1 springs.
    FreeFree,
    /// No wall, the two end masses are half the others: a uniform bar lumped at its nodes.
    FreeFreeHalf,
    /// A wall at one end and half a mass at the free end: a clamped uniform bar lumped at its nodes.
    FixedFreeHalf,
}

/// Greatest angular frequency (rad/s) of a chain of `masses` ≥ 1 moving masses of `mass` (kg) (≥ 2 for a chain
/// without a wall) and springs of `stiffness` (N/m).
///
/// ω = 2 √(k/m) sin(q/2) with the greatest admissible phase q per spring.
pub fn greatest_frequency(ends: Ends, masses: usize, stiffness: f64, mass: f64) -> f64 {
    let n = masses as f64;
    let phase = match ends {
        Ends::FixedFixed => n * PI / (n + 1.0),
        Ends::FixedFree => (2.0 * n - 1.0) * PI / (2.0 * n + 1.0),
        Ends::FreeFree => (n - 1.0) * PI / n,
        Ends::FreeFreeHalf => PI,
        Ends::FixedFreeHalf => (2.0 * n - 1.0) * PI / (2.0 * n),
    };
    2.0 * (stiffness / mass).sqrt() * (0.5 * phase).sin()
}

/// Critical step 2/ω_max (s); see [`greatest_frequency`].
pub fn critical_step(ends: Ends, masses: usize, stiffness: f64, mass: f64) -> f64 {
    2.0 / greatest_frequency(ends, masses, stiffness, mass)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Ends; 5] = [Ends::FixedFixed, Ends::FixedFree, Ends::FreeFree, Ends::FreeFreeHalf, Ends::FixedFreeHalf];

    /// Accelerations of a chain of unit springs and masses at displacements `u`.
    fn accelerations(ends: Ends, u: &[f64]) -> Vec<f64> {
        let n = u.len();
        let wall_left = !matches!(ends, Ends::FreeFree | Ends::FreeFreeHalf);
        let wall_right = matches!(ends, Ends::FixedFixed);
        (0..n)
            .map(|i| {
                let mut force = 0.0;
                if i > 0 {
                    force += u[i - 1] - u[i];
                } else if wall_left {
                    force -= u[i];
                }
                if i + 1 < n {
                    force += u[i + 1] - u[i];
                } else if wall_right {
                    force -= u[i];
                }
                let half = match ends {
                    Ends::FreeFreeHalf => i == 0 || i + 1 == n,
                    Ends::FixedFreeHalf => i + 1 == n,
                    _ => false,
                };
                force / if half { 0.5 } else { 1.0 }
            })
            .collect()
    }

    /// Power iteration on the chain's own equations of motion finds the same greatest frequency.
    #[test]
    fn closed_forms_are_the_greatest_eigenvalues() {
        for ends in ALL {
            for n in [2, 3, 7, 12] {
                let mut u: Vec<f64> = (0..n).map(|i| (1.0 + 0.1 * i as f64) * [1.0, -1.0][i % 2]).collect();
                let mut eigenvalue = 0.0;
                for _ in 0..20_000 {
                    let a = accelerations(ends, &u);
                    let norm = a.iter().map(|x| x * x).sum::<f64>().sqrt();
                    eigenvalue = norm / u.iter().map(|x| x * x).sum::<f64>().sqrt();
                    u = a.iter().map(|x| x / norm).collect();
                }
                let expected = greatest_frequency(ends, n, 1.0, 1.0);
                assert!(
                    (eigenvalue.sqrt() / expected - 1.0).abs() < 1e-9,
                    "{ends:?} {n}: {} {expected}",
                    eigenvalue.sqrt()
                );
            }
        }
    }

    /// √(m/k) of an endless chain.
    #[test]
    fn long_chains_approach_the_limit_from_above() {
        let limit = 0.5e-6;
        for ends in ALL {
            let step = critical_step(ends, 1000, 4e6, 1e-6);
            assert!(step >= limit * (1.0 - 1e-12) && step < limit * 1.00001);
        }
    }
}
