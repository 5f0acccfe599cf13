//! Stiffness, hardening, yield stress, friction, damping.

use super::super::case::StabilityCase;
use super::super::measure::{no_friction, peak_is_yield, pulled_strand, pulled_wire};
use super::scenes::{SEVEN, WIRE};
use crate::base::finding::FindingKind;

/// The cases of this file.
pub fn cases() -> Vec<StabilityCase> {
    [stiffness(), hardening(), yields(), friction(), damping()].concat()
}

fn stiffness() -> Vec<StabilityCase> {
    let case = |name: &str, about: &str, young: &str| {
        StabilityCase::new(name, about, SEVEN).set([format!("material.young={young}")]).gives(pulled_strand)
    };
    vec![
        case("base", "seven copper wires pulled by 5 %, the base of what follows", "115 GPa"),
        case("stiff-1000x", "Young's modulus a thousand times copper's", "115000 GPa").quick(["stop.strain=0.5 %"]),
        // Without a stiffer matter, waves are slow; the pull stays as slow against them.
        case("soft-1000x", "Young's modulus a thousandth of copper's", "0.115 GPa").set(["grip.speed=0.1 m/s"]),
    ]
}

fn hardening() -> Vec<StabilityCase> {
    let perfect = ["bond.hardening.saturation=0 MPa", "bond.hardening.linear=0 MPa"];
    let falling = r#"bond.hardening={ form = "table", points = [[0, "100 MPa"], [0.2, "60 MPa"]] }"#;
    vec![
        StabilityCase::new("hardening-0-wire", "a perfectly plastic wire", WIRE)
            .set(perfect)
            .finds(&[FindingKind::Necking])
            .gives(peak_is_yield),
        StabilityCase::new("hardening-0-strand", "seven perfectly plastic wires", SEVEN)
            .set(perfect)
            .finds(&[FindingKind::Necking]),
        StabilityCase::new("hardening-1000x", "a wire that hardens a thousand times more", WIRE)
            .set(["bond.hardening.linear=543600 MPa", "bond.hardening.saturation=0 MPa"])
            .gives(pulled_wire),
        StabilityCase::new("softening", "true stress that falls with plastic strain", WIRE).set([falling]).refused(),
        StabilityCase::new("softening-linear", "a negative hardening slope", WIRE)
            .set(["bond.hardening.linear=-100 MPa"])
            .refused(),
    ]
}

fn yields() -> Vec<StabilityCase> {
    let scaled = |name: &str, about: &str, share: f64| {
        StabilityCase::new(name, about, SEVEN)
            .set([
                format!("bond.hardening.yield_stress={} MPa", 100.0 * share),
                format!("bond.hardening.saturation={} MPa", 177.9 * share),
                format!("bond.hardening.linear={} MPa", 543.6 * share),
            ])
            .gives(pulled_strand)
    };
    vec![
        // The wires' inertia counts against so little stress: pulled a hundred times more slowly, it does not.
        scaled("yield-0.1%", "a thousandth of copper's yield stress and hardening", 1e-3)
            .set(["grip.speed=0.05 m/s"])
            .quick(["stop.strain=1 %"]),
        scaled("yield-1000%", "ten times copper's yield stress and hardening", 10.0),
    ]
}

fn friction() -> Vec<StabilityCase> {
    let mut cases = Vec::new();
    for shape in ["sphere", "wire"] {
        for value in [0.0, 0.2, 1.0, 10.0] {
            let case = StabilityCase::new(
                format!("friction-{value}-{shape}"),
                format!("friction coefficient {value}, contact shape {shape}"),
                SEVEN,
            )
            .set([format!("contact.friction={value}"), format!("contact.shape={shape}")]);
            cases.push(case.gives(if value == 0.0 { no_friction } else { pulled_strand }));
        }
    }
    cases
}

fn damping() -> Vec<StabilityCase> {
    [0.0, 0.02, 0.3, 1.0, 3.0]
        .map(|value| {
            StabilityCase::new(
                format!("damping-{value}"),
                match value {
                    1.0 => "critical damping of bonds and contacts".into(),
                    _ => format!("bonds and contacts damped by {value} of critical"),
                },
                SEVEN,
            )
            .set([format!("bond.damping={value}"), format!("contact.damping={value}")])
            .quick(["stop.strain=2 %"])
            .gives(pulled_strand)
        })
        .to_vec()
}
