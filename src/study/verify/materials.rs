//! Bodies of unlike materials: stiffness that adds up, contacts by the constants of the pair, a conductor of two metals.

use super::case::VerificationCase;
use super::comparison::Comparison;
use super::contacts::collide;
use super::support::{Context, set};
use crate::base::error::Result;
use crate::base::vectors::Vectors;
use crate::engine::Engine;
use crate::reference::hertz::Pair;
use crate::reference::strand::{Layer, stiffness_sum, wire_strain};
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
    about: "an ACSR conductor, steel 1 + 6 under aluminium 12 + 18 + 24: stiffness, and each metal's share",
    source: "Hruska 1951: Σ n A E cos³β, the bound of wires that do not give; strain of a helix",
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

/// What the wires of each material carry along the strand (N) by stretch, radius and turn of every wire's middle third, as the
/// strain of a helix has it.
fn by_shape(engine: &Engine, layers: &[Layer], materials: usize) -> Vec<f64> {
    let (a, s) = (engine.assembly(), engine.state());
    let mut carried = vec![0.0; materials];
    for w in &a.wires {
        let (low, high) = (w.first + w.len / 3, w.first + 2 * w.len / 3);
        let strain = (s.x.z[high] - s.x.z[low]) / (a.position.z[high] - a.position.z[low]) - 1.0;
        let radius = |x: &Vectors| (low..=high).map(|p| x.x[p].hypot(x.y[p])).sum::<f64>();
        let turn = |x: &Vectors| {
            let between = |p: usize| {
                let (from, to) = (x.get(p).truncate(), x.get(p + 1).truncate());
                from.perp_dot(to).atan2(from.dot(to))
            };
            (low..high).map(between).sum::<f64>()
        };
        let layer = &layers[w.layer];
        let around =
            if layer.radius > 0.0 { radius(&s.x) / radius(&a.position) * turn(&s.x) / turn(&a.position) } else { 1.0 };
        let x = wire_strain(strain, layer.lay_angle(), around);
        let young = engine.spec().material_at(w.material).material.young;
        carried[w.material] += young * w.area() * x.ln_1p() * (1.0 + strain) * layer.lay_angle().cos() / (1.0 + x);
    }
    carried
}

/// Crossing wires give where they touch, which lets the layers in: the conductor is softer than Hruska's sum, and as stiff as
/// the shape of its wires says.
fn conductor(context: &Context) -> Result<Vec<Comparison>> {
    let mut simulation = context.simulation("acsr", &elastic())?;
    let theory = Theory::of_pull(&simulation.spec).expect("a pulled strand has a theory");
    let layers = simulation.spec.strand.as_ref().map_or(&[][..], |strand| &strand.layers[..]);
    let young: Vec<f64> =
        layers.iter().map(|layer| simulation.spec.material_at(layer.material).material.young).collect();
    let sum = stiffness_sum(&theory.layers, &young);
    let names: Vec<String> = simulation.spec.materials().map(|one| one.label().to_owned()).collect();
    // Strain, force of the grip, then what each material carries, by its bonds and by its shape.
    let mut rows: Vec<Vec<f64>> = Vec::new();
    simulation.run(|engine| {
        if engine.strain() >= 1e-3 && engine.steps().is_multiple_of(10) {
            let sample = engine.sample();
            let share = |number: usize| {
                let wires = engine.assembly().wires.iter().zip(&sample.wire_pull);
                wires.filter(|(wire, _)| wire.material == number).map(|(_, force)| force).sum::<f64>()
            };
            let mut row = vec![sample.strain, sample.grip_force[1]];
            row.extend((0..names.len()).map(share));
            row.extend(by_shape(engine, &theory.layers, names.len()));
            rows.push(row);
        }
    })?;
    let mean = |k: usize| rows.iter().map(|row| row[k]).sum::<f64>() / rows.len() as f64;
    let slope = |k: usize| {
        let both: f64 = rows.iter().map(|row| (row[0] - mean(0)) * (row[k] - mean(k))).sum();
        both / rows.iter().map(|row| (row[0] - mean(0)).powi(2)).sum::<f64>()
    };
    let spent = simulation.finish();
    let mn = |k: usize| slope(k) * 1e-6;
    let of = |name: &str| format!("of it in {name}, against stretch, radius and turn of its wires");
    let mut found = vec![
        Comparison::new("force per strain, against the sum rule", "MN", mn(1), sum * 1e-6, spent)
            .between(-0.06, 0.0)
            .note("the sum rule lets no wire give where it touches; contra-laid layers touch in points"),
    ];
    for (number, name) in names.iter().enumerate() {
        let (bonds, shape) = (mn(2 + number), mn(2 + names.len() + number));
        found.push(Comparison::new(of(name), "MN", bonds, shape, spent).within(3e-3));
    }
    Ok(found)
}
