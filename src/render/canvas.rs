//! Two-dimensional drawing on the processor: rectangles, lines, discs, text. Everything is anti-aliased by coverage
//! and depends on nothing but its arguments, so two draws give the same bytes.

use super::style::Rgb;
use ab_glyph::{Font, FontRef, PxScale, ScaleFont};
use image::RgbImage;

/// A rectangle in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// Left edge (px).
    pub x: f32,
    /// Top edge (px).
    pub y: f32,
    /// Width (px).
    pub w: f32,
    /// Height (px).
    pub h: f32,
}

impl Rect {
    /// A rectangle from its corner and size (px).
    pub fn new(x: f32, y: f32, w: f32, h: f32) -> Self {
        Self { x, y, w, h }
    }

    /// Right edge (px).
    pub fn right(&self) -> f32 {
        self.x + self.w
    }

    /// Bottom edge (px).
    pub fn bottom(&self) -> f32 {
        self.y + self.h
    }

    /// The rectangle without margins left, top, right and bottom (px).
    pub fn inset(&self, left: f32, top: f32, right: f32, bottom: f32) -> Self {
        Self::new(self.x + left, self.y + top, self.w - left - right, self.h - top - bottom)
    }

    /// Edges moved to whole pixels.
    pub fn snapped(&self) -> Self {
        let (x, y) = (self.x.round(), self.y.round());
        Self::new(x, y, self.right().round() - x, self.bottom().round() - y)
    }
}

/// Weight of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weight {
    /// Labels.
    Regular,
    /// Values and titles.
    Bold,
}

/// Where a text hangs on its anchor point, horizontally.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// The point is the text's left end.
    Left,
    /// The point is its middle.
    Centre,
    /// The point is its right end.
    Right,
}

/// How a text looks.
#[derive(Debug, Clone, Copy)]
pub struct Type {
    /// Height of an em (px).
    pub size: f32,
    /// Weight.
    pub weight: Weight,
    /// Colour.
    pub colour: Rgb,
    /// Horizontal alignment.
    pub align: Align,
}

/// Fonts that are part of the program.
pub struct Fonts {
    regular: FontRef<'static>,
    bold: FontRef<'static>,
}

impl Fonts {
    /// Reads the embedded fonts.
    pub fn embedded() -> Self {
        // The bytes are compiled in, so parsing either always works or fails in the first test.
        let font = |bytes| FontRef::try_from_slice(bytes).expect("the embedded font is valid");
        Self {
            regular: font(include_bytes!("../../assets/fonts/Inter-Regular.otf")),
            bold: font(include_bytes!("../../assets/fonts/Inter-SemiBold.otf")),
        }
    }

    fn get(&self, weight: Weight) -> &FontRef<'static> {
        match weight {
            Weight::Regular => &self.regular,
            Weight::Bold => &self.bold,
        }
    }

    /// Width of a text (px).
    pub fn width(&self, text: &str, size: f32, weight: Weight) -> f32 {
        self.layout(text, size, weight, |_, _| ())
    }

    /// Calls `place(glyph, x)` for every character and returns the width (px). Figures all get the width of a zero,
    /// so that numbers do not dance from frame to frame.
    fn layout(&self, text: &str, size: f32, weight: Weight, mut place: impl FnMut(ab_glyph::GlyphId, f32)) -> f32 {
        let font = self.get(weight);
        let scaled = font.as_scaled(em_scale(font, size));
        let zero = scaled.h_advance(font.glyph_id('0'));
        let (mut x, mut last) = (0.0, None);
        for c in text.chars() {
            let id = font.glyph_id(c);
            let advance = scaled.h_advance(id);
            if c.is_ascii_digit() {
                place(id, x + 0.5 * (zero - advance));
                x += zero;
                last = None;
            } else {
                x += last.map_or(0.0, |l| scaled.kern(l, id));
                place(id, x);
                x += advance;
                last = Some(id);
            }
        }
        x
    }
}

/// The scale at which an em is `size` pixels high (ab_glyph scales by ascent − descent instead).
fn em_scale(font: &FontRef, size: f32) -> PxScale {
    let em = font.units_per_em().unwrap_or(1000.0);
    PxScale::from(size * font.height_unscaled() / em)
}

/// A picture that is being drawn.
pub struct Canvas<'a> {
    /// The picture.
    pub image: RgbImage,
    /// Fonts.
    pub fonts: &'a Fonts,
    /// Size of a layout pixel (px): 1 for a frame of 720 lines, 3 for 2160.
    pub unit: f32,
}

