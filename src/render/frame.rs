//! One snapshot to one picture.

use super::bodies;
use super::body::Body;
use super::canvas::{Canvas, Fonts, Rect};
use super::close_up::Focus;
use super::colour::ColourScale;
use super::data::Data;
use super::history::History;
use super::layout::{Layout, layout};
use super::painter::{Drawing, Painter};
use super::panel::Shot;
use super::panels::{Entry, PANELS, usual};
use super::stripe;
use super::style::{Rgb, Style};
use super::wires::{self, Looks, Segment};
use super::{header, marks};
use crate::base::error::{Error, Result};
use crate::engine::view::{RunInfo, Snapshot};
use crate::observe::timings::Timings;
use crate::scene::look::FRAME_SIDE;
use crate::scene::spec::{OutputSpec, View};
use image::{Rgb as Pixel, RgbImage};
use std::cell::LazyCell;
use std::sync::Arc;
use std::time::Instant;

/// Draws frames of one run.
pub struct Renderer {
    sheet: Arc<Sheet>,
    solid: Option<Solid>,
    timings: Timings,
}

/// What all frames of a run have in common, and what draws over their wires.
pub(super) struct Sheet {
    info: RunInfo,
    look: OutputSpec,
    style: Style,
    scale: ColourScale,
    body: Body,
    layout: Layout,
    fonts: Fonts,
}

/// What a frame shows of its wires.
pub(super) struct Scene {
    colours: Vec<Rgb>,
    focus: Focus,
    shots: Vec<Shot>,
    segments: Vec<Segment>,
    drawings: Vec<Drawing>,
}

/// A frame with its wires, without charts and text.
pub(super) struct Wires {
    scene: Scene,
    picture: RgbImage,
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
        let solid = Solid::open(&layout, look.supersampling)?;
        let sheet = Sheet {
            style: look.theme.style(),
            scale: ColourScale::new(info, look.colour),
            body: Body::of(info),
            fonts: Fonts::embedded(),
            info: info.clone(),
            look: look.clone(),
            layout,
        };
        Ok(Self { sheet: Arc::new(sheet), solid, timings: Timings::default() })
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
        self.sheet.layout.panels.iter().map(|(v, r)| (*v, [r.x, r.y, r.w, r.h].map(|c| c as u32))).collect()
    }

    /// Tells a history of its next snapshot, after rows and ruptures up to it were added: to be called for every snapshot of
    /// a run, also for those that are not drawn.
    pub fn follow(&self, history: &mut History, snapshot: &Snapshot) {
        history.follow(&self.sheet.info, &self.sheet.body, &self.sheet.look.camera, snapshot);
    }

    /// Draws one frame of the snapshot that a history was told last.
    ///
    /// # Errors
    /// When the adapter is lost.
    pub fn draw(&mut self, snapshot: &Snapshot, history: &History) -> Result<RgbImage> {
        let scene = self.prepare(snapshot, history);
        self.begin(&scene);
        let wires = self.collect(scene)?;
        let start = Instant::now();
        let picture = self.sheet.finish(wires, snapshot, history);
        self.timings.overlay += start.elapsed();
        Ok(picture)
    }

    /// What draws over the wires, on any thread.
    pub(super) fn sheet(&self) -> Arc<Sheet> {
        self.sheet.clone()
    }

    /// Makes one frame of the snapshot that a history was told last ready to be drawn.
    pub(super) fn prepare(&mut self, snapshot: &Snapshot, history: &History) -> Scene {
        let start = Instant::now();
        let scene = self.sheet.scene(snapshot, history);
        self.timings.draw += start.elapsed();
        scene
    }

    /// Has the adapter draw a scene; the one before must have been collected.
    pub(super) fn begin(&mut self, scene: &Scene) {
        let start = Instant::now();
        if let Some(Solid { painter, area }) = &self.solid {
            painter.draw([area.x, area.y], &self.sheet.style, &scene.segments, &scene.drawings);
        }
        self.timings.draw += start.elapsed();
    }

    /// Waits for the scene that was begun last.
    ///
    /// # Errors
    /// When the adapter is lost.
    pub(super) fn collect(&mut self, scene: Scene) -> Result<Wires> {
        let [w, h] = self.sheet.look.frame_size;
        let mut picture = RgbImage::from_pixel(w, h, Pixel(self.sheet.style.page));
        let start = Instant::now();
        let mut drawn = start;
        if let Some(solid) = &self.solid {
            drawn = solid.read_into(&mut picture, &scene.shots)?;
        }
        self.timings.draw += drawn - start;
        self.timings.read_back += drawn.elapsed();
        self.timings.frames += 1;
        Ok(Wires { scene, picture })
    }
}

