//! The coefficient of restitution that a scene asks for is the one that its bodies part with.

use glam::DVec3;
use strandsnap::engine::Engine;
use strandsnap::law::damping::{HERTZIAN, hertzian_fraction, ratio_of_restitution, restitution};
use strandsnap::scene::{self, plan::Plan};
use strandsnap::strand::discretise;

const COEFFICIENTS: [f64; 4] = [0.8, 0.6, 0.4, 0.2];

fn started(scene: &str, set: &[&str]) -> Engine {
    let set: Vec<String> = set.iter().map(|option| option.to_string()).collect();
    let spec = scene::load(scene, &set).unwrap().spec;
    let assembly = discretise::build(&spec).unwrap();
    Engine::new(&spec, &Plan::new(&spec), assembly).unwrap()
}

/// Speed at which the second half of the particles moves away from the first along z (m/s).
fn parting(engine: &Engine) -> f64 {
    let (state, half) = (engine.state(), engine.state().len() / 2);
    let mean = |range: std::ops::Range<usize>| {
        let count = range.len() as f64;
        range.map(|p| state.v.get(p)).sum::<DVec3>().z / count
    };
    mean(half..2 * half) - mean(0..half)
}

/// Lets bodies meet and part, and tells speed of parting over speed of approach; the energy ledger must close.
fn measured(mut engine: Engine) -> f64 {
    let before = parting(&engine);
    assert!(before < 0.0);
    let mut touched = false;
    for _ in 0..100_000 {
        engine.step().unwrap();
        let touches = engine.contact_counts().2 > 0;
        if touched && !touches {
            let energy = engine.energy();
            assert!(energy.damping > 0.0 && energy.residual().abs() < 1e-3 * energy.damping, "{energy:?}");
            return -parting(&engine) / before;
        }
        touched |= touches;
    }
    panic!("they did not part");
}

const ELASTIC: [&str; 2] = ["contact.normal=hertz", "contact.limiting_pressure="];

fn spheres(coefficient: f64, more: &[&str]) -> f64 {
    let key = format!("contact.restitution={coefficient}");
    measured(started("two-spheres", &[&ELASTIC[..], &[&key], more].concat()))
}

fn near(found: f64, wanted: f64, what: &str) {
    println!("{what}: {found:.4} for {wanted}");
    assert!((found / wanted - 1.0).abs() < 0.02, "{what}: {found} is not {wanted}");
}

/// Values of the closed form from Schwager & Pöschel's three branches, by hand.
#[test]
fn the_closed_form_is_that_of_the_branches_and_its_inverse() {
    for ratio in [1e-3, 0.1, 0.5, 0.7, 0.8, 0.99, 1.0, 1.5, 20.0f64] {
        let damped = (1.0 - ratio * ratio).abs().sqrt();
        let exact = if ratio < 1.0 {
            let angle = (2.0 * ratio * damped).atan2(1.0 - 2.0 * ratio * ratio);
            (-(ratio / damped) * (std::f64::consts::PI - angle)).exp()
        } else if ratio == 1.0 {
            (-2.0f64).exp()
        } else {
            (-(ratio / damped) * ((ratio + damped) / (ratio - damped)).ln()).exp()
        };
        assert!((restitution(ratio) / exact - 1.0).abs() < 1e-12, "{ratio}");
        assert!((ratio_of_restitution(exact) / ratio - 1.0).abs() < 1e-6, "{ratio}");
    }
    assert_eq!(ratio_of_restitution(1.0), 0.0);
    assert!((HERTZIAN * HERTZIAN - 1.2).abs() < 1e-15);
    // Without the end of attraction taken into account, 0.2 would come out as 0.325.
    let tsuji = 0.2f64.ln().abs() / std::f64::consts::PI.hypot(0.2f64.ln());
    assert!((restitution(tsuji) - 0.325).abs() < 5e-4 && hertzian_fraction(tsuji) < tsuji);
}

#[test]
fn two_spheres_part_as_the_key_says_whatever_stiffness_size_and_speed() {
    let speed = |v: &str| [format!("sphere.0.velocity.2={v} m/s"), format!("sphere.1.velocity.2=-{v} m/s")];
    let (slow, fast) = (speed("0.005"), speed("5"));
    for wanted in COEFFICIENTS {
        near(spheres(wanted, &[]), wanted, "as shipped");
        near(spheres(wanted, &["material.young=1 GPa"]), wanted, "soft");
        near(spheres(wanted, &[&slow[0], &slow[1], "stop.time=20 ms"]), wanted, "slow");
        near(spheres(wanted, &[&fast[0], &fast[1]]), wanted, "fast");
        near(spheres(wanted, &["sphere.0.diameter=2 mm", "sphere.0.position.2=-1.01 mm"]), wanted, "unequal");
        near(spheres(wanted, &["contact.shape=wire"]), wanted, "as balls among smooth wires");
    }
}

#[test]
fn a_sphere_parts_from_a_fixed_one_as_the_key_says() {
    let hold = "hold=[{ body = 0, part = \"all\", fix = [\"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\"] }]";
    for wanted in COEFFICIENTS {
        near(spheres(wanted, &[hold]), wanted, "against a fixed sphere");
    }
}
