//! The curve of a run so far: stress over strain with a tick per rupture, or what tells most where nothing is pulled.

use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::chart::{Axes, Chart};
use super::data::Data;
use super::kind::Kind;
use super::marks;
use super::panel::Panel;
use crate::base::units::newton_mm;
use crate::observe::stress_strain::{STRAIN, STRESS, expected, mark, place};

/// The panel.
pub struct Curve;

impl Panel for Curve {
    fn draw(&self, canvas: &mut Canvas, panel: Rect, data: &Data) {
        canvas.fill(panel, data.style.panel, 1.0);
        let (title, chart) = chart(data);
        let x = marks::title(canvas, panel, data, title);
        if Kind::of(data.info) == Kind::Collision {
            marks::subtitle(canvas, x, panel, data, "above 0 they touch");
        }
        let axes = chart.axes(canvas, panel, data);
        if title == STRESS {
            ruptures(canvas, &axes, data);
        }
        chart.curve(canvas, &axes, data);
    }
}

/// What is charted, and its title.
fn chart(data: &Data) -> (&'static str, Chart) {
    let sample = &data.snapshot.sample;
    match Kind::of(data.info) {
        Kind::Pulled => (STRESS, stress_strain(data)),
        // Grips that turn but do not pull leave no strain.
        Kind::Held if data.rows.iter().any(|row| row.strain != 0.0) => (STRESS, stress_strain(data)),
        Kind::Held => {
            let rows = data.rows.iter().map(|row| [row.time, newton_mm(row.torque)]);
            ("torque (N mm)", over_time(rows, [sample.time, newton_mm(sample.torque)]))
        }
        kind => {
            let (title, factor) = match kind {
                Kind::Bent => ("greatest deflection (mm)", 1e3),
                Kind::Collision => ("approach of the spheres (µm)", 1e6),
                _ => ("greatest speed (m/s)", 1.0),
            };
            let points = data.measured.iter().map(|[time, value]| [*time, factor * value]);
            let now = kind.measure(data.info, data.snapshot).map_or(0.0, |value| factor * value);
            (title, over_time(points, [sample.time, now]))
        }
    }
}

fn stress_strain(data: &Data) -> Chart {
    let sample = &data.snapshot.sample;
    let [end, bound] = expected(data.info);
    // Where the end is not known the curve decides alone.
    let [low, high] = [end.min(0.0), end.max(1e-4)];
    Chart {
        across: STRAIN,
        points: data.rows.iter().map(|row| place(row.strain, row.stress)).collect(),
        now: place(sample.strain, sample.stress),
        holds: [[low, high], [0.0, bound.max(1e-6)]],
    }
}

/// A chart over time (s), in the unit that fits how long the run is so far.
fn over_time(points: impl Iterator<Item = [f64; 2]>, now: [f64; 2]) -> Chart {
    let end = round_end(now[0].max(1e-9));
    let (across, factor) = match end {
        end if end >= 1.0 => ("time (s)", 1.0),
        end if end >= 1e-3 => ("time (ms)", 1e3),
        _ => ("time (µs)", 1e6),
    };
    let scaled = |[time, value]: [f64; 2]| [factor * time, value];
    let points: Vec<[f64; 2]> = points.map(scaled).collect();
    // So flat a curve is nothing: it must not fill the chart with rounding.
    Chart { across, points, now: scaled(now), holds: [[0.0, factor * end], [0.0, 1e-6]] }
}

/// The next round number: an axis that ends there grows rarely.
fn round_end(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let round = [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0].map(|factor| factor * power);
    round.into_iter().find(|end| *end >= value * (1.0 - 1e-3)).unwrap_or(value)
}

fn ruptures(canvas: &mut Canvas, axes: &Axes, data: &Data) {
    let u = canvas.unit;
    for rupture in data.ruptures {
        let [x, _] = axes.point(mark(rupture));
        let height = if rupture.first_of_wire { 14.0 } else { 7.0 } * u;
        canvas.fill(Rect::new(x - 0.6 * u, axes.area.bottom() - height, 1.2 * u, height), data.style.signal, 0.9);
    }
    let Some((number, first)) = data.first_breaks().next() else {
        return;
    };
    let at @ [strain, stress] = mark(first);
    let [x, y] = axes.point(at);
    canvas.ring(x, y, 5.0 * u, 1.8 * u, data.style.signal, 1.0);
    let kind = Type { size: 11.0 * u, weight: Weight::Bold, colour: data.style.signal, align: Align::Right };
    let what = data.words(number, first, true);
    canvas.text(x + 6.0 * u, y - 11.0 * u, kind, &format!("first break, {what}: {strain:.2} %, {stress:.1} MPa"));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_of_a_time_axis_are_round_and_hold_the_time() {
        assert_eq!(
            [3.0001e-3, 0.9e-3, 1.2].map(round_end).map(|end| format!("{end:.4}")),
            ["0.0030", "0.0010", "1.5000"]
        );
        for k in 1..200 {
            let value = 1.07f64.powi(k) * 1e-7;
            let end = round_end(value);
            assert!(end >= 0.999 * value && end < 1.6 * value, "{value} {end}");
        }
    }
}
