//! What moves and what ends a scene: grips, holds, stop.

use super::at::{At, Range};
use super::raw::{RawAdaptive, RawGrip, RawGripKind, RawHold, RawPart, RawStop};
use super::spec::{AdaptiveSpec, BodyPart, DriveSpec, GripKind, GripSpec, HoldSpec, StopSpec};
use crate::base::error::Result;
use crate::base::units::{self, Dimension};
use glam::DVec3;

/// Resolves `[grip]`; `extent` is the length along z of what it holds (m).
pub(super) fn grip(at: &At, raw: &RawGrip, extent: Option<f64>) -> Result<GripSpec> {
    let length = at.required("length", &raw.length, Dimension::Length, Range::Positive)?;
    let Some(extent) = extent else {
        return Err(at.error("the grips have nothing to hold", "grips hold a [strand] or [[wire]]s"));
    };
    if 2.0 * length >= extent {
        let body = units::format(extent, Dimension::Length);
        let what = format!("two grips of this length leave nothing of a body of {body}");
        return Err(at.key("length").error(what, "the gauge length is the body's length less both grips"));
    }
    let rotation = at.optional("rotation_rate", &raw.rotation_rate, Dimension::AngularVelocity, Range::Any)?;
    let free_rotation = raw.free_rotation.unwrap_or(false);
    if free_rotation && rotation.is_some_and(|rate| rate != 0.0) {
        return Err(at.key("rotation_rate").refused("has no effect beside `free_rotation = true`"));
    }
    let drive = drive(at, raw)?;
    Ok(GripSpec {
        kind: grip_kind(at, raw)?,
        length,
        drive,
        adaptive: raw.adaptive.as_ref().map(|raw| adaptive(at, raw, drive)).transpose()?,
        rotation_rate: rotation.unwrap_or(0.0),
        free_rotation,
    })
}

fn grip_kind(at: &At, raw: &RawGrip) -> Result<GripKind> {
    match raw.kind.unwrap_or(RawGripKind::All) {
        RawGripKind::All => {
            at.refuse("clamp_pressure", &raw.clamp_pressure, "belongs to kind = \"jaw\" only")?;
            Ok(GripKind::All)
        }
        RawGripKind::Jaw => Ok(GripKind::Jaw {
            pressure: at.required("clamp_pressure", &raw.clamp_pressure, Dimension::Pressure, Range::Positive)?,
        }),
    }
}

fn drive(at: &At, raw: &RawGrip) -> Result<DriveSpec> {
    if let Some(speed) = at.optional("speed", &raw.speed, Dimension::Velocity, Range::Any)? {
        let why = "has no effect beside `speed`";
        at.refuse("displacement_amplitude", &raw.displacement_amplitude, why)?;
        at.refuse("frequency", &raw.frequency, why)?;
        return Ok(DriveSpec::Speed(speed));
    }
    if raw.displacement_amplitude.is_none() && raw.frequency.is_none() {
        return Err(at.missing("speed", "\"5 m/s\", or displacement_amplitude and frequency"));
    }
    Ok(DriveSpec::Cyclic {
        amplitude: at.required(
            "displacement_amplitude",
            &raw.displacement_amplitude,
            Dimension::Length,
            Range::Positive,
        )?,
        frequency: at.required("frequency", &raw.frequency, Dimension::Frequency, Range::Positive)?,
    })
}

/// Resolves `grip.adaptive` of a grip that is driven so.
fn adaptive(at: &At, raw: &RawAdaptive, drive: DriveSpec) -> Result<AdaptiveSpec> {
    let at = at.key("adaptive");
    let DriveSpec::Speed(slow) = drive else {
        return Err(at.refused("has no effect without `speed`"));
    };
    if slow <= 0.0 {
        return Err(at.refused("is for a pull: `speed` must be above zero"));
    }
    let fastest = at.required("fastest", &raw.fastest, Dimension::Velocity, Range::Positive)?;
    let usual = AdaptiveSpec::new(0.0, fastest);
    let adaptive = AdaptiveSpec {
        from: at.ratio_or("from", &raw.from, usual.from, Range::NotNegative)?,
        fastest,
        kinetic: at.ratio_or("kinetic", &raw.kinetic, usual.kinetic, Range::Fraction)?,
        passages: at.ratio_or("passages", &raw.passages, usual.passages, Range::Positive)?,
    };
    match slower_than_the_drive(&adaptive, drive) {
        Some((what, help)) => Err(at.key("fastest").error(what, help)),
        None => Ok(adaptive),
    }
}

/// What is wrong, and what would be right, where an adaptive pull may not even be as fast as it begins.
pub(super) fn slower_than_the_drive(adaptive: &AdaptiveSpec, drive: DriveSpec) -> Option<(String, &'static str)> {
    let DriveSpec::Speed(slow) = drive else { return None };
    (adaptive.fastest < slow).then(|| {
        let [fastest, slow] = [adaptive.fastest, slow].map(|speed| units::format(speed, Dimension::Velocity));
        let what = format!("`fastest` is {fastest}, but the pull begins at `speed`, {slow}");
        (what, "make it greater than grip.speed")
    })
}

