//! The engine on a graphics processor (feature `gpu`): adapters, recorded functions on columns of numbers, and whole steps.
//!
//! A formula is recorded ([`recorder`](crate::base::recorder)), written as WGSL and run through `wgpu` on any adapter that has
//! 64-bit numbers in its shaders. A [`Stepper`] does the steps of an engine without contacts; runs do not use it yet: their
//! steps are done on the processor. How a stage gets there stands in
//! [`manual::architecture`](crate::manual::architecture#how-a-stage-gets-to-a-graphics-processor).

mod adapter;
mod kernel;
mod stage;
mod stepper;

pub use adapter::{Adapter, Device, adapters};
pub use kernel::Kernel;
pub use stepper::Stepper;
