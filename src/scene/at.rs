//! A place in a scene: reads quantities there, checks their range, and words errors with key, value and line.

use super::place::Part;
use super::raw::{Scalar, Triple};
use super::source::SceneSource;
use crate::base::error::{Error, Result};
use crate::base::units::{self, Dimension};
use glam::DVec3;

/// Longest length (m): beyond it positions have not the digits that contacts of wires need.
const LONGEST: f64 = 1e5;

/// Whether a scene may have this name, and its results a folder, or a picture a file of that name.
pub fn can_name_a_folder(name: &str) -> bool {
    let allowed = |c: char| c.is_alphanumeric() || "-_.+".contains(c);
    !name.is_empty() && name.len() <= LONGEST_NAME && !name.starts_with(['.', '-']) && name.chars().all(allowed)
}

/// Longest name of a file (bytes): file systems take 255, with what else stands in it.
const LONGEST_NAME: usize = 120;

/// A key path in a scene.
#[derive(Clone)]
pub(super) struct At<'a> {
    source: &'a SceneSource,
    path: Vec<String>,
}

/// Which values a quantity may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Range {
    /// Any finite number.
    Any,
    /// Above zero.
    Positive,
    /// Above zero, or infinite.
    PositiveOrInfinite,
    /// Zero or more.
    NotNegative,
    /// 0 to 1, both included.
    UnitInterval,
    /// Above 0, at most 1.
    Fraction,
    /// 1 or more.
    AtLeastOne,
    /// Poisson's ratio of a stable isotropic solid: above −1, below 0.5.
    Poisson,
}

impl Range {
    fn holds(self, value: f64) -> bool {
        match self {
            Range::PositiveOrInfinite => value > 0.0,
            _ if !value.is_finite() => false,
            Range::Any => true,
            Range::Positive => value > 0.0,
            Range::NotNegative => value >= 0.0,
            Range::UnitInterval => (0.0..=1.0).contains(&value),
            Range::Fraction => value > 0.0 && value <= 1.0,
            Range::AtLeastOne => value >= 1.0,
            Range::Poisson => value > -1.0 && value < 0.5,
        }
    }

    fn words(self) -> &'static str {
        match self {
            Range::Any => "a finite number",
            Range::Positive => "greater than zero",
            Range::PositiveOrInfinite => "greater than zero, or \"inf\"",
            Range::NotNegative => "zero or more",
            Range::UnitInterval => "between 0 and 1",
            Range::Fraction => "greater than 0 and at most 1",
            Range::AtLeastOne => "1 or more",
            Range::Poisson => "greater than -1 and less than 0.5",
        }
    }
}

impl<'a> At<'a> {
    /// The whole scene.
    pub fn root(source: &'a SceneSource) -> Self {
        Self { source, path: Vec::new() }
    }

    /// Key `name` below this place.
    pub fn key(&self, name: &str) -> Self {
        let mut below = self.clone();
        below.path.push(name.to_owned());
        below
    }

    /// Element `index` of this place.
    pub fn element(&self, index: usize) -> Self {
        self.key(&index.to_string())
    }

    /// The key itself, with element numbers where there are any: `speed`, `from[2]`.
    pub fn name(&self) -> String {
        let is_key = |part: &String| part.parse::<usize>().is_err();
        let Some(key) = self.path.iter().rposition(is_key) else {
            return "the scene".into();
        };
        let elements = self.path[key + 1..].iter().map(|index| format!("[{index}]"));
        self.path[key].clone() + &elements.collect::<String>()
    }

    /// An error here.
    pub fn error(&self, what: impl Into<String>, help: impl Into<String>) -> Error {
        self.source.error_at(&self.path, Part::Value, what.into(), help.into())
    }

    /// An error that says that a key below this place is missing.
    pub fn missing(&self, name: &str, example: &str) -> Error {
        let what = match self.path.is_empty() {
            true => format!("`{name}` is missing"),
            false => format!("`{}` has no `{name}`", self.path.join(".")),
        };
        self.error(what, format!("add it, for example {name} = {example}"))
    }

    /// An error that says that this key does not belong here.
    pub fn refused(&self, why: &str) -> Error {
        self.error(format!("`{}` {why}", self.name()), "remove it")
    }

    /// Refuses the key `name` when it is given.
    pub fn refuse<T>(&self, name: &str, given: &Option<T>, why: &str) -> Result<()> {
        match given {
            Some(_) => Err(self.key(name).refused(why)),
            None => Ok(()),
        }
    }

