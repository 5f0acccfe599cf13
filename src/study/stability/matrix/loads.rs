//! Pull speeds, sudden stop, compression, torsion, cycles, breaking, rest.

use super::super::case::{Base, StabilityCase};
use super::super::measure::{
    buckled, cycled_alike, cycled_plastic, no_drift, peak_is_yield, pulled_strand, stopped_wave, turned,
};
use super::scenes::{COLUMN, REST, SEVEN, WIRE};
use crate::base::finding::FindingKind;

/// What must be said of crushed contacts.
const DEEP: &[FindingKind] = &[FindingKind::DeepContact];

/// The cases of this file.
pub fn cases() -> Vec<StabilityCase> {
    [speeds(), compression(), torsion(), cycles(), breaking(), grips(), rest()].concat()
}

fn rest() -> Vec<StabilityCase> {
    ["sphere", "wire"]
        .map(|shape| {
            StabilityCase::new(
                format!("rest-{shape}"),
                format!(
                    "10⁷ steps at rest: a wire pressed on another and pushed within friction, contact shape {shape}"
                ),
                REST,
            )
            .set([format!("contact.shape={shape}")])
            .quick(["stop.steps=600000"])
            .long()
            .gives(no_drift)
        })
        .to_vec()
}

fn cycles() -> Vec<StabilityCase> {
    let cyclic = ["grip.speed=", "stop.strain="];
    vec![
        // Short, so that its wires' own bending is ten times as fast as the cycles.
        StabilityCase::new("cycles-strand", "1,000 cycles of an elastic strand with rubbing wires, ± 0.08 %", SEVEN)
            .set(cyclic)
            .set(["strand.length=6 mm", "grip.length=1 mm", "grip.displacement_amplitude=3.2 um"])
            .set(["grip.frequency=8 kHz", "stop.time=125 ms", "output.samples=40000"])
            .quick(["stop.time=4 ms", "output.samples=1280"])
            .long()
            .gives(cycled_alike),
        StabilityCase::new("cycles-plastic", "1,000 cycles of a perfectly plastic wire, ± 0.15 %", WIRE)
            .set(cyclic)
            .set(["bond.hardening.saturation=0 MPa", "bond.hardening.linear=0 MPa"])
            .set(["grip.displacement_amplitude=0.012 mm"])
            .set(["grip.frequency=4 kHz", "stop.time=250 ms", "output.samples=40000"])
            .quick(["stop.time=2.5 ms", "output.samples=400"])
            .long()
            .gives(cycled_plastic),
    ]
}

fn speeds() -> Vec<StabilityCase> {
    let pulled = |speed: f64, about: &str| {
        StabilityCase::new(format!("speed-{speed}"), format!("pulled at {speed} m/s{about}"), SEVEN)
            .set([format!("grip.speed={speed} m/s")])
    };
    let thrown = [
        "grip=",
        "bond.law=elastic",
        "bond.hardening=",
        "bond.damping=0.3",
        r#"wire.0.velocity=["0 m/s", "0 m/s", "-5 m/s"]"#,
        r#"wire.0.to=["0 mm", "0 mm", "80 mm"]"#,
        r#"hold=[{ body = 0, part = "start", fix = ["x", "y", "z", "rx", "ry", "rz"] }]"#,
        "stop.strain=",
        "stop.time=60 us",
    ];
    let fast = &[FindingKind::TooShort];
    vec![
        pulled(0.1, "").quick(["stop.strain=1 %"]).gives(pulled_strand),
        pulled(1.0, "").gives(pulled_strand),
        pulled(10.0, "").gives(pulled_strand),
        pulled(100.0, ", near the speed of plastic waves").finds(fast),
        pulled(300.0, ", above the speed of plastic waves").finds(fast),
        StabilityCase::new("sudden-stop", "an elastic wire flying at 5 m/s whose front end is stopped dead", WIRE)
            .set(thrown)
            .gives(stopped_wave),
        StabilityCase::new("sudden-stop-strand", "seven wires that fly at 100 m/s and are stopped dead at one end", SEVEN).set([
            "grip=",
            "strand=",
            "stop.strain=",
            "stop.time=0.1 ms",
            "contact.hardness_strain=8 %",
            r#"wire=[{ diameter = "0.4 mm", from = ["0 mm", "0 mm", "0 mm"], to = ["0 mm", "0 mm", "8 mm"], velocity = ["0 m/s", "0 m/s", "-100 m/s"] }, { diameter = "0.4 mm", from = ["0.4 mm", "0 mm", "0 mm"], to = ["0.4 mm", "0 mm", "8 mm"], velocity = ["0 m/s", "0 m/s", "-100 m/s"] }]"#,
            r#"hold=[{ body = 0, part = "start", fix = ["x", "y", "z", "rx", "ry", "rz"] }]"#,
        ]),
    ]
}

