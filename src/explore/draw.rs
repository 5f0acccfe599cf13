//! One view to one picture: everything that this floor knows of the renderer and of a snapshot's particles.

use super::pick::{Cone, Picked, nearest};
use super::record::{Record, follow_offset};
use super::view::View;
use crate::base::error::{Error, Result};
use crate::base::units::mm;
use crate::engine::view::{RunInfo, Snapshot};
use crate::render::bodies;
use crate::render::body::Body;
use crate::render::camera::Camera;
use crate::render::canvas::Rect;
use crate::render::colour::ColourScale;
use crate::render::occlusion::Occlusion;
use crate::render::painter::{Drawing, Painter};
use crate::render::perspective::Perspective;
use crate::render::stripe;
use crate::render::style::Rgb;
use crate::render::wires::{self, Looks};
use crate::scene::picture::SIDES;
use glam::{Vec2, Vec3};
use image::RgbImage;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Most pixels of a picture, as fine as it is drawn: with four samples each, half a gigabyte on the adapter.
const MOST_PIXELS: u64 = 16 << 20;
/// Memory for what was made ready to be drawn (bytes).
const READY_MEMORY: usize = 256 << 20;
/// Memory of a segment (bytes).
const SEGMENT_BYTES: usize = size_of::<wires::Segment>();
/// Share of their light that wires keep beside the selected one (-).
const DIMMED: f32 = 0.35;

/// A picture.
pub struct Picture {
    /// Its pixels.
    pub image: RgbImage,
    /// How long it took (s), without encoding.
    pub took: Duration,
}

/// Draws views of one run, for any number of browsers one after the other.
pub struct Artist {
    painter: Painter,
    body: Body,
    ready: VecDeque<(Key, Arc<Ready>)>,
    /// The last one, of which view and step.
    occlusion: Option<((View, u64), Shares)>,
}

/// How much of its surroundings is hidden from each particle, and where from.
type Shares = Arc<Vec<[f32; 4]>>;

/// What decides the shapes of a view: all but the camera.
#[derive(Clone, PartialEq)]
struct Key {
    view: View,
    /// Steps of the snapshots that it lies between.
    steps: [u64; 2],
    stride: usize,
}

impl Key {
    fn of(view: &View, steps: [u64; 2], stride: usize) -> Self {
        let still = View::default();
        let view = View {
            azimuth: still.azimuth,
            elevation: still.elevation,
            centre: still.centre,
            height: still.height,
            perspective: still.perspective,
            supersampling: still.supersampling,
            follow: None,
            theme: still.theme,
            ..view.clone()
        };
        Self { view, steps, stride }
    }

    /// What decides how much of its surroundings each particle hides: of a state between two snapshots, the earlier one.
    fn of_occlusion(&self) -> View {
        let still = View::default();
        let view = self.view.clone();
        View { state: view.state.floor(), colour: still.colour, range: None, selected: None, ..view }
    }
}

/// A state made ready to be drawn from any side.
pub struct Ready {
    snapshot: Arc<Snapshot>,
    /// Centres as they are drawn (m).
    position: Vec<[f32; 3]>,
    segments: Vec<wires::Segment>,
    /// Colour of each particle.
    pub colours: Vec<Rgb>,
}

impl Artist {
    /// Opens the graphics adapter.
    ///
    /// # Errors
    /// [`Error::Missing`] when there is none, with the package to install.
    pub fn new(record: &Record) -> Result<Self> {
        let (painter, body) = (Painter::open([1, 1], 1)?, Body::of(record.info()));
        Ok(Self { painter, body, ready: VecDeque::new(), occlusion: None })
    }

    /// Name of the adapter.
    pub fn adapter(&self) -> &str {
        self.painter.adapter()
    }

    /// Draws a view that [`View::check`] has let through.
    ///
    /// # Errors
    /// [`Error::Input`] for a size that cannot be drawn, [`Error::Missing`] when the adapter is lost.
    pub fn draw(&mut self, record: &Record, view: &View, size: [u32; 2]) -> Result<Picture> {
        let begin = Instant::now();
        check_size(size, view.supersampling)?;
        self.painter.resize(size, view.supersampling)?;
        let style = view.theme.style();
        let ready = self.ready(record, view, size);
        let camera = self.camera(record.info(), &ready.snapshot, view, size);
        // Deeper parts darken over the strand's own depth, or over what is seen of it where the eye looks along it.
        let along = (camera.rotation * Vec3::Z).z.abs();
        let fade = self.body.radius * (1.0 + view.explode as f32) + along * size[0] as f32 / camera.scale;
        let mut seen = Vec::new();
        let drawing = match eye(camera, view) {
            None => Drawing::new(camera, fade, &ready.segments, &mut seen),
            Some(eye) => {
                let changed: Vec<_> = ready.segments.iter().filter_map(|segment| eye.segment(segment)).collect();
                Drawing::round(eye.straight(), fade, &changed, &mut seen)
            }
        };
        self.painter.draw([0.0, 0.0], &style, &seen, &[drawing]);
        let mut image = RgbImage::new(size[0], size[1]);
        let width = size[0] as usize * 3;
        let bytes: &mut [u8] = &mut image;
        self.painter.read(|y, row| {
            let out = &mut bytes[y as usize * width..(y as usize + 1) * width];
            for (to, from) in out.chunks_exact_mut(3).zip(row.chunks_exact(4)) {
                to.copy_from_slice(&from[..3]);
            }
        })?;
        Ok(Picture { image, took: begin.elapsed() })
    }

