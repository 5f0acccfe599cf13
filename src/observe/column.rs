//! Columns of results: one list for each kind of result, from which tables for people, CSV, JSON and Parquet take names,
//! units, digits and values.

use super::files::write_whole;
use crate::base::error::{Error, Result};
use serde::ser::{Serialize, SerializeMap, Serializer};
use std::borrow::Cow;
use std::path::Path;

/// One column of a table of results `R`.
pub struct Column<'a, R: ?Sized> {
    /// Name in CSV and JSON.
    pub name: Cow<'a, str>,
    /// Heading for people, without the unit; empty for what only stands in files.
    pub heading: Cow<'a, str>,
    /// Unit of the numbers, "-" for plain ones; empty for text and counts.
    pub unit: Cow<'a, str>,
    /// What it is, for files that carry such words beside their columns; empty where the heading says it.
    pub about: Cow<'a, str>,
    /// Decimals for people.
    pub decimals: usize,
    /// What its values are; `None` where that changes from result to result.
    pub kind: Option<Kind>,
    /// The value of a result.
    of: Box<dyn Fn(&R) -> Value + Send + Sync + 'a>,
    /// How people read it where that is not the value with its decimals.
    text: Option<fn(&R) -> String>,
}

/// A value of a result.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// There is none.
    Missing,
    /// A number; null in JSON and empty in CSV when it is not finite.
    Number(f64),
    /// A count.
    Count(u64),
    /// Text.
    Text(String),
    /// Whether something is so: yes or no in CSV.
    Flag(bool),
    /// What only JSON holds.
    Json(serde_json::Value),
}

/// What all values of a column are, where one is not missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// [`Value::Number`].
    Number,
    /// [`Value::Number`] that single precision holds.
    Single,
    /// [`Value::Count`].
    Count,
    /// [`Value::Text`].
    Text,
    /// [`Value::Flag`].
    Flag,
}

/// What a column is made from.
pub trait Cell: Into<Value> {
    /// What it is; `None` where only the value itself tells.
    const KIND: Option<Kind>;
}

macro_rules! cells {
    ($($from:ty: $kind:expr => $value:expr),* $(,)?) => {
        $(impl From<$from> for Value {
            fn from(value: $from) -> Self {
                let make: fn($from) -> Value = $value;
                make(value)
            }
        }

        impl Cell for $from {
            const KIND: Option<Kind> = $kind;
        })*
    };
}

cells! {
    f64: Some(Kind::Number) => Value::Number,
    f32: Some(Kind::Single) => |number| Value::Number(f64::from(number)),
    u64: Some(Kind::Count) => Value::Count,
    usize: Some(Kind::Count) => |count| Value::Count(count as u64),
    &str: Some(Kind::Text) => |text| Value::Text(text.into()),
    String: Some(Kind::Text) => Value::Text,
    bool: Some(Kind::Flag) => Value::Flag,
    serde_json::Value: None => Value::Json,
}

impl Cell for Value {
    const KIND: Option<Kind> = None;
}

impl<T: Into<Value>> From<Option<T>> for Value {
    fn from(value: Option<T>) -> Self {
        value.map_or(Value::Missing, Into::into)
    }
}

impl<T: Cell> Cell for Option<T> {
    const KIND: Option<Kind> = T::KIND;
}

impl Value {
    /// As CSV holds it.
    pub fn in_csv(self) -> String {
        match self {
            Self::Number(value) if value.is_finite() => value.to_string(),
            Self::Missing | Self::Number(_) => String::new(),
            Self::Count(count) => count.to_string(),
            Self::Text(text) => text,
            Self::Flag(holds) => if holds { "yes" } else { "no" }.into(),
            Self::Json(value) => value.to_string(),
        }
    }
}

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Value::Missing => serializer.serialize_none(),
            Value::Number(value) => serializer.serialize_f64(*value),
            Value::Count(value) => serializer.serialize_u64(*value),
            Value::Text(value) => serializer.serialize_str(value),
            Value::Flag(value) => serializer.serialize_bool(*value),
            Value::Json(value) => value.serialize(serializer),
        }
    }
}

impl<'a, R: ?Sized> Column<'a, R> {
    /// A column for files and people, whose numbers have `unit` and show `decimals`.
    pub fn new<V: Cell>(
        name: impl Into<Cow<'a, str>>,
        heading: impl Into<Cow<'a, str>>,
        unit: impl Into<Cow<'a, str>>,
        decimals: usize,
        of: impl Fn(&R) -> V + Send + Sync + 'a,
    ) -> Self {
        let of = Box::new(move |result: &R| of(result).into());
        let (name, heading, unit, about) = (name.into(), heading.into(), unit.into(), "".into());
        Self { name, heading, unit, about, decimals, kind: V::KIND, of, text: None }
    }

