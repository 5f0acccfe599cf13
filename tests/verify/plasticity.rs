//! One wire pulled past yield, one bond bent and twisted past yield.

use crate::support::{alone, builtin, case, near, set};
use strandsnap::reference::plasticity::{Section, tension_at};
use strandsnap::scene::spec::BondLawSpec;

/// Engineering curve at the grips, true curve in the bonds, Young's modulus from the first slope.
#[test]
fn one_wire_pulled_follows_the_hardening_law() {
    alone(|| {
        let mut case = case("pull", &[]);
        let BondLawSpec::ElastoPlastic(law) = &case.spec.bond.law else { panic!("the scene is plastic") };
        let (law, young) = (law.clone(), case.spec.material.young);
        let exact = |strain: f64| tension_at(strain, |p| law.stress(p), young);
        let mut marks = vec![0.199, 0.15, 0.1, 0.03, 0.01];
        case.run(|engine| {
            let strain = engine.strain();
            if marks.last().is_some_and(|mark| strain >= *mark) {
                marks.pop();
                let point = exact(strain);
                near(&format!("engineering stress at {strain:.3}"), engine.stress(), point.engineering_stress, 5e-3);
                let shot = engine.snapshot();
                let middle = engine.assembly().wires[0].len / 2;
                near("plastic strain", f64::from(shot.plastic_strain[middle]), point.plastic_strain, 1e-2);
                let p = f64::from(shot.plastic_strain[middle]);
                near("true stress", f64::from(shot.bond_stress[middle]) * 1e6, law.stress(p), 1e-3);
            }
        });
        assert!(marks.is_empty(), "not all strains were reached: {marks:?}");
        case.check_ledger();
    });
}

/// Slowly, so that the running mean of the grip force keeps up.
#[test]
fn one_wire_pulled_shows_youngs_modulus() {
    alone(|| {
        let mut case = case("pull", &[set("grip.speed", "0.1 m/s"), set("stop.strain", "0.08 %")]);
        let mut points = Vec::new();
        case.run(|engine| {
            if engine.strain() > 3e-4 {
                points.push([engine.strain(), engine.stress()]);
            }
        });
        let (first, last) = (points[0], points[points.len() - 1]);
        near("Young's modulus", (last[1] - first[1]) / (last[0] - first[0]), case.spec.material.young, 2e-3);
        case.check_ledger();
    });
}

/// Moment or torque of the only bond over the angle: elastic, then the plastic limit, then hardening: with
/// σ_y = σ₀ + H p and dp = dW_p/(σ_y A l) the limit grows linearly with the plastic angle.
fn limit(name: &str, hardens: bool, elastic_slope: f64, plastic: impl Fn(&Section) -> f64) {
    let yield_stress = 100e6;
    let linear = if hardens { 2e9 } else { 0.0 };
    let options = [set("bond.hardening.linear", format!("{linear:e} Pa"))];
    let mut case = case(name, &options);
    let bar = case.bar();
    let section = Section { radius: 0.5 * bar.diameter, yield_stress };
    let limit = plastic(&section);
    let rate = 100.0;
    let mut checked = [false; 2];
    case.run(|engine| {
        let angle = rate * engine.time();
        let moment = engine.state().bond.moment(0).length();
        if !checked[0] && angle > 0.5 * limit / elastic_slope {
            checked[0] = true;
            near(&format!("{name}, elastic"), moment, elastic_slope * angle, 1e-6);
        }
        if !checked[1] && angle > 0.09 {
            checked[1] = true;
            // p grows with the plastic angle by m = (∂/∂σ_y of the limit)/(A l).
            let per_angle = limit / yield_stress / (bar.area() * bar.length);
            let growth = linear * per_angle / yield_stress;
            // moment = limit (1 + growth θ_p) with θ_p = angle − moment/elastic_slope.
            let exact = limit * (1.0 + growth * angle) / (1.0 + limit * growth / elastic_slope);
            near(&format!("{name}, plastic, H = {linear:e}"), moment, exact, 1e-4);
        }
    });
    assert_eq!(checked, [true; 2]);
    case.check_ledger();
}

#[test]
fn one_bond_bent_past_yield() {
    alone(|| {
        let bar = case("bond-bent", &[]).bar();
        let slope = bar.young * bar.second_moment() / bar.length;
        for hardens in [false, true] {
            limit("bond-bent", hardens, slope, Section::plastic_moment);
        }
    });
}

#[test]
fn one_bond_twisted_past_yield() {
    alone(|| {
        let bar = case("bond-twisted", &[]).bar();
        let slope = bar.shear_modulus() * bar.polar_moment() / bar.length;
        for hardens in [false, true] {
            limit("bond-twisted", hardens, slope, Section::plastic_torque);
        }
    });
}

/// The built-in scene `torsion`: every bond turns alike, and the grip feels T = (2π/3)(σ_y(p)/√3) r³ with
/// p = T φ_p/(σ_y A l), φ_p the angle less its elastic part T l/(G J).
#[test]
fn torque_at_the_grip_of_a_wire_twisted_past_yield() {
    alone(|| {
        let mut case = builtin("torsion");
        let BondLawSpec::ElastoPlastic(law) = &case.spec.bond.law else { panic!("the scene is plastic") };
        let (law, bar) = (law.clone(), case.bar());
        let per_stress = Section { radius: 0.5 * bar.diameter, yield_stress: 1.0 }.plastic_torque();
        let rate = case.spec.grip.as_ref().unwrap().rotation_rate;
        case.run(|_| {});
        let sample = case.engine.sample();
        let torque_at = |p: f64| per_stress * law.stress(p);
        let angle_at = |p: f64| p * bar.area() * bar.length / per_stress + bar.twist(torque_at(p));
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..100 {
            let p = 0.5 * (low + high);
            if angle_at(p) < rate * sample.time { low = p } else { high = p }
        }
        assert!(low > 1e-3, "it has not yielded: p = {low}");
        near("torque", sample.torque, torque_at(low), 5e-3);
        case.check_ledger();
    });
}
