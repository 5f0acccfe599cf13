//! A thin layer over Rerun's stream: everything goes out as columns, so that a run always gives the same chunks. Whatever
//! sends gives [`Error::Io`] when Rerun refuses the data.

use crate::base::error::{Error, Result};
use crate::base::units::{mm, mpa};
use crate::engine::view::Rupture;
use rerun::components::ClassId;
use rerun::external::arrow::array::{
    Array, ArrayRef, ArrowPrimitiveType, FixedSizeListArray, Float16Array, Float32Array, ListArray, StringArray,
    UInt16Array, UInt32Array,
};
use rerun::external::arrow::buffer::{NullBuffer, OffsetBuffer};
use rerun::external::arrow::datatypes::{DataType, Field, Float16Type};
use rerun::external::arrow::error::ArrowError;
use rerun::{
    AsComponents, ComponentDescriptor, EntityPath, Loggable, RecordingStream, SerializationResult,
    SerializedComponentBatch, SerializedComponentColumn, TimeColumn,
};
use std::sync::Arc;

/// Timeline of steps.
pub const STEP: &str = "step";
/// Timeline of simulated time.
pub const TIME: &str = "sim_time";
/// Timeline of strain, in whole µm/m, because Rerun has no timelines of real numbers: 234,000 is 23.4 %.
pub const STRAIN: &str = "microstrain";

/// Where on the timelines something is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Instant {
    /// Step.
    pub step: u64,
    /// Simulated time (s).
    pub time: f64,
    /// Strain (-).
    pub strain: f64,
}

impl Instant {
    /// Strain in whole millionths.
    pub fn microstrain(&self) -> i64 {
        (self.strain * 1e6).round() as i64
    }
}

impl From<&Rupture> for Instant {
    fn from(rupture: &Rupture) -> Self {
        Self { step: rupture.step, time: rupture.time, strain: rupture.strain }
    }
}

/// The stream that the recording is sent through.
pub(super) struct Stream {
    pub rerun: RecordingStream,
    file: std::path::PathBuf,
}

impl Stream {
    /// Wraps a stream whose errors concern `file`.
    pub fn new(rerun: RecordingStream, file: &std::path::Path) -> Self {
        Self { rerun, file: file.to_owned() }
    }

    /// Logs what holds at all times.
    ///
    /// # Errors
    /// [`Error::Io`] when Rerun refuses the data.
    pub fn fixed(&self, path: impl Into<EntityPath>, what: &dyn AsComponents) -> Result<()> {
        self.send(path.into(), Vec::new(), self.columns(what)?)
    }

    /// Logs one row.
    ///
    /// # Errors
    /// [`Error::Io`] when Rerun refuses the data.
    pub fn row(&self, path: impl Into<EntityPath>, instant: Instant, what: &dyn AsComponents) -> Result<()> {
        self.send(path.into(), time_columns(&[instant]), self.columns(what)?)
    }

    /// One row of everything in `what`.
    fn columns(&self, what: &dyn AsComponents) -> Result<Vec<SerializedComponentColumn>> {
        let whole = |batch: SerializedComponentBatch| {
            let len = batch.array.len();
            batch.partitioned([len])
        };
        let columns: SerializationResult<Vec<_>> = what.as_serialized_batches().into_iter().map(whole).collect();
        self.checked(columns)
    }

    /// Logs one row per instant.
    ///
    /// # Errors
    /// [`Error::Io`] when Rerun refuses the data.
    pub fn rows(
        &self,
        path: impl Into<EntityPath>,
        instants: &[Instant],
        columns: impl IntoIterator<Item = impl Into<Column>>,
    ) -> Result<()> {
        let columns: std::result::Result<Vec<_>, _> = columns.into_iter().map(|column| column.into().cut()).collect();
        self.send(path.into(), time_columns(instants), self.checked(columns)?)
    }

    fn send(&self, path: EntityPath, times: Vec<TimeColumn>, columns: Vec<SerializedComponentColumn>) -> Result<()> {
        self.checked(self.rerun.send_columns(path, times, columns))
    }

    /// Gives an error of Rerun the shape of this crate's.
    pub fn checked<T>(&self, result: Result<T, impl std::fmt::Display>) -> Result<T> {
        result.map_err(|e| Error::io("cannot record to", &self.file, std::io::Error::other(e.to_string())))
    }
}

/// Values of a component, and how many of them each row has.
pub(super) struct Column {
    batch: SerializedComponentBatch,
    /// `None` for a row that says nothing: what an earlier row said still holds.
    lengths: Vec<Option<usize>>,
}

impl Column {
    /// A column that says something in those rows alone that have a length.
    pub fn sparse(batch: SerializedComponentBatch, lengths: Vec<Option<usize>>) -> Self {
        Self { batch, lengths }
    }

