//! strandsnap: a discrete-element engine for stranded wire under load, and the pictures that show how it fails.

pub mod base;
pub mod cli;
pub mod engine;
pub mod law;
pub mod observe;
pub mod page;
pub mod reference;
#[cfg(feature = "render")]
pub mod render;
pub mod run;
pub mod scene;
pub mod strand;
pub mod study;