fn compression() -> Vec<StabilityCase> {
    vec![
        StabilityCase::new("buckling", "a column shortened to a quarter of its length beyond buckling", COLUMN)
            .set([r#"hold.1.velocity=["0 m/s", "0 m/s", "-0.1 m/s"]"#, "stop.time=60 ms"])
            .gives(buckled),
        StabilityCase::new("compressed-strand", "seven wires compressed by 20 %: they bulge, buckle and knot", SEVEN)
            .set(["grip.speed=-2 m/s", "stop.strain=20 %"]),
        StabilityCase::new("compressed-wires", "the same with smooth wires", SEVEN).set([
            "grip.speed=-2 m/s",
            "stop.strain=20 %",
            "contact.shape=wire",
        ]),
    ]
}

fn torsion() -> Vec<StabilityCase> {
    let ten = ["grip.speed=0 m/s", "grip.rotation_rate=5000 rad/s", "stop.strain=", "stop.time=12.566 ms"];
    let four = [r#"wire.0.to=["0 mm", "0 mm", "4 mm"]"#];
    vec![
        StabilityCase::new("torsion-perfect", "ten turns of a perfectly plastic wire of ten diameters", WIRE)
            .set(ten)
            .set(four)
            .set(["bond.hardening.saturation=0 MPa", "bond.hardening.linear=0 MPa"])
            .gives(turned),
        StabilityCase::new("torsion-hardening", "ten turns of a hardening wire", WIRE).set(ten).set(four).gives(turned),
        StabilityCase::new(
            "torsion-strand",
            "ten turns of seven wires, chains of spheres: wrung until wires slip through",
            SEVEN,
        )
        .set(ten)
        .passes_through(),
        StabilityCase::new("torsion-unlay", "ten turns of seven wires against their lay, chains of spheres", SEVEN)
            .set(ten)
            .set(["grip.rotation_rate=-5000 rad/s"])
            .passes_through(),
        StabilityCase::new("torsion-smooth", "two turns of seven smooth wires", SEVEN)
            .set(ten)
            .set(["contact.shape=wire", "stop.time=2.513 ms"]),
    ]
}

fn breaking() -> Vec<StabilityCase> {
    let at = |strain: &str| format!(r#"bond.rupture={{ criterion = "plastic-strain", strain = "{strain}" }}"#);
    let brittle = r#"bond.rupture={ criterion = "beam-stress", tensile = "0.001 MPa", shear = "0.001 MPa" }"#;
    let mut cases = vec![
        StabilityCase::new("broken-at-once", "every bond breaks at the first pull", SEVEN)
            .set([brittle, "stop.strain=20 %"]),
        StabilityCase::new("broken-together", "every bond breaks at one plastic strain, without scatter", SEVEN)
            .set([at("2 %"), "stop.strain=20 %".into()]),
    ];
    for shape in ["sphere", "wire"] {
        cases.push(
            StabilityCase::new(
                format!("after-the-break-{shape}"),
                format!("pulled to twice its length, long after the last wire has gone, contact shape {shape}"),
                SEVEN,
            )
            .set([
                r#"bond.rupture={ criterion = "plastic-strain", strain = "4 %", weibull_modulus = 20 }"#.to_string(),
                "stop.strain=100 %".into(),
                format!("contact.shape={shape}"),
            ])
            .quick(["stop.strain=20 %"]),
        );
        cases.push(
            StabilityCase::new(
                format!("stretched-{shape}"),
                format!("a soft strand pulled to more than twice its length, contact shape {shape}"),
                SEVEN,
            )
            .set([
                "bond.hardening={ form = \"voce\", yield_stress = \"100 MPa\", linear = \"1000 MPa\" }".to_string(),
                "stop.strain=120 %".into(),
                "grip.speed=5 m/s".into(),
                format!("contact.shape={shape}"),
            ])
            .quick(["stop.strain=40 %"])
            .gives(pulled_strand),
        );
        cases.push(
            StabilityCase::new(
                format!("broken-fine-{shape}"),
                format!("particles a quarter diameter apart, pulled until all wires break, contact shape {shape}"),
                SEVEN,
            )
            .set([at("3 %"), "spacing=0.25".into(), "stop.strain=8 %".into(), format!("contact.shape={shape}")])
            .quick([at("0.5 %"), "stop.strain=1 %".into()]),
        );
    }
    cases
}

fn grips() -> Vec<StabilityCase> {
    let jaw = |name: &str, about: &str, pressure: &str| {
        StabilityCase::new(name, about, Base::Builtin("jaw-grip")).set([
            "strand.length=14 mm".to_string(),
            "grip.length=3 mm".into(),
            "grip.speed=1 m/s".into(),
            format!("grip.clamp_pressure={pressure}"),
            "stop.strain=3 %".into(),
            "stop.stress_fraction=".into(),
        ])
    };
    vec![
        jaw("jaw-100MPa", "KA4 in a jaw of 100 MPa", "100 MPa").finds(DEEP),
        jaw("jaw-3GPa", "KA4 in a jaw of 3 GPa, which crushes it", "3 GPa").passes_through(),
        StabilityCase::new("jaw-slips", "seven wires whose core is held by friction alone, without friction", SEVEN)
            .set(["grip.kind=jaw", "grip.clamp_pressure=100 MPa", "contact.friction=0"]),
        StabilityCase::new("grip-still", "grips that do not move", SEVEN).set([
            "grip.speed=0 m/s",
            "stop.strain=",
            "stop.time=0.2 ms",
        ]),
        StabilityCase::new(
            "yield-at-once",
            "a perfectly plastic wire that each step strains by seventy times its yield strain",
            WIRE,
        )
        .set([
            "bond.hardening.yield_stress=0.001 MPa",
            "bond.hardening.saturation=0 MPa",
            "bond.hardening.linear=0 MPa",
            "bond.damping=0",
            "grip.speed=0.05 m/s",
            "stop.strain=2 %",
        ])
        .gives(peak_is_yield),
    ]
}
