//! Axial waves, free bending vibration, and buckling, which is vibration at frequency zero.

use super::case::VerificationCase;
use super::comparison::{Comparison, Order, Point, Spent};
use super::modes::{first_axial_mode, first_bending_mode, project};
use super::support::{Context, Crossings, Simulation, set};
use crate::base::error::Result;
use crate::engine::Engine;
use std::f64::consts::PI;

pub const AXIAL_WAVE: VerificationCase = VerificationCase {
    name: "axial-wave",
    about: "bar thrown along its axis: wave speed, and the frequency of the lumped chain",
    source: "√(E/ρ); Brillouin, Wave Propagation in Periodic Structures, chapter 2",
    run: axial_wave,
};

pub const BENDING_FREQUENCY: VerificationCase = VerificationCase {
    name: "bending-frequency",
    about: "cantilever thrown sideways: its first frequency",
    source: "Timoshenko, Vibration Problems in Engineering, section 53: 1.8751² √(E I/(ρ A))/L²",
    run: bending_frequency_case,
};

pub const BUCKLING: VerificationCase = VerificationCase {
    name: "buckling-load",
    about: "cantilever pressed along its axis: the load at which its first frequency is zero",
    source: "Euler 1744: π² E I/(4 L²)",
    run: buckling_load,
};

pub const BUCKLING_BRACKET: VerificationCase = VerificationCase {
    name: "buckling-bracket",
    about: "1 % below Euler's load the cantilever swings back, 1 % above it runs away",
    source: "Euler 1744",
    run: buckling_bracket,
};

fn sideways(engine: &Engine) -> f64 {
    project(engine, |i| engine.state().x.x[i] - engine.assembly().position.x[i], first_bending_mode)
}

fn bending_frequency(simulation: &mut Simulation, time: f64) -> Result<f64> {
    let mut crossings = Crossings::default();
    simulation.run_to(time, |engine| crossings.add(engine.time(), sideways(engine)))?;
    Ok(crossings.frequency())
}

/// The first mode of a chain is a sine, so its projection swings with one frequency: that of the lumped chain in
/// leapfrog, 2/Δt asin(ω Δt/2) with ω = 2√(k/m) sin(π/4n), and with order 2 that of the bar. The throw excites all modes
/// evenly; a fine step keeps leapfrog's ripple in the energy of the highest, (ω Δt)²/4, out of the ledger.
fn axial_wave(context: &Context) -> Result<Vec<Comparison>> {
    let (mut chains, mut points, mut speeds) = (Vec::new(), Vec::new(), (f64::NAN, f64::NAN));
    for spacing in context.pick(&[8.0, 4.0, 2.0, 1.0][..], &[8.0, 4.0, 2.0, 1.0, 0.5]) {
        let mut simulation =
            context.simulation("verify/axial-wave", &[set("spacing", spacing), set("time.safety", 0.2)])?;
        let (bar, n) = (simulation.bar(), simulation.bonds());
        let mut crossings = Crossings::default();
        simulation.run(|engine| {
            let along = |i: usize| engine.state().x.z[i] - engine.assembly().position.z[i];
            crossings.add(engine.time(), project(engine, along, first_axial_mode));
        })?;
        let frequency = crossings.frequency();
        let dt = simulation.engine.time_step();
        let spent = simulation.finish();
        let chain = 2.0 * bar.axial_wave_speed() / (bar.length / n as f64) * (PI / (4 * n) as f64).sin();
        let leapfrog = 2.0 / dt * (0.5 * dt * chain).asin();
        let what = "frequency, against the lumped chain's";
        chains.push(Comparison::new(what, "rad/s", frequency, leapfrog, spent).within(2e-6));
        speeds = (2.0 * bar.length * frequency / PI, bar.axial_wave_speed());
        points.push(Point { resolution: 1.0 / n as f64, error: speeds.0 / speeds.1 - 1.0, spent });
    }
    let speed = Comparison::new("wave speed", "m/s", speeds.0, speeds.1, Spent::default()).within(1e-4);
    Ok(vec![Comparison::worst(chains), speed.converging("a/L", points, 2.0, 0.05)])
}

