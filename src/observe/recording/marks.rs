//! Ruptures: marked, labelled points that stay from their time on, and a log.

use super::map::Map;
use super::stream::{Instant, Stream, strips, texts, vectors};
use super::{names, paint};
use crate::base::error::Result;
use crate::engine::view::{RunInfo, Rupture};
use crate::observe::wording::{rupture_line, wire_number};
use rerun::{Color, LineStrips3D, Points2D, Points3D, Radius, TextLog, TextLogLevel};
use std::collections::BTreeMap;

/// Heights at which labels of successive ruptures stand.
const LABEL_TIERS: usize = 5;
/// Step from one height to the next, in thicknesses of the body [-].
const LABEL_STEP: f32 = 0.155;

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

    fn labels(&self) -> impl Iterator<Item = String> {
        self.rows().flatten().map(|r| format!("{}: wire {}", r.order, wire_number(r.wire)))
    }

    fn lengths(&self) -> Vec<usize> {
        self.rows().map(<[_]>::len).collect()
    }

    fn send_in_space(&self, stream: &Stream, info: &RunInfo, number: usize) -> Result<()> {
        let marks = names::marks(names::STRAND, info, number);
        let places = self.rows().flatten().map(place);
        let places = vectors(Points3D::descriptor_positions(), places);
        stream.rows(marks.clone(), &self.instants(), [(places, self.lengths())])?;
        let ends = self.rows().flatten().map(|r| label_place(info, r));
        let leaders = self.rows().flatten().flat_map(|r| [place(r), label_place(info, r)]);
        stream.rows(
            marks.join(&names::LABEL.into()),
            &self.instants(),
            [
                (vectors(Points3D::descriptor_positions(), ends), self.lengths()),
                (texts(Points3D::descriptor_labels(), self.labels()), self.lengths()),
                (strips(LineStrips3D::descriptor_strips(), leaders, 2), self.lengths()),
            ],
        )
    }

    fn send_on_map(&self, stream: &Stream, info: &RunInfo, number: usize, map: &Map) -> Result<()> {
        let places = self.rows().flatten().map(|r| [(r.rest_z * 1e3) as f32, map.wire_y[r.wire]]);
        stream.rows(
            names::marks(names::MAP, info, number),
            &self.instants(),
            [
                (vectors(Points2D::descriptor_positions(), places), self.lengths()),
                (texts(Points2D::descriptor_labels(), self.labels()), self.lengths()),
            ],
        )
    }
}

fn send_style(stream: &Stream, info: &RunInfo, number: usize) -> Result<()> {
    let colour = Color::from_u32(paint::MARK);
    let marks = names::marks(names::STRAND, info, number);
    let radius = Radius::new_scene_units(0.5 * info.wires[number].diameter);
    let in_space = Points3D::update_fields().with_colors([colour]).with_radii([radius]);
    stream.fixed(marks.clone(), &in_space)?;
    let labels = marks.join(&names::LABEL.into());
    let thin = Radius::new_ui_points(0.75);
    let points = Points3D::update_fields().with_colors([colour]).with_radii([thin]).with_show_labels(true);
    stream.fixed(labels.clone(), &points)?;
    stream.fixed(labels, &LineStrips3D::update_fields().with_colors([colour]).with_radii([thin]))?;
    let on_map = Points2D::update_fields()
        .with_colors([colour])
        .with_radii([Radius::new_ui_points(3.5)])
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

/// Place of the bond when it broke [mm].
fn place(rupture: &Rupture) -> [f32; 3] {
    rupture.position.map(|x| (x * 1e3) as f32)
}

/// Place of a rupture's label [mm]: off the wires, and labels that follow each other at different heights, because
/// ruptures come close together.
fn label_place(info: &RunInfo, rupture: &Rupture) -> [f32; 3] {
    let tier = ((rupture.order - 1) % LABEL_TIERS) as f32;
    let y = thickness(info) * (0.62 + LABEL_STEP * tier);
    let [_, _, z] = place(rupture);
    [0.0, y, z]
}

/// Largest distance of a particle's surface from the z axis before loading [mm].
fn thickness(info: &RunInfo) -> f32 {
    let reach = info.rest_position.iter().zip(&info.radius).map(|([x, y, _], r)| x.hypot(*y) + r);
    2.0 * reach.fold(0.0, f32::max)
}
