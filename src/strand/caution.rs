//! What the geometry of a scene can be known to get wrong before it runs.

use crate::base::units::{self, Dimension};
use crate::scene::spec::{PathSpec, Spec};
use crate::strand::assembly::Assembly;
use crate::strand::discretise::build;
use crate::strand::error::mm;
use crate::strand::held;
use crate::strand::overlap::{self, Body, Overlap};
use crate::strand::resample::resample;
use glam::DVec3;

/// Deviation of a wire from the points that a file gives, over its radius, from which it is told (-).
const FAR: f64 = 0.1;
/// Spacing over the scene's at which it is asked whether overlaps come from chords that cut curves short (-).
const FINER: f64 = 0.25;

/// Everything about the geometry that the user should know before the run; empty when there is nothing.
pub fn cautions(spec: &Spec, assembly: &Assembly) -> Vec<String> {
    let of_stop =
        held::unreachable_strain(spec, assembly).map(|what| format!("{what}; another condition ends the run"));
    [held::loose_wires(spec, assembly), of_stop, strays(spec)].into_iter().flatten().collect()
}

/// How well a wire follows the points of its centreline file.
#[derive(Debug, Clone, PartialEq)]
pub struct Followed {
    /// Number of the wire, from 0, in [`Assembly::wires`].
    pub wire: usize,
    /// Greatest distance between the particles' polygon and the one through the points (m).
    pub deviation: f64,
    /// Points that repeat the one before and were left out.
    pub merged: usize,
    /// Radius of the wire (m).
    pub radius: f64,
}

/// Every wire that a file gives by points.
pub fn followed(spec: &Spec) -> Vec<Followed> {
    let before: usize = spec.strand.as_ref().map_or(0, |s| s.layers.iter().map(|l| l.wires).sum());
    let of_file = |(k, wire): (usize, &crate::scene::spec::WireSpec)| {
        let PathSpec::File { points, .. } = &wire.path else { return None };
        let chain = resample(points, spec.spacing * wire.diameter).ok()?;
        Some(Followed {
            wire: before + k,
            deviation: chain.deviation,
            merged: chain.merged,
            radius: 0.5 * wire.diameter,
        })
    };
    spec.wires.iter().enumerate().filter_map(of_file).collect()
}

/// One line on how well the wires follow the points given; `None` where none is given by points.
pub fn deviation(spec: &Spec) -> Option<String> {
    let all = followed(spec);
    let worst = all.iter().max_by(|a, b| a.deviation.total_cmp(&b.deviation))?;
    let merged: usize = all.iter().map(|one| one.merged).sum();
    let left_out = match merged {
        0 => String::new(),
        1 => "; 1 point repeats the one before it and was left out".into(),
        n => format!("; {n} points repeat the one before them and were left out"),
    };
    Some(format!(
        "centre lines by points: off by {} mm at most ({:.2} % of the radius, wire {}){left_out}",
        mm(worst.deviation),
        100.0 * worst.deviation / worst.radius,
        worst.wire + 1
    ))
}

fn strays(spec: &Spec) -> Option<String> {
    let off = |one: &Followed| one.deviation / one.radius;
    let worst = followed(spec).into_iter().max_by(|a, b| off(a).total_cmp(&off(b))).filter(|one| off(one) > FAR)?;
    Some(format!(
        "wire {} leaves the lines between the points of its file by up to {} mm, {:.0} % of its radius: where it runs \
         between them is a guess; give points closer together, check those that nearly coincide, or lower spacing where \
         particles are further apart than points",
        worst.wire + 1,
        mm(worst.deviation),
        100.0 * off(&worst)
    ))
}

/// What would close an overlap that a scene begins with, found by trying.
pub fn remedy(spec: &Spec, assembly: &Assembly) -> String {
    let Some(worst) = deepest(assembly) else {
        return "spheres that are out of register fall into each other's gaps: lower spacing, or take smooth wires"
            .into();
    };
    let place = format!(
        "wires {} and {} overlap most, by {} mm ({:.1} % of the diameter)",
        worst.bodies[0] + 1,
        worst.bodies[1] + 1,
        mm(worst.depth),
        100.0 * worst.share
    );
    let finer = Spec { spacing: FINER * spec.spacing, ..spec.clone() };
    let left = build(&finer).ok().map(|assembly| deepest(&assembly).map_or(0.0, |found| found.share));
    if left.is_some_and(|left| left < 0.5 * worst.share) {
        let left = 100.0 * left.unwrap_or(0.0);
        return format!(
            "{place}, because particles are too far apart to follow curved wires: spacing = {} leaves {left:.1} %",
            short(finer.spacing)
        );
    }
    let strand: usize = spec.strand.as_ref().map_or(0, |s| s.layers.iter().map(|l| l.wires).sum());
    if worst.bodies.iter().all(|wire| *wire < strand) {
        return format!("{place}: raise lay_radius there, or leave it to \"auto\"");
    }
    let factor = 1.0 - worst.share;
    let diameters = worst.bodies.map(|w| assembly.wires.get(w).map_or(f64::INFINITY, |wire| wire.diameter));
    // On the safe side, in the digits that are shown.
    let enough = (diameters[0].min(diameters[1]) * factor * 1e7).floor() * 1e-7;
    format!(
        "{place}: their centre lines are too close for that diameter; it would fit at {} or less, or with the points moved \
         apart by {:.1} %",
        units::format(format!("{enough:.7e}").parse().expect("a number"), Dimension::Length),
        (100.0 * (1.0 / factor - 1.0) * 10.0).ceil() / 10.0
    )
}

fn deepest(assembly: &Assembly) -> Option<Overlap> {
    let points: Vec<Vec<DVec3>> =
        assembly.bodies().into_iter().map(|body| body.map(|i| assembly.position.get(i)).collect()).collect();
    let firsts = assembly.bodies().into_iter().map(|body| body.start);
    let bodies: Vec<Body> =
        points.iter().zip(firsts).map(|(points, first)| Body { points, radius: assembly.radius[first] }).collect();
    overlap::deepest(&bodies, 0.0)
}

fn short(value: f64) -> String {
    format!("{value:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
}
