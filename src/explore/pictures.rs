//! The pictures that a scene asks for of its own run, and what a page shows as such an entry of a scene.

use super::draw::check_size;
use super::record::Record;
use super::shared::Pane;
use super::view::View;
use crate::base::error::{Error, Result};
use crate::base::finding::StopReason;
use crate::base::regular::make_folder;
use crate::base::units::{mm, percent, shortest};
use crate::engine::view::{Sample, Snapshot};
use crate::observe::origin::Origin;
use crate::observe::tables::layer_name;
use crate::page::Abscissa;
use crate::render::camera::Camera;
use crate::render::{self, png};
use crate::run::RunSummary;
use crate::run::folder::PICTURES;
use crate::scene::look::Moment;
use crate::scene::picture::{PictureSpec, When};
use crate::scene::spec::{OutputSpec, Spec};
use crate::scene::write::picture_to_toml;
use glam::{DVec3, Vec3};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// What is left free around all that is shown, over its size (-).
const MARGIN: f64 = 0.075;

/// What a run that has ended has made of `output.picture`.
#[derive(Debug, Default)]
pub struct Drawn {
    /// Files that were made.
    pub made: Vec<PathBuf>,
    /// Why others were not, in sentences: the run never came to what they were to show.
    pub left_out: Vec<String>,
    /// It was stopped before it had drawn all; [`command`] draws them.
    pub stopped: bool,
}

/// The command that draws the pictures of a run's own scene.
pub fn command(run: &Path) -> String {
    format!("strandsnap render {} --pictures", run.display())
}

/// Checks what would find out only after a long run: that there is a graphics adapter, and room in the folder `run`.
///
/// # Errors
/// [`Error::Missing`] without an adapter; [`Error::Input`] where something else than a folder has the name of theirs, or a size is
/// too large.
pub fn check(run: &Path, output: &OutputSpec) -> Result<()> {
    if output.pictures.is_empty() {
        return Ok(());
    }
    let folder = run.join(PICTURES);
    if !folder.is_dir() && std::fs::symlink_metadata(&folder).is_ok() {
        return Err(Error::input(
            format!("{} is not a folder, and output.picture writes into it", folder.display()),
            "move it away, or leave out output.picture",
        ));
    }
    output.pictures.iter().try_for_each(|picture| check_size(picture.size, picture.supersampling))?;
    render::check()
}

/// Whether a run has come to its end by its summary, pictures included.
pub fn are_due(summary: &RunSummary) -> bool {
    let undrawn = summary.cost.frames.is_some_and(|frames| frames.unfinished());
    summary.stopped != StopReason::Interrupted && !undrawn
}

/// Draws the pictures that the scene `spec` asks for of the run in the folder `run`, in place of earlier ones.
///
/// # Errors
/// When the run cannot be read, or the adapter is lost; [`Error::Io`] when a picture cannot be written. What `stop` leaves out is no
/// error.
pub fn draw(run: &Path, spec: &Spec, stop: &AtomicBool) -> Result<Drawn> {
    let mut drawn = Drawn::default();
    let output = &spec.output;
    if output.pictures.is_empty() {
        return Ok(drawn);
    }
    let (pane, origin) = (Pane::open(run)?, Origin::of(spec));
    let folder = run.join(PICTURES);
    make_folder(&folder)?;
    for picture in &output.pictures {
        let state = match state_of(&pane.record(), picture.when) {
            Ok(state) => state,
            Err(why) => {
                drawn.left_out.push(format!("the picture \"{}\" was not drawn: {why}", picture.name));
                continue;
            }
        };
        let view = view_of(&pane.record(), picture, state);
        if stop.load(Ordering::Relaxed) {
            drawn.stopped = true;
            break;
        }
        view.check(pane.record().info(), pane.record().states())?;
        let image = pane.draw(&view, picture.size)?.image;
        let step = pane.record().steps(state)[0];
        let file = folder.join(format!("{}.png", picture.name));
        png::write(&file, &png::encode(&image, Some((origin, step)))?)?;
        drawn.made.push(file);
    }
    Ok(drawn)
}

/// The state of a run that a picture is to show; or why there is none.
fn state_of(record: &Record, when: When) -> std::result::Result<f64, String> {
    let last = (record.states() - 1) as f64;
    let abscissa = Abscissa::of_run(record.info());
    let end = &record.snapshot(last).sample;
    match when {
        When::At(Moment::Start) => Ok(0.0),
        When::At(Moment::End) => Ok(last),
        When::At(Moment::FirstBreak) => record.break_state(0).ok_or_else(|| "nothing broke".into()),
        When::At(Moment::LastBreak) => {
            let latest = record.ruptures().len().checked_sub(1).and_then(|latest| record.break_state(latest));
            latest.ok_or_else(|| "nothing broke".into())
        }
        When::Strain(strain) => record.first_state(strain, |sample| sample.strain).ok_or_else(|| {
            let most = record.greatest(|sample| sample.strain);
            format!(
                "the run did not come to {} % strain, but to {}",
                shortest(percent(strain)),
                abscissa.moment(percent(most))
            )
        }),
        When::Time(time) => record
            .first_state(time, |sample| sample.time)
            .ok_or_else(|| format!("the run ended after {} s, before {} s", shortest(end.time), shortest(time))),
    }
}

