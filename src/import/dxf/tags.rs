//! Pairs of a group code and a value, and entities of them.

use crate::base::error::{Error, Result};
use glam::DVec3;
use std::path::Path;

/// A group code with its value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tag<'a> {
    /// What the value means.
    pub code: i32,
    /// The value, without blanks around it.
    pub value: &'a str,
    /// Line of the value, from 1.
    pub line: usize,
}

/// An entity.
#[derive(Debug, Clone, PartialEq)]
pub struct Entity<'a> {
    /// Its kind: LINE, ARC.
    pub kind: &'a str,
    /// Line of its kind, from 1.
    pub line: usize,
    /// What it says.
    pub tags: Vec<Tag<'a>>,
    /// Entities that belong to it, as vertices to a POLYLINE.
    pub parts: Vec<Entity<'a>>,
}

/// A file.
#[derive(Debug)]
pub struct File<'a> {
    path: &'a Path,
    /// $INSUNITS.
    pub unit: Option<i64>,
    /// Blocks: each begins with a BLOCK.
    pub blocks: Vec<Vec<Entity<'a>>>,
    /// The model itself.
    pub entities: Vec<Entity<'a>>,
}

impl<'a> Entity<'a> {
    /// The first value of a code.
    pub fn first(&self, code: i32) -> Option<Tag<'a>> {
        self.tags.iter().copied().find(|tag| tag.code == code)
    }

    /// Its tags below a subclass marker (code 100), up to the next.
    pub fn subclass(&self, name: &str) -> Option<Entity<'a>> {
        let at = self.tags.iter().position(|tag| tag.code == 100 && tag.value == name)?;
        let tags = self.tags[at + 1..].iter().copied().take_while(|tag| tag.code != 100).collect();
        Some(Entity { kind: self.kind, line: self.line, tags, parts: Vec::new() })
    }
}

impl File<'_> {
    /// An error at a line.
    pub fn error(&self, line: usize, what: &str, help: &str) -> Error {
        error(self.path, line, what, help)
    }

    /// The number of a tag.
    pub fn number(&self, tag: Tag) -> Result<f64> {
        let value = tag.value.parse::<f64>().ok().filter(|value| value.is_finite());
        value.ok_or_else(|| {
            let what = format!("`{}` (group code {}) is no finite number", tag.value.escape_debug(), tag.code);
            self.error(tag.line, &what, "write it with digits, such as 12.5")
        })
    }

    /// The number of a code, or what holds without it.
    pub fn number_or(&self, entity: &Entity, code: i32, otherwise: f64) -> Result<f64> {
        entity.first(code).map_or(Ok(otherwise), |tag| self.number(tag))
    }

    /// All numbers of a code.
    pub fn numbers(&self, entity: &Entity, code: i32) -> Result<Vec<f64>> {
        entity.tags.iter().filter(|tag| tag.code == code).map(|tag| self.number(*tag)).collect()
    }

    /// The flags of a code.
    pub fn flags(&self, entity: &Entity, code: i32) -> Result<u32> {
        let number = self.number_or(entity, code, 0.0)?;
        Ok(if (0.0..1e9).contains(&number) { number as u32 } else { 0 })
    }

    /// The point whose x has this code, or what holds without it; y and z have 10 and 20 more.
    pub fn point_or(&self, entity: &Entity, code: i32, otherwise: DVec3) -> Result<DVec3> {
        let axis = |k: i32, otherwise| self.number_or(entity, code + 10 * k, otherwise);
        match entity.first(code) {
            None => Ok(otherwise),
            Some(_) => Ok(DVec3::new(axis(0, 0.0)?, axis(1, 0.0)?, axis(2, 0.0)?)),
        }
    }

    /// All points whose x has this code, in their order.
    pub fn points(&self, entity: &Entity, code: i32) -> Result<Vec<DVec3>> {
        let mut points: Vec<DVec3> = Vec::new();
        for tag in &entity.tags {
            let axis = (tag.code - code) / 10;
            if (tag.code - code) % 10 != 0 || !(0..3).contains(&axis) {
                continue;
            }
            let value = self.number(*tag)?;
            match (axis, points.last_mut()) {
                (0, _) => points.push(DVec3::new(value, 0.0, 0.0)),
                (1, Some(point)) => point.y = value,
                (2, Some(point)) => point.z = value,
                _ => return Err(self.error(tag.line, "a coordinate stands before its x", "points begin with their x")),
            }
        }
        Ok(points)
    }
}

