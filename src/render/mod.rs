//! Floor 6: off-screen pictures of a run. The only folder that names `wgpu`.
//!
//! Wires are drawn on the graphics adapter ([`adapter`], [`target`], [`wires`]); charts and text are drawn over them
//! on the processor ([`canvas`]). [`frame::Renderer`] turns one snapshot into one picture, [`writer::FrameWriter`] is
//! the observer that writes a numbered PNG sequence while the simulation runs, and [`animation`] makes one file of it.

pub mod adapter;
pub mod animation;
pub mod camera;
pub mod canvas;
pub mod colour;
pub mod curve;
pub mod cut;
pub mod cutaway;
pub mod exploded;
pub mod frame;
pub mod header;
pub mod labels;
pub mod layout;
pub mod marks;
pub mod occlusion;
pub mod png;
pub mod shots;
pub mod solid;
pub mod style;
pub mod target;
pub mod unrolled;
pub mod viewpoint;
pub mod wires;
pub mod writer;

use crate::base::ticks;

pub use crate::observe::timings;
pub use adapter::check;
pub use animation::AnimationOptions;
pub use frame::Renderer;
pub use style::{CameraOptions, FrameOptions, Theme, View};
pub use timings::Timings;
pub use writer::FrameWriter;
