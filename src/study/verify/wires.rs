//! Smooth wires beside chains of spheres, under a sphere, and across each other.

use super::case::VerificationCase;
use super::comparison::{Comparison, Point, Spent};
use super::support::{Context, set};
use crate::base::error::Result;
use crate::law::contact::line::LINE;
use crate::reference::hertz::{Pair, elliptical_factor};
use crate::reference::thornton;
use crate::scene;

pub const SLIDING_WIRES: VerificationCase = VerificationCase {
    name: "sliding-wires",
    about: "a wire is dragged along another: smooth ones feel friction alone, chains of spheres interlock",
    source: "Coulomb; a sphere of radius r rolls from crest to saddle of two touching ones: height 2r to sqrt(3) r",
    run: sliding_wires,
};

pub const SPHERE_ON_WIRE: VerificationCase = VerificationCase {
    name: "sphere-on-wire",
    about: "a sphere pressed into a smooth wire: normal force",
    source: "Hertz 1882; Johnson, Contact Mechanics, 1985, section 4.2",
    run: sphere_on_wire,
};

pub const CROSSED_WIRES: VerificationCase = VerificationCase {
    name: "crossed-wires",
    about: "two smooth wires pressed together, parallel and crossed, particles at any spacing: force",
    source: "Hertz's ellipse, Johnson, Contact Mechanics, 1985, section 4.2; Thornton 1997; 0.3 E* per length for parallel wires",
    run: crossed_wires,
};

/// What dragging one wire along the other took; forces along the wires over the load.
struct Drag {
    /// Greatest.
    greatest: f64,
    /// At the end.
    last: f64,
    /// Furthest from that of touching spheres on the way from crest to saddle, and that.
    furthest: [f64; 2],
    /// Rise of the dragged wire over the wires' radius.
    rise: f64,
    spent: Spent,
}

fn drag(context: &Context, options: &[String]) -> Result<Drag> {
    let mut simulation = context.simulation("verify/parallel-wires", options)?;
    let load = simulation.spec.holds[1].force.x.abs();
    let a = simulation.engine.assembly();
    let (second, spacing) = (a.wires[1], a.rest_length[0]);
    let middle = second.first + second.len / 2;
    let settled = 0.1 * simulation.spec.stop.time.expect("the scene says when it ends");
    let (mut low, mut high) = (f64::MAX, f64::MIN);
    let mut drag = Drag { greatest: 0.0, last: 0.0, furthest: [0.0; 2], rise: 0.0, spent: Spent::default() };
    simulation.run(|engine| {
        if engine.time() < settled {
            return;
        }
        let s = engine.state();
        drag.last = second.particles().map(|p| s.force_from_contacts(p).z).sum::<f64>() / load;
        drag.greatest = drag.greatest.max(drag.last.abs());
        let beside = s.x.z[middle].rem_euclid(spacing);
        if beside < 0.5 * spacing && engine.time() < 4.0 * settled {
            let exact = beside / (4.0 * s.radius[0].powi(2) - beside * beside).sqrt();
            if (drag.last - exact).abs() > (drag.furthest[0] - drag.furthest[1]).abs() {
                drag.furthest = [drag.last, exact];
            }
        }
        let height = s.x.x[middle];
        (low, high) = (low.min(height), high.max(height));
    })?;
    drag.rise = (high - low) / simulation.engine.state().radius[middle];
    Ok(Drag { spent: simulation.finish(), ..drag })
}

