//! Tubes: solids and shells whose faces are swept by one circle, as centre lines with a diameter.
//!
//! Faces that count are cylinders, tori and B-spline surfaces whose sections are circles; plane ones close the ends. The
//! two halves of a tube give one centre line.

use super::model::{self, Attributes, Read};
use super::reader::{Reader, Segment, within};
use super::{curves, edges, surfaces};
use crate::import::circle;
use crate::import::fault::Why;
use crate::import::part21::Value;
use crate::import::shape::{Shape, ring};
use crate::import::spline::SplineSurface;
use crate::import::surface::{Frame, Surface};
use glam::DVec3;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Difference of radii, or of a section from a circle, over the radius up to which a surface is a tube (-). Programs
/// approximate tubes to 1e-4 or so.
const ROUND: f64 = 0.01;
/// Places along a surface at which its sections are looked at.
const SECTIONS: usize = 7;
/// Points on an edge of a face.
const ON_EDGE: usize = 16;
/// Most lengths of faces of one tube: each is compared with all others.
const MOST_LENGTHS: usize = 1000;

/// A centre line of one face.
struct Line {
    segment: Segment,
    radius: f64,
}

/// The centre line of a solid or shell with its diameter, in as many segments as it has lengths of faces.
pub fn tube(reader: &Reader, number: u64) -> Read<Vec<Segment>> {
    let model = reader.model;
    if let Some(disk) = model.record(number, "SWEPT_DISK_SOLID") {
        let diameter = 2.0 * disk.positive(2, "radius: a number greater than 0")?;
        if matches!(disk.value(3), Some(Value::Number(_) | Value::Typed(..))) {
            return Err(model.fault(number, Why::NoTube("it is hollow")));
        }
        let line = curves::curve(reader, number, disk.reference(1, "directrix: an instance")?, 0)?;
        whole(&disk, &line)?;
        return Ok(line.into_iter().map(|segment| Segment { diameter: Some(diameter), ..segment }).collect());
    }
    let refuse = |why| model.fault(number, Why::NoTube(why));
    let mut lines: Vec<Line> = Vec::new();
    for face in faces(reader, number, 0)? {
        let line = line(reader, number, face)?;
        lines.extend(line.filter(|line| !lines.iter().any(|there| is_same(there, line))));
        if lines.len() > MOST_LENGTHS {
            return Err(refuse("it has more than 1000 round faces"));
        }
    }
    let radius = lines.first().ok_or_else(|| refuse("it has no round face"))?.radius;
    if lines.iter().any(|line| (line.radius / radius - 1.0).abs() > ROUND) {
        return Err(refuse("its faces have several radii"));
    }
    if !is_chain(&lines, radius) {
        return Err(refuse("the centre lines of its faces do not follow one another"));
    }
    let diameter = Some(2.0 * radius);
    Ok(lines.into_iter().map(|line| Segment { diameter, ..line.segment }).collect())
}

/// Refuses a disk that is swept along a part of its directrix. Parameters of a composite curve count its segments.
fn whole(disk: &Attributes, line: &[Segment]) -> Read<()> {
    let own = match line {
        [one] => [one.from, one.to],
        several => [0.0, several.len() as f64],
    };
    let differs = |(index, own): (usize, f64)| {
        let given = disk.value(index).and_then(model::number);
        given.is_some_and(|given| (given - own).abs() > 1e-6 * (own.abs() + 1.0))
    };
    match [(4, own[0]), (5, own[1])].into_iter().any(differs) {
        true => Err(disk.unusable("parameters of start and end: those of the whole directrix")),
        false => Ok(()),
    }
}