    /// What the view's state looks like, without a camera.
    pub fn ready(&mut self, record: &Record, view: &View, size: [u32; 2]) -> Arc<Ready> {
        let key = Key::of(view, record.steps(view.state), stride(record.info(), view, size));
        if let Some(at) = self.ready.iter().position(|(known, _)| *known == key) {
            let found = self.ready.remove(at);
            self.ready.extend(found);
        } else {
            let made = Arc::new(self.prepare(record, &key));
            self.ready.push_back((key, made));
            while self.ready.len() > 1 && self.memory() > READY_MEMORY {
                self.ready.pop_front();
            }
        }
        self.ready[self.ready.len() - 1].1.clone()
    }

    fn memory(&self) -> usize {
        self.ready.iter().map(|(_, ready)| ready.segments.len() * SEGMENT_BYTES).sum()
    }

    fn prepare(&mut self, record: &Record, key: &Key) -> Ready {
        let Key { view, stride, .. } = key;
        let info = record.info();
        let occlusion = self.occlusion(record, key.of_occlusion(), key.steps[0]);
        let snapshot = record.snapshot(view.state);
        let removed = removed(info, &snapshot, view);
        let position = self.exploded(&snapshot, view);
        let scale = ColourScale::new(info, view.colour);
        let scale = view.range.map_or(scale, |range| ColourScale::new(info, view.colour).with_shown_range(range));
        let colours = scale.particles(info, &snapshot);
        let depth = self.body.shade();
        let open = [&view.hidden_layers, &view.hidden_wires, &view.ghost_layers].iter().any(|some| !some.is_empty());
        let bright = view.explode > 0.0 || open;
        let shade = (0..info.wires.len()).map(|wire| {
            let dimmed = view.selected.is_some_and(|selected| selected != wire);
            (if bright { 1.0 } else { depth[wire] }) * if dimmed { DIMMED } else { 1.0 }
        });
        let looks = Looks::new(info, &snapshot, position.clone(), &colours, shade.collect(), removed);
        let looks = looks.with_occlusion(Occlusion::known(occlusion.to_vec()));
        let ghosts = info.wires.iter().map(|wire| view.ghost_layers.contains(&wire.layer));
        let looks = looks.with_ghosts(ghosts.collect()).with_section(view.cut.map(|z| (z / mm(1.0)) as f32));
        let mut segments = wires::segments(info, &snapshot, &looks, *stride, None, |_, _| true);
        segments.extend(stripe::segments(info, &snapshot, &looks, None, |_, _| true));
        if view.explode == 0.0 {
            segments.extend(bodies::segments(info, &snapshot));
        }
        Ready { snapshot, position, segments, colours }
    }

    fn occlusion(&mut self, record: &Record, view: View, step: u64) -> Shares {
        if let Some(((known, at), found)) = &self.occlusion
            && (known, *at) == (&view, step)
        {
            return found.clone();
        }
        let (info, snapshot) = (record.info(), record.snapshot(view.state));
        let position = self.exploded(&snapshot, &view);
        // What is seen through casts no shadow.
        let removed = solid(info, &snapshot, &view).map(|solid| !solid).collect::<Vec<_>>();
        let made = Arc::new(Occlusion::new(info, &position, &snapshot.radius, &removed).all());
        self.occlusion = Some(((view, step), made.clone()));
        made
    }

    /// Centres of the particles (m), moved away from the axis as far as the view wants.
    fn exploded(&self, snapshot: &Snapshot, view: &View) -> Vec<[f32; 3]> {
        let mut position = snapshot.position.clone();
        if view.explode > 0.0 {
            let apart = 1.0 + view.explode as f32;
            for p in &mut position {
                p[0] = self.body.axis.x + (p[0] - self.body.axis.x) * apart;
                p[1] = self.body.axis.y + (p[1] - self.body.axis.y) * apart;
            }
        }
        position
    }

    fn camera(&self, info: &RunInfo, snapshot: &Snapshot, view: &View, size: [u32; 2]) -> Camera {
        let [w, h] = size.map(|side| side as f32);
        let follow_offset = follow_offset(info, snapshot, view);
        let [x, y, z] = view.centre.map(|c| (c / mm(1.0)) as f32);
        Camera {
            rotation: Camera::orientation(view.azimuth.to_radians(), view.elevation.to_radians()),
            centre: Vec3::new(x, y, z + follow_offset),
            panel: Rect::new(0.0, 0.0, w, h),
            scale: h * mm(1.0) as f32 / view.height as f32,
            depth: self.body.depth_of_view(),
        }
    }

