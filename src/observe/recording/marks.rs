//! Ruptures: a mark in space where a bond broke, a mark and the order of break on the map, and a line of the log.

use super::map::Map;
use super::stream::{Instant, Stream, texts, vectors};
use super::{names, paint};
use crate::base::error::Result;
use crate::base::finding::Notice;
use crate::base::units::{mm, mpa};
use crate::engine::view::{RunInfo, Rupture};
use crate::observe::wording::{rupture_line, wire_number};
use rerun::{Color, LineStrips2D, Points2D, Points3D, Radius, TextLog, TextLogLevel};
use std::collections::BTreeMap;

/// Ruptures of one wire so far.
#[derive(Default)]
struct WireMarks {
    all: Vec<Rupture>,
    sent: usize,
}

/// A line of the log.
struct Line {
    instant: Instant,
    level: &'static str,
    text: String,
}

/// Ruptures and notices so far.
#[derive(Default)]
pub(super) struct Marks {
    wires: BTreeMap<usize, WireMarks>,
    unsent: Vec<Rupture>,
    lines: Vec<Line>,
}

impl Marks {
    /// Takes note of a rupture.
    pub fn add(&mut self, info: &RunInfo, rupture: &Rupture) {
        self.wires.entry(rupture.wire).or_default().all.push(rupture.clone());
        self.unsent.push(rupture.clone());
        let text =
            format!("{}. {}; nominal {:.0} MPa", rupture.order, rupture_line(info, rupture), mpa(rupture.body_stress));
        self.lines.push(Line { instant: rupture.into(), level: TextLogLevel::INFO, text });
    }

    /// Takes note of a notice.
    pub fn add_notice(&mut self, notice: &Notice) {
        let at = &notice.at;
        let instant = Instant { step: at.step, time: at.time, strain: at.strain.unwrap_or(0.0) };
        self.lines.push(Line { instant, level: TextLogLevel::WARN, text: notice.to_string() });
    }

    /// Sends what is new, and gives the ruptures in it.
    pub fn send(&mut self, stream: &Stream, info: &RunInfo, map: &Map) -> Result<Vec<Rupture>> {
        self.send_log(stream)?;
        for (number, wire) in self.wires.iter_mut().filter(|(_, wire)| wire.sent < wire.all.len()) {
            if wire.sent == 0 {
                wire.send_first_time(stream, info, *number, map)?;
            }
            wire.send_places(stream, info, *number, map)?;
            wire.sent = wire.all.len();
        }
        Ok(std::mem::take(&mut self.unsent))
    }

    fn send_log(&mut self, stream: &Stream) -> Result<()> {
        let lines = std::mem::take(&mut self.lines);
        if lines.is_empty() {
            return Ok(());
        }
        let instants: Vec<_> = lines.iter().map(|line| line.instant).collect();
        let one = vec![1; lines.len()];
        let levels = texts(TextLog::descriptor_level(), lines.iter().map(|line| line.level.to_owned()));
        let words = texts(TextLog::descriptor_text(), lines.into_iter().map(|line| line.text));
        stream.rows(names::LOG, &instants, [(words, one.clone()), (levels, one)])
    }
}

impl WireMarks {
    /// A row for each new rupture holds all of the wire's marks so far, because a row replaces the one before.
    fn rows(&self) -> impl Iterator<Item = &[Rupture]> {
        (self.sent + 1..=self.all.len()).map(|n| &self.all[..n])
    }

    fn instants(&self) -> Vec<Instant> {
        self.all[self.sent..].iter().map(Instant::from).collect()
    }

    fn labels(&self) -> impl Iterator<Item = String> {
        self.rows().flatten().map(label)
    }

    fn lengths(&self) -> Vec<usize> {
        self.rows().map(<[_]>::len).collect()
    }

    fn send_places(&self, stream: &Stream, info: &RunInfo, number: usize, map: &Map) -> Result<()> {
        let places = vectors(Points3D::descriptor_positions(), self.rows().flatten().map(place));
        let words = texts(Points3D::descriptor_labels(), self.labels());
        let marks = names::marks(names::STRAND, info, number);
        stream.rows(marks, &self.instants(), [(places, self.lengths()), (words, self.lengths())])?;
        let places = vectors(Points2D::descriptor_positions(), self.rows().flatten().map(|r| map.place(r)));
        let words = texts(Points2D::descriptor_labels(), self.labels());
        let marks = names::marks(names::MAP, info, number);
        stream.rows(marks, &self.instants(), [(places, self.lengths()), (words, self.lengths())])
    }

    /// What a wire gets with its first rupture only: the style of its marks, and its place in the order of break.
    fn send_first_time(&self, stream: &Stream, info: &RunInfo, number: usize, map: &Map) -> Result<()> {
        let first = &self.all[0];
        let colour = if first.order == 1 { paint::FIRST } else { paint::MARK };
        let in_space = Points3D::update_fields()
            .with_colors([Color::from_u32(colour)])
            .with_radii([Radius::new_ui_points(2.0)])
            .with_show_labels(false);
        stream.fixed(names::marks(names::STRAND, info, number), &in_space)?;
        let on_map = Points2D::update_fields()
            .with_colors([Color::from_u32(if first.order == 1 { paint::FIRST } else { paint::BROKEN })])
            .with_radii([Radius::new_ui_points(if first.order == 1 { 6.0 } else { 3.5 })])
            .with_draw_order(if first.order == 1 { paint::OVER + 10.0 } else { paint::OVER })
            .with_show_labels(false);
        let marks = names::marks(names::MAP, info, number);
        stream.fixed(marks.clone(), &on_map)?;
        let order = map.order(first);
        let leader = LineStrips2D::new([order.leader])
            .with_colors([Color::from_u32(colour)])
            .with_radii([Radius::new_ui_points(0.5)]);
        let words = paint::labels([(order.label, ordinal(first))], colour);
        let path = marks.join(&names::ORDER.into());
        stream.row(path.clone(), first.into(), &leader)?;
        stream.row(path.join(&"label".into()), first.into(), &words)?;
        if first.order == 1 { map.send_first_break(stream, info, first) } else { Ok(()) }
    }
}

/// `5: wire 14`, with `1st` for the first.
fn label(rupture: &Rupture) -> String {
    format!("{}: wire {}", ordinal(rupture), wire_number(rupture.wire))
}

/// `5`, and `1st` for the first.
fn ordinal(rupture: &Rupture) -> String {
    if rupture.order == 1 { "1st".to_owned() } else { rupture.order.to_string() }
}

/// Place of the bond when it broke (mm).
pub(super) fn place(rupture: &Rupture) -> [f32; 3] {
    rupture.position.map(|x| mm(x) as f32)
}
