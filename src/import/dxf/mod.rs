//! DXF files (ASCII): lines, polylines, arcs, ellipses, splines and helices, in blocks and units of any kind.
//!
//! Group codes are those of Autodesk's DXF reference.

mod blocks;
mod entities;
mod part;
mod polylines;
mod tags;

use super::contents::Contents;
use super::fault::{Place, Unread, Why};
use super::shape::Piece;
use crate::base::error::{Error, Result};
use blocks::Blocks;
use glam::{DAffine3, DVec3};
use std::path::Path;
use std::sync::Arc;
use tags::{Entity, File};

/// Deepest nesting of blocks.
const DEEPEST: usize = 32;
/// Most entities after all blocks are set in: beyond it a file multiplies them by nesting.
const MOST_ENTITIES: usize = 1_000_000;

/// What a binary file begins with.
pub const BINARY: &[u8] = b"AutoCAD Binary DXF";

/// Whether text begins as such a file does: with a comment or a section.
pub fn is_one(text: &str) -> bool {
    let mut lines = text.trim_start_matches('\u{feff}').lines().map(str::trim);
    matches!((lines.next(), lines.next()), (Some("0"), Some("SECTION")) | (Some("999"), Some(_)))
}

/// Reads a file. `unit` (m) takes the place of what its header says.
///
/// # Errors
/// [`Error::Input`] with the line: a file that is cut off, a number that is not finite; or without a unit.
pub fn read(text: &str, path: &Path, unit: Option<f64>) -> Result<Contents> {
    let file = tags::parse(text, path)?;
    let unit = match (unit, file.unit) {
        (Some(unit), _) => unit,
        (None, Some(code)) => length(code).ok_or_else(|| without_unit(path, &format!("$INSUNITS is {code}")))?,
        (None, None) => return Err(without_unit(path, "it has no $INSUNITS")),
    };
    let contents = Contents { format: "DXF".into(), units: vec![unit], ..Contents::default() };
    let mut drawing = Drawing { path, file: &file, blocks: Blocks::of(&file.blocks), contents, seen: 0 };
    let scale = DAffine3::from_scale(DVec3::splat(unit));
    drawing.add(&file.entities, scale, &mut Vec::new())?;
    Ok(drawing.contents)
}

fn without_unit(path: &Path, why: &str) -> Error {
    Error::input(
        format!("{} does not say in what unit it is drawn: {why}", path.display()),
        "give --unit, such as --unit mm",
    )
}

/// The unit of $INSUNITS (m).
fn length(code: i64) -> Option<f64> {
    const UNITS: [(i64, f64); 14] = [
        (1, 0.0254),
        (2, 0.3048),
        (4, 1e-3),
        (5, 1e-2),
        (6, 1.0),
        (7, 1e3),
        (8, 2.54e-8),
        (9, 2.54e-5),
        (10, 0.9144),
        (11, 1e-10),
        (12, 1e-9),
        (13, 1e-6),
        (14, 1e-1),
        (15, 1e1),
    ];
    UNITS.iter().find(|(known, _)| *known == code).map(|(_, metres)| *metres)
}

struct Drawing<'a> {
    path: &'a Path,
    file: &'a File<'a>,
    blocks: Blocks<'a>,
    contents: Contents,
    /// Entities so far, each as often as it is set in.
    seen: usize,
}

impl<'a> Drawing<'a> {
    /// Adds entities that lie in these blocks.
    fn add(&mut self, all: &'a [Entity<'a>], place: DAffine3, within: &mut Vec<&'a str>) -> Result<()> {
        for entity in all {
            self.seen += 1;
            if self.seen > MOST_ENTITIES {
                let what = format!("{} has more than {MOST_ENTITIES} entities", self.path.display());
                return Err(Error::input(what, "export the wires alone, without blocks within blocks"));
            }
            // Sheets of paper show the model again.
            if entity.kind == "VIEWPORT" {
                continue;
            }
            let source = Place { entity: entity.kind.to_owned(), number: None, line: entity.line };
            if entity.first(67).is_some_and(|tag| tag.value == "1") {
                self.contents.unread.push(Unread { why: Why::OnSheet, place: source });
                continue;
            }
            if entity.kind == "INSERT" {
                let Some(block) = self.blocks.find(entity) else {
                    let why = Why::Unusable("block: its name is that of a BLOCK");
                    self.contents.unread.push(Unread { why, place: source });
                    continue;
                };
                if within.contains(&block.name) || within.len() >= DEEPEST {
                    self.contents.unread.push(Unread { why: Why::Circular, place: source });
                    continue;
                }
                let Some(places) = blocks::places(self.file, entity, block.base)? else {
                    let why = Why::Unusable("array: at most 10000 rows and columns together");
                    self.contents.unread.push(Unread { why, place: source });
                    continue;
                };
                within.push(block.name);
                for inner in places {
                    self.add(block.entities, place * inner, within)?;
                }
                within.pop();
                continue;
            }
            match entities::parts(self.file, entity)? {
                Ok(parts) => {
                    let piece = |part: part::Part| Piece {
                        shape: Arc::new(part.shape),
                        from: part.from,
                        to: part.to,
                        place: place * part.place,
                        diameter: None,
                        source: source.clone(),
                    };
                    self.contents.pieces.extend(parts.into_iter().map(piece));
                }
                Err(why) => self.contents.unread.push(Unread { why, place: source }),
            }
        }
        Ok(())
    }
}
