//! Rigid bodies: a sphere on a plane, and a wire between pins.

use super::case::VerificationCase;
use super::comparison::{Comparison, Point, Spent};
use super::contacts::{TANGENTIAL_LAWS, Thrown};
use super::support::{Context, Simulation, set};
use crate::base::error::Result;
use crate::engine::Engine;
use crate::engine::view::BodyState;
use crate::reference::hertz::Pair;

pub const IMPACT: VerificationCase = VerificationCase {
    name: "sphere-on-plane",
    about: "an elastic sphere meets a plane: duration, force, depth and rebound",
    source: "Hertz 1882; Johnson, Contact Mechanics, 1985, section 11.4: 2.868 (m²/(R E*² v))^(1/5)",
    run: impact,
};

pub const ROLLING: VerificationCase = VerificationCase {
    name: "rolling-on-plane",
    about: "a sphere thrown to slide on a plane ends up rolling: when, and how fast",
    source: "Timoshenko & Young, Advanced Dynamics, 1948: 2 v₀/(7 μ g′), (5/7) v₀",
    run: rolling,
};

pub const BENDING: VerificationCase = VerificationCase {
    name: "three-point-bending",
    about: "a wire on two pins is bent by a third: force over deflection, at any spacing",
    source: "Timoshenko & Gere, Mechanics of Materials: F L³/(48 E I) + F L/(4 κ G A)",
    run: bending,
};

/// A rigid body as it is now.
fn body(engine: &Engine, number: usize) -> BodyState {
    engine.view().rigid.map(|rigid| rigid.bodies()[number]).expect("the scene has bodies")
}

/// The sphere of a scene against a plane of its own material that does not move.
fn against_plane(simulation: &Simulation) -> Pair {
    let m = &simulation.spec.material;
    Pair {
        modulus: m.young / (2.0 * (1.0 - m.poisson * m.poisson)),
        radius: 0.5 * simulation.spec.spheres[0].diameter,
        mass: simulation.engine.assembly().mass[0],
    }
}

fn impact(context: &Context) -> Result<Vec<Comparison>> {
    let speed = 1.0;
    let (mut points, mut finest) = (Vec::new(), None);
    for step in context.pick(&[40.0, 20.0, 10.0, 5.0][..], &[80.0, 40.0, 20.0, 10.0, 5.0]) {
        let mut simulation = context.simulation("verify/sphere-on-plane", &[set("time.step", format!("{step} ns"))])?;
        let exact = against_plane(&simulation);
        let radius = 0.5 * simulation.spec.spheres[0].diameter;
        let (mut deepest, mut strongest, mut end, mut before) = (0.0f64, 0.0f64, f64::NAN, 0.0);
        let dt = simulation.engine.time_step();
        simulation.run(|engine| {
            let now = radius - engine.state().x.z[0];
            if end.is_nan() && before > 0.0 && now <= 0.0 {
                end = engine.time() - dt * now / (now - before);
            }
            (deepest, before) = (deepest.max(now), now);
            strongest = strongest.max(-body(engine, 0).force[2]);
        })?;
        let rebound = simulation.engine.state().v.z[0];
        let whole = exact.contact_time(speed);
        let spent = simulation.finish();
        points.push(Point { resolution: step * 1e-9 / whole, error: end / whole - 1.0, spent });
        finest = Some((end, deepest, strongest, rebound, exact));
    }
    let (time, depth, force, rebound, exact) = finest.expect("there are steps");
    let spent = points.last().map_or(Spent::default(), |p| p.spent);
    let deepest = exact.greatest_overlap(speed);
    Ok(vec![
        Comparison::new("contact time", "s", time, exact.contact_time(speed), spent)
            .within(1e-3)
            .converging("dt/T", points, 2.0, 0.1),
        Comparison::new("greatest overlap", "m", depth, deepest, spent).within(1e-3),
        Comparison::new("greatest force on the plane", "N", force, exact.force(deepest), spent).within(1e-3),
        Comparison::new("speed of rebound", "m/s", rebound, speed, spent).within(1e-6),
    ])
}

/// As for two spheres; the arm of friction is the radius less half of the overlap.
fn rolling(context: &Context) -> Result<Vec<Comparison>> {
    let mut comparisons = Vec::new();
    for law in TANGENTIAL_LAWS {
        let (radius, force, speed, friction) = (0.5e-3, 10e-3, 0.5, 0.2);
        let exact = against_plane(&context.simulation("verify/rolling-on-plane", &[])?);
        let depth = (0.75 * force / (exact.modulus * exact.radius.sqrt())).powf(2.0 / 3.0);
        let height = format!(r#"["0 m", "0 m", "{:.17e} m"]"#, radius - depth);
        let options = [set("sphere.0.position", height), set("contact.tangential", law)];
        let simulation = context.simulation("verify/rolling-on-plane", &options)?;
        let thrown = Thrown { sphere: 0, arm: radius - 0.5 * depth, speed, friction, force };
        comparisons.extend(thrown.rolls(simulation, law)?);
    }
    Ok(comparisons)
}

/// Deflection of the wire between the pins (m), which stand at particles.
fn deflection(engine: &Engine, pins: [f64; 3]) -> f64 {
    let (state, rest) = (engine.state(), &engine.assembly().position);
    let at = |z: f64| {
        let nearest = (0..state.len()).min_by(|a, b| (rest.z[*a] - z).abs().total_cmp(&(rest.z[*b] - z).abs()));
        state.x.y[nearest.unwrap_or(0)]
    };
    0.5 * (at(pins[0]) + at(pins[1])) - at(pins[2])
}

fn bending(context: &Context) -> Result<Vec<Comparison>> {
    let at_spacing = |spacing: f64| {
        let mut simulation = context.simulation("verify/three-point-bending", &[set("spacing", spacing)])?;
        let pins: Vec<f64> = simulation.spec.rigids.iter().map(|rigid| rigid.position.z).collect();
        let pins = [pins[0], pins[1], pins[2]];
        let (from, to) = (0.5e-3, simulation.spec.stop.time.unwrap_or_default());
        let mut deflections = (0.0, 0.0);
        let force = simulation.settled(from, to, |engine| {
            let phase = (engine.time() - from) / (to - from);
            if (0.0..=1.0).contains(&phase) {
                let weight = (std::f64::consts::PI * phase).sin().powi(2) * engine.time_step();
                deflections = (deflections.0 + weight * deflection(engine, pins), deflections.1 + weight);
            }
            body(engine, 2).force[1]
        })?;
        let exact = simulation.bar().three_point_deflection(pins[1] - pins[0], force);
        let spent = simulation.finish();
        let what = format!("deflection at spacing {spacing}");
        Ok(Comparison::new(what, "m", deflections.0 / deflections.1, exact, spent).within(5e-3))
    };
    context.pick(&[1.0, 0.5][..], &[1.0, 0.5, 0.25]).iter().map(|spacing| at_spacing(*spacing)).collect()
}
