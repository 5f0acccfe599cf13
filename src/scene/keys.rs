//! The keys of a scene, read from the types that parse it ([`super::raw`]): one source for `strandsnap scene keys` and for
//! everybody who wants to know what can be written.

use super::raw::RawScene;
use schemars::generate::SchemaSettings;
use serde::Serialize;
use serde_json::Value;

/// A key of a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Key {
    /// Its path, such as `strand.layer[].pitch`; `[]` stands after a table that may be repeated, `NAME` for a name that the
    /// scene gives.
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
    /// When its table needs it, where that is not always or never.
    pub required_when: Option<String>,
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

/// Whether `key` is one of those that somebody means by `wanted`: a part of its path, in any case, in which the number of
/// an element, as in `--set`, or nothing at all may stand for `[]`.
pub fn is_meant(key: &str, wanted: &str) -> bool {
    let plain = |path: &str| {
        let path = path.to_lowercase().replace("[]", "");
        let mut names: Vec<&str> = path.split('.').filter(|part| part.parse::<usize>().is_err()).collect();
        // The name of a material stands for itself.
        if let ["materials", name, ..] = &mut names[..] {
            *name = "name";
        }
        names.join(".")
    };
    let meant = plain(wanted);
    (!meant.is_empty() || wanted.is_empty()) && plain(key).contains(&meant)
}

/// Adds the keys of a table.
fn walk(table: &Value, path: &str, found: &mut Vec<Key>) {
    let properties = table["properties"].as_object().into_iter().flatten();
    for (name, value) in properties {
        let key = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        let choices = choices(value);
        let tables: Vec<(&Value, bool)> = choices.iter().filter_map(|choice| table_of(choice)).collect();
        let repeated = tables.iter().any(|(_, repeated)| *repeated);
        let named = choices.iter().any(|choice| choice["additionalProperties"]["properties"].is_object());
        let key = match (repeated, named) {
            (true, _) => format!("{key}[]"),
            (false, true) => format!("{key}.NAME"),
            (false, false) => key,
        };
        let extra = |name: &str| value[name].as_str().map(str::to_owned);
        found.push(Key {
            key: key.clone(),
            kind: with_word(kind(&choices), value["x-word"].as_str()),
            unit: extra("x-unit"),
            default: extra("x-default"),
            otherwise: extra("x-otherwise"),
            required: value["x-required"] == true,
            required_when: extra("x-required-when"),
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
        let named = &value["additionalProperties"];
        let of_items = || value["items"]["properties"].is_object().then(|| (&value["items"], true));
        if named["properties"].is_object() { Some((named, false)) } else { of_items() }
    }
}

fn kind(choices: &[&Value]) -> Kind {
    match choices {
        [one] => kind_of(one),
        [one, other, ..] => Kind::Either(Box::new([kind_of(one), kind_of(other)])),
        [] => Kind::Text,
    }
}

/// A kind of value beside which a word may stand.
fn with_word(kind: Kind, word: Option<&str>) -> Kind {
    let Some(word) = word else { return kind };
    let word = Kind::Words(vec![[word.to_owned(), String::new()]]);
    Kind::Either(Box::new(match kind {
        // The text is the word.
        Kind::Either(both) if both[0] == Kind::Text => [word, both[1].clone()],
        other => [other, word],
    }))
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

    #[test]
    fn keys_are_found_as_people_write_them() {
        let meant = |wanted: &str| keys().iter().filter(|key| is_meant(&key.key, wanted)).count();
        for wanted in ["strand.layer.0.pitch", "layer.pitch", "Layer[].Pitch", "strand.layer[].pitch"] {
            assert_eq!(meant(wanted), 1, "{wanted}");
        }
        assert_eq!((meant(""), meant("0"), meant("ptich")), (keys().len(), 0, 0));
    }

    /// What a scene is refused for not having is said to be required there.
    #[test]
    fn what_is_required_sometimes_is_said_with_when() {
        let all = keys();
        let of = |name: &str| all.iter().find(|key| key.key == name).unwrap_or_else(|| panic!("{name}"));
        let cases: [(&str, &[&str], &str); 9] = [
            ("single-wire", &["grip.speed="], "grip.speed"),
            ("single-wire", &["grip.speed=", "grip.frequency=1 Hz"], "grip.displacement_amplitude"),
            ("single-wire", &["grip.speed=", "grip.displacement_amplitude=1 mm"], "grip.frequency"),
            ("single-wire", &["grip.kind=jaw"], "grip.clamp_pressure"),
            ("single-wire", &["bond.hardening="], "bond.hardening"),
            ("single-wire", &["bond.hardening={form=\"swift\"}"], "bond.hardening.strength"),
            ("single-wire", &["bond.rupture={criterion=\"beam-stress\"}"], "bond.rupture.tensile"),
            ("two-spheres", &["contact.normal=thornton", "contact.limiting_pressure="], "contact.limiting_pressure"),
            ("ka4", &["strand.layer=", "strand.construction=auto"], "strand.area"),
        ];
        for (scene, options, key) in cases {
            // What is not there needs not be taken away.
            let options: Vec<String> = options.iter().map(|option| option.to_string()).collect();
            let name = format!("`{}`", key.rsplit('.').next().unwrap());
            let error = match scene::load(scene, &options) {
                Err(error) if error.to_string().contains(&name) => error,
                _ => scene::load(scene, &options[..1]).unwrap_err(),
            };
            assert!(error.to_string().contains(&name), "{key}: {error}");
            assert!(of(key).required_when.is_some(), "{key}");
        }
        assert!(all.iter().filter(|key| key.key.starts_with("stop.")).all(|key| key.required_when.is_some()));
        assert!(all.iter().all(|key| !(key.required && key.required_when.is_some())));
    }

    #[test]
    fn words_beside_quantities_are_kinds() {
        let all = keys();
        let kind = |name: &str| all.iter().find(|key| key.key == name).unwrap().kind.clone();
        let word = |word: &str| Kind::Words(vec![[word.to_owned(), String::new()]]);
        for (key, allowed) in [("lay_radius", "auto"), ("pitch", "inf")] {
            let both = Kind::Either(Box::new([Kind::Quantity, word(allowed)]));
            assert_eq!(kind(&format!("strand.layer[].{key}")), both);
        }
        let numbers = Kind::Array(Box::new(Kind::Integer));
        assert_eq!(kind("strand.construction"), Kind::Either(Box::new([word("auto"), numbers])));
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
