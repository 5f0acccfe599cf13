//! Floor 2: TOML → [`spec::Spec`] (SI) → [`plan::Plan`] (what this scene needs, with a reason per component).

pub mod centreline_text;
pub mod spec;
