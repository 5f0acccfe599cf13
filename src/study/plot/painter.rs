//! Draws one figure: axes by plotters, everything else in pixels.

use super::axis::{Span, can_show};
use super::figure::{Figure, Legend, Mark, Series};
use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Family of all text.
pub const FONT: &str = "Inter";
/// Text: axes, ticks and legend; titles (px).
const TEXT: f64 = 14.0;
const TITLE: f64 = 17.0;
/// Radius of a marker, width of a line, gap beside text (px).
const MARKER: f64 = 4.5;
const LINE: f64 = 1.8;
const GAP: f64 = 5.0;
/// Widths of a line behind everything and of an error bar, radius of the ring around a point that stands out (px).
const BROAD: f64 = 7.0;
const BAR: f64 = 1.0;
const RING: f64 = 9.0;
/// Height of a line of the legend, and width of its sample of a line (px).
const ROW: f64 = 19.0;
const SAMPLE: f64 = 28.0;
/// Dash and gap of reference lines (px).
const DASH: [f64; 2] = [7.0, 5.0];

const INK: RGBColor = RGBColor(40, 40, 40);
const GREY: RGBColor = RGBColor(110, 110, 110);
/// Of lines behind everything.
const BAND: RGBColor = RGBColor(205, 205, 205);
const GRID: RGBColor = RGBColor(218, 218, 218);
const FINE_GRID: RGBColor = RGBColor(240, 240, 240);
/// Okabe & Ito's palette, which the colour-blind can tell apart.
const PALETTE: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];

type Pixel = (i32, i32);
type Drawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// One figure in one part of a sheet.
pub struct Painter<'a, B: DrawingBackend> {
    figure: &'a Figure,
    area: &'a DrawingArea<B, Shift>,
    /// Pixels per pixel of an SVG (-).
    scale: f64,
    x: Span,
    y: Span,
    /// Left, top, right and bottom of the frame; known once the axes are drawn.
    frame: [i32; 4],
}

/// A line of the legend.
struct Entry<'a> {
    name: &'a str,
    mark: Mark,
    colour: RGBColor,
    index: usize,
}

impl<'a, B: DrawingBackend> Painter<'a, B> {
    /// `figure` in `area`, with `scale` pixels per pixel of an SVG.
    pub fn new(figure: &'a Figure, area: &'a DrawingArea<B, Shift>, scale: f64) -> Self {
        let [x, y] = spans(figure);
        Self { figure, area, scale, x, y, frame: [0; 4] }
    }

    /// Draws everything.
    pub fn paint(&mut self) -> Drawn<B> {
        self.axes()?;
        self.limits()?;
        self.slopes()?;
        let behind = |series: &Series| series.mark == Mark::Behind;
        for at_the_back in [true, false] {
            for (index, series) in self.figure.series.iter().enumerate().filter(|(_, s)| behind(s) == at_the_back) {
                self.series(index, series)?;
            }
        }
        self.highlights()?;
        self.legend()
    }

    fn px(&self, size: f64) -> i32 {
        (size * self.scale).round() as i32
    }

