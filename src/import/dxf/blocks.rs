//! Blocks, and where they are set in.

use super::tags::{Entity, File};
use crate::base::error::Result;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::HashMap;

/// Most rows and columns of an INSERT together.
const MOST_SET_IN: f64 = 10_000.0;

/// A block.
#[derive(Debug, Clone, Copy)]
pub struct Block<'a> {
    /// Its name.
    pub name: &'a str,
    /// The point that comes to lie where it is set in.
    pub base: DVec3,
    /// What it holds.
    pub entities: &'a [Entity<'a>],
}

/// Blocks by their names.
pub struct Blocks<'a>(HashMap<String, Block<'a>>);

impl<'a> Blocks<'a> {
    /// Those of a file. Names have no case.
    pub fn of(blocks: &'a [Vec<Entity<'a>>]) -> Self {
        let named = blocks.iter().filter_map(|block| {
            let (head, entities) = block.split_first()?;
            let axis = |code| head.first(code).and_then(|tag| tag.value.parse().ok()).unwrap_or(0.0);
            let base = DVec3::new(axis(10), axis(20), axis(30));
            let name = head.first(2)?.value;
            Some((name.to_uppercase(), Block { name, base, entities }))
        });
        Self(named.collect())
    }

    /// The block that an INSERT sets in.
    pub fn find(&self, insert: &Entity) -> Option<Block<'a>> {
        self.0.get(&insert.first(2)?.value.to_uppercase()).copied()
    }
}

/// Axes of the plane in which an entity is drawn, by its extrusion direction (arbitrary axis algorithm).
pub fn plane(file: &File, entity: &Entity) -> Result<DAffine3> {
    let z = file.point_or(entity, 210, DVec3::Z)?.try_normalize().unwrap_or(DVec3::Z);
    let x = if z.x.abs() < 1.0 / 64.0 && z.y.abs() < 1.0 / 64.0 { DVec3::Y.cross(z) } else { DVec3::Z.cross(z) };
    let x = x.normalize();
    Ok(DAffine3::from_mat3(DMat3::from_cols(x, z.cross(x), z)))
}

/// Where an INSERT sets its block in; `None` for an array without an end.
pub fn places(file: &File, insert: &Entity, base: DVec3) -> Result<Option<Vec<DAffine3>>> {
    let number = |code, otherwise| file.number_or(insert, code, otherwise);
    let scale = DVec3::new(number(41, 1.0)?, number(42, 1.0)?, number(43, 1.0)?);
    let (columns, rows) = (number(70, 1.0)?.max(1.0), number(71, 1.0)?.max(1.0));
    let step = DVec3::new(number(44, 0.0)?, number(45, 0.0)?, 0.0);
    if columns * rows > MOST_SET_IN {
        return Ok(None);
    }
    let at = file.point_or(insert, 10, DVec3::ZERO)?;
    let turned = DAffine3::from_rotation_z(number(50, 0.0)?.to_radians());
    let outer = plane(file, insert)? * DAffine3::from_translation(at) * turned;
    let inner = DAffine3::from_scale(scale) * DAffine3::from_translation(-base);
    let place = |column: usize, row: usize| {
        outer * DAffine3::from_translation(step * DVec3::new(column as f64, row as f64, 0.0)) * inner
    };
    let (columns, rows) = (columns as usize, rows as usize);
    Ok(Some(
        (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))).map(|(c, r)| place(c, r)).collect(),
    ))
}
