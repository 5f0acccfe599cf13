//! Columns and arrays for numpy, which takes over the memory without copying it.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use strandsnap::base::error::Result;
use strandsnap::observe::column::{Column, Kind, TableSink, Value};

/// Numbers in memory.
pub enum Numbers {
    /// float64.
    Double(Vec<f64>),
    /// float32.
    Single(Vec<f32>),
    /// int64.
    Count(Vec<i64>),
    /// uint8.
    Byte(Vec<u8>),
    /// bool.
    Flag(Vec<bool>),
}

impl Numbers {
    /// Address, and the type as numpy's array interface names it.
    fn interface(&mut self) -> (usize, String) {
        let order = if cfg!(target_endian = "little") { '<' } else { '>' };
        match self {
            Self::Double(values) => (values.as_mut_ptr() as usize, format!("{order}f8")),
            Self::Single(values) => (values.as_mut_ptr() as usize, format!("{order}f4")),
            Self::Count(values) => (values.as_mut_ptr() as usize, format!("{order}i8")),
            Self::Byte(values) => (values.as_mut_ptr() as usize, "|u1".into()),
            Self::Flag(values) => (values.as_mut_ptr() as usize, "|b1".into()),
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Double(values) => values.len(),
            Self::Single(values) => values.len(),
            Self::Count(values) => values.len(),
            Self::Byte(values) => values.len(),
            Self::Flag(values) => values.len(),
        }
    }
}

/// What an array's memory belongs to: numpy keeps it as long as the array.
#[pyclass(frozen, module = "strandsnap._core")]
struct Memory {
    /// Where its numbers are, which do not move.
    address: usize,
    /// Their type, in numpy's words.
    kind: String,
    shape: Vec<usize>,
    _numbers: Numbers,
}

#[pymethods]
impl Memory {
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("typestr", &self.kind)?;
        interface.set_item("shape", PyTuple::new(py, &self.shape)?)?;
        // Nothing else sees this memory, so whoever has the array may write to it.
        interface.set_item("data", (self.address, false))?;
        Ok(interface)
    }
}

/// An array of this shape, whose product is the count of the numbers.
pub fn array<'py>(py: Python<'py>, mut numbers: Numbers, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    assert_eq!(numbers.len(), shape.iter().product::<usize>(), "numpy would read beyond the memory");
    let (address, kind) = numbers.interface();
    let memory = Bound::new(py, Memory { address, kind, shape: shape.to_vec(), _numbers: numbers })?;
    py.import("numpy")?.call_method1("asarray", (memory,))
}

/// The cells of a column.
enum Cells {
    Numbers(Vec<f64>),
    Others(Vec<Value>),
}

/// A column that grows row by row.
struct Growing {
    name: String,
    kind: Option<Kind>,
    cells: Cells,
}

/// A table that grows row by row.
#[derive(Default)]
pub struct Growth(Vec<Growing>);

impl Growth {
    /// Without rows.
    pub fn new<R>(columns: &[Column<R>]) -> Self {
        let empty = |column: &Column<R>| Growing {
            name: column.name.to_string(),
            kind: column.kind,
            cells: match column.kind {
                Some(Kind::Number | Kind::Single) => Cells::Numbers(Vec::new()),
                Some(Kind::Count | Kind::Text | Kind::Flag) | None => Cells::Others(Vec::new()),
            },
        };
        Self(columns.iter().map(empty).collect())
    }

    /// Adds a row.
    pub fn push<R>(&mut self, columns: &[Column<R>], row: &R) {
        for (growing, column) in self.0.iter_mut().zip(columns) {
            match (&mut growing.cells, column.value(row)) {
                (Cells::Numbers(numbers), Value::Number(number)) => numbers.push(number),
                (Cells::Numbers(numbers), _) => numbers.push(f64::NAN),
                (Cells::Others(values), value) => values.push(value),
            }
        }
    }

    /// All columns by name.
    pub fn into_dict(self, py: Python) -> PyResult<Bound<PyDict>> {
        let dict = PyDict::new(py);
        for Growing { name, kind, cells } in self.0 {
            let values = match cells {
                Cells::Numbers(numbers) => {
                    let shape = [numbers.len()];
                    array(py, Numbers::Double(numbers), &shape)?
                }
                Cells::Others(values) => others(py, kind.or_else(|| told_by(&values)), values)?,
            };
            dict.set_item(name, values)?;
        }
        Ok(dict)
    }
}

/// What the values are of a column that does not say it: text where they differ.
fn told_by(values: &[Value]) -> Option<Kind> {
    let kind = |value: &Value| match value {
        Value::Missing => None,
        Value::Number(_) => Some(Kind::Number),
        Value::Count(_) => Some(Kind::Count),
        Value::Flag(_) => Some(Kind::Flag),
        Value::Text(_) | Value::Json(_) => Some(Kind::Text),
    };
    let mut kinds = values.iter().filter_map(kind);
    let first = kinds.next()?;
    Some(if kinds.all(|other| other == first) { first } else { Kind::Text })
}

/// Counts of which some are missing become numbers, which alone can say so (NaN), as in pandas; missing text is empty.
fn others(py: Python, kind: Option<Kind>, values: Vec<Value>) -> PyResult<Bound<PyAny>> {
    let shape = [values.len()];
    let whole = !values.contains(&Value::Missing);
    let number = |value: &Value| match value {
        Value::Number(number) => *number,
        Value::Count(count) => *count as f64,
        _ => f64::NAN,
    };
    match kind {
        Some(Kind::Count) if whole => {
            let count = |value: &Value| if let Value::Count(count) = value { *count as i64 } else { 0 };
            array(py, Numbers::Count(values.iter().map(count).collect()), &shape)
        }
        Some(Kind::Flag) if whole => {
            let holds = values.iter().map(|value| *value == Value::Flag(true)).collect();
            array(py, Numbers::Flag(holds), &shape)
        }
        Some(Kind::Number | Kind::Single | Kind::Count) | None => {
            array(py, Numbers::Double(values.iter().map(number).collect()), &shape)
        }
        Some(Kind::Text | Kind::Flag) => {
            let texts: Vec<String> = values.into_iter().map(Value::in_csv).collect();
            py.import("numpy")?.call_method1("array", (texts, "str"))
        }
    }
}

/// Tables that the library hands over, by name.
#[derive(Default)]
pub struct Taken(pub Vec<(String, Growth)>);

impl TableSink for Taken {
    fn take<R>(&mut self, name: &str, columns: &[Column<R>], results: &[R]) -> Result<()> {
        let mut growth = Growth::new(columns);
        results.iter().for_each(|row| growth.push(columns, row));
        self.0.push((name.to_owned(), growth));
        Ok(())
    }
}
