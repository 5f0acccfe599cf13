//! `--set key=value`: one option changes, adds or removes one key of a scene before it is read.
//!
//! The key is a dotted path with element numbers from 0, `strand.layer.0.pitch`. The value is TOML; what is not TOML
//! is taken as text, so that `44 mm` needs no quotes. No value at all (`bond.rupture=`) removes the key.

use super::place::{Part, scene_error};
use super::suggest::nearest;
use crate::base::error::{Error, Result};
use crate::base::wording::counted;
use std::num::IntErrorKind;
use std::ops::Range;
use toml_edit::{DocumentMut, Item, TableLike, Value};

/// One `--set` option.
#[derive(Debug, Clone)]
pub struct Override {
    text: String,
    path: Vec<String>,
    key: Range<usize>,
    value: Range<usize>,
}

impl Override {
    /// Reads `key=value`. Errors: no `=`, an empty key.
    pub fn parse(text: &str) -> Result<Self> {
        let Some(equals) = text.find('=') else {
            return Err(malformed(text, "there is no `=` in this option"));
        };
        let path: Vec<String> = text[..equals].split('.').map(|part| part.trim().to_owned()).collect();
        if path.iter().any(String::is_empty) {
            return Err(malformed(text, "the key is empty or has an empty part"));
        }
        Ok(Self {
            text: text.to_owned(),
            path,
            key: trimmed(text, 0..equals),
            value: trimmed(text, equals + 1..text.len()),
        })
    }

    /// The key path.
    pub fn path(&self) -> &[String] {
        &self.path
    }

    /// Whether it gives a value, and does not remove a key.
    pub(super) fn gives_a_value(&self) -> bool {
        !self.value.is_empty()
    }

    /// An error at this option's key or value.
    pub(super) fn error(&self, part: Part, what: String, help: String) -> Error {
        let span = match part {
            Part::Value if !self.value.is_empty() => self.value.clone(),
            _ => self.key.clone(),
        };
        scene_error(&option_name(&self.text), &self.text, span, what, help)
    }

    /// Changes the document. Errors: an element that is not there, a key below something that is no table, a value
    /// that opens a TOML bracket or quote and does not close it. Unknown keys show when the scene is read.
    pub(super) fn apply(&self, document: &mut DocumentMut) -> Result<()> {
        let (last, parents) = self.path.split_last().expect("a split has one part at least");
        let mut item = document.as_item_mut();
        for (depth, name) in parents.iter().enumerate() {
            item = self.enter(item, depth, name)?;
        }
        match self.parse_value()? {
            Some(value) => self.put(item, last, value),
            None => self.remove(item, last),
        }
    }

    fn parse_value(&self) -> Result<Option<Value>> {
        let text = &self.text[self.value.clone()];
        if text.is_empty() {
            return Ok(None);
        }
        match text.parse::<Value>() {
            Ok(value) => Ok(Some(value)),
            // Something that opens like TOML and is not is a mistake; anything else is text without quotes.
            Err(error) if text.starts_with(['[', '{', '"', '\'']) => Err(self.error(
                Part::Value,
                format!("this value is not TOML: {}", error.message()),
                "close every bracket and quote; quote the whole option for the shell".into(),
            )),
            Err(_) if text.parse::<i64>().is_err_and(|e| *e.kind() == IntErrorKind::PosOverflow) => {
                let what = format!("{text} is too large for a whole number");
                Err(self.error(Part::Value, what, format!("the largest is {}", i64::MAX)))
            }
            Err(_) => Ok(Some(Value::from(text))),
        }
    }

    /// The entry `name` of `item`, made as an empty table where there is none.
    fn enter<'a>(&self, item: &'a mut Item, depth: usize, name: &str) -> Result<&'a mut Item> {
        if item.is_table_like() {
            let table = item.as_table_like_mut().expect("just asked");
            let empty = || Item::Value(Value::InlineTable(Default::default()));
            return Ok(table.entry(name).or_insert_with(empty));
        }
        let index = self.element(item, depth, name)?;
        Ok(item.get_mut(index).expect("the index was checked"))
    }

    fn put(&self, item: &mut Item, name: &str, value: Value) -> Result<()> {
        if let Some(table) = item.as_table_like_mut() {
            table.insert(name, Item::Value(value));
            return Ok(());
        }
        let index = self.element(item, self.path.len() - 1, name)?;
        let element = item.get_mut(index).expect("the index was checked");
        *element = match (&element, value) {
            (Item::Table(_), Value::InlineTable(table)) => Item::Table(table.into_table()),
            (Item::Table(_), other) => {
                let what =
                    format!("`{}` is a table, but the value is of type {}", self.path.join("."), other.type_name());
                return Err(self.error(Part::Value, what, "give { key = value, … }".into()));
            }
            (_, value) => Item::Value(value),
        };
        Ok(())
    }

    fn remove(&self, item: &mut Item, name: &str) -> Result<()> {
        let whole = self.path.join(".");
        let Some(table) = item.as_table_like_mut() else {
            let what = format!("`{whole}` is an element, and elements cannot be removed one by one");
            return Err(self.error(Part::Key, what, "give the whole array instead".into()));
        };
        if table.remove(name).is_none() {
            let what = format!("there is no `{whole}` to remove");
            return Err(self.error(Part::Key, what, present_keys(table, name)));
        }
        Ok(())
    }

    /// Reads `name` as the number of an element of `item`.
    fn element(&self, item: &Item, depth: usize, name: &str) -> Result<usize> {
        let parent = self.path[..depth].join(".");
        let len = match item {
            Item::ArrayOfTables(tables) => tables.len(),
            Item::Value(Value::Array(array)) => array.len(),
            other => {
                let what = format!("`{parent}` is of type {}, so it has no key `{name}`", other.type_name());
                return Err(self.error(Part::Key, what, format!("set `{parent}` itself")));
            }
        };
        match name.parse::<usize>() {
            Ok(index) if index < len => Ok(index),
            _ => {
                let what = format!("`{parent}` has {}, and `{name}` is none of them", counted(len, "element"));
                let help = match len {
                    0 => format!("set the whole of `{parent}`"),
                    1 => "the first element has number 0".into(),
                    _ => format!("elements are numbered from 0 to {}", len - 1),
                };
                Err(self.error(Part::Key, what, help))
            }
        }
    }
}

/// Name under which an option is shown in an error.
fn option_name(text: &str) -> String {
    format!("--set {text}")
}

fn malformed(text: &str, what: &str) -> Error {
    let help = "write --set key=value, for example --set 'strand.layer.0.pitch=44 mm'";
    scene_error(&option_name(text), text, 0..text.len(), what.into(), help.into())
}

fn present_keys(table: &dyn TableLike, name: &str) -> String {
    let keys: Vec<&str> = table.iter().map(|(key, _)| key).collect();
    match nearest(name, keys.iter().copied()) {
        Some(key) => format!("did you mean `{key}`?"),
        None if keys.is_empty() => String::new(),
        None => format!("what is there: {}", keys.join(", ")),
    }
}

/// `range` of `text` without the blanks at its ends.
fn trimmed(text: &str, range: Range<usize>) -> Range<usize> {
    let part = &text[range.clone()];
    let start = range.start + (part.len() - part.trim_start().len());
    start..start + part.trim().len()
}
