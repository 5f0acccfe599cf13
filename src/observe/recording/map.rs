//! The unrolled map: a row per wire, layers apart, initial axial position to the right. It shows at a glance where
//! each wire is loaded and where it broke. Places are those before loading, so that only colours change.

use super::names;
use super::paint::{FIRST, NEUTRAL, Scale};
use super::stream::Stream;
use crate::base::error::Result;
use crate::engine::view::{RunInfo, Rupture, WireInfo};
use crate::observe::wording::wire_number;
use rerun::{Color, LineStrips2D, Points2D, Radius};

/// Height of the map over its width (-): wires are far thinner than they are long.
const ASPECT: f32 = 0.5;
/// Gap between layers, in rows.
const LAYER_GAP: f32 = 1.5;

/// Wires of a layer with their indices.
pub(super) fn wires_of(info: &RunInfo, layer: usize) -> impl Iterator<Item = (usize, &WireInfo)> {
    info.wires.iter().enumerate().filter(move |(_, wire)| wire.layer == layer)
}

/// Columns in which neighbours write their place in the order of break.
const ORDER_COLUMNS: usize = 2;
/// Width of such a column over the length of the map (-).
const ORDER_WIDTH: f32 = 0.115;

/// Where a wire's place in the order of break is written, and the line that leads there.
pub(super) struct Order {
    pub leader: [[f32; 2]; 2],
    pub label: [f32; 2],
}

/// Where things are on the map.
pub(super) struct Map {
    /// Extent along z before loading (mm).
    pub z: [f32; 2],
    /// Row height, in the map's own units (those of z).
    pub row: f32,
    /// y of each wire.
    pub wire_y: Vec<f32>,
    /// Total height.
    pub height: f32,
}

impl Map {
    /// Lays the map out.
    pub fn new(info: &RunInfo) -> Self {
        let z = extent(info);
        let gaps = LAYER_GAP * info.layers.len().saturating_sub(1) as f32;
        let height = ASPECT * (z[1] - z[0]);
        let row = height / (info.wires.len() as f32 + gaps).max(1.0);
        let mut wire_y = vec![0.0; info.wires.len()];
        let mut y = 0.5 * row;
        for layer in 0..info.layers.len() {
            for (number, _) in wires_of(info, layer) {
                wire_y[number] = y;
                y += row;
            }
            y += LAYER_GAP * row;
        }
        Self { z, row, wire_y, height }
    }

    /// Sends what does not change: places of bonds, names of layers.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Io`] when Rerun refuses the data.
    pub fn send(&self, stream: &Stream, info: &RunInfo) -> Result<()> {
        for layer in 0..info.layers.len() {
            let places = wires_of(info, layer).flat_map(|(number, wire)| {
                let y = self.wire_y[number];
                info.rest_position[wire.first..wire.first + wire.len].iter().map(move |p| [p[2], y])
            });
            let points = Points2D::new(places).with_radii([Radius::new_scene_units(0.4 * self.row)]);
            stream.fixed(names::layer(names::MAP, info, layer), &points)?;
        }
        self.send_names(stream, info)?;
        self.send_ticks(stream)
    }

