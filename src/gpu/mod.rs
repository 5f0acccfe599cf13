//! The engine on a graphics processor (feature `gpu`): adapters, recorded functions on columns of numbers, and whole steps.
//!
//! A formula is recorded ([`recorder`](crate::base::recorder)), written as WGSL and run through `wgpu` on any adapter that has
//! 64-bit numbers in its shaders. A [`Stepper`] does the steps of an engine (`run --device`). How a stage gets there stands in
//! [`manual::architecture`](crate::manual::architecture#how-a-stage-gets-to-a-graphics-processor).

mod adapter;
mod batch;
mod kernel;
mod layout;
mod stage;
mod stepper;
mod together;

pub use adapter::{Adapter, Device, adapters};
pub use kernel::Kernel;
pub use stepper::Stepper;
