//! Stress over strain as a drawing: a plot of the viewer can only count along a timeline, a drawing has axes in per
//! cent and MPa, and room to name the first break. The view shows all times up to the cursor, so the curve grows with
//! it and every piece is sent once.

use super::paint::{self, distinct};
use super::stream::{Instant, Stream, strips, texts, vectors};
use super::{curve, names};
use crate::base::error::Result;
use crate::engine::view::{RunInfo, Rupture, Sample};
use crate::observe::units::{mpa, percent};
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
    /// Strain at the right end (%).
    strain: f64,
    /// Stress at the upper end (MPa).
    stress: f64,
    /// Last point of each curve: the strand, then layers.
    last: Option<Vec<[f32; 2]>>,
}

impl Chart {
    /// The chart of a run that is pulled; `None` for others, which have no curve of stress over strain.
    pub fn new(info: &RunInfo) -> Option<Self> {
        let end = info.strain_end.filter(|end| info.is_pulled() && *end > 0.0)?;
        // The range is one of true stress; force over initial section is smaller by the stretch.
        let stress = f64::from(info.stress_range[1]) / (1.0 + end) * HEADROOM;
        Some(Self { strain: percent(end), stress, last: None })
    }

    /// x and y range that the view shows.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let [left, right, above, below] = MARGINS.map(f64::from);
        let [width, height] = SIZE.map(f64::from);
        [[-left, width + right], [-height - above, below]]
    }

    fn place(&self, strain_percent: f64, stress_mpa: f64) -> [f32; 2] {
        let [x, y] = [strain_percent / self.strain, stress_mpa / self.stress];
        [x as f32 * SIZE[0], -y as f32 * SIZE[1]]
    }

    /// Sends axes, ticks and legend.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Io`] when Rerun refuses the data.
    pub fn send_fixed(&self, stream: &Stream, info: &RunInfo) -> Result<()> {
        let (along, up) = (ticks(self.strain), ticks(self.stress));
        let vertical = along.iter().map(|e| [self.place(*e, 0.0), self.place(*e, self.stress)]);
        let level = up.iter().map(|s| [self.place(0.0, *s), self.place(self.strain, *s)]);
        let grid = LineStrips2D::new(vertical.chain(level))
            .with_colors([Color::from_u32(GRID)])
            .with_radii([Radius::new_ui_points(0.5)]);
        stream.fixed(path("grid"), &grid)?;
        let below = along.iter().map(|e| (shift(self.place(*e, 0.0), [0.0, 1.5]), format!("{e} %")));
        let beside = up.iter().map(|s| (shift(self.place(0.0, *s), [-15.0, -5.0]), format!("{s} MPa")));
        stream.fixed(path("axes"), &labels(below.chain(beside), paint::NEUTRAL))?;
        for (i, Series { path: curve, name, colour }) in series(info).into_iter().enumerate() {
            let style = LineStrips2D::update_fields()
                .with_colors([Color::from_u32(colour)])
                .with_radii([Radius::new_ui_points(if i == 0 { 1.75 } else { 1.0 })]);
            stream.fixed(curve.clone(), &style)?;
            let place = [(0.25 + 0.2 * (i % 2) as f32) * SIZE[0], (-0.32 + 0.13 * (i / 2) as f32) * SIZE[1]];
            stream.fixed(curve.join(&"name".into()), &labels([(place, name)], colour))?;
        }
        let marks = Points2D::update_fields()
            .with_colors([Color::from_u32(paint::BROKEN)])
            .with_radii([Radius::new_ui_points(2.5)])
            .with_draw_order(10.0)
            .with_show_labels(false);
        stream.fixed(path("ruptures"), &marks)
    }

    /// Sends the next pieces of the curves.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Io`] when Rerun refuses the data.
    pub fn send(&mut self, stream: &Stream, info: &RunInfo, samples: &[Sample]) -> Result<()> {
        let points: Vec<Vec<[f32; 2]>> = samples.iter().map(|s| self.points(s)).collect();
        let instants: Vec<_> = samples.iter().map(curve::instant).collect();
        let Some(first) = points.first().cloned() else { return Ok(()) };
        let before = self.last.take().unwrap_or(first);
        for (i, Series { path, .. }) in series(info).into_iter().enumerate() {
            let ends = std::iter::once(before[i]).chain(points.iter().map(|p| p[i]));
            let pieces = ends.zip(points.iter().map(|p| p[i])).flat_map(|(a, b)| [a, b]);
            let batch = strips(LineStrips2D::descriptor_strips(), pieces, 2);
            stream.rows(path, &instants, [(batch, vec![1; instants.len()])])?;
        }
        self.last = points.last().cloned();
        Ok(())
    }

    /// Marks ruptures on the curve of the strand, and names the first.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Io`] when Rerun refuses the data.
    pub fn send_ruptures(&self, stream: &Stream, info: &RunInfo, ruptures: &[Rupture]) -> Result<()> {
        let instants: Vec<_> = ruptures.iter().map(Instant::from).collect();
        let place = |r: &Rupture| self.place(percent(r.strain), mpa(r.body_stress));
        let words = |r: &Rupture| {
            let wire = wire_number(r.wire);
            format!("{}: wire {wire}, {:.1} MPa at {:.2} %", r.order, mpa(r.body_stress), percent(r.strain))
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
        let [x, y] = self.place(percent(first.strain), mpa(first.body_stress));
        let colour = Color::from_u32(paint::FIRST);
        let text = format!(
            "{}\n{:.2} %, {:.0} MPa",
            names::first_break(info, first),
            percent(first.strain),
            mpa(first.body_stress)
        );
        let label = [0.65 * x, 0.72 * y];
        let leader = LineStrips2D::new([[[x, y], label], [[x, y], [x, 0.0]], [[x, y], [0.0, y]]]);
        let leader = leader.with_colors([colour]).with_radii([Radius::new_ui_points(0.75)]);
        let points = Points2D::new([[x, y], label])
            .with_colors([colour])
            .with_radii([Radius::new_ui_points(5.0), Radius::new_ui_points(0.1)])
            .with_labels([String::new(), text])
            .with_show_labels(true)
            .with_draw_order(20.0);
        let instant = Instant::from(first);
        stream.row(path("first_break"), instant, &leader.with_draw_order(15.0))?;
        stream.row(path("first_break").join(&"mark".into()), instant, &points)
    }

    /// The strand's point of a row, then those of layers.
    fn points(&self, sample: &Sample) -> Vec<[f32; 2]> {
        let stresses = std::iter::once(&sample.stress).chain(&sample.layer_stress);
        stresses.map(|s| self.place(percent(sample.strain), mpa(*s))).collect()
    }
}

