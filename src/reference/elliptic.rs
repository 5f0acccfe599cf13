//! Legendre's elliptic integrals by Carlson's duplication.
//!
//! Source: Carlson, Numer. Math. 33 (1979) 1; DLMF 19.25.

/// Incomplete integral of the first kind F(φ, k) = ∫₀^φ dt/√(1 − k² sin²t) (-); `angle` φ in [0, π/2] (rad), `modulus`
/// k in [0, 1] (-).
pub fn first(angle: f64, modulus: f64) -> f64 {
    let (sine, cosine) = angle.sin_cos();
    let rest = 1.0 - (modulus * sine).powi(2);
    sine * carlson_rf(cosine * cosine, rest, 1.0)
}

/// Incomplete integral of the second kind E(φ, k) = ∫₀^φ √(1 − k² sin²t) dt (-); arguments as in [`first`].
pub fn second(angle: f64, modulus: f64) -> f64 {
    let (sine, cosine) = angle.sin_cos();
    let part = (modulus * sine).powi(2);
    let (c2, rest) = (cosine * cosine, 1.0 - part);
    sine * (carlson_rf(c2, rest, 1.0) - part / 3.0 * carlson_rd(c2, rest, 1.0))
}

/// R_F(x, y, z) = ½ ∫₀^∞ dt/√((t + x)(t + y)(t + z)).
fn carlson_rf(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    loop {
        let mean = (x + y + z) / 3.0;
        let off = [x, y, z].map(|v| 1.0 - v / mean);
        if off.iter().all(|d| d.abs() < 1e-3) {
            let e2 = off[0] * off[1] - off[2] * off[2];
            let e3 = off[0] * off[1] * off[2];
            return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / mean.sqrt();
        }
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        (x, y, z) = (0.25 * (x + lambda), 0.25 * (y + lambda), 0.25 * (z + lambda));
    }
}

/// R_D(x, y, z) = (3/2) ∫₀^∞ dt/((t + z) √((t + x)(t + y)(t + z))).
fn carlson_rd(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    let (mut sum, mut factor) = (0.0, 1.0);
    loop {
        let mean = (x + y + 3.0 * z) / 5.0;
        let [dx, dy, dz] = [x, y, z].map(|v| 1.0 - v / mean);
        if dx.abs().max(dy.abs()).max(dz.abs()) < 1e-3 {
            let (ea, eb) = (dx * dy, dz * dz);
            let (ec, ed) = (ea - eb, ea - 6.0 * eb);
            let ee = ed + ec + ec;
            let series = 1.0
                + ed * (-3.0 / 14.0 + 9.0 / 88.0 * ed - 9.0 / 52.0 * dz * ee)
                + dz * (ee / 6.0 + dz * (-9.0 / 22.0 * ec + dz * 3.0 / 26.0 * ea));
            return 3.0 * sum + factor * series / (mean * mean.sqrt());
        }
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        sum += factor / (z.sqrt() * (z + lambda));
        factor *= 0.25;
        (x, y, z) = (0.25 * (x + lambda), 0.25 * (y + lambda), 0.25 * (z + lambda));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn both_agree_with_the_midpoint_rule() {
        for (angle, modulus) in [(0.3, 0.5), (1.2, 0.9), (FRAC_PI_2, 0.7), (FRAC_PI_2, 0.99)] {
            let n = 200_000;
            let step = angle / n as f64;
            let (mut f, mut e) = (0.0, 0.0);
            for i in 0..n {
                let root = (1.0 - (modulus * ((i as f64 + 0.5) * step).sin()).powi(2)).sqrt();
                f += step / root;
                e += step * root;
            }
            assert!((first(angle, modulus) / f - 1.0).abs() < 1e-9, "F({angle}, {modulus})");
            assert!((second(angle, modulus) / e - 1.0).abs() < 1e-9, "E({angle}, {modulus})");
        }
    }

    /// Legendre's relation ties all four complete integrals together.
    #[test]
    fn complete_integrals_satisfy_legendres_relation() {
        for modulus in [0.1f64, 0.6, 0.95] {
            let other = (1.0 - modulus * modulus).sqrt();
            let (k, e) = (first(FRAC_PI_2, modulus), second(FRAC_PI_2, modulus));
            let (k1, e1) = (first(FRAC_PI_2, other), second(FRAC_PI_2, other));
            assert!((e * k1 + e1 * k - k * k1 - FRAC_PI_2).abs() < 1e-12);
        }
    }
}
