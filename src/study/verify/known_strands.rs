//! Strands of seven unlike wires whose force and torque the literature gives: nothing here was tuned to them.
//!
//! Force and torque are those of strand theory, which `reference::strand` has and tests against the printed values; the
//! elastic-plastic strand is compared with the forces printed for it.

use super::case::VerificationCase;
use super::comparison::{Comparison, Spent};
use super::support::{Context, set};
use crate::base::error::Result;
use crate::engine::Engine;
use crate::strand::theory::Theory;

pub const UTTING: VerificationCase = VerificationCase {
    name: "strand-utting",
    about: "1x7 strands at lay angles of 9.2, 11.8 and 14.9 degrees: force and torque at 0.1 %",
    source: "strand theory; Utting & Jones, Int. J. Mech. Sci. 29 (1987) 605",
    run: |context| elastic(context, &[utting("148.773 mm"), utting("115.341 mm"), utting("90.559 mm")]),
};

pub const TEXTBOOK: VerificationCase = VerificationCase {
    name: "strand-textbook",
    about: "1x7 strand of 0.206 and 0.202 in at a pitch of 9.75 in: force and torque at 0.3 %",
    source: "Costello, Theory of Wire Rope, 2nd ed. 1997, chapter 3",
    run: |context| {
        elastic(
            context,
            &[Strand {
                young: "196.5005745 GPa",
                poisson: 0.25,
                diameters: ["5.2324 mm", "5.1308 mm"],
                pitch: "247.65 mm",
                strain: 3e-3,
                speed: "0.15 m/s",
            }],
        )
    },
};

pub const GHOREISHI: VerificationCase = VerificationCase {
    name: "strand-ghoreishi",
    about: "1x7 strand of 5.35 and 5.18 mm at a pitch of 230 mm: force and torque at 0.1 %",
    source: "strand theory; Ghoreishi et al., Int. J. Mech. Sci. 49 (2007) 1251",
    run: |context| {
        elastic(
            context,
            &[Strand {
                young: "200 GPa",
                poisson: 0.3,
                diameters: ["5.35 mm", "5.18 mm"],
                pitch: "230 mm",
                strain: 1e-3,
                speed: "0.05 m/s",
            }],
        )
    },
};

pub const JIANG: VerificationCase = VerificationCase {
    name: "strand-jiang",
    about: "1x7 strand that yields, with friction: force at 0.1, 1 and 1.5 %",
    source: "Jiang, Yao & Walton, Int. J. Mech. Sci. 41 (1999) 1233",
    run: yielding,
};

/// The shape that the cases are run with, how finely, and how far off its forces and torques may be (-).
struct Accuracy {
    shape: &'static str,
    spacing: f64,
    force: [f64; 2],
    torque: [f64; 2],
    plastic: [f64; 2],
    /// Energy in contacts before the pull, over the work of the pull (-).
    started: f64,
}

/// Smooth wires with particles one diameter apart.
const SHAPE: Accuracy = Accuracy {
    shape: "wire",
    spacing: 1.0,
    force: [-0.01, 0.01],
    torque: [-0.02, 0.02],
    plastic: [-0.01, 0.01],
    started: 1e-6,
};

