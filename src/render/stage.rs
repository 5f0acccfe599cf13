//! One state of a run drawn into memory through any camera, as fast as the adapter can: what an interactive viewer
//! calls. It draws wires and nothing else; titles, scale and charts are the viewer's own.
//!
//! ```no_run
//! # fn main() -> strandsnap::base::error::Result<()> {
//! # let (info, snapshot): (std::sync::Arc<strandsnap::engine::view::RunInfo>, strandsnap::engine::view::Snapshot) = todo!();
//! use strandsnap::render::stage::{Shown, Stage};
//!
//! let mut stage = Stage::new(info)?;
//! stage.show(&snapshot, &Shown::default());
//! let mut eye = stage.fitting();
//! for turn in 0..36 {
//!     eye.azimuth = f64::from(turn) * 10f64.to_radians();
//!     let picture: image::RgbaImage = stage.draw(&eye, [1280, 720])?;
//!     let under_the_middle = stage.pick(&eye, [1280, 720], [640.0, 360.0]);
//! }
//! # Ok(())
//! # }
//! ```

use super::body::Body;
use super::camera::Camera;
use super::canvas::Rect;
use super::colour::ColourScale;
use super::cutaway::Opening;
use super::painter::{Drawing, Painter};
use super::style::Style;
use super::wires::{self, Looks};
use crate::base::error::Result;
use crate::engine::view::{RunInfo, Snapshot};
use crate::scene::spec::{ColourBy, Theme};
use glam::{Vec2, Vec3};
use image::RgbaImage;
use std::sync::Arc;

/// What is shown of a state.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// Quantity that colours the wires.
    pub colour: ColourBy,
    /// Dark or light ground.
    pub theme: Theme,
    /// Layers that are left out, by their index.
    pub hidden: Vec<usize>,
    /// Where outer layers are cut open, if they are.
    pub open: Option<Open>,
}

impl Default for Shown {
    fn default() -> Self {
        Self { colour: ColourBy::Stress, theme: Theme::default(), hidden: Vec::new(), open: None }
    }
}

/// An opening of the outer layers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Open {
    /// z before loading of its middle (m).
    pub rest_z: f64,
    /// Azimuth and elevation of the eye that it faces (rad), as in [`Eye`].
    pub towards: [f64; 2],
    /// Layer that broke first: where it broke, it stays whole.
    pub first_broken: Option<usize>,
}

/// Where the picture is seen from. Seen from azimuth and elevation 0, the strand's axis z points right and y up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eye {
    /// Turn about the vertical (rad).
    pub azimuth: f64,
    /// Turn about the horizontal (rad).
    pub elevation: f64,
    /// The point in the middle of the picture (m).
    pub centre: [f64; 3],
    /// Length that spans the picture's width (m).
    pub width: f64,
}

/// What lies under a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Picked {
    /// The particle whose part of the body it is.
    pub particle: usize,
    /// Its wire, from 0; `None` for a free sphere.
    pub wire: Option<usize>,
}

/// A run on the adapter.
pub struct Stage {
    info: Arc<RunInfo>,
    body: Body,
    painter: Painter,
    state: Option<State>,
}

/// A state that was made ready: only the camera changes from picture to picture.
struct State {
    position: Vec<[f32; 3]>,
    radius: Vec<f32>,
    /// Whether bond slot `i` is drawn, and whether particle `i` is.
    bond: Vec<bool>,
    particle: Vec<bool>,
    style: Style,
    segments: wgpu::Buffer,
    count: u32,
}

impl Stage {
    /// Opens the adapter for a run.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Missing`] when there is no adapter.
    pub fn new(info: Arc<RunInfo>) -> Result<Self> {
        Ok(Self { body: Body::of(&info), painter: Painter::open([1, 1])?, state: None, info })
    }

