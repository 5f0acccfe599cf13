//! Two spheres: Hertz, Thornton, friction at constant normal force, sliding into rolling.

use super::case::VerificationCase;
use super::comparison::{Comparison, Point, Spent};
use super::support::{Context, Simulation, set};
use crate::base::error::Result;
use crate::engine::Engine;
use crate::reference::hertz::Pair;
use crate::reference::mindlin::{Held, effective_shear_modulus};
use crate::reference::{sliding, thornton};
use crate::scene::spec::NormalSpec;

pub const HERTZ: VerificationCase = VerificationCase {
    name: "hertz",
    about: "two elastic spheres collide head-on: duration, depth and rebound",
    source: "Hertz 1882; Johnson, Contact Mechanics, 1985, section 11.4",
    run: hertz,
};

pub const THORNTON: VerificationCase = VerificationCase {
    name: "thornton",
    about: "two elastoplastic spheres collide head-on: restitution over V/V_y",
    source: "Thornton, J. Appl. Mech. 64 (1997) 383",
    run: thornton_restitution,
};

pub const RESTITUTION: VerificationCase = VerificationCase {
    name: "restitution",
    about: "two elastic spheres part with the coefficient of restitution that the scene asks for, whatever their speed",
    source: "Schwager & Pöschel, Granular Matter 9 (2007) 465: damped oscillator without a pull",
    run: asked_restitution,
};

pub const TANGENTIAL: VerificationCase = VerificationCase {
    name: "friction-constant-load",
    about: "tangential force over displacement at constant normal force, both laws",
    source: "Mindlin 1949; Mindlin & Deresiewicz 1953",
    run: constant_load,
};

pub const ROLLING: VerificationCase = VerificationCase {
    name: "sliding-to-rolling",
    about: "a sphere thrown to slide ends up rolling: when, and how fast, both laws",
    source: "Timoshenko & Young, Advanced Dynamics, 1948: 2 v₀/(7 μ g′), (5/7) v₀",
    run: sliding_to_rolling,
};

pub(super) const TANGENTIAL_LAWS: [&str; 2] = ["mindlin", "mindlin-deresiewicz"];

/// The two equal spheres of a scene.
fn pair(simulation: &Simulation) -> Pair {
    let m = &simulation.spec.material;
    Pair::equal_spheres(0.5 * simulation.spec.spheres[0].diameter, m.young, m.poisson, m.density)
}

pub(super) fn overlap(engine: &Engine) -> f64 {
    let s = engine.state();
    s.radius[0] + s.radius[1] - (s.x.get(1) - s.x.get(0)).length()
}

