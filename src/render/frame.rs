//! One snapshot to one picture.

use super::body::Body;
use super::canvas::{Canvas, Fonts, Rect};
use super::colour::ColourScale;
use super::data::Data;
use super::history::History;
use super::layout::{Layout, layout};
use super::painter::{Drawing, Painter};
use super::panel::Shot;
use super::panels::{Entry, PANELS, usual};
use super::style::Style;
use super::wires::{self, Looks, Segment};
use super::{header, marks};
use crate::base::error::{Error, Result};
use crate::engine::view::{RunInfo, Snapshot};
use crate::observe::timings::Timings;
use crate::scene::look::FRAME_SIDE;
use crate::scene::spec::{OutputSpec, View};
use image::{Rgb as Pixel, RgbImage};
use std::time::Instant;

/// Draws frames of one run.
pub struct Renderer {
    info: RunInfo,
    look: OutputSpec,
    style: Style,
    scale: ColourScale,
    body: Body,
    layout: Layout,
    fonts: Fonts,
    solid: Option<Solid>,
    timings: Timings,
}

/// What the adapter needs, present when some panel is three-dimensional.
struct Solid {
    painter: Painter,
    area: Rect,
}

impl Renderer {
    /// Opens the adapter and lays frames out that look as a scene's output says.
    ///
    /// # Errors
    /// When there is no adapter, when it cannot draw a picture of this size, when no panel would be larger than a
    /// few pixels.
    pub fn new(info: &RunInfo, look: &OutputSpec) -> Result<Self> {
        let views = if look.views.is_empty() { usual(info) } else { look.views.clone() };
        let [w, h] = look.frame_size;
        if !FRAME_SIDE.contains(&w) || !FRAME_SIDE.contains(&h) {
            let what = format!("frames of {w} × {h} pixels cannot be drawn");
            return Err(Error::input(
                what,
                format!("a side has {} to {} pixels", FRAME_SIDE.start(), FRAME_SIDE.end()),
            ));
        }
        let layout = layout(look.frame_size, &views);
        Ok(Self {
            style: look.theme.style(),
            scale: ColourScale::new(info, look.colour),
            body: Body::of(info),
            fonts: Fonts::embedded(),
            solid: Solid::open(&layout)?,
            timings: Timings::default(),
            info: info.clone(),
            look: look.clone(),
            layout,
        })
    }

    /// Name of the adapter; `None` when no panel needs one.
    pub fn adapter(&self) -> Option<&str> {
        self.solid.as_ref().map(|s| s.painter.adapter())
    }

    /// Where the time went so far.
    pub fn timings(&self) -> Timings {
        self.timings
    }

    /// The panels of the frame and their places in pixels: x, y, width, height.
    pub fn panels(&self) -> Vec<(View, [u32; 4])> {
        self.layout.panels.iter().map(|(v, r)| (*v, [r.x, r.y, r.w, r.h].map(|c| c as u32))).collect()
    }

    /// Tells a history of its next snapshot, after rows and ruptures up to it were added: to be called for every snapshot of
    /// a run, also for those that are not drawn.
    pub fn follow(&self, history: &mut History, snapshot: &Snapshot) {
        history.follow(&self.info, &self.body, &self.look.camera, snapshot);
    }

    /// Draws one frame of the snapshot that a history was told last.
    ///
    /// # Errors
    /// When the adapter is lost.
    pub fn draw(&mut self, snapshot: &Snapshot, history: &History) -> Result<RgbImage> {
        let start = Instant::now();
        let colours = self.scale.particles(&self.info, snapshot);
        let data = Data {
            info: &self.info,
            body: &self.body,
            snapshot,
            rows: &history.rows,
            measured: &history.measured,
            ruptures: &history.ruptures,
            scale: &self.scale,
            colours: &colours,
            style: &self.style,
            camera: &self.look.camera,
            focus: history.focus(&self.info, &self.body),
        };
        let [w, h] = self.look.frame_size;
        let mut picture = RgbImage::from_pixel(w, h, Pixel(self.style.page));
        let unit = self.layout.unit;
        let panels = self.layout.panels.iter();
        let shots: Vec<_> = panels.flat_map(|(view, area)| of(*view).panel.shots(&data, *area, unit)).collect();
        if let Some(solid) = &self.solid {
            solid.draw(&data, &shots)?;
            self.timings.draw += start.elapsed();
            let start = Instant::now();
            solid.read_into(&mut picture, &shots)?;
            self.timings.read_back += start.elapsed();
        }
        let start = Instant::now();
        let mut canvas = Canvas { image: picture, fonts: &self.fonts, unit };
        overlay(&mut canvas, &data, &self.layout, &shots);
        self.timings.overlay += start.elapsed();
        self.timings.frames += 1;
        Ok(canvas.image)
    }
}

