//! Pictures of a view as they are written.

use super::scalar::{Scalar, Triple};
use crate::scene::look::{ColourBy, Moment, Theme};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[[output.picture]]`: a picture from any side, drawn when the run has come to its end, of one moment: `at`, `strain` or
/// `time`. `strandsnap explore` writes it out of what it shows.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawPicture {
    /// Name of its file in the run's folder `pictures`, without .png.
    #[schemars(extend("x-required" = true))]
    pub name: Option<String>,
    /// Moment that it shows.
    #[schemars(extend("x-default" = "end"))]
    pub at: Option<Moment>,
    /// Strain that it shows, at the first time that it is reached; between two snapshots what can move is drawn between.
    #[schemars(extend("x-unit" = "-"))]
    pub strain: Option<Scalar>,
    /// Simulated time that it shows.
    #[schemars(extend("x-unit" = "ms"))]
    pub time: Option<Scalar>,
    /// Width and height in pixels.
    #[schemars(extend("x-otherwise" = "those of frames"))]
    pub size: Option<[i64; 2]>,
    /// Turn of the eye about the vertical.
    #[schemars(extend("x-unit" = "deg", "x-default" = "-28 deg"))]
    pub azimuth: Option<Scalar>,
    /// Turn of the eye about the horizontal.
    #[schemars(extend("x-unit" = "deg", "x-default" = "22 deg"))]
    pub elevation: Option<Scalar>,
    /// The point in the middle of the picture.
    #[schemars(extend("x-unit" = "mm", "x-otherwise" = "that of all that is there; beside `follow` [\"0 mm\", \"0 mm\", \"0 mm\"]"))]
    pub centre: Option<Triple>,
    /// What the height of the picture spans; in perspective, where its middle lies.
    #[schemars(extend("x-unit" = "mm", "x-otherwise" = "what shows all that is there"))]
    pub height: Option<Scalar>,
    /// Angle under which the eye sees that height, 90 deg at most; 0 is the view along parallel lines.
    #[schemars(extend("x-unit" = "deg", "x-default" = "0 deg"))]
    pub perspective: Option<Scalar>,
    /// Material section that the view rides on: z before loading. The z of `centre` is relative to it then.
    #[schemars(extend("x-unit" = "mm"))]
    pub follow: Option<Scalar>,
    /// What colours the wires.
    #[schemars(extend("x-otherwise" = "what colours the frames"))]
    pub colour: Option<ColourBy>,
    /// Ends of the colour scale, in the unit that it is shown in.
    #[schemars(extend("x-unit" = "-", "x-otherwise" = "those of the run"))]
    pub range: Option<[f64; 2]>,
    /// Layers that are left out, by name.
    pub hidden_layers: Option<Vec<String>>,
    /// Layers that are drawn see-through, by name.
    pub ghost_layers: Option<Vec<String>>,
    /// Wires that are left out, numbered from 1.
    pub hidden_wires: Option<Vec<i64>>,
    /// Wire that stands out, numbered from 1: the others are dimmed.
    pub selected: Option<i64>,
    /// How far wires are drawn away from the axis, over their distance from it, 4 at most.
    #[schemars(extend("x-unit" = "-", "x-default" = "0"))]
    pub explode: Option<Scalar>,
    /// What lies above this z is cut off.
    #[schemars(extend("x-unit" = "mm"))]
    pub cut: Option<Scalar>,
    /// How many times finer than its pixels it is drawn in either direction, from 1 to 4.
    #[schemars(extend("x-otherwise" = "that of frames"))]
    pub supersampling: Option<i64>,
    /// Ground.
    #[schemars(extend("x-otherwise" = "that of the frames"))]
    pub theme: Option<Theme>,
}
