//! Units of a representation.

use super::model::{Model, Read};
use super::reader::within;
use crate::import::fault::Why;
use crate::import::part21::Value;

/// What a representation counts in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    /// Its unit of length (m).
    pub length: f64,
    /// Its unit of angle (rad).
    pub angle: f64,
}

impl Units {
    /// Those of a representation; `length` (m) takes the place of what it says.
    ///
    /// # Errors
    /// [`Why::NoUnit`] where neither gives a length, and what is wrong with the units.
    pub fn of(model: &Model, representation: u64, length: Option<f64>) -> Read<Self> {
        let what = "context: an instance";
        let context = match model.representation(representation) {
            Some(attributes) => attributes.reference(2, what)?,
            None => return Err(model.fault(representation, Why::Unusable(what))),
        };
        model.instance(representation, context)?;
        let units = match model.record(context, "GLOBAL_UNIT_ASSIGNED_CONTEXT") {
            Some(attributes) => {
                attributes.references(attributes.len().saturating_sub(1), "units: a list of instances")?
            }
            None => Vec::new(),
        };
        let find = |kind: &str| units.iter().copied().find(|unit| model.record(*unit, kind).is_some());
        let angle = find("PLANE_ANGLE_UNIT").map(|unit| factor(model, unit, 0)).transpose()?.unwrap_or(1.0);
        let length = match (length, find("LENGTH_UNIT")) {
            (Some(length), _) => length,
            (None, Some(unit)) => factor(model, unit, 0)?,
            (None, None) => return Err(model.fault(representation, Why::NoUnit)),
        };
        Ok(Self { length, angle })
    }
}

/// A unit in that of SI.
fn factor(model: &Model, unit: u64, depth: usize) -> Read<f64> {
    within(depth, model, unit)?;
    if let Some(si) = model.record(unit, "SI_UNIT") {
        // Prefix and name come last, whether or not the inherited dimensions are given.
        return match (si.len().checked_sub(2).and_then(|at| si.value(at)), si.value(si.len().saturating_sub(1))) {
            (Some(Value::Omitted), Some(Value::Word(_))) => Ok(1.0),
            (Some(Value::Word(prefix)), Some(Value::Word(_))) => {
                prefixed(prefix).ok_or_else(|| si.unusable("prefix: one of SI"))
            }
            _ => Err(si.unusable("prefix and name: those of SI")),
        };
    }
    let Some(conversion) = model.record(unit, "CONVERSION_BASED_UNIT") else {
        return Err(model.fault(unit, Why::Unusable("kind: a unit of SI or one converted to it")));
    };
    let measure = conversion.reference(conversion.len().saturating_sub(1), "factor: a measure with its unit")?;
    let instance = model.instance(unit, measure)?;
    let name =
        instance.records.iter().map(|record| record.name.as_str()).find(|name| name.ends_with("MEASURE_WITH_UNIT"));
    let wanted = "a measure with its unit";
    let values = model.expect(unit, measure, name.unwrap_or_default(), wanted)?;
    let value = values.positive(0, "value: a number greater than 0")?;
    Ok(value * factor(model, values.reference(1, "unit: an instance")?, depth + 1)?)
}

fn prefixed(prefix: &str) -> Option<f64> {
    const PREFIXES: [(&str, f64); 16] = [
        ("EXA", 1e18),
        ("PETA", 1e15),
        ("TERA", 1e12),
        ("GIGA", 1e9),
        ("MEGA", 1e6),
        ("KILO", 1e3),
        ("HECTO", 1e2),
        ("DECA", 1e1),
        ("DECI", 1e-1),
        ("CENTI", 1e-2),
        ("MILLI", 1e-3),
        ("MICRO", 1e-6),
        ("NANO", 1e-9),
        ("PICO", 1e-12),
        ("FEMTO", 1e-15),
        ("ATTO", 1e-18),
    ];
    PREFIXES.iter().find(|(name, _)| *name == prefix).map(|(_, factor)| *factor)
}
