//! The options that say how frames look: the keys of a scene's `[output]`, for `run` and `render` alike.

use super::values::{size, within};
use crate::scene::look::ZOOM;
use crate::scene::spec::{ColourBy, OutputSpec, Theme, View};
use clap::ValueEnum;
use clap::builder::PossibleValue;

/// The words of a scene on the command line.
macro_rules! word_options {
    ($($name:ident)+) => {
        $(impl ValueEnum for $name {
            fn value_variants<'a>() -> &'a [Self] {
                &Self::ALL
            }

            fn to_possible_value(&self) -> Option<PossibleValue> {
                Some(PossibleValue::new(self.word()).help(self.about()))
            }
        })+
    };
}

word_options!(View Theme ColourBy);

/// What differs from the scene.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Look of the frames [default: the scene's]")]
pub struct LookArgs {
    /// Panels, such as overview,midsection
    #[arg(long, value_name = "VIEW", value_enum, value_delimiter = ',')]
    views: Option<Vec<View>>,
    /// What colours the wires
    #[arg(long, value_enum)]
    colour: Option<ColourBy>,
    /// Ground
    #[arg(long, value_enum)]
    theme: Option<Theme>,
    /// Width and height in pixels, from 120 to 8192 each
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    /// How many times finer than its pixels a picture is drawn, from 1 to 4: finer outlines, for the square of it in drawing time
    #[arg(long, value_name = "TIMES", value_parser = clap::value_parser!(u32).range(1..=4))]
    supersampling: Option<u32>,
    /// Turn of the eye about the vertical
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = within(-360.0, 360.0, "an angle in degrees"))]
    azimuth: Option<f64>,
    /// Turn of the eye about the horizontal
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = within(-360.0, 360.0, "an angle in degrees"))]
    elevation: Option<f64>,
    /// Magnification over what fits
    #[arg(long, value_name = "FACTOR", value_parser = within(*ZOOM.start(), *ZOOM.end(), "a magnification"))]
    zoom: Option<f64>,
    /// Section that the close-up follows: z before loading
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = within(-1e8, 1e8, "a place in mm"))]
    focus_z: Option<f64>,
}

impl LookArgs {
    /// Puts the options in place of the scene's keys.
    pub fn apply(&self, output: &mut OutputSpec) {
        put(&mut output.views, self.views.clone());
        put(&mut output.colour, self.colour);
        put(&mut output.theme, self.theme);
        put(&mut output.frame_size, self.size);
        put(&mut output.supersampling, self.supersampling);
        put(&mut output.camera.azimuth, self.azimuth.map(f64::to_radians));
        put(&mut output.camera.elevation, self.elevation.map(f64::to_radians));
        put(&mut output.camera.zoom, self.zoom);
        put(&mut output.camera.focus_z, self.focus_z.map(|z| Some(z * 1e-3)));
    }
}

fn put<T>(key: &mut T, option: Option<T>) {
    if let Some(value) = option {
        *key = value;
    }
}
