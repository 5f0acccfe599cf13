//! `[[body]]` → [`RigidSpec`].

use super::at::{At, Range};
use super::raw::{RawBody, RawBodyShape};
use super::resolve_materials::Materials;
use super::rigid::{RigidMotion, RigidShape, RigidSpec};
use crate::base::error::Result;
use crate::base::units::{self, Dimension};
use glam::DVec3;

/// Resolves all `[[body]]`; `friction` is that of those that give none (-).
pub(super) fn rigids(at: &At, raw: &[RawBody], materials: &Materials, friction: f64) -> Result<Vec<RigidSpec>> {
    let mut all: Vec<RigidSpec> = Vec::with_capacity(raw.len());
    for (index, raw) in raw.iter().enumerate() {
        let here = at.element(index);
        let one = rigid(&here, raw, index, materials, friction)?;
        if all.iter().any(|before| before.name == one.name) {
            let what = format!("two bodies are named {:?}", one.name);
            return Err(here.key("name").error(what, "give each its own name"));
        }
        all.push(one);
    }
    Ok(all)
}

fn rigid(at: &At, raw: &RawBody, index: usize, materials: &Materials, friction: f64) -> Result<RigidSpec> {
    at.refuse("mass", &raw.mass, "is not supported: a body stands still or moves as `velocity` and `spin` say")?;
    at.refuse("groove_radius", &raw.groove_radius, "is not supported: a cylinder has no groove")?;
    let motion = motion(at, raw)?;
    let shape = shape(at, raw, motion.spin != 0.0)?;
    let example = "[\"0 mm\", \"0 mm\", \"5 mm\"]";
    let position = raw.position.as_ref().ok_or_else(|| at.missing("position", example))?;
    let (material_name, material) = materials.elastic(at, raw.material.as_ref())?;
    let name = raw.name.clone().unwrap_or_else(|| format!("body {}", index + 1));
    if name.trim().is_empty() {
        return Err(at.key("name").error("`name` is empty", "for example name = \"pin\""));
    }
    Ok(RigidSpec {
        name,
        shape,
        position: at.key("position").vector(position, Dimension::Length)?,
        motion,
        material_name,
        material,
        friction: at.ratio_or("friction", &raw.friction, friction, Range::NotNegative)?,
    })
}

/// `spins`: whether it does, for a sphere needs an axis then and has no use for one otherwise.
fn shape(at: &At, raw: &RawBody, spins: bool) -> Result<RigidShape> {
    let direction = |name: &str, given: &Option<_>| -> Result<DVec3> {
        let raw = given.as_ref().ok_or_else(|| at.missing(name, "[0, 1, 0]"))?;
        let vector = at.key(name).vector(raw, Dimension::Ratio)?;
        match vector.length().is_normal() {
            true => Ok(vector),
            false => Err(at.key(name).error(format!("`{name}` has no direction"), "for example [0, 1, 0]")),
        }
    };
    let diameter = || at.required("diameter", &raw.diameter, Dimension::Length, Range::Positive);
    let shape = raw.shape.ok_or_else(|| at.missing("shape", "\"cylinder\""))?;
    if shape != RawBodyShape::Plane {
        at.refuse("normal", &raw.normal, "belongs to a plane only")?;
    }
    if shape != RawBodyShape::Cylinder {
        at.refuse("length", &raw.length, "belongs to a cylinder only")?;
    }
    match shape {
        RawBodyShape::Plane => {
            at.refuse("axis", &raw.axis, "does not belong to a plane, which takes normal")?;
            at.refuse("diameter", &raw.diameter, "does not belong to a plane, which has no end")?;
            Ok(RigidShape::Plane { normal: direction("normal", &raw.normal)? })
        }
        RawBodyShape::Cylinder => Ok(RigidShape::Cylinder {
            axis: direction("axis", &raw.axis)?,
            diameter: diameter()?,
            length: at.optional("length", &raw.length, Dimension::Length, Range::Positive)?,
        }),
        RawBodyShape::Sphere => {
            if !spins {
                at.refuse("axis", &raw.axis, "has no effect on a sphere without `spin`")?;
            }
            let axis = if spins { direction("axis", &raw.axis)? } else { DVec3::Z };
            Ok(RigidShape::Sphere { axis, diameter: diameter()? })
        }
    }
}

fn motion(at: &At, raw: &RawBody) -> Result<RigidMotion> {
    let motion = RigidMotion {
        velocity: at.vector_or_zero("velocity", &raw.velocity, Dimension::Velocity)?,
        spin: at.optional("spin", &raw.spin, Dimension::AngularVelocity, Range::Any)?.unwrap_or(0.0),
        ramp: at.optional("ramp", &raw.ramp, Dimension::Time, Range::NotNegative)?.unwrap_or(0.0),
        duration: at.optional("duration", &raw.duration, Dimension::Time, Range::Positive)?,
    };
    if !motion.moves() {
        let why = "has no effect on a body without `velocity` and `spin`";
        if motion.ramp > 0.0 {
            return Err(at.key("ramp").refused(why));
        }
        at.refuse("duration", &raw.duration, why)?;
        at.refuse("travel", &raw.travel, why)?;
    }
    let duration = match at.optional("travel", &raw.travel, Dimension::Length, Range::Positive)? {
        None => motion.duration,
        Some(travel) => Some(duration_of(at, raw, &motion, travel)?),
    };
    let shown = |time: f64| units::format(time, Dimension::Time);
    match duration {
        Some(duration) if raw.travel.is_none() && duration < 2.0 * motion.ramp => {
            let what = format!("`duration` is {}, less than the two ramps of {}", shown(duration), shown(motion.ramp));
            Err(at.key("duration").error(what, format!("at least {}", shown(2.0 * motion.ramp))))
        }
        _ => Ok(RigidMotion { duration, ..motion }),
    }
}

/// When a body that is to move by `travel` (m) stands still again (s): at full speed it would take one ramp less.
fn duration_of(at: &At, raw: &RawBody, motion: &RigidMotion, travel: f64) -> Result<f64> {
    at.refuse("duration", &raw.duration, "and `travel` both say when the motion ends")?;
    let speed = motion.velocity.length();
    if speed == 0.0 {
        return Err(at.key("travel").refused("has no effect without `velocity`"));
    }
    let least = speed * motion.ramp;
    if travel < least {
        let shown = |way: f64| units::format(way, Dimension::Length);
        let what = format!("`travel` is {}, but the two ramps alone take {}", shown(travel), shown(least));
        return Err(at.key("travel").error(what, "take a shorter `ramp`, or move further"));
    }
    Ok(travel / speed + motion.ramp)
}
