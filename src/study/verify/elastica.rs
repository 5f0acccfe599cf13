//! Large deflection of a cantilever.

use super::case::VerificationCase;
use super::comparison::{Comparison, Point, Spent};
use super::support::{Context, set};
use crate::base::error::Result;
use crate::reference::elastica;
use crate::scene;
use glam::DVec2;
use std::f64::consts::PI;

pub const ELASTICA: VerificationCase = VerificationCase {
    name: "elastica",
    about: "a slender cantilever is bent far round by a force at its tip: where the tip goes",
    source: "Bisshopp & Drucker, Q. Appl. Math. 3 (1945) 272",
    run: elastica,
};

/// Hann's window over `from..to`, that of [`super::support::Simulation::settled`].
fn window(time: f64, from: f64, to: f64) -> f64 {
    let phase = ((time - from) / (to - from)).clamp(0.0, 1.0);
    (PI * phase).sin().powi(2)
}

/// Tip over the length, across and along the clamp, under P L²/(E I) = `load` with a spacing of `spacing` diameters.
fn tip(context: &Context, load: f64, spacing: f64) -> Result<(DVec2, Spent)> {
    let scene = scene::load("verify/elastica", &[set("spacing", spacing)])?;
    let bar = context.simulation_of(scene.clone())?.bar();
    let scene =
        scene.changed(|spec| spec.holds[1].force.x = load * bar.young * bar.second_moment() / bar.length.powi(2));
    let spec = &scene.spec;
    let (from, to) = (spec.holds[1].ramp, spec.stop.time.expect("the scene says when it ends"));
    let mut simulation = context.simulation_of(scene)?;
    let end = simulation.bonds();
    let (mut along, mut weights) = (0.0, 0.0);
    let across = simulation.settled(from, to, |engine| {
        let (s, weight) = (engine.state(), window(engine.time(), from, to) * engine.time_step());
        (along, weights) = (along + weight * s.x.z[end], weights + weight);
        s.x.x[end]
    })?;
    Ok((DVec2::new(across, along / weights) / bar.length, simulation.finish()))
}

/// Chords of a polygon with the curve's corners on it: order 2 in the spacing.
fn elastica(context: &Context) -> Result<Vec<Comparison>> {
    let mut found = Vec::new();
    for load in context.pick(&[10.0][..], &[1.0, 3.0, 10.0]) {
        let exact = elastica::tip(*load);
        let exact = DVec2::new(exact.deflection, exact.reach);
        let mut points = Vec::new();
        let mut finest = DVec2::NAN;
        for bonds in context.pick(&[5.0, 10.0][..], &[5.0, 10.0, 20.0]) {
            let (at, spent) = tip(context, *load, 160.0 / bonds)?;
            points.push(Point { resolution: 1.0 / bonds, error: at.distance(exact), spent });
            finest = at;
        }
        let what = |what: &str| format!("{what} of the tip over L, P L^2/(E I) = {load}");
        let spent = points.iter().map(|p| p.spent).sum();
        found.push(Comparison::new(what("deflection"), "-", finest.x, exact.x, spent).within(5e-3));
        found.push(
            Comparison::new(what("distance from the exact place"), "-", finest.distance(exact), 0.0, spent)
                .relative_to(1.0)
                .within(5e-3)
                .converging("a/L", points, 2.0, 0.3),
        );
    }
    Ok(found)
}
