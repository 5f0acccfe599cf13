//! Where a key stands: in the scene file, or in a `--set` option. Errors about a key get their place here.

use super::overrides::Override;
use super::place::{Part, find, scene_error};
use crate::base::error::Error;
use std::cmp::Ordering;
use toml_edit::Document;

/// The text that a scene, or a study, came from, so that any later floor can point at the line of a key.
#[derive(Debug, Clone)]
pub struct SceneSource {
    file_name: String,
    document: Document<String>,
    overrides: Vec<Override>,
}

impl SceneSource {
    pub(super) fn new(file_name: &str, document: Document<String>, overrides: Vec<Override>) -> Self {
        Self { file_name: file_name.to_owned(), document, overrides }
    }

    /// What it was read from: a file's path, or the name of a built-in scene.
    pub fn file_name(&self) -> &str {
        &self.file_name
    }

    /// An error at the value of a key path such as `strand.layer.1.lay_radius`, or at its nearest parent that the
    /// scene has. A value that a `--set` option gave is shown there. An empty `help` means none.
    pub fn error(&self, key_path: &str, what: impl Into<String>, help: impl Into<String>) -> Error {
        let path: Vec<String> = key_path.split('.').filter(|part| !part.is_empty()).map(str::to_owned).collect();
        self.error_at(&path, Part::Value, what.into(), help.into())
    }

    /// Path of the last `--set` option that gives the key at `key_path`, or one below it; `None` when none does.
    pub(super) fn option_below(&self, key_path: &str) -> Option<String> {
        let path: Vec<&str> = key_path.split('.').collect();
        let below = |option: &&Override| {
            option.gives_a_value()
                && option.path().len() >= path.len()
                && option.path().iter().zip(&path).all(|(own, key)| own == key)
        };
        self.overrides.iter().rev().find(below).map(|option| option.path().join("."))
    }

    /// Whether a `--set` option gives or removes the key at `key_path`, one below it, or a table that holds it.
    pub(super) fn is_set(&self, key_path: &str) -> bool {
        let own = |option: &Override| option.path().iter().zip(key_path.split('.')).all(|(own, key)| own == key);
        self.overrides.iter().any(own)
    }

    pub(super) fn error_at(&self, path: &[String], part: Part, what: String, help: String) -> Error {
        let place = find(self.document.as_item(), path, part);
        let in_file = place.as_ref().is_some_and(|place| place.exact);
        // A value that an option replaced is shown in the option. A table that only options made, too.
        let chosen = self.overrides.iter().rev().find(|option| path.starts_with(option.path())).or_else(|| {
            let below = |option: &&Override| option.path().starts_with(path);
            self.overrides.iter().rev().find(|o| !in_file && below(o))
        });
        match chosen {
            Some(option) => {
                // At what the error is about; at the value that holds it; at the key that made the table.
                let part = match path.len().cmp(&option.path().len()) {
                    Ordering::Equal => part,
                    Ordering::Greater => Part::Value,
                    Ordering::Less => Part::Key,
                };
                option.error(part, what, help)
            }
            None => {
                let span = place.map_or(0..0, |place| place.span);
                scene_error(&self.file_name, self.document.raw(), span, what, help)
            }
        }
    }
}
