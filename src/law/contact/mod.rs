//! Normal contact laws.
//!
//! | name | equation | source |
//! | --- | --- | --- |
//! | `hertz` | F = 4/3 E* √R* δ^(3/2) | Hertz 1882 |
//! | `thornton` | Hertz to p_y, then F_y + π p_y R* (δ − δ_y); unloading with R_p | Thornton 1997 |

pub mod constants;
pub mod geometry;
pub mod hertz;
pub mod thornton;

/// What a normal law answers for one contact.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct NormalResponse {
    /// Repulsive force, never negative [N].
    pub force: f64,
    /// dF/dδ on the branch that the contact is on [N/m].
    pub stiffness: f64,
    /// Contact radius a = √(R δ) with the R of the branch (R* or R_p, δ counted from δ_p) [m].
    pub radius: f64,
    /// Plastic work done since the last call [J]; 0 on elastic branches.
    pub plastic_work: f64,
}

/// A normal law; elastic constants live in the law, the reduced radius comes with each contact.
pub trait NormalLaw: Copy + Send + Sync + 'static {
    /// History that one contact carries; `()` stores nothing.
    type State: Copy + Default + Send + Sync + PartialEq + std::fmt::Debug + 'static;

    /// Response at overlap `overlap` [m] (> 0 or not: no force at ≤ 0) for reduced radius `reduced_radius` R* [m].
    fn response(&self, state: &mut Self::State, reduced_radius: f64, overlap: f64) -> NormalResponse;

    /// Energy that would come back on unloading from `overlap` [J].
    fn elastic_energy(&self, state: &Self::State, reduced_radius: f64, overlap: f64) -> f64;

    /// Greatest dF/dδ that the contact can show at this state when it unloads or loads further [N/m]; for the bound
    /// on the time step.
    fn greatest_stiffness(&self, state: &Self::State, reduced_radius: f64, overlap: f64) -> f64;
}