fn error(path: &Path, line: usize, what: &str, help: &str) -> Error {
    Error::input(format!("{}, line {line}: {what}", path.display()), help)
}

/// Reads a file's text.
///
/// # Errors
/// [`Error::Input`] with the line where it is cut off or no such file.
pub fn parse<'a>(text: &'a str, path: &'a Path) -> Result<File<'a>> {
    let tags = pairs(text.trim_start_matches('\u{feff}'), path)?;
    let mut file = File { path, unit: None, blocks: Vec::new(), entities: Vec::new() };
    let mut section = "";
    let mut in_parts = false;
    let mut at = 0;
    while at < tags.len() {
        let tag = tags[at];
        let end = tags[at + 1..].iter().position(|next| next.code == 0).map_or(tags.len(), |next| at + 1 + next);
        let own = &tags[at + 1..end];
        at = end;
        if tag.code != 0 {
            continue;
        }
        match (tag.value, section) {
            ("EOF", "") => return Ok(file),
            ("ENDSEC", _) => section = "",
            ("SECTION", _) => {
                section = own.first().filter(|name| name.code == 2).map_or("OTHER", |name| name.value);
                if section == "HEADER" {
                    let unit = own.windows(2).find(|two| two[0].code == 9 && two[0].value == "$INSUNITS");
                    file.unit = unit.and_then(|two| two[1].value.parse().ok());
                }
            }
            (kind, "ENTITIES" | "BLOCKS") => {
                let entity = Entity { kind, line: tag.line, tags: own.to_vec(), parts: Vec::new() };
                let list = match section {
                    "ENTITIES" => Some(&mut file.entities),
                    _ if kind == "BLOCK" => {
                        file.blocks.push(vec![entity]);
                        continue;
                    }
                    _ if kind == "ENDBLK" => continue,
                    _ => file.blocks.last_mut(),
                };
                match (kind, list) {
                    ("SEQEND", _) => in_parts = false,
                    ("VERTEX" | "ATTRIB", Some(list)) if in_parts => {
                        if let Some(owner) = list.last_mut() {
                            owner.parts.push(entity);
                        }
                    }
                    (_, Some(list)) => {
                        in_parts = matches!(kind, "POLYLINE" | "INSERT");
                        list.push(entity);
                    }
                    (_, None) => {}
                }
            }
            _ => {}
        }
    }
    let last = tags.last().map_or(1, |tag| tag.line);
    Err(error(path, last, "the file ends here, without EOF", "it was cut off: save or copy it again"))
}

fn pairs<'a>(text: &'a str, path: &Path) -> Result<Vec<Tag<'a>>> {
    let mut lines = text.lines().enumerate();
    let mut tags = Vec::new();
    while let Some((at, code)) = lines.next() {
        let code = code.trim();
        let Some((below, value)) = lines.next() else {
            match code.is_empty() {
                true => break,
                false => {
                    return Err(error(
                        path,
                        at + 1,
                        "the file ends here, within a pair",
                        "it was cut off: save or copy it again",
                    ));
                }
            }
        };
        let Ok(number) = code.parse::<i32>() else {
            let shown: String = code.chars().take(16).flat_map(char::escape_debug).collect();
            let what = format!("`{shown}` stands where a group code is expected");
            return Err(error(
                path,
                at + 1,
                &what,
                "DXF is made of pairs of lines, a whole number and a value; save it as ASCII DXF",
            ));
        };
        tags.push(Tag { code: number, value: value.trim(), line: below + 1 });
        if number == 0 && value.trim() == "EOF" {
            break;
        }
    }
    Ok(tags)
}
