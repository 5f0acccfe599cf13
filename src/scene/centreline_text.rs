//! Centre lines as text: blocks of `x y z` lines in mm, one block per wire.

use crate::base::error::{Error, Result};
use glam::DVec3;
use std::fmt::Write;
use std::path::Path;

/// One wire of a centreline text.
#[derive(Debug, Clone, PartialEq)]
pub struct CentrelineWire {
    /// Layer name; "wire" where the text names none.
    pub layer: String,
    /// Diameter [m], where the text gives it.
    pub diameter: Option<f64>,
    /// Points [m].
    pub points: Vec<DVec3>,
}

/// Reads wires from text; `path` is named in errors.
///
/// # Errors
/// When a line is neither a comment nor three numbers.
pub fn parse(text: &str, path: &Path) -> Result<Vec<CentrelineWire>> {
    let mut wires = Vec::new();
    let mut wire = empty_wire();
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() {
            finish(&mut wires, &mut wire);
        } else if let Some(comment) = line.strip_prefix('#') {
            read_header(comment, &mut wire);
        } else {
            let point = read_point(line).ok_or_else(|| {
                let place = format!("{}, line {}", path.display(), number + 1);
                Error::input(
                    format!("{place}: not a point: {line}"),
                    "a line holds x y z in mm",
                )
            })?;
            wire.points.push(point);
        }
    }
    finish(&mut wires, &mut wire);
    Ok(wires)
}

fn empty_wire() -> CentrelineWire {
    CentrelineWire {
        layer: "wire".into(),
        diameter: None,
        points: Vec::new(),
    }
}

fn finish(wires: &mut Vec<CentrelineWire>, wire: &mut CentrelineWire) {
    if !wire.points.is_empty() {
        wires.push(std::mem::replace(wire, empty_wire()));
    }
}

fn read_header(comment: &str, wire: &mut CentrelineWire) {
    if let Some((_, rest)) = comment.split_once(" layer ") {
        match rest.split_once(" diameter ") {
            Some((layer, diameter)) => {
                wire.layer = layer.trim().to_owned();
                let value = diameter.trim().trim_end_matches("mm").trim();
                wire.diameter = value.parse().ok().map(|d: f64| d / 1e3);
            }
            None => wire.layer = rest.trim().to_owned(),
        }
    }
}

fn read_point(line: &str) -> Option<DVec3> {
    let values: Vec<f64> = line
        .split_whitespace()
        .map(str::parse)
        .collect::<Result<_, _>>()
        .ok()?;
    let [x, y, z] = values.try_into().ok()?;
    Some(DVec3::new(x, y, z) / 1e3)
}

/// Writes wires as text.
pub fn write(wires: &[CentrelineWire]) -> String {
    let mut text = String::from("# centre lines, x y z in mm\n");
    for (i, wire) in wires.iter().enumerate() {
        let diameter = match wire.diameter {
            Some(d) => format!(" diameter {} mm", d * 1e3),
            None => String::new(),
        };
        let _ = writeln!(text, "\n# wire {} layer {}{diameter}", i + 1, wire.layer);
        for point in &wire.points {
            let p = *point * 1e3;
            let _ = writeln!(text, "{} {} {}", p.x, p.y, p.z);
        }
    }
    text
}
