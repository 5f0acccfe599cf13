//! Axes of a study: their levels, each with what it changes in the scene.

use super::raw::{RawAxis, RawLevel};
use crate::base::error::Result;
use crate::base::units::{self, Dimension};
use crate::scene::SceneSource;
use toml::Value;

/// Most cases of a study: more is a typing error.
pub(super) const MOST_CASES: usize = 20_000;

/// Something that a study varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What it is called.
    pub name: String,
    /// Key of the scene; `None` where levels change several.
    pub key: Option<String>,
    /// Unit of the numbers, when every level has one and the same; empty for plain numbers.
    pub unit: String,
    /// Its levels, in order.
    pub levels: Vec<Level>,
}

/// A value of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// As people read it: "39 mm".
    pub name: String,
    /// As it stands in the study, which may be in another unit.
    pub written: String,
    /// As a number in the axis' unit, if it is one.
    pub number: Option<f64>,
    /// What it changes.
    pub set: Vec<String>,
}

impl Axis {
    /// Whether the levels are numbers, so that curves may be drawn and fitted over them.
    pub fn is_numeric(&self) -> bool {
        self.levels.iter().all(|level| level.number.is_some())
    }

    /// Name and unit, for the axis of a plot.
    pub fn label(&self) -> String {
        match self.unit.as_str() {
            "" if self.is_numeric() => format!("{} [-]", self.name),
            "" => self.name.clone(),
            unit => format!("{} [{unit}]", self.name),
        }
    }
}

/// Levels of one meaning that were taken as one.
#[derive(Debug, Clone, PartialEq)]
pub struct Merged {
    /// Name of the axis.
    pub axis: String,
    /// The level that stays, as it is told.
    pub kept: String,
    /// The one that says the same, as it was written.
    pub same: String,
}

/// Resolves all axes, and says which levels were taken as one; those that zip are taken into the one before them.
pub(super) fn axes(raw: &[RawAxis], source: &SceneSource) -> Result<(Vec<Axis>, Vec<Merged>)> {
    let mut axes: Vec<Axis> = Vec::new();
    for (index, raw) in raw.iter().enumerate() {
        let at = format!("axis.{index}");
        let axis = axis(raw, &at, source)?;
        if raw.zip {
            let Some(last) = axes.last_mut() else {
                return Err(source.error(&format!("{at}.zip"), "the first axis has none before it", "remove `zip`"));
            };
            zip(last, axis, &at, source)?;
        } else if axes.iter().any(|before| before.name == axis.name) {
            let what = format!("two axes are called `{}`", axis.name);
            return Err(source.error(&at, what, "give each its own `name`"));
        } else {
            axes.push(axis);
        }
    }
    let merged = axes.iter_mut().flat_map(merge).collect();
    Ok((axes, merged))
}

/// Takes levels that change the same keys to the same values as one: the first.
fn merge(axis: &mut Axis) -> Vec<Merged> {
    // Levels of several keys were written and named one by one; two of them that say the same are an error, which shows
    // when their scenes are compared.
    if axis.key.is_none() {
        return Vec::new();
    }
    let mut kept: Vec<Level> = Vec::new();
    let mut merged = Vec::new();
    for level in std::mem::take(&mut axis.levels) {
        match kept.iter().find(|before| before.set == level.set) {
            Some(before) => {
                merged.push(Merged { axis: axis.name.clone(), kept: before.name.clone(), same: level.written });
            }
            None => kept.push(level),
        }
    }
    axis.levels = kept;
    merged
}

/// Takes `along` into `axis`, level by level.
fn zip(axis: &mut Axis, along: Axis, at: &str, source: &SceneSource) -> Result<()> {
    let (have, give) = (axis.levels.len(), along.levels.len());
    if have != give {
        let what =
            format!("`{}` has {give} values, but `{}`, which it goes along with, has {have}", along.name, axis.name);
        return Err(source.error(at, what, "give as many of the one as of the other"));
    }
    for (level, along) in axis.levels.iter_mut().zip(along.levels) {
        level.set.extend(along.set);
    }
    Ok(())
}

fn axis(raw: &RawAxis, at: &str, source: &SceneSource) -> Result<Axis> {
    let error = |key: &str, what: &str, help: &str| Err(source.error(&format!("{at}.{key}"), what, help));
    let name = |default: &str| raw.name.clone().unwrap_or_else(|| default.to_owned());
    let levels = match (&raw.key, &raw.levels) {
        (None, Some(levels)) => {
            let Some(name) = &raw.name else {
                return error("levels", "an axis of levels has no name", "add `name`");
            };
            return several(name, levels, at, source);
        }
        (Some(_), Some(_)) => return error("levels", "`levels` does not go with `key`", "remove one of them"),
        (None, None) => {
            return error("", "the axis does not say what it varies", "add `key` with `values`, or `levels`");
        }
        (Some(key), None) => {
            let values = match (&raw.values, &raw.from, &raw.to, raw.points) {
                (Some(values), None, None, None) => values.clone(),
                (None, Some(from), Some(to), Some(points)) => range(from, to, points, at, source)?,
                (None, ..) => return error("", "the axis has no values", "add `values`, or `from`, `to` and `points`"),
                (Some(_), ..) => return error("values", "`values` does not go with a range", "remove one of them"),
            };
            if values.is_empty() {
                return error("values", "the axis has no value", "give at least one");
            }
            let values = in_one_unit(&values);
            values.iter().map(|(value, written)| level(key, value, written)).collect::<Vec<_>>()
        }
    };
    let key = raw.key.as_deref().expect("the other cases have returned");
    let last = key.rsplit('.').next().unwrap_or(key).replace('_', " ");
    let unit = common_unit(&levels);
    let levels = levels.into_iter().map(|(level, _)| level).collect();
    Ok(Axis { name: name(&last), key: Some(key.to_owned()), unit: unit.unwrap_or_default(), levels })
}

