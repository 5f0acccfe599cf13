//! Two spheres: Hertz, Thornton, friction at constant normal force, sliding into rolling.

use super::Case;
use super::finding::{Finding, Point, Spent};
use super::support::{Lab, Trial, set};
use crate::base::error::Result;
use crate::engine::Engine;
use crate::reference::hertz::Pair;

pub const HERTZ: Case = Case {
    name: "hertz",
    about: "two elastic spheres collide head-on: duration, depth and rebound",
    source: "Hertz 1882; Johnson, Contact Mechanics, 1985, section 11.4",
    run: hertz,
};

/// The two equal spheres of a scene.
fn pair(trial: &Trial) -> Pair {
    let m = &trial.spec.material;
    Pair::equal_spheres(0.5 * trial.spec.spheres[0].diameter, m.young, m.poisson, m.density)
}

fn overlap(engine: &Engine) -> f64 {
    let s = engine.state();
    s.radius[0] + s.radius[1] - (s.x.get(1) - s.x.get(0)).length()
}

/// Duration from touch to parting [s], interpolated (NaN when they do not part), and the greatest overlap [m].
fn collide(trial: &mut Trial) -> Result<(f64, f64)> {
    let (mut deepest, mut end, mut before) = (0.0f64, f64::NAN, 0.0);
    let dt = trial.engine.time_step();
    trial.run(|engine| {
        let now = overlap(engine);
        if end.is_nan() && before > 0.0 && now <= 0.0 {
            end = engine.time() - dt * now / (now - before);
        }
        deepest = deepest.max(now);
        before = now;
    })?;
    Ok((end, deepest))
}

/// Leapfrog is of order 2; the smooth 3/2 power of Hertz's law does not spoil it.
fn hertz(lab: &Lab) -> Result<Vec<Finding>> {
    let speed = 1.0;
    let (mut points, mut finest) = (Vec::new(), None);
    for step in lab.pick(&[400.0, 200.0, 100.0][..], &[800.0, 400.0, 200.0, 100.0, 50.0]) {
        let mut trial = lab.trial("verify/hertz", &[set("time.step", format!("{step} ns"))])?;
        let exact = pair(&trial);
        let (time, depth) = collide(&mut trial)?;
        let v = &trial.engine.state().v;
        let rebound = v.z[1] - v.z[0];
        let whole = exact.contact_time(speed);
        let spent = trial.finish();
        points.push(Point { resolution: step * 1e-9 / whole, error: time / whole - 1.0, spent });
        finest = Some((time, depth, rebound, exact));
    }
    let (time, depth, rebound, exact) = finest.expect("there are steps");
    let spent = points.last().map_or(Spent::default(), |p| p.spent);
    Ok(vec![
        Finding::new("contact time", "s", time, exact.contact_time(speed), spent)
            .within(1e-3)
            .converging("dt/T", points, 2.0, 0.1),
        Finding::new("greatest overlap", "m", depth, exact.greatest_overlap(speed), spent).within(1e-3),
        Finding::new("speed of rebound", "m/s", rebound, speed, spent).within(1e-6),
    ])
}
