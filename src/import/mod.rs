//! Centre lines of wires from CAD models: STEP, DXF, and text as [`centreline_text`] reads it.
//!
//! A file gives lines, some of them tubes ([`contents`]). Lines that follow one another are a wire ([`chains`]), wires have a
//! common axis ([`axis`]) and lie in layers around it ([`layers`]). [`import`] gives them with points as close together as a
//! chord error asks for; [`scene_text`] makes a scene of them, [`wording`] says what was found.
//!
//! Only the structure of STEP files and the few entities that make lines are read here. The readers that could be had
//! either do not read what programs write for helices (complex instances of rational B-splines), or compile a whole schema
//! for it.

pub mod axis;
pub mod chains;
mod circle;
pub mod contents;
mod dxf;
pub mod fault;
mod imported;
pub mod layers;
mod part21;
pub mod scene_text;
pub mod shape;
pub mod spline;
mod step;
pub mod surface;
pub mod wire;
pub mod wording;

use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::scene::centreline_text;
use crate::strand::overlap::{self, Body};
use axis::{Axis, Course, STATIONS};
use chains::Chains;
use contents::Contents;
use fault::{Place, Unread};
use glam::{DAffine3, DVec3};
pub use imported::{Clearance, ImportOptions, Imported, ImportedWire};
use layers::{Fit, Layer};
use shape::{Piece, Shape};
use std::path::Path;
use std::sync::Arc;
use wire::Wire;

/// Chord error over the diameter where none is asked for (-).
const USUAL_CHORD: f64 = 1e-3;
/// Chord error over the extent of a model without a diameter (-).
const CHORD_OVER_EXTENT: f64 = 1e-5;
/// Most points of one wire.
const MOST_POINTS: usize = 1_000_000;
/// Most points of a file.
const MOST_POINTS_OF_ALL: usize = 5_000_000;
/// Most segments between which overlaps are looked for.
const MOST_SEGMENTS: f64 = 2e6;
/// Deviation from a helix over the diameter, or without one over the lay radius, above which wires are not laid about one
/// axis (-).
const NOT_LAID: f64 = 0.5;
/// Distance from a straight line over the length that means nothing: the digits of files (-).
const DIGITS: f64 = 1e-6;
/// Distance of an axis from z, and of the strand's end from the origin, over the length, up to which wires stay as drawn (-).
const AS_DRAWN: f64 = 1e-6;

/// Reads the wires of a file.
///
/// # Errors
/// [`Error::Input`] with the line where it cannot be read, and where nothing in it is a wire; [`Error::Io`].
pub fn import(path: &Path, options: &ImportOptions) -> Result<Imported> {
    let bytes = regular::read(path, regular::LONGEST_TABLE)?;
    let Found { contents, mut chains, names } = read(&bytes, path, options)?;
    let Contents { format, units, mut unread, .. } = contents;
    unread.append(&mut chains.unread);
    if chains.wires.is_empty() {
        return Err(nothing(path, &unread));
    }
    let diameters = diameters(path, &chains.wires, options.diameter)?;
    let least = diameters.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    let chord = options.chord.unwrap_or(match least.is_finite() {
        true => USUAL_CHORD * least,
        false => CHORD_OVER_EXTENT * chains.wires.iter().map(Wire::length).fold(0.0, f64::max),
    });
    let points = points(path, &chains.wires, chord)?;
    let courses: Vec<Course> = chains.wires.iter().zip(&points).map(|(wire, points)| course(wire, points)).collect();
    let laid = laid(&courses, &diameters);
    let axis = laid.as_ref().map(|(axis, ..)| *axis);
    let place = axis.filter(|_| !options.as_drawn).map_or(DAffine3::IDENTITY, |axis| upright(&axis, &points));
    let (order, layers) = match laid {
        Some((_, fits, layers)) => in_order(&fits, layers),
        None => ((0..points.len()).collect(), Vec::new()),
    };
    let name = |wire: usize, at: usize| {
        let layer = || layers.iter().find(|layer| layer.wires.contains(&at)).map(|layer| layer.name.clone());
        names[wire].clone().or_else(layer).unwrap_or_else(|| "wire".into())
    };
    let wires: Vec<ImportedWire> = order
        .iter()
        .enumerate()
        .map(|(at, wire)| ImportedWire {
            layer: name(*wire, at),
            diameter: diameters[*wire],
            points: points[*wire].iter().map(|point| place.transform_point3(*point)).collect(),
            pieces: chains.wires[*wire].pieces.len(),
        })
        .collect();
    Ok(Imported {
        format,
        units,
        clearance: clearance(&wires),
        wires,
        axis,
        is_moved: place != DAffine3::IDENTITY,
        layers,
        forks: chains.forks,
        reach: chains.reach,
        chord,
        unread,
    })
}

/// What a file gives, joined.
struct Found {
    contents: Contents,
    chains: Chains,
    /// Names of layers that the file gives its wires.
    names: Vec<Option<String>>,
}