/// Duration from touch to parting (s), interpolated (NaN when they do not part), and the greatest overlap (m).
pub(super) fn collide(simulation: &mut Simulation) -> Result<(f64, f64)> {
    let (mut deepest, mut end, mut before) = (0.0f64, f64::NAN, 0.0);
    let dt = simulation.engine.time_step();
    simulation.run(|engine| {
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
fn hertz(context: &Context) -> Result<Vec<Comparison>> {
    let speed = 1.0;
    let (mut points, mut finest) = (Vec::new(), None);
    for step in context.pick(&[400.0, 200.0, 100.0][..], &[800.0, 400.0, 200.0, 100.0, 50.0]) {
        let mut simulation = context.simulation("verify/hertz", &[set("time.step", format!("{step} ns"))])?;
        let exact = pair(&simulation);
        let (time, depth) = collide(&mut simulation)?;
        let v = &simulation.engine.state().v;
        let rebound = v.z[1] - v.z[0];
        let whole = exact.contact_time(speed);
        let spent = simulation.finish();
        points.push(Point { resolution: step * 1e-9 / whole, error: time / whole - 1.0, spent });
        finest = Some((time, depth, rebound, exact));
    }
    let (time, depth, rebound, exact) = finest.expect("there are steps");
    let spent = points.last().map_or(Spent::default(), |p| p.spent);
    Ok(vec![
        Comparison::new("contact time", "s", time, exact.contact_time(speed), spent)
            .within(1e-3)
            .converging("dt/T", points, 2.0, 0.1),
        Comparison::new("greatest overlap", "m", depth, exact.greatest_overlap(speed), spent).within(1e-3),
        Comparison::new("speed of rebound", "m/s", rebound, speed, spent).within(1e-6),
    ])
}

/// Speed of parting over `speed` of approach (m/s) of the two spheres of a scene, whose elastic contact takes 2000 steps; with
/// plasticity or damping it takes longer.
fn parting(context: &Context, scene: &str, exact: &Pair, speed: f64, more: &[String]) -> Result<(f64, Spent)> {
    let half = |sign: f64| format!(r#"["0 m/s", "0 m/s", "{:e} m/s"]"#, 0.5 * sign * speed);
    let time = exact.contact_time(speed);
    let mut options = vec![
        set("sphere.0.velocity", half(1.0)),
        set("sphere.1.velocity", half(-1.0)),
        set("time.step", format!("{:e} s", time / 2000.0)),
        set("stop.time", format!("{:e} s", 6.0 * time)),
    ];
    options.extend_from_slice(more);
    let mut simulation = context.simulation(scene, &options)?;
    simulation.run(|_| {})?;
    let v = &simulation.engine.state().v;
    Ok(((v.z[1] - v.z[0]) / speed, simulation.finish()))
}

fn thornton_restitution(context: &Context) -> Result<Vec<Comparison>> {
    let still = context.simulation("verify/thornton", &[])?;
    let exact = pair(&still);
    let pressure = match still.spec.contact.as_ref().map(|c| &c.normal) {
        Some(NormalSpec::Thornton { limiting_pressure }) => *limiting_pressure,
        _ => unreachable!("the scene is elastoplastic"),
    };
    let collide_at = |ratio: f64| {
        let speed = ratio * thornton::yield_velocity(&exact, pressure);
        let (restitution, spent) = parting(context, "verify/thornton", &exact, speed, &[])?;
        let what = format!("restitution at V/V_y = {ratio}");
        Ok(Comparison::new(what, "-", restitution, thornton::restitution(ratio), spent).within(1e-3))
    };
    [0.9, 1.5, 3.0, 10.0, 100.0].into_iter().map(collide_at).collect()
}

/// At two speeds; damping is up to 0.73 of critical.
fn asked_restitution(context: &Context) -> Result<Vec<Comparison>> {
    let exact = pair(&context.simulation("verify/hertz", &[])?);
    let collide_at = |(coefficient, speed): (f64, f64)| {
        let key = set("contact.restitution", coefficient);
        let (found, spent) = parting(context, "verify/hertz", &exact, speed, &[key])?;
        let what = format!("asked for {coefficient} at {speed} m/s");
        Ok(Comparison::new(what, "-", found, coefficient, spent).within(1e-3))
    };
    let coefficients = [0.8, 0.6, 0.4, 0.2];
    coefficients.into_iter().flat_map(|e| [(e, 1.0), (e, 1e-3)]).map(collide_at).collect()
}

/// At every tenth of the displacement at which the whole contact slides, up to 1.3 of it.
fn constant_load(context: &Context) -> Result<Vec<Comparison>> {
    let of_law = |law: &'static str| {
        let mut simulation = context.simulation("verify/tangential", &[set("contact.tangential", law)])?;
        let (spec, exact) = (&simulation.spec, pair(&simulation));
        let depth = overlap(&simulation.engine);
        let held = Held {
            shear_modulus: effective_shear_modulus(spec.material.shear(), spec.material.poisson),
            radius: (exact.radius * depth).sqrt(),
            normal_force: exact.force(depth),
            friction: spec.contact.as_ref().map_or(0.0, |c| c.friction),
        };
        let rate = spec.holds[1].spin.y * (0.5 * spec.spheres[1].diameter - 0.5 * depth);
        let whole = held.sliding_displacement();
        let mut seen = Vec::new();
        simulation.run_to(1.3 * whole / rate, |engine| {
            let slip = rate * engine.time();
            if slip / whole >= 0.1 * (seen.len() + 1) as f64 {
                seen.push((slip, engine.state().force.x[1].abs()));
            }
        })?;
        let spent = simulation.finish();
        let points = seen.len();
        let compare = |(slip, force): (f64, f64)| {
            let exact = if law == "mindlin" { held.no_slip_force(slip) } else { held.partial_slip_force(slip) };
            let what = format!("{law}: force, worst of {points}: {:.1} of sliding", slip / whole);
            Comparison::new(what, "N", force, exact, Spent::default()).within(5e-3)
        };
        Ok(Comparison { spent, ..Comparison::worst(seen.into_iter().map(compare).collect()) })
    };
    TANGENTIAL_LAWS.into_iter().map(of_law).collect()
}

/// A sphere that is thrown to slide on something.
pub(super) struct Thrown {
    /// Its particle.
    pub sphere: usize,
    /// Arm of friction about its centre (m).
    pub arm: f64,
    /// How fast it is thrown, along x (m/s).
    pub speed: f64,
    /// Coefficient of friction (-).
    pub friction: f64,
    /// By how much it is pressed on (N).
    pub force: f64,
}

impl Thrown {
    /// When it rolls, and how fast then in the mean over the ringing of the tangential spring, under a law of friction.
    pub fn rolls(&self, mut simulation: Simulation, law: &str) -> Result<[Comparison; 2]> {
        let Self { sphere, arm, speed, friction, force } = *self;
        let start = sliding::rolling_start(speed, friction, force / simulation.engine.assembly().mass[sphere]);
        let (mut rolls, mut sum, mut count) = (f64::NAN, 0.0, 0);
        simulation.run_to(2.0 * start, |engine| {
            let s = engine.state();
            let slip = s.v.x[sphere] - s.w.y[sphere] * arm;
            if rolls.is_nan() && slip <= 0.0 {
                rolls = engine.time();
            }
            if engine.time() > 1.2 * start {
                sum += s.v.x[sphere];
                count += 1;
            }
        })?;
        let (mean, spent) = (sum / f64::from(count), simulation.finish());
        let exact = sliding::rolling_speed(speed);
        Ok([
            Comparison::new(format!("{law}: it rolls from"), "s", rolls, start, spent).within(1e-2),
            Comparison::new(format!("{law}: speed then"), "m/s", mean, exact, spent).within(2e-3),
        ])
    }
}

/// Slip ends at 2v₀/(7μg′); from then on the speed is (5/7)v₀ in the mean over the ringing of the tangential spring.
fn sliding_to_rolling(context: &Context) -> Result<Vec<Comparison>> {
    let mut comparisons = Vec::new();
    for law in TANGENTIAL_LAWS {
        let (radius, floor, force, speed, friction) = (0.5e-3, 1.0, 10e-3, 0.5, 0.2);
        let m = context.simulation("verify/rolling", &[])?.spec.material;
        let modulus = m.young / (2.0 * (1.0 - m.poisson * m.poisson));
        let reduced = radius * floor / (radius + floor);
        let depth = (0.75 * force / (modulus * f64::sqrt(reduced))).powf(2.0 / 3.0);
        let height = format!(r#"["0 m", "0 m", "{:.17e} m"]"#, radius - depth);
        let simulation = context
            .simulation("verify/rolling", &[set("sphere.1.position", height), set("contact.tangential", law)])?;
        let thrown = Thrown { sphere: 1, arm: radius - 0.5 * depth, speed, friction, force };
        comparisons.extend(thrown.rolls(simulation, law)?);
    }
    Ok(comparisons)
}
