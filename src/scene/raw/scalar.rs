//! Quantities before their units are read, and damping, which is one of them or a table.

use crate::base::units::shortest;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{self, Deserializer, MapAccess, Visitor};
use std::borrow::Cow;
use std::fmt;

/// A quantity before its unit is read: text or a plain number.
#[derive(Debug, Clone, PartialEq)]
pub enum Scalar {
    /// `"39 mm"`.
    Text(String),
    /// `0.2`.
    Number(f64),
}

/// A vector of three quantities.
pub type Triple = [Scalar; 3];

/// `bond.damping`: one number or one per mode.
#[derive(Debug, Clone)]
pub enum RawDamping {
    /// The same in all modes.
    All(Scalar),
    /// Mode by mode.
    Modes(RawDampingModes),
}

/// `bond.damping` mode by mode.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawDampingModes {
    /// Axial.
    #[schemars(extend("x-unit" = "-", "x-default" = "0"))]
    pub axial: Option<Scalar>,
    /// Shear.
    #[schemars(extend("x-unit" = "-", "x-default" = "0"))]
    pub shear: Option<Scalar>,
    /// Bending.
    #[schemars(extend("x-unit" = "-", "x-default" = "0"))]
    pub bending: Option<Scalar>,
    /// Torsion.
    #[schemars(extend("x-unit" = "-", "x-default" = "0"))]
    pub torsion: Option<Scalar>,
}

impl JsonSchema for Scalar {
    fn schema_name() -> Cow<'static, str> {
        "quantity".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "title": "quantity", "type": ["string", "number"] })
    }
}

impl JsonSchema for RawDamping {
    fn schema_name() -> Cow<'static, str> {
        "damping".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let modes = RawDampingModes::json_schema(generator);
        json_schema!({ "anyOf": [Scalar::json_schema(generator), modes] })
    }
}

impl fmt::Display for Scalar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Scalar::Text(text) => write!(f, "{text:?}"),
            Scalar::Number(number) => f.write_str(&shortest(*number)),
        }
    }
}

impl<'de> Deserialize<'de> for Scalar {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ScalarVisitor)
    }
}

struct ScalarVisitor;

impl Visitor<'_> for ScalarVisitor {
    type Value = Scalar;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or text with a unit")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Scalar, E> {
        Ok(Scalar::Text(text.to_owned()))
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<Scalar, E> {
        Ok(Scalar::Number(number as f64))
    }

    fn visit_u64<E: de::Error>(self, number: u64) -> Result<Scalar, E> {
        Ok(Scalar::Number(number as f64))
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<Scalar, E> {
        Ok(Scalar::Number(number))
    }
}

impl<'de> Deserialize<'de> for RawDamping {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(DampingVisitor)
    }
}

struct DampingVisitor;

impl<'de> Visitor<'de> for DampingVisitor {
    type Value = RawDamping;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or { axial, shear, bending, torsion }")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<RawDamping, E> {
        ScalarVisitor.visit_str(text).map(RawDamping::All)
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<RawDamping, E> {
        ScalarVisitor.visit_i64(number).map(RawDamping::All)
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<RawDamping, E> {
        ScalarVisitor.visit_f64(number).map(RawDamping::All)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawDamping, A::Error> {
        RawDampingModes::deserialize(de::value::MapAccessDeserializer::new(map)).map(RawDamping::Modes)
    }
}
