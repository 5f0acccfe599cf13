//! Momentum and angular momentum of free bodies.

use crate::support::{alone, case, scene_names, set, spec};
use glam::DVec3;
use strandsnap::engine::Engine;

/// Momentum, angular momentum about the origin, and the sizes that rounding is measured by. Positions and velocities
/// half a step apart give the same angular momentum: the drift is along the velocity.
fn momenta(engine: &Engine) -> [DVec3; 2] {
    let s = engine.state();
    (0..s.len()).fold([DVec3::ZERO; 2], |[p, l], i| {
        let momentum = s.v.get(i) * s.mass[i];
        [p + momentum, l + s.x.get(i).cross(momentum) + s.w.get(i) * s.inertia[i]]
    })
}

fn sizes(engine: &Engine) -> [f64; 2] {
    let s = engine.state();
    (0..s.len()).fold([0.0; 2], |[p, l], i| {
        let momentum = s.v.get(i).length() * s.mass[i];
        [p + momentum, l + s.x.get(i).length() * momentum + s.w.get(i).length() * s.inertia[i]]
    })
}

fn check(name: &str, options: &[String]) {
    alone(|| {
        let mut case = case(name, options);
        let before = momenta(&case.engine);
        let mut touched = 0;
        let mut worst = [0.0f64; 2];
        case.run(|engine| {
            touched = touched.max(engine.contact_counts().2);
            let (now, size) = (momenta(engine), sizes(engine));
            for k in 0..2 {
                worst[k] = worst[k].max((now[k] - before[k]).length() / size[k]);
            }
        });
        println!("{name} {options:?}: {} steps, momenta change by {worst:?}, contacts {touched}", case.engine.steps());
        for (value, what) in worst.into_iter().zip(["momentum", "angular momentum"]) {
            assert!(value < 1e-11, "{name} {options:?}: {what} changes by {value:.1e}");
        }
        assert_eq!(touched > 0, case.spec.contact.is_some(), "{name}: contacts {touched}");
        case.check_ledger();
    });
}

#[test]
fn a_free_wire_keeps_its_momenta() {
    check("free-wire", &[]);
    check("free-wire", &[set("bond.damping", 0.1)]);
}

#[test]
fn colliding_wires_keep_their_momenta() {
    for shape in ["sphere", "capsule"] {
        for law in ["mindlin", "mindlin-deresiewicz", "none"] {
            check("crossing-wires", &[set("contact.shape", shape), set("contact.tangential", law)]);
        }
    }
}

/// Every verification scene can be read, built and says what it shows.
#[test]
fn every_scene_says_what_it_shows() {
    let names = scene_names();
    assert!(names.len() >= 16, "{names:?}");
    for name in names {
        assert!(spec(&name, &[]).about.ends_with('.'), "{name}");
        case(&name, &[]);
    }
}
