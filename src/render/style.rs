//! Colours of the themes.

use crate::scene::spec::Theme;

/// A colour as sRGB bytes.
pub type Rgb = [u8; 3];

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
