//! Stress–strain curve so far, with the current point and a tick per rupture.

use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::frame::Data;
use super::marks;
use super::ticks::{Ticks, label, ticks};

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
    fn point(&self, strain_percent: f64, stress_mpa: f64) -> [f32; 2] {
        let part = |v: f64, r: [f64; 2]| ((v - r[0]) / (r[1] - r[0])) as f32;
        let x = self.area.x + self.area.w * part(strain_percent, self.x.range);
        [x, self.area.bottom() - self.area.h * part(stress_mpa, self.y.range)]
    }
}

/// Draws the panel.
pub fn draw(canvas: &mut Canvas, panel: Rect, data: &Data) {
    let u = canvas.unit;
    canvas.fill(panel, data.style.panel, 1.0);
    marks::title(canvas, panel, data, "nominal stress (MPa)");
    let axes = axes(panel.inset(46.0 * u, 32.0 * u, 18.0 * u, 40.0 * u), data);
    grid(canvas, &axes, data);
    let kind = Type { size: 11.0 * u, weight: Weight::Regular, colour: data.style.text, align: Align::Right };
    canvas.text(axes.area.right(), panel.bottom() - 9.0 * u, kind, "nominal strain (%)");
    ruptures(canvas, &axes, data);
    let points = thinned(data.curve.iter().map(|(e, s)| axes.point(e * 100.0, s / 1e6)));
    canvas.polyline(&points, 2.0 * u, data.style.accent, 1.0);
    current(canvas, &axes, data);
}

fn axes(area: Rect, data: &Data) -> Axes {
    let seen = |f: fn(&(f64, f64)) -> f64| data.curve.iter().map(f).fold(0.0, f64::max);
    let low = data.curve.iter().map(|p| p.1 / 1e6).fold(0.0, f64::min);
    let strain_end = data.info.strain_end.unwrap_or(0.0).max(seen(|p| p.0)).max(1e-6);
    // True stress over stretch is nominal stress: that bounds what the axis must hold.
    let bound = f64::from(data.info.stress_range[1]) / (1.0 + data.info.strain_end.unwrap_or(0.0));
    let top = bound.max(seen(|p| p.1) / 1e6 * 1.05).max(1e-6);
    let x = ticks(0.0, strain_end * 100.0, 7);
    let y = ticks(low, top, 6);
    let x_end = strain_end * 100.0 * 1.02;
    Axes { area, x: Axis { range: [0.0, x_end], ticks: x }, y: Axis { range: [low, top * 1.04], ticks: y } }
}

fn grid(canvas: &mut Canvas, axes: &Axes, data: &Data) {
    let u = canvas.unit;
    let area = axes.area;
    let small = Type { size: 11.0 * u, weight: Weight::Regular, colour: data.style.muted, align: Align::Right };
    for value in &axes.y.ticks.values {
        let [_, y] = axes.point(0.0, *value);
        canvas.fill(Rect::new(area.x, (y - 0.5 * u).round(), area.w, u.max(1.0)), data.style.grid, 1.0);
        canvas.text(area.x - 7.0 * u, y + 4.0 * u, small, &label(*value, axes.y.ticks.decimals));
    }
    for value in &axes.x.ticks.values {
        let [x, _] = axes.point(*value, 0.0);
        canvas.fill(Rect::new((x - 0.5 * u).round(), area.bottom(), u.max(1.0), 4.0 * u), data.style.muted, 1.0);
        let kind = Type { align: Align::Centre, ..small };
        canvas.text(x, area.bottom() + 17.0 * u, kind, &label(*value, axes.x.ticks.decimals));
    }
}

fn ruptures(canvas: &mut Canvas, axes: &Axes, data: &Data) {
    let u = canvas.unit;
    for rupture in data.ruptures {
        let [x, _] = axes.point(rupture.strain * 100.0, 0.0);
        let height = if rupture.first_of_wire { 14.0 } else { 7.0 } * u;
        canvas.fill(Rect::new(x - 0.6 * u, axes.area.bottom() - height, 1.2 * u, height), data.style.signal, 0.9);
    }
    let Some(first) = data.ruptures.first() else {
        return;
    };
    let [x, y] = axes.point(first.strain * 100.0, first.body_stress / 1e6);
    canvas.ring(x, y, 5.0 * u, 1.8 * u, data.style.signal, 1.0);
    let kind = Type { size: 11.0 * u, weight: Weight::Bold, colour: data.style.signal, align: Align::Right };
    let text = format!("first break at {:.1} MPa", first.body_stress / 1e6);
    canvas.text(x + 6.0 * u, y - 11.0 * u, kind, &text);
}

fn current(canvas: &mut Canvas, axes: &Axes, data: &Data) {
    let u = canvas.unit;
    let sample = &data.snapshot.sample;
    let [x, y] = axes.point(sample.strain * 100.0, sample.stress / 1e6);
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
