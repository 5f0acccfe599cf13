//! The virgin curve of a contact with partial slip (Mindlin 1949), its inverse and its energy.

use glam::DVec3;

/// The virgin curve φ for one normal load. All formulas are written in 1 − θ, which keeps small pulls exact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Curve {
    /// m = μ F_n (N).
    pub cap: f64,
    /// δ_c = 3m/(2k_t) (m).
    pub reach: f64,
}

impl Curve {
    #[inline(always)]
    pub fn new(cap: f64, stiffness: f64) -> Self {
        Curve { cap, reach: 1.5 * cap / stiffness }
    }

    /// φ(δ) (N): m (1 − θ³) with θ² = 1 − δ/δ_c; m beyond δ_c.
    #[inline(always)]
    pub fn force(&self, displacement: f64) -> f64 {
        let part = (displacement / self.reach).min(1.0);
        let theta = (1.0 - part).sqrt();
        self.cap * part * (1.0 + theta + theta * theta) / (1.0 + theta)
    }

    /// θ and 1 − θ at a force up to m.
    #[inline(always)]
    pub fn theta(&self, force: f64) -> (f64, f64) {
        let part = (force / self.cap).min(1.0);
        let theta = (1.0 - part).cbrt();
        (theta, part / (1.0 + theta + theta * theta))
    }

    /// e(F) (m): δ_c (1 − θ²).
    #[inline(always)]
    pub fn displacement(&self, force: f64) -> f64 {
        let (theta, rest) = self.theta(force);
        self.reach * rest * (1.0 + theta)
    }

    /// C(F) = ∫ e dF (J): m δ_c (2/5 − θ³ + 3θ⁵/5), expanded in 1 − θ.
    #[inline(always)]
    pub fn stored(&self, force: f64) -> f64 {
        let (_, t) = self.theta(force);
        self.cap * self.reach * t * t * (3.0 - 5.0 * t + 3.0 * t * t - 0.6 * t * t * t)
    }

    /// Displacement vector e(|F|) F̂ of a pull (m).
    #[inline(always)]
    pub fn displacement_of(&self, pull: DVec3) -> DVec3 {
        let length = pull.length();
        if length > 0.0 { pull * (self.displacement(length) / length) } else { DVec3::ZERO }
    }

    /// Pull φ(|e|) ê of a displacement vector (N).
    #[inline(always)]
    pub fn force_of(&self, displacement: DVec3) -> DVec3 {
        let length = displacement.length();
        if length > 0.0 { displacement * (self.force(length) / length) } else { DVec3::ZERO }
    }

    /// Change of the stored energy along a Masing branch that begins at the pull `from`, up to the pull `to`:
    /// (F_from + F_to)·q̂ e(|q|) with q = (F_to − F_from)/2 (J).
    #[inline(always)]
    pub fn masing_energy(&self, from: DVec3, to: DVec3) -> f64 {
        (from + to).dot(self.displacement_of(0.5 * (to - from)))
    }
}