/// Faces of a solid or shell.
fn faces(reader: &Reader, number: u64, depth: usize) -> Read<Vec<u64>> {
    let model = reader.model;
    within(depth, model, number)?;
    for name in ["MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS"] {
        if let Some(solid) = model.record(number, name) {
            let outer = solid.reference(1, "outer shell: an instance")?;
            model.instance(number, outer)?;
            return faces(reader, outer, depth + 1);
        }
    }
    if let Some(shell) = model.record(number, "ORIENTED_CLOSED_SHELL") {
        let inner = shell.reference(2, "shell: an instance")?;
        model.instance(number, inner)?;
        return faces(reader, inner, depth + 1);
    }
    for name in ["CLOSED_SHELL", "OPEN_SHELL"] {
        if let Some(shell) = model.record(number, name) {
            return shell.references(1, "faces: a list of instances");
        }
    }
    Err(model.fault(number, Why::Kind))
}

/// The centre line of a face; `None` for a plane one.
fn line(reader: &Reader, solid: u64, face: u64) -> Read<Option<Line>> {
    let model = reader.model;
    model.instance(solid, face)?;
    let record = ["ADVANCED_FACE", "FACE_SURFACE"].into_iter().find_map(|name| model.record(face, name));
    let Some(attributes) = record else {
        return Err(model.fault(solid, Why::Unexpected { number: face, wanted: "an ADVANCED_FACE" }));
    };
    let surface = surfaces::surface(reader, face, attributes.reference(2, "surface: an instance")?)?;
    let rim = || rim(reader, face, attributes.references(1, "bounds: a list of instances")?);
    let refuse = |why| model.fault(face, Why::NoTube(why));
    let segment = |shape: Shape, [from, to]: [f64; 2]| Segment { shape: Arc::new(shape), from, to, diameter: None };
    match surface {
        Surface::Plane(_) => Ok(None),
        Surface::Cone { widening, .. } if widening != 0.0 => Err(refuse("a face is a cone")),
        Surface::Cone { frame, radius, .. } => {
            let heights: Vec<f64> = rim()?.into_iter().map(|point| frame.local(point).z).collect();
            let (low, high) = bounds(&heights);
            let shape = Shape::Line { origin: frame.origin, direction: frame.z };
            Ok(Some(Line { segment: segment(shape, [low, high]), radius }))
        }
        Surface::Torus { frame, major, minor, .. } => {
            let ends = turned(&frame, &rim()?).ok_or_else(|| refuse("a face is a whole ring"))?;
            let shape =
                Shape::Round { centre: frame.origin, x: frame.x * major, y: frame.y * major, rise: DVec3::ZERO };
            Ok(Some(Line { segment: segment(shape, ends), radius: minor }))
        }
        Surface::Spline(tube) => {
            let found = [0, 1].into_iter().filter_map(|around| Some((around, radius(&tube, around)?)));
            let Some((around, radius)) = found.min_by(|a, b| a.1.total_cmp(&b.1)) else {
                return Err(refuse("a face is a B-spline surface without circles around it"));
            };
            let ends = tube.knots(1 - around).domain();
            let shape = Shape::Centres { tube, around };
            // A face may be a part of its surface.
            let along: Vec<f64> = rim()?.into_iter().map(|point| shape.nearest(point, ends[0], ends[1])).collect();
            let (low, high) = bounds(&along);
            Ok(Some(Line { segment: segment(shape, [low, high]), radius }))
        }
    }
}

fn bounds(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (value.min(low), value.max(high)))
}

/// Points on the edges of a face.
fn rim(reader: &Reader, face: u64, bounds: Vec<u64>) -> Read<Vec<DVec3>> {
    let model = reader.model;
    let mut points = Vec::new();
    for bound in bounds {
        model.instance(face, bound)?;
        let record = ["FACE_BOUND", "FACE_OUTER_BOUND"].into_iter().find_map(|name| model.record(bound, name));
        let Some(attributes) = record else {
            return Err(model.fault(face, Why::Unexpected { number: bound, wanted: "a FACE_BOUND" }));
        };
        let edge_loop = attributes.reference(1, "loop: an instance")?;
        let list = model.expect(bound, edge_loop, "EDGE_LOOP", "an EDGE_LOOP")?;
        for edge in list.references(1, "edges: a list of instances")? {
            let Segment { shape, from, to, .. } = edges::edge(reader, edge_loop, edge)?;
            points.extend((0..=ON_EDGE).map(|i| shape.point(from + (to - from) * i as f64 / ON_EDGE as f64)));
        }
    }
    match points.is_empty() || points.iter().any(|point| !point.is_finite()) {
        true => Err(model.fault(face, Why::Unusable("bounds: edges with finite coordinates"))),
        false => Ok(points),
    }
}

