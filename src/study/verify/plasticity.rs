//! One wire pulled past yield, one bond bent and twisted past yield.

use super::case::VerificationCase;
use super::comparison::{Comparison, Spent};
use super::support::{Context, set};
use crate::base::bisect::bisect;
use crate::base::error::Result;
use crate::reference::beam::RoundBar;
use crate::reference::plasticity::{Section, tension_at};
use crate::scene::spec::{BondLawSpec, HardeningSpec, Spec};

pub const PULLED: VerificationCase = VerificationCase {
    name: "wire-pulled",
    about: "one wire pulled to 20 %: engineering and true curve follow the hardening law",
    source: "the law itself, converted with A = A₀ e^(−p)",
    run: wire_pulled,
};

pub const YOUNG: VerificationCase = VerificationCase {
    name: "wire-modulus",
    about: "one wire pulled slowly below yield: first slope of the curve",
    source: "Hooke",
    run: wire_modulus,
};

pub const BENT: VerificationCase = VerificationCase {
    name: "bond-bent",
    about: "one bond bent past yield: first yield, plastic moment, hardening",
    source: "Lubliner, Plasticity Theory, 1990, chapter 4: M_e = (π/4) σ_y r³, M_p = (4/3) σ_y r³",
    run: bond_bent,
};

pub const TWISTED: VerificationCase = VerificationCase {
    name: "bond-twisted",
    about: "one bond twisted past yield: plastic torque, hardening",
    source: "Lubliner, Plasticity Theory, 1990, chapter 4: T_p = (2π/3)(σ_y/√3) r³",
    run: bond_twisted,
};

pub const WIRE_TWISTED: VerificationCase = VerificationCase {
    name: "wire-twisted",
    about: "a wire twisted past yield between grips: torque at the grip",
    source: "T = (2π/3)(σ_y(p)/√3) r³ with p = T φ_p/(σ_y A l)",
    run: wire_twisted,
};

/// Of the bonds in scenes `verify/bond-…`.
const YIELD_STRESS: f64 = 100e6;

/// The hardening law of an elastoplastic scene.
pub(super) fn hardening(spec: &Spec) -> HardeningSpec {
    match &spec.bond.law {
        BondLawSpec::ElastoPlastic(law) => law.clone(),
        BondLawSpec::Elastic => unreachable!("the scene is elastoplastic"),
    }
}

/// Engineering curve at the grips, true curve in the bonds.
fn wire_pulled(context: &Context) -> Result<Vec<Comparison>> {
    let mut simulation = context.simulation("verify/pull", &[])?;
    let (law, young) = (hardening(&simulation.spec), simulation.spec.material.young);
    let middle = simulation.bonds() / 2;
    let mut marks = vec![0.199, 0.15, 0.1, 0.03, 0.01];
    let mut comparisons: [Vec<Comparison>; 3] = Default::default();
    simulation.run(|engine| {
        let strain = engine.strain();
        if marks.last().is_some_and(|mark| strain >= *mark) {
            marks.pop();
            let point = tension_at(strain, |p| law.stress(p), young);
            let shot = engine.snapshot();
            let p = f64::from(shot.plastic_strain[middle]);
            let true_stress = f64::from(shot.bond_stress[middle]);
            let none = Spent::default();
            let at = |what: &str| format!("{what}, worst of five: at {:.0} %", 100.0 * strain);
            comparisons[0].push(
                Comparison::new(at("engineering stress"), "Pa", engine.stress(), point.engineering_stress, none)
                    .within(5e-3),
            );
            comparisons[1].push(Comparison::new(at("plastic strain"), "-", p, point.plastic_strain, none).within(1e-2));
            comparisons[2]
                .push(Comparison::new(at("true stress"), "Pa", true_stress, law.stress(p), none).within(1e-3));
        }
    })?;
    let spent = simulation.finish();
    Ok(comparisons.into_iter().map(|all| Comparison { spent, ..Comparison::worst(all) }).collect())
}

/// Slowly, so that nothing rings.
fn wire_modulus(context: &Context) -> Result<Vec<Comparison>> {
    let mut simulation =
        context.simulation("verify/pull", &[set("grip.speed", "0.1 m/s"), set("stop.strain", "0.08 %")])?;
    let (mut first, mut last) = (None, [f64::NAN; 2]);
    simulation.run(|engine| {
        if engine.strain() > 3e-4 {
            last = [engine.strain(), engine.stress()];
            first.get_or_insert(last);
        }
    })?;
    let [strain, stress] = first.unwrap_or(last);
    let slope = (last[1] - stress) / (last[0] - strain);
    let young = simulation.spec.material.young;
    Ok(vec![Comparison::new("Young's modulus", "Pa", slope, young, simulation.finish()).within(2e-3)])
}

/// The only bond of a scene, which turns by 100 rad/s: its section, its elastic stiffness and its plastic limit.
struct Turned {
    bar: RoundBar,
    section: Section,
    slope: f64,
    limit: f64,
}

const RATE: f64 = 100.0;

