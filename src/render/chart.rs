//! A chart of one curve so far, with axes and the current point.

use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::data::Data;
use crate::base::ticks::{Ticks, label, ticks};

/// Points of a curve up to which each is marked.
const SINGLE: usize = 120;

/// What is charted.
pub struct Chart {
    /// What stands along the horizontal axis, with its unit.
    pub across: &'static str,
    /// Points so far.
    pub points: Vec<[f64; 2]>,
    /// The present one.
    pub now: [f64; 2],
    /// Ranges that both axes show at least.
    pub holds: [[f64; 2]; 2],
}

/// A plot area with its axes.
pub struct Axes {
    /// The area (px).
    pub area: Rect,
    x: Axis,
    y: Axis,
}

struct Axis {
    range: [f64; 2],
    ticks: Ticks,
}

impl Axes {
    /// Pixel of a place in the chart.
    pub fn point(&self, [across, up]: [f64; 2]) -> [f32; 2] {
        let part = |v: f64, r: [f64; 2]| ((v - r[0]) / (r[1] - r[0])) as f32;
        let x = self.area.x + self.area.w * part(across, self.x.range);
        [x, self.area.bottom() - self.area.h * part(up, self.y.range)]
    }
}

impl Chart {
    /// Draws axes and grid into `panel` (px).
    pub fn axes(&self, canvas: &mut Canvas, panel: Rect, data: &Data) -> Axes {
        let u = canvas.unit;
        let area = panel.inset(46.0 * u, 32.0 * u, 18.0 * u, 40.0 * u);
        let seen = self.points.iter().chain([&self.now]);
        let [x, y] = seen.fold(self.holds, |mut ranges, p| {
            for (range, value) in ranges.iter_mut().zip(p) {
                *range = [range[0].min(*value), range[1].max(*value)];
            }
            ranges
        });
        // A little room beyond the ends that are not zero.
        let axis = |[low, high]: [f64; 2], count: usize, room: f64| {
            let more = room * (high - low).max(1e-12);
            let range = [if low < 0.0 { low - more } else { low }, high + more];
            Axis { range, ticks: ticks(low, high.max(low + 1e-12), count) }
        };
        let axes = Axes { area, x: axis(x, 7, 0.02), y: axis(y, 6, 0.04) };
        self.grid(canvas, &axes, panel, data);
        axes
    }

    fn grid(&self, canvas: &mut Canvas, axes: &Axes, panel: Rect, data: &Data) {
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
        let kind = Type { colour: data.style.text, ..small };
        canvas.text(area.right(), panel.bottom() - 9.0 * u, kind, self.across);
    }

    /// Draws the curve and its present point.
    pub fn curve(&self, canvas: &mut Canvas, axes: &Axes, data: &Data) {
        let u = canvas.unit;
        let points = thinned(self.points.iter().map(|p| axes.point(*p)));
        canvas.polyline(&points, 2.0 * u, data.style.accent, 1.0);
        // Few points: each is seen, and that nothing is known between them.
        if self.points.len() <= SINGLE {
            points.iter().for_each(|[x, y]| canvas.disc(*x, *y, 2.4 * u, data.style.accent, 1.0));
        }
        let [x, y] = axes.point(self.now);
        canvas.disc(x, y, 5.5 * u, data.style.panel, 1.0);
        canvas.disc(x, y, 4.0 * u, data.style.accent, 1.0);
    }
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
