//! Static cantilever and torsion bar.

use crate::support::{Case, alone, case, converges, near, set};
use strandsnap::engine::Engine;

fn tip(engine: &Engine) -> f64 {
    let a = engine.assembly();
    let end = a.wires[0].len - 1;
    engine.state().x.x[end] - a.position.x[end]
}

/// Tip deflection after the ramp; the window holds several periods of the first mode.
fn settled_tip(name: &str, options: &[String]) -> (Case, f64) {
    let mut case = case(name, options);
    let (from, to) = (case.spec.holds.iter().map(|h| h.ramp).fold(0.0, f64::max), case.spec.stop.time.unwrap());
    let deflection = case.settled(from, to, tip);
    case.check_ledger();
    (case, deflection)
}

/// A bond is Timoshenko's beam, exact between its ends: a force at the tip gives the exact deflection at any spacing.
#[test]
fn cantilever_under_a_tip_force_is_exact_at_any_spacing() {
    alone(|| {
        for spacing in [20.0, 10.0, 5.0, 2.0, 1.0] {
            let (case, deflection) = settled_tip("tip-load", &[set("spacing", spacing)]);
            let exact = case.bar().cantilever_tip(6e-3);
            near(&format!("tip, a/L = {}", spacing / 20.0), deflection, exact, 1e-4);
        }
    });
}

/// Four diameters long, shear gives 3.5 % of the deflection.
#[test]
fn shear_of_a_stocky_cantilever() {
    alone(|| {
        let options = [
            set("wire.0.to", r#"["0 mm", "0 mm", "1.6 mm"]"#),
            set("hold.1.ramp", "100 us"),
            set("stop.time", "400 us"),
        ];
        let (case, deflection) = settled_tip("tip-load", &options);
        let bar = case.bar();
        let exact = bar.cantilever_tip(6e-3);
        let bending = 6e-3 * bar.length.powi(3) / (3.0 * bar.young * bar.second_moment());
        assert!(exact / bending > 1.03);
        near("stocky tip", deflection, exact, 1e-4);
    });
}

/// A load shared equally by n + 1 particles is that of the continuum up to order a/L: the end particles stand for half
/// a spacing and carry a whole share. The model's own sum is met at every spacing.
#[test]
fn cantilever_under_a_shared_load_converges() {
    alone(|| {
        let mut errors = Vec::new();
        for spacing in [2.0, 1.0, 0.5] {
            let (case, deflection) = settled_tip("shared-load", &[set("spacing", spacing)]);
            let bar = case.bar();
            let n = (20.0 / spacing) as usize;
            let (l, share) = (bar.length, 6e-3 / (n + 1) as f64);
            let stiffness = bar.young * bar.second_moment();
            let shear = bar.cantilever_tip(1.0) / l - l * l / (3.0 * stiffness);
            let at = |x: f64| share * (x * x * (3.0 * l - x) / (6.0 * stiffness) + x * shear);
            let sum: f64 = (1..=n).map(|i| at(l * i as f64 / n as f64)).sum();
            near(&format!("shared load, a/L = {}", spacing / 20.0), deflection, sum, 1e-4);
            let continuum = 6e-3 * l * (l * l / (8.0 * stiffness) + shear / 2.0);
            errors.push(deflection / continuum - 1.0);
        }
        converges("shared load", &errors, 1.0, 0.1);
    });
}

/// The angle is the spin summed up, as the bonds do.
#[test]
fn torsion_bar() {
    alone(|| {
        for spacing in [10.0, 2.0, 1.0] {
            let mut case = case("torque", &[set("spacing", spacing)]);
            let end = case.engine.assembly().wires[0].len - 1;
            let mut angle = 0.0;
            let mean = case.settled(100e-6, 500e-6, |engine| {
                angle += engine.state().w.z[end] * engine.state().dt;
                angle
            });
            near(&format!("twist, a/L = {}", spacing / 20.0), mean, case.bar().twist(0.12e-3), 1e-4);
            case.check_ledger();
        }
    });
}
