//! Instances and their attributes, with errors that name them.

use crate::import::fault::{Place, Unread, Why};
use crate::import::part21::{Exchange, Instance, Record, Value};
use glam::DVec3;

/// What is read of a model, or what is in the way.
pub type Read<T> = Result<T, Unread>;

/// The instances of a file.
#[derive(Clone, Copy)]
pub struct Model<'a> {
    /// The file.
    pub exchange: &'a Exchange,
}

/// Attributes of one record of an instance.
#[derive(Clone, Copy)]
pub struct Attributes<'a> {
    model: Model<'a>,
    number: u64,
    values: &'a [Value],
}

impl<'a> Model<'a> {
    /// Where an instance stands.
    pub fn place(&self, number: u64) -> Place {
        match self.exchange.instances.get(&number) {
            Some(instance) => Place { entity: instance.name(), number: Some(number), line: instance.line },
            None => Place { entity: "instance".into(), number: Some(number), line: 0 },
        }
    }

    /// Something wrong with an instance.
    pub fn fault(&self, number: u64, why: Why) -> Unread {
        Unread { why, place: self.place(number) }
    }

    /// An instance that `from` refers to.
    pub fn instance(&self, from: u64, number: u64) -> Read<&'a Instance> {
        self.exchange.instances.get(&number).ok_or_else(|| self.fault(from, Why::Missing(number)))
    }

    /// The record `name` of an instance, if it has one.
    pub fn record(&self, number: u64, name: &str) -> Option<Attributes<'a>> {
        let values = self.exchange.instances.get(&number)?.record(name)?;
        Some(Attributes { model: *self, number, values })
    }

    /// The record `name` of an instance that `from` refers to; `wanted` says what it has to be.
    pub fn expect(&self, from: u64, number: u64, name: &str, wanted: &'static str) -> Read<Attributes<'a>> {
        self.instance(from, number)?;
        self.record(number, name).ok_or_else(|| self.fault(from, Why::Unexpected { number, wanted }))
    }

    /// Numbers of all instances that have one of these records.
    pub fn all(&self, name: &'static str) -> impl Iterator<Item = u64> + use<'a> {
        let has = move |instance: &Instance| instance.record(name).is_some();
        self.exchange.instances.iter().filter(move |(_, instance)| has(instance)).map(|(number, _)| *number)
    }

    /// Representations of shapes.
    pub fn representations(&self) -> Vec<u64> {
        let numbers = self.exchange.instances.keys().copied();
        numbers.filter(|number| self.of_shape(*number).is_some()).collect()
    }

    /// Attributes of a representation of a shape.
    fn of_shape(&self, number: u64) -> Option<Attributes<'a>> {
        // Name, items, context: a usage of a representation (CONTEXT_DEPENDENT_SHAPE_REPRESENTATION) has two attributes.
        let is_named =
            |name: &str| name.ends_with("SHAPE_REPRESENTATION") || name == "CONSTRUCTIVE_GEOMETRY_REPRESENTATION";
        let is_one = |record: &&Record| is_named(&record.name) && record.values.len() == 3;
        let record = self.exchange.instances.get(&number)?.records.iter().find(is_one)?;
        Some(Attributes { model: *self, number, values: &record.values })
    }

    /// Attributes of a representation, whatever its kind: name, items, context.
    pub fn representation(&self, number: u64) -> Option<Attributes<'a>> {
        let plain = || self.record(number, "REPRESENTATION").filter(|attributes| attributes.len() == 3);
        self.of_shape(number).or_else(plain)
    }

    /// Items of a representation.
    pub fn items(&self, number: u64) -> Read<Vec<u64>> {
        match self.representation(number) {
            Some(attributes) => attributes.references(1, "items: they are instances"),
            None => Err(self.fault(number, Why::Unusable("attributes: a name, items and a context"))),
        }
    }

    /// A CARTESIAN_POINT, VERTEX_POINT or such that `from` refers to.
    pub fn point(&self, from: u64, number: u64) -> Read<DVec3> {
        if let Some(vertex) = self.record(number, "VERTEX_POINT") {
            let point = vertex.reference(1, "geometry: a point")?;
            return self.coordinates(number, point, "CARTESIAN_POINT", "a point");
        }
        self.coordinates(from, number, "CARTESIAN_POINT", "a point")
    }

    /// A DIRECTION that `from` refers to; of any length.
    pub fn direction(&self, from: u64, number: u64) -> Read<DVec3> {
        self.coordinates(from, number, "DIRECTION", "a direction")
    }

    fn coordinates(&self, from: u64, number: u64, name: &str, wanted: &'static str) -> Read<DVec3> {
        let given = self.expect(from, number, name, wanted)?.numbers(1, "coordinates: two or three numbers")?;
        match given[..] {
            [x, y] => Ok(DVec3::new(x, y, 0.0)),
            [x, y, z] => Ok(DVec3::new(x, y, z)),
            _ => Err(self.fault(number, Why::Unusable("coordinates: two or three numbers"))),
        }
    }
}

