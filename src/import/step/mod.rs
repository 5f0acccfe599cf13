//! STEP files (AP203, AP214, AP242): curves, wires of edges, and tubes, in assemblies and units of any kind.
//!
//! Entities are those of ISO 10303-42 (geometry, topology), -43 (representations), -41 (units) and -44 (assemblies).

mod assembly;
mod curves;
mod edges;
mod items;
mod model;
mod placement;
mod reader;
mod shapes;
mod splines;
mod surfaces;
mod trims;
mod tubes;
mod units;

use super::contents::Contents;
use super::part21;
use super::shape::Piece;
use crate::base::error::Result;
use assembly::Assembly;
use glam::{DAffine3, DVec3};
use model::{Model, Read};
use reader::{Reader, Segment};
use std::path::Path;
use units::Units;

/// Reads a file. `unit` (m) takes the place of what its representations say.
///
/// # Errors
/// [`crate::base::error::Error::Input`] with the line where it is no exchange structure.
pub fn read(text: &str, path: &Path, unit: Option<f64>) -> Result<Contents> {
    let exchange = part21::parse(text, path)?;
    let model = Model { exchange: &exchange };
    let schemas: Vec<&str> =
        exchange.schemas.iter().map(|name| name.split_whitespace().next().unwrap_or_default()).collect();
    let mut contents = Contents { format: format!("STEP ({})", schemas.join(", ")), ..Contents::default() };
    let assembly = match Assembly::of(&model, unit) {
        Ok(assembly) => assembly,
        Err(unread) => {
            contents.unread.push(unread);
            return Ok(contents);
        }
    };
    for representation in model.representations() {
        if let Err(unread) = add(&model, &assembly, representation, unit, &mut contents) {
            contents.unread.push(unread);
        }
    }
    Ok(contents)
}

/// Adds what the items of a representation give, wherever it is placed.
fn add(model: &Model, assembly: &Assembly, number: u64, unit: Option<f64>, contents: &mut Contents) -> Read<()> {
    let items = model.items(number)?;
    let mut found: Vec<(u64, Vec<Segment>)> = Vec::new();
    let units = Units::of(model, number, unit);
    for item in items {
        let reader = Reader { model, angle: units.as_ref().map_or(1.0, |units| units.angle) };
        for (source, segments) in items::item(&reader, item) {
            match segments {
                Ok(segments) => found.push((source, segments)),
                Err(unread) => contents.unread.push(unread),
            }
        }
    }
    if found.is_empty() {
        return Ok(());
    }
    let units = units?;
    if !contents.units.contains(&units.length) {
        contents.units.push(units.length);
    }
    let scale = DAffine3::from_scale(DVec3::splat(units.length));
    for place in assembly.places(model, number)? {
        for (source, segments) in &found {
            contents.pieces.extend(segments.iter().map(|segment| Piece {
                shape: segment.shape.clone(),
                from: segment.from,
                to: segment.to,
                place: place * scale,
                diameter: segment.diameter.map(|diameter| diameter * units.length),
                source: model.place(*source),
            }));
        }
    }
    Ok(())
}