fn several(name: &str, raw: &[RawLevel], at: &str, source: &SceneSource) -> Result<Axis> {
    let mut levels: Vec<Level> = Vec::new();
    for (index, level) in raw.iter().enumerate() {
        let here = format!("{at}.levels.{index}");
        let Some(name) = &level.name else {
            return Err(source.error(&here, "a level has no name", "add `name`"));
        };
        if levels.iter().any(|before| before.name == *name) {
            return Err(source.error(&here, format!("two levels are called `{name}`"), "give each its own `name`"));
        }
        let number = name.trim().parse().ok().filter(|number: &f64| number.is_finite());
        levels.push(Level { name: name.clone(), written: name.clone(), number, set: level.set.clone() });
    }
    if levels.is_empty() {
        return Err(source.error(&format!("{at}.levels"), "the axis has no level", "give at least one"));
    }
    Ok(Axis { name: name.to_owned(), key: None, unit: String::new(), levels })
}

/// Values, each with how it was written: numbers in the unit of the first of them, and the same text for the same number.
/// Values that have no kind of quantity in common stay as they are.
fn in_one_unit(values: &[Value]) -> Vec<(Value, Value)> {
    let numbers: Vec<(f64, String)> = values.iter().filter_map(number_and_unit).collect();
    let si = |(number, unit): &(f64, String), dimension| units::parse(&format!("{number} {unit}"), dimension).ok();
    let fits = |dimension: &&Dimension| numbers.iter().all(|number| si(number, **dimension).is_some());
    let (Some((_, unit)), Some(dimension)) = (numbers.first(), Dimension::ALL.iter().find(fits)) else {
        return values.iter().map(|value| (value.clone(), value.clone())).collect();
    };
    let one = si(&(1.0, unit.clone()), *dimension).expect("the unit fits");
    let mut seen: Vec<(f64, Value)> = Vec::new();
    let mut convert = |value: &Value| {
        let Some((number, own)) = number_and_unit(value) else { return (value.clone(), value.clone()) };
        let (number, text) = match own == *unit {
            true => (number, value.clone()),
            false => {
                let number = figures(si(&(number, own), *dimension).expect("every number fits") / one);
                (number, with_unit(number, unit))
            }
        };
        let text = match seen.iter().find(|(before, _)| *before == number) {
            Some((_, before)) => before.clone(),
            None => {
                seen.push((number, text.clone()));
                text
            }
        };
        (text, value.clone())
    };
    values.iter().map(&mut convert).collect()
}

/// A number as it stands in a scene.
fn with_unit(number: f64, unit: &str) -> Value {
    if unit.is_empty() { Value::Float(number) } else { Value::String(format!("{number} {unit}")) }
}

/// A level of one key, and its unit.
fn level(key: &str, value: &Value, written: &Value) -> (Level, Option<String>) {
    let split = number_and_unit(value);
    let shown = |value: &Value| match value {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    let (number, unit) = split.map_or((None, None), |(number, unit)| (Some(number), Some(unit)));
    let (name, written) = (shown(value), shown(written));
    (Level { name, written, number, set: vec![format!("{key}={value}")] }, unit)
}

/// The unit that all levels share; `None` when they do not.
fn common_unit(levels: &[(Level, Option<String>)]) -> Option<String> {
    let first = levels.first()?.1.clone()?;
    levels.iter().all(|(_, unit)| unit.as_ref() == Some(&first)).then_some(first)
}

/// 39 and "mm" of "39 mm"; a plain number has an empty unit.
fn number_and_unit(value: &Value) -> Option<(f64, String)> {
    let (number, unit) = match value {
        Value::Integer(number) => (*number as f64, String::new()),
        Value::Float(number) => (*number, String::new()),
        Value::String(text) => {
            let text = text.trim();
            let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c))).unwrap_or(text.len());
            (text[..end].parse().ok()?, text[end..].trim().to_owned())
        }
        _ => return None,
    };
    number.is_finite().then_some((number, unit))
}

/// Values of an even range.
fn range(from: &Value, to: &Value, points: i64, at: &str, source: &SceneSource) -> Result<Vec<Value>> {
    let end = |key: &str, value: &Value| {
        let what = format!("`{key}` is {value}, which is no number");
        number_and_unit(value).ok_or_else(|| source.error(&format!("{at}.{key}"), what, "for example \"39 mm\""))
    };
    let ((first, unit), (last, other)) = (end("from", from)?, end("to", to)?);
    if unit != other {
        let what = format!("`from` is in {unit:?} and `to` in {other:?}");
        return Err(source.error(&format!("{at}.to"), what, "give both in one unit"));
    }
    if points < 2 {
        let what = format!("`points` is {points}, but a range has at least 2");
        return Err(source.error(&format!("{at}.points"), what, "for example points = 7"));
    }
    if points as usize > MOST_CASES {
        let what = format!("`points` is {points}, more than {MOST_CASES} cases");
        return Err(source.error(&format!("{at}.points"), what, "for example points = 7"));
    }
    let value = |k: i64| {
        let exact = first + (last - first) * k as f64 / (points - 1) as f64;
        with_unit(figures(exact), &unit)
    };
    Ok((0..points).map(value).collect())
}

/// Twelve figures, so that 41.5 does not become 41.50000000000001.
fn figures(exact: f64) -> f64 {
    format!("{exact:.11e}").parse().expect("it was written as a number")
}
