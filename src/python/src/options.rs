//! What is given as Python values, in the words of the command line.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use std::collections::BTreeSet;
use std::time::Duration;
use strandsnap::run::DeviceChoice;
use strandsnap::scene::quality::Quality;
use toml_edit::{Array, InlineTable, Value};

/// The `--set` options of `set` (a mapping, or a list of "key=value") and of `keys`, where `__` stands for a dot.
pub fn overrides(set: Option<&Bound<PyAny>>, keys: Option<&Bound<PyDict>>) -> PyResult<Vec<String>> {
    let mut options = Vec::new();
    if let Some(set) = set {
        if let Ok(pairs) = set.cast::<PyDict>() {
            for (key, value) in pairs {
                options.push(option(&key.extract::<String>()?, &value)?);
            }
        } else if set.is_instance_of::<PyString>() {
            return Err(PyTypeError::new_err("set is a dict, or a list of texts such as \"stop.strain=2 %\""));
        } else {
            options.extend(set.extract::<Vec<String>>()?);
        }
    }
    for (key, value) in keys.into_iter().flatten() {
        options.push(option(&key.extract::<String>()?.replace("__", "."), &value)?);
    }
    Ok(options)
}

/// `key=value`; text stands as it is typed on the command line, and nothing removes the key.
fn option(key: &str, value: &Bound<PyAny>) -> PyResult<String> {
    if value.is_none() {
        return Ok(format!("{key}="));
    }
    match value.cast::<PyString>() {
        Ok(text) => Ok(format!("{key}={}", text.to_cow()?)),
        Err(_) => Ok(format!("{key}={}", toml(value)?)),
    }
}

fn toml(value: &Bound<PyAny>) -> PyResult<Value> {
    if value.is_instance_of::<PyBool>() {
        return Ok(Value::from(value.extract::<bool>()?));
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(Value::from(value.extract::<i64>()?));
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(Value::from(value.extract::<f64>()?));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Value::from(text.to_cow()?.as_ref()));
    }
    if let Ok(pairs) = value.cast::<PyDict>() {
        let mut table = InlineTable::new();
        for (key, value) in pairs {
            table.insert(key.extract::<String>()?, toml(&value)?);
        }
        return Ok(Value::from(table));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let elements = value.try_iter()?.map(|element| toml(&element?)).collect::<PyResult<Array>>()?;
        return Ok(Value::from(elements));
    }
    // Scalars and arrays of numpy.
    if value.hasattr("tolist")? {
        return toml(&value.call_method0("tolist")?);
    }
    let what = format!("no value of a scene: {}; give text with a unit, a number, a list or a dict", value.get_type());
    Err(PyTypeError::new_err(what))
}

/// Which value has this word; `name` is what is asked for.
pub fn word<T: Copy>(name: &str, word: &str, all: &[T], of: impl Fn(T) -> &'static str) -> PyResult<T> {
    all.iter().copied().find(|one| of(*one) == word).ok_or_else(|| {
        let known: Vec<&str> = all.iter().map(|one| of(*one)).collect();
        PyValueError::new_err(format!("{name} is {word:?}; it is one of: {}", known.join(", ")))
    })
}

/// The preset of this name.
pub fn quality(name: Option<&str>) -> PyResult<Option<Quality>> {
    name.map(|name| word("quality", name, &Quality::ALL, Quality::word)).transpose()
}

/// What to compute on.
pub fn device(name: &str) -> PyResult<DeviceChoice> {
    name.parse().map_err(|why: &str| PyValueError::new_err(format!("device: {why}")))
}

/// A number that is at least one.
pub fn positive(name: &str, number: Option<usize>) -> PyResult<Option<usize>> {
    match number {
        Some(0) => Err(PyValueError::new_err(format!("{name} is at least 1"))),
        number => Ok(number),
    }
}

/// A time in seconds.
pub fn seconds(name: &str, seconds: Option<f64>) -> PyResult<Option<Duration>> {
    let refuse = |_| PyValueError::new_err(format!("{name} is a time in seconds"));
    seconds.map(|seconds| Duration::try_from_secs_f64(seconds).map_err(refuse)).transpose()
}

/// Most seeds that a count may ask for: more is a typing error.
const MOST_SEEDS: u64 = 10_000;

/// Seeds, as how many or as a list; nothing where none are named.
pub fn seeds(seeds: Option<&Bound<PyAny>>) -> PyResult<Vec<u64>> {
    let Some(given) = seeds else { return Ok(Vec::new()) };
    let seeds: Vec<u64> = match given.extract::<u64>() {
        Ok(count) if count > MOST_SEEDS => {
            let what = format!("{count} seeds are too many; one alone is the list [{count}]");
            return Err(PyValueError::new_err(what));
        }
        Ok(count) => (1..=count).collect(),
        Err(_) => given.try_iter()?.map(|seed| seed?.extract()).collect::<PyResult<_>>()?,
    };
    let mut seen = BTreeSet::new();
    match seeds.iter().find(|seed| !seen.insert(**seed)) {
        Some(seed) => Err(PyValueError::new_err(format!("seed {seed} is listed twice"))),
        None if seeds.is_empty() => Err(PyValueError::new_err("none is not enough: give a count or a list of seeds")),
        None => Ok(seeds),
    }
}