    /// A column for files alone.
    pub fn in_files<V: Cell>(name: impl Into<Cow<'a, str>>, of: impl Fn(&R) -> V + Send + Sync + 'a) -> Self {
        Self::new(name, "", "", 0, of)
    }

    /// A column for files that say what it is and what unit its numbers have.
    pub fn described<V: Cell>(
        name: impl Into<Cow<'a, str>>,
        unit: impl Into<Cow<'a, str>>,
        about: impl Into<Cow<'a, str>>,
        of: impl Fn(&R) -> V + Send + Sync + 'a,
    ) -> Self {
        Self { unit: unit.into(), about: about.into(), ..Self::in_files(name, of) }
    }

    /// The same, shown to people as `text` says.
    pub fn shown_as(self, text: fn(&R) -> String) -> Self {
        Self { text: Some(text), ..self }
    }

    /// The same, whose values are of a kind that the type of its cells does not tell.
    pub fn of_kind(self, kind: Option<Kind>) -> Self {
        Self { kind, ..self }
    }

    /// The value of a result.
    pub fn value(&self, result: &R) -> Value {
        (self.of)(result)
    }

    /// Its value as a number.
    pub fn number(&self, result: &R) -> Option<f64> {
        match self.value(result) {
            Value::Number(value) => Some(value),
            Value::Count(count) => Some(count as f64),
            Value::Missing | Value::Text(_) | Value::Flag(_) | Value::Json(_) => None,
        }
    }

    /// Heading with the unit, for the head of a table and the axis of a plot.
    pub fn label(&self) -> String {
        if self.unit.is_empty() { self.heading.to_string() } else { format!("{} [{}]", self.heading, self.unit) }
    }

    /// The value as people read it; empty where there is none.
    pub fn cell(&self, result: &R) -> String {
        if let Some(text) = self.text {
            return text(result);
        }
        match self.value(result) {
            Value::Number(value) => format!("{value:.*}", self.decimals),
            other => other.in_csv(),
        }
    }
}

/// Takes tables, whatever their rows are: writes them, or turns them into what another program reads.
pub trait TableSink {
    /// Takes the table `name`.
    ///
    /// # Errors
    /// When it cannot be written.
    fn take<R>(&mut self, name: &str, columns: &[Column<R>], results: &[R]) -> Result<()>;
}

/// Writes all columns as CSV; cells of what is not known are empty.
///
/// # Errors
/// When the file cannot be written.
pub fn write_csv<R>(columns: &[Column<R>], results: &[R], path: &Path) -> Result<()> {
    let refuse = |e: csv::Error| Error::io("cannot write", path, std::io::Error::other(e));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns.iter().map(|column| column.name.as_bytes())).map_err(refuse)?;
    for result in results {
        writer.write_record(columns.iter().map(|column| column.value(result).in_csv())).map_err(refuse)?;
    }
    let bytes = writer.into_inner().map_err(|e| Error::io("cannot write", path, e.into_error()))?;
    write_whole(path, &bytes)
}

/// All columns as a JSON list, one object per result.
pub fn json<R>(columns: &[Column<R>], results: &[R]) -> String {
    let objects: Vec<Object<R>> = results.iter().map(|result| Object { columns, result }).collect();
    serde_json::to_string_pretty(&objects).expect("columns hold nothing that JSON lacks") + "\n"
}

/// A result as a JSON object, columns in their order.
struct Object<'a, R> {
    columns: &'a [Column<'a, R>],
    result: &'a R,
}

impl<R> Serialize for Object<'_, R> {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.columns.len()))?;
        self.columns.iter().try_for_each(|column| map.serialize_entry(&*column.name, &column.value(self.result)))?;
        map.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_list_gives_csv_and_json() {
        let columns = [
            Column::new("who", "name", "", 0, |r: &(&str, f64)| r.0),
            Column::new("force_n", "force", "N", 1, |r: &(&str, f64)| r.1),
            Column::in_files("known", |r: &(&str, f64)| r.1.is_finite().then_some(1usize)),
        ];
        let results = [("a", 1.25), ("b", f64::NAN)];
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        write_csv(&columns, &results, &path).unwrap();
        assert_eq!(std::fs::read_to_string(path).unwrap(), "who,force_n,known\na,1.25,1\nb,,\n");
        let list: serde_json::Value = serde_json::from_str(&json(&columns, &results)).unwrap();
        assert_eq!(
            list,
            serde_json::json!([
                { "who": "a", "force_n": 1.25, "known": 1 },
                { "who": "b", "force_n": null, "known": null },
            ])
        );
    }
}
