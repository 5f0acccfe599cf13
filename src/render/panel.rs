//! What a view of a frame is.

use super::camera::Camera;
use super::canvas::{Canvas, Rect};
use super::data::Data;
use super::wires::Looks;
use crate::scene::spec::View;

/// Space around panels in units.
pub const GAP: f32 = 6.0;

/// A view of a frame: a panel that is drawn on the processor, or one whose wires the graphics adapter draws first.
pub trait Panel: Sync {
    /// The three-dimensional pictures in `panel` (px), `unit` pixels being a layout unit; a flat panel has none.
    fn shots(&self, _data: &Data, _panel: Rect, _unit: f32) -> Vec<Shot> {
        Vec::new()
    }

    /// How wires look in its shots, where that is not as they are: alike in all shots of a frame.
    fn looks(&self, _data: &Data, _camera: &Camera) -> Option<Looks> {
        None
    }

    /// Draws all of a flat panel (px).
    fn draw(&self, _canvas: &mut Canvas, _panel: Rect, _data: &Data) {}

    /// Draws what goes over the wires of one of its shots; `frame` are those of the whole frame.
    fn annotate(&self, _canvas: &mut Canvas, _shot: &Shot, _data: &Data, _frame: &[Shot]) {}
}

/// A three-dimensional picture: a camera and what it is for.
pub struct Shot {
    /// The view that it belongs to.
    pub view: View,
    /// The camera.
    pub camera: Camera,
    /// The one layer that it shows; `None` for all.
    pub layer: Option<usize>,
    /// Title; empty for none.
    pub caption: String,
    /// Remark after the title.
    pub remark: String,
    /// Depth over which things darken (m).
    pub fade: f32,
    /// Whether a scale bar and the axes are drawn over it.
    pub measures: bool,
}
