//! Floor 8: studies, made of many runs.

pub mod accuracy;
pub mod calibrate;
pub mod plot;
pub mod stability;
pub mod verify;