    /// The particle that is seen at a place of the picture, given as shares of its width and height from the top left.
    pub fn pick(&mut self, record: &Record, view: &View, size: [u32; 2], [right, down]: [f64; 2]) -> Option<Picked> {
        let info = record.info();
        let ready = self.ready(record, view, size);
        let camera = self.camera(info, &ready.snapshot, view, size);
        let pixel = Vec2::new(right as f32 * camera.panel.w, down as f32 * camera.panel.h);
        let at = (pixel - 0.5 * Vec2::new(camera.panel.w, camera.panel.h)) / camera.scale * Vec2::new(1.0, -1.0);
        let eye = eye(camera, view);
        let place = |i: usize| {
            let (centre, radius) = (Vec3::from(ready.position[i]), ready.snapshot.radius[i]);
            match eye {
                None => Some((camera.to_view(centre), radius)),
                Some(eye) => eye.place(centre).map(|(place, larger)| (place, radius * larger)),
            }
        };
        // Clicks go through what is seen through.
        let solid: Vec<bool> = solid(info, &ready.snapshot, view).collect();
        let shown = |i: usize| solid[i];
        let mut cones = Vec::new();
        for (number, wire) in info.wires.iter().enumerate() {
            for i in wire.particles() {
                let bonded = i + 1 < wire.particles().end && ready.snapshot.bond_state[i].holds() && shown(i + 1);
                let j = if bonded { i + 1 } else { i };
                if let (true, Some(from), Some(to)) = (shown(i), place(i), place(j)) {
                    cones.push(Cone { ends: [from, to], what: [(i, Some(number)), (j, Some(number))] });
                }
            }
        }
        for i in (info.wire_particles..info.particles).filter(|i| shown(*i)) {
            cones.extend(place(i).map(|place| Cone { ends: [place; 2], what: [(i, None); 2] }));
        }
        nearest(&cones, at).map(|(particle, wire)| Picked { particle, wire })
    }
}

/// The eye of a view in perspective. Below a hundredth of a degree lines of sight are parallel to a pixel.
fn eye(camera: Camera, view: &View) -> Option<Perspective> {
    (view.perspective > 0.01).then(|| Perspective::new(camera, view.perspective.to_radians()))
}

/// Refuses a picture that would take too much memory.
pub(super) fn check_size(size: [u32; 2], times: u32) -> Result<()> {
    let fits = size.iter().all(|side| SIDES.contains(side));
    let finer = if times > 1 { format!(", each {times} times finer,") } else { String::new() };
    let most = MOST_PIXELS / u64::from(times * times);
    if fits && u64::from(size[0]) * u64::from(size[1]) <= most {
        return Ok(());
    }
    Err(Error::input(
        format!("a picture of {} × {} pixels{finer} cannot be drawn here", size[0], size[1]),
        format!("choose sides from {} to {} pixels, {most} pixels at most", SIDES.start(), SIDES.end()),
    ))
}

/// Which particles are left out of a view.
fn removed(info: &RunInfo, snapshot: &Snapshot, view: &View) -> Vec<bool> {
    let mut removed = vec![false; info.particles];
    for (number, wire) in info.wires.iter().enumerate() {
        removed[wire.particles()].fill(view.hides(number, wire.layer));
    }
    if let Some(cut) = view.cut {
        // A particle in the plane would leave nothing between itself and the plane to draw the section on.
        let nearly = |radius: &f32| 0.02 * mm(f64::from(*radius));
        let places = snapshot.position.iter().zip(&snapshot.radius);
        let beyond = places.map(|(p, radius)| mm(f64::from(p[2])) > cut - nearly(radius));
        removed.iter_mut().zip(beyond).for_each(|(gone, beyond)| *gone |= beyond);
    }
    removed
}

/// Which particles are drawn, and not see-through.
fn solid<'a>(info: &'a RunInfo, snapshot: &'a Snapshot, view: &'a View) -> impl Iterator<Item = bool> + 'a {
    let mut see_through = vec![false; info.particles];
    for wire in info.wires.iter().filter(|wire| view.ghost_layers.contains(&wire.layer)) {
        see_through[wire.particles()].fill(true);
    }
    removed(info, snapshot, view).into_iter().zip(see_through).map(|(removed, ghost)| !removed && !ghost)
}

/// Most bonds of a segment.
fn stride(info: &RunInfo, view: &View, size: [u32; 2]) -> usize {
    let spacing = 2.0 * mm(f64::from(info.radius.first().copied().unwrap_or(1e-3)));
    wires::stride((spacing * f64::from(size[1] * view.supersampling) / view.height) as f32)
}
