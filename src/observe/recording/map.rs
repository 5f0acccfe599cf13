//! The unrolled map: a row per wire, layers apart, initial axial position to the right. It shows at a glance where
//! each wire is loaded and where it broke. Places are those before loading, so that only colours change.

use super::names;
use super::names::{PLACE, PLACE_RADIUS, descriptor};
use super::paint::{FIRST, NEUTRAL, Scale, labels};
use super::stream::{Stream, in_mm, numbers, vectors};
use crate::base::error::Result;
use crate::base::ticks::{label, ticks};
use crate::base::units::mm;
use crate::engine::view::{RunInfo, Rupture};
use crate::observe::unrolled::Unrolled;
use rerun::blueprint::VisualizerComponentMapping;
use rerun::{Archetype as _, Color, ComponentDescriptor, LineStrips2D, Points2D, Points3D, Radius};

/// Height of the map over its width (-): wires are far thinner than they are long.
const ASPECT: f32 = 0.5;
/// Colour of the layers' names.
const NAMES: u32 = 0xC8CDD4FF;
/// Rows that a map has room for at least: one row as high as the map would be no row.
const LEAST_ROWS: f64 = 8.0;
/// Gap between layers, in rows.
const LAYER_GAP: f64 = 1.5;

/// Columns in which neighbours write their place in the order of break.
const ORDER_COLUMNS: usize = 3;
/// Width of such a column over the length of the map (-).
const ORDER_WIDTH: f32 = 0.07;

/// Where the viewer finds what it draws a wire's row from: places that never change, and the colours in space.
pub(super) fn mappings() -> Vec<VisualizerComponentMapping> {
    let from = |target: ComponentDescriptor, source: &str| {
        VisualizerComponentMapping::new_source_component(target.component.as_str(), source)
    };
    vec![
        from(Points2D::descriptor_positions(), PLACE),
        from(Points2D::descriptor_radii(), PLACE_RADIUS),
        from(Points2D::descriptor_colors(), Points3D::descriptor_colors().component.as_str()),
    ]
}

/// The viewer's name for what draws rows.
pub(super) fn visualizer() -> &'static str {
    Points2D::name().short_name()
}

/// Where a wire's place in the order of break is written, and the line that leads there.
pub(super) struct Order {
    pub leader: [[f32; 2]; 2],
    pub label: [f32; 2],
}

/// Where things are on the map.
pub(super) struct Map {
    map: Unrolled,
    /// Extent along z before loading (mm).
    z: [f32; 2],
    /// Row height, in the map's own units (those of z).
    row: f32,
    /// Total height.
    height: f32,
}

impl Map {
    /// Lays the map out.
    pub fn new(info: &RunInfo) -> Self {
        let map = Unrolled::new(info, LAYER_GAP, 0..info.layers.len());
        let z = map.ends.map(|z| z as f32);
        let row = ASPECT * (z[1] - z[0]) / map.rows.max(LEAST_ROWS) as f32;
        Self { height: row * map.rows as f32, row, map, z }
    }

    /// Height of a row, or between two.
    fn y(&self, row: f64) -> f32 {
        self.row * row as f32
    }

    /// Sends what does not change: places of bonds, names of layers.
    pub fn send(&self, stream: &Stream, info: &RunInfo) -> Result<()> {
        for (number, wire) in info.wires.iter().enumerate() {
            let y = self.y(self.map.row[number]);
            let places = info.rest_position[wire.particles()].iter().map(|p| [in_mm(*p)[2], y]);
            let places = vectors(descriptor(PLACE), places);
            let radius = numbers(descriptor(PLACE_RADIUS), std::iter::once(0.4 * self.row));
            stream.fixed(names::wire(names::STRAND, info, number), &[places, radius])?;
        }
        self.send_names(stream, info)?;
        self.send_ticks(stream)
    }

