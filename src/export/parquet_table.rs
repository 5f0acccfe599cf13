//! A table as Apache Parquet. Each column carries its unit and meaning (keys `unit` and `about` of the field's metadata).

use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::observe::column::{Column, Kind, Value};
use crate::observe::partial;
use arrow_array::{ArrayRef, BooleanArray, Float32Array, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A Parquet file that grows by batches of rows.
pub struct ParquetTable {
    path: PathBuf,
    schema: SchemaRef,
    writer: ArrowWriter<BufWriter<File>>,
}

impl ParquetTable {
    /// Creates it with what the file says `about` itself, under `strandsnap.KEY`, besides version and units.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn create<R>(path: &Path, about: &[(&str, String)], columns: &[Column<R>]) -> Result<Self> {
        let file = File::create(path).map_err(|e| Error::io("cannot write", path, e))?;
        let units: BTreeMap<&str, &str> =
            columns.iter().filter(|c| !c.unit.is_empty()).map(|c| (&*c.name, &*c.unit)).collect();
        let units = serde_json::to_string(&units).expect("text is JSON");
        let always = [("version", env!("CARGO_PKG_VERSION").to_owned()), ("units", units)];
        let about: BTreeMap<String, String> =
            about.iter().chain(&always).map(|(key, value)| (format!("strandsnap.{key}"), value.clone())).collect();
        // Arrow's readers see what the schema carries, all others what the file does.
        let pairs = about.iter().map(|(key, value)| KeyValue::new(key.clone(), value.clone())).collect();
        let fields: Vec<Field> = columns.iter().map(field).collect();
        let schema = Arc::new(Schema::new(fields).with_metadata(about.into_iter().collect()));
        let properties = WriterProperties::builder()
            .set_compression(Compression::LZ4_RAW)
            .set_key_value_metadata(Some(pairs))
            .build();
        let writer = ArrowWriter::try_new(BufWriter::new(file), schema.clone(), Some(properties));
        let writer = writer.map_err(|e| refused(path, e))?;
        Ok(Self { path: path.to_owned(), schema, writer })
    }

    /// Appends rows.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn write<R>(&mut self, columns: &[Column<R>], rows: &[R]) -> Result<()> {
        let arrays = columns.iter().map(|column| array(column, rows)).collect();
        let batch = RecordBatch::try_new(self.schema.clone(), arrays).expect("arrays are made by the schema's columns");
        self.writer.write(&batch).map_err(|e| refused(&self.path, e))
    }

    /// Appends rows, and closes the file.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn filled<R>(mut self, columns: &[Column<R>], rows: &[R]) -> Result<()> {
        self.write(columns, rows)?;
        self.finish()
    }

    /// Closes the file.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn finish(self) -> Result<()> {
        self.writer.close().map(|_| ()).map_err(|e| refused(&self.path, e))
    }
}

/// Writes a whole table, which has its name only then.
///
/// # Errors
/// [`Error::Input`] where a device, a pipe, a link or a folder has that name; [`Error::Io`].
pub fn write_whole<R>(path: &Path, about: &[(&str, String)], columns: &[Column<R>], rows: &[R]) -> Result<()> {
    regular::replaceable(path)?;
    ParquetTable::create(&partial::name(path), about, columns)?.filled(columns, rows)?;
    partial::complete(path)
}

fn refused(path: &Path, error: ParquetError) -> Error {
    let cause = match error {
        // What the system answered is wrapped twice.
        ParquetError::External(cause) => {
            cause.downcast::<std::io::Error>().map_or_else(std::io::Error::other, |cause| *cause)
        }
        other => std::io::Error::other(other),
    };
    Error::io("cannot write", path, cause)
}

/// The kind of a column that is written; text where only its values tell.
fn kind<R>(column: &Column<R>) -> Kind {
    column.kind.unwrap_or(Kind::Text)
}

fn field<R>(column: &Column<R>) -> Field {
    let data = match kind(column) {
        Kind::Number => DataType::Float64,
        Kind::Single => DataType::Float32,
        Kind::Count => DataType::Int64,
        Kind::Text => DataType::Utf8,
        Kind::Flag => DataType::Boolean,
    };
    let about = [("unit", &column.unit), ("about", &column.about)].into_iter().filter(|(_, text)| !text.is_empty());
    let about: HashMap<String, String> = about.map(|(key, text)| (key.into(), text.to_string())).collect();
    Field::new(&*column.name, data, true).with_metadata(about)
}

fn array<R>(column: &Column<R>, rows: &[R]) -> ArrayRef {
    let values = rows.iter().map(|row| column.value(row));
    let number = |value| if let Value::Number(value) = value { Some(value) } else { None };
    match kind(column) {
        Kind::Number => Arc::new(values.map(number).collect::<Float64Array>()),
        Kind::Single => Arc::new(values.map(|value| number(value).map(|value| value as f32)).collect::<Float32Array>()),
        Kind::Count => Arc::new(
            values.map(|v| if let Value::Count(n) = v { Some(n as i64) } else { None }).collect::<Int64Array>(),
        ),
        Kind::Flag => Arc::new(
            values.map(|v| if let Value::Flag(holds) = v { Some(holds) } else { None }).collect::<BooleanArray>(),
        ),
        Kind::Text => {
            let text = |value: Value| (value != Value::Missing).then(|| value.in_csv());
            Arc::new(values.map(text).collect::<StringArray>())
        }
    }
}
