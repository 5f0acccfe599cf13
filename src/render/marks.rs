//! What is written over panels of every kind: titles and scale bars.

use super::camera::Camera;
use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::data::Data;
use crate::base::ticks::{label, round_step};
use crate::base::units::mm;
use glam::Vec3;

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

/// The mark of a break in `place` (px): the signal colour with a light and a dark outline, told apart from any colour of
/// a wire by its brightness too.
pub fn broken(canvas: &mut Canvas, place: Rect, data: &Data) {
    let u = canvas.unit;
    canvas.fill(place.inset(-2.0 * u, -2.0 * u, -2.0 * u, -2.0 * u), data.style.page, 1.0);
    canvas.fill(place.inset(-u, -u, -u, -u), data.style.text, 1.0);
    canvas.fill(place, data.style.signal, 1.0);
}

/// A remark about the first break at the `left` or right edge of a panel, `above` its lower edge (px), with an arrow beyond
/// the edge.
pub fn aside(canvas: &mut Canvas, panel: Rect, data: &Data, text: &str, left: bool, above: f32) {
    let u = canvas.unit;
    let arrow = 9.0 * u;
    let width = canvas.fonts.width(text, 10.5 * u, Weight::Bold) + 14.0 * u + arrow;
    let x = if left { panel.x + 6.0 * u } else { panel.right() - 6.0 * u - width };
    let ground = Rect::new(x, panel.bottom() - above - 9.0 * u, width, 18.0 * u);
    canvas.fill_rounded(ground.inset(-u, -u, -u, -u), 4.0 * u, data.style.text, 1.0);
    canvas.fill_rounded(ground, 3.5 * u, data.style.signal, 1.0);
    let [tip, out] = if left { [ground.x + 4.0 * u, 1.0] } else { [ground.right() - 4.0 * u, -1.0] };
    let middle = ground.y + 9.0 * u;
    for end in [-4.0 * u, 4.0 * u] {
        canvas.line([tip, middle], [tip + out * 4.5 * u, middle + end], 1.6 * u, [255; 3], 1.0);
    }
    canvas.line([tip, middle], [tip + out * arrow, middle], 1.6 * u, [255; 3], 1.0);
    let kind = Type { size: 10.5 * u, weight: Weight::Bold, colour: [255; 3], align: Align::Left };
    let start = if left { ground.x + 8.0 * u + arrow } else { ground.x + 6.0 * u };
    canvas.text(start, ground.y + 12.8 * u, kind, text);
}

/// The three axes in the panel's lower left corner: arrows, or a dot and a cross for one that points to the eye and away from
/// it.
pub fn axes(canvas: &mut Canvas, camera: &Camera, data: &Data) {
    let u = canvas.unit;
    let panel = camera.panel;
    // A low panel shows the strand alone; the frame has others.
    if panel.h < 90.0 * u {
        return;
    }
    let length = 20.0 * u;
    let ends = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| camera.rotation * axis);
    // The box around arrows and letters about their root.
    let reach = |k: usize, sign: f32| ends.iter().map(|e| sign * e[k]).fold(0.0, f32::max) * length + 14.0 * u;
    let [left, right, up, down] = [reach(0, -1.0), reach(0, 1.0), reach(1, 1.0), reach(1, -1.0)];
    let ground = Rect::new(panel.x + 5.0 * u, panel.bottom() - 5.0 * u - up - down, left + right, up + down);
    let [x, y] = [ground.x + left, ground.y + up];
    canvas.fill_rounded(ground, 4.0 * u, data.style.panel, 0.8);
    let kind = Type { size: 10.0 * u, weight: Weight::Bold, colour: data.style.text, align: Align::Centre };
    for (name, end) in ["x", "y", "z"].iter().zip(ends) {
        let flat = end.x.hypot(end.y);
        if flat > 0.25 {
            let tip = [x + end.x * length, y - end.y * length];
            canvas.line([x, y], tip, 1.6 * u, data.style.text, 0.9);
            let beyond = 1.0 + 7.0 * u / (flat * length);
            canvas.text(x + end.x * length * beyond, y - end.y * length * beyond + 3.5 * u, kind, name);
        } else {
            canvas.disc(x, y, 4.5 * u, data.style.panel, 1.0);
            canvas.ring(x, y, 4.0 * u, 1.2 * u, data.style.text, 0.9);
            if end.z > 0.0 {
                canvas.disc(x, y, 1.4 * u, data.style.text, 1.0);
            } else {
                let d = 2.6 * u;
                canvas.line([x - d, y - d], [x + d, y + d], 1.1 * u, data.style.text, 0.9);
                canvas.line([x - d, y + d], [x + d, y - d], 1.1 * u, data.style.text, 0.9);
            }
            canvas.text(x - 9.0 * u, y + 9.0 * u, kind, name);
        }
    }
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
