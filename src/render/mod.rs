//! Floor 6: off-screen pictures of a run. The only folder besides `gpu` that names `wgpu`.
//!
//! | for | call |
//! | --- | --- |
//! | frames of a run, with all panels, titles and charts | [`Renderer`], one snapshot and the [`History`] up to it to one picture |
//! | a numbered PNG sequence, and an animation of it, while a run goes on | [`FrameWriter`] |
//! | wires alone, through any camera, into memory, and what lies under a pixel | `explore::draw::Artist` (feature `explore`), with `painter::Painter` and `wires::segments` |
//!
//! Wires are drawn on the graphics adapter (`painter`, `wires`); charts and text are drawn over them on the processor
//! (`canvas`). A view of a frame is a file that implements `panel::Panel`, and a row of the table in `panels`. Everything
//! is in SI; lengths become millimetres where they are written.

pub mod adapter;
pub mod animation;
pub(crate) mod bodies;
pub(crate) mod body;
pub(crate) mod camera;
pub(crate) mod canvas;
// What only the interactive picture uses.
#[cfg(feature = "explore")]
pub(crate) mod caption;
mod chart;
mod close_up;
pub mod colour;
mod cross_section;
mod curve;
mod cutaway;
pub(crate) mod data;
mod everything;
mod exploded;
mod frame;
mod header;
mod history;
mod kind;
mod labels;
mod layout;
mod marks;
mod midsection;
pub(crate) mod occlusion;
mod overview;
pub(crate) mod painter;
mod panel;
mod panels;
#[cfg(feature = "explore")]
pub(crate) mod perspective;
pub mod png;
mod sides;
pub(crate) mod stripe;
pub(crate) mod style;
mod supersample;
mod target;
mod unrolled;
pub(crate) mod wires;
mod writer;

pub use adapter::check;
pub use frame::Renderer;
pub use history::{History, Row};
pub use painter::SHADER;
pub use style::{Rgb, SIGNAL, Style};
pub use writer::FrameWriter;
