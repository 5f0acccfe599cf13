//! Floor 8: studies, made of many runs.

pub mod accuracy;
pub mod calibrate;
pub mod cases;
pub mod check_run;
pub mod fit;
pub mod plot;
pub mod screening;
mod select;
pub mod stability;
pub mod sweep;
pub mod table;
pub mod verify;
