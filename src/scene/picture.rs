//! Pictures of a view that a run makes of itself when it has come to its end.

use super::look::{ColourBy, Moment, Theme};
use glam::DVec3;

/// Least and greatest side of a picture (px).
pub const SIDES: std::ops::RangeInclusive<u32> = 16..=8192;
/// Furthest that wires are drawn apart (-).
pub const MOST_EXPLODED: f64 = 4.0;
/// Widest angle of a perspective (°).
pub const WIDEST: f64 = 90.0;

/// A picture that a scene asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureSpec {
    /// Name of its file, without .png.
    pub name: String,
    /// Which state of the run it shows.
    pub when: When,
    /// Width and height (px).
    pub size: [u32; 2],
    /// Turn of the eye about the vertical (rad).
    pub azimuth: f64,
    /// Turn of the eye about the horizontal (rad).
    pub elevation: f64,
    /// The point in the middle (m); `None`: that of all that is there, or the axis where it follows a section.
    pub centre: Option<DVec3>,
    /// What the height of the picture spans (m); `None`: what shows all that is there.
    pub height: Option<f64>,
    /// Angle under which the eye sees that height (rad); 0: along parallel lines.
    pub perspective: f64,
    /// Material section that the view rides on: z before loading (m).
    pub follow: Option<f64>,
    /// What colours the wires.
    pub colour: ColourBy,
    /// Ends of the colour scale in its own unit; `None`: those of the run.
    pub range: Option<[f64; 2]>,
    /// Layers that are left out, by name.
    pub hidden_layers: Vec<String>,
    /// Layers that are see-through, by name.
    pub ghost_layers: Vec<String>,
    /// Wires that are left out, from 0.
    pub hidden_wires: Vec<usize>,
    /// Wire that stands out, from 0.
    pub selected: Option<usize>,
    /// How far wires are drawn away from the axis, over their distance from it (-).
    pub explode: f64,
    /// What lies above this z is cut off (m).
    pub cut: Option<f64>,
    /// Ground.
    pub theme: Theme,
    /// How many times finer than its pixels it is drawn, in either direction.
    pub supersampling: u32,
}

/// Which state of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum When {
    /// One that has a name.
    At(Moment),
    /// The first one with this strain (-).
    Strain(f64),
    /// That at this simulated time (s).
    Time(f64),
}
