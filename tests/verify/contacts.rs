//! Two spheres: Hertz, Thornton, friction at constant normal force, sliding into rolling.

use crate::support::{Case, alone, case, converges, near, set};
use strandsnap::engine::Engine;
use strandsnap::reference::hertz::Pair;
use strandsnap::reference::mindlin::{Held, effective_shear_modulus};
use strandsnap::reference::{sliding, thornton};
use strandsnap::scene::spec::NormalSpec;

/// The two equal spheres of a scene.
fn pair(case: &Case) -> Pair {
    let m = &case.spec.material;
    Pair::equal_spheres(0.5 * case.spec.spheres[0].diameter, m.young, m.poisson, m.density)
}

fn overlap(engine: &Engine) -> f64 {
    let s = engine.state();
    s.radius[0] + s.radius[1] - (s.x.get(1) - s.x.get(0)).length()
}

/// Duration from touch to parting, interpolated, and the greatest overlap.
fn collide(case: &mut Case) -> (f64, f64) {
    let (mut deepest, mut end, mut before) = (0.0f64, None, 0.0);
    let dt = case.engine.time_step();
    case.run(|engine| {
        let now = overlap(engine);
        if end.is_none() && before > 0.0 && now <= 0.0 {
            end = Some(engine.time() - dt * now / (now - before));
        }
        deepest = deepest.max(now);
        before = now;
    });
    (end.expect("the spheres part"), deepest)
}

#[test]
fn two_spheres_follow_hertz() {
    alone(|| {
        let mut errors = Vec::new();
        for step in [400.0, 200.0, 100.0] {
            let mut case = case("hertz", &[set("time.step", format!("{step} ns"))]);
            let exact = pair(&case);
            let (time, depth) = collide(&mut case);
            errors.push(time / exact.contact_time(1.0) - 1.0);
            case.check_ledger();
            if step == 100.0 {
                near("contact time", time, exact.contact_time(1.0), 1e-3);
                near("greatest overlap", depth, exact.greatest_overlap(1.0), 1e-3);
                let (a, b) = (case.engine.state().v.z[0], case.engine.state().v.z[1]);
                near("rebound", b - a, 1.0, 1e-6);
            }
        }
        converges("contact time over the step", &errors, 2.0, 0.1);
    });
}

#[test]
fn two_spheres_follow_thornton() {
    alone(|| {
        for ratio in [0.9, 1.5, 3.0, 10.0, 100.0] {
            let still = case("thornton", &[]);
            let NormalSpec::Thornton { limiting_pressure } = still.spec.contact.as_ref().unwrap().normal else {
                panic!("the scene is elastoplastic")
            };
            let exact = pair(&still);
            let speed = ratio * thornton::yield_velocity(&exact, limiting_pressure);
            let half = |sign: f64| format!(r#"["0 m/s", "0 m/s", "{:e} m/s"]"#, 0.5 * sign * speed);
            // An elastic contact of this speed in 2000 steps; elastoplastic ones take longer.
            let time = exact.contact_time(speed);
            let mut case = case(
                "thornton",
                &[
                    set("sphere.0.velocity", half(1.0)),
                    set("sphere.1.velocity", half(-1.0)),
                    set("time.step", format!("{:e} s", time / 2000.0)),
                    set("stop.time", format!("{:e} s", 6.0 * time)),
                ],
            );
            case.run(|_| {});
            assert!(overlap(&case.engine) < 0.0 || ratio > 1.0);
            let v = &case.engine.state().v;
            let restitution = (v.z[1] - v.z[0]) / speed;
            near(&format!("restitution at V/V_y = {ratio}"), restitution, thornton::restitution(ratio), 1e-3);
            case.check_ledger();
        }
    });
}

/// Friction over displacement at constant normal force, for both laws.
#[test]
fn friction_at_constant_normal_force() {
    alone(|| {
        for law in ["mindlin", "mindlin-deresiewicz"] {
            let mut case = case("tangential", &[set("contact.tangential", law)]);
            let (spec, exact) = (&case.spec, pair(&case));
            let depth = overlap(&case.engine);
            let held = Held {
                shear_modulus: effective_shear_modulus(spec.material.shear(), spec.material.poisson),
                radius: (exact.radius * depth).sqrt(),
                normal_force: exact.force(depth),
                friction: spec.contact.as_ref().unwrap().friction,
            };
            let rate = spec.holds[1].spin.y * (0.5 * spec.spheres[1].diameter - 0.5 * depth);
            // The whole contact slides within the run.
            let end = 1.3 * held.sliding_displacement() / rate;
            let mut seen = 0;
            let mut next = 0.1;
            case.run_to(end, |engine| {
                let slip = rate * engine.time();
                let share = slip / held.sliding_displacement();
                if share >= next {
                    next += 0.1;
                    seen += 1;
                    let force = engine.state().contact_force.x[1].abs();
                    let exact = if law == "mindlin" { held.no_slip_force(slip) } else { held.partial_slip_force(slip) };
                    near(&format!("{law} at {share:.2} of sliding"), force, exact, 5e-3);
                }
            });
            assert!(seen >= 12, "{seen} points");
            case.check_ledger();
        }
    });
}

/// Slip ends at 2v₀/(7μg′); from then on the speed is (5/7)v₀ in the mean over the ringing of the tangential spring.
#[test]
fn a_sliding_sphere_ends_up_rolling() {
    alone(|| {
        for law in ["mindlin", "mindlin-deresiewicz"] {
            let (radius, floor, force, speed, friction) = (0.5e-3, 1.0, 10e-3, 0.5, 0.2);
            let spec = crate::support::spec("rolling", &[]);
            let m = spec.material;
            let modulus = m.young / (2.0 * (1.0 - m.poisson * m.poisson));
            let reduced = radius * floor / (radius + floor);
            let depth = (0.75 * force / (modulus * f64::sqrt(reduced))).powf(2.0 / 3.0);
            let height = format!(r#"["0 m", "0 m", "{:.17e} m"]"#, radius - depth);
            let mut case = case("rolling", &[set("sphere.1.position", height), set("contact.tangential", law)]);
            let mass = case.engine.assembly().mass[1];
            let start = sliding::rolling_start(speed, friction, force / mass);
            let (mut rolls, mut sum, mut count) = (None, 0.0, 0);
            case.run_to(2.0 * start, |engine| {
                let s = engine.state();
                let slip = s.v.x[1] - s.w.y[1] * (radius - 0.5 * depth);
                if rolls.is_none() && slip <= 0.0 {
                    rolls = Some(engine.time());
                }
                if engine.time() > 1.2 * start {
                    sum += s.v.x[1];
                    count += 1;
                }
            });
            near(&format!("{law}: rolling starts"), rolls.expect("it rolls in the end"), start, 1e-2);
            near(&format!("{law}: rolling speed"), sum / f64::from(count), sliding::rolling_speed(speed), 2e-3);
            case.check_ledger();
        }
    });
}