/// Moment of the bond (N m) when its angle passes each of `angles` (rad), and the angle itself.
fn moments(context: &Context, scene: &str, linear: f64, angles: &[f64]) -> Result<(Vec<[f64; 2]>, Spent)> {
    let mut simulation = context.simulation(scene, &[set("bond.hardening.linear", format!("{linear:e} Pa"))])?;
    let mut found = Vec::new();
    simulation.run(|engine| {
        let angle = RATE * engine.time();
        if angles.get(found.len()).is_some_and(|next| angle >= *next) {
            found.push([angle, engine.state().bond.moment(0).length()]);
        }
    })?;
    Ok((found, simulation.finish()))
}

/// Elastic, then the plastic limit, then hardening: with σ_y = σ₀ + H p and dp = dW_p/(σ_y A l) the limit grows linearly
/// with the plastic angle.
fn limits(context: &Context, scene: &str, turned: &Turned, name: &str) -> Result<Vec<Comparison>> {
    let Turned { bar, section, slope, limit } = turned;
    let (half, late) = (0.5 * limit / slope, 0.09);
    let mut comparisons = Vec::new();
    for linear in [0.0, 2e9] {
        let (found, spent) = moments(context, scene, linear, &[half, late])?;
        let [[elastic, below], [angle, moment]] = found[..] else { unreachable!("the scene turns to 0.1 rad") };
        if linear == 0.0 {
            let what = format!("{name} below yield");
            comparisons.push(Comparison::new(what, "N m", below, slope * elastic, spent).within(1e-6));
        }
        // p grows with the plastic angle by (∂ limit/∂σ_y)/(A l).
        let per_angle = limit / section.yield_stress / (bar.area() * bar.length);
        let growth = linear * per_angle / section.yield_stress;
        // moment = limit (1 + growth θ_p) with θ_p = angle − moment/slope.
        let exact = limit * (1.0 + growth * angle) / (1.0 + limit * growth / slope);
        let what = if linear == 0.0 { format!("plastic {name}") } else { format!("{name} with hardening of 2 GPa") };
        comparisons.push(Comparison::new(what, "N m", moment, exact, spent).within(1e-4));
    }
    Ok(comparisons)
}

fn turned(context: &Context, scene: &str, slope: fn(&RoundBar) -> f64, limit: fn(&Section) -> f64) -> Result<Turned> {
    let bar = context.simulation(scene, &[])?.bar();
    let section = Section { radius: 0.5 * bar.diameter, yield_stress: YIELD_STRESS };
    Ok(Turned { bar, section, slope: slope(&bar) / bar.length, limit: limit(&section) })
}

/// The section yields as one. What that is worth is largest where its elastic line meets the plastic moment, and is
/// compared with the excess over the exact section that the two closed forms give there.
fn bond_bent(context: &Context) -> Result<Vec<Comparison>> {
    let scene = "verify/bond-bent";
    let bent = turned(context, scene, |b| b.young * b.second_moment(), Section::plastic_moment)?;
    let mut comparisons = limits(context, scene, &bent, "moment")?;
    let first = bent.section.first_yield_moment();
    let (found, spent) = moments(context, scene, 0.0, &[first / bent.slope, bent.limit / bent.slope])?;
    let [[angle, at_first], [corner, at_corner]] = found[..] else { unreachable!("the scene turns to 0.1 rad") };
    let share = |angle: f64| angle * bent.slope / first;
    let exact = |angle: f64| bent.section.moment_at(share(angle));
    comparisons.push(Comparison::new("moment at first yield", "N m", at_first, exact(angle), spent).within(1e-3));
    let excess = bent.limit / exact(corner) - 1.0;
    comparisons.push(
        Comparison::new("moment where elastic line meets M_p", "N m", at_corner, exact(corner), spent)
            .between(excess - 1e-3, excess + 1e-3)
            .note(format!(
                "the bond's section yields as one at M_p; fibres of a round section yield from M_e = 0.589 M_p on, and \
                 its moment lies below by at most {:.1} %, here; both agree below M_e and far beyond M_p",
                100.0 * excess
            )),
    );
    Ok(comparisons)
}

fn bond_twisted(context: &Context) -> Result<Vec<Comparison>> {
    let scene = "verify/bond-twisted";
    let twisted = turned(context, scene, |b| b.shear_modulus() * b.polar_moment(), Section::plastic_torque)?;
    limits(context, scene, &twisted, "torque")
}

/// The built-in scene `torsion`: every bond turns alike; φ_p is the angle less its elastic part T l/(G J).
fn wire_twisted(context: &Context) -> Result<Vec<Comparison>> {
    let mut simulation = context.simulation("torsion", &[])?;
    let (law, bar) = (hardening(&simulation.spec), simulation.bar());
    let per_stress = Section { radius: 0.5 * bar.diameter, yield_stress: 1.0 }.plastic_torque();
    let rate = simulation.spec.grip.as_ref().map_or(0.0, |grip| grip.rotation_rate);
    simulation.run(|_| {})?;
    let sample = simulation.engine.sample();
    let torque_at = |p: f64| per_stress * law.stress(p);
    let angle_at = |p: f64| p * bar.area() * bar.length / per_stress + bar.twist(torque_at(p));
    let [low, _] = bisect(0.0, 1.0, 0.0, |p| angle_at(p) < rate * sample.time);
    let what = format!("torque at a plastic strain of {:.2} %", 100.0 * low);
    Ok(vec![Comparison::new(what, "N m", sample.torque, torque_at(low), simulation.finish()).within(5e-3)])
}