    /// x and y range that the view shows.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let length = self.z[1] - self.z[0];
        let x = [self.z[0] - 0.13 * length, self.z[1] + (0.04 + ORDER_WIDTH * ORDER_COLUMNS as f32) * length];
        let y = [-4.0 * self.row, self.height + 6.0 * self.row];
        [x.map(f64::from), y.map(f64::from)]
    }

    /// x and y range that shows the bar of colours alone.
    pub fn bar_bounds(&self) -> [[f64; 2]; 2] {
        let y = self.bar();
        [self.bounds()[0], [y - 2.0 * self.row, y + 2.0 * self.row].map(f64::from)]
    }

    /// Middle of the bar of colours.
    fn bar(&self) -> f32 {
        self.height + 4.0 * self.row
    }

    /// Where a rupture is on the map.
    pub fn place(&self, rupture: &Rupture) -> [f32; 2] {
        [mm(rupture.rest_z) as f32, self.y(self.map.row[rupture.wire])]
    }

    /// Where a wire's place in the order of break is written: in a column on the right, beside its row. Texts are
    /// higher than rows, so neighbours take turns in [`ORDER_COLUMNS`] columns.
    pub fn order(&self, rupture: &Rupture) -> Order {
        let y = self.y(self.map.row[rupture.wire]);
        let length = self.z[1] - self.z[0];
        let column = (rupture.wire % ORDER_COLUMNS) as f32;
        let x = self.z[1] + (0.06 + ORDER_WIDTH * column) * length;
        // Texts stand below their point. A leader ends before the first column: further on it would strike out the
        // texts of neighbours.
        Order { leader: [[self.z[1], y], [self.z[1] + 0.02 * length, y]], label: [x, y - 0.85 * self.row] }
    }

    /// Leads from the first break to the axis of z, where its place is written.
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
        stream.row(format!("{path}/label"), first.into(), &labels([([z, -2.6 * self.row], words)], FIRST))
    }

    fn send_ticks(&self, stream: &Stream) -> Result<()> {
        let [low, high] = self.map.ends;
        let ticks = ticks(low, high, 6);
        let y = self.height + 0.5 * self.row;
        let words = ticks.values.iter().map(|z| ([*z as f32, y], format!("z = {} mm", label(*z, ticks.decimals))));
        let points = labels(words, NEUTRAL).with_radii([Radius::new_ui_points(1.0)]);
        stream.fixed(format!("{}/ticks", names::MAP), &points)
    }

    /// Sends a bar of colours with the values at its ends, below the map.
    pub fn send_colour_bar(&self, stream: &Stream, scale: &Scale) -> Result<()> {
        let length = self.z[1] - self.z[0];
        let y = self.bar();
        let at = |t: f32| self.z[0] + (0.3 + 0.4 * t) * length;
        let n = scale.colours.len();
        let place = |i: usize| at(i as f32 / (n - 1) as f32);
        let bar = LineStrips2D::new((0..n).map(|i| [[place(i), y], [place(i) + 0.4 * length / n as f32, y]]))
            .with_colors(scale.colours.iter().map(|c| Color::from_u32(*c)))
            .with_radii([Radius::new_scene_units(0.6 * self.row)]);
        let path = format!("{}/{}", names::MAP, names::COLOUR_BAR);
        stream.fixed(path.as_str(), &bar)?;
        let ends = [-0.3, 1.16].map(|t| [at(t), y - self.row]).into_iter().zip(scale.ends.clone());
        stream.fixed(format!("{path}/ends"), &labels(ends, NEUTRAL))
    }

    fn send_names(&self, stream: &Stream, info: &RunInfo) -> Result<()> {
        let x = self.z[0] - 0.07 * (self.z[1] - self.z[0]);
        let of = self.map.layers.iter();
        let words = of.map(|of| ([x, self.y(of.row)], format!("{} {}", info.layers[of.layer], of.numbers())));
        stream.fixed(format!("{}/names", names::MAP), &labels(words, NAMES))
    }
}