impl Canvas<'_> {
    /// Mixes `colour` into a pixel with weight `alpha`.
    #[inline]
    pub fn blend(&mut self, x: i32, y: i32, colour: Rgb, alpha: f32) {
        let (w, h) = self.image.dimensions();
        if alpha <= 0.0 || x < 0 || y < 0 || x >= w as i32 || y >= h as i32 {
            return;
        }
        let a = alpha.min(1.0);
        let pixel = &mut self.image.get_pixel_mut(x as u32, y as u32).0;
        for k in 0..3 {
            pixel[k] = (f32::from(pixel[k]) * (1.0 - a) + f32::from(colour[k]) * a + 0.5) as u8;
        }
    }

    /// Fills a rectangle; edges between pixels are anti-aliased.
    pub fn fill(&mut self, r: Rect, colour: Rgb, alpha: f32) {
        let cover = |p: i32, low: f32, high: f32| (high.min(p as f32 + 1.0) - low.max(p as f32)).clamp(0.0, 1.0);
        let (w, h) = (self.image.width() as i32, self.image.height() as i32);
        let [from, to] = [r.x.floor(), r.right().ceil()].map(|x| (x as i32).clamp(0, w));
        // Columns that are covered from edge to edge.
        let [first, last] = [r.x.ceil(), r.right().floor()].map(|x| (x as i32).clamp(from, to));
        for y in (r.y.floor() as i32).max(0)..(r.bottom().ceil() as i32).min(h) {
            let cy = cover(y, r.y, r.bottom());
            let whole = alpha * cy >= 1.0 && first < last;
            if whole {
                let row = (y * w) as usize;
                let inner = (row + first as usize) * 3..(row + last as usize) * 3;
                let bytes: &mut [u8] = &mut self.image;
                bytes[inner].as_chunks_mut().0.fill(colour);
            }
            let edges = if whole { [from..first, last..to] } else { [from..to, to..to] };
            for x in edges.into_iter().flatten() {
                self.blend(x, y, colour, alpha * cy * cover(x, r.x, r.right()));
            }
        }
    }

    /// Fills a rectangle with rounded corners.
    pub fn fill_rounded(&mut self, r: Rect, radius: f32, colour: Rgb, alpha: f32) {
        let (cx, cy) = (r.x + 0.5 * r.w, r.y + 0.5 * r.h);
        self.shade(
            r,
            |x, y| {
                let dx = ((x - cx).abs() - 0.5 * r.w + radius).max(0.0);
                let dy = ((y - cy).abs() - 0.5 * r.h + radius).max(0.0);
                dx.hypot(dy) - radius
            },
            colour,
            alpha,
        );
    }

    /// Fills a disc.
    pub fn disc(&mut self, x: f32, y: f32, radius: f32, colour: Rgb, alpha: f32) {
        let r = Rect::new(x - radius, y - radius, 2.0 * radius, 2.0 * radius);
        self.shade(r, |px, py| (px - x).hypot(py - y) - radius, colour, alpha);
    }

    /// Draws a circle of line width `width`.
    pub fn ring(&mut self, x: f32, y: f32, radius: f32, width: f32, colour: Rgb, alpha: f32) {
        let o = radius + width;
        let r = Rect::new(x - o, y - o, 2.0 * o, 2.0 * o);
        self.shade(r, |px, py| ((px - x).hypot(py - y) - radius).abs() - 0.5 * width, colour, alpha);
    }

    /// Draws a straight line with round ends.
    pub fn line(&mut self, from: [f32; 2], to: [f32; 2], width: f32, colour: Rgb, alpha: f32) {
        self.polyline(&[from, to], width, colour, alpha);
    }

    /// Draws connected straight lines with round joints, as one shape: no darker spots where pieces overlap.
    pub fn polyline(&mut self, points: &[[f32; 2]], width: f32, colour: Rgb, alpha: f32) {
        let (w, h) = self.image.dimensions();
        let reach = 0.5 * width + 1.0;
        let (mut low, mut high) = ([f32::MAX; 2], [f32::MIN; 2]);
        for p in points {
            for k in 0..2 {
                low[k] = low[k].min(p[k] - reach);
                high[k] = high[k].max(p[k] + reach);
            }
        }
        let (x0, y0) = (low[0].max(0.0) as usize, low[1].max(0.0) as usize);
        let (x1, y1) =
            ((high[0].ceil().max(0.0) as usize).min(w as usize), (high[1].ceil().max(0.0) as usize).min(h as usize));
        if points.len() < 2 || x1 <= x0 || y1 <= y0 {
            return;
        }
        let columns = x1 - x0;
        let mut cover = vec![0f32; columns * (y1 - y0)];
        for pair in points.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let clip = |v: f32, lo: usize, hi: usize| (v.max(lo as f32) as usize).clamp(lo, hi);
            for y in clip(a[1].min(b[1]) - reach, y0, y1)..clip(a[1].max(b[1]) + reach + 1.0, y0, y1) {
                for x in clip(a[0].min(b[0]) - reach, x0, x1)..clip(a[0].max(b[0]) + reach + 1.0, x0, x1) {
                    let d = distance_to_segment([x as f32 + 0.5, y as f32 + 0.5], a, b);
                    let c = &mut cover[(y - y0) * columns + x - x0];
                    *c = c.max((0.5 * width + 0.5 - d).clamp(0.0, width.min(1.0)));
                }
            }
        }
        for (k, c) in cover.iter().enumerate().filter(|(_, c)| **c > 0.0) {
            self.blend((x0 + k % columns) as i32, (y0 + k / columns) as i32, colour, alpha * c);
        }
    }

    /// Writes a text with its baseline at `y`; returns its width (px).
    pub fn text(&mut self, x: f32, y: f32, kind: Type, text: &str) -> f32 {
        let fonts = self.fonts;
        let width = fonts.width(text, kind.size, kind.weight);
        let start = x - width * share(kind.align);
        let (fx, fy) = (start.fract(), y.fract());
        let font = fonts.get(kind.weight);
        let scale = em_scale(font, kind.size);
        fonts.layout(text, kind.size, kind.weight, |id, at| {
            let glyph = id.with_scale_and_position(scale, ab_glyph::point(at + fx, fy));
            let Some(outline) = font.outline_glyph(glyph) else {
                return;
            };
            let min = outline.px_bounds().min;
            outline.draw(|gx, gy, c| {
                let (px, py) = (min.x + gx as f32 - fx + 0.5, min.y + gy as f32 - fy + 0.5);
                self.blend((start + px).floor() as i32, (y + py).floor() as i32, kind.colour, c);
            });
        });
        width
    }

    fn shade(&mut self, r: Rect, distance: impl Fn(f32, f32) -> f32, colour: Rgb, alpha: f32) {
        for y in (r.y - 1.0).floor() as i32..=(r.bottom() + 1.0).ceil() as i32 {
            for x in (r.x - 1.0).floor() as i32..=(r.right() + 1.0).ceil() as i32 {
                let c = (0.5 - distance(x as f32 + 0.5, y as f32 + 0.5)).clamp(0.0, 1.0);
                self.blend(x, y, colour, alpha * c);
            }
        }
    }
}

