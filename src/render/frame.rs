//! One snapshot to one picture.

use super::adapter::Gpu;
use super::camera::Camera;
use super::canvas::{Canvas, Fonts, Rect};
use super::colour::ColourScale;
use super::layout::{GAP, Layout, default_views, layout};
use super::occlusion::occlusion;
use super::solid::{Drawing, SolidPipeline};
use super::style::{FrameOptions, Rgb, Style, View};
use super::target::Target;
use super::timings::Timings;
use super::viewpoint::{self, Body};
use super::wires::{self, Looks, Segment};
use super::{curve, cut, exploded, header, marks, unrolled};
use crate::base::error::{Error, Result};
use crate::engine::view::{RunInfo, Rupture, Snapshot};
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
    /// Strain [-] and nominal stress [Pa] so far.
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

    /// Where the broken bond is now, between its two particles [mm].
    pub fn place(&self, rupture: &Rupture) -> Vec3 {
        let at = |i: usize| Vec3::from(self.snapshot.position[i]);
        0.5 * (at(rupture.bond) + at(rupture.bond + 1))
    }

    /// z of the two grip faces now [mm].
    pub fn grip_faces(&self) -> Option<[f32; 2]> {
        self.info.gauge.map(|faces| faces.map(|z| viewpoint::current_z(self.info, self.snapshot, z)))
    }

    /// z of the body's two ends now [mm].
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
        let views = if options.views.is_empty() { default_views(info.gauge.is_some()) } else { options.views.clone() };
        let [w, h] = options.size;
        if !(160..=16384).contains(&w) || !(120..=16384).contains(&h) {
            let what = format!("frames of {w} × {h} pixels cannot be drawn");
            return Err(Error::input(what, "sizes go from 160 × 120 to 16384 × 16384 pixels"));
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

    /// Draws one frame. `curve` holds strain [-] and nominal stress [Pa] up to the snapshot, `ruptures` what broke
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
            solid.draw(&data, &shots)?;
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

/// A camera and what it is for.
struct Shot {
    view: View,
    camera: Camera,
    caption: &'static str,
    /// Depth over which things darken [mm].
    fade: f32,
}

fn is_solid(view: View) -> bool {
    matches!(view, View::Overview | View::Midsection | View::Exploded | View::Scene)
}

fn shots(data: &Data, options: &FrameOptions, layout: &Layout) -> Vec<Shot> {
    let u = layout.unit;
    let body = data.body;
    let z = viewpoint::current_z(data.info, data.snapshot, focus(data, options));
    let mut shots = Vec::new();
    for (view, panel) in &layout.panels {
        let mut shot = |camera, caption, fade| shots.push(Shot { view: *view, camera, caption, fade });
        match view {
            View::Overview => {
                let camera = viewpoint::overview(data.info, body, &options.camera, *panel, u);
                shot(camera, "whole strand", body.radius);
            }
            View::Midsection => {
                let (front, back) = halves(*panel, GAP * u);
                for (panel, caption, turn) in [(front, "front", 0.0), (back, "back", 180.0)] {
                    let camera = viewpoint::section(body, &options.camera, panel, z, turn);
                    let slant = options.camera.azimuth_deg.to_radians().sin().abs();
                    shot(camera, caption, body.radius + slant * panel.w / camera.scale);
                }
            }
            View::Exploded => {
                let (_, height) = exploded::lifts(data.info, body);
                shot(exploded::camera(body, &options.camera, *panel, u, z, height), "layers apart", body.radius);
            }
            View::Scene => {
                let camera = viewpoint::everything(body, data.snapshot, &options.camera, *panel);
                shot(camera, "", 2.0 * (body.high - body.low).length());
            }
            View::CrossSection | View::Unrolled | View::Curve => {}
        }
    }
    shots
}

/// Two panels of the same size: side by side, or one above the other when that leaves more room along the strand.
fn halves(panel: Rect, gap: f32) -> (Rect, Rect) {
    if panel.w < 2.2 * panel.h {
        let h = (0.5 * (panel.h - gap)).floor();
        (Rect { h, ..panel }, Rect { h, y: panel.bottom() - h, ..panel })
    } else {
        let w = (0.5 * (panel.w - gap)).floor();
        (Rect { w, ..panel }, Rect { w, x: panel.right() - w, ..panel })
    }
}

/// z before loading [mm] of the section that close-ups follow.
fn focus(data: &Data, options: &FrameOptions) -> f32 {
    let [low, high] = data.info.gauge.unwrap_or([data.body.low.z, data.body.high.z]);
    let first = data.ruptures.first().map(|r| r.rest_z as f32 * 1e3);
    options.camera.focus_z_mm.or(first).unwrap_or(0.5 * (low + high))
}

/// How wires look with their particles at `position` [mm] and each wire in its shade [-].
fn looks(data: &Data, position: Vec<[f32; 3]>, shade: Vec<f32>) -> Looks {
    let occlusion = occlusion(data.info, &position, &data.snapshot.radius);
    Looks { position, colour: data.colours.to_vec(), occlusion, shade }
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

    fn draw(&self, data: &Data, shots: &[Shot]) -> Result<()> {
        let shade = data.body.depth.iter().map(|d| 0.45 + 0.55 * d).collect();
        let whole = looks(data, data.snapshot.position.clone(), shade);
        let mut all: Vec<Segment> = Vec::new();
        let mut drawings = Vec::new();
        for shot in shots {
            let start = all.len() as u32;
            let stride = stride(data, &shot.camera);
            let segments = if shot.view == View::Exploded {
                let (lifts, _) = exploded::lifts(data.info, data.body);
                let position = exploded::positions(data, &lifts, &shot.camera);
                let apart = looks(data, position, vec![1.0; data.info.wires.len()]);
                wires::segments(data.info, data.snapshot, &apart, stride)
            } else {
                wires::segments(data.info, data.snapshot, &whole, stride)
            };
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
        let mut remark = String::new();
        match shot.view {
            View::Overview => marks::overview(canvas, &shot.camera, data, window),
            View::Midsection => {
                remark = format!("around z {focus:.1} mm");
                marks::break_numbers(canvas, &shot.camera, data);
            }
            View::Exploded => {
                let (lifts, _) = exploded::lifts(data.info, data.body);
                exploded::names(canvas, &shot.camera, data, &lifts);
            }
            _ => {}
        }
        marks::title_over(canvas, shot.camera.panel, data, shot.caption, &remark);
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
