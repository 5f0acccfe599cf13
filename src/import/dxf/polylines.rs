//! LWPOLYLINE and POLYLINE: straight lengths, and arcs where a vertex has a bulge.

use super::blocks::plane;
use super::part::Part;
use super::tags::{Entity, File};
use crate::base::error::Result;
use crate::import::fault::Why;
use crate::import::shape::Shape;
use glam::{DAffine3, DVec3};

/// A vertex, with the bulge of what follows it: tangent of a quarter of the arc's angle.
struct Vertex {
    at: DVec3,
    bulge: f64,
}

/// Those of a LWPOLYLINE.
pub fn light(file: &File, entity: &Entity) -> Result<Result<Vec<Part>, Why>> {
    let elevation = file.number_or(entity, 38, 0.0)?;
    let mut vertices: Vec<Vertex> = Vec::new();
    for tag in entity.tags.iter().filter(|tag| matches!(tag.code, 10 | 20 | 42)) {
        let value = file.number(*tag)?;
        match (tag.code, vertices.last_mut()) {
            (10, _) => vertices.push(Vertex { at: DVec3::new(value, 0.0, elevation), bulge: 0.0 }),
            (20, Some(vertex)) => vertex.at.y = value,
            (_, Some(vertex)) => vertex.bulge = value,
            (_, None) => {
                return Err(file.error(tag.line, "a coordinate stands before its x", "points begin with their x"));
            }
        }
    }
    Ok(parts(&vertices, file.flags(entity, 70)? & 1 != 0, plane(file, entity)?))
}

/// Those of a POLYLINE, in its plane or in space.
pub fn heavy(file: &File, entity: &Entity) -> Result<Result<Vec<Part>, Why>> {
    let flags = file.flags(entity, 70)?;
    if flags & (16 | 64) != 0 {
        return Ok(Err(Why::Unusable("kind: a polyline, and no mesh")));
    }
    let in_space = flags & 8 != 0;
    let elevation = file.number_or(entity, 30, 0.0)?;
    let mut vertices = Vec::new();
    for vertex in &entity.parts {
        // Points of the frame of a smoothed polyline are not on it.
        if flags & 4 != 0 && file.flags(vertex, 70)? & 16 != 0 {
            continue;
        }
        let at = file.point_or(vertex, 10, DVec3::ZERO)?;
        vertices.push(match in_space {
            true => Vertex { at, bulge: 0.0 },
            false => Vertex { at: DVec3::new(at.x, at.y, elevation), bulge: file.number_or(vertex, 42, 0.0)? },
        });
    }
    let place = if in_space { DAffine3::IDENTITY } else { plane(file, entity)? };
    Ok(parts(&vertices, flags & 1 != 0, place))
}

fn parts(vertices: &[Vertex], is_closed: bool, place: DAffine3) -> Result<Vec<Part>, Why> {
    if is_closed {
        return Err(Why::Closed);
    }
    if vertices.len() < 2 {
        return Err(Why::NoLength);
    }
    let mut parts = Vec::new();
    let mut straight: Vec<DVec3> = vec![vertices[0].at];
    let end = |straight: &mut Vec<DVec3>, parts: &mut Vec<Part>| {
        let points = std::mem::take(straight);
        if points.len() > 1 {
            let to = (points.len() - 1) as f64;
            parts.push(Part { shape: Shape::Points(points), from: 0.0, to, place });
        }
    };
    for two in vertices.windows(2) {
        if two[0].bulge == 0.0 {
            straight.push(two[1].at);
            continue;
        }
        end(&mut straight, &mut parts);
        parts.push(arc(two[0].at, two[1].at, two[0].bulge, place));
        straight = vec![two[1].at];
    }
    end(&mut straight, &mut parts);
    Ok(parts)
}

/// The arc from `from` to `to`, to the left of the chord where the bulge is negative.
fn arc(from: DVec3, to: DVec3, bulge: f64, place: DAffine3) -> Part {
    let chord = to - from;
    let left = DVec3::new(-chord.y, chord.x, 0.0);
    let centre = 0.5 * (from + to) + left * (1.0 - bulge * bulge) / (4.0 * bulge);
    let x = from - centre;
    let y = DVec3::new(-x.y, x.x, 0.0);
    Part { shape: Shape::Round { centre, x, y, rise: DVec3::ZERO }, from: 0.0, to: 4.0 * bulge.atan(), place }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bulge of 1 is a half circle, to the right of the chord (DXF reference, LWPOLYLINE, code 42).
    #[test]
    fn a_bulge_is_an_arc() {
        let ends = [DVec3::ZERO, DVec3::new(2.0, 0.0, 5.0)];
        let ends = [ends[0].with_z(5.0), ends[1]];
        for (bulge, middle) in [(1.0, -1.0), (-1.0, 1.0), (0.5, -0.5), (-0.5, 0.5), (2.0, -2.0)] {
            let part = arc(ends[0], ends[1], bulge, DAffine3::IDENTITY);
            assert!(part.shape.point(part.from).distance(ends[0]) < 1e-14);
            assert!(part.shape.point(part.to).distance(ends[1]) < 1e-14);
            let half = part.shape.point(0.5 * (part.from + part.to));
            assert!(half.distance(DVec3::new(1.0, middle, 5.0)) < 1e-14, "{bulge}: {half}");
        }
    }
}