fn share(align: Align) -> f32 {
    match align {
        Align::Left => 0.0,
        Align::Centre => 0.5,
        Align::Right => 1.0,
    }
}

fn distance_to_segment(p: [f32; 2], a: [f32; 2], b: [f32; 2]) -> f32 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let (px, py) = (p[0] - a[0], p[1] - a[1]);
    let s = ((px * dx + py * dy) / (dx * dx + dy * dy).max(1e-12)).clamp(0.0, 1.0);
    (px - s * dx).hypot(py - s * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_one_width_and_every_sign_has_a_glyph() {
        let fonts = Fonts::embedded();
        let width = |t| fonts.width(t, 12.0, Weight::Regular);
        assert_eq!(width("1111"), width("8888"));
        for c in "AZaz09 °·×±²³µ–—−≥≤→√εσατ%()/".chars() {
            assert_ne!(fonts.regular.glyph_id(c).0, 0, "{c}");
            assert_ne!(fonts.bold.glyph_id(c).0, 0, "{c}");
        }
    }

    #[test]
    fn overlapping_pieces_of_a_line_blend_once() {
        let fonts = Fonts::embedded();
        let mut canvas = Canvas { image: RgbImage::new(20, 20), fonts: &fonts, unit: 1.0 };
        canvas.polyline(&[[2.0, 10.0], [10.0, 10.0], [18.0, 10.0]], 4.0, [200; 3], 0.5);
        assert_eq!(canvas.image.get_pixel(10, 10), canvas.image.get_pixel(5, 10));
        assert_eq!(canvas.image.get_pixel(10, 2).0, [0; 3]);
    }
}
