//! The cut across the strand at the section in view: wires as discs with their numbers, broken ones hollow. Wires that do not
//! pass through the cut any more stand in rows below it.

use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::data::Data;
use super::marks;
use super::panel::Panel;
use super::style::Rgb;
use crate::base::units::mm;
use crate::engine::view::{BondState, WireInfo};

/// Share of the panel's height that is kept for wires that are not in the cut (-).
const BESIDE: f32 = 0.2;

/// The panel.
pub struct CrossSection;

impl Panel for CrossSection {
    fn draw(&self, canvas: &mut Canvas, panel: Rect, data: &Data) {
        let u = canvas.unit;
        canvas.fill(panel, data.style.panel, 1.0);
        let x = marks::title(canvas, panel, data, "section");
        let place = format!("{:.0} mm", mm(data.focus.z.into()));
        let words = [format!("{place} · broken: hollow"), place];
        let fits = |text: &&String| x + canvas.fonts.width(text, 11.0 * u, Weight::Regular) + 14.0 * u < panel.right();
        if let Some(text) = words.iter().find(fits) {
            marks::subtitle(canvas, x, panel, data, text);
        }
        let all = panel.inset(8.0 * u, 28.0 * u, 8.0 * u, 8.0 * u);
        let area = Rect { h: (1.0 - BESIDE) * all.h, ..all };
        // A tenth of room around the strand for wires that sprang out.
        let scale = 0.5 * area.w.min(area.h) / (1.15 * data.body.radius);
        let middle = [area.x + 0.5 * area.w, area.y + 0.5 * area.h];
        let z = data.current_z(data.focus.z);
        let (mut inside, mut beside) = (Vec::new(), Vec::new());
        for (number, wire) in data.info.wires.iter().enumerate() {
            let disc = cut(data, wire, z).map(|(particle, [x, y], radius)| {
                let x = middle[0] + (x - data.body.axis.x) * scale;
                let y = middle[1] - (y - data.body.axis.y) * scale;
                Disc { number, x, y, r: radius * scale, colour: colour(data, wire, particle) }
            });
            match disc.filter(|disc| disc.lies_in(area)) {
                Some(disc) => inside.push(disc),
                None => beside.push(Disc { number, x: 0.0, y: 0.0, r: 0.0, colour: colour(data, wire, wire.first) }),
            }
        }
        let rows = Rect { y: area.bottom(), h: BESIDE * all.h, ..all };
        in_rows(canvas, rows, data, &mut beside);
        // Broken wires over whole ones, which would hide their thin rings.
        inside.sort_by_key(|disc| disc.colour.is_none());
        for disc in inside.iter().chain(&beside) {
            disc.draw(canvas, data);
        }
        // Numbers last: no wire is drawn over the number of another.
        for disc in inside.iter().chain(&beside) {
            disc.number(canvas, data);
        }
    }
}

/// A wire in the picture, all in (px).
struct Disc {
    /// Number of the wire, from 0.
    number: usize,
    x: f32,
    y: f32,
    r: f32,
    /// `None` for a broken wire.
    colour: Option<Rgb>,
}

impl Disc {
    fn lies_in(&self, area: Rect) -> bool {
        let inner = area.inset(self.r, self.r, self.r, self.r);
        (inner.x..=inner.right()).contains(&self.x) && (inner.y..=inner.bottom()).contains(&self.y)
    }

    fn draw(&self, canvas: &mut Canvas, data: &Data) {
        let u = canvas.unit;
        match self.colour {
            Some(colour) => canvas.disc(self.x, self.y, self.r, colour, 1.0),
            None => {
                let line = (0.2 * self.r).max(1.5 * u);
                canvas.disc(self.x, self.y, self.r, data.style.panel, 0.75);
                canvas.ring(self.x, self.y, self.r - 0.5 * line, line, data.style.signal, 1.0);
                canvas.ring(self.x, self.y, self.r, u, data.style.text, 1.0);
            }
        }
    }

    fn number(&self, canvas: &mut Canvas, data: &Data) {
        let u = canvas.unit;
        if self.r > 5.0 * u {
            let size = (0.85 * self.r).clamp(8.0 * u, 13.0 * u);
            let colour = self.colour.map_or(data.style.text, ink_on);
            let kind = Type { size, weight: Weight::Regular, colour, align: Align::Centre };
            canvas.text(self.x, self.y + 0.36 * size, kind, &(self.number + 1).to_string());
        }
    }
}

/// Puts wires that the cut does not meet in rows, in the order of their numbers, and says what they are.
fn in_rows(canvas: &mut Canvas, area: Rect, data: &Data, discs: &mut [Disc]) {
    let u = canvas.unit;
    if discs.is_empty() {
        return;
    }
    let kind = Type { size: 10.5 * u, weight: Weight::Regular, colour: data.style.muted, align: Align::Left };
    canvas.text(area.x + 4.0 * u, area.y + 8.0 * u, kind, "not in this section");
    let area = area.inset(2.0 * u, 13.0 * u, 2.0 * u, 0.0);
    // The largest discs that all find room.
    let rows = (1..).find(|rows| {
        let pitch = area.h / *rows as f32;
        (area.w / pitch).floor() as usize * rows >= discs.len()
    });
    let pitch = (area.h / rows.unwrap_or(1) as f32).min(28.0 * u);
    let per_row = ((area.w / pitch) as usize).max(1);
    for (k, disc) in discs.iter_mut().enumerate() {
        disc.x = area.x + ((k % per_row) as f32 + 0.5) * pitch;
        disc.y = area.y + ((k / per_row) as f32 + 0.5) * pitch;
        disc.r = 0.44 * pitch;
    }
}

/// Colour of a wire at one of its particles; `None` where any of its bonds is broken.
fn colour(data: &Data, wire: &WireInfo, particle: usize) -> Option<Rgb> {
    let broken = data.snapshot.bond_state[wire.bonds()].contains(&BondState::Broken);
    (!broken).then(|| data.colours[particle])
}

/// Where a wire passes through the cut: its nearest particle, x and y (m) and radius (m), straight between the two particles
/// on either side.
fn cut(data: &Data, wire: &WireInfo, z: f32) -> Option<(usize, [f32; 2], f32)> {
    let snapshot = &data.snapshot;
    let above = |i: usize| snapshot.position[i][2] - z;
    let passes = |i: usize| above(i).min(above(i + 1)) <= 0.0 && above(i).max(above(i + 1)) > 0.0;
    let (_, i) =
        wire.bonds().zip(wire.particles()).find(|(bond, i)| snapshot.bond_state[*bond].holds() && passes(*i))?;
    let share = above(i) / (above(i) - above(i + 1));
    let between = |a: f32, b: f32| a + share * (b - a);
    let [[x0, y0, _], [x1, y1, _]] = [snapshot.position[i], snapshot.position[i + 1]];
    let radius = between(snapshot.radius[i], snapshot.radius[i + 1]);
    Some((if share < 0.5 { i } else { i + 1 }, [between(x0, x1), between(y0, y1)], radius))
}

/// Black or white, whichever reads better on `colour`.
fn ink_on(colour: Rgb) -> Rgb {
    let [r, g, b] = colour.map(f32::from);
    if 0.299 * r + 0.587 * g + 0.114 * b > 120.0 { [16, 18, 22] } else { [240, 242, 246] }
}
