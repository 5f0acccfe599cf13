//! Stress over strain as a drawing: a plot of the viewer can only count along a timeline, a drawing has axes in per
//! cent and MPa, and room to name the first break. The view shows all times up to the cursor, so the curve grows with
//! it and every piece is sent once.

use super::paint::{self, OVER, distinct, labels};
use super::stream::{Instant, Stream, strips, texts, vectors};
use super::{curve, names};
use crate::base::error::Result;
use crate::base::ticks::{label, ticks};
use crate::engine::view::{RunInfo, Rupture, Sample};
use crate::observe::stress_strain::{Series, expected, mark, point, series};
use crate::observe::wording::wire_number;
use rerun::{Color, EntityPath, LineStrips2D, Points2D, Radius};

/// Width and height of the drawing, in its own units.
const SIZE: [f32; 2] = [190.0, 100.0];
/// Margins left, right, above and below, in the drawing's units.
pub(super) const MARGINS: [f32; 4] = [30.0, 8.0, 8.0, 16.0];
/// Room over the highest expected stress (-).
const HEADROOM: f64 = 1.06;
const WHITE: u32 = 0xFFFFFFFF;
const GRID: u32 = 0x2C333DFF;

/// Scales of the drawing.
pub(super) struct Chart {
    /// Strain at the right end (%), stress at the upper end (MPa).
    end: [f64; 2],
    /// Last point of each curve: the strand, then layers.
    last: Option<Vec<[f32; 2]>>,
}

impl Chart {
    /// The chart of a run that is pulled; `None` for others, which have no curve of stress over strain.
    pub fn new(info: &RunInfo) -> Option<Self> {
        let [strain, stress] = expected(info);
        (info.is_pulled() && strain > 0.0).then_some(Self { end: [strain, stress * HEADROOM], last: None })
    }

