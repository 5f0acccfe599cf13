//! A wire that slides round another, and round a rigid cylinder.

use super::case::VerificationCase;
use super::comparison::{Comparison, Point, Spent};
use super::support::{Context, set};
use crate::base::error::Result;
use crate::reference::capstan::{Wrapped, string_ratio};
use crate::scene;
use crate::scene::spec::PathSpec;
use crate::strand::helix::Helix;
use glam::DVec3;

pub const CAPSTAN: VerificationCase = VerificationCase {
    name: "capstan",
    about: "a thin wire slides round a thick one: growth of its tension",
    source: "Euler 1769, T2 = T1 e^(mu phi); Kirchhoff's equations of a rod for the wire's thickness",
    run: capstan,
};

pub const DRUM: VerificationCase = VerificationCase {
    name: "capstan-on-drum",
    about: "a thin wire slides round a rigid cylinder: growth of its tension",
    source: CAPSTAN.source,
    run: on_drum,
};

/// Share of the length at either end that does not count: the free ends bend off the drum there.
const ENDS: f64 = 0.15;

/// Tension along the middle of the winding.
struct Slide {
    /// Tension after over before.
    ratio: f64,
    wire: Wrapped,
    /// Length in between (m).
    length: f64,
    /// Angle from bond to bond (rad).
    corner: f64,
    spent: Spent,
}

fn slide(context: &Context, name: &str, friction: f64, spacing: f64) -> Result<Slide> {
    // A step in proportion to the spacing, as the bonds ask for.
    let options =
        [set("spacing", spacing), set("contact.friction", friction), set("time.step", format!("{} ns", 8.0 * spacing))];
    let scene = scene::load(name, &options)?;
    let spec = &scene.spec;
    let strand = spec.strand.as_ref().expect("the scene has a winding");
    let (layer, height) = (&strand.layers[0], strand.length);
    let radius = layer.lay_radius.expect("the scene gives it");
    let helix = Helix { radius, pitch: layer.pitch, lay: layer.lay, phase: layer.phase };
    let wire = Wrapped { friction, curvature: helix.curvature(), radius: 0.5 * layer.wire_diameter };
    let axis = |z: f64| DVec3::Z * (0.5 * height + z);
    let end = spec.stop.time.expect("the scene says when it ends");
    let scene = scene.changed(|spec| {
        if let Some(drum) = spec.wires.first_mut() {
            // One bond of the drum, so that its own particles are out of reach.
            let half = 0.5 * spacing * drum.diameter;
            drum.path = PathSpec::Straight { from: axis(-half), to: axis(half) };
        }
        let [.., back, pulled] = &mut spec.holds[..] else { return };
        back.force = -helix.tangent(0.0) * back.force.length();
        pulled.velocity = helix.tangent(height) * pulled.velocity.length();
    });
    let mut simulation = context.simulation_of(scene)?;
    let bonds = simulation.bonds();
    let skipped = (ENDS * bonds as f64).round() as usize;
    let [first, last] = [skipped, bonds - 1 - skipped];
    let ratio = simulation.settled(0.5 * end, end, |engine| {
        let s = engine.state();
        let tension = |k: usize| s.bond.pull(k).dot((s.x.get(k + 1) - s.x.get(k)).normalize());
        tension(last) / tension(first)
    })?;
    let piece = helix.arc_length(height) / bonds as f64;
    let (length, corner) = (piece * (last - first) as f64, wire.curvature * piece);
    Ok(Slide { ratio, wire, length, corner, spent: simulation.finish() })
}

fn capstan(context: &Context) -> Result<Vec<Comparison>> {
    of_scene(context, "verify/capstan")
}

fn on_drum(context: &Context) -> Result<Vec<Comparison>> {
    of_scene(context, "verify/capstan-on-drum")
}

fn of_scene(context: &Context, scene: &str) -> Result<Vec<Comparison>> {
    let mut found = Vec::new();
    for friction in context.pick(&[0.2][..], &[0.1, 0.2, 0.4]) {
        let mut points = Vec::new();
        let mut finest = None;
        for spacing in context.pick(&[5.0, 2.5][..], &[5.0, 2.5, 1.25]) {
            let s = slide(context, scene, *friction, *spacing)?;
            let exact = (s.wire.rate() * s.length).exp();
            points.push(Point { resolution: s.corner, error: s.ratio.ln() / exact.ln() - 1.0, spent: s.spent });
            finest = Some((s, exact));
        }
        let (s, exact) = finest.expect("there are spacings");
        let angle = s.wire.curvature * s.length;
        let string = string_ratio(*friction, angle);
        found.push(
            Comparison::new(format!("T2/T1 over {angle:.2} rad, mu = {friction}"), "-", s.ratio, exact, s.spent)
                .within(2e-2)
                .over("angle of a corner", points)
                .note(format!(
                    "A string without thickness has e^(mu phi) = {string:.3}; here friction acts r inside the wire's \
                     axis, which takes r/(R + r) = {:.1} % off the exponent.",
                    100.0 * s.wire.radius * s.wire.curvature
                )),
        );
    }
    Ok(found)
}