/// The view of a picture at a state.
fn view_of(record: &Record, picture: &PictureSpec, state: f64) -> View {
    let info = record.info();
    let layers = |names: &[String]| {
        let numbers = names.iter().filter_map(|name| info.layers.iter().position(|layer| layer == name));
        numbers.collect()
    };
    let mut view = View {
        state,
        azimuth: picture.azimuth.to_degrees(),
        elevation: picture.elevation.to_degrees(),
        centre: [0.0; 3],
        height: 1.0,
        perspective: picture.perspective.to_degrees(),
        follow: picture.follow.map(mm),
        colour: picture.colour,
        range: picture.range,
        hidden_layers: layers(&picture.hidden_layers),
        hidden_wires: picture.hidden_wires.clone(),
        ghost_layers: layers(&picture.ghost_layers),
        selected: picture.selected,
        explode: picture.explode,
        cut: picture.cut.map(mm),
        theme: picture.theme,
        supersampling: picture.supersampling,
    };
    let [low, high] = reach(&record.snapshot(state));
    if view.follow.is_none() {
        view.centre = (0.5 * (low + high)).to_array();
    }
    if let Some(centre) = picture.centre {
        view.centre = centre.to_array().map(mm);
    }
    view.height = picture.height.map_or_else(|| fitting(&view, picture.size, high - low), mm);
    view
}

/// Least and greatest coordinates of all that is there (mm).
fn reach(snapshot: &Snapshot) -> [DVec3; 2] {
    let ends = snapshot.position.iter().zip(&snapshot.radius).map(|(p, r)| [Vec3::from(*p) - *r, Vec3::from(*p) + *r]);
    let [low, high] = ends.fold([Vec3::MAX, Vec3::MIN], |[low, high], end| [low.min(end[0]), high.max(end[1])]);
    [low, high].map(|end| end.as_dvec3().map(mm))
}

/// Height (mm) of a view that shows a box of these sides (mm) about its middle.
fn fitting(view: &View, size: [u32; 2], sides: DVec3) -> f64 {
    let turn = Camera::orientation(view.azimuth.to_radians(), view.elevation.to_radians());
    let shape = f64::from(size[1]) / f64::from(size[0]);
    let slope = (0.5 * view.perspective.to_radians()).tan();
    let apart = DVec3::new(1.0 + view.explode, 1.0 + view.explode, 1.0);
    let corner = |k: u32| {
        let sign = |axis: u32| if (k >> axis) & 1 == 1 { 0.5 } else { -0.5 };
        let corner = sides * apart * DVec3::new(sign(0), sign(1), sign(2));
        (turn * corner.as_vec3()).as_dvec3()
    };
    // Of what is nearer to the eye by z, the picture shows less by the slope of its outermost line of sight.
    let half = (0..8).map(corner).map(|c| (c.x.abs() * shape).max(c.y.abs()) + c.z * slope).fold(0.0, f64::max);
    2.0 * (1.0 + MARGIN) * half
}

/// A view as an entry of a scene, for a picture of this size (px).
pub(super) fn entry(record: &Record, view: &View, size: [u32; 2]) -> String {
    let info = record.info();
    let sample = &record.snapshot(view.state).sample;
    let same = |value: f64, of: fn(&Sample) -> f64| {
        record.first_state(value, of).is_some_and(|state| (state - view.state).abs() < 1e-6)
    };
    let when = if view.state == (record.states() - 1) as f64 {
        When::At(Moment::End)
    } else if info.is_pulled() && same(sample.strain, |sample| sample.strain) {
        When::Strain(sample.strain)
    } else {
        When::Time(sample.time)
    };
    let metre = |length: f64| length / mm(1.0);
    let layers = |numbers: &[usize]| numbers.iter().map(|layer| layer_name(info, *layer).to_owned()).collect();
    picture_to_toml(&PictureSpec {
        name: "view".into(),
        when,
        size,
        azimuth: view.azimuth.to_radians(),
        elevation: view.elevation.to_radians(),
        centre: Some(DVec3::from(view.centre.map(metre))),
        height: Some(metre(view.height)),
        perspective: view.perspective.to_radians(),
        follow: view.follow.map(metre),
        colour: view.colour,
        range: view.range,
        hidden_layers: layers(&view.hidden_layers),
        ghost_layers: layers(&view.ghost_layers),
        hidden_wires: view.hidden_wires.clone(),
        selected: view.selected,
        explode: view.explode,
        cut: view.cut.map(metre),
        theme: view.theme,
        supersampling: view.supersampling,
    })
}
