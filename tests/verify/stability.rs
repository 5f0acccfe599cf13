//! The stable step: where runs really explode, against 2/ω_max and against the engine's bound.

use crate::support::{alone, case, near, set, stays};
use strandsnap::reference::stability::{Ends, critical_step};

/// Greatest step [s] at which the scene stays within bounds, by bisection between 0.5 and 2 times its bound.
fn measured(name: &str, options: &[String], steps: usize) -> (f64, f64) {
    let bound = case(name, options).engine.time_step_bound();
    let explodes = |step: f64| {
        let mut options = options.to_vec();
        options.push(set("time.step", format!("{step:e} s")));
        !stays(&mut case(name, &options), steps)
    };
    let (mut low, mut high) = (0.5 * bound, 2.0 * bound);
    assert!(!explodes(low) && explodes(high), "{name}: no edge between {low:e} and {high:e} s");
    while high / low > 1.00005 {
        let middle = 0.5 * (low + high);
        if explodes(middle) { high = middle } else { low = middle }
    }
    (low, bound)
}

fn check_bound(what: &str, bound: f64, critical: f64) {
    let share = bound / critical;
    println!("{what}: bound / critical step = {share:.4}");
    assert!(share <= 1.0, "{what}: the bound {bound:e} s lies above the critical step {critical:e} s");
    assert!(share >= 0.8, "{what}: the bound is {share:.3} of the critical step, less than 0.8");
}

/// An axial chain between two walls.
#[test]
fn axial_chain_between_walls() {
    alone(|| {
        let still = case("chain", &[]);
        let (a, bar) = (still.engine.assembly(), still.bar());
        let moving = a.wires[0].len - 2;
        let spacing = a.rest_length[0];
        let exact = critical_step(Ends::FixedFixed, moving, bar.young * bar.area() / spacing, a.mass[1]);
        let (edge, bound) = measured("chain", &[], 4000);
        near("critical step", edge, exact, 5e-4);
        check_bound("axial chain", bound, exact);
    });
}

/// A cantilever in all its modes, touching spheres, and with other spacings: which mode limits changes.
#[test]
fn cantilever_in_all_modes() {
    alone(|| {
        for spacing in [0.5, 1.0, 2.0, 3.0] {
            let options =
                [set("spacing", spacing), set("wire.0.to", r#"["0 mm", "0 mm", "6 mm"]"#), set("stop.time", "1 s")];
            let (edge, bound) = measured("free-vibration", &options, 4000);
            check_bound(&format!("cantilever, spacing {spacing}"), bound, edge);
        }
    });
}

/// A free wire: its end particles have half the mass.
#[test]
fn free_wire_in_all_modes() {
    alone(|| {
        for spacing in [1.0, 2.0] {
            // A gentle throw: turning fast, the wire would be pulled stiffer than the bound knows at the start.
            let options = [set("spacing", spacing), set("wire.0.spin", r#"["2 rad/s", "1 rad/s", "-1 rad/s"]"#)];
            let (edge, bound) = measured("free-wire", &options, 4000);
            check_bound(&format!("free wire, spacing {spacing}"), bound, edge);
        }
    });
}

/// Damping lowers the critical step.
#[test]
fn damped_cantilever() {
    alone(|| {
        for damping in [0.05, 0.3] {
            let options =
                [set("bond.damping", damping), set("wire.0.to", r#"["0 mm", "0 mm", "6 mm"]"#), set("spacing", 1)];
            let (edge, bound) = measured("free-vibration", &options, 4000);
            println!("damping {damping}: bound / critical = {:.4}", bound / edge);
            assert!(bound <= edge, "damping {damping}: the bound {bound:e} s lies above the critical step {edge:e} s");
        }
    });
}