    fn text(&self, size: f64, colour: &RGBColor) -> TextStyle<'static> {
        (FONT, size * self.scale).into_font().color(colour)
    }

    fn stroke(&self, colour: RGBColor, width: f64) -> ShapeStyle {
        ShapeStyle::from(&colour).stroke_width(self.px(width).max(1) as u32)
    }

    fn axes(&mut self) -> Drawn<B> {
        let f = self.figure;
        let title = (FONT, TITLE * self.scale).into_font().style(FontStyle::Bold).color(&INK);
        let beside = if f.legend == Legend::Beside { self.legend_size(&self.entries()).0 } else { 0 };
        let mut chart = ChartBuilder::on(self.area)
            .margin(self.px(10.0))
            .margin_right(self.px(18.0) + beside)
            .caption(&f.title, title)
            .x_label_area_size(self.px(48.0))
            .y_label_area_size(self.px(72.0))
            .build_cartesian_2d(self.x.clone(), self.y.clone())?;
        chart
            .configure_mesh()
            .x_desc(&f.x.label)
            .y_desc(&f.y.label)
            .axis_desc_style(self.text(TEXT, &INK))
            .label_style(self.text(TEXT, &INK))
            .axis_style(self.stroke(INK, 1.0))
            .bold_line_style(self.stroke(GRID, 1.0))
            .light_line_style(self.stroke(FINE_GRID, 1.0))
            .set_all_tick_mark_size(self.px(4.0))
            .draw()?;
        let (width, height) = chart.plotting_area().get_pixel_range();
        let (left, top) = self.area.get_base_pixel();
        self.frame = [width.start - left, height.start - top, width.end - left, height.end - top];
        Ok(())
    }

    /// Where a point lies.
    fn at(&self, point: [f64; 2]) -> Pixel {
        let [left, top, right, bottom] = self.frame;
        let along = |share: f64, from: i32, to: i32| from + (share * f64::from(to - from)).round() as i32;
        (along(self.x.share(point[0]), left, right), along(self.y.share(point[1]), bottom, top))
    }

    fn line(&self, points: Vec<Pixel>, style: ShapeStyle, dash: Option<[f64; 2]>) -> Drawn<B> {
        match dash {
            None => self.area.draw(&PathElement::new(points, style)),
            Some([dash, gap]) => {
                let (dash, gap) = (self.px(dash), self.px(gap));
                self.area.draw(&DashedPathElement::new(points, dash, gap, style))
            }
        }
    }

    fn limits(&self) -> Drawn<B> {
        let [left, _, right, _] = self.frame;
        let gap = self.px(GAP);
        for limit in &self.figure.limits {
            let y = self.at([self.x.low(), limit.y]).1;
            self.line(vec![(left, y), (right, y)], self.stroke(GREY, 1.2), Some(DASH))?;
            let place = (left + gap, y - self.px(TEXT) - gap / 2);
            self.area.draw(&Text::new(limit.name.as_str(), place, self.text(TEXT, &GREY)))?;
        }
        Ok(())
    }

    fn slopes(&self) -> Drawn<B> {
        for slope in &self.figure.slopes {
            let [x0, y0] = slope.through;
            let at = |x: f64| y0 * (x / x0).powf(slope.order);
            let back = |y: f64| x0 * (y / y0).powf(1.0 / slope.order);
            // Clipped to the frame.
            let (a, b) = (back(self.y.low()), back(self.y.high()));
            let ends = [self.x.low().max(a.min(b)), self.x.high().min(a.max(b))];
            let points = ends.map(|x| self.at([x, at(x)])).to_vec();
            self.line(points, self.stroke(GREY, 1.4), Some(SHORT_DASH))?;
        }
        Ok(())
    }

    fn series(&self, index: usize, series: &Series) -> Drawn<B> {
        let colour = colour(index, series);
        let style = self.stroke(colour, LINE);
        let shown: Vec<(usize, [f64; 2])> = self.shown(series).collect();
        let points: Vec<Pixel> = shown.iter().map(|(_, p)| self.at(*p)).collect();
        match series.mark {
            Mark::Line | Mark::LineAndPoints => self.line(points.clone(), style, None)?,
            Mark::Dashed => self.line(points.clone(), style, Some(DASH))?,
            Mark::Behind => self.line(points.clone(), self.stroke(BAND, BROAD), None)?,
            Mark::Points => {}
        }
        if has_markers(series.mark) {
            for ((i, point), at) in shown.iter().zip(points) {
                if let Some(half) = series.errors.get(*i) {
                    let [low, high] = [point[1] - half, point[1] + half].map(|y| y.clamp(self.y.low(), self.y.high()));
                    let bar = vec![self.at([point[0], low]), self.at([point[0], high])];
                    self.line(bar, self.stroke(colour, BAR), None)?;
                }
                self.marker(index, at, colour)?;
            }
        }
        Ok(())
    }

    /// Points of a series that lie within the frame, with their numbers.
    fn shown<'s>(&'s self, series: &'s Series) -> impl Iterator<Item = (usize, [f64; 2])> + use<'s, 'a, B> {
        let (x, y) = (&self.x, &self.y);
        series.points.iter().copied().enumerate().filter(move |(_, p)| x.shows(p[0]) && y.shows(p[1]))
    }

    /// A marker whose shape goes with the series' number, so that series differ without colour, too.
    fn marker(&self, index: usize, at: Pixel, colour: RGBColor) -> Drawn<B> {
        let size = MARKER * self.scale;
        let fill = colour.filled();
        let corners: &[(f64, f64)] = match index % 4 {
            0 => return self.area.draw(&Circle::new(at, size.round() as i32, fill)),
            1 => &[(0.0, -1.25), (1.15, 0.85), (-1.15, 0.85)],
            2 => &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
            _ => &[(0.0, -1.35), (1.35, 0.0), (0.0, 1.35), (-1.35, 0.0)],
        };
        let corner = |(x, y): &(f64, f64)| (at.0 + (x * size).round() as i32, at.1 + (y * size).round() as i32);
        self.area.draw(&Polygon::new(corners.iter().map(corner).collect::<Vec<_>>(), fill))
    }

    fn entries(&self) -> Vec<Entry<'a>> {
        let f = self.figure;
        let series = f.series.iter().enumerate().map(|(index, s)| Entry {
            name: &s.name,
            mark: s.mark,
            colour: colour(index, s),
            index,
        });
        let slopes = f.slopes.iter().map(|s| Entry { name: &s.name, mark: Mark::Dashed, colour: GREY, index: 0 });
        series.chain(slopes).filter(|entry| !entry.name.is_empty()).collect()
    }

    /// A ring around each point that stands out, and its name where it hides least.
    fn highlights(&self) -> Drawn<B> {
        let ring = self.px(RING);
        for highlight in self.figure.highlights.iter().filter(|h| self.x.shows(h.at[0]) && self.y.shows(h.at[1])) {
            let at = self.at(highlight.at);
            self.area.draw(&Circle::new(at, ring, self.stroke(INK, 2.0)))?;
            self.area.draw(&Circle::new(at, self.px(MARKER), INK.filled()))?;
            let font = (FONT, TEXT * self.scale).into_font().style(FontStyle::Bold);
            let (width, height) = font.box_size(&highlight.name).unwrap_or((0, 0));
            let size = (width as i32, height as i32);
            let (left, top) = self.place_beside(at, size);
            // A line from the ring to the nearest edge of the text.
            let to = (at.0.clamp(left, left + size.0), at.1.clamp(top, top + size.1));
            let [dx, dy] = [to.0 - at.0, to.1 - at.1].map(f64::from);
            let share = f64::from(ring) / dx.hypot(dy).max(1.0);
            let from = (at.0 + (share * dx).round() as i32, at.1 + (share * dy).round() as i32);
            self.line(vec![from, to], self.stroke(INK, 1.0), None)?;
            let ground = [(left - 2, top - 2), (left + size.0 + 2, top + size.1 + 2)];
            self.area.draw(&Rectangle::new(ground, WHITE.mix(0.85).filled()))?;
            self.area.draw(&Text::new(highlight.name.as_str(), (left, top), font.color(&INK)))?;
        }
        Ok(())
    }

    /// Upper left of a text of this size near `at`, within the frame, where it hides the fewest points.
    fn place_beside(&self, at: Pixel, size: (i32, i32)) -> Pixel {
        let [left, top, right, bottom] = self.frame;
        let near = [2.0, 3.5, 5.0, 8.0].map(|rings| self.px(rings * RING));
        let xs = |gap: i32| [at.0 + gap, at.0 - gap - size.0, at.0 - size.0 / 2];
        let ys = |gap: i32| [at.1 - gap - size.1, at.1 + gap];
        let places = near.iter().flat_map(|gap| ys(*gap).into_iter().flat_map(|y| xs(*gap).map(|x| (x, y))));
        let inside = |(x, y): &Pixel| left <= *x && x + size.0 <= right && top <= *y && y + size.1 <= bottom;
        places.filter(inside).min_by_key(|place| self.hidden(*place, size)).unwrap_or((at.0, at.1 - size.1))
    }

    /// Points that a box with this upper left and size hides, those included that its edge cuts.
    fn hidden(&self, place: Pixel, size: (i32, i32)) -> usize {
        let edge = self.px(MARKER);
        let inside = |p: Pixel| {
            (place.0 - edge..place.0 + size.0 + edge).contains(&p.0)
                && (place.1 - edge..place.1 + size.1 + edge).contains(&p.1)
        };
        self.figure.series.iter().flat_map(|s| self.shown(s)).filter(|(_, p)| inside(self.at(*p))).count()
    }

    fn legend_size(&self, entries: &[Entry]) -> (i32, i32) {
        let font = (FONT, TEXT * self.scale).into_font();
        let width = |e: &Entry| font.box_size(e.name).map_or(0, |(width, _)| width as i32);
        let widest = entries.iter().map(width).max().unwrap_or(0);
        let (gap, row, sample) = (self.px(GAP), self.px(ROW), self.px(SAMPLE));
        (widest + sample + 3 * gap, row * entries.len() as i32 + gap)
    }

    fn legend(&self) -> Drawn<B> {
        let entries = self.entries();
        if entries.is_empty() {
            return Ok(());
        }
        let (gap, row, sample) = (self.px(GAP), self.px(ROW), self.px(SAMPLE));
        let size = self.legend_size(&entries);
        let (left, top) = match self.figure.legend {
            Legend::Inside => self.emptiest_corner(size),
            Legend::Beside => (self.frame[2] + gap, self.frame[1]),
        };
        let back = Rectangle::new([(left, top), (left + size.0, top + size.1)], WHITE.mix(0.85).filled());
        self.area.draw(&back)?;
        for (k, entry) in entries.iter().enumerate() {
            let middle = top + gap / 2 + row * k as i32 + row / 2;
            let ends = vec![(left + gap, middle), (left + gap + sample, middle)];
            match entry.mark {
                Mark::Line | Mark::LineAndPoints => self.line(ends, self.stroke(entry.colour, LINE), None)?,
                Mark::Dashed if entry.colour == GREY => self.line(ends, self.stroke(GREY, 1.4), Some(SHORT_DASH))?,
                Mark::Dashed => self.line(ends, self.stroke(entry.colour, LINE), Some(DASH))?,
                Mark::Behind => self.line(ends, self.stroke(BAND, BROAD), None)?,
                Mark::Points => {}
            }
            if has_markers(entry.mark) {
                self.marker(entry.index, (left + gap + sample / 2, middle), entry.colour)?;
            }
            let style = self.text(TEXT, &INK).pos(Pos::new(HPos::Left, VPos::Center));
            self.area.draw(&Text::new(entry.name, (left + 2 * gap + sample, middle), style))?;
        }
        Ok(())
    }

    /// Upper left of a box of this size in the corner of the frame where it hides the fewest points.
    fn emptiest_corner(&self, size: (i32, i32)) -> Pixel {
        let [left, top, right, bottom] = self.frame;
        let gap = 2 * self.px(GAP);
        let (xs, ys) = ([right - gap - size.0, left + gap], [top + gap, bottom - gap - size.1]);
        let corners = ys.iter().flat_map(|y| xs.iter().map(move |x| (*x, *y)));
        corners.min_by_key(|corner| self.hidden(*corner, size)).expect("a frame has corners")
    }
}

