//! `strandsnap scene keys`.

use super::say::say;
use crate::base::error::{Error, Result};
use crate::scene::keys::{Key, Kind, is_meant, keys};
use crate::scene::suggest::nearest;

/// Columns that meanings are wrapped to.
const WIDTH: usize = 110;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Only keys whose path has this in it, such as "contact" or "layer.pitch", in any case [default: all]; `layer[]` is
    /// `layer.0`, `layer.1` and so on in --set
    pattern: Option<String>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

pub fn print(args: &Args) -> Result<()> {
    let all = keys();
    let wanted = args.pattern.as_deref().unwrap_or_default();
    let chosen: Vec<&Key> = all.iter().filter(|key| is_meant(&key.key, wanted)).collect();
    if chosen.is_empty() {
        return Err(unknown(&all, wanted));
    }
    if args.json {
        say!("{}", serde_json::to_string_pretty(&chosen).expect("keys hold nothing that JSON lacks"));
        return Ok(());
    }
    for key in &chosen {
        let parts = [
            Some(of(&key.kind)),
            key.unit
                .as_deref()
                .map(|unit| if unit == "-" { "no unit, or %".into() } else { format!("such as {unit}") }),
            key.required.then(|| "required".to_owned()),
            key.required_when.as_ref().map(|when| format!("required when {when}")),
            key.default.as_ref().or(key.otherwise.as_ref()).map(|default| format!("default {default}")),
        ];
        say!("{}: {}", key.key, parts.into_iter().flatten().collect::<Vec<_>>().join("; "));
        let paragraph = |text: &str| {
            let indented = textwrap::Options::new(WIDTH).initial_indent("    ").subsequent_indent("    ");
            say!("{}", textwrap::fill(text, indented));
        };
        paragraph(&key.meaning);
        words(&key.kind).iter().for_each(|[word, meaning]| paragraph(&format!("{word}: {meaning}")));
    }
    if let Some(key) = chosen.iter().find(|key| key.key.contains("[]")) {
        say!("\n[] stands for the number of the element, from 0: --set {}=…", key.key.replace("[]", ".0"));
    }
    Ok(())
}

fn unknown(all: &[Key], wanted: &str) -> Error {
    let last = |key: &str| key.rsplit('.').next().unwrap_or_default().to_owned();
    let names: Vec<String> = all.iter().flat_map(|key| [key.key.clone(), last(&key.key)]).collect();
    let help = match nearest(wanted, names.iter().map(String::as_str)) {
        Some(near) => format!("did you mean `{near}`? `strandsnap scene keys` lists all"),
        None => "`strandsnap scene keys` lists all".to_owned(),
    };
    Error::input(format!("no key of a scene has `{wanted}` in its path"), help)
}

/// The words that have a meaning of their own to tell.
fn words(kind: &Kind) -> &[[String; 2]] {
    match kind {
        Kind::Words(words) if words.iter().all(|[_, meaning]| !meaning.is_empty()) => words,
        Kind::Array(inner) => words(inner),
        _ => &[],
    }
}

/// What may be written, in a few words.
fn of(kind: &Kind) -> String {
    match kind {
        Kind::Quantity => "number or text with a unit".into(),
        Kind::Integer => "whole number".into(),
        Kind::Boolean => "true or false".into(),
        Kind::Text => "text".into(),
        Kind::Words(words) => words.iter().map(|[word, _]| word.as_str()).collect::<Vec<_>>().join(" | "),
        Kind::Array(inner) if **inner == Kind::Table => "tables".into(),
        Kind::Array(inner) => format!("array of ({})", of(inner)),
        Kind::Either(both) => format!("{}, or {}", of(&both[0]), of(&both[1])),
        Kind::Table => "table".into(),
    }
}
