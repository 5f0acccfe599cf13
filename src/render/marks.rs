//! What is written over panels of every kind: titles and scale bars.

use super::camera::Camera;
use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::data::Data;
use crate::base::ticks::{label, round_step};
use crate::base::units::mm;

/// Title in the panel's top left corner; returns where it ends (px).
pub fn title(canvas: &mut Canvas, panel: Rect, data: &Data, text: &str) -> f32 {
    let u = canvas.unit;
    let kind = Type { size: 12.0 * u, weight: Weight::Bold, colour: data.style.text, align: Align::Left };
    let x = panel.x + 12.0 * u;
    x + canvas.text(x, panel.y + 18.0 * u, kind, text)
}

/// A remark after the title.
pub fn subtitle(canvas: &mut Canvas, x: f32, panel: Rect, data: &Data, text: &str) {
    let u = canvas.unit;
    let kind = Type { size: 11.0 * u, weight: Weight::Regular, colour: data.style.muted, align: Align::Left };
    canvas.text(x + 9.0 * u, panel.y + 18.0 * u, kind, text);
}

/// Title and remark over a three-dimensional panel, legible also in front of wires.
pub fn title_over(canvas: &mut Canvas, panel: Rect, data: &Data, text: &str, remark: &str) {
    let u = canvas.unit;
    if text.is_empty() {
        return;
    }
    let mut w = canvas.fonts.width(text, 12.0 * u, Weight::Bold) + 12.0 * u;
    if !remark.is_empty() {
        w += canvas.fonts.width(remark, 11.0 * u, Weight::Regular) + 9.0 * u;
    }
    let ground = Rect::new(panel.x + 6.0 * u, panel.y + 4.0 * u, w, 20.0 * u);
    canvas.fill_rounded(ground, 4.0 * u, data.style.panel, 0.8);
    let x = title(canvas, panel, data, text);
    subtitle(canvas, x, panel, data, remark);
}

/// A bar of a round length in the panel's lower right corner.
pub fn scale_bar(canvas: &mut Canvas, camera: &Camera, data: &Data) {
    let u = canvas.unit;
    // The largest of 1, 2, 5 × 10^k that is at most about 120 units long.
    let longest = mm(f64::from(120.0 * u / camera.scale));
    let length = [0.5, 0.4, 0.2, 0.1].map(|f| round_step(longest * f)).into_iter().find(|l| *l <= longest);
    let length = length.unwrap_or(longest);
    let width = (length * 1e-3) as f32 * camera.scale;
    let (right, y) = (camera.panel.right() - 14.0 * u, camera.panel.bottom() - 12.0 * u);
    let left = right - width;
    let colour = data.style.text;
    let decimals = if length < 1.0 { (-length.log10()).ceil() as usize } else { 0 };
    let text = format!("{} mm", label(length, decimals));
    let text_width = canvas.fonts.width(&text, 11.0 * u, Weight::Regular);
    let ground = Rect::new(left - text_width - 12.0 * u, y - 9.0 * u, width + text_width + 18.0 * u, 18.0 * u);
    canvas.fill_rounded(ground, 4.0 * u, data.style.panel, 0.8);
    canvas.fill(Rect::new(left, y - u, width, 2.0 * u), colour, 1.0);
    for x in [left, right - 1.5 * u] {
        canvas.fill(Rect::new(x, y - 4.0 * u, 1.5 * u, 8.0 * u), colour, 1.0);
    }
    let kind = Type { size: 11.0 * u, weight: Weight::Regular, colour, align: Align::Right };
    canvas.text(left - 6.0 * u, y + 4.0 * u, kind, &text);
}
