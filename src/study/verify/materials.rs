//! Bodies of unlike materials: stiffness that adds up, contacts by the constants of the pair, a conductor of two metals.

use super::case::VerificationCase;
use super::comparison::Comparison;
use super::contacts::collide;
use super::support::{Context, set};
use crate::base::error::Result;
use crate::reference::hertz::Pair;
use crate::reference::strand::{Wire, elastic_of_materials, stiffness_sum};
use crate::strand::theory::Theory;

pub const WIRES: VerificationCase = VerificationCase {
    name: "unlike-wires",
    about: "a steel and an aluminium wire pulled side by side: E A adds up, each carries its share",
    source: "bars in parallel, F = Σ E A ln(1 + ε)",
    run: wires,
};

pub const SPHERES: VerificationCase = VerificationCase {
    name: "unlike-spheres",
    about: "a steel and an aluminium sphere collide head-on: duration and depth by the modulus of the pair",
    source: "Hertz 1882; Johnson, Contact Mechanics, 1985, section 11.4",
    run: spheres,
};

pub const CONDUCTOR: VerificationCase = VerificationCase {
    name: "acsr-stiffness",
    about: "an ACSR conductor, steel 1 + 6 under aluminium 12 + 18 + 24, between the bounds of strand theory, and each metal's share",
    source: "Hruska 1951: Σ n A E cos³β; Costello, Theory of Wire Rope, 1997, chapter 3",
    run: conductor,
};

fn wires(context: &Context) -> Result<Vec<Comparison>> {
    let mut simulation = context.simulation("verify/unlike-wires", &[])?;
    let mut last = None;
    simulation.run(|engine| {
        if engine.strain() >= 2e-3 {
            last.get_or_insert_with(|| engine.sample());
        }
    })?;
    let sample = last.unwrap_or_else(|| simulation.engine.sample());
    let assembly = simulation.engine.assembly();
    let exact: Vec<f64> = assembly
        .wires
        .iter()
        .map(|wire| simulation.spec.material_at(wire.material).material.young * wire.area() * sample.strain.ln_1p())
        .collect();
    let names: Vec<String> = simulation.spec.materials().map(|one| one.label().to_owned()).collect();
    let spent = simulation.finish();
    let mut found: Vec<Comparison> = (0..exact.len())
        .map(|w| {
            let what = format!("force of the wire of {} at 0.2 %", names[w]);
            Comparison::new(what, "N", sample.wire_pull[w], exact[w], spent).within(2e-4)
        })
        .collect();
    let both = exact.iter().sum();
    found.push(Comparison::new("force of the grip at 0.2 %", "N", sample.grip_force[1], both, spent).within(5e-3));
    Ok(found)
}

fn spheres(context: &Context) -> Result<Vec<Comparison>> {
    let mut simulation = context.simulation("verify/unlike-spheres", &[])?;
    let (end, deepest) = collide(&mut simulation)?;
    let one = |k: usize| {
        let sphere = &simulation.spec.spheres[k];
        let m = simulation.spec.material_at(sphere.material).material;
        [0.5 * sphere.diameter, m.young, m.poisson, m.density]
    };
    let pair = Pair::spheres([one(0), one(1)]);
    let spent = simulation.finish();
    Ok(vec![
        Comparison::new("contact time", "us", end * 1e6, pair.contact_time(1.0) * 1e6, spent).within(1e-4),
        Comparison::new("greatest overlap", "um", deepest * 1e6, pair.greatest_overlap(1.0) * 1e6, spent).within(1e-4),
    ])
}

/// Elastic, smooth and short: the conductor's stiffness alone.
fn elastic() -> Vec<String> {
    let off = |key: &str| set(key, "");
    let mut options = vec![
        set("contact.normal", "hertz"),
        set("contact.tangential", "none"),
        off("contact.friction"),
        off("contact.pair"),
        set("strand.length", "300 mm"),
        set("grip.speed", "1 m/s"),
        off("stop.stress_fraction"),
        set("stop.strain", "0.25 %"),
    ];
    for metal in ["steel", "aluminium"] {
        let key = |name: &str| format!("materials.{metal}.{name}");
        options.push(set(&key("law"), "elastic"));
        options.extend(["hardening", "rupture", "limiting_pressure"].map(|name| off(&key(name))));
    }
    options
}

/// Wires do not thin elastically here and only contacts give, so that the conductor lies between Hruska's sum and Costello's
/// value, which lets wires thin.
fn conductor(context: &Context) -> Result<Vec<Comparison>> {
    let mut simulation = context.simulation("acsr", &elastic())?;
    let layers = simulation.spec.strand.as_ref().map_or(&[][..], |strand| &strand.layers[..]);
    let constants = |number: usize| {
        let material = simulation.spec.material_at(number).material;
        [material.young, material.poisson]
    };
    let materials: Vec<[f64; 2]> = layers.iter().map(|layer| constants(layer.material)).collect();
    let of: Vec<usize> = layers.iter().map(|layer| layer.material).collect();
    let theory = Theory::of_pull(&simulation.spec).expect("a pulled strand has a theory");
    let sum = |counts: &dyn Fn(usize) -> bool| {
        let young: Vec<f64> = (0..of.len()).map(|k| if counts(of[k]) { materials[k][0] } else { 0.0 }).collect();
        stiffness_sum(&theory.layers, &young)
    };
    let (plain, thinning) =
        (sum(&|_| true), elastic_of_materials(&theory.layers, &materials, Wire::Inextensible).force);
    let mut points: Vec<[f64; 4]> = Vec::new();
    simulation.run(|engine| {
        if engine.strain() >= 1e-3 && engine.steps().is_multiple_of(10) {
            let sample = engine.sample();
            let share = |number: usize| {
                let wires = engine.assembly().wires.iter().zip(&sample.wire_pull);
                wires.filter(|(wire, _)| wire.material == number).map(|(_, force)| force).sum::<f64>()
            };
            points.push([sample.strain, sample.grip_force[1], share(0), share(1)]);
        }
    })?;
    let mean = |k: usize| points.iter().map(|point| point[k]).sum::<f64>() / points.len() as f64;
    let slope = |k: usize| {
        let both: f64 = points.iter().map(|point| (point[0] - mean(0)) * (point[k] - mean(k))).sum();
        both / points.iter().map(|point| (point[0] - mean(0)).powi(2)).sum::<f64>()
    };
    let names: Vec<String> = simulation.spec.materials().map(|one| one.label().to_owned()).collect();
    let spent = simulation.finish();
    let room = 2e-3;
    let what = format!("force per strain (Costello {:.3} MN)", thinning * 1e-6);
    let mut found = vec![
        Comparison::new(what, "MN", slope(1) * 1e-6, plain * 1e-6, spent).between(thinning / plain - 1.0 - room, room),
    ];
    for (number, name) in names.iter().enumerate() {
        let right = sum(&|of| of == number);
        let what = format!("of it in {name}");
        found.push(Comparison::new(what, "MN", slope(2 + number) * 1e-6, right * 1e-6, spent).within(0.02));
    }
    Ok(found)
}
