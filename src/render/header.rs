//! Caption and colour bar.

use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::colour::ColourScale;
use super::data::Data;
use super::kind::{Kind, approach, contact_force, most_deflected};
use super::marks;
use crate::base::ticks::{label, ticks};
use crate::base::units::{mm, mpa, ms, newton_mm, percent};
use crate::base::wording::counted;
use crate::engine::view::RunInfo;
use crate::observe::wording::{FIRST_BREAK, wire_number};
use crate::scene::spec::ColourBy;

/// Draws the header into `area`.
pub fn draw(canvas: &mut Canvas, area: Rect, data: &Data) {
    let u = canvas.unit;
    let x = name(canvas, area, data);
    let mut x = x.max(area.x + 176.0 * u);
    let bar = Rect::new(area.right() - 292.0 * u, area.y, 272.0 * u, area.h);
    for block in caption(data) {
        let width = block_width(canvas, &block);
        // A narrow frame or a long name leaves no room: better nothing than text over text.
        if x + width > bar.x - 10.0 * u {
            break;
        }
        draw_block(canvas, x, area.y, data, &block);
        x += width + 20.0 * u;
    }
    match data.scale.shown_range() {
        Some(_) if data.info.wires.is_empty() && data.scale.by() != ColourBy::Velocity => (),
        Some(range) => colour_bar(canvas, bar, data, range),
        None => legend(canvas, bar, data),
    }
}

/// A block of the caption.
struct Block {
    what: String,
    value: String,
    detail: String,
    /// Size of the value in units.
    size: f32,
    /// It tells of the first break.
    signal: bool,
}

impl Block {
    fn new(what: &str, value: String, detail: String) -> Self {
        Self { what: what.to_owned(), value, detail, size: 17.0, signal: false }
    }
}

fn caption(data: &Data) -> Vec<Block> {
    let sample = &data.snapshot.sample;
    let time = time_text(sample.time);
    let clock = Block::new("time", time.clone(), format!("step {}", sample.step));
    match Kind::of(data.info) {
        Kind::Pulled => {
            let strain = format!("{} %", label(percent(sample.strain), 2));
            let mut blocks = vec![
                Block::new("strain", strain, format!("at {time}")),
                Block::new("nominal stress", format!("{} MPa", label(mpa(sample.stress), 1)), String::new()),
            ];
            blocks.extend(broken(data));
            blocks
        }
        Kind::Held => {
            let mut blocks = vec![
                clock,
                Block::new("torque", format!("{} N mm", label(newton_mm(sample.torque), 2)), String::new()),
            ];
            if data.rows.iter().any(|row| row.strain != 0.0) {
                blocks.push(Block::new("strain", format!("{} %", label(percent(sample.strain), 2)), String::new()));
                let stress = format!("{} MPa", label(mpa(sample.stress), 1));
                blocks.push(Block::new("nominal stress", stress, String::new()));
            }
            blocks.extend(broken(data).into_iter().filter(|_| !data.ruptures.is_empty()));
            blocks
        }
        Kind::Bent => {
            let deflection = most_deflected(data.info, data.snapshot).map_or(0.0, |(_, by)| mm(by));
            let most = Block::new("greatest deflection", format!("{} mm", label(deflection, 3)), String::new());
            let mut blocks = vec![clock, most];
            blocks.extend(broken(data).into_iter().filter(|_| !data.ruptures.is_empty()));
            blocks
        }
        Kind::Collision => {
            let [a, b] = [0, 1].map(|i| data.snapshot.speed[i]);
            let approach = 1e6 * approach(data.snapshot);
            let how = if approach > 0.0 { "pressed together" } else { "apart" };
            let force = label(contact_force(data.snapshot), 1);
            vec![
                clock,
                Block::new("approach", format!("{} µm", label(approach, 2)), how.to_owned()),
                Block::new("contact force", format!("{force} N"), String::new()),
                Block::new("speeds", format!("{a:.3} and {b:.3} m/s"), String::new()),
            ]
        }
        Kind::Free => {
            let fastest = data.snapshot.speed.iter().copied().fold(0.0, f32::max);
            vec![clock, Block::new("greatest speed", format!("{fastest:.3} m/s"), String::new())]
        }
    }
}