    /// Makes a state ready to be drawn; to be called when the state or what is shown of it changes.
    pub fn show(&mut self, snapshot: &Snapshot, shown: &Shown) {
        let info = &*self.info;
        let colours = ColourScale::new(info, shown.colour).particles(info, snapshot);
        let mut removed = shown.open.map_or_else(
            || vec![false; snapshot.position.len()],
            |open| {
                let to_eye = Camera::orientation(open.towards[0], open.towards[1]).transpose() * Vec3::Z;
                Opening::new(info, &self.body, open.first_broken, to_eye, open.rest_z as f32).removed()
            },
        );
        for wire in info.wires.iter().filter(|wire| shown.hidden.contains(&wire.layer)) {
            removed[wire.particles()].fill(true);
        }
        let looks = Looks::new(info, snapshot, snapshot.position.clone(), &colours, self.body.shade(), removed);
        let segments = wires::segments(info, snapshot, &looks, 1);
        let particle: Vec<bool> = (0..snapshot.position.len()).map(|i| looks.shows(i)).collect();
        let bond = |i: usize| snapshot.bond_state[i].holds() && particle[i] && particle[i + 1];
        self.state = Some(State {
            bond: (0..particle.len()).map(bond).collect(),
            particle,
            position: looks.position,
            radius: snapshot.radius.clone(),
            style: shown.theme.style(),
            segments: self.painter.upload(&segments),
            count: segments.len() as u32,
        });
    }

    /// An eye from the side that sees the whole body as it is before loading.
    pub fn fitting(&self) -> Eye {
        let size = self.body.high - self.body.low;
        let centre = (0.5 * (self.body.low + self.body.high)).as_dvec3().to_array();
        Eye { azimuth: 0.0, elevation: 0.0, centre, width: f64::from(1.1 * size.max_element()) }
    }

    /// Draws the state that is shown into a picture of `size` (px); the ground when none is.
    ///
    /// # Errors
    /// When the adapter cannot draw that size, or is lost.
    pub fn draw(&mut self, eye: &Eye, size: [u32; 2]) -> Result<RgbaImage> {
        self.painter.resize(size)?;
        let mut picture = RgbaImage::new(size[0], size[1]);
        let Some(state) = &self.state else {
            let [r, g, b] = Theme::default().style().panel;
            picture.pixels_mut().for_each(|pixel| pixel.0 = [r, g, b, 255]);
            return Ok(picture);
        };
        let drawing = Drawing { camera: self.camera(eye, size), instances: 0..state.count, fade: self.body.radius };
        self.painter.draw([0.0; 2], &state.style, &state.segments, &[drawing])?;
        let row_bytes = 4 * size[0] as usize;
        let bytes: &mut [u8] = &mut picture;
        self.painter.read(|y, row| bytes[y as usize * row_bytes..][..row_bytes].copy_from_slice(row))?;
        Ok(picture)
    }

    /// What of the state lies under a pixel (px from the left and from the top) of a picture of `size` that `eye` sees.
    pub fn pick(&self, eye: &Eye, size: [u32; 2], pixel: [f32; 2]) -> Option<Picked> {
        let state = self.state.as_ref()?;
        let camera = self.camera(eye, size);
        let ray = (Vec2::from(pixel) - 0.5 * Vec2::new(camera.panel.w, camera.panel.h)) / camera.scale;
        let ray = Vec2::new(ray.x, -ray.y);
        let ball = |i: usize| (camera.to_view(Vec3::from(state.position[i])), state.radius[i]);
        let mut nearest: Option<(f32, usize)> = None;
        for i in (0..state.position.len()).filter(|i| state.particle[*i]) {
            let j = if state.bond[i] { i + 1 } else { i };
            let ((a, ra), (b, rb)) = (ball(i), ball(j));
            let along = (b - a).truncate();
            let s = ((ray - a.truncate()).dot(along) / along.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
            let (centre, radius) = (a.lerp(b, s), ra + s * (rb - ra));
            let height = radius * radius - (ray - centre.truncate()).length_squared();
            let depth = centre.z + height.max(0.0).sqrt();
            if height >= 0.0 && nearest.is_none_or(|(before, _)| depth > before) {
                nearest = Some((depth, if s > 0.5 { j } else { i }));
            }
        }
        let (_, particle) = nearest?;
        let wire = self.info.wires.iter().position(|wire| wire.particles().contains(&particle));
        Some(Picked { particle, wire })
    }

    fn camera(&self, eye: &Eye, size: [u32; 2]) -> Camera {
        let [w, h] = size.map(|s| s as f32);
        Camera {
            rotation: Camera::orientation(eye.azimuth, eye.elevation),
            centre: Vec3::from(eye.centre.map(|x| x as f32)),
            panel: Rect::new(0.0, 0.0, w, h),
            scale: w / eye.width as f32,
            depth: self.body.depth_of_view(),
        }
    }
}
