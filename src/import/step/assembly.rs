//! Where representations are placed: assemblies, and representations within others.
//!
//! Representations that a SHAPE_REPRESENTATION_RELATIONSHIP without a transformation joins share their space. One that is
//! placed nowhere is at the top.

use super::model::{Model, Read};
use super::placement;
use super::units::Units;
use crate::import::fault::Why;
use crate::import::part21::Value;
use glam::DAffine3;
use std::collections::{BTreeMap, BTreeSet};

/// Most placements of one representation: beyond it a file multiplies them by nesting.
const MOST_PLACES: usize = 100_000;
/// Deepest nesting of assemblies.
const DEEPEST: usize = 100;

/// Kinds of relations between representations.
const RELATIONS: [&str; 3] = [
    "SHAPE_REPRESENTATION_RELATIONSHIP",
    "REPRESENTATION_RELATIONSHIP",
    "CONSTRUCTIVE_GEOMETRY_REPRESENTATION_RELATIONSHIP",
];

/// How a space lies within another (lengths in m).
#[derive(Debug, Clone, Copy)]
struct Placed {
    within: u64,
    by: DAffine3,
    /// The instance that says so.
    source: u64,
}

/// Where representations are placed.
#[derive(Debug, Default)]
pub struct Assembly {
    /// The representation that stands for all which share a space.
    space: BTreeMap<u64, u64>,
    /// Where spaces lie.
    placed: BTreeMap<u64, Vec<Placed>>,
}

impl Assembly {
    /// That of a model; `unit` (m) as in [`Units::of`].
    ///
    /// # Errors
    /// What is wrong with a relation: with one missing, parts would lie where they are not.
    pub fn of(model: &Model, unit: Option<f64>) -> Read<Self> {
        let mut assembly = Self::default();
        let mut transformed = Vec::new();
        for relation in RELATIONS.into_iter().flat_map(|name| model.all(name)) {
            let Some(two) = related(model, relation)? else { continue };
            match model.record(relation, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION") {
                None => assembly.join(two),
                Some(with) => transformed.push((
                    relation,
                    two,
                    with.reference(with.len().saturating_sub(1), "operator: an instance")?,
                )),
            }
        }
        let swapped = swapped(model)?;
        transformed.sort_by_key(|(relation, ..)| *relation);
        transformed.dedup_by_key(|(relation, ..)| *relation);
        for (relation, [first, second], operator) in transformed {
            let attributes = model.expect(
                relation,
                operator,
                "ITEM_DEFINED_TRANSFORMATION",
                "a transformation by two placements",
            )?;
            let place = |index: usize, representation: u64| -> Read<DAffine3> {
                let frame = placement::frame(model, operator, attributes.reference(index, "items: two placements")?)?;
                Ok(placement::affine(&frame, Units::of(model, representation, unit)?.length))
            };
            let (in_first, in_second) = (place(2, first)?, place(3, second)?);
            let (inner, outer, by) = match swapped.contains(&relation) {
                false => (first, second, in_second * in_first.inverse()),
                true => (second, first, in_first * in_second.inverse()),
            };
            assembly.place(inner, Placed { within: outer, by, source: relation });
        }
        for representation in model.representations() {
            assembly.add_mapped(model, representation, unit)?;
        }
        Ok(assembly)
    }

    fn space(&self, representation: u64) -> u64 {
        let mut space = representation;
        while let Some(next) = self.space.get(&space) {
            space = *next;
        }
        space
    }

    fn join(&mut self, two: [u64; 2]) {
        let [kept, gone] = two.map(|one| self.space(one));
        // One that stands for itself has no entry, so that the way up ends there.
        for joined in two.into_iter().chain([gone]).filter(|joined| *joined != kept) {
            self.space.insert(joined, kept);
        }
    }

    /// Spaces are complete when this is called.
    fn place(&mut self, inner: u64, placed: Placed) {
        let placed = Placed { within: self.space(placed.within), ..placed };
        self.placed.entry(self.space(inner)).or_default().push(placed);
    }