/// How many wires are broken, in all and of each layer, with the first break of each.
fn broken(data: &Data) -> Vec<Block> {
    let sample = &data.snapshot.sample;
    let wires = format!("{} / {}", sample.wires_broken, data.info.wires.len());
    let mut blocks = vec![Block::new("wires broken", wires, counted(sample.bonds_broken, "bond"))];
    let layers = &data.info.layers;
    if layers.len() > 1 {
        for (layer, name) in layers.iter().enumerate() {
            let of = data.info.wires_of(layer).count();
            let firsts = || data.first_breaks().filter(|(_, rupture)| rupture.layer == layer);
            let count = firsts().count();
            let detail = match firsts().next() {
                Some((_, first)) => format!("first: wire {}, {:.2} %", wire_number(first.wire), percent(first.strain)),
                None => String::new(),
            };
            // The layer of the first break of all is marked.
            let signal = data.ruptures.first().is_some_and(|first| first.layer == layer);
            blocks.push(Block { signal, ..Block::new(&format!("{name} broken"), format!("{count} / {of}"), detail) });
        }
    } else if let Some(first) = data.ruptures.first() {
        let value = format!("wire {} · z {:.1} mm before loading", wire_number(first.wire), mm(first.rest_z));
        let [strand, wire] = [first.body_stress, first.stress].map(mpa);
        let detail = format!("at {:.2} % and {strand:.1} MPa, wire at {wire:.0} MPa true", percent(first.strain));
        blocks.push(Block { size: 14.0, signal: true, ..Block::new(FIRST_BREAK, value, detail) });
    }
    blocks
}

fn time_text(seconds: f64) -> String {
    match seconds {
        s if s >= 1.0 => format!("{s:.3} s"),
        s if s >= 1e-3 => format!("{:.3} ms", ms(s)),
        s => format!("{:.2} µs", ms(ms(s))),
    }
}

fn name(canvas: &mut Canvas, area: Rect, data: &Data) -> f32 {
    let u = canvas.unit;
    let x = area.x + 18.0 * u;
    let kind = Type { size: 21.0 * u, weight: Weight::Bold, colour: data.style.text, align: Align::Left };
    let title = canvas.text(x, area.y + 29.0 * u, kind, &data.info.name);
    let kind = Type { size: 11.0 * u, weight: Weight::Regular, colour: data.style.muted, align: Align::Left };
    let size = canvas.text(x, area.y + 46.0 * u, kind, &size_text(data.info));
    x + title.max(size) + 22.0 * u
}

fn size_text(info: &RunInfo) -> String {
    let particles = counted(info.particles, "particle");
    match info.wires.len() {
        0 => particles,
        n => format!("{} · {particles}", counted(n, "wire")),
    }
}

/// Width of a block (px); at least a little, so that the caption does not dance as figures come and go.
fn block_width(canvas: &Canvas, block: &Block) -> f32 {
    let u = canvas.unit;
    let small = |t: &str| canvas.fonts.width(t, 11.0 * u, Weight::Regular);
    let value = canvas.fonts.width(&block.value, block.size * u, Weight::Bold);
    small(&block.what).max(value).max(small(&block.detail)).max(66.0 * u)
}

fn draw_block(canvas: &mut Canvas, x: f32, y: f32, data: &Data, block: &Block) {
    let u = canvas.unit;
    let colour = if block.signal { data.style.signal } else { data.style.muted };
    let small = Type { size: 11.0 * u, weight: Weight::Regular, colour, align: Align::Left };
    let big = Type { size: block.size * u, weight: Weight::Bold, colour: data.style.text, align: Align::Left };
    canvas.text(x, y + 18.0 * u, small, &block.what);
    canvas.text(x, y + 37.0 * u, big, &block.value);
    canvas.text(x, y + 51.0 * u, Type { colour: data.style.muted, ..small }, &block.detail);
}

