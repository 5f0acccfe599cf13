//! Columns of results: one list for each kind of result, from which tables for people, CSV and JSON take names, units,
//! digits and values.

use crate::base::error::{Error, Result};
use crate::observe::files::write_whole;
use crate::study::table::Table;
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
    /// Decimals for people.
    pub decimals: usize,
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
    /// What only JSON holds.
    Json(serde_json::Value),
}

macro_rules! value_from {
    ($($from:ty => $value:expr),* $(,)?) => {
        $(impl From<$from> for Value {
            fn from(value: $from) -> Self {
                let make: fn($from) -> Value = $value;
                make(value)
            }
        })*
    };
}

value_from! {
    f64 => Value::Number,
    u64 => Value::Count,
    usize => |count| Value::Count(count as u64),
    &str => |text| Value::Text(text.into()),
    String => Value::Text,
    serde_json::Value => Value::Json,
}

impl<T: Into<Value>> From<Option<T>> for Value {
    fn from(value: Option<T>) -> Self {
        value.map_or(Value::Missing, Into::into)
    }
}

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Value::Missing => serializer.serialize_none(),
            Value::Number(value) => serializer.serialize_f64(*value),
            Value::Count(value) => serializer.serialize_u64(*value),
            Value::Text(value) => serializer.serialize_str(value),
            Value::Json(value) => value.serialize(serializer),
        }
    }
}

impl<'a, R: ?Sized> Column<'a, R> {
    /// A column for files and people, whose numbers have `unit` and show `decimals`.
    pub fn new<V: Into<Value>>(
        name: impl Into<Cow<'a, str>>,
        heading: impl Into<Cow<'a, str>>,
        unit: impl Into<Cow<'a, str>>,
        decimals: usize,
        of: impl Fn(&R) -> V + Send + Sync + 'a,
    ) -> Self {
        let of = Box::new(move |result: &R| of(result).into());
        Self { name: name.into(), heading: heading.into(), unit: unit.into(), decimals, of, text: None }
    }

    /// A column for files alone.
    pub fn in_files<V: Into<Value>>(name: impl Into<Cow<'a, str>>, of: impl Fn(&R) -> V + Send + Sync + 'a) -> Self {
        Self::new(name, "", "", 0, of)
    }

    /// The same, shown to people as `text` says.
    pub fn shown_as(self, text: fn(&R) -> String) -> Self {
        Self { text: Some(text), ..self }
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
            Value::Missing | Value::Text(_) | Value::Json(_) => None,
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
            other => in_file(other),
        }
    }
}

/// The value as CSV holds it.
fn in_file(value: Value) -> String {
    match value {
        Value::Number(value) if value.is_finite() => value.to_string(),
        Value::Missing | Value::Number(_) => String::new(),
        Value::Count(count) => count.to_string(),
        Value::Text(text) => text,
        Value::Json(value) => value.to_string(),
    }
}

/// A table for people of the columns that have a heading; the first `left` of them hold text.
pub fn table<R>(title: String, columns: &[Column<R>], results: &[R], left: usize) -> Table {
    let shown = || columns.iter().filter(|column| !column.heading.is_empty());
    Table {
        title,
        heads: shown().map(Column::label).collect(),
        rows: results.iter().map(|result| shown().map(|column| column.cell(result)).collect()).collect(),
        default: None,
        left,
    }
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
        writer.write_record(columns.iter().map(|column| in_file(column.value(result)))).map_err(refuse)?;
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
    fn one_list_gives_table_csv_and_json() {
        let columns = [
            Column::new("who", "name", "", 0, |r: &(&str, f64)| r.0),
            Column::new("force_n", "force", "N", 1, |r: &(&str, f64)| r.1),
            Column::in_files("known", |r: &(&str, f64)| r.1.is_finite().then_some(1usize)),
        ];
        let results = [("a", 1.25), ("b", f64::NAN)];
        let table = table("Forces".into(), &columns, &results, 1);
        assert_eq!(
            (table.heads, table.rows[0].clone()),
            (vec!["name".into(), "force [N]".into()], vec!["a".into(), "1.2".into()])
        );
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
