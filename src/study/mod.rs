//! Floor 8: studies, made of many runs.

pub mod calibrate;
pub mod stability;
