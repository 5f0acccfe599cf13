//! Floor 8: studies, made of many runs.

pub mod accuracy;
pub mod calibrate;
pub mod check_run;
pub mod column;
pub mod fit;
pub mod plot;
pub mod runner;
pub mod screening;
mod select;
pub mod stability;
pub mod statistics;
pub mod sweep;
pub mod table;
pub mod tensile;
pub mod verify;