/// A strand of a core and six helical wires.
struct Strand {
    young: &'static str,
    poisson: f64,
    /// Core, helical wire.
    diameters: [&'static str; 2],
    pitch: &'static str,
    strain: f64,
    speed: &'static str,
}

fn utting(pitch: &'static str) -> Strand {
    let diameters = ["3.94 mm", "3.73 mm"];
    Strand { young: "197.9 GPa", poisson: 0.3, diameters, pitch, strain: 1e-3, speed: "0.05 m/s" }
}

impl Strand {
    fn options(&self) -> Vec<String> {
        vec![
            set("contact.shape", SHAPE.shape),
            set("spacing", SHAPE.spacing),
            set("material.young", self.young),
            set("material.poisson", self.poisson),
            set("strand.wire_diameter", self.diameters[0]),
            set("strand.layer.1.wire_diameter", self.diameters[1]),
            set("strand.length", self.pitch),
            set("strand.layer.1.pitch", self.pitch),
            set("grip.speed", self.speed),
            set("stop.strain", self.strain),
        ]
    }
}

/// Mean of the two grips' forces, and torque, as the curve has them.
fn load(engine: &Engine) -> [f64; 2] {
    let sample = engine.sample();
    [0.5 * (sample.grip_force[0] + sample.grip_force[1]), sample.torque]
}

fn elastic(context: &Context, strands: &[Strand]) -> Result<Vec<Comparison>> {
    let mut comparisons = Vec::new();
    for strand in strands {
        let mut simulation = context.simulation("verify/known-strand", &strand.options())?;
        let theory = Theory::of_pull(&simulation.spec).expect("the scene is a strand that is pulled");
        let started = simulation.engine.energy().elastic_contacts;
        simulation.run(|_| {})?;
        let strain = simulation.engine.strain();
        let [force, torque] = load(&simulation.engine);
        let work = simulation.engine.energy().work;
        let spent = simulation.finish();
        let at =
            |what: &str| format!("{what}, {} and {}, pitch {}", strand.diameters[0], strand.diameters[1], strand.pitch);
        let [low, high] = SHAPE.force;
        comparisons
            .push(Comparison::new(at("force"), "N", force, theory.wrench.force * strain, spent).between(low, high));
        let [low, high] = SHAPE.torque;
        comparisons.push(
            Comparison::new(at("torque"), "N m", torque, theory.wrench.torque * strain, spent).between(low, high),
        );
        comparisons.push(
            Comparison::new(at("energy in contacts before the pull, over its work"), "-", started / work, 0.0, spent)
                .relative_to(1.0)
                .within(SHAPE.started),
        );
    }
    comparisons[1].note = Some(
        "Torque is that of wires as rods which stretch; the textbook's formula leaves their twist per length out and has \
         4 to 5 % less."
            .into(),
    );
    Ok(comparisons)
}

/// Bilinear true stress: yield at 1540 MPa, tangent modulus 24.6 GPa, so H = E Eₜ/(E − Eₜ).
fn yielding(context: &Context) -> Result<Vec<Comparison>> {
    let strand = Strand {
        young: "188 GPa",
        poisson: 0.3,
        diameters: ["3.94 mm", "3.73 mm"],
        pitch: "115 mm",
        strain: 1.5e-2,
        speed: "0.3 m/s",
    };
    let mut options = strand.options();
    options.extend([
        set("bond.law", "elasto-plastic"),
        set("bond.hardening", r#"{ form = "voce", yield_stress = "1540 MPa", linear = "28303.5 MPa" }"#),
        set("contact.normal", "thornton"),
        set("contact.tangential", "mindlin"),
        set("contact.friction", 0.115),
    ]);
    let mut simulation = context.simulation("verify/known-strand", &options)?;
    let known = [(1e-3, 13.70e3), (1e-2, 120.1e3), (1.5e-2, 129.1e3)];
    let mut found: Vec<f64> = Vec::new();
    let mut before = [0.0; 2];
    simulation.run(|engine| {
        let now = [engine.strain(), load(engine)[0]];
        while let Some((strain, _)) = known.get(found.len()).filter(|(strain, _)| now[0] >= *strain) {
            let share = (strain - before[0]) / (now[0] - before[0]);
            found.push(before[1] + share * (now[1] - before[1]));
        }
        before = now;
    })?;
    let spent: Spent = simulation.finish();
    let finding = |((strain, force), found): (&(f64, f64), f64)| {
        let [low, high] = if *strain < 5e-3 { SHAPE.force } else { SHAPE.plastic };
        Comparison::new(format!("force at {} %", strain * 1e2), "N", found, *force, spent).between(low, high)
    };
    Ok(known.iter().zip(found).map(finding).collect())
}
