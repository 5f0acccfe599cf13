//! B-spline curves and surfaces, simple and complex, rational or not.

use super::model::{Attributes, Model, Read};
use crate::import::fault::Why;
use crate::import::part21::Value;
use crate::import::spline::{Spline, SplineSurface};
use glam::DVec3;

/// Names of curves that are read here.
pub const CURVES: [&str; 6] = [
    "B_SPLINE_CURVE",
    "B_SPLINE_CURVE_WITH_KNOTS",
    "RATIONAL_B_SPLINE_CURVE",
    "BEZIER_CURVE",
    "UNIFORM_CURVE",
    "QUASI_UNIFORM_CURVE",
];

/// Names of surfaces that are read here.
pub const SURFACES: [&str; 6] = [
    "B_SPLINE_SURFACE",
    "B_SPLINE_SURFACE_WITH_KNOTS",
    "RATIONAL_B_SPLINE_SURFACE",
    "BEZIER_SURFACE",
    "UNIFORM_SURFACE",
    "QUASI_UNIFORM_SURFACE",
];

const DEGREE: &str = "degree: a whole number";
const POINTS: &str = "control points: instances";
const KNOTS: &str = "knots: numbers, each with its multiplicity";

/// A curve.
pub fn curve(model: &Model, number: u64) -> Read<Spline> {
    let kind = |name: &str| model.record(number, name);
    // Complex: each record has its own attributes. Simple: one has those of all, after the name of the item.
    let complex = kind("B_SPLINE_CURVE").filter(|_| is_complex(model, number));
    let Some(own) = complex.or_else(|| CURVES.iter().find_map(|name| kind(name)).map(|all| all.after(1))) else {
        return Err(model.fault(number, Why::Kind));
    };
    let degree = own.count(0, DEGREE)?;
    let points = own.references(1, POINTS)?;
    let points = points.into_iter().map(|point| model.point(number, point)).collect::<Read<Vec<DVec3>>>()?;
    let knots = match kind("B_SPLINE_CURVE_WITH_KNOTS") {
        Some(given) => {
            let first = if complex.is_some() { 0 } else { 6 };
            expanded(given, first, first + 1, degree, points.len())?
        }
        None => implied(model, number, "CURVE", degree, points.len())?,
    };
    let weights = kind("RATIONAL_B_SPLINE_CURVE").filter(|_| complex.is_some());
    let weights = weights.map(|record| record.numbers(0, "weights: numbers")).transpose()?;
    Spline::new(degree, knots, &points, weights.as_deref()).map_err(|why| model.fault(number, why))
}

/// A surface.
pub fn surface(model: &Model, number: u64) -> Read<SplineSurface> {
    let kind = |name: &str| model.record(number, name);
    let complex = kind("B_SPLINE_SURFACE").filter(|_| is_complex(model, number));
    let Some(own) = complex.or_else(|| SURFACES.iter().find_map(|name| kind(name)).map(|all| all.after(1))) else {
        return Err(model.fault(number, Why::Kind));
    };
    let degrees = [own.count(0, DEGREE)?, own.count(1, DEGREE)?];
    let rows = rows(own, 2, POINTS, |value| if let Value::Reference(point) = value { Some(*point) } else { None })?;
    let row = |row: Vec<u64>| row.into_iter().map(|point| model.point(number, point)).collect::<Read<Vec<DVec3>>>();
    let net = rows.into_iter().map(row).collect::<Read<Vec<_>>>()?;
    let counts = [net.len(), net.first().map_or(0, Vec::len)];
    let knots = match kind("B_SPLINE_SURFACE_WITH_KNOTS") {
        Some(given) => {
            let first = if complex.is_some() { 0 } else { 8 };
            [0, 1].map(|k| expanded(given, first + k, first + 2 + k, degrees[k], counts[k]))
        }
        None => [0, 1].map(|k| implied(model, number, "SURFACE", degrees[k], counts[k])),
    };
    let [u, v] = knots;
    let weights = kind("RATIONAL_B_SPLINE_SURFACE").filter(|_| complex.is_some());
    let weights = weights.map(|record| self::rows(record, 0, "weights: numbers", super::model::number)).transpose()?;
    SplineSurface::new(degrees, [u?, v?], &net, weights.as_deref()).map_err(|why| model.fault(number, why))
}

fn is_complex(model: &Model, number: u64) -> bool {
    model.exchange.instances.get(&number).is_some_and(|instance| instance.records.len() > 1)
}

/// A list of lists.
fn rows<T>(of: Attributes, index: usize, what: &'static str, one: impl Fn(&Value) -> Option<T>) -> Read<Vec<Vec<T>>> {
    let row = |value: &Value| match value {
        Value::List(values) => values.iter().map(&one).collect::<Option<Vec<T>>>(),
        _ => None,
    };
    of.list(index, what)?.iter().map(row).collect::<Option<_>>().ok_or_else(|| of.unusable(what))
}

/// Knots, each as often as its multiplicity says.
fn expanded(of: Attributes, multiplicities: usize, knots: usize, degree: usize, points: usize) -> Read<Vec<f64>> {
    let (counts, values) = (of.counts(multiplicities, KNOTS)?, of.numbers(knots, KNOTS)?);
    // Before they are written out: a multiplicity may be any number.
    if counts.len() != values.len() || counts.iter().sum::<usize>() != points + degree + 1 {
        return Err(of.unusable("multiplicities: one per knot, together as many as points and degree, and one more"));
    }
    Ok(counts.iter().zip(values).flat_map(|(count, knot)| std::iter::repeat_n(knot, *count)).collect())
}

/// Knots that the name of a curve or surface implies.
fn implied(model: &Model, number: u64, what: &str, degree: usize, points: usize) -> Read<Vec<f64>> {
    let is = |kind: &str| model.record(number, &format!("{kind}_{what}")).is_some();
    let wrong = || {
        model.fault(number, Why::Unusable("degree: less than the number of points, and for Bézier pieces a part of it"))
    };
    if degree == 0 || points <= degree {
        return Err(wrong());
    }
    let inner = points - degree;
    if is("UNIFORM") {
        return Ok((0..points + degree + 1).map(|i| i as f64 - degree as f64).collect());
    }
    let (pieces, times) = match (is("BEZIER"), is("QUASI_UNIFORM")) {
        (true, _) if (points - 1).is_multiple_of(degree) => ((points - 1) / degree, degree),
        (false, true) => (inner, 1),
        (true, _) => return Err(wrong()),
        (false, false) => return Err(model.fault(number, Why::Unusable("knots: none are given"))),
    };
    let ends = |value: usize| std::iter::repeat_n(value as f64, degree + 1);
    let between = (1..pieces).flat_map(|k| std::iter::repeat_n(k as f64, times));
    Ok(ends(0).chain(between).chain(ends(pieces)).collect())
}
