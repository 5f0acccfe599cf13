//! Floor 2: TOML → [`spec::Spec`] (SI) → [`plan::Plan`] (what this scene needs, with a reason per component).
//!
//! Keys, units and defaults of a scene file: [`raw`].

mod at;
pub mod builtin;
pub mod caution;
pub mod centreline_text;
mod construction;
pub mod hardening;
mod idle;
pub mod keys;
pub mod look;
pub mod material;
mod materials;
mod overrides;
pub mod picture;
mod place;
pub mod plan;
pub mod quality;
pub mod raw;
mod resolve;
mod resolve_bodies;
mod resolve_drive;
mod resolve_materials;
mod resolve_picture;
mod resolve_rigid;
pub mod rigid;
mod source;
pub mod spec;
pub mod suggest;
pub mod write;

pub use at::can_name_a_folder;
pub use idle::Idle;
pub use source::SceneSource;

use crate::base::error::Result;
use crate::base::regular;
use at::At;
use overrides::Override;
use place::{path_at, scene_error};
use plan::Plan;
use serde::de::DeserializeOwned;
use spec::Spec;
use std::path::Path;
use toml_edit::Document;

/// A scene that was read: what it says, and where it says so.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The resolved scene.
    pub spec: Spec,
    /// What it needs: made with the scene and handed on ([`Self::changed`] makes it anew).
    pub plan: Plan,
    /// Its text, for errors that later floors find.
    pub source: SceneSource,
    /// Keys that it gives without effect.
    pub idle: Vec<Idle>,
    /// Most memory that its run may take (bytes); `None`: what is free.
    pub memory: Option<u64>,
}

impl Scene {
    /// The scene with a change of what it says, and with the plan of that.
    #[must_use]
    pub fn changed(mut self, change: impl FnOnce(&mut Spec)) -> Self {
        change(&mut self.spec);
        self.plan = Plan::new(&self.spec);
        self
    }
}

/// Loads a scene by built-in name or by path, with `--set` options.
///
/// What ends in `.toml`, holds a path separator or names an existing file is a path; `verify/NAME` without `.toml` is
/// a scene of `strandsnap verify`. Errors: an unknown name (with the
/// nearest), a file that cannot be read, anything wrong in the scene or in an option.
pub fn load(name_or_path: &str, overrides: &[String]) -> Result<Scene> {
    let path = Path::new(name_or_path);
    if !is_path(name_or_path) {
        let text = builtin::find(name_or_path)?;
        return parse(text, &format!("{name_or_path}.toml"), Path::new("."), overrides);
    }
    let text = regular::text_if_there(path, regular::LONGEST_SCENE)?.ok_or_else(|| builtin::no_such_file(path))?;
    let folder = path.parent().unwrap_or(Path::new("."));
    parse(&text, name_or_path, folder, overrides)
}

/// Whether a scene argument means a file.
fn is_path(argument: &str) -> bool {
    let in_folder = argument.contains(std::path::is_separator) && !builtin::is_verification(argument);
    argument.ends_with(".toml") || in_folder || Path::new(argument).is_file()
}

/// Reads a scene from its text. `file_name` is shown in errors, and its stem names the scene where the text does not;
/// `folder` is where centreline files are looked for.
pub fn parse(text: &str, file_name: &str, folder: &Path, overrides: &[String]) -> Result<Scene> {
    let document = document(text, file_name)?;
    let overrides = overrides.iter().map(|text| Override::parse(text)).collect::<Result<Vec<_>>>()?;
    let mut changed = document.clone().into_mut();
    overrides.iter().try_for_each(|option| option.apply(&mut changed))?;
    let source = SceneSource::new(file_name, document, overrides);
    let raw: raw::RawScene = read_tables(&changed.to_string(), &source, "a scene")?;
    let stem = Path::new(file_name).file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy());
    let spec = resolve::resolve(&At::root(&source), &raw, &stem, folder)?;
    let plan = Plan::new(&spec);
    let idle = idle::check(&source, &raw, &spec, &plan)?;
    Ok(Scene { spec, plan, source, idle, memory: None })
}

