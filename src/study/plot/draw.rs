//! Draws figures on one of the two backends.

use super::figure::Figure;
use super::painter::{FONT, Painter};
use crate::base::error::{Error, Result};
use plotters::coord::Shift;
use plotters::prelude::*;
use std::sync::Once;

/// Pixels of a PNG per pixel of an SVG (-).
const PNG_SCALE: u32 = 2;

/// The figures as SVG text.
pub fn svg(figures: &[Figure], columns: usize) -> Result<String> {
    let mut text = String::new();
    let size = sheet(figures, columns, 1);
    draw(figures, columns, 1, SVGBackend::with_string(&mut text, size).into_drawing_area())?;
    // Who opens the file may not have our font.
    Ok(text.replace("font-family=\"Inter\"", "font-family=\"Inter, Helvetica, Arial, sans-serif\""))
}

/// The figures as the bytes of a PNG.
pub fn png(figures: &[Figure], columns: usize) -> Result<Vec<u8>> {
    let (width, height) = sheet(figures, columns, PNG_SCALE);
    let mut pixels = vec![255; (3 * width * height) as usize];
    let backend = BitMapBackend::with_buffer(&mut pixels, (width, height));
    draw(figures, columns, PNG_SCALE, backend.into_drawing_area())?;
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&pixels)).map_err(cannot_draw)?;
    Ok(bytes)
}

/// Size of the whole sheet.
fn sheet(figures: &[Figure], columns: usize, scale: u32) -> (u32, u32) {
    let columns = columns.clamp(1, figures.len());
    let rows = figures.len().div_ceil(columns);
    let [width, height] = [0, 1].map(|k| figures.iter().map(|figure| figure.size[k]).max().unwrap_or(0) * scale);
    (width * columns as u32, height * rows as u32)
}

fn cannot_draw(cause: impl std::fmt::Display) -> Error {
    Error::Missing { what: format!("cannot draw a figure: {cause}"), help: None }
}

fn draw<B: DrawingBackend>(figures: &[Figure], columns: usize, scale: u32, area: DrawingArea<B, Shift>) -> Result<()> {
    use_own_font();
    area.fill(&WHITE).map_err(cannot_draw)?;
    let columns = columns.clamp(1, figures.len());
    let parts = area.split_evenly((figures.len().div_ceil(columns), columns));
    for (figure, part) in figures.iter().zip(&parts) {
        Painter::new(figure, part, f64::from(scale)).paint().map_err(cannot_draw)?;
    }
    area.present().map_err(cannot_draw)
}

fn use_own_font() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let fonts: [(FontStyle, &'static [u8]); 2] = [
            (FontStyle::Normal, include_bytes!("../../../assets/fonts/Inter-Regular.otf")),
            (FontStyle::Bold, include_bytes!("../../../assets/fonts/Inter-SemiBold.otf")),
        ];
        for (style, bytes) in fonts {
            assert!(plotters::style::register_font(FONT, style, bytes).is_ok(), "the font that comes along is whole");
        }
    });
}