fn colour_bar(canvas: &mut Canvas, area: Rect, data: &Data, range: [f64; 2]) {
    let u = canvas.unit;
    let bar = Rect::new(area.x, area.y + 24.0 * u, area.w, 11.0 * u).snapped();
    for k in 0..bar.w as i32 {
        let colour = data.scale.at((f64::from(k) + 0.5) / f64::from(bar.w));
        canvas.fill(Rect::new(bar.x + k as f32, bar.y, 1.0, bar.h), colour, 1.0);
    }
    // An arrow where values may lie beyond the range.
    let [below, above] = data.scale.open_ends();
    for (open, x, out, fraction) in [(below, bar.x - u, -1.0, 0.0), (above, bar.right() + u, 1.0, 1.0)] {
        for k in (0..(7.0 * u) as i32).filter(|_| open) {
            let height = bar.h * (1.0 - k as f32 / (7.0 * u));
            let column = Rect::new(
                x + out * k as f32 - if out < 0.0 { 1.0 } else { 0.0 },
                bar.y + 0.5 * (bar.h - height),
                1.0,
                height,
            );
            canvas.fill(column, data.scale.at(fraction), 1.0);
        }
    }
    let small = Type { size: 11.0 * u, weight: Weight::Regular, colour: data.style.muted, align: Align::Centre };
    canvas.text(
        area.x,
        area.y + 18.0 * u,
        Type { align: Align::Left, colour: data.style.text, ..small },
        data.scale.title(),
    );
    let marks = ticks(range[0], range[1], 6);
    for value in marks.values {
        let x = bar.x + bar.w * ((value - range[0]) / (range[1] - range[0])) as f32;
        canvas.fill(Rect::new(x - 0.5 * u, bar.bottom(), u, 4.0 * u), data.style.muted, 1.0);
        canvas.text(x, bar.bottom() + 15.0 * u, small, &label(value, marks.decimals));
    }
    if data.info.wires.is_empty() {
        return;
    }
    let x = area.right();
    let kind = Type { align: Align::Right, colour: data.style.signal, ..small };
    let width = canvas.text(x, area.y + 18.0 * u, kind, "broken");
    marks::broken(canvas, Rect::new(x - width - 15.0 * u, area.y + 9.0 * u, 10.0 * u, 10.0 * u), data);
}

fn legend(canvas: &mut Canvas, area: Rect, data: &Data) {
    let u = canvas.unit;
    let kind = Type { size: 12.0 * u, weight: Weight::Regular, colour: data.style.text, align: Align::Left };
    let mut entries: Vec<(String, [u8; 3])> = match data.scale.by() {
        ColourBy::Layer => {
            data.info.layers.iter().enumerate().map(|(k, name)| (name.clone(), ColourScale::category(k))).collect()
        }
        ColourBy::Material => {
            data.info.materials.iter().enumerate().map(|(k, name)| (name.clone(), ColourScale::category(k))).collect()
        }
        _ => vec![("coloured by wire".to_owned(), data.style.text)],
    };
    if !data.info.wires.is_empty() {
        entries.push(("broken".to_owned(), data.style.signal));
    }
    let (mut x, y) = (area.x, area.y + 0.5 * area.h);
    for (text, colour) in entries {
        let field = Rect::new(x, y - 5.0 * u, 10.0 * u, 10.0 * u);
        if colour == data.style.signal {
            marks::broken(canvas, field, data)
        } else {
            canvas.fill(field, colour, 1.0)
        }
        x += 15.0 * u;
        x += canvas.text(x, y + 4.5 * u, kind, &text) + 16.0 * u;
    }
}