    /// A quantity at exactly this place (SI).
    pub fn quantity(&self, raw: &Scalar, dimension: Dimension, range: Range) -> Result<f64> {
        let value = self.read(raw, dimension, range)?;
        if dimension == Dimension::Length && value.is_finite() && value.abs() > LONGEST {
            let what = format!("`{}` is {raw}, but a length is at most {} km", self.name(), LONGEST * 1e-3);
            return Err(self.error(what, "check its unit"));
        }
        if range.holds(value) {
            return Ok(value);
        }
        let finite = match range {
            Range::Any | Range::PositiveOrInfinite => "",
            _ if value.is_finite() => "",
            _ => "a finite number, ",
        };
        let what = format!("`{}` is {raw}, but must be {finite}{}", self.name(), range.words());
        Err(self.error(what, format!("for example {} = {}", self.name(), dimension.example())))
    }

    fn read(&self, raw: &Scalar, dimension: Dimension, range: Range) -> Result<f64> {
        match raw {
            Scalar::Text(text) if text == "inf" && range == Range::PositiveOrInfinite => Ok(f64::INFINITY),
            Scalar::Text(text) => units::parse(text, dimension).map_err(|error| {
                let what = format!("`{}`: {}", self.name(), error.what);
                self.error(what, error.help)
            }),
            Scalar::Number(number) if dimension == Dimension::Ratio => Ok(*number),
            Scalar::Number(number) if number.is_infinite() && range == Range::PositiveOrInfinite => Ok(*number),
            Scalar::Number(_) => {
                let what =
                    format!("`{}` is the bare number {raw}, but a {} needs its unit", self.name(), dimension.name());
                Err(self.error(what, format!("write {} = {}", self.name(), dimension.example())))
            }
        }
    }

    /// The quantity under key `name`, if given (SI).
    pub fn optional(
        &self,
        name: &str,
        raw: &Option<Scalar>,
        dimension: Dimension,
        range: Range,
    ) -> Result<Option<f64>> {
        raw.as_ref().map(|raw| self.key(name).quantity(raw, dimension, range)).transpose()
    }

    /// The quantity under key `name`; an error when it is missing (SI).
    pub fn required(&self, name: &str, raw: &Option<Scalar>, dimension: Dimension, range: Range) -> Result<f64> {
        self.optional(name, raw, dimension, range)?.ok_or_else(|| self.missing(name, dimension.example()))
    }

    /// The ratio under key `name`, or its default (-).
    pub fn ratio_or(&self, name: &str, raw: &Option<Scalar>, default: f64, range: Range) -> Result<f64> {
        Ok(self.optional(name, raw, Dimension::Ratio, range)?.unwrap_or(default))
    }

    /// The vector under key `name`, zero when absent (SI).
    pub fn vector_or_zero(&self, name: &str, raw: &Option<Triple>, dimension: Dimension) -> Result<DVec3> {
        match raw {
            Some(raw) => self.key(name).vector(raw, dimension),
            None => Ok(DVec3::ZERO),
        }
    }

    /// The vector at exactly this place (SI).
    pub fn vector(&self, raw: &Triple, dimension: Dimension) -> Result<DVec3> {
        let mut value = DVec3::ZERO;
        for (axis, raw) in raw.iter().enumerate() {
            value[axis] = self.element(axis).quantity(raw, dimension, Range::Any)?;
        }
        Ok(value)
    }

    /// The whole number under key `name`, which must be at least `least`; its default when absent.
    pub fn count_or(&self, name: &str, raw: Option<i64>, default: u64, least: u64) -> Result<u64> {
        let Some(number) = raw else {
            return Ok(default);
        };
        self.key(name).count(number, least)
    }

    /// The same, of at most `most`.
    pub fn count_within(&self, number: i64, least: u64, most: u64) -> Result<u64> {
        let count = self.count(number, least)?;
        if count > most {
            return Err(self.error(format!("`{}` is {number}, but must be at most {most}", self.name()), ""));
        }
        Ok(count)
    }

    /// The whole number at exactly this place, which must be at least `least`.
    pub fn count(&self, number: i64, least: u64) -> Result<u64> {
        u64::try_from(number).ok().filter(|count| *count >= least).ok_or_else(|| {
            let what = format!("`{}` is {number}, but must be at least {least}", self.name());
            self.error(what, "")
        })
    }
}
