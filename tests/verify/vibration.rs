//! Axial waves, free bending vibration with its energy, and buckling, which is vibration at frequency zero.

use crate::support::{Case, Crossings, alone, case, converges, near, set};
use std::f64::consts::PI;
use strandsnap::engine::Engine;
use strandsnap::reference::beam::CLAMPED_FREE_ROOT;

/// Amplitude of the mode `shape(z/L)` in the displacement `component`, weighed with the masses.
fn mode(engine: &Engine, displacement: impl Fn(usize) -> f64, shape: impl Fn(f64) -> f64) -> f64 {
    let a = engine.assembly();
    let last = a.wires[0].len - 1;
    (0..=last).map(|i| a.mass[i] * displacement(i) * shape(i as f64 / last as f64)).sum()
}

/// Clamped–free beam's first mode (Timoshenko, Vibration Problems in Engineering, section 53).
fn first_mode(s: f64) -> f64 {
    let b = CLAMPED_FREE_ROOT;
    let ratio = (b.sinh() - b.sin()) / (b.cosh() + b.cos());
    let x = b * s;
    x.cosh() - x.cos() - ratio * (x.sinh() - x.sin())
}

fn sideways(engine: &Engine) -> f64 {
    mode(engine, |i| engine.state().x.x[i] - engine.assembly().position.x[i], first_mode)
}

fn bending_frequency(case: &mut Case, time: f64) -> f64 {
    let mut crossings = Crossings::default();
    case.run_to(time, |engine| crossings.add(engine.time(), sideways(engine)));
    crossings.frequency()
}

/// The first mode of a chain is a sine, so its projection swings with one frequency: that of the lumped chain in
/// leapfrog, 2/Δt asin(ω Δt/2) with ω = 2√(k/m) sin(π/4n), and with order 2 that of the bar. The throw excites all modes
/// evenly; a fine step keeps leapfrog's ripple in the energy of the highest, (ω Δt)²/4, out of the ledger.
#[test]
fn axial_wave_speed() {
    alone(|| {
        let mut errors = Vec::new();
        for spacing in [8.0, 4.0, 2.0, 1.0] {
            let mut case = case("axial-wave", &[set("spacing", spacing), set("time.safety", 0.2)]);
            let bar = case.bar();
            let n = case.engine.assembly().wires[0].len - 1;
            let mut crossings = Crossings::default();
            case.run(|engine| {
                let along = |i: usize| engine.state().x.z[i] - engine.assembly().position.z[i];
                let value = mode(engine, along, |s| (0.5 * PI * s).sin());
                crossings.add(engine.time(), value);
            });
            let frequency = crossings.frequency();
            let chain = 2.0 * bar.axial_wave_speed() / (bar.length / n as f64) * (PI / (4 * n) as f64).sin();
            let dt = case.engine.time_step();
            near(&format!("chain of {n}"), frequency, 2.0 / dt * (0.5 * dt * chain).asin(), 2e-6);
            let speed = 2.0 * bar.length * frequency / PI;
            errors.push(speed / bar.axial_wave_speed() - 1.0);
            case.check_ledger();
        }
        assert!(errors[3].abs() < 1e-4, "{errors:?}");
        converges("axial wave speed", &errors, 2.0, 0.05);
    });
}

/// Masses lumped at particles: order 2. At 60 diameters shear and rotary inertia take 1e-4 off Euler–Bernoulli's
/// frequency.
#[test]
fn first_bending_frequency() {
    alone(|| {
        let mut frequencies = Vec::new();
        for spacing in [12.0, 6.0, 3.0, 1.5] {
            let mut case = case("free-vibration", &[set("spacing", spacing)]);
            frequencies.push(bending_frequency(&mut case, 0.02));
            case.check_ledger();
            if spacing == 1.5 {
                near("first bending frequency", frequencies[3], case.bar().first_bending_frequency(), 2e-3);
            }
        }
        let steps: Vec<f64> = frequencies.windows(2).map(|f| f[1] - f[0]).collect();
        converges("first bending frequency", &steps, 2.0, 0.15);
    });
}