fn read(bytes: &[u8], path: &Path, options: &ImportOptions) -> Result<Found> {
    if bytes.starts_with(dxf::BINARY) || bytes.starts_with(b"AC10") {
        let what = format!("{} is a binary drawing", path.display());
        return Err(Error::input(what, "save it as ASCII DXF, or as STEP"));
    }
    // Names in files may be of any encoding; what is read of them is ASCII.
    let text = String::from_utf8_lossy(bytes);
    let contents = if part21::is_one(&text) {
        step::read(&text, path, options.unit)?
    } else if dxf::is_one(&text) {
        dxf::read(&text, path, options.unit)?
    } else {
        return from_text(bytes, path, options);
    };
    let mut contents = contents;
    let chains = chains::join(std::mem::take(&mut contents.pieces), options.reach);
    let names = vec![None; chains.wires.len()];
    Ok(Found { contents, chains, names })
}

/// Text: a block of points is a wire.
fn from_text(bytes: &[u8], path: &Path, options: &ImportOptions) -> Result<Found> {
    const MILLIMETRE: f64 = 1e-3;
    let text = centreline_text::decode(bytes).ok_or_else(|| {
        let what = format!("{} is neither STEP nor DXF, nor text in UTF-8 or UTF-16", path.display());
        Error::input(what, "save the model as STEP (.step), as ASCII DXF, or its points as text")
    })?;
    let read = centreline_text::parse(&text, path)?;
    // Points of text are in mm; diameters say so themselves.
    let scale = options.unit.map_or(DAffine3::IDENTITY, |unit| DAffine3::from_scale(DVec3::splat(unit / MILLIMETRE)));
    let mut found = Found {
        contents: Contents {
            format: "text".into(),
            units: vec![options.unit.unwrap_or(MILLIMETRE)],
            ..Contents::default()
        },
        chains: Chains::default(),
        names: Vec::new(),
    };
    for (number, wire) in read.into_iter().enumerate() {
        let to = (wire.points.len() - 1) as f64;
        let piece = Piece {
            shape: Arc::new(Shape::Points(wire.points)),
            from: 0.0,
            to,
            place: scale,
            diameter: wire.diameter,
            source: Place { entity: format!("wire {}", number + 1), number: None, line: 0 },
        };
        match piece.marks() {
            Ok(marks) => {
                let diameter = piece.diameter;
                found.chains.wires.push(Wire { pieces: vec![wire::Measured { piece, marks }], diameter });
                found.names.push(Some(wire.layer).filter(|name| name != centreline_text::DEFAULT_LAYER));
            }
            Err(unread) => found.chains.unread.push(unread),
        }
    }
    Ok(found)
}

fn nothing(path: &Path, unread: &[Unread]) -> Error {
    let what = format!("{} holds no wire that can be read", path.display());
    let told = wording::unread(unread);
    Error::input(
        what,
        match told.is_empty() {
            true => "draw centre lines as curves, or wires as tubes, and save them as STEP or DXF".to_owned(),
            false => format!("not used: {}", told.join("; ")),
        },
    )
}

/// Diameters of wires (m), to the digits that a program keeps.
fn diameters(path: &Path, wires: &[Wire], given: Option<f64>) -> Result<Vec<Option<f64>>> {
    let rounded = |diameter: f64| format!("{diameter:.6e}").parse::<f64>().unwrap_or(diameter);
    let one = |(number, wire): (usize, &Wire)| match (wire.diameter.map(rounded), given) {
        (Some(own), Some(given)) if (own - given).abs() > 1e-3 * own => {
            let [own, given] = [own, given].map(wording::millimetres);
            let what = format!("wire {} of {} has a diameter of {own} mm, not {given} mm", number + 1, path.display());
            Err(Error::input(what, "leave --diameter out: it is for wires for which the file gives none"))
        }
        (own, given) => Ok(own.or(given)),
    };
    wires.iter().enumerate().map(one).collect()
}

fn points(path: &Path, wires: &[Wire], chord: f64) -> Result<Vec<Vec<DVec3>>> {
    let too_many = || {
        let what = format!("{} would have more than {MOST_POINTS_OF_ALL} points", path.display());
        let chord = wording::millimetres(chord);
        Error::input(
            what,
            format!("give a greater --chord than {chord} mm, or look whether the unit is right (--unit)"),
        )
    };
    let mut all = Vec::new();
    let mut count = 0;
    for wire in wires {
        let points = wire.points(chord, MOST_POINTS).ok_or_else(too_many)?;
        count += points.len();
        if count > MOST_POINTS_OF_ALL {
            return Err(too_many());
        }
        all.push(points);
    }
    Ok(all)
}

fn course(wire: &Wire, points: &[DVec3]) -> Course {
    let even = wire.even(STATIONS);
    // Between the corners of a polygon its curve is elsewhere.
    let fitted = if wire.is_polygon() && points.len() > 2 { points.to_vec() } else { even.clone() };
    Course::new(even, fitted, DIGITS * wire.length())
}

