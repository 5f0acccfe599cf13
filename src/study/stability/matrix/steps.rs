//! The critical time step against the predicted bound.

use super::super::case::{Base, Critical, StabilityCase};
use super::scenes::{LIGHT_ON_HEAVY, SEVEN};

const CHAIN: Base = Base::Builtin("verify/chain");
const FREE_WIRE: Base = Base::Builtin("verify/free-wire");
const VIBRATION: Base = Base::Builtin("verify/free-vibration");
const CROSSING: Base = Base::Builtin("verify/crossing-wires");

/// The cases of this file.
pub fn cases() -> Vec<StabilityCase> {
    let near = Critical { within: Some(0.2), ..Critical::ELASTIC };
    let gentle = [r#"wire.0.spin=["2 rad/s", "1 rad/s", "-1 rad/s"]"#, "stop.steps=4000"];
    let short = [r#"wire.0.to=["0 mm", "0 mm", "6 mm"]"#, "stop.time=", "stop.steps=4000"];
    let pulled = ["stop.strain=0.5 %"];
    let mut cases = vec![
        StabilityCase::new("step-chain", "critical step of an axial chain", CHAIN).critical(near),
        StabilityCase::new("step-bent", "critical step of a bent wire, clamped at one end", VIBRATION)
            .set(short)
            .critical(near),
        StabilityCase::new("step-bent-fine", "the same with particles d/4 apart", VIBRATION)
            .set(short)
            .set(["spacing=0.25"])
            .critical(near),
        StabilityCase::new("step-bent-coarse", "the same with particles 4 d apart", VIBRATION)
            .set([r#"wire.0.to=["0 mm", "0 mm", "24 mm"]"#, "stop.time=", "stop.steps=4000", "spacing=4"])
            .critical(near),
        StabilityCase::new("step-free", "critical step of a free wire, bent and twisted", FREE_WIRE)
            .set(gentle)
            .critical(near),
        StabilityCase::new("step-damped", "critical step of a bent wire damped by 0.3 of critical", VIBRATION)
            .set(short)
            .set(["bond.damping=0.3"])
            .critical(Critical::ELASTIC),
        StabilityCase::new(
            "step-ka4",
            "critical step of KA4 in full contact, 6 mm long, pulled by 6 %",
            Base::Builtin("ka4"),
        )
        .set(["strand.length=6 mm", "grip.length=1 mm", "grip.speed=4 m/s", "stop.strain=6 %", "stop.stress_fraction="])
        .quick(["stop.strain=1 %"])
        .critical(Critical::DISSIPATIVE),
        StabilityCase::new(
            "step-mass-ratio",
            "critical step with a sphere between two of a million times its mass; the bound resolves its bounces",
            LIGHT_ON_HEAVY,
        )
        .critical(Critical::ELASTIC),
    ];
    for (name, young) in [("step-hard-10x", "1150 GPa"), ("step-hard-1000x", "115000 GPa")] {
        cases.push(
            StabilityCase::new(
                name,
                format!("critical step of seven wires with hard elastic contacts, E = {young}"),
                SEVEN,
            )
            .set(pulled)
            .set(["contact.normal=hertz", "contact.hardness_strain=", "bond.law=elastic", "bond.hardening="])
            .set([format!("material.young={young}")])
            .critical(Critical::DISSIPATIVE),
        );
    }
    for shape in ["sphere", "wire"] {
        cases.push(
            StabilityCase::new(
                format!("step-crossing-{shape}"),
                format!("critical step of two wires that collide crosswise, contact shape {shape}"),
                CROSSING,
            )
            .set([format!("contact.shape={shape}")])
            .critical(Critical::DISSIPATIVE),
        );
    }
    cases
}