    /// x and y range that the view shows.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let length = self.z[1] - self.z[0];
        let x = [self.z[0] - 0.13 * length, self.z[1] + (0.03 + ORDER_WIDTH * ORDER_COLUMNS as f32) * length];
        let y = [-4.0 * self.row, self.height + 6.0 * self.row];
        [x.map(f64::from), y.map(f64::from)]
    }

    /// Where a rupture is on the map.
    pub fn place(&self, rupture: &Rupture) -> [f32; 2] {
        [(rupture.rest_z * 1e3) as f32, self.wire_y[rupture.wire]]
    }

    /// Where a wire's place in the order of break is written: in a column on the right, beside its row. Texts are
    /// higher than rows, so neighbours take turns in [`ORDER_COLUMNS`] columns.
    pub fn order(&self, rupture: &Rupture) -> Order {
        let y = self.wire_y[rupture.wire];
        let length = self.z[1] - self.z[0];
        let column = (rupture.wire % ORDER_COLUMNS) as f32;
        let x = self.z[1] + (0.08 + ORDER_WIDTH * column) * length;
        // Texts stand below their point.
        Order { leader: [[self.z[1], y], [x - 0.5 * ORDER_WIDTH * length, y]], label: [x, y - 0.85 * self.row] }
    }

    /// Leads from the first break to the axis of z, where its place is written.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Io`] when Rerun refuses the data.
    pub fn send_first_break(&self, stream: &Stream, info: &RunInfo, first: &Rupture) -> Result<()> {
        let [z, y] = self.place(first);
        let colour = Color::from_u32(FIRST);
        let path = format!("{}/first_break", names::MAP);
        let cross =
            LineStrips2D::new([[[z, -self.row], [z, self.height + self.row]], [[self.z[0], y], [self.z[1], y]]])
                .with_colors([colour])
                .with_radii([Radius::new_ui_points(0.75)])
                .with_draw_order(15.0);
        stream.row(path.clone(), first.into(), &cross)?;
        let words = format!("{}, z = {z:.1} mm", names::first_break(info, first));
        let label = Points2D::new([[z, -2.6 * self.row]])
            .with_labels([words])
            .with_show_labels(true)
            .with_colors([colour])
            .with_radii([Radius::new_ui_points(0.1)]);
        stream.row(format!("{path}/label"), first.into(), &label)
    }

    fn send_ticks(&self, stream: &Stream) -> Result<()> {
        let ticks = ticks(self.z);
        let points = Points2D::new(ticks.iter().map(|z| [*z, self.height + 0.5 * self.row]))
            .with_labels(ticks.iter().map(|z| format!("z = {z} mm")))
            .with_show_labels(true)
            .with_colors([Color::from_u32(NEUTRAL)])
            .with_radii([Radius::new_ui_points(1.0)]);
        stream.fixed(format!("{}/ticks", names::MAP), &points)
    }

    /// Sends a bar of colours with the values at its ends, below the map.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Io`] when Rerun refuses the data.
    pub fn send_colour_bar(&self, stream: &Stream, scale: &Scale) -> Result<()> {
        let length = self.z[1] - self.z[0];
        let y = self.height + 4.0 * self.row;
        let at = |t: f32| self.z[0] + (0.3 + 0.4 * t) * length;
        let n = scale.colours.len();
        let place = |i: usize| at(i as f32 / (n - 1) as f32);
        let bar = LineStrips2D::new((0..n).map(|i| [[place(i), y], [place(i) + 0.4 * length / n as f32, y]]))
            .with_colors(scale.colours.iter().map(|c| Color::from_u32(*c)))
            .with_radii([Radius::new_scene_units(0.6 * self.row)]);
        stream.fixed(format!("{}/colour_bar", names::MAP), &bar)?;
        let ends = Points2D::new([[at(-0.3), y - self.row], [at(1.16), y - self.row]])
            .with_labels(scale.ends.clone())
            .with_show_labels(true)
            .with_colors([Color::from_u32(NEUTRAL)])
            .with_radii([Radius::new_ui_points(0.1)]);
        stream.fixed(format!("{}/colour_bar/ends", names::MAP), &ends)
    }

    fn send_names(&self, stream: &Stream, info: &RunInfo) -> Result<()> {
        let first_and_last = (0..info.layers.len()).filter_map(|layer| {
            let first = wires_of(info, layer).next()?.0;
            let last = wires_of(info, layer).last()?.0;
            Some((layer, first, last))
        });
        let (mut places, mut labels) = (Vec::new(), Vec::new());
        for (layer, first, last) in first_and_last {
            places.push([self.z[0] - 0.07 * (self.z[1] - self.z[0]), 0.5 * (self.wire_y[first] + self.wire_y[last])]);
            labels.push(format!("{} {}–{}", info.layers[layer], wire_number(first), wire_number(last)));
        }
        let points = Points2D::new(places)
            .with_labels(labels)
            .with_show_labels(true)
            .with_colors([Color::from_rgb(200, 205, 212)])
            .with_radii([Radius::new_ui_points(0.5)]);
        stream.fixed(format!("{}/names", names::MAP), &points)
    }
}

/// Round positions along z (mm), about six of them.
fn ticks([low, high]: [f32; 2]) -> Vec<f32> {
    let step = round_step((high - low) / 6.0);
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    (first..=last).map(|i| i as f32 * step).collect()
}

/// The least round number that is not below `rough`.
pub(super) fn round_step(rough: f32) -> f32 {
    let decade = 10f32.powf(rough.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|m| m * decade).into_iter().find(|s| *s >= rough).unwrap_or(rough)
}

/// Extent of the particles along z before loading (mm).
pub(super) fn extent(info: &RunInfo) -> [f32; 2] {
    let z = info.rest_position.iter().zip(&info.radius).map(|(p, r)| [p[2] - r, p[2] + r]);
    let [low, high] = z.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], [a, b]| [low.min(a), high.max(b)]);
    if low < high { [low, high] } else { [0.0, 1.0] }
}
