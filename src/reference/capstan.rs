//! Friction of a rope or wire that slides round a fixed body.
//!
//! Source: Euler 1769 (the string); Kirchhoff's rod equations for a wire of finite thickness, see [`Wrapped::rate`].

/// Pull over hold of a string without thickness, T₂/T₁ = e^(μφ) (-) (Euler, Eytelwein), for friction coefficient
/// `friction` μ (-) and turning angle `angle` φ (rad), the curvature times the length of contact.
pub fn string_ratio(friction: f64, angle: f64) -> f64 {
    (friction * angle).exp()
}

/// Pull over hold of a string laid as a polygon whose corners turn by `turns` θ each (rad): (-).
///
/// At a corner N = (T₁ + T₂) sin(θ/2) and (T₂ − T₁) cos(θ/2) = μ N, so T₂/T₁ = (1 + μ tan(θ/2))/(1 − μ tan(θ/2)).
pub fn polygon_ratio(friction: f64, turns: impl IntoIterator<Item = f64>) -> f64 {
    let corner = |turn: f64| {
        let part = friction * (0.5 * turn).tan();
        (1.0 + part) / (1.0 - part)
    };
    turns.into_iter().map(corner).product()
}

/// A round wire on a body, laid in its natural shape of constant curvature (circle or helix).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wrapped {
    /// Friction coefficient μ (-).
    pub friction: f64,
    /// Curvature κ of its axis (1/m).
    pub curvature: f64,
    /// Radius r of the wire (m).
    pub radius: f64,
}

impl Wrapped {
    /// Growth λ of the pull per length, T ~ e^(λs) (1/m).
    ///
    /// Contact pressure q and friction μ q act at the surface, r inside the axis. The wire slides along its own shape,
    /// so its bending moment does not change and the couple μ q r of friction is balanced by a shear force V = −μ q r.
    /// Along the axis T′ = μ q + κ V = μ q (1 − r κ), across it q + μ r q′ = κ T; with all ~ e^(λs):
    /// λ (1 + μ r λ) = μ κ (1 − r κ). It is μ κ for r → 0.
    pub fn rate(&self) -> f64 {
        let drive = self.friction * self.curvature * (1.0 - self.radius * self.curvature);
        let quadratic = self.friction * self.radius;
        // The root 2c/(1 + √(1 + 4ac)) does not cancel for a → 0.
        2.0 * drive / (1.0 + (1.0 + 4.0 * quadratic * drive).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fine_polygon_is_a_string() {
        let (friction, angle) = (0.3, 5.0);
        let error = |n: usize| polygon_ratio(friction, vec![angle / n as f64; n]) / string_ratio(friction, angle) - 1.0;
        assert!((error(50) / error(100) - 4.0).abs() < 0.02);
        assert!(error(1000) > 0.0 && error(1000) < 1e-5);
    }

    #[test]
    fn a_thin_wire_is_a_string() {
        let thin = Wrapped { friction: 0.2, curvature: 250.0, radius: 1e-12 };
        assert!((thin.rate() / 50.0 - 1.0).abs() < 1e-8);
        let thick = Wrapped { radius: 1e-4, ..thin };
        let (l, m) = (thick.rate(), thick.friction * thick.radius);
        assert!((l * (1.0 + m * l) - 50.0 * (1.0 - 0.025)).abs() < 1e-9);
    }
}
