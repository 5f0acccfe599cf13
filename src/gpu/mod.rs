//! The engine's formulas on a graphics processor (feature `gpu`): adapters, and recorded functions on columns of numbers.
//!
//! A formula is recorded ([`recorder`](crate::base::recorder)), written as WGSL and run through `wgpu` on any adapter that has
//! 64-bit numbers in its shaders. Runs do not use it yet: their steps are done on the processor.

mod adapter;
mod kernel;
mod stage;
mod stepper;

pub use adapter::{Adapter, Device, adapters};
pub use kernel::Kernel;
pub use stepper::Stepper;