/// A curve.
struct Series {
    path: EntityPath,
    name: String,
    colour: u32,
}

/// The curve of the strand, then those of layers.
fn series(info: &RunInfo) -> Vec<Series> {
    let name = if info.wires.len() > 1 { "strand" } else { "wire" };
    let body = Series { path: path("body"), name: name.to_owned(), colour: WHITE };
    let layers = (0..info.layers.len()).map(|layer| Series {
        path: names::layer(&format!("{}/layers", names::CHART), info, layer),
        name: names::layer_name(info, layer),
        colour: distinct(layer),
    });
    // One layer alone has the curve of the body.
    std::iter::once(body).chain(layers.filter(|_| info.layers.len() > 1)).collect()
}

fn path(part: &str) -> EntityPath {
    EntityPath::from(format!("{}/{part}", names::CHART))
}

fn shift([x, y]: [f32; 2], [dx, dy]: [f32; 2]) -> [f32; 2] {
    [x + dx, y + dy]
}

/// Texts without visible points.
fn labels(all: impl IntoIterator<Item = ([f32; 2], String)>, colour: u32) -> Points2D {
    let (places, words): (Vec<_>, Vec<_>) = all.into_iter().unzip();
    Points2D::new(places)
        .with_labels(words)
        .with_show_labels(true)
        .with_colors([Color::from_u32(colour)])
        .with_radii([Radius::new_ui_points(0.1)])
}

/// Round numbers from 0 up to `end`, three to six of them.
fn ticks(end: f64) -> Vec<f64> {
    let step = super::map::round_step(end as f32 / 6.0);
    let count = (end / f64::from(step)) as u32;
    // Back through text: 3 · 0.1 is 0.30000001 in binary.
    (0..=count).filter_map(|i| format!("{:.6}", f64::from(i) * f64::from(step)).parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        assert_eq!(ticks(29.3), [0.0, 5.0, 10.0, 15.0, 20.0, 25.0]);
        assert_eq!(ticks(0.34), [0.0, 0.1, 0.2, 0.3]);
        assert_eq!(ticks(368.0), [0.0, 100.0, 200.0, 300.0]);
    }
}