fn sliding_wires(context: &Context) -> Result<Vec<Comparison>> {
    let smooth = drag(context, &[])?;
    let rough = drag(context, &[set("contact.tangential", "mindlin"), set("contact.friction", 0.2)])?;
    // A little further, so that the next crest is passed.
    let beads = drag(context, &[set("contact.shape", "sphere"), set("stop.time", "4 ms")])?;
    let [off, exact] = beads.furthest;
    Ok(vec![
        Comparison::new("smooth, no friction: greatest drag over load", "-", smooth.greatest, 0.0, smooth.spent)
            .relative_to(1.0)
            .within(1e-5),
        Comparison::new("smooth, mu = 0.2: drag over load", "-", -rough.last, 0.2, rough.spent).within(2e-2),
        Comparison::new(
            "spheres, no friction: push over load towards the saddle, furthest off",
            "-",
            off,
            exact,
            beads.spent,
        )
        .relative_to(1.0 / 3f64.sqrt())
        .within(2e-2),
        Comparison::new("spheres: rise from saddle to crest over r", "-", beads.rise, 2.0 - 3f64.sqrt(), beads.spent)
            .within(5e-3)
            .note("Real wires are smooth; shape = \"sphere\" adds this geometric friction, shape = \"wire\" does not."),
    ])
}

