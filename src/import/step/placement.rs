//! Placements and transformations.

use super::model::{Model, Read};
use crate::import::fault::Why;
use crate::import::part21::Value;
use crate::import::surface::Frame;
use glam::{DAffine3, DMat3, DVec3};

/// An AXIS2_PLACEMENT_3D, AXIS2_PLACEMENT_2D or AXIS1_PLACEMENT that `from` refers to.
pub fn frame(model: &Model, from: u64, number: u64) -> Read<Frame> {
    let wanted = "a placement";
    model.instance(from, number)?;
    let flat = model.record(number, "AXIS2_PLACEMENT_2D");
    let solid = model.record(number, "AXIS2_PLACEMENT_3D").or_else(|| model.record(number, "AXIS1_PLACEMENT"));
    let Some(attributes) = flat.or(solid) else {
        return Err(model.fault(from, Why::Unexpected { number, wanted }));
    };
    let origin = model.point(number, attributes.reference(1, "location: a point")?)?;
    let direction = |index: usize| match attributes.value(index) {
        Some(Value::Reference(direction)) => model.direction(number, *direction).map(Some),
        _ => Ok(None),
    };
    let (z, x) = if flat.is_some() { (None, direction(2)?) } else { (direction(2)?, direction(3)?) };
    let z = z.unwrap_or(DVec3::Z);
    // What the standard takes where no direction is given: x, or y where the axis is x.
    let usual = if z.cross(DVec3::X).length() > 1e-9 * z.length() { DVec3::X } else { DVec3::Y };
    Frame::new(origin, z, x.unwrap_or(usual)).ok_or_else(|| attributes.unusable("axes: two directions that differ"))
}

/// From the coordinates of a frame to those around it.
pub fn affine(frame: &Frame, unit: f64) -> DAffine3 {
    DAffine3::from_mat3_translation(DMat3::from_cols(frame.x, frame.y, frame.z), frame.origin * unit)
}

/// The target of a MAPPED_ITEM: a placement, or an operator that may scale too. `unit` is that of its lengths (m).
pub fn target(model: &Model, from: u64, number: u64, unit: f64) -> Read<DAffine3> {
    // Name, description, axis1, axis2, local_origin, scale, axis3: complex ones hold them in CARTESIAN_TRANSFORMATION_OPERATOR.
    let Some(operator) = model.record(number, "CARTESIAN_TRANSFORMATION_OPERATOR_3D") else {
        return frame(model, from, number).map(|frame| affine(&frame, unit));
    };
    let direction = |index: usize, usual: DVec3| match operator.value(index) {
        Some(Value::Reference(direction)) => model.direction(number, *direction),
        _ => Ok(usual),
    };
    // The simple instance has one name or two before its attributes.
    let first = operator.len().checked_sub(5).ok_or_else(|| operator.unusable("attributes: axes, origin and scale"))?;
    let (x, y) = (direction(first, DVec3::X)?, direction(first + 1, DVec3::Y)?);
    let origin = model.point(number, operator.reference(first + 2, "origin: a point")?)?;
    let scale = match operator.value(first + 3) {
        Some(Value::Omitted) => 1.0,
        _ => operator.positive(first + 3, "scale: a number greater than 0")?,
    };
    let z = direction(first + 4, x.cross(y))?;
    let frame = Frame::new(origin, z, x).ok_or_else(|| operator.unusable("axes: directions that differ"))?;
    Ok(affine(&frame, unit) * DAffine3::from_scale(DVec3::splat(scale)))
}