/// Resolves all `[[hold]]` of a scene with this many bodies.
pub(super) fn holds(at: &At, raw: &[RawHold], bodies: usize) -> Result<Vec<HoldSpec>> {
    raw.iter().enumerate().map(|(index, raw)| hold(&at.element(index), raw, bodies)).collect()
}

fn hold(at: &At, raw: &RawHold, bodies: usize) -> Result<HoldSpec> {
    let body = raw.body.ok_or_else(|| at.missing("body", "0"))?;
    let body = at.key("body").count(body, 0)? as usize;
    if body >= bodies {
        let what = format!("there is no body {body}: the scene has {bodies}, numbered from 0 (from 1 in results)");
        return Err(at.key("body").error(what, "strand wires come first, inside out, then [[wire]], then [[sphere]]"));
    }
    let mut fixed = [false; 6];
    raw.fix.iter().for_each(|component| fixed[*component as usize] = true);
    let hold = HoldSpec {
        body,
        part: match raw.part.unwrap_or(RawPart::All) {
            RawPart::Start => BodyPart::Start,
            RawPart::End => BodyPart::End,
            RawPart::All => BodyPart::All,
        },
        fixed,
        velocity: at.vector_or_zero("velocity", &raw.velocity, Dimension::Velocity)?,
        spin: at.vector_or_zero("spin", &raw.spin, Dimension::AngularVelocity)?,
        force: at.vector_or_zero("force", &raw.force, Dimension::Force)?,
        moment: at.vector_or_zero("moment", &raw.moment, Dimension::Moment)?,
        ramp: at.optional("ramp", &raw.ramp, Dimension::Time, Range::NotNegative)?.unwrap_or(0.0),
    };
    refuse_idle(at, &hold)?;
    Ok(hold)
}

/// Refuses what would have no effect: motion of a free component, load on a prescribed one, a hold that does nothing.
fn refuse_idle(at: &At, hold: &HoldSpec) -> Result<()> {
    const NAMES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];
    let checks: [(&str, DVec3, usize, bool); 4] = [
        ("velocity", hold.velocity, 0, true),
        ("spin", hold.spin, 3, true),
        ("force", hold.force, 0, false),
        ("moment", hold.moment, 3, false),
    ];
    for (key, vector, first, needs_fix) in checks {
        for axis in 0..3 {
            if vector[axis] == 0.0 || hold.fixed[first + axis] == needs_fix {
                continue;
            }
            let component = NAMES[first + axis];
            let (what, help) = match needs_fix {
                true => (
                    format!("`{key}` moves {component}, which is not prescribed"),
                    format!("add \"{component}\" to `fix`"),
                ),
                false => (
                    format!("`{key}` loads {component}, which is prescribed"),
                    format!("take \"{component}\" out of `fix`, or the load away"),
                ),
            };
            return Err(at.key(key).element(axis).error(what, help));
        }
    }
    let unloaded = hold.force == DVec3::ZERO && hold.moment == DVec3::ZERO;
    if hold.ramp > 0.0 && unloaded {
        return Err(at.key("ramp").refused("has no effect without `force` or `moment`"));
    }
    let idle = hold.fixed == [false; 6] && unloaded;
    match idle {
        true => Err(at.error("this hold neither prescribes nor loads anything", "give `fix`, `force` or `moment`")),
        false => Ok(()),
    }
}

/// Resolves `[stop]`.
pub(super) fn stop(at: &At, raw: &RawStop, grip: Option<&GripSpec>, breaks: bool) -> Result<StopSpec> {
    if grip.is_none() {
        let why = "needs a [grip], which this scene does not have";
        at.refuse("strain", &raw.strain, why)?;
        at.refuse("stress_fraction", &raw.stress_fraction, why)?;
        at.refuse("strain_after_drop", &raw.strain_after_drop, why)?;
    }
    if !breaks {
        let why = "never holds: no bond of this scene can break";
        at.refuse("stress_fraction", &raw.stress_fraction, why)?;
        at.refuse("strain_after_drop", &raw.strain_after_drop, why)?;
    }
    let stop = StopSpec {
        strain: at.optional("strain", &raw.strain, Dimension::Ratio, Range::Positive)?,
        stress_fraction: at.optional("stress_fraction", &raw.stress_fraction, Dimension::Ratio, Range::Fraction)?,
        strain_after_drop: at.optional(
            "strain_after_drop",
            &raw.strain_after_drop,
            Dimension::Ratio,
            Range::Positive,
        )?,
        time: at.optional("time", &raw.time, Dimension::Time, Range::Positive)?,
        steps: raw.steps.map(|steps| at.key("steps").count(steps, 1)).transpose()?,
    };
    if stop == StopSpec::default() {
        let help = "add [stop] with strain, stress_fraction, strain_after_drop, time or steps";
        return Err(at.error("the scene does not say when to stop", help));
    }
    let still = grip.is_some_and(|grip| grip.drive == DriveSpec::Speed(0.0));
    if still && stop.time.is_none() && stop.steps.is_none() {
        return Err(
            at.error("the grips do not move apart, so this scene would never stop", "add time or steps to [stop]")
        );
    }
    Ok(stop)
}
