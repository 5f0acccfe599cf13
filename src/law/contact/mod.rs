//! Normal contact laws.
//!
//! | name | equation | source |
//! | --- | --- | --- |
//! | `hertz` | F = 4/3 E* √R* δ^(3/2) | Hertz 1882 |
//! | `thornton` | Hertz to p_y, then F_y + π p_y R* (δ − δ_y); unloading with R_p | Thornton 1997 |
//!
//! Both also hold for smooth wires, as force per length: [`mod@line`].

pub mod constants;
pub mod hertz;
pub mod line;
#[cfg(test)]
mod line_resultants;
pub mod thornton;

use crate::base::lanes::Real;

/// What a normal law answers for one contact, or for several.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct NormalResponse<R = f64> {
    /// Repulsive force, never negative (N).
    pub force: R,
    /// dF/dδ on the branch that the contact is on (N/m).
    pub stiffness: R,
    /// Contact radius a = √(R δ) with the R of the branch (R* or R_p, δ counted from δ_p) (m).
    pub radius: R,
    /// 1/a (1/m); any number where a is 0.
    pub inverse_radius: R,
    /// Plastic work done since the last call (J); 0 on elastic branches.
    pub plastic_work: R,
}

/// A normal law, for one contact or for several at once; elastic constants live in the law, the reduced radius comes
/// with each contact.
pub trait NormalLaw: Copy + Send + Sync + 'static {
    /// History that one contact carries; `()` stores nothing.
    type State<R: Real>: Copy + Send + Sync;

    /// How many numbers the history is; all are 0 before the first touch.
    const HISTORY: usize;

    /// The history from its numbers.
    fn history<R: Real>(numbers: impl Fn(usize) -> R) -> Self::State<R>;

    /// The numbers of a history, each with its index.
    fn each_number<R: Real>(state: &Self::State<R>, put: impl FnMut(usize, R));

    /// Response at overlap `overlap` (m) (> 0 or not: no force at ≤ 0) for reduced radius `reduced_radius` R* (m).
    fn response<R: Real>(&self, state: &mut Self::State<R>, reduced_radius: R, overlap: R) -> NormalResponse<R>;

    /// Limiting contact pressure (Pa), infinite for elastic bodies; what [`mod@line`] needs to know of a law besides E*.
    fn limiting_pressure(&self) -> f64;

    /// Effective modulus E* of the pair (Pa).
    fn effective_modulus(&self) -> f64;

    /// Energy that would come back on unloading from `overlap` (J).
    fn elastic_energy(&self, state: &Self::State<f64>, reduced_radius: f64, overlap: f64) -> f64;

    /// Greatest dF/dδ that the contact can show at this state when it unloads or loads further (N/m); for the bound
    /// on the time step.
    fn greatest_stiffness(&self, state: &Self::State<f64>, reduced_radius: f64, overlap: f64) -> f64;
}
