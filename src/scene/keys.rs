//! The keys of a scene, read from the types that parse it ([`super::raw`]): one source for `strandsnap scene keys` and for
//! everybody who wants to know what can be written.

use super::raw::RawScene;
use schemars::generate::SchemaSettings;
use serde::Serialize;
use serde_json::Value;

/// A key of a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Key {
    /// Its path, such as `strand.layer[].pitch`; `[]` stands after a table that may be repeated.
    pub key: String,
    /// What is written there.
    pub kind: Kind,
    /// A unit that will do, any other of the same kind too; `-` for plain numbers and ratios.
    pub unit: Option<String>,
    /// The value that holds when it is left out.
    pub default: Option<String>,
    /// What holds when it is left out, where that is no single value.
    pub otherwise: Option<String>,
    /// Whether its table needs it always.
    pub required: bool,
    /// What it means.
    pub meaning: String,
}

/// What a value of a scene is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// A number, or text with a unit.
    Quantity,
    /// A whole number.
    Integer,
    /// True or false.
    Boolean,
    /// Text.
    Text,
    /// One of these words, each with its meaning.
    Words(Vec<[String; 2]>),
    /// An array of values.
    Array(Box<Kind>),
    /// One or the other.
    Either(Box<[Kind; 2]>),
    /// A table whose keys follow.
    Table,
}

/// Every key, tables before what is in them.
pub fn keys() -> Vec<Key> {
    let settings = SchemaSettings::default().with(|settings| settings.inline_subschemas = true);
    let schema = settings.into_generator().into_root_schema_for::<RawScene>();
    let mut found = Vec::new();
    walk(schema.as_value(), "", &mut found);
    found
}

/// Adds the keys of a table.
fn walk(table: &Value, path: &str, found: &mut Vec<Key>) {
    let properties = table["properties"].as_object().into_iter().flatten();
    for (name, value) in properties {
        let key = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        let choices = choices(value);
        let tables: Vec<(&Value, bool)> = choices.iter().filter_map(|choice| table_of(choice)).collect();
        let repeated = tables.iter().any(|(_, repeated)| *repeated);
        let key = if repeated { format!("{key}[]") } else { key };
        let extra = |name: &str| value[name].as_str().map(str::to_owned);
        found.push(Key {
            key: key.clone(),
            kind: kind(&choices),
            unit: extra("x-unit"),
            default: extra("x-default"),
            otherwise: extra("x-otherwise"),
            required: value["x-required"] == true,
            meaning: meaning(value),
        });
        tables.into_iter().for_each(|(table, _)| walk(table, &key, found));
    }
}

/// The alternatives of a value; that it may be left out is none.
fn choices(value: &Value) -> Vec<&Value> {
    match value["anyOf"].as_array() {
        Some(all) => all.iter().filter(|choice| choice["type"] != "null").flat_map(choices).collect(),
        None => vec![value],
    }
}

/// The table that a value is, and whether it is an array of them.
fn table_of(value: &Value) -> Option<(&Value, bool)> {
    if value["properties"].is_object() {
        Some((value, false))
    } else {
        value["items"]["properties"].is_object().then(|| (&value["items"], true))
    }
}

fn kind(choices: &[&Value]) -> Kind {
    match choices {
        [one] => kind_of(one),
        [one, other, ..] => Kind::Either(Box::new([kind_of(one), kind_of(other)])),
        [] => Kind::Text,
    }
}

fn kind_of(value: &Value) -> Kind {
    let is = |name: &str| match &value["type"] {
        Value::String(one) => one == name,
        Value::Array(some) => some.iter().any(|one| one == name),
        _ => false,
    };
    if let Some((_, repeated)) = table_of(value) {
        if repeated { Kind::Array(Box::new(Kind::Table)) } else { Kind::Table }
    } else if let Some(words) = words(value) {
        Kind::Words(words)
    } else if value["title"] == "quantity" || is("number") {
        Kind::Quantity
    } else if is("array") {
        Kind::Array(Box::new(kind(&choices(&value["items"]))))
    } else if is("integer") {
        Kind::Integer
    } else if is("boolean") {
        Kind::Boolean
    } else {
        Kind::Text
    }
}

/// The words that a value may be.
fn words(value: &Value) -> Option<Vec<[String; 2]>> {
    if let Some(all) = value["enum"].as_array() {
        return Some(all.iter().filter_map(Value::as_str).map(|word| [word.to_owned(), String::new()]).collect());
    }
    let all = value["oneOf"].as_array()?;
    let word = |one: &Value| Some([one["const"].as_str()?.to_owned(), meaning(one)]);
    all.iter().filter(|one| one["type"] != "null").map(word).collect()
}

/// A description on one line.
fn meaning(value: &Value) -> String {
    value["description"].as_str().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    #[test]
    fn every_key_says_what_it_means_and_every_quantity_has_a_unit() {
        let all = keys();
        assert!(all.len() > 100, "{}", all.len());
        for key in &all {
            assert!(!key.meaning.is_empty(), "{}", key.key);
            assert!(!key.meaning.contains("[`"), "links are for rustdoc: {}: {}", key.key, key.meaning);
            let quantity = match &key.kind {
                Kind::Array(inner) => **inner == Kind::Quantity,
                Kind::Either(both) => both[0] == Kind::Quantity,
                kind => *kind == Kind::Quantity,
            };
            assert_eq!(quantity, key.unit.is_some(), "{}: {:?}", key.key, key.kind);
        }
        let of = |name: &str| all.iter().find(|key| key.key == name).unwrap_or_else(|| panic!("{name}"));
        assert_eq!(of("strand.layer[].pitch").unit.as_deref(), Some("mm"));
        assert!(of("grip.length").required && of("strand.layer[]").kind == Kind::Array(Box::new(Kind::Table)));
        let Kind::Either(damping) = &of("bond.damping").kind else { panic!("{:?}", of("bond.damping")) };
        assert_eq!(**damping, [Kind::Quantity, Kind::Table]);
    }

    /// Scenes with a default left out and written out are the same scene, for every default that can be written.
    #[test]
    fn the_defaults_that_are_named_are_those_that_hold() {
        let bases = ["ka4", "jaw-grip", "strand-1x7", "single-wire", "cantilever", "two-spheres", "torsion"];
        let mut compared = 0;
        let mut not_compared = Vec::new();
        for key in keys() {
            let Some(default) = &key.default else { continue };
            let path = key.key.replace("[]", ".0");
            let text = |default: &str| match &key.kind {
                Kind::Array(_) if !default.starts_with('[') => {
                    let three = vec![format!("\"{default}\""); 3].join(", ");
                    format!("{path}=[{three}]")
                }
                _ => format!("{path}={default}"),
            };
            let load = |base: &str, options: &[String]| scene::load(base, options).map(|scene| scene.spec);
            let before = compared;
            for base in bases {
                // What a scene does not have cannot be taken away.
                let absent = load(base, &[format!("{path}=")]).or_else(|_| load(base, &[]));
                if let (Ok(absent), Ok(written)) = (absent, load(base, &[text(default)])) {
                    assert_eq!(absent, written, "{base}: {}", text(default));
                    compared += 1;
                }
            }
            if compared == before {
                not_compared.push(key.key);
            }
        }
        println!("{compared} compared; never: {not_compared:?}");
        assert!(compared > 200, "{compared}; never: {not_compared:?}");
    }
}