impl Sheet {
    fn data<'a>(&'a self, snapshot: &'a Snapshot, history: &'a History, colours: &'a [Rgb], focus: Focus) -> Data<'a> {
        Data {
            info: &self.info,
            body: &self.body,
            snapshot,
            rows: &history.rows,
            measured: &history.measured,
            ruptures: &history.ruptures,
            scale: &self.scale,
            colours,
            style: &self.style,
            camera: &self.look.camera,
            focus,
        }
    }

    fn scene(&self, snapshot: &Snapshot, history: &History) -> Scene {
        let colours = self.scale.particles(&self.info, snapshot);
        let focus = history.focus(&self.info, &self.body);
        let data = self.data(snapshot, history, &colours, focus);
        let panels = self.layout.panels.iter();
        let shots: Vec<Shot> =
            panels.flat_map(|(view, area)| of(*view).panel.shots(&data, *area, self.layout.unit)).collect();
        let (segments, drawings) = wires_of(&data, &shots, self.look.supersampling as f32);
        Scene { focus, shots, segments, drawings, colours }
    }

    /// Draws charts and text over the wires.
    pub(super) fn finish(&self, wires: Wires, snapshot: &Snapshot, history: &History) -> RgbImage {
        let Wires { scene, picture } = wires;
        let data = self.data(snapshot, history, &scene.colours, scene.focus);
        let mut canvas = Canvas { image: picture, fonts: &self.fonts, unit: self.layout.unit };
        overlay(&mut canvas, &data, &self.layout, &scene.shots);
        canvas.image
    }
}

/// The segments of all shots and how they are drawn, `times` finer than pixels.
fn wires_of(data: &Data, shots: &[Shot], times: f32) -> (Vec<Segment>, Vec<Drawing>) {
    let whole = LazyCell::new(|| {
        let position = data.snapshot.position.clone();
        Looks::new(data.info, data.snapshot, position, data.colours, data.body.shade(), Vec::new())
    });
    let spacing = 2.0 * data.info.radius.first().copied().unwrap_or(1e-3);
    let (mut all, mut drawings) = (Vec::new(), Vec::new());
    let mut own: Option<(View, Option<Looks>)> = None;
    for shot in shots {
        if own.as_ref().is_none_or(|(view, _)| *view != shot.view) {
            own = Some((shot.view, of(shot.view).panel.looks(data, &shot.camera)));
        }
        let looks = own.as_ref().and_then(|(_, looks)| looks.as_ref()).unwrap_or_else(|| &whole);
        let stride = wires::stride(spacing * shot.camera.scale * times);
        let sees = |a, b| shot.camera.sees(a, b);
        let mut segments = wires::segments(data.info, data.snapshot, looks, stride, shot.layer, sees);
        segments.extend(stripe::segments(data.info, data.snapshot, looks, shot.layer, sees));
        // Where wires are moved apart there is no place for them.
        if shot.layer.is_none() && shot.view != View::Exploded {
            segments.extend(bodies::segments(data.info, data.snapshot));
        }
        drawings.push(Drawing::new(shot.camera, shot.fade, &segments, &mut all));
    }
    (all, drawings)
}

/// The row of a view in the table.
fn of(view: View) -> &'static Entry {
    PANELS.iter().find(|entry| entry.view == view).expect("every view has its row")
}

impl Solid {
    fn open(layout: &Layout, times: u32) -> Result<Option<Self>> {
        let solid = layout.panels.iter().filter(|(view, _)| !of(*view).flat).map(|(_, area)| *area);
        let Some(area) = solid.reduce(around) else {
            return Ok(None);
        };
        Ok(Some(Self { painter: Painter::open([area.w as u32, area.h as u32], times)?, area }))
    }

    /// Waits for the adapter and copies the panels, and nothing between them, into the picture; returns when it was drawn.
    fn read_into(&self, picture: &mut RgbImage, shots: &[Shot]) -> Result<Instant> {
        let mut drawn = None;
        let (left, top) = (self.area.x as usize, self.area.y as usize);
        let width = picture.width() as usize;
        let bytes: &mut [u8] = picture;
        self.painter.read(|y, row| {
            drawn.get_or_insert_with(Instant::now);
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
        })?;
        Ok(drawn.unwrap_or_else(Instant::now))
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
