//! What a single picture says of itself: a few words at its lower edge, and a scale.

use super::canvas::{Align, Canvas, Fonts, Rect, Type, Weight};
use super::style::Style;
use image::RgbImage;

/// Size of the words, distance from the edges and distance between lines, in units.
const TEXT: f32 = 19.0;
const EDGE: f32 = 14.0;
const LINE: f32 = 1.4;
/// Share of the picture's width that the scale takes at most (-).
const WIDEST: f64 = 0.16;

/// How large a picture shows things.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Pixels that a millimetre takes (px/mm).
    pub pixels_per_mm: f64,
}

/// A picture with lines of text at its lower left and a scale at its lower right.
pub fn caption(image: RgbImage, fonts: &Fonts, style: &Style, lines: &[String], scale: Scale) -> RgbImage {
    let [w, h] = [image.width() as f32, image.height() as f32];
    let mut canvas = Canvas { image, fonts, unit: (h / 720.0).max(0.4) };
    let (edge, size) = (EDGE * canvas.unit, TEXT * canvas.unit);
    let length = round_below(WIDEST * f64::from(w) / scale.pixels_per_mm);
    let bar = (length * scale.pixels_per_mm) as f32;
    let room = w - bar - 5.0 * edge;
    let widest = lines.iter().map(|line| fonts.width(line, size, Weight::Bold)).fold(0.0, f32::max);
    // Smaller words rather than words over the scale.
    let size = size * (room / widest.max(1.0)).min(1.0);
    let height = size * LINE;
    let ground = Rect::new(0.0, h - height * lines.len() as f32 - edge, w, height * lines.len() as f32 + edge);
    canvas.fill(ground, style.page, 0.72);
    for (number, line) in lines.iter().rev().enumerate() {
        let kind = Type { size, weight: Weight::Bold, colour: style.text, align: Align::Left };
        canvas.text(edge, h - edge - height * number as f32, kind, line);
    }
    // In the middle of a row of pixels, so that it is sharp.
    let (right, y) = (w - edge, (h - edge).floor() + 0.5);
    let (left, tick) = (right - bar, 0.35 * edge);
    let width = (1.6 * canvas.unit).max(1.0);
    canvas.polyline(&[[left, y - tick], [left, y], [right, y], [right, y - tick]], width, style.text, 1.0);
    let size = (TEXT * canvas.unit).min(size * 1.2) * 0.8;
    let kind = Type { size, weight: Weight::Regular, colour: style.text, align: Align::Centre };
    canvas.text(0.5 * (left + right), y - 0.5 * edge, kind, &format!("{length} mm"));
    canvas.image
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a value.
fn round_below(value: f64) -> f64 {
    let power = value.log10().floor();
    let factor = [5.0, 2.0, 1.0].into_iter().find(|factor| factor * 10f64.powf(power) <= value).unwrap_or(1.0);
    // Read from digits, so that a tenth is 0.1.
    format!("{factor}e{power}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::spec::Theme;

    #[test]
    fn scales_are_round() {
        for (value, right) in [(1.0, 1.0), (0.13, 0.1), (7.0, 5.0), (0.0299, 0.02), (499.0, 200.0), (6e-3, 5e-3)] {
            assert_eq!(round_below(value), right);
        }
    }

    #[test]
    fn the_scale_is_as_long_as_it_says_and_words_leave_it_alone() {
        let (fonts, style) = (Fonts::embedded(), Theme::Dark.style());
        let image = RgbImage::from_pixel(640, 360, image::Rgb([40, 40, 40]));
        let long = "a line that is much longer than the picture is wide ".repeat(5);
        let scale = Scale { pixels_per_mm: 31.0 };
        let drawn = caption(image, &fonts, &style, &[long, "short".into()], scale);
        // 2 mm are the most in 16 % of the width: 62 px, up to seven from the right edge.
        let y = 360 - 7;
        let bright = |x: &u32| drawn.get_pixel(*x, y).0[0] > 150;
        let lit: Vec<u32> = (500..640).filter(bright).collect();
        let (first, last) = (lit[0], lit[lit.len() - 1]);
        assert!((570..=572).contains(&first) && (632..=634).contains(&last), "{first} to {last}");
        assert_eq!(lit.len() as u32, last - first + 1, "one line, and no words in it");
        assert_eq!(drawn.get_pixel(320, 100).0, [40, 40, 40], "above it nothing changes");
    }
}
