//! Steps of bonds and contacts under every law that is recorded, with arguments to try them with: histories of bonds and
//! contacts that are loaded, yield and are unloaded, and extreme ones.

use strandsnap::base::random::uniform;
use strandsnap::base::recorder::{Formula, Function};
use strandsnap::engine::bonds::formula::{BondStep, SectionStress};
use strandsnap::engine::contact::formula::ContactStep;
use strandsnap::engine::contact::pair::Laws;
use strandsnap::law::bond::elastic::Elastic;
use strandsnap::law::bond::elasto_plastic::ElastoPlastic;
use strandsnap::law::bond::hardening::Hardening;
use strandsnap::law::bond::rupture::BeamStress;
use strandsnap::law::bond::{BondLaw, Moduli};
use strandsnap::law::contact::NormalLaw;
use strandsnap::law::contact::hertz::Hertz;
use strandsnap::law::contact::thornton::Thornton;
use strandsnap::law::tangential::TangentialLaw;
use strandsnap::law::tangential::mindlin::Mindlin;
use strandsnap::law::tangential::none::Frictionless;

const LENGTH: f64 = 0.39e-3;
const RADIUS: f64 = 0.195e-3;
const DT: f64 = 1e-7;
/// Bonds and contacts of a batch, and steps of each.
const BODIES: u64 = 12;
const STEPS: u64 = 80;

/// Arguments that belong together: errors are measured against the largest results among them.
pub struct Batch {
    pub name: &'static str,
    /// Inputs of each step, in order.
    pub rows: Vec<Vec<f64>>,
    /// What the formula makes of them with `f64`.
    pub expected: Vec<Vec<f64>>,
}

/// A recorded formula with arguments.
pub struct Case {
    pub function: Function,
    pub batches: Vec<Batch>,
}

/// Magnitudes of a batch of histories.
struct Scale {
    name: &'static str,
    /// Speeds (m/s), spins (rad/s), overlaps (m).
    speed: f64,
    spin: f64,
    overlap: f64,
    /// Whether the bonds hold.
    live: f64,
}

const SCALES: [Scale; 6] = [
    Scale { name: "ordinary", speed: 2.0, spin: 1e4, overlap: 2e-6, live: 1.0 },
    Scale { name: "elastic", speed: 0.01, spin: 50.0, overlap: 1e-9, live: 1.0 },
    Scale { name: "at rest", speed: 0.0, spin: 0.0, overlap: 0.0, live: 1.0 },
    Scale { name: "tiny", speed: 1e-30, spin: 1e-30, overlap: 1e-40, live: 1.0 },
    Scale { name: "huge", speed: 100.0, spin: 1e6, overlap: 1e-3, live: 1.0 },
    Scale { name: "broken", speed: 2.0, spin: 1e4, overlap: 2e-6, live: 0.0 },
];

/// Every law that can be recorded.
pub fn cases() -> Vec<Case> {
    let moduli = Moduli::new(115e9, 0.34);
    let hardenings = [
        ("voce", Hardening::Voce { yield_stress: 100e6, saturation: 180e6, rate: 12.0, linear: 450e6 }),
        ("swift", Hardening::Swift { strength: 500e6, prestrain: 0.01, exponent: 0.3 }),
        ("ludwik", Hardening::Ludwik { yield_stress: 90e6, strength: 400e6, exponent: 0.5 }),
        ("table", Hardening::Table(vec![[0.0, 90e6], [0.002, 140e6], [0.01, 170e6], [0.1, 250e6], [0.3, 400e6]])),
        ("perfect", Hardening::Table(vec![[0.0, 100e6]])),
    ];
    let mut cases = Vec::new();
    for (turn, damped) in [(false, false), (true, false), (false, true), (true, true)] {
        let kind = format!("{}{}", if turn { "turning" } else { "stretching" }, if damped { "_damped" } else { "" });
        cases.push(bond(&format!("elastic_{kind}"), Elastic { moduli }, turn, damped));
        for (name, hardening) in &hardenings {
            // One law shows the dashpots, which know nothing of it.
            if !damped || *name == "voce" {
                let law = ElastoPlastic { moduli, hardening: hardening.clone() };
                cases.push(bond(&format!("{name}_{kind}"), law, turn, damped));
            }
        }
    }
    let law = ElastoPlastic { moduli, hardening: hardenings[0].1.clone() };
    cases.push(section(law));
    let (hertz, thornton) =
        (Hertz { effective_modulus: 65e9 }, Thornton { effective_modulus: 65e9, limiting_pressure: 252e6 });
    let mindlin = Mindlin { shear_modulus_star: 13e9, friction: 0.2 };
    cases.push(contact("hertz", Laws { normal: hertz, tangential: Frictionless, damping: 0.0 }));
    cases.push(contact("hertz_damped", Laws { normal: hertz, tangential: Frictionless, damping: 0.1 }));
    cases.push(contact("hertz_mindlin", Laws { normal: hertz, tangential: mindlin, damping: 0.0 }));
    cases.push(contact("thornton", Laws { normal: thornton, tangential: Frictionless, damping: 0.0 }));
    cases.push(contact("thornton_mindlin_damped", Laws { normal: thornton, tangential: mindlin, damping: 0.1 }));
    cases
}

