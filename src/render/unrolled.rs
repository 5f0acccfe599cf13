//! The strand unrolled: one row per wire, outermost layer on top, along the axial position before loading. Shows at a
//! glance where each wire broke and in which order.

use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::colour::desaturated;
use super::data::Data;
use super::labels::{self, Mark};
use super::marks;
use super::panel::Panel;
use super::style::Rgb;
use crate::base::ticks::{label, ticks};
use crate::base::units::mm;
use crate::engine::view::{BondState, WireInfo};
use crate::observe::unrolled;

/// Breaks nearer together than this, in units, are numbered as one group: beside it there must be room for the
/// columns of the next.
const GROUP: f32 = 240.0;

/// The panel.
pub struct Unrolled;

impl Panel for Unrolled {
    fn draw(&self, canvas: &mut Canvas, panel: Rect, data: &Data) {
        let u = canvas.unit;
        canvas.fill(panel, data.style.panel, 1.0);
        let x = marks::title(canvas, panel, data, "wires unrolled");
        marks::subtitle(canvas, x, panel, data, "breaks, in their order");
        let rows = rows(panel.inset(76.0 * u, 42.0 * u, 18.0 * u, 38.0 * u), data, u);
        for (number, wire) in data.info.wires.iter().enumerate() {
            row(canvas, &rows, rows.top(number), wire, data);
        }
        layers(canvas, panel, &rows, data);
        axis(canvas, &rows, data);
        numbers(canvas, &rows, data);
        breaks(canvas, &rows, data);
    }
}

/// Rows of the map.
struct Rows {
    map: unrolled::Unrolled,
    area: Rect,
    height: f32,
}

impl Rows {
    fn x(&self, z_mm: f64) -> f32 {
        let [low, high] = self.map.ends;
        self.area.x + self.area.w * ((z_mm - low) / (high - low)) as f32
    }

    /// x of a particle before loading.
    fn x_of(&self, data: &Data, particle: usize) -> f32 {
        self.x(mm(data.info.rest_position[particle][2].into()))
    }

    /// Top of a wire's row (px).
    fn top(&self, wire: usize) -> f32 {
        self.area.y + self.height * (self.map.row[wire] - 0.5) as f32
    }
}

fn rows(area: Rect, data: &Data, unit: f32) -> Rows {
    let map = unrolled::Unrolled::new(data.info, 1.2, (0..data.info.layers.len()).rev());
    let height = (area.h / map.rows.max(1.0) as f32).min(34.0 * unit);
    // Few wires do not fill the panel: the axis then follows the last row.
    let area = Rect { h: (map.rows as f32 * height).min(area.h), ..area };
    Rows { map, area, height }
}

fn row(canvas: &mut Canvas, rows: &Rows, top: f32, wire: &WireInfo, data: &Data) {
    let shown = |i: usize| {
        if data.info.in_grip(i) { desaturated(data.colours[i]) } else { data.colours[i] }
    };
    let gap = if rows.height >= 4.0 * canvas.unit { 0.16 * rows.height } else { 0.0 };
    for i in wire.bonds() {
        if !data.snapshot.bond_state[i].holds() {
            continue;
        }
        let [x0, x1] = [i, i + 1].map(|i| rows.x_of(data, i));
        let colour = mixed(shown(i), shown(i + 1));
        // Whole columns, each of exactly one bond: no seams between neighbours.
        let (from, to) = (x0.min(x1).round(), x0.max(x1).round());
        canvas.fill(Rect::new(from, top, to - from, rows.height - gap), colour, 1.0);
    }
}

fn mixed(a: Rgb, b: Rgb) -> Rgb {
    std::array::from_fn(|k| ((u16::from(a[k]) + u16::from(b[k])) / 2) as u8)
}

fn layers(canvas: &mut Canvas, panel: Rect, rows: &Rows, data: &Data) {
    let u = canvas.unit;
    let name = Type { size: 12.0 * u, weight: Weight::Bold, colour: data.style.text, align: Align::Left };
    let detail = Type { size: 10.5 * u, weight: Weight::Regular, colour: data.style.muted, align: Align::Left };
    let x = panel.x + 12.0 * u;
    for layer in &rows.map.layers {
        let middle = rows.area.y + rows.height * layer.row as f32;
        canvas.text(x, middle - u, name, &data.info.layers[layer.layer]);
        canvas.text(x, middle + 12.0 * u, detail, &layer.numbers());
    }
}

