//! Nothing but accuracy depends on the time step.

use crate::drive::*;

const REED: &str = r#"
about = "A wire, clamped at its start, swings after a push."
[bond]
law = "elastic"
damping = 0.05
[contact]
normal = "none"
[[wire]]
diameter = "0.39 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "4 mm"]
[[hold]]
body = 0
part = "start"
fix = ["x", "y", "z", "rx", "ry", "rz"]
[stop]
time = "1 ms"
"#;

/// Energy that a swinging wire has left after `time`, over what it had (-).
fn left(step: &str, time: f64, damping: &str, axial: bool) -> f64 {
    let (step, damping) = (format!("time.step={step}"), format!("bond.damping={damping}"));
    let mut engine = edited(REED, &[&step, &damping], |a| {
        add_velocity(a, |x| {
            let s = x.z / 4e-3;
            if axial { glam::DVec3::Z * s } else { glam::DVec3::X * (2.0 * s * s) }
        });
    });
    let before = engine.energy().kinetic;
    run_to(&mut engine, time);
    let e = engine.energy();
    (e.kinetic + e.elastic_bonds) / before
}

#[test]
fn damping_does_not_depend_on_the_step() {
    for (axial, damping, time) in [(false, "0.5", 1e-3), (true, "0.02", 6e-5)] {
        let coarse = left("4e-8 s", time, damping, axial);
        let fine = left("1e-8 s", time, damping, axial);
        let free = left("4e-8 s", time, "0", axial);
        println!("axial {axial}: {coarse} {fine}, without damping {free}");
        assert!((0.05..0.8).contains(&fine), "{fine} of the energy is left, which says little");
        // The dashpot lags by half a step, an error of first order.
        assert!((coarse / fine - 1.0).abs() < 0.02, "{coarse} {fine}");
        assert!((free - 1.0).abs() < 1e-4, "{free}");
    }
}

/// Undamped, leapfrog swings about the energy and does not drift: elastic bonds over a hundred thousand steps.
#[test]
fn energy_does_not_drift() {
    let mut engine = edited(REED, &["bond.damping=0"], |a| {
        add_velocity(a, |x| glam::DVec3::new(2.0, 0.5, 0.2) * (x.z / 4e-3));
    });
    let before = engine.energy().kinetic;
    let mut early = 0.0f64;
    let mut late = 0.0f64;
    for k in 0..200 {
        run_steps(&mut engine, 500);
        let residual = engine.energy().residual().abs() / before;
        if k < 20 { early = early.max(residual) } else { late = late.max(residual) }
    }
    println!("{early:e} {late:e}");
    assert!(late < 2.0 * early + 1e-6 && late < 1e-2, "{early:e} {late:e}");
}

/// A sphere meets another after a long flight: the step of the flight is no step for the impact.
#[test]
fn a_long_flight_does_not_coarsen_the_impact() {
    let text = strandsnap::scene::builtin::find("two-spheres").unwrap();
    let rebound = |time: &str| {
        let mut engine = engine(text, &[&format!("stop.time={time}")]);
        run_to(&mut engine, 2e-4);
        assert!(engine.energy().plastic_contacts > 0.0);
        -engine.state().v.get(0).z
    };
    let (short, long) = (rebound("200 us"), rebound("10 s"));
    assert!((long / short - 1.0).abs() < 1e-3, "{short} {long}");
    assert!(short > 0.0 && short < 0.5, "{short}");
}