/// Histories of a formula: what `inputs` says at (step, name) beside what it has put itself under the same name.
fn histories(formula: &impl Formula, function: &Function, input: impl Fn(u64, u64, &str, &Scale) -> f64) -> Vec<Batch> {
    let outputs: Vec<&str> = function.outputs().collect();
    let own: Vec<Option<usize>> =
        function.inputs().iter().map(|input| outputs.iter().position(|output| output == input)).collect();
    let batch = |scale: &Scale| {
        let (mut rows, mut expected) = (Vec::new(), Vec::new());
        for body in 0..BODIES {
            let mut last: Option<Vec<f64>> = None;
            for step in 0..STEPS {
                let row: Vec<f64> = function
                    .inputs()
                    .iter()
                    .zip(&own)
                    .map(|(name, own)| match (&last, own) {
                        (Some(last), Some(output)) => last[*output],
                        _ => input(body, step, name, scale),
                    })
                    .collect();
                let results = formula.evaluate(&row);
                rows.push(row);
                last = Some(results.clone());
                expected.push(results);
            }
        }
        Batch { name: scale.name, rows, expected }
    };
    SCALES.iter().map(batch).collect()
}

/// A number from −1 to 1 that stays for some steps, of the stream `name`.
fn draw(body: u64, step: u64, name: &str) -> f64 {
    let stream = name.bytes().fold(7, |hash: u64, byte| hash.wrapping_mul(31) + u64::from(byte));
    2.0 * uniform(body, stream, step / 8) - 1.0
}

fn bond<L: BondLaw>(name: &str, law: L, turn: bool, damped: bool) -> Case {
    let mut initial = vec![0.0; L::HISTORY];
    L::each_number(&law.initial(), |k, number| initial[k] = number);
    let formula = BondStep { law, turn, damped };
    let function = Function::record(name, &formula).unwrap();
    let batches = histories(&formula, &function, |body, step, name, scale| {
        // Along x; the far end has gone where the velocities of all steps have brought it.
        let velocity = |name: &str, step: u64| scale.speed * draw(body, step, name);
        let gone = |name: &str| (0..=step).map(|step| velocity(name, step)).sum::<f64>() * DT;
        match name {
            "near_x_x" | "near_x_y" | "near_x_z" => 0.02 * draw(body, 0, name) + gone(&name.replacen("_x_", "_v_", 1)),
            "far_x_x" => 0.02 * draw(body, 0, "near_x_x") + LENGTH + gone("far_v_x"),
            "far_x_y" => 0.02 * draw(body, 0, "near_x_y") + gone("far_v_y"),
            "far_x_z" => 0.02 * draw(body, 0, "near_x_z") + gone("far_v_z"),
            "rest_length" => LENGTH,
            "radius0" => RADIUS,
            "inverse_length" => 1.0 / LENGTH,
            "inverse_radius" => 1.0 / RADIUS,
            "e1_y" => 1.0,
            "viscosity_axial" | "viscosity_shear" => 0.4,
            "viscosity_bend" | "viscosity_twist" => 1e-9,
            "dt" => DT,
            "inverse_dt" => 1.0 / DT,
            "live" => scale.live,
            _ if name.contains("_v_") => velocity(name, step),
            _ if name.contains("_w_") => scale.spin * draw(body, step, name),
            _ => name.strip_prefix("history_").map_or(0.0, |k| initial[k.parse::<usize>().unwrap()]),
        }
    });
    Case { function, batches }
}

fn section(law: ElastoPlastic) -> Case {
    let criterion = BeamStress { tensile: 300e6, shear: 200e6, moment_share: 0.7 };
    let mut initial = [0.0; 6];
    ElastoPlastic::each_number(&law.initial(), |k, number| initial[k] = number);
    let formula = SectionStress { law, criterion };
    let function = Function::record("section_stress", &formula).unwrap();
    let batches = histories(&formula, &function, |body, step, name, scale| match name {
        "rest_length" => LENGTH,
        "radius0" => RADIUS,
        "inverse_length" => 1.0 / LENGTH,
        "inverse_radius" => 1.0 / RADIUS,
        "history_2" => 1.0 - 0.1 * draw(body, step, name).abs(),
        "axial" | "shear_1" | "shear_2" => 10.0 * scale.speed * draw(body, step, name),
        "bend_1" | "bend_2" | "twist" => 1e-3 * scale.speed * draw(body, step, name),
        _ => initial[name.strip_prefix("history_").unwrap().parse::<usize>().unwrap()],
    });
    Case { function, batches }
}

fn contact<N: NormalLaw, T: TangentialLaw>(name: &str, laws: Laws<N, T>) -> Case {
    let formula = ContactStep(laws);
    let function = Function::record(name, &formula).unwrap();
    let batches = histories(&formula, &function, |body, step, name, scale| {
        // The normal turns slowly.
        let angle = 1e-3 * scale.spin * DT * step as f64 + draw(body, 0, "angle");
        match name {
            "reduced_radius" => 0.5 * RADIUS,
            "normal_x" => angle.cos(),
            "normal_y" => 0.6 * angle.sin(),
            "normal_z" => 0.8 * angle.sin(),
            // Up and down, and apart for a while.
            "overlap" => (scale.overlap * (0.1 * step as f64 + 3.0 * draw(body, 0, name)).sin()).max(0.0),
            "thinner" => 1e-10 * scale.speed * draw(body, step, name).abs(),
            "viscosity" => 3e-5,
            "dt" => DT,
            _ if name.starts_with("velocity") => scale.speed * draw(body, step, name),
            _ => 0.0,
        }
    });
    Case { function, batches }
}