/// Dash and gap of reference slopes (px).
const SHORT_DASH: [f64; 2] = [3.0, 4.0];

fn has_markers(mark: Mark) -> bool {
    matches!(mark, Mark::Points | Mark::LineAndPoints)
}

/// Colour of the series with this number.
fn colour(index: usize, series: &Series) -> RGBColor {
    let ramp = |shade: f64| {
        // Viridis is even to the eye and for the colour-blind; its last tenth is too light for lines on white.
        let colour = colorous::VIRIDIS.eval_continuous((LIGHTEST * shade).clamp(0.0, 1.0));
        RGBColor(colour.r, colour.g, colour.b)
    };
    series.shade.map_or(PALETTE[index % PALETTE.len()], ramp)
}

/// Greatest place on the colour map that is used for lines on white (-).
const LIGHTEST: f64 = 0.9;

/// Ranges of both axes, which hold series, error bars and limits.
fn spans(figure: &Figure) -> [Span; 2] {
    let shown = |p: &[f64; 2]| can_show(figure.x.scale, p[0]) && can_show(figure.y.scale, p[1]);
    let (mut xs, mut ys) = (Vec::new(), Vec::new());
    for series in &figure.series {
        for (i, point) in series.points.iter().enumerate().filter(|(_, p)| shown(p)) {
            let half = series.errors.get(i).copied().unwrap_or(0.0);
            xs.push(point[0]);
            ys.extend([point[1], point[1] - half, point[1] + half]);
        }
    }
    let limits = figure.limits.iter().map(|limit| limit.y);
    [Span::new(&figure.x, xs.into_iter()), Span::new(&figure.y, ys.into_iter().chain(limits))]
}
