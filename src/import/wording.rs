//! The words for what an import finds.

use super::chains::Fork;
use super::fault::{Place, Unread, Why};
use super::imported::{Clearance, Imported};
use super::layers::Layer;
use crate::base::units::{self, mm};
use crate::base::wording::counted;
use crate::strand::error;
use std::fmt;
use std::path::Path;

/// Most places that are named of things which are not used for one reason.
const NAMED: usize = 4;

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.entity)?;
        match (self.number, self.line) {
            (Some(number), 0) => write!(f, " #{number}"),
            (Some(number), line) => write!(f, " #{number}, line {line}"),
            (None, 0) => Ok(()),
            (None, line) => write!(f, ", line {line}"),
        }
    }
}

impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Kind => write!(f, "is of a kind that is not read"),
            Self::Missing(number) => write!(f, "refers to #{number}, which the file does not have"),
            Self::Unexpected { number, wanted } => write!(f, "refers to #{number}, which is not {wanted}"),
            Self::Unusable(what) => write!(f, "cannot be used for its {what}"),
            Self::Circular => write!(f, "holds itself, or is nested too deep"),
            Self::NoLength => write!(f, "has no length"),
            Self::Closed => write!(f, "is closed, and a wire has two ends"),
            Self::NoTube(why) => write!(f, "is no tube around one line: {why}"),
            Self::NoUnit => write!(f, "gives no unit of length: give --unit, such as --unit mm"),
            Self::Twice => write!(f, "lies on another line from end to end"),
            Self::OnSheet => write!(f, "stands on a sheet (paper space), not in the model"),
        }
    }
}

/// What is not used, a line for each kind and reason.
pub fn unread(all: &[Unread]) -> Vec<String> {
    let mut groups: Vec<(&Why, &str, Vec<&Place>)> = Vec::new();
    for one in all {
        match groups.iter_mut().find(|(why, entity, _)| *why == &one.why && *entity == one.place.entity) {
            Some((.., places)) => places.push(&one.place),
            None => groups.push((&one.why, &one.place.entity, vec![&one.place])),
        }
    }
    let line = |(why, entity, places): (&Why, &str, Vec<&Place>)| {
        if let [place] = places[..] {
            return format!("{place} {why}");
        }
        let at = |place: &&Place| match place.number {
            Some(number) => format!("#{number}"),
            None => format!("line {}", place.line),
        };
        let named: Vec<String> = places.iter().take(NAMED).map(at).collect();
        let more = if places.len() > NAMED { ", …" } else { "" };
        format!("{} × {entity} ({}{more}): each {why}", places.len(), named.join(", "))
    };
    groups.into_iter().map(line).collect()
}

/// A length (m) in mm with six digits.
pub fn millimetres(metres: f64) -> String {
    significant(mm(metres))
}

/// A length (m) in mm to a nanometre: of places and deviations, what is less is noise.
fn to_nanometre(metres: f64) -> String {
    without_sign_of_zero(error::mm(metres))
}

fn without_sign_of_zero(text: String) -> String {
    if text == "-0" { "0".into() } else { text }
}

fn significant(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    // What is nothing beside the digits of any file.
    if rounded.abs() < 1e-9 { "0".into() } else { units::shortest(rounded) }
}

fn unit_name(metres: f64) -> String {
    let names = [(1e-3, "mm"), (1e-2, "cm"), (1.0, "m"), (1e-6, "µm"), (0.0254, "inch"), (0.3048, "ft")];
    let named = names.into_iter().find(|(unit, _)| (unit / metres - 1.0).abs() < 1e-9);
    named.map_or_else(|| format!("units of {} mm", millimetres(metres)), |(_, name)| name.to_owned())
}

/// A component of a direction, with six digits.
fn component(value: f64) -> String {
    let text = format!("{value:.6}");
    without_sign_of_zero(text.trim_end_matches('0').trim_end_matches('.').to_owned())
}