/// Masses lumped at particles: order 2, which shows in the differences between neighbours.
fn bending_frequency_case(context: &Context) -> Result<Vec<Comparison>> {
    let (mut points, mut frequencies) = (Vec::new(), Vec::new());
    let mut exact = f64::NAN;
    for spacing in context.pick(&[12.0, 6.0, 3.0][..], &[12.0, 6.0, 3.0, 1.5]) {
        let mut simulation = context.simulation("verify/free-vibration", &[set("spacing", spacing)])?;
        let frequency = bending_frequency(&mut simulation, 0.02)?;
        exact = simulation.bar().first_bending_frequency();
        let resolution = 1.0 / simulation.bonds() as f64;
        points.push(Point { resolution, error: frequency / exact - 1.0, spent: simulation.finish() });
        frequencies.push(frequency);
    }
    let steps: Vec<f64> = frequencies.windows(2).map(|f| f[1] - f[0]).collect();
    let orders: Vec<f64> = steps.windows(2).map(|s| (s[0] / s[1]).abs().log2()).collect();
    let last = frequencies.last().copied().unwrap_or(f64::NAN);
    let mut finding = Comparison::new("first bending frequency", "rad/s", last, exact, Spent::default())
        .within(2e-3)
        .converging("a/L", points, 2.0, 0.15)
        .note("at 60 diameters shear and rotary inertia take 1e-4 off Euler–Bernoulli's frequency, so the order is that of differences between neighbours");
    finding.order = Some(Order::worst(&orders, 2.0, 0.15));
    Ok(vec![finding])
}

fn pressed<'a>(context: &'a Context, share: f64, spacing: f64) -> Result<Simulation<'a>> {
    let spacing = set("spacing", spacing);
    let euler = context.simulation("verify/buckling", std::slice::from_ref(&spacing))?.bar().buckling_load();
    let force = format!(r#"["0 N", "0 N", "{:e} N"]"#, -share * euler);
    context.simulation("verify/buckling", &[spacing, set("hold.1.force", force)])
}

/// ω² falls linearly with the load for the first mode of a cantilever up to 0.1 %-small terms; near the load of
/// instability it is extrapolated to zero. In shares of Euler's load.
fn critical_share(context: &Context, spacing: f64) -> Result<(f64, Spent)> {
    let at = |share: f64| -> Result<(f64, Spent)> {
        let mut simulation = pressed(context, share, spacing)?;
        let period = 2.0 * PI / simulation.bar().first_bending_frequency() / (1.0 - share).sqrt();
        let square = bending_frequency(&mut simulation, 5.0 * period)?.powi(2);
        Ok((square, simulation.finish()))
    };
    let (a, b) = (0.94, 0.97);
    let ((fa, spent_a), (fb, spent_b)) = (at(a)?, at(b)?);
    Ok((a + (b - a) * fa / (fa - fb), spent_a + spent_b))
}

fn buckling_load(context: &Context) -> Result<Vec<Comparison>> {
    let bar = context.simulation("verify/buckling", &[])?.bar();
    let euler = bar.buckling_load();
    let (mut points, mut share) = (Vec::new(), f64::NAN);
    for spacing in [12.0, 6.0, 3.0] {
        let (found, spent) = critical_share(context, spacing)?;
        share = found;
        points.push(Point { resolution: spacing * bar.diameter / bar.length, error: found - 1.0, spent });
    }
    Ok(vec![
        Comparison::new("load of instability", "N", share * euler, euler, Spent::default())
            .within(5e-3)
            .converging("a/L", points, 2.0, 0.2),
    ])
}

/// Amplitude of the tip in swings of the amplitude that starts with the throw's share in the first mode, 1.566 there.
fn buckling_bracket(context: &Context) -> Result<Vec<Comparison>> {
    let mut comparisons = Vec::new();
    for (share, buckles) in [(0.99, false), (1.01, true)] {
        let mut simulation = pressed(context, share, 3.0)?;
        let frequency = simulation.bar().first_bending_frequency();
        let swing = 1.566 * 1e-3 / (frequency * f64::abs(1.0 - share).sqrt());
        let (mut greatest, mut least) = (0.0f64, 0.0f64);
        let end = simulation.bonds();
        simulation.run_to(8.0 * 2.0 * PI / frequency, |engine| {
            let tip = engine.state().x.x[end] / swing;
            greatest = greatest.max(tip);
            least = least.min(tip);
        })?;
        let spent = simulation.finish();
        let what = |side: &str| format!("tip at {share} of Euler's load, {side}, in swings");
        if buckles {
            comparisons.push(Comparison::at_least(what("greatest"), "-", greatest, 20.0, spent));
        } else {
            comparisons.push(Comparison::new(what("greatest"), "-", greatest, 1.0, spent).between(-0.5, 0.5));
            comparisons.push(Comparison::new(what("least"), "-", least, -1.0, spent).between(-0.5, 0.5));
        }
    }
    Ok(comparisons)
}
