//! What a frame should show and how it should look.

use crate::scene::spec::ColourBy;
/// The words of a frame stand in the scene.
pub use crate::scene::spec::{Theme, View};

/// A colour as sRGB bytes.
pub type Rgb = [u8; 3];

/// What to draw.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameOptions {
    /// Width and height (px).
    pub size: [u32; 2],
    /// Quantity that colours the wires.
    pub colour: ColourBy,
    /// Panels. Empty means the default for the scene: overview, midsection, exploded layers, cross-section, unrolled
    /// map and curve for a body between grips, one view of everything for free bodies.
    pub views: Vec<View>,
    /// Dark or light.
    pub theme: Theme,
    /// Viewpoint.
    pub camera: CameraOptions,
}

impl Default for FrameOptions {
    fn default() -> Self {
        Self {
            size: [1280, 720],
            colour: ColourBy::Stress,
            views: Vec::new(),
            theme: Theme::Dark,
            camera: CameraOptions::default(),
        }
    }
}

/// Viewpoint of the three-dimensional panels. The strand's axis z points right, y points up, the eye looks along +x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraOptions {
    /// Turn of the eye about the vertical (°).
    pub azimuth_deg: f32,
    /// Turn of the eye about the horizontal, which is the strand's axis when the azimuth is 0 (°).
    pub elevation_deg: f32,
    /// Magnification over what fits the panel (-).
    pub zoom: f32,
    /// Section that the close-up follows, as z before loading (mm). `None`: the middle of the gauge until a bond
    /// breaks, then the place of the first rupture.
    pub focus_z_mm: Option<f32>,
}

impl Default for CameraOptions {
    fn default() -> Self {
        Self { azimuth_deg: 0.0, elevation_deg: 0.0, zoom: 1.0, focus_z_mm: None }
    }
}

impl Theme {
    /// The colours of the theme.
    pub fn style(self) -> Style {
        match self {
            Theme::Dark => Style {
                page: [13, 16, 22],
                panel: [22, 26, 34],
                text: [236, 239, 244],
                muted: [150, 159, 174],
                grid: [44, 50, 62],
                signal: SIGNAL,
                accent: [240, 243, 248],
                cut: [126, 134, 148],
                rim: [0.10, 0.12, 0.15],
                edge: 0.0,
            },
            Theme::Light => Style {
                page: [255, 255, 255],
                panel: [246, 247, 249],
                text: [24, 28, 36],
                muted: [96, 104, 118],
                grid: [216, 220, 227],
                signal: SIGNAL,
                accent: [30, 36, 48],
                cut: [150, 156, 166],
                rim: [0.0, 0.0, 0.0],
                edge: 0.45,
            },
        }
    }
}

/// Colour of everything that marks a rupture. No colour map used here comes near it (tested in `colour`).
pub const SIGNAL: Rgb = [255, 45, 60];

/// Colours of a theme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// Between panels and behind the header.
    pub page: Rgb,
    /// Behind a panel's content.
    pub panel: Rgb,
    /// Text.
    pub text: Rgb,
    /// Labels and axes.
    pub muted: Rgb,
    /// Grid lines and borders.
    pub grid: Rgb,
    /// Ruptures.
    pub signal: Rgb,
    /// The curve.
    pub accent: Rgb,
    /// Faces where wires were cut off to show what lies behind them.
    pub cut: Rgb,
    /// Light added along silhouettes, linear RGB (-).
    pub rim: [f32; 3],
    /// Darkening along silhouettes, 0 to 1 (-).
    pub edge: f32,
}
