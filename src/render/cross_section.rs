//! The cut across the strand at the section in view: wires as discs with their numbers, broken ones hollow.

use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::data::Data;
use super::marks;
use super::panel::Panel;
use super::style::Rgb;
use crate::engine::view::{BondState, WireInfo};

/// The panel: the cut at the section in view, looking down from the upper grip.
pub struct CrossSection;

impl Panel for CrossSection {
    fn draw(&self, canvas: &mut Canvas, panel: Rect, data: &Data) {
        let u = canvas.unit;
        canvas.fill(panel, data.style.panel, 1.0);
        let x = marks::title(canvas, panel, data, "section");
        marks::subtitle(canvas, x, panel, data, "broken: hollow");
        let area = panel.inset(8.0 * u, 28.0 * u, 8.0 * u, 8.0 * u);
        // A tenth of room around the strand for wires that sprang out.
        let scale = 0.5 * area.w.min(area.h) / (1.15 * data.body.radius);
        let middle = [area.x + 0.5 * area.w, area.y + 0.5 * area.h];
        let z = data.current_z(data.focus());
        for (number, wire) in data.info.wires.iter().enumerate() {
            let (i, [x, y], radius) = cut(data, wire, z);
            let r = radius * scale;
            let x = middle[0] + (x - data.body.axis.x) * scale;
            let y = middle[1] - (y - data.body.axis.y) * scale;
            let reach = area.inset(r, r, r, r);
            let [x, y] = [x.clamp(reach.x, reach.right()), y.clamp(reach.y, reach.bottom())];
            let ink = if broken(data, wire) {
                let line = (0.22 * r).max(1.5 * u);
                canvas.ring(x, y, r - 0.5 * line, line, data.style.signal, 1.0);
                data.style.text
            } else {
                canvas.disc(x, y, r, data.colours[i], 1.0);
                ink_on(data.colours[i])
            };
            if r > 7.0 * u {
                let size = (0.85 * r).min(13.0 * u);
                let kind = Type { size, weight: Weight::Regular, colour: ink, align: Align::Centre };
                canvas.text(x, y + 0.36 * size, kind, &(number + 1).to_string());
            }
        }
    }
}

/// Whether any bond of the wire is broken.
fn broken(data: &Data, wire: &WireInfo) -> bool {
    data.snapshot.bond_state[wire.bonds()].contains(&BondState::Broken)
}

/// Where a wire passes through the cut: its nearest particle, x and y (m) and radius (m), straight between the two particles
/// on either side. A wire that does not reach the cut is shown by its nearest particle.
fn cut(data: &Data, wire: &WireInfo, z: f32) -> (usize, [f32; 2], f32) {
    let snapshot = &data.snapshot;
    let above = |i: usize| snapshot.position[i][2] - z;
    let passes = |i: usize| above(i).min(above(i + 1)) <= 0.0 && above(i).max(above(i + 1)) > 0.0;
    let whole = |bond: usize| snapshot.bond_state[bond] != BondState::Broken;
    match wire.bonds().zip(wire.particles()).find(|(bond, i)| whole(*bond) && passes(*i)) {
        Some((_, i)) => {
            let share = above(i) / (above(i) - above(i + 1));
            let between = |a: f32, b: f32| a + share * (b - a);
            let [[x0, y0, _], [x1, y1, _]] = [snapshot.position[i], snapshot.position[i + 1]];
            let radius = between(snapshot.radius[i], snapshot.radius[i + 1]);
            (if share < 0.5 { i } else { i + 1 }, [between(x0, x1), between(y0, y1)], radius)
        }
        None => {
            let i = wire.particles().min_by(|a, b| above(*a).abs().total_cmp(&above(*b).abs())).unwrap_or(wire.first);
            let [x, y, _] = snapshot.position[i];
            (i, [x, y], snapshot.radius[i])
        }
    }
}

/// Black or white, whichever reads better on `colour`.
fn ink_on(colour: Rgb) -> Rgb {
    let [r, g, b] = colour.map(f32::from);
    if 0.299 * r + 0.587 * g + 0.114 * b > 120.0 { [16, 18, 22] } else { [240, 242, 246] }
}
