//! Outputs as they are written.

use super::picture::RawPicture;
use super::scalar::Scalar;
use crate::scene::look::{ColourBy, Format, Table, Theme, View};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[output]`.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawOutput {
    /// Number of curve samples over the planned run, four times denser after the first rupture.
    #[schemars(extend("x-default" = "2000"))]
    pub samples: Option<i64>,
    /// Number of snapshots (recording and frames), evenly spread over the planned run; ruptures bring more, up to
    /// four times as many.
    #[schemars(extend("x-otherwise" = "160, or 60 where bonds can break"))]
    pub snapshots: Option<i64>,
    /// How many times denser than that snapshots are right after a rupture; with 1 a rupture brings only the last
    /// state before it and the first one after it.
    #[schemars(extend("x-unit" = "-", "x-default" = "40"))]
    pub rupture_density: Option<Scalar>,
    /// How often a run keeps its state, to be resumed from after a crash: a wall time such as "30 s", a number of steps, or
    /// none. It changes nothing in the results.
    #[schemars(extend("x-unit" = "s", "x-word" = "none", "x-otherwise" = "what costs at most 1 % of the time, at least 5 s apart"))]
    pub checkpoint: Option<Scalar>,
    /// Width and height of frames in pixels.
    #[schemars(extend("x-default" = "[1280, 720]"))]
    pub frame_size: Option<[i64; 2]>,
    /// What colours the wires.
    #[schemars(extend("x-default" = "stress"))]
    pub colour: Option<ColourBy>,
    /// Panels of a frame, such as ["overview", "midsection"].
    #[schemars(extend("x-otherwise" = "those that suit the scene"))]
    pub views: Option<Vec<View>>,
    /// Ground of the frames.
    #[schemars(extend("x-default" = "dark"))]
    pub theme: Option<Theme>,
    /// Viewpoint of the frames.
    #[serde(default)]
    pub camera: RawCamera,
    /// Files for other programs that are made when the run has come to its end, as `strandsnap export` makes them, such as
    /// ["parquet"].
    #[schemars(extend("x-otherwise" = "none"))]
    pub also: Option<Vec<Format>>,
    /// Tables that are written at every snapshot as CSV files of these names, such as ["holds", "contacts"].
    #[schemars(extend("x-otherwise" = "none"))]
    pub tables: Option<Vec<Table>>,
    /// How many times finer than its pixels a picture is drawn in either direction, from 1 to 4: finer outlines, for the
    /// square of it in drawing time.
    #[schemars(extend("x-default" = "1"))]
    pub supersampling: Option<i64>,
    /// `[[output.picture]]`: pictures from any side that are drawn when the run has come to its end.
    #[serde(default)]
    pub picture: Vec<RawPicture>,
}

/// `[output.camera]`: the viewpoint of the three-dimensional panels. The strand's axis z points right, y points up, the
/// eye looks along +x.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawCamera {
    /// Turn of the eye about the vertical.
    #[schemars(extend("x-unit" = "deg", "x-default" = "0 deg"))]
    pub azimuth: Option<Scalar>,
    /// Turn of the eye about the horizontal; at azimuth 0 that turns the strand about its axis.
    #[schemars(extend("x-unit" = "deg", "x-default" = "0 deg"))]
    pub elevation: Option<Scalar>,
    /// Magnification over what fits a panel.
    #[schemars(extend("x-unit" = "-", "x-default" = "1"))]
    pub zoom: Option<Scalar>,
    /// Section that the close-up follows: z before loading.
    #[schemars(extend("x-unit" = "mm", "x-otherwise" = "mid-length, then the first rupture"))]
    pub focus_z: Option<Scalar>,
}
