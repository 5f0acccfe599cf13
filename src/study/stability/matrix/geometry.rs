//! Spacing, diameter, pitch, number of wires, overlap at the start.

use super::super::case::{Base, StabilityCase};
use super::super::measure::{pulled_layers, pulled_strand, pulled_wire, thrown_apart};
use super::scenes::{SEVEN, WIRE, mm};
use crate::base::finding::FindingKind;

/// The cases of this file.
pub fn cases() -> Vec<StabilityCase> {
    [spacing(), diameter(), pitch(), numbers(), overlap()].concat()
}

fn spacing() -> Vec<StabilityCase> {
    let mut cases = Vec::new();
    for shape in ["sphere", "wire"] {
        // Smooth wires do not follow a pitch of 45 mm with particles 4 diameters apart: they lie in each other.
        let widest = if shape == "wire" { 2.0 } else { 4.0 };
        for value in [0.25, 0.5, 2.0, 4.0].into_iter().filter(|value| *value <= widest) {
            let case = StabilityCase::new(
                format!("spacing-{value}d-{shape}"),
                format!("particles {value} diameters apart, contact shape {shape}"),
                SEVEN,
            )
            .set([format!("spacing={value}"), format!("contact.shape={shape}")])
            .quick(["stop.strain=2 %"]);
            cases.push(match shape {
                "sphere" if value >= 2.0 => case.refused(),
                _ => case.gives(pulled_strand),
            });
        }
    }
    cases
}

/// Everything scaled alike answers alike.
fn diameter() -> Vec<StabilityCase> {
    [0.02, 5.0]
        .map(|d: f64| {
            let scale = d / 0.39;
            StabilityCase::new(format!("wire-{d}mm"), format!("wires of {d} mm, everything else in proportion"), SEVEN)
                .set([
                    format!("strand.wire_diameter={}", mm(d)),
                    format!("strand.length={}", mm(12.0 * scale)),
                    format!("strand.layer.1.pitch={}", mm(12.0 * scale)),
                    format!("grip.length={}", mm(2.0 * scale)),
                ])
                .gives(pulled_strand)
        })
        .to_vec()
}

/// The lay radius of six wires around one is their diameter, 0.39 mm.
fn pitch() -> Vec<StabilityCase> {
    let pitch = |name: &str, about: &str, value: &str| {
        StabilityCase::new(name, about, SEVEN).set([format!("strand.layer.1.pitch={value}")])
    };
    vec![
        pitch("pitch-3r", "pitch three times the lay radius: wires would need more room than there is", "1.17 mm")
            .refused(),
        pitch("pitch-8r", "pitch eight times the lay radius", "3.12 mm").set(["spacing=0.5"]),
        pitch("pitch-16r", "pitch sixteen times the lay radius", "6.24 mm").gives(pulled_strand),
        pitch("pitch-inf", "straight wires side by side", "inf").gives(pulled_strand),
        StabilityCase::new("pitch-3r-spring", "a helix of one wire at three times its lay radius, pulled by half", WIRE).set([
            "wire=",
            r#"strand={ length = "6 mm", wire_diameter = "0.1 mm", layer = [{ wires = 1, lay_radius = "0.5 mm", pitch = "1.5 mm" }] }"#,
            "grip.length=0.5 mm",
            "stop.strain=50 %",
        ]),
    ]
}

fn numbers() -> Vec<StabilityCase> {
    let ka4 = Base::Builtin("ka4");
    let short =
        ["strand.length=12 mm", "grip.length=2 mm", "grip.speed=2 m/s", "stop.strain=5 %", "stop.stress_fraction="];
    let two = r#"strand.layer=[{ name = "outer", wires = 2, pitch = "12 mm" }]"#;
    let many = r#"strand.layer=[{ wires = 1, pitch = "inf" }, { wires = 6, pitch = "40 mm" }, { wires = 12, pitch = "40 mm" }, { wires = 18, pitch = "40 mm" }, { wires = 24, pitch = "40 mm" }, { wires = 30, pitch = "40 mm" }, { wires = 36, pitch = "40 mm" }, { wires = 42, pitch = "40 mm" }, { wires = 31, pitch = "40 mm" }]"#;
    vec![
        StabilityCase::new("wires-1", "one wire", WIRE).gives(pulled_wire),
        StabilityCase::new("wires-2", "two wires around each other", SEVEN).set([two]).gives(pulled_strand),
        StabilityCase::new("wires-7", "one and six smooth wires", SEVEN)
            .set(["contact.shape=wire"])
            .gives(pulled_strand),
        StabilityCase::new("wires-34", "the KA4 strand, 12 mm long", ka4).set(short).gives(pulled_strand),
        StabilityCase::new("wires-200", "200 wires in nine layers", SEVEN).set([many]).gives(pulled_layers),
    ]
}

fn overlap() -> Vec<StabilityCase> {
    let spheres = Base::Builtin("two-spheres");
    let apart = |distance: f64| {
        [
            format!(r#"sphere.0.position=["0 mm", "0 mm", "{} mm"]"#, -0.5 * distance),
            format!(r#"sphere.1.position=["0 mm", "0 mm", "{} mm"]"#, 0.5 * distance),
            r#"sphere.0.velocity=["0 m/s", "0 m/s", "0 m/s"]"#.to_string(),
            r#"sphere.1.velocity=["0 m/s", "0 m/s", "0 m/s"]"#.to_string(),
        ]
    };
    let near_core = |radius: &str| [format!("strand.layer.1.lay_radius={radius}")];
    vec![
        StabilityCase::new("overlap-10%", "two spheres that overlap by a tenth of their diameter", spheres)
            .set(apart(9.0001))
            .set(["contact.normal=hertz", "contact.limiting_pressure="])
            .gives(thrown_apart),
        StabilityCase::new("overlap-11%", "two spheres that overlap by a little more", spheres)
            .set(apart(8.9))
            .refused(),
        StabilityCase::new("overlap-inside", "a sphere placed inside another", spheres).set(apart(1.0)).refused(),
        StabilityCase::new("overlap-same-place", "two spheres in one place", spheres).set(apart(0.0)).refused(),
        StabilityCase::new("overlap-strand", "wires that overlap their core by 8 % of their diameter", SEVEN)
            .set(near_core("0.36 mm"))
            .gives(pulled_strand),
        StabilityCase::new(
            "overlap-strand-hertz",
            "the same with elastic contacts, which throw the wires apart",
            SEVEN,
        )
        .set(near_core("0.36 mm"))
        .set(["contact.normal=hertz", "contact.hardness_strain="])
        .finds(&[FindingKind::DeepContact]),
        StabilityCase::new("overlap-strand-20%", "wires that overlap their core by 20 % of their diameter", SEVEN)
            .set(near_core("0.31 mm"))
            .refused(),
    ]
}
