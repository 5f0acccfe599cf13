//! Stress–strain curve so far, with the current point and a tick per rupture.

use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::data::Data;
use super::marks;
use super::panel::Panel;
use crate::base::ticks::{Ticks, label, ticks};
use crate::observe::stress_strain::{STRAIN, STRESS, expected, mark, place};

/// The panel.
pub struct Curve;

impl Panel for Curve {
    fn draw(&self, canvas: &mut Canvas, panel: Rect, data: &Data) {
        let u = canvas.unit;
        canvas.fill(panel, data.style.panel, 1.0);
        marks::title(canvas, panel, data, STRESS);
        let axes = axes(panel.inset(46.0 * u, 32.0 * u, 18.0 * u, 40.0 * u), data);
        grid(canvas, &axes, data);
        let kind = Type { size: 11.0 * u, weight: Weight::Regular, colour: data.style.text, align: Align::Right };
        canvas.text(axes.area.right(), panel.bottom() - 9.0 * u, kind, STRAIN);
        ruptures(canvas, &axes, data);
        let points = thinned(data.curve.iter().map(|(e, s)| axes.point(place(*e, *s))));
        canvas.polyline(&points, 2.0 * u, data.style.accent, 1.0);
        current(canvas, &axes, data);
    }
}

/// A plot area with its axes.
struct Axes {
    area: Rect,
    x: Axis,
    y: Axis,
}

struct Axis {
    range: [f64; 2],
    ticks: Ticks,
}

impl Axes {
    /// Pixel of a place in the chart.
    fn point(&self, [strain, stress]: [f64; 2]) -> [f32; 2] {
        let part = |v: f64, r: [f64; 2]| ((v - r[0]) / (r[1] - r[0])) as f32;
        let x = self.area.x + self.area.w * part(strain, self.x.range);
        [x, self.area.bottom() - self.area.h * part(stress, self.y.range)]
    }
}

fn axes(area: Rect, data: &Data) -> Axes {
    let [strain_end, bound] = expected(data.info);
    let seen = data.curve.iter().map(|(e, s)| place(*e, *s));
    let [end, low, highest] =
        seen.fold([strain_end, 0.0, 0.0], |[end, low, high], [e, s]| [end.max(e), low.min(s), high.max(s)]);
    let (end, top) = (end.max(1e-4), bound.max(1.05 * highest).max(1e-6));
    let x = Axis { range: [0.0, end * 1.02], ticks: ticks(0.0, end, 7) };
    let y = Axis { range: [low, top * 1.04], ticks: ticks(low, top, 6) };
    Axes { area, x, y }
}

fn grid(canvas: &mut Canvas, axes: &Axes, data: &Data) {
    let u = canvas.unit;
    let area = axes.area;
    let small = Type { size: 11.0 * u, weight: Weight::Regular, colour: data.style.muted, align: Align::Right };
    for value in &axes.y.ticks.values {
        let [_, y] = axes.point([0.0, *value]);
        canvas.fill(Rect::new(area.x, (y - 0.5 * u).round(), area.w, u.max(1.0)), data.style.grid, 1.0);
        canvas.text(area.x - 7.0 * u, y + 4.0 * u, small, &label(*value, axes.y.ticks.decimals));
    }
    for value in &axes.x.ticks.values {
        let [x, _] = axes.point([*value, 0.0]);
        canvas.fill(Rect::new((x - 0.5 * u).round(), area.bottom(), u.max(1.0), 4.0 * u), data.style.muted, 1.0);
        let kind = Type { align: Align::Centre, ..small };
        canvas.text(x, area.bottom() + 17.0 * u, kind, &label(*value, axes.x.ticks.decimals));
    }
}

fn ruptures(canvas: &mut Canvas, axes: &Axes, data: &Data) {
    let u = canvas.unit;
    for rupture in data.ruptures {
        let [x, _] = axes.point(mark(rupture));
        let height = if rupture.first_of_wire { 14.0 } else { 7.0 } * u;
        canvas.fill(Rect::new(x - 0.6 * u, axes.area.bottom() - height, 1.2 * u, height), data.style.signal, 0.9);
    }
    let Some(first) = data.ruptures.first() else {
        return;
    };
    let at = mark(first);
    let [x, y] = axes.point(at);
    canvas.ring(x, y, 5.0 * u, 1.8 * u, data.style.signal, 1.0);
    let kind = Type { size: 11.0 * u, weight: Weight::Bold, colour: data.style.signal, align: Align::Right };
    let text = format!("first break at {:.1} MPa", at[1]);
    canvas.text(x + 6.0 * u, y - 11.0 * u, kind, &text);
}

fn current(canvas: &mut Canvas, axes: &Axes, data: &Data) {
    let u = canvas.unit;
    let sample = &data.snapshot.sample;
    let [x, y] = axes.point(place(sample.strain, sample.stress));
    canvas.disc(x, y, 5.5 * u, data.style.panel, 1.0);
    canvas.disc(x, y, 4.0 * u, data.style.accent, 1.0);
}

/// Points closer together than a third of a pixel are left out, except the last.
fn thinned(points: impl Iterator<Item = [f32; 2]>) -> Vec<[f32; 2]> {
    let mut kept: Vec<[f32; 2]> = Vec::new();
    let mut skipped = None;
    for p in points {
        match kept.last() {
            Some(l) if (l[0] - p[0]).hypot(l[1] - p[1]) < 0.33 => skipped = Some(p),
            _ => {
                kept.push(p);
                skipped = None;
            }
        }
    }
    kept.extend(skipped);
    kept
}