impl<'a> Attributes<'a> {
    /// Number of the instance.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// The same without the first ones.
    pub fn after(self, first: usize) -> Self {
        Self { values: self.values.get(first..).unwrap_or_default(), ..self }
    }

    /// One of them.
    pub fn value(&self, index: usize) -> Option<&'a Value> {
        self.values.get(index)
    }

    /// The instance with an attribute that has to be something else.
    pub fn unusable(&self, what: &'static str) -> Unread {
        self.model.fault(self.number, Why::Unusable(what))
    }

    /// A number, perhaps with its type.
    pub fn real(&self, index: usize, what: &'static str) -> Read<f64> {
        self.value(index).and_then(number).ok_or_else(|| self.unusable(what))
    }

    /// A number greater than 0.
    pub fn positive(&self, index: usize, what: &'static str) -> Read<f64> {
        self.real(index, what).and_then(|value| if value > 0.0 { Ok(value) } else { Err(self.unusable(what)) })
    }

    /// A whole number from 0, up to what no list of a file exceeds.
    pub fn count(&self, index: usize, what: &'static str) -> Read<usize> {
        self.value(index).and_then(count).ok_or_else(|| self.unusable(what))
    }

    /// `.T.` or `.F.`; anything else is neither.
    pub fn truth(&self, index: usize) -> Option<bool> {
        match self.value(index)? {
            Value::Word(word) if word == "T" => Some(true),
            Value::Word(word) if word == "F" => Some(false),
            _ => None,
        }
    }

    /// An instance.
    pub fn reference(&self, index: usize, what: &'static str) -> Read<u64> {
        match self.value(index) {
            Some(Value::Reference(number)) => Ok(*number),
            _ => Err(self.unusable(what)),
        }
    }

    /// A list.
    pub fn list(&self, index: usize, what: &'static str) -> Read<&'a [Value]> {
        match self.value(index) {
            Some(Value::List(values)) => Ok(values),
            _ => Err(self.unusable(what)),
        }
    }

    /// Instances.
    pub fn references(&self, index: usize, what: &'static str) -> Read<Vec<u64>> {
        let one = |value: &Value| if let Value::Reference(number) = value { Some(*number) } else { None };
        self.list(index, what)?.iter().map(one).collect::<Option<_>>().ok_or_else(|| self.unusable(what))
    }

    /// Numbers.
    pub fn numbers(&self, index: usize, what: &'static str) -> Read<Vec<f64>> {
        self.list(index, what)?.iter().map(number).collect::<Option<_>>().ok_or_else(|| self.unusable(what))
    }

    /// Whole numbers.
    pub fn counts(&self, index: usize, what: &'static str) -> Read<Vec<usize>> {
        self.list(index, what)?.iter().map(count).collect::<Option<_>>().ok_or_else(|| self.unusable(what))
    }
}

/// A number, perhaps with its type.
pub fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Number(number) => Some(*number),
        Value::Typed(_, values) => match &values[..] {
            [Value::Number(number)] => Some(*number),
            _ => None,
        },
        _ => None,
    }
}

fn count(value: &Value) -> Option<usize> {
    number(value).filter(|number| number.fract() == 0.0 && (0.0..1e7).contains(number)).map(|number| number as usize)
}
