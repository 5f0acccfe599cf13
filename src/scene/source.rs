//! Where a key stands: in the scene file, or in a `--set` option. Every error about a scene is made here.

use super::overrides::Override;
use crate::base::error::{Error, SceneError};
use miette::{NamedSource, SourceSpan};
use std::cmp::Ordering;
use std::ops::Range;
use toml_edit::{Document, Item};

/// The text that a scene, or a study, came from, so that any later floor can point at the line of a key.
#[derive(Debug, Clone)]
pub struct SceneSource {
    file_name: String,
    document: Document<String>,
    overrides: Vec<Override>,
}

/// Which part of an entry an error points at.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    Key,
    Value,
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

/// A scene error with its place.
pub(super) fn scene_error(name: &str, text: &str, span: Range<usize>, what: String, help: String) -> Error {
    Error::Scene(Box::new(SceneError {
        what,
        help: (!help.is_empty()).then_some(help),
        source_code: NamedSource::new(name, text.to_owned()),
        span: Some(SourceSpan::from(span)),
    }))
}

struct Place {
    span: Range<usize>,
    /// The whole path was found, not only a parent.
    exact: bool,
}

/// The place of `path`, or of the nearest parent that has one.
fn find(root: &Item, path: &[String], part: Part) -> Option<Place> {
    let mut item = root;
    let mut best = None;
    for (depth, name) in path.iter().enumerate() {
        let Some((key_span, next)) = child(item, name) else {
            break;
        };
        let last = depth + 1 == path.len();
        let span = match part {
            Part::Key if last => key_span.or(next.span()),
            _ => next.span().or(key_span),
        };
        if let Some(span) = span {
            best = Some(Place { span, exact: last });
        }
        item = next;
    }
    best
}

/// Entry `name` of a table, or element `name` of an array, and the place of its key.
fn child<'a>(item: &'a Item, name: &str) -> Option<(Option<Range<usize>>, &'a Item)> {
    if let Some(table) = item.as_table_like() {
        let (key, next) = table.get_key_value(name)?;
        return Some((key.span(), next));
    }
    let index: usize = name.parse().ok()?;
    item.get(index).map(|next| (None, next))
}

/// The key path whose key or value at `at` spans the fewest bytes, and which of the two it is.
///
/// Serde reports places in the text; this turns them into key paths, which stay valid when options change the text.
pub(super) fn path_at(root: &Item, at: &Range<usize>) -> (Vec<String>, Part) {
    let mut best = Nearest { width: usize::MAX, path: Vec::new(), part: Part::Value };
    visit(root, at, &mut Vec::new(), &mut best);
    (best.path, best.part)
}

struct Nearest {
    width: usize,
    path: Vec<String>,
    part: Part,
}

impl Nearest {
    fn offer(&mut self, span: Option<Range<usize>>, at: &Range<usize>, path: &[String], part: Part) {
        let Some(span) = span else { return };
        if span.start <= at.start && at.end <= span.end && span.len() < self.width {
            self.width = span.len();
            self.path = path.to_vec();
            self.part = part;
        }
    }
}

fn visit(item: &Item, at: &Range<usize>, path: &mut Vec<String>, best: &mut Nearest) {
    if let Some(table) = item.as_table_like() {
        for (name, next) in table.iter() {
            path.push(name.to_owned());
            best.offer(table.key(name).and_then(|key| key.span()), at, path, Part::Key);
            best.offer(next.span(), at, path, Part::Value);
            visit(next, at, path, best);
            path.pop();
        }
    }
    for (index, next) in (0..).map_while(|index| item.get(index).map(|next| (index, next))) {
        path.push(index.to_string());
        best.offer(next.span(), at, path, Part::Value);
        visit(next, at, path, best);
        path.pop();
    }
}