/// Axis, helices and layers, where wires are laid about one axis.
fn laid(courses: &[Course], diameters: &[Option<f64>]) -> Option<(Axis, Vec<Fit>, Vec<Layer>)> {
    let axis = Axis::common(courses)?;
    let upright = axis.upright();
    let fits: Vec<Fit> = courses.iter().map(|course| layers::fit(course, upright)).collect();
    let follows =
        |(fit, diameter): (&Fit, &Option<f64>)| fit.deviation <= NOT_LAID * diameter.unwrap_or(fit.helix.radius);
    let all_follow = fits.iter().zip(diameters).zip(courses).all(|(pair, course)| course.is_straight || follows(pair));
    let layers = layers::layers(&fits, diameters);
    all_follow.then_some((axis, fits, layers))
}

/// Brings the axis to z and the lowest end to its foot, where that is not so already.
fn upright(axis: &Axis, points: &[Vec<DVec3>]) -> DAffine3 {
    let turned = axis.upright();
    let heights = points.iter().flatten().map(|point| turned.transform_point3(*point).z);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z)));
    let length = high - low;
    let is_upright = axis.direction.truncate().length() <= AS_DRAWN;
    let off = axis.origin.reject_from_normalized(axis.direction).length();
    if is_upright && off <= AS_DRAWN * length {
        return DAffine3::IDENTITY;
    }
    DAffine3::from_translation(DVec3::new(0.0, 0.0, -low)) * turned
}

/// Numbers of wires layer by layer, around each; and the layers with their wires numbered so.
fn in_order(fits: &[Fit], layers: Vec<Layer>) -> (Vec<usize>, Vec<Layer>) {
    let mut order = Vec::new();
    let renumbered = layers.into_iter().map(|mut layer| {
        layer.wires.sort_by(|a, b| fits[*a].helix.phase.total_cmp(&fits[*b].helix.phase));
        let first = order.len();
        order.append(&mut layer.wires);
        Layer { wires: (first..order.len()).collect(), ..layer }
    });
    let layers = renumbered.collect();
    (order, layers)
}

fn clearance(wires: &[ImportedWire]) -> Clearance {
    let diameters: Option<Vec<f64>> = wires.iter().map(|wire| wire.diameter).collect();
    let Some(diameters) = diameters else { return Clearance::NoDiameter(least_distance(wires)) };
    // Long segments would put all of them into one cell of the search.
    let dense: Option<Vec<Vec<DVec3>>> =
        wires.iter().zip(&diameters).map(|(wire, diameter)| divided(&wire.points, 2.0 * diameter)).collect();
    let Some(dense) = dense.filter(|all| all.iter().map(Vec::len).sum::<usize>() as f64 <= MOST_SEGMENTS) else {
        return Clearance::NotLookedAt;
    };
    let bodies: Vec<Body> =
        dense.iter().zip(&diameters).map(|(points, diameter)| Body { points, radius: 0.5 * diameter }).collect();
    overlap::deepest(&bodies, 0.0).map_or(Clearance::Free, Clearance::Overlaps)
}

/// Points with others between those that are further apart than `longest` (m); `None` where they would be too many.
fn divided(points: &[DVec3], longest: f64) -> Option<Vec<DVec3>> {
    let mut all = vec![points[0]];
    for two in points.windows(2) {
        let steps = (two[0].distance(two[1]) / longest).ceil().max(1.0);
        if all.len() as f64 + steps > MOST_SEGMENTS {
            return None;
        }
        all.extend((1..=steps as usize).map(|i| two[0].lerp(two[1], i as f64 / steps)));
    }
    Some(all)
}

/// Least distance of the centre lines of two wires (m), by points of one and the other.
fn least_distance(wires: &[ImportedWire]) -> Option<f64> {
    // Of some points per wire: it only serves as a hint at the diameter.
    const TRIED: usize = 200;
    const MOST_WIRES: usize = 150;
    if wires.len() < 2 || wires.len() > MOST_WIRES {
        return None;
    }
    let some = |wire: &ImportedWire| -> Vec<DVec3> {
        let dense = divided(
            &wire.points,
            wire.points.windows(2).map(|two| two[0].distance(two[1])).sum::<f64>() / TRIED as f64,
        );
        let dense = dense.unwrap_or_default();
        let step = (dense.len() / TRIED).max(1);
        dense.into_iter().step_by(step).collect()
    };
    let all: Vec<Vec<DVec3>> = wires.iter().map(some).collect();
    let segment = |p: DVec3, two: &[DVec3]| {
        let along = two[1] - two[0];
        let t =
            if along == DVec3::ZERO { 0.0 } else { ((p - two[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0) };
        p.distance(two[0] + along * t)
    };
    let mut least = f64::INFINITY;
    for (i, a) in all.iter().enumerate() {
        for b in &all[i + 1..] {
            for p in a {
                least = b.windows(2).map(|two| segment(*p, two)).fold(least, f64::min);
            }
        }
    }
    least.is_finite().then_some(least)
}