    /// x and y range that the view shows.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let [left, right, above, below] = MARGINS.map(f64::from);
        let [width, height] = SIZE.map(f64::from);
        [[-left, width + right], [-height - above, below]]
    }

    /// Where a place in the chart (%, MPa) is in the drawing.
    fn place(&self, [strain, stress]: [f64; 2]) -> [f32; 2] {
        let [x, y] = [strain / self.end[0], stress / self.end[1]];
        [x as f32 * SIZE[0], -y as f32 * SIZE[1]]
    }

    /// Sends axes, ticks and legend.
    pub fn send_fixed(&self, stream: &Stream, info: &RunInfo) -> Result<()> {
        let [along, up] = self.end.map(|end| ticks(0.0, end, 6));
        let [right, top] = self.end;
        let vertical = along.values.iter().map(|e| [self.place([*e, 0.0]), self.place([*e, top])]);
        let level = up.values.iter().map(|s| [self.place([0.0, *s]), self.place([right, *s])]);
        let grid = LineStrips2D::new(vertical.chain(level))
            .with_colors([Color::from_u32(GRID)])
            .with_radii([Radius::new_ui_points(0.5)]);
        stream.fixed(path("grid"), &grid)?;
        let below = along
            .values
            .iter()
            .map(|e| (shift(self.place([*e, 0.0]), [0.0, 1.5]), format!("{} %", label(*e, along.decimals))));
        let beside = up
            .values
            .iter()
            .map(|s| (shift(self.place([0.0, *s]), [-15.0, -5.0]), format!("{} MPa", label(*s, up.decimals))));
        stream.fixed(path("axes"), &labels(below.chain(beside), paint::NEUTRAL))?;
        for (i, of) in series(info).into_iter().enumerate() {
            let (curve, colour) = (path_of(info, &of), colour_of(&of));
            let style = LineStrips2D::update_fields()
                .with_colors([Color::from_u32(colour)])
                .with_radii([Radius::new_ui_points(if i == 0 { 1.75 } else { 1.0 })]);
            stream.fixed(curve.clone(), &style)?;
            let place = [(0.25 + 0.2 * (i % 2) as f32) * SIZE[0], (-0.32 + 0.13 * (i / 2) as f32) * SIZE[1]];
            stream.fixed(curve.join(&"name".into()), &labels([(place, of.name)], colour))?;
        }
        let marks = Points2D::update_fields()
            .with_colors([Color::from_u32(paint::BROKEN)])
            .with_radii([Radius::new_ui_points(2.5)])
            .with_draw_order(OVER)
            .with_show_labels(false);
        stream.fixed(path("ruptures"), &marks)
    }

    /// Sends the next pieces of the curves.
    pub fn send(&mut self, stream: &Stream, info: &RunInfo, samples: &[Sample]) -> Result<()> {
        let all = series(info);
        let row = |sample: &Sample| all.iter().map(|of| self.place(point(of, sample))).collect();
        let points: Vec<Vec<[f32; 2]>> = samples.iter().map(row).collect();
        let instants: Vec<_> = samples.iter().map(curve::instant).collect();
        let Some(first) = points.first().cloned() else { return Ok(()) };
        let before = self.last.take().unwrap_or(first);
        for (i, of) in all.iter().enumerate() {
            let ends = std::iter::once(before[i]).chain(points.iter().map(|p| p[i]));
            let pieces = ends.zip(points.iter().map(|p| p[i])).flat_map(|(a, b)| [a, b]);
            let batch = strips(LineStrips2D::descriptor_strips(), pieces, 2);
            stream.rows(path_of(info, of), &instants, [(batch, vec![1; instants.len()])])?;
        }
        self.last = points.last().cloned();
        Ok(())
    }

    /// Marks ruptures on the curve of the strand, and names the first.
    pub fn send_ruptures(&self, stream: &Stream, info: &RunInfo, ruptures: &[Rupture]) -> Result<()> {
        let instants: Vec<_> = ruptures.iter().map(Instant::from).collect();
        let place = |r: &Rupture| self.place(mark(r));
        let words = |r: &Rupture| {
            let ([strain, stress], wire) = (mark(r), wire_number(r.wire));
            format!("{}: wire {wire}, {stress:.1} MPa at {strain:.2} %", r.order)
        };
        let one = vec![1; ruptures.len()];
        let places = vectors(Points2D::descriptor_positions(), ruptures.iter().map(place));
        let words = texts(Points2D::descriptor_labels(), ruptures.iter().map(words));
        stream.rows(path("ruptures"), &instants, [(places, one.clone()), (words, one)])?;
        match ruptures.iter().find(|r| r.order == 1) {
            Some(first) => self.send_first(stream, info, first),
            None => Ok(()),
        }
    }

    fn send_first(&self, stream: &Stream, info: &RunInfo, first: &Rupture) -> Result<()> {
        let [strain, stress] = mark(first);
        let [x, y] = self.place([strain, stress]);
        let colour = Color::from_u32(paint::FIRST);
        // In short lines, left of the line that leads down to the axis.
        let words = names::first_break(info, first).replacen(": ", ":\n", 1);
        let text = format!("{words}\n{strain:.2} %, {stress:.0} MPa");
        let label = [0.6 * x, 0.72 * y];
        let leader = LineStrips2D::new([[[x, y], label], [[x, y], [x, 0.0]], [[x, y], [0.0, y]]]);
        let leader = leader.with_colors([colour]).with_radii([Radius::new_ui_points(0.75)]);
        let points = Points2D::new([[x, y], label])
            .with_colors([colour])
            .with_radii([Radius::new_ui_points(5.0), Radius::new_ui_points(0.1)])
            .with_labels([String::new(), text])
            .with_show_labels(true)
            .with_draw_order(OVER + 10.0);
        let instant = Instant::from(first);
        stream.row(path("first_break"), instant, &leader.with_draw_order(15.0))?;
        stream.row(path("first_break").join(&"mark".into()), instant, &points)
    }
}

fn path_of(info: &RunInfo, series: &Series) -> EntityPath {
    match series.layer {
        None => path("body"),
        Some(layer) => names::layer(&format!("{}/layers", names::CHART), info, layer),
    }
}

fn colour_of(series: &Series) -> u32 {
    series.layer.map_or(WHITE, distinct)
}

fn path(part: &str) -> EntityPath {
    EntityPath::from(format!("{}/{part}", names::CHART))
}

fn shift([x, y]: [f32; 2], [dx, dy]: [f32; 2]) -> [f32; 2] {
    [x + dx, y + dy]
}
