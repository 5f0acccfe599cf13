//! Ruptures: marked, labelled points that stay from their time on, and a log.

use super::map::Map;
use super::stream::{Instant, Stream, vectors};
use super::{names, paint};
use crate::base::error::Result;
use crate::engine::view::{RunInfo, Rupture};
use crate::observe::wording::{rupture_line, wire_number};
use rerun::external::arrow::array::StringArray;
use rerun::{
    Color, ComponentDescriptor, Points2D, Points3D, Radius, SerializedComponentBatch, TextLog, TextLogLevel,
};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Ruptures of one wire so far.
#[derive(Default)]
struct WireMarks {
    all: Vec<Rupture>,
    sent: usize,
}

/// Ruptures so far.
#[derive(Default)]
pub(super) struct Marks {
    wires: BTreeMap<usize, WireMarks>,
    unsent: Vec<Rupture>,
}

impl Marks {
    /// Takes note of a rupture.
    pub fn add(&mut self, rupture: &Rupture) {
        self.wires.entry(rupture.wire).or_default().all.push(rupture.clone());
        self.unsent.push(rupture.clone());
    }

    /// Sends what is new.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Io`] when Rerun refuses the data.
    pub fn send(&mut self, stream: &Stream, info: &RunInfo, map: &Map) -> Result<()> {
        if self.unsent.is_empty() {
            return Ok(());
        }
        send_log(stream, info, &self.unsent)?;
        self.unsent.clear();
        for (number, wire) in self.wires.iter_mut().filter(|(_, wire)| wire.sent < wire.all.len()) {
            if wire.sent == 0 {
                send_style(stream, info, *number)?;
            }
            wire.send_in_space(stream, info, *number)?;
            wire.send_on_map(stream, info, *number, map)?;
            wire.sent = wire.all.len();
        }
        Ok(())
    }
}

impl WireMarks {
    /// A row for each new rupture holds all of the wire's marks so far, because a row replaces the one before.
    fn rows(&self) -> impl Iterator<Item = &[Rupture]> {
        (self.sent + 1..=self.all.len()).map(|n| &self.all[..n])
    }

    fn instants(&self) -> Vec<Instant> {
        self.all[self.sent..].iter().map(instant).collect()
    }

    fn lengths(&self) -> Vec<usize> {
        self.rows().map(<[_]>::len).collect()
    }

    fn send_in_space(&self, stream: &Stream, info: &RunInfo, number: usize) -> Result<()> {
        let places = self.rows().flatten().map(|r| r.position.map(|x| (x * 1e3) as f32));
        let labels = self.rows().flatten().map(|r| format!("{}: wire {}", r.order, wire_number(r.wire)));
        stream.rows(
            names::marks(names::STRAND, info, number),
            &self.instants(),
            [
                (vectors(Points3D::descriptor_positions(), places), self.lengths()),
                (texts(Points3D::descriptor_labels(), labels), self.lengths()),
            ],
        )
    }

    fn send_on_map(&self, stream: &Stream, info: &RunInfo, number: usize, map: &Map) -> Result<()> {
        let places = self.rows().flatten().map(|r| [(r.rest_z * 1e3) as f32, map.wire_y[r.wire]]);
        let labels = self.rows().flatten().map(|r| format!("{}: wire {}", r.order, wire_number(r.wire)));
        stream.rows(
            names::marks(names::MAP, info, number),
            &self.instants(),
            [
                (vectors(Points2D::descriptor_positions(), places), self.lengths()),
                (texts(Points2D::descriptor_labels(), labels), self.lengths()),
            ],
        )
    }
}

fn send_style(stream: &Stream, info: &RunInfo, number: usize) -> Result<()> {
    let colour = Color::from_u32(paint::BROKEN);
    let in_space = Points3D::update_fields()
        .with_colors([colour])
        .with_radii([Radius::new_scene_units(0.65 * info.wires[number].diameter)])
        .with_show_labels(true);
    stream.fixed(names::marks(names::STRAND, info, number), &in_space)?;
    let on_map = Points2D::update_fields()
        .with_colors([colour])
        .with_radii([Radius::new_ui_points(5.0)])
        .with_draw_order(10.0)
        .with_show_labels(true);
    stream.fixed(names::marks(names::MAP, info, number), &on_map)
}

fn send_log(stream: &Stream, info: &RunInfo, ruptures: &[Rupture]) -> Result<()> {
    let instants: Vec<_> = ruptures.iter().map(instant).collect();
    let level = |r: &Rupture| if r.first_of_wire { TextLogLevel::WARN } else { TextLogLevel::INFO };
    let one = vec![1; ruptures.len()];
    stream.rows(
        names::LOG,
        &instants,
        [
            (texts(TextLog::descriptor_text(), ruptures.iter().map(|r| rupture_line(info, r))), one.clone()),
            (texts(TextLog::descriptor_level(), ruptures.iter().map(|r| level(r).to_owned())), one),
        ],
    )
}

fn instant(rupture: &Rupture) -> Instant {
    Instant { step: rupture.step, time: rupture.time, strain: rupture.strain }
}

fn texts(descriptor: ComponentDescriptor, values: impl Iterator<Item = String>) -> SerializedComponentBatch {
    let all: Vec<String> = values.collect();
    SerializedComponentBatch::new(Arc::new(StringArray::from(all)), descriptor)
}