    /// Representations that are items of this one.
    fn add_mapped(&mut self, model: &Model, representation: u64, unit: Option<f64>) -> Read<()> {
        for item in model.items(representation)? {
            let Some(mapped) = model.record(item, "MAPPED_ITEM") else { continue };
            let source = mapped.reference(1, "source: a REPRESENTATION_MAP")?;
            let map = model.expect(item, source, "REPRESENTATION_MAP", "a REPRESENTATION_MAP")?;
            let inner = map.reference(1, "representation: an instance")?;
            model.instance(source, inner)?;
            let lengths = [inner, representation].map(|one| Units::of(model, one, unit).map(|units| units.length));
            let [inside, outside] = lengths;
            let origin = placement::frame(model, source, map.reference(0, "origin: a placement")?)?;
            let target = placement::target(model, item, mapped.reference(2, "target: a placement")?, outside?)?;
            let by = target * placement::affine(&origin, inside?).inverse();
            self.place(inner, Placed { within: representation, by, source: item });
        }
        Ok(())
    }

    /// All places of a representation (from m to m).
    ///
    /// # Errors
    /// [`Why::Circular`] when it lies within itself, or more often than any strand.
    pub fn places(&self, model: &Model, representation: u64) -> Read<Vec<DAffine3>> {
        let mut found = Vec::new();
        self.climb(model, self.space(representation), DAffine3::IDENTITY, &mut Vec::new(), &mut found)?;
        Ok(found)
    }

    fn climb(
        &self,
        model: &Model,
        space: u64,
        by: DAffine3,
        below: &mut Vec<u64>,
        found: &mut Vec<DAffine3>,
    ) -> Read<()> {
        let Some(placed) = self.placed.get(&space) else {
            found.push(by);
            return Ok(());
        };
        below.push(space);
        for one in placed {
            if below.contains(&one.within) || below.len() > DEEPEST || found.len() >= MOST_PLACES {
                return Err(model.fault(one.source, Why::Circular));
            }
            self.climb(model, one.within, one.by * by, below, found)?;
        }
        below.pop();
        Ok(())
    }
}

/// The two representations of a relation, where it relates shapes.
fn related(model: &Model, relation: u64) -> Read<Option<[u64; 2]>> {
    let own = model.record(relation, "REPRESENTATION_RELATIONSHIP").filter(|attributes| attributes.len() >= 4);
    let simple = || {
        let record = RELATIONS.into_iter().find_map(|name| model.record(relation, name));
        record.filter(|attributes| attributes.len() >= 4)
    };
    let Some(attributes) = own.or_else(simple) else { return Ok(None) };
    let two = [2, 3].map(|index| attributes.reference(index, "representations: two instances"));
    let [first, second] = two;
    let two = [first?, second?];
    for one in two {
        model.instance(relation, one)?;
    }
    Ok(two.iter().all(|one| model.representation(*one).is_some()).then_some(two))
}

/// Relations whose first representation is the assembly and not its part, as their usage says.
fn swapped(model: &Model) -> Read<BTreeSet<u64>> {
    // Definition → representation, by SHAPE_DEFINITION_REPRESENTATION → PRODUCT_DEFINITION_SHAPE → definition.
    let mut shapes: BTreeMap<u64, u64> = BTreeMap::new();
    for link in model.all("SHAPE_DEFINITION_REPRESENTATION") {
        let Some(link) = model.record(link, "SHAPE_DEFINITION_REPRESENTATION") else { continue };
        let (shape, representation) =
            (link.reference(0, "definition: an instance")?, link.reference(1, "representation: an instance")?);
        if let Some(definition) = definition(model, shape) {
            shapes.insert(representation, definition);
        }
    }
    let mut swapped = BTreeSet::new();
    for usage in model.all("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION") {
        let Some(usage) = model.record(usage, "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION") else { continue };
        let relation = usage.reference(0, "relation: an instance")?;
        let Some(occurrence) = definition(model, usage.reference(1, "shape: an instance")?) else { continue };
        let Some([first, second]) = related(model, relation)? else { continue };
        // id, name, description, relating (the assembly), related (its part).
        let Some(occurrence) = model.record(occurrence, "NEXT_ASSEMBLY_USAGE_OCCURRENCE") else { continue };
        let (whole, part) = (occurrence.value(3), occurrence.value(4));
        let is = |representation: u64, definition: Option<&Value>| {
            shapes.get(&representation).is_some_and(|shape| definition == Some(&Value::Reference(*shape)))
        };
        if is(first, whole) && (is(second, part) || !is(first, part)) {
            swapped.insert(relation);
        }
    }
    Ok(swapped)
}

/// What a PRODUCT_DEFINITION_SHAPE is the shape of.
fn definition(model: &Model, shape: u64) -> Option<u64> {
    match model.record(shape, "PRODUCT_DEFINITION_SHAPE")?.value(2)? {
        Value::Reference(number) => Some(*number),
        _ => None,
    }
}
