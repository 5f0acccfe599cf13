//! Screening: few points of a large grid of factors, picked so that main effects and chosen interactions are told apart
//! well (`design.rs`), and the effects themselves by least squares (`effects.rs`).

mod design;
mod effects;
mod model;

pub use design::{DesignError, d_optimal, efficiency};
pub use effects::{AtLevel, Effects, EffectsError, Estimate, Factor, Interaction, LevelMean, Term, effects};
pub use model::Model;
