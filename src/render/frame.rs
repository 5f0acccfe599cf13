//! One snapshot to one picture.

use super::adapter::Gpu;
use super::camera::Camera;
use super::canvas::{Canvas, Fonts, Rect};
use super::colour::ColourScale;
use super::layout::{Layout, default_views, layout};
use super::occlusion::occlusion;
use super::shots::{Shot, focus, is_solid, shots};
use super::solid::{Drawing, SolidPipeline};
use super::style::{FrameOptions, Rgb, Style, View};
use super::target::Target;
use super::timings::Timings;
use super::viewpoint::{self, Body};
use super::wires::{self, Looks, Segment};
use super::{curve, cut, cutaway, exploded, header, marks, unrolled};
use crate::base::error::{Error, Result};
use crate::engine::view::{RunInfo, Rupture, Snapshot};
use crate::scene::look::FRAME_SIDE;
use glam::Vec3;
use image::{Rgb as Pixel, RgbImage};
use std::time::Instant;

/// What the panels of one frame draw from.
pub struct Data<'a> {
    /// The run.
    pub info: &'a RunInfo,
    /// Its body at rest.
    pub body: &'a Body,
    /// The instant.
    pub snapshot: &'a Snapshot,
    /// Strain (-) and nominal stress (Pa) so far.
    pub curve: &'a [(f64, f64)],
    /// Ruptures so far, in order.
    pub ruptures: &'a [Rupture],
    /// Colour scale.
    pub scale: &'a ColourScale,
    /// Colour of each particle.
    pub colours: &'a [Rgb],
    /// Theme.
    pub style: &'a Style,
}

impl Data<'_> {
    /// Each wire's first rupture with its number in the order in which wires broke, from 1.
    pub fn first_breaks(&self) -> impl Iterator<Item = (usize, &Rupture)> {
        self.ruptures.iter().filter(|r| r.first_of_wire).enumerate().map(|(k, r)| (k + 1, r))
    }

    /// Where the broken bond is now, between its two particles (mm).
    pub fn place(&self, rupture: &Rupture) -> Vec3 {
        let at = |i: usize| Vec3::from(self.snapshot.position[i]);
        0.5 * (at(rupture.bond) + at(rupture.bond + 1))
    }

    /// z of the two grip faces now (mm).
    pub fn grip_faces(&self) -> Option<[f32; 2]> {
        self.info.gauge.map(|faces| faces.map(|z| viewpoint::current_z(self.info, self.snapshot, z)))
    }

    /// z of the body's two ends now (mm).
    pub fn ends(&self) -> [f32; 2] {
        [self.body.low.z, self.body.high.z].map(|z| viewpoint::current_z(self.info, self.snapshot, z))
    }
}

/// Draws frames of one run.
pub struct Renderer {
    info: RunInfo,
    options: FrameOptions,
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
    gpu: Gpu,
    pipeline: SolidPipeline,
    target: Target,
    area: Rect,
}

impl Renderer {
    /// Opens the adapter and lays the frame out.
    ///
    /// # Errors
    /// When there is no adapter, when it cannot draw a picture of this size, when no panel would be larger than a
    /// few pixels.
    pub fn new(info: &RunInfo, options: &FrameOptions) -> Result<Self> {
        let views = if options.views.is_empty() { default_views(info) } else { options.views.clone() };
        let [w, h] = options.size;
        if !FRAME_SIDE.contains(&w) || !FRAME_SIDE.contains(&h) {
            let what = format!("frames of {w} × {h} pixels cannot be drawn");
            return Err(Error::input(
                what,
                format!("a side has {} to {} pixels", FRAME_SIDE.start(), FRAME_SIDE.end()),
            ));
        }
        let layout = layout(options.size, &views);
        Ok(Self {
            style: options.theme.style(),
            scale: ColourScale::new(info, options.colour),
            body: Body::of(info),
            fonts: Fonts::embedded(),
            solid: Solid::open(&layout)?,
            timings: Timings::default(),
            info: info.clone(),
            options: options.clone(),
            layout,
        })
    }

    /// Name of the adapter; `None` when no panel needs one.
    pub fn adapter(&self) -> Option<&str> {
        self.solid.as_ref().map(|s| s.gpu.name.as_str())
    }

    /// Where the time went so far.
    pub fn timings(&self) -> Timings {
        self.timings
    }

    /// The panels of the frame and their places in pixels: x, y, width, height.
    pub fn panels(&self) -> Vec<(View, [u32; 4])> {
        self.layout.panels.iter().map(|(v, r)| (*v, [r.x, r.y, r.w, r.h].map(|c| c as u32))).collect()
    }

    /// Draws one frame. `curve` holds strain (-) and nominal stress (Pa) up to the snapshot, `ruptures` what broke
    /// up to it, in order.
    ///
    /// # Errors
    /// When the adapter is lost.
    pub fn draw(&mut self, snapshot: &Snapshot, curve: &[(f64, f64)], ruptures: &[Rupture]) -> Result<RgbImage> {
        let start = Instant::now();
        let colours = self.scale.particles(&self.info, snapshot);
        let data = Data {
            info: &self.info,
            body: &self.body,
            snapshot,
            curve,
            ruptures,
            scale: &self.scale,
            colours: &colours,
            style: &self.style,
        };
        let [w, h] = self.options.size;
        let mut picture = RgbImage::from_pixel(w, h, Pixel(self.style.page));
        let shots = shots(&data, &self.options, &self.layout);
        if let Some(solid) = &self.solid {
            solid.draw(&data, &self.options, &shots)?;
            self.timings.draw += start.elapsed();
            let start = Instant::now();
            solid.read_into(&mut picture, &shots)?;
            self.timings.read_back += start.elapsed();
        }
        let start = Instant::now();
        let mut canvas = Canvas { image: picture, fonts: &self.fonts, unit: self.layout.unit };
        overlay(&mut canvas, &data, &self.options, &self.layout, &shots);
        self.timings.overlay += start.elapsed();
        self.timings.frames += 1;
        Ok(canvas.image)
    }
}