/// Angles (rad) between which points lie around an axis: all but the widest gap. `None` where there is no gap.
fn turned(frame: &Frame, points: &[DVec3]) -> Option<[f64; 2]> {
    let mut angles: Vec<f64> = points
        .iter()
        .map(|point| {
            let local = frame.local(*point);
            local.y.atan2(local.x)
        })
        .collect();
    angles.sort_by(f64::total_cmp);
    let gap = |i: usize| if i + 1 < angles.len() { angles[i + 1] - angles[i] } else { angles[0] + TAU - angles[i] };
    let widest = (0..angles.len()).max_by(|a, b| gap(*a).total_cmp(&gap(*b)))?;
    // The points stand closer than this on the seam of a whole ring.
    if gap(widest) < 1.5 * TAU / ON_EDGE as f64
        && angles[angles.len() - 1] - angles[0] > 0.9 * TAU * (1.0 - 1.0 / ON_EDGE as f64)
    {
        return None;
    }
    match widest + 1 < angles.len() {
        true => Some([angles[widest + 1], angles[widest] + TAU]),
        false => Some([angles[0], angles[widest]]),
    }
}

/// Radius of a tube whose sections along `around` are all the same circle.
fn radius(tube: &SplineSurface, around: usize) -> Option<f64> {
    let [from, to] = tube.knots(1 - around).domain();
    let at = |i: usize| from + (to - from) * i as f64 / (SECTIONS - 1) as f64;
    let rings: Vec<_> = (0..SECTIONS).map(|i| circle::ring(&ring(tube, around, at(i)))).collect::<Option<_>>()?;
    let mean = rings.iter().map(|ring| ring.radius).sum::<f64>() / SECTIONS as f64;
    let is_round = |ring: &circle::Ring| {
        ring.deviation <= ROUND * mean && (ring.radius - mean).abs() <= ROUND * mean && ring.centre.is_finite()
    };
    rings.iter().all(is_round).then_some(mean)
}

/// Where a segment begins, ends and is between.
fn stations(segment: &Segment) -> [DVec3; 3] {
    [segment.from, segment.to, 0.5 * (segment.from + segment.to)].map(|t| segment.shape.point(t))
}

/// Whether two faces have one centre line and one radius, as halves of a tube do: an inner face has another.
fn is_same(a: &Line, b: &Line) -> bool {
    let near = |p: DVec3, q: DVec3| p.distance(q) <= ROUND * a.radius;
    let ([a0, a1, a2], [b0, b1, b2]) = (stations(&a.segment), stations(&b.segment));
    (a.radius / b.radius - 1.0).abs() <= ROUND
        && near(a2, b2)
        && ((near(a0, b0) && near(a1, b1)) || (near(a0, b1) && near(a1, b0)))
}

/// Whether lines follow one another: all ends but two, or none, meet one other.
fn is_chain(lines: &[Line], radius: f64) -> bool {
    let ends: Vec<DVec3> = lines.iter().flat_map(|line| stations(&line.segment).into_iter().take(2)).collect();
    let meeting =
        |i: usize| (0..ends.len()).filter(|j| *j != i && ends[i].distance(ends[*j]) <= ROUND * radius).count();
    let counts: Vec<usize> = (0..ends.len()).map(meeting).collect();
    counts.iter().all(|count| *count <= 1) && counts.iter().filter(|count| **count == 0).count() <= 2
}