    fn cut(self) -> std::result::Result<SerializedComponentColumn, ArrowError> {
        let Self { batch: SerializedComponentBatch { array, descriptor }, lengths } = self;
        let field = Arc::new(Field::new_list_field(array.data_type().clone(), true));
        let offsets = OffsetBuffer::from_lengths(lengths.iter().map(|length| length.unwrap_or(0)));
        let nulls = Some(NullBuffer::from_iter(lengths.iter().map(Option::is_some))).filter(|n| n.null_count() > 0);
        let list = ListArray::try_new(field, offsets, array, nulls)?;
        Ok(SerializedComponentColumn::new(list, descriptor))
    }
}

impl From<(SerializedComponentBatch, Vec<usize>)> for Column {
    fn from((batch, lengths): (SerializedComponentBatch, Vec<usize>)) -> Self {
        Self::sparse(batch, lengths.into_iter().map(Some).collect())
    }
}

fn time_columns(instants: &[Instant]) -> Vec<TimeColumn> {
    vec![
        TimeColumn::new_sequence(STEP, instants.iter().map(|i| i.step as i64)),
        TimeColumn::new_duration_secs(TIME, instants.iter().map(|i| i.time)),
        TimeColumn::new_sequence(STRAIN, instants.iter().map(Instant::microstrain)),
    ]
}

/// Vectors as Rerun stores them, built in one go: this is most of the recording.
pub(super) fn vectors<const N: usize>(
    descriptor: ComponentDescriptor,
    values: impl Iterator<Item = [f32; N]>,
) -> SerializedComponentBatch {
    SerializedComponentBatch::new(lists::<N>(Arc::new(flat(values))), descriptor)
}

/// Vectors in half precision (eleven digits of two): a layout may have the viewer widen them.
pub(super) fn half_vectors<const N: usize>(
    descriptor: ComponentDescriptor,
    values: impl Iterator<Item = [f32; N]>,
) -> SerializedComponentBatch {
    let halves: Float16Array = flat(values).unary(<Float16Type as ArrowPrimitiveType>::Native::from_f32);
    SerializedComponentBatch::new(lists::<N>(Arc::new(halves)), descriptor)
}

fn flat<const N: usize>(values: impl Iterator<Item = [f32; N]>) -> Float32Array {
    Float32Array::from(values.flatten().collect::<Vec<f32>>())
}

/// Lists of `N` numbers each.
fn lists<const N: usize>(numbers: ArrayRef) -> ArrayRef {
    let field = Arc::new(Field::new("item", numbers.data_type().clone(), false));
    Arc::new(FixedSizeListArray::new(field, N as i32, numbers, None))
}

/// A place (m) in the unit of recordings (mm).
pub(super) fn in_mm<const N: usize>(place: [f32; N]) -> [f32; N] {
    place.map(|x| mm(x.into()) as f32)
}

/// A stress (Pa) in the unit of recordings (MPa).
pub(super) fn in_mpa(stress: f32) -> f32 {
    mpa(stress.into()) as f32
}

/// Lines of `corners` points each as Rerun stores them.
pub(super) fn strips<const N: usize>(
    descriptor: ComponentDescriptor,
    points: impl Iterator<Item = [f32; N]>,
    corners: usize,
) -> SerializedComponentBatch {
    let points = vectors(descriptor.clone(), points).array;
    let field = Arc::new(Field::new("item", points.data_type().clone(), false));
    let offsets = OffsetBuffer::from_repeated_length(corners, points.len() / corners);
    SerializedComponentBatch::new(Arc::new(ListArray::new(field, offsets, points, None)), descriptor)
}

/// Texts as Rerun stores them.
pub(super) fn texts(descriptor: ComponentDescriptor, values: impl Iterator<Item = String>) -> SerializedComponentBatch {
    let all: Vec<String> = values.collect();
    SerializedComponentBatch::new(Arc::new(StringArray::from(all)), descriptor)
}

/// Numbers as Rerun stores them.
pub(super) fn numbers(descriptor: ComponentDescriptor, values: impl Iterator<Item = f32>) -> SerializedComponentBatch {
    SerializedComponentBatch::new(Arc::new(Float32Array::from_iter_values(values)), descriptor)
}

/// Colours (0xRRGGBBAA) as Rerun stores them.
pub(super) fn colours(descriptor: ComponentDescriptor, values: impl Iterator<Item = u32>) -> SerializedComponentBatch {
    SerializedComponentBatch::new(Arc::new(UInt32Array::from_iter_values(values)), descriptor)
}

/// Class numbers as Rerun stores them; the viewer shows the names that the annotation context gives them.
pub(super) fn classes(descriptor: ComponentDescriptor, values: impl Iterator<Item = u16>) -> SerializedComponentBatch {
    debug_assert_eq!(ClassId::arrow_datatype(), DataType::UInt16);
    let array: ArrayRef = Arc::new(UInt16Array::from_iter_values(values));
    SerializedComponentBatch::new(array, descriptor)
}
