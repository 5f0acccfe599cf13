//! Places in the text of a scene, and errors that point at them.

use crate::base::error::{Error, SceneError};
use miette::{NamedSource, SourceSpan};
use std::ops::Range;
use toml_edit::Item;

/// Which part of an entry an error points at.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    Key,
    Value,
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

pub(super) struct Place {
    pub(super) span: Range<usize>,
    /// The whole path was found, not only a parent.
    pub(super) exact: bool,
}

/// The place of `path`, or of the nearest parent that has one.
pub(super) fn find(root: &Item, path: &[String], part: Part) -> Option<Place> {
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