fn axis(canvas: &mut Canvas, rows: &Rows, data: &Data) {
    let u = canvas.unit;
    let small = Type { size: 11.0 * u, weight: Weight::Regular, colour: data.style.muted, align: Align::Centre };
    let [low, high] = rows.map.ends;
    let marks = ticks(low, high, 8);
    let bottom = rows.area.bottom();
    for value in marks.values {
        let x = rows.x(value);
        canvas.fill(Rect::new((x - 0.5 * u).round(), bottom, u.max(1.0), 4.0 * u), data.style.muted, 1.0);
        canvas.text(x, bottom + 16.0 * u, small, &label(value, marks.decimals));
    }
    let kind = Type { align: Align::Right, colour: data.style.text, ..small };
    canvas.text(rows.area.right(), bottom + 31.0 * u, kind, "axial position before loading (mm)");
    if let Some(faces) = rows.map.grips {
        for z in faces {
            let x = rows.x(z);
            canvas.fill(Rect::new(x - 0.5 * u, rows.area.y - 4.0 * u, u, rows.area.h + 4.0 * u), data.style.text, 0.5);
        }
        let middle = |a: f64, b: f64| 0.5 * (rows.x(a) + rows.x(b));
        for x in [middle(low, faces[0]), middle(faces[1], high)] {
            canvas.text(x, rows.area.y - 5.0 * u, Type { size: 10.0 * u, ..small }, "grip");
        }
    }
}

fn breaks(canvas: &mut Canvas, rows: &Rows, data: &Data) {
    let u = canvas.unit;
    for (number, wire) in data.info.wires.iter().enumerate() {
        for i in wire.bonds() {
            if data.snapshot.bond_state[i] == BondState::Broken {
                let x = 0.5 * (rows.x_of(data, i) + rows.x_of(data, i + 1));
                let reach = 0.5 * rows.height.max(9.0 * u);
                let middle = rows.top(number) + 0.45 * rows.height;
                marks::broken(canvas, Rect::new(x - 2.5 * u, middle - reach, 5.0 * u, 2.0 * reach), data);
            }
        }
    }
}

/// Order numbers of the wires' first breaks, in columns to the left and right of each group of breaks, on lines to
/// their places.
fn numbers(canvas: &mut Canvas, rows: &Rows, data: &Data) {
    let u = canvas.unit;
    let mut places: Vec<Mark> = data
        .first_breaks()
        .map(|(number, r)| {
            let at = [rows.x(mm(r.rest_z)), rows.top(r.wire) + 0.45 * rows.height];
            Mark { number, words: [data.words(number, r, true), String::new()], at }
        })
        .collect();
    places.sort_by(|a, b| a.at[0].total_cmp(&b.at[0]));
    for group in places.chunk_by(|a, b| b.at[0] - a.at[0] < GROUP * u) {
        let (left, right) = group.split_at(group.len() / 2);
        column(canvas, rows, data, left, false);
        column(canvas, rows, data, right, true);
    }
}

/// A column of numbers beside a group of breaks.
fn column(canvas: &mut Canvas, rows: &Rows, data: &Data, marks: &[Mark], right: bool) {
    let u = canvas.unit;
    let (size, h) = (10.5 * u, 13.0 * u);
    let width = |m: &Mark| canvas.fonts.width(&m.words[0], size, Weight::Bold);
    let w = marks.iter().map(width).fold(0.0, f32::max) + 8.0 * u;
    let reach = marks.iter().map(|m| if right { m.at[0] } else { -m.at[0] }).fold(f32::MIN, f32::max);
    let distance = reach + 14.0 * u;
    // Against the ends of the map, numbers rather cover a break than leave it.
    let left = if right { distance } else { -distance - w }.clamp(rows.area.x, rows.area.right() - w);
    // As many as can be read, the first ones, closer together the more they are.
    let [low, high] = [rows.area.y - 0.3 * h, rows.area.bottom() + 0.3 * h];
    let mut marks: Vec<&Mark> = marks.iter().collect();
    marks.sort_by_key(|m| m.number);
    marks.truncate(((high - low) / (0.8 * h)) as usize + 1);
    marks.sort_by(|a, b| a.at[1].total_cmp(&b.at[1]));
    let pitch = (h + u).min((high - low) / marks.len().saturating_sub(1).max(1) as f32);
    let h = h.min(pitch);
    let wanted: Vec<f32> = marks.iter().map(|m| m.at[1]).collect();
    let levels = labels::spread(&wanted, pitch, low, high);
    let near = if right { left } else { left + w };
    for (mark, y) in marks.iter().zip(&levels) {
        canvas.line([near, *y], mark.at, 1.1 * u, data.style.text, 0.85);
    }
    for (mark, y) in marks.iter().zip(levels) {
        canvas.fill_rounded(Rect::new(left, y - 0.5 * h, w, h), 3.0 * u, data.style.page, 0.88);
        // The first break is what people look for; filled with the signal colour its label would look like a break itself.
        if mark.number == 1 {
            canvas.fill(Rect::new(left, y - 0.5 * h, 3.0 * u, h), data.style.signal, 1.0);
        }
        let kind = Type { size, weight: Weight::Bold, colour: data.style.text, align: Align::Centre };
        canvas.text(left + 0.5 * w, y + 0.36 * size, kind, &mark.words[0]);
    }
}
