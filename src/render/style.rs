//! What a frame should show and how it should look.

use crate::base::error::{Error, Result};
use crate::scene::spec::ColourBy;

/// A colour as sRGB bytes.
pub type Rgb = [u8; 3];

/// What to draw.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameOptions {
    /// Width and height [px].
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
    /// Turn of the eye about the vertical [°].
    pub azimuth_deg: f32,
    /// Turn of the eye about the horizontal, which is the strand's axis when the azimuth is 0 [°].
    pub elevation_deg: f32,
    /// Magnification over what fits the panel [-].
    pub zoom: f32,
    /// Section that the close-up follows, as z before loading [mm]. `None`: the middle of the gauge until a bond
    /// breaks, then the place of the first rupture.
    pub focus_z_mm: Option<f32>,
}

impl Default for CameraOptions {
    fn default() -> Self {
        Self { azimuth_deg: 0.0, elevation_deg: 0.0, zoom: 1.0, focus_z_mm: None }
    }
}

/// A panel of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum View {
    /// The whole strand, its axis across the width.
    Overview,
    /// Close-up on the section where it breaks, from the front and from the back.
    Midsection,
    /// The same section with its outer layers cut open in steps, so that inner wires are seen in place.
    Cutaway,
    /// The same section with the layers taken apart, one below the other.
    Exploded,
    /// The cut at the same section: wires as discs, broken ones hollow.
    CrossSection,
    /// Wire number against axial position.
    Unrolled,
    /// Stress–strain curve.
    Curve,
    /// Everything in one view; what free bodies get.
    Scene,
}

impl View {
    /// Every view.
    pub const ALL: [View; 8] = [
        View::Overview,
        View::Midsection,
        View::Cutaway,
        View::Exploded,
        View::CrossSection,
        View::Unrolled,
        View::Curve,
        View::Scene,
    ];

    /// The word that people write.
    pub fn word(self) -> &'static str {
        match self {
            View::Overview => "overview",
            View::Midsection => "midsection",
            View::Cutaway => "cutaway",
            View::Exploded => "exploded",
            View::CrossSection => "cross-section",
            View::Unrolled => "unrolled",
            View::Curve => "curve",
            View::Scene => "scene",
        }
    }
}

impl std::str::FromStr for View {
    type Err = Error;

    fn from_str(word: &str) -> Result<Self> {
        let words = View::ALL.map(View::word).join(", ");
        View::ALL
            .into_iter()
            .find(|v| v.word() == word)
            .ok_or_else(|| Error::input(format!("there is no view `{word}`"), format!("views are {words}")))
    }
}

/// Dark or light ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Theme {
    /// Dark, for screens.
    #[default]
    Dark,
    /// White, for paper.
    Light,
}

impl Theme {
    /// Every theme.
    pub const ALL: [Theme; 2] = [Theme::Dark, Theme::Light];

    /// The word that people write.
    pub fn word(self) -> &'static str {
        match self {
            Theme::Dark => "dark",
            Theme::Light => "light",
        }
    }

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

impl std::str::FromStr for Theme {
    type Err = Error;

    fn from_str(word: &str) -> Result<Self> {
        Theme::ALL
            .into_iter()
            .find(|t| t.word() == word)
            .ok_or_else(|| Error::input(format!("there is no theme `{word}`"), "themes are dark, light"))
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
    /// Light added along silhouettes, linear RGB [-].
    pub rim: [f32; 3],
    /// Darkening along silhouettes, 0 to 1 [-].
    pub edge: f32,
}