/// The row of a view in the table.
fn of(view: View) -> &'static Entry {
    PANELS.iter().find(|entry| entry.view == view).expect("every view has its row")
}

impl Solid {
    fn open(layout: &Layout) -> Result<Option<Self>> {
        let solid = layout.panels.iter().filter(|(view, _)| !of(*view).flat).map(|(_, area)| *area);
        let Some(area) = solid.reduce(around) else {
            return Ok(None);
        };
        Ok(Some(Self { painter: Painter::open([area.w as u32, area.h as u32])?, area }))
    }

    fn draw(&self, data: &Data, shots: &[Shot]) -> Result<()> {
        let position = data.snapshot.position.clone();
        let whole = Looks::new(data.info, data.snapshot, position, data.colours, data.body.shade(), Vec::new());
        let mut all: Vec<Segment> = Vec::new();
        let mut drawings = Vec::new();
        let spacing = 2.0 * data.info.radius.first().copied().unwrap_or(1e-3);
        let mut own: Option<(View, Option<Looks>)> = None;
        for shot in shots {
            if own.as_ref().is_none_or(|(view, _)| *view != shot.view) {
                own = Some((shot.view, of(shot.view).panel.looks(data, &shot.camera)));
            }
            let looks = own.as_ref().and_then(|(_, looks)| looks.as_ref()).unwrap_or(&whole);
            let stride = wires::stride(spacing * shot.camera.scale);
            let sees = |a, b| shot.camera.sees(a, b);
            let segments = wires::segments(data.info, data.snapshot, looks, stride, shot.layer, sees);
            drawings.push(Drawing::new(shot.camera, shot.fade, &segments, &mut all));
        }
        let segments = self.painter.upload(&all);
        self.painter.draw([self.area.x, self.area.y], data.style, &segments, &drawings)
    }

    /// Copies the panels, and nothing between them, into the picture.
    fn read_into(&self, picture: &mut RgbImage, shots: &[Shot]) -> Result<()> {
        let (left, top) = (self.area.x as usize, self.area.y as usize);
        let width = picture.width() as usize;
        let bytes: &mut [u8] = picture;
        self.painter.read(|y, row| {
            let y = top + y as usize;
            let crosses = |p: &Rect| (p.y as usize..p.bottom() as usize).contains(&y);
            for panel in shots.iter().map(|s| s.camera.panel).filter(crosses) {
                let (from, to) = (panel.x as usize, panel.right() as usize);
                let out = &mut bytes[(y * width + from) * 3..(y * width + to) * 3];
                let row = &row[(from - left) * 4..(to - left) * 4];
                for (to, from) in out.chunks_exact_mut(3).zip(row.chunks_exact(4)) {
                    to.copy_from_slice(&from[..3]);
                }
            }
        })
    }
}

fn around(a: Rect, b: Rect) -> Rect {
    let (x, y) = (a.x.min(b.x), a.y.min(b.y));
    Rect::new(x, y, a.right().max(b.right()) - x, a.bottom().max(b.bottom()) - y)
}

fn overlay(canvas: &mut Canvas, data: &Data, layout: &Layout, shots: &[Shot]) {
    header::draw(canvas, layout.header, data);
    for (view, area) in &layout.panels {
        of(*view).panel.draw(canvas, *area, data);
    }
    for shot in shots {
        if shot.measures {
            marks::scale_bar(canvas, &shot.camera, data);
            marks::axes(canvas, &shot.camera, data);
        }
        of(shot.view).panel.annotate(canvas, shot, data, shots);
        marks::title_over(canvas, shot.camera.panel, data, &shot.caption, &shot.remark);
    }
}
