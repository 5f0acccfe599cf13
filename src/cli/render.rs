//! `strandsnap render`.

use super::Ended;
use super::values::{Colour, size, strain_range};
use crate::base::error::Result;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a finished run, such as out/ka4
    run: PathBuf,
    /// Panels, such as overview,midsection [default: those of the run's kind]
    #[arg(long, value_name = "VIEW", value_delimiter = ',')]
    views: Vec<String>,
    /// What colours the wires
    #[arg(long, value_enum, default_value = "stress")]
    colour: Colour,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "1280x720")]
    size: [u32; 2],
    /// Folder of the pictures [default: RUN/render]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace earlier pictures in that folder
    #[arg(long)]
    overwrite: bool,
    /// Turn of the eye about the vertical, in degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, allow_negative_numbers = true)]
    azimuth: f32,
    /// Turn of the eye about the horizontal, in degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, allow_negative_numbers = true)]
    elevation: f32,
    /// Magnification over what fits
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    zoom: f32,
    /// Section that the close-up follows: z before loading, in mm [default: mid-length, then the first rupture]
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    focus_z: Option<f32>,
    /// Ground
    #[arg(long, value_parser = ["dark", "light"], default_value = "dark")]
    theme: String,
    /// Draw every Nth snapshot only
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// Draw only this range of strain, in per cent, such as 20..26
    #[arg(long, value_name = "A..B", value_parser = strain_range)]
    strain_range: Option<[f64; 2]>,
}

#[cfg(not(feature = "render"))]
pub fn render(_args: Args) -> Result<Ended> {
    let instead = "draw on a machine where it is";
    Err(crate::run::outputs::built_without("frames", "render", instead))
}

#[cfg(feature = "render")]
pub fn render(args: Args) -> Result<Ended> {
    use super::say::say;
    use crate::render as drawing;
    use crate::run::{folder::OutFolder, replay};
    use std::sync::atomic::Ordering;

    replay::trajectory_of(&args.run)?;
    let options = drawing::FrameOptions {
        size: args.size,
        colour: args.colour.into(),
        views: args.views.iter().map(|word| word.parse()).collect::<Result<_>>()?,
        theme: if args.theme == "light" { drawing::Theme::Light } else { drawing::Theme::Dark },
        camera: drawing::CameraOptions {
            azimuth_deg: args.azimuth,
            elevation_deg: args.elevation,
            zoom: args.zoom,
            focus_z_mm: args.focus_z,
        },
    };
    let whole = replay::Selection::default();
    let selection = replay::Selection { every: args.every as usize, strain: args.strain_range.unwrap_or(whole.strain) };
    let out = args.out.unwrap_or_else(|| args.run.join("render"));
    let folder = OutFolder::check(&out, args.overwrite)?;
    drawing::check()?;
    folder.open_for_pictures()?;
    let mut writer = drawing::FrameWriter::new(&out, options)?;
    let stop = super::interrupt::install()?;
    let shown = replay::replay(&args.run, &selection, &mut writer, stop)?;
    say!("{shown} pictures are in {}", out.display());
    Ok(if stop.load(Ordering::Relaxed) { Ended::Interrupted } else { Ended::Well })
}