/// Reads tables of another kind than a scene, with errors of the same kind: `whole` says what it is, "a study".
///
/// # Errors
/// Text that is not TOML; keys or values that the tables do not have.
pub fn read<T: DeserializeOwned>(text: &str, file_name: &str, whole: &str) -> Result<(T, SceneSource)> {
    let source = SceneSource::new(file_name, document(text, file_name)?, Vec::new());
    let tables = read_tables(text, &source, whole)?;
    Ok((tables, source))
}

fn document(text: &str, file_name: &str) -> Result<Document<String>> {
    Document::parse(text.to_owned()).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        scene_error(file_name, text, span, format!("this is not TOML: {}", error.message()), String::new())
    })
}

/// Reads the raw tables of `whole`; what serde has to say is brought back to key paths.
fn read_tables<T: DeserializeOwned>(text: &str, source: &SceneSource, whole: &str) -> Result<T> {
    toml::from_str(text).map_err(|error| {
        let document = Document::parse(text).expect("it was read before, or toml_edit wrote it");
        let (path, part) =
            error.span().map_or_else(|| (Vec::new(), place::Part::Value), |span| path_at(document.as_item(), &span));
        let (what, help) = in_plain_words(error.message(), &path, whole);
        source.error_at(&path, part, what, help)
    })
}

/// Serde's message as what is wrong and what would be right.
fn in_plain_words(message: &str, path: &[String], whole: &str) -> (String, String) {
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let key = path.join(".");
    if let (true, [unknown, known @ ..]) = (message.starts_with("unknown field"), &quoted[..]) {
        let place = match path.split_last() {
            Some((_, parents)) if !parents.is_empty() => format!("`{}`", parents.join(".")),
            _ => whole.into(),
        };
        return (format!("unknown key `{unknown}` in {place}"), did_you_mean(unknown, known, "known keys"));
    }
    if let (true, [unknown, known @ ..]) = (message.starts_with("unknown variant"), &quoted[..]) {
        return (format!("`{unknown}` is not a value of `{key}`"), did_you_mean(unknown, known, "one of"));
    }
    let place = if key.is_empty() { String::new() } else { format!("`{key}`: ") };
    (format!("{place}{}", of_types(message, path)), String::new())
}

/// Serde's names of types as the user writes such a value; a table is named by its `path`.
fn of_types(message: &str, path: &[String]) -> String {
    let numbers = |part: &&String| part.parse::<usize>().is_err();
    let name = path.iter().filter(numbers).cloned().collect::<Vec<_>>().join(".");
    let table = match path.last() {
        None => "the tables of a file".into(),
        Some(last) if last.parse::<usize>().is_ok() => format!("a table, such as [[{name}]] begins"),
        Some(_) => format!("a table, such as [{name}] begins"),
    };
    let mut words: Vec<&str> = message.split(' ').collect();
    // "struct RawStrand", "enum RawLay": the kind, then a name of this program's.
    while let Some(at) = words.windows(2).position(|pair| ["struct", "enum"].contains(&pair[0])) {
        words[at] = if words[at] == "struct" { &table } else { "one of its words" };
        words.remove(at + 1);
    }
    let message = words.join(" ");
    [
        ("i64", "a whole number"),
        ("u64", "a whole number"),
        ("usize", "a whole number"),
        ("f64", "a number"),
        ("floating point", "number"),
        ("a sequence", "an array"),
        ("sequence", "an array"),
        ("map", "a table"),
        ("a boolean", "true or false"),
        ("a string", "text"),
    ]
    .iter()
    .fold(message, |text, (from, to)| {
        text.replace(&format!("expected {from}"), &format!("expected {to}"))
            .replace(&format!("type: {from}"), &format!("type: {to}"))
    })
}

fn did_you_mean(unknown: &str, known: &[&str], list: &str) -> String {
    let all = format!("{list}: {}", known.join(", "));
    match suggest::nearest(unknown, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`? {all}"),
        None => all,
    }
}