/// What was found, line by line.
pub fn report(found: &Imported, path: &Path) -> Vec<String> {
    let units: Vec<String> = found.units.iter().map(|unit| unit_name(*unit)).collect();
    let in_units = if units.is_empty() { String::new() } else { format!(", in {}", units.join(" and ")) };
    let points: usize = found.wires.iter().map(|wire| wire.points.len()).sum();
    let mut lines = vec![format!(
        "{}: {}{in_units}: {}, {} ({} mm of chord error)",
        path.display(),
        found.format,
        counted(found.wires.len(), "wire"),
        counted(points, "point"),
        millimetres(found.chord),
    )];
    let joined: usize = found.wires.iter().map(|wire| wire.pieces - 1).sum();
    if joined > 0 {
        lines.push(format!("{} joined, ends up to {} mm apart", counted(joined, "pair"), millimetres(found.reach)));
    }
    lines.extend(axis(found));
    lines.extend(table(&found.layers));
    lines.push(clearance(&found.clearance));
    lines
}

fn axis(found: &Imported) -> Vec<String> {
    let Some(axis) = &found.axis else {
        return vec!["the wires are not laid about one straight axis: they stay as drawn, without layers".into()];
    };
    let [x, y, z] = axis.direction.to_array().map(component);
    let through = axis.origin.reject_from_normalized(axis.direction).to_array().map(to_nanometre);
    let [px, py, pz] = through;
    let moved = if found.is_moved { "; turned and moved to z" } else { "" };
    vec![format!("axis: direction ({x}, {y}, {z}) through ({px}, {py}, {pz}) mm{moved}")]
}

/// Layers as a table.
fn table(layers: &[Layer]) -> Vec<String> {
    if layers.is_empty() {
        return Vec::new();
    }
    let heads = ["layer", "wires", "diameter mm", "lay radius mm", "pitch mm", "lay", "off the helix mm"];
    let mut rows: Vec<[String; 7]> = vec![heads.map(str::to_owned)];
    for layer in layers {
        let is_straight = layer.pitch.is_infinite();
        let spread = match layer.pitch_spread > 1e-4 {
            true => format!(" ± {:.2} %", units::percent(layer.pitch_spread)),
            false => String::new(),
        };
        rows.push([
            layer.name.clone(),
            layer.wires.len().to_string(),
            layer.diameter.map_or_else(|| "not known".into(), millimetres),
            millimetres(layer.radius),
            if is_straight { "straight".into() } else { millimetres(layer.pitch) + &spread },
            if is_straight {
                "-"
            } else if layer.lay > 0.0 {
                "right (Z)"
            } else {
                "left (S)"
            }
            .into(),
            to_nanometre(layer.deviation),
        ]);
    }
    let width = |k: usize| rows.iter().map(|row| row[k].chars().count()).max().unwrap_or(0);
    let widths: [usize; 7] = std::array::from_fn(width);
    let line = |row: &[String; 7]| {
        let cells = row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}"));
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

fn clearance(clearance: &Clearance) -> String {
    match clearance {
        Clearance::NoDiameter(None) => "diameter: not given".into(),
        Clearance::NoDiameter(Some(least)) => {
            format!("diameter: not given; two centre lines come as near as {} mm to each other", millimetres(*least))
        }
        Clearance::Free => "overlaps: none".into(),
        Clearance::Overlaps(deepest) => format!(
            "overlaps: the deepest is {} mm ({:.2} % of the diameter), between wires {} and {} at ({}) mm",
            millimetres(deepest.depth),
            units::percent(deepest.share),
            deepest.bodies[0] + 1,
            deepest.bodies[1] + 1,
            deepest.place.to_array().map(to_nanometre).join(", "),
        ),
        Clearance::NotLookedAt => "overlaps: not looked for, the wires are too long for their diameters".into(),
    }
}

/// Ends that were not joined.
pub fn forks(found: &Imported) -> Vec<String> {
    let line = |fork: &Fork| {
        let place = fork.place.to_array().map(to_nanometre).join(", ");
        format!("{} lines end at ({place}) mm and were not joined: which goes on where is open", fork.ends)
    };
    let mut lines: Vec<String> = found.forks.iter().take(NAMED).map(line).collect();
    if found.forks.len() > NAMED {
        lines.push(format!("and {} such places more", found.forks.len() - NAMED));
    }
    lines
}