/// How wires look with their particles at `position` (mm), each wire in its shade (-), without the removed ones.
fn looks(data: &Data, position: Vec<[f32; 3]>, shade: Vec<f32>, removed: Vec<bool>) -> Looks {
    let occlusion = occlusion(data.info, &position, &data.snapshot.radius, &removed);
    Looks { position, colour: data.colours.to_vec(), occlusion, shade, removed }
}

/// How wires look in a shot, where that is its own.
fn own_looks(data: &Data, options: &FrameOptions, shot: &Shot) -> Option<Looks> {
    let bright = || vec![1.0; data.info.wires.len()];
    match shot.view {
        View::Exploded => {
            let (lifts, _) = exploded::lifts(data.body);
            Some(looks(data, exploded::positions(data, &lifts, &shot.camera), bright(), Vec::new()))
        }
        View::Cutaway => {
            let opening = cutaway::Opening::new(data, &shot.camera, focus(data, options));
            Some(looks(data, data.snapshot.position.clone(), bright(), opening.removed()))
        }
        _ => None,
    }
}

/// Bonds that make up about eight pixels.
fn stride(data: &Data, camera: &Camera) -> usize {
    let spacing = 2.0 * data.info.radius.first().copied().unwrap_or(1.0);
    (8.0 / (spacing * camera.scale)).clamp(1.0, 8.0) as usize
}

impl Solid {
    fn open(layout: &Layout) -> Result<Option<Self>> {
        let panels: Vec<Rect> = layout.panels.iter().filter(|(v, _)| is_solid(*v)).map(|(_, r)| *r).collect();
        let Some(area) = panels.iter().copied().reduce(around) else {
            return Ok(None);
        };
        let gpu = Gpu::open()?;
        let limit = gpu.device.limits().max_texture_dimension_2d;
        if area.w as u32 > limit || area.h as u32 > limit {
            let what = format!("the graphics adapter {} draws at most {limit} pixels across", gpu.name);
            return Err(Error::input(what, "choose a smaller frame size"));
        }
        let pipeline = SolidPipeline::new(&gpu)?;
        let target = Target::new(&gpu, area.w as u32, area.h as u32);
        Ok(Some(Self { gpu, pipeline, target, area }))
    }

    fn draw(&self, data: &Data, options: &FrameOptions, shots: &[Shot]) -> Result<()> {
        let shade = data.body.depth.iter().map(|d| 0.45 + 0.55 * d).collect();
        let whole = looks(data, data.snapshot.position.clone(), shade, Vec::new());
        let mut all: Vec<Segment> = Vec::new();
        let mut drawings = Vec::new();
        for shot in shots {
            let start = all.len() as u32;
            let own = own_looks(data, options, shot);
            let stride = stride(data, &shot.camera);
            let segments = wires::segments(data.info, data.snapshot, own.as_ref().unwrap_or(&whole), stride);
            all.extend(segments.into_iter().filter(|s| shot.camera.sees(s.a, s.b)));
            let instances = start..all.len() as u32;
            drawings.push(Drawing { camera: shot.camera, instances, fade: shot.fade });
        }
        let origin = [self.area.x, self.area.y];
        self.pipeline.draw(&self.gpu, &self.target, origin, data.style, &all, &drawings)
    }

    /// Copies the panels, and nothing between them, into the picture.
    fn read_into(&self, picture: &mut RgbImage, shots: &[Shot]) -> Result<()> {
        let (left, top) = (self.area.x as usize, self.area.y as usize);
        let width = picture.width() as usize;
        let bytes: &mut [u8] = picture;
        self.target.read(&self.gpu, |y, row| {
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

fn overlay(canvas: &mut Canvas, data: &Data, options: &FrameOptions, layout: &Layout, shots: &[Shot]) {
    let focus = focus(data, options);
    header::draw(canvas, layout.header, data);
    let window = shots.iter().find(|s| s.view == View::Midsection).map(|s| {
        let half = 0.5 * s.camera.panel.w / s.camera.scale;
        [s.camera.centre.z - half, s.camera.centre.z + half]
    });
    for shot in shots {
        marks::scale_bar(canvas, &shot.camera, data);
        match shot.view {
            View::Overview => marks::overview(canvas, &shot.camera, data, window),
            View::Midsection => marks::break_numbers(canvas, &shot.camera, data),
            View::Exploded => exploded::annotate(canvas, &shot.camera, data),
            View::Cutaway => {
                let opening = cutaway::Opening::new(data, &shot.camera, focus);
                cutaway::annotate(canvas, &shot.camera, data, &opening);
            }
            _ => {}
        }
        marks::title_over(canvas, shot.camera.panel, data, shot.caption, &shot.remark);
    }
    for (view, panel) in &layout.panels {
        match view {
            View::Unrolled => unrolled::draw(canvas, *panel, data),
            View::Curve => curve::draw(canvas, *panel, data),
            View::CrossSection => cut::draw(canvas, *panel, data, focus),
            _ => {}
        }
    }
}