fn sphere_on_wire(context: &Context) -> Result<Vec<Comparison>> {
    let (mut own, mut points) = (Vec::new(), Vec::new());
    let mut finest = None;
    for diameter in [1.0, 4.0, 16.0] {
        let place = 0.5 * diameter + 0.499;
        let options = [
            set("wire.0.diameter", format!("{diameter} mm")),
            set("sphere.0.position", format!(r#"["{place} mm", "0 mm", "0.13 mm"]"#)),
        ];
        let scene = scene::load("verify/sphere-on-wire", &options)?;
        let spec = &scene.spec;
        let (m, wire, sphere) = (spec.material, 0.5 * spec.wires[0].diameter, 0.5 * spec.spheres[0].diameter);
        let depth = wire + sphere - spec.spheres[0].position.x;
        let round = 1.0 / (1.0 / wire + 1.0 / sphere);
        let pair = Pair { radius: (round * sphere).sqrt(), ..Pair::equal_spheres(1.0, m.young, m.poisson, m.density) };
        let mut simulation = context.simulation_of(scene)?;
        simulation.run(|_| {})?;
        let s = simulation.engine.state();
        let force = s.force_from_contacts(s.len() - 1).x;
        let spent = simulation.finish();
        let what = "force at the geometric mean of the radii of curvature";
        own.push(Comparison::new(what, "N", force, pair.force(depth), spent).within(1e-9));
        let exact = pair.force(depth) * elliptical_factor(sphere / round);
        points.push(Point { resolution: sphere / wire, error: force / exact - 1.0, spent });
        finest = Some((force, exact, spent));
    }
    let (force, exact, spent) = finest.expect("there are wires");
    // Relative radii of curvature 1/R sphere and 1/R sphere + 1/R wire.
    let ellipse = |sphere: f64, wire: f64| 100.0 * (1.0 - 1.0 / elliptical_factor(1.0 + sphere / wire));
    Ok(vec![
        Comparison::worst(own),
        Comparison::new("force of the elliptical contact, wire of 16 mm", "N", force, exact, spent)
            .within(5e-3)
            .converging("R sphere/R wire", points, 2.0, 0.4)
            .note(format!(
                "The law knows one radius of curvature and takes the geometric mean of the two; Hertz's ellipse is \
                 stiffer: by {:.1} % for a sphere on a wire of its own diameter, {:.1} % on one of 0.4 of it.",
                ellipse(1.0, 1.0),
                ellipse(1.0, 0.4)
            )),
    ])
}

/// Approach of the two wires (m).
const APPROACH: f64 = 4e-6;
/// Angles between them (degrees).
const ANGLES: [f64; 6] = [0.0, 2.0, 10.0, 30.0, 60.0, 90.0];

/// Force between two wires of the scene that cross at `angle` (degrees) off their particles, with particles `spacing`
/// diameters apart and `options`, and the length over which parallel wires lie side by side (m).
fn crossed(context: &Context, angle: f64, spacing: f64, options: &[String]) -> Result<(f64, f64, Spent)> {
    // A patch at 2 degrees is 3 mm long.
    let half = if angle == 2.0 { 8.0 } else { 3.2 };
    let (sine, cosine) = angle.to_radians().sin_cos();
    // Crossed off the middle of both wires.
    let (first, second) = (0.13, -0.07);
    let place = |along: f64| {
        let x = 0.4 - APPROACH * 1e3;
        format!(r#"["{x} mm", "{} mm", "{} mm"]"#, along * sine, along * cosine)
    };
    let mut all = vec![
        set("spacing", spacing),
        set("wire.0.from", format!(r#"["0 mm", "0 mm", "{} mm"]"#, first - half)),
        set("wire.0.to", format!(r#"["0 mm", "0 mm", "{} mm"]"#, first + half)),
        set("wire.1.from", place(second - half)),
        set("wire.1.to", place(second + half)),
    ];
    all.extend_from_slice(options);
    let simulation = context.simulation("verify/crossed-wires", &all)?;
    let wire = simulation.engine.assembly().wires[1];
    let force = wire.particles().map(|p| simulation.engine.state().force_from_contacts(p).x).sum();
    Ok((force, (2.0 * half - (first - second).abs()) * 1e-3, simulation.finish()))
}

fn crossed_wires(context: &Context) -> Result<Vec<Comparison>> {
    let mut comparisons = Vec::new();
    let m = scene::load("verify/crossed-wires", &[])?.spec;
    let (radius, m) = (0.5 * m.wires[0].diameter, m.material);
    let ball = Pair { radius, ..Pair::equal_spheres(1.0, m.young, m.poisson, m.density) };
    for angle in ANGLES {
        let (mut own, mut forces) = (Vec::new(), Vec::new());
        for spacing in [2.0, 1.0, 0.5, 0.25] {
            let (force, length, spent) = crossed(context, angle, spacing, &[])?;
            let exact = if angle == 0.0 {
                LINE * ball.modulus * APPROACH * length
            } else {
                let (sine, cosine) = angle.to_radians().sin_cos();
                let pair = Pair { radius: radius / sine, ..ball };
                pair.force(APPROACH) * elliptical_factor((1.0 + cosine) / (1.0 - cosine))
            };
            own.push(Comparison::new(format!("force at {angle} degrees"), "N", force, exact, spent).within(1e-2));
            forces.push((force, spent));
        }
        comparisons.push(Comparison::worst(own));
        let (most, least) = forces.iter().fold((0.0f64, f64::MAX), |(a, b), (f, _)| (a.max(*f), b.min(*f)));
        let what = format!("force at {angle} degrees, greatest over least for a/d from 2 to 0.25");
        comparisons.push(Comparison::new(what, "-", most / least, 1.0, forces[0].1).within(1e-2));
    }
    comparisons.extend(pressed_wires(context, &ball)?);
    Ok(comparisons)
}

/// The same with a limiting pressure, at right angles: Thornton's law for spheres of the wires' radius in pairs.
fn pressed_wires(context: &Context, ball: &Pair) -> Result<Vec<Comparison>> {
    let mut own = Vec::new();
    for pressure in [0.5e9, 2e9, 8e9] {
        for spacing in [2.0, 0.25] {
            let options =
                [set("contact.normal", "thornton"), set("contact.limiting_pressure", format!("{pressure} Pa"))];
            let (force, _, spent) = crossed(context, 90.0, spacing, &options)?;
            let exact = thornton::force(ball, pressure, APPROACH, APPROACH);
            own.push(
                Comparison::new("force at 90 degrees under a limiting pressure", "N", force, exact, spent).within(2e-2),
            );
        }
    }
    Ok(vec![Comparison::worst(own).note(
        "Force per length on the limit is Abel's inversion of Thornton's law, whose series is cut off: within 0.8 %; four \
         points per stretch integrate an ellipse to 0.6 %.",
    )])
}