/// 10⁵ undamped steps with a swing of a few per cent of the length: the energy neither grows nor falls.
#[test]
fn energy_of_an_undamped_run_does_not_drift() {
    alone(|| {
        let mut case = case("free-vibration", &[set("wire.0.velocity", r#"["1 m/s", "0.5 m/s", "0 m/s"]"#)]);
        let start = case.engine.energy().work;
        let (steps, window) = (100_000, 10_000);
        let (mut means, mut sum, mut worst) = (Vec::new(), 0.0, 0.0f64);
        for step in 1..=steps {
            case.engine.step().unwrap();
            if step % 10 == 0 {
                let energy = case.engine.energy();
                let error = (energy.kinetic + energy.elastic_bonds) / start - 1.0;
                worst = worst.max(error.abs());
                sum += error;
            }
            if step % window == 0 {
                means.push(sum * 10.0 / window as f64);
                sum = 0.0;
            }
        }
        println!("energy: worst {worst:.2e}, means over {window} steps {means:?}");
        let drift = (means[means.len() - 1] - means[0]).abs();
        assert!(worst < 1e-3, "the energy leaves its start by {worst:.2e}");
        assert!(drift < 1e-5, "the energy drifts by {drift:.2e}: {means:?}");
    });
}

fn pressed(load: f64, spacing: f64) -> Case {
    let force = format!(r#"["0 N", "0 N", "{:e} N"]"#, -load);
    case("buckling", &[set("spacing", spacing), set("hold.1.force", force)])
}

/// ω² falls linearly with the load for the first mode of a cantilever up to 0.1 %-small terms; near the load of
/// instability it is extrapolated to zero.
fn critical_load(spacing: f64) -> f64 {
    let euler = pressed(0.1, spacing).bar().buckling_load();
    let at = |share: f64| {
        let mut case = pressed(share * euler, spacing);
        let period = 2.0 * PI / case.bar().first_bending_frequency() / (1.0 - share).sqrt();
        let square = bending_frequency(&mut case, 5.0 * period).powi(2);
        case.check_ledger();
        square
    };
    let (a, b) = (0.94, 0.97);
    let (fa, fb) = (at(a), at(b));
    euler * (a + (b - a) * fa / (fa - fb))
}

#[test]
fn buckling_load() {
    alone(|| {
        let euler = pressed(0.1, 3.0).bar().buckling_load();
        let loads: Vec<f64> = [12.0, 6.0, 3.0].into_iter().map(critical_load).collect();
        near("buckling load", loads[2], euler, 5e-3);
        let errors: Vec<f64> = loads.iter().map(|load| load / euler - 1.0).collect();
        converges("buckling load", &errors, 2.0, 0.2);
    });
}

/// Half a per cent below the load the tip swings back through its rest, half a per cent above it runs away.
#[test]
fn buckling_is_bracketed() {
    alone(|| {
        let tip = |engine: &Engine| engine.state().x.x[engine.assembly().wires[0].len - 1];
        for (share, buckles) in [(0.99, false), (1.01, true)] {
            let bar = pressed(0.1, 3.0).bar();
            let mut case = pressed(share * bar.buckling_load(), 3.0);
            let time = 8.0 * 2.0 * PI / bar.first_bending_frequency();
            // Amplitude of a swing that starts with the throw's share in the first mode, 1.566 at the tip.
            let swing = 1.566 * 1e-3 / (bar.first_bending_frequency() * f64::abs(1.0 - share).sqrt());
            let (mut greatest, mut least) = (0.0f64, 0.0f64);
            case.run_to(time, |engine| {
                greatest = greatest.max(tip(engine));
                least = least.min(tip(engine));
            });
            println!("load {share} of Euler's: tip from {least:.2e} to {greatest:.2e} m, swing {swing:.2e} m");
            if buckles {
                assert!(greatest > 20.0 * swing, "it does not buckle: {greatest:e} m");
            } else {
                assert!(least < -0.5 * swing, "it does not come back: {least:e} m");
                assert!(greatest < 1.5 * swing, "it buckles: {greatest:e} m");
            }
            case.check_ledger();
        }
    });
}
