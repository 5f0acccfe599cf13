//! A helix pulled as a spring.

use super::case::VerificationCase;
use super::comparison::{Comparison, Point};
use super::support::{Context, Simulation, set};
use crate::base::error::Result;
use crate::reference::spring::Spring;

pub const SPRING: VerificationCase = VerificationCase {
    name: "spring",
    about: "an open-coiled helical spring is pulled along its axis, ends held or free to turn: stiffness",
    source: "Love, Mathematical Theory of Elasticity, 1927, section 271; Timoshenko, Strength of Materials II, section 56",
    run: spring,
};

/// The helix of a simulation, with the length of its wire as it was before it was cut into chords.
fn helix(simulation: &Simulation) -> Spring {
    let strand = simulation.spec.strand.as_ref().expect("the scene has a coil");
    let layer = &strand.layers[0];
    let mut spring =
        Spring { wire: simulation.bar(), radius: layer.lay_radius.expect("given by the scene"), pitch: layer.pitch };
    spring.wire.length = crate::reference::helix::arc_length(spring.radius, spring.pitch, strand.length);
    spring
}

/// Force over displacement, both averaged under the same window while the displacement grows evenly (N/m).
fn stiffness(simulation: &mut Simulation) -> Result<f64> {
    let end = simulation.spec.stop.time.expect("the scene says when it ends");
    let last = simulation.bonds() - 1;
    let mut moved = (0.0, 0.0);
    let force = simulation.settled(0.0, end, |engine| {
        let s = engine.state();
        let weight = (std::f64::consts::PI * engine.time() / end).sin().powi(2) * engine.time_step();
        let pulled = s.x.z[last + 1] - engine.assembly().position.z[last + 1];
        moved = (moved.0 + weight * pulled, moved.1 + weight);
        0.5 * (s.bond.pull(0).z + s.bond.pull(last).z)
    })?;
    Ok(force * moved.1 / moved.0)
}

fn spring(context: &Context) -> Result<Vec<Comparison>> {
    let mut found = Vec::new();
    for free in [false, true] {
        let mut points = Vec::new();
        let mut finest = None;
        for spacing in context.pick(&[3.0, 1.5, 0.75][..], &[3.0, 1.5, 0.75, 0.5]) {
            let options = [set("spacing", spacing), set("grip.free_rotation", free)];
            let mut simulation = context.simulation("verify/spring", &options)?;
            let helix = helix(&simulation);
            let value = stiffness(&mut simulation)?;
            let spent = simulation.finish();
            let exact = helix.clamped(free);
            points.push(Point {
                resolution: spacing * helix.wire.diameter / helix.radius,
                error: value / exact - 1.0,
                spent,
            });
            finest = Some((value, exact, helix, spent));
        }
        let (value, exact, helix, spent) = finest.expect("there are spacings");
        let ends = if free { "free to turn" } else { "held" };
        let central = if free { helix.central_free() } else { helix.central_held() };
        let note = format!(
            "G d^4/(8 D^3 n) of a close-coiled spring is {:+.1} % off: here D/d = {:.0}, the coils rise by {:.0} degrees, and clamps keep two turns from tilting (a central force alone gives {:+.1} %).",
            100.0 * (helix.close_coiled() / exact - 1.0),
            2.0 * helix.radius / helix.wire.diameter,
            (helix.pitch / (std::f64::consts::TAU * helix.radius)).atan().to_degrees(),
            100.0 * (central / exact - 1.0),
        );
        found.push(
            Comparison::new(format!("stiffness, ends {ends}"), "N/m", value, exact, spent)
                .within(context.pick(1e-2, 5e-3))
                .converging("a/R", points, 2.0, 0.2)
                .note(note),
        );
    }
    Ok(found)
}
