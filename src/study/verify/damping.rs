//! Decay of the first axial and bending mode under the bonds' viscous damping, and that it does not depend on the step.

use super::case::VerificationCase;
use super::comparison::{Comparison, Convergence, Point};
use super::modes::{first_axial_mode, first_bending_curvature, first_bending_mode, project};
use super::support::{Context, Simulation, set};
use crate::base::error::Result;
use crate::base::vectors::Vectors;
use crate::engine::Engine;
use crate::law::damping::viscous_coefficient;
use glam::DVec3;
use std::f64::consts::TAU;

pub const AXIAL: VerificationCase = VerificationCase {
    name: "damping-axial",
    about: "first axial mode decays by ζ of the bonds' dashpots, whatever the step",
    source: "Rayleigh quotient of the dashpots: ζ = Σ c Δφ²/(2 ω Σ m φ²); logarithmic decrement 2πζ/√(1 − ζ²)",
    run: axial,
};

pub const BENDING: VerificationCase = VerificationCase {
    name: "damping-bending",
    about: "first bending mode decays by ζ of the bonds' dashpots, whatever the step",
    source: "Rayleigh quotient of the dashpots: ζ = (ω/2) Σ c κ²/Σ k κ²; logarithmic decrement 2πζ/√(1 − ζ²)",
    run: bending,
};

/// Speed that a mode starts with where its shape is 1 (m/s).
const SPEED: f64 = 0.01;

/// One mode of one wire.
struct Mode {
    scene: &'static str,
    options: Vec<String>,
    /// Periods that are watched.
    periods: f64,
    /// Direction of the motion, its component, and its shape over z/L.
    direction: DVec3,
    axis: fn(&Vectors) -> &Vec<f64>,
    shape: fn(f64) -> f64,
    /// Damping ratio ζ and angular frequency ω (rad/s) of the model.
    theory: fn(&Simulation) -> [f64; 2],
}

impl Mode {
    /// The wire at rest in place, with the velocity of this mode alone.
    fn start<'a>(&self, context: &'a Context, safety: f64) -> Result<Simulation<'a>> {
        let mut options = self.options.clone();
        options.push(set("time.safety", safety));
        context.changed(self.scene, &options, |a| {
            let last = a.len() - 1;
            for i in 0..=last {
                a.velocity.set(i, self.direction * (SPEED * (self.shape)(i as f64 / last as f64)));
            }
        })
    }

    /// Shares of the mode in displacement and velocity.
    fn shares(&self, engine: &Engine) -> [f64; 2] {
        let (s, a) = (engine.state(), engine.assembly());
        let displacement = |i: usize| (self.axis)(&s.x)[i] - (self.axis)(&a.position)[i];
        [project(engine, displacement, self.shape), project(engine, |i| (self.axis)(&s.v)[i], self.shape)]
    }
}

/// Logarithmic decrement per period: of the mode's speed at its first and last passage through rest. Speeds lag by half
/// a step at either, which leaves their ratio alone.
fn decrement(simulation: &mut Simulation, mode: &Mode, frequency: f64) -> Result<f64> {
    let (mut last, mut speeds) = (None::<[f64; 2]>, Vec::new());
    simulation.run_to((mode.periods + 0.5) * TAU / frequency, |engine| {
        let now = mode.shares(engine);
        if let Some([x, v]) = last
            && x < 0.0
            && now[0] >= 0.0
        {
            let share = x / (x - now[0]);
            speeds.push(v + share * (now[1] - v));
        }
        last = Some(now);
    })?;
    let [first, .., end] = speeds[..] else { return Ok(f64::NAN) };
    Ok((first / end).ln() / (speeds.len() - 1) as f64)
}

/// Leapfrog with the dashpots' velocities half a step old multiplies amplitudes by √(1 − 2ζωΔt) per step: that is e^(−ζωΔt)
/// up to a share ζωΔt of the decay.
fn decays(context: &Context, mode: &Mode) -> Result<Vec<Comparison>> {
    let (mut points, mut found) = (Vec::new(), Vec::new());
    let mut exact = f64::NAN;
    let safety = context.pick(&[0.8, 0.4][..], &[0.8, 0.4, 0.2]);
    for safety in safety {
        let mut simulation = mode.start(context, *safety)?;
        let [ratio, frequency] = (mode.theory)(&simulation);
        exact = TAU * ratio / (1.0 - ratio * ratio).sqrt();
        let value = decrement(&mut simulation, mode, frequency)?;
        let resolution = simulation.engine.time_step() * frequency / TAU;
        points.push(Point { resolution, error: value / exact - 1.0, spent: simulation.finish() });
        found.push(value);
    }
    let spent = points.iter().map(|p| p.spent).sum();
    let [coarse, .., fine] = found[..] else { unreachable!("there are several steps") };
    let part = safety[0] / safety[safety.len() - 1];
    let mut decrement =
        Comparison::new(format!("logarithmic decrement at 1/{part:.0} of that step"), "-", fine, exact, spent)
            .within(5e-3);
    decrement.convergence = Some(Convergence { axis: "dt/T".into(), points });
    Ok(vec![
        Comparison::new("logarithmic decrement at the default step", "-", coarse, exact, spent).within(5e-3),
        decrement,
        Comparison::new("the one over the other", "-", coarse / fine, 1.0, spent).within(5e-3),
    ])
}

/// Coefficient 2ξ√(k m) of each bond, m reduced from both its ends, as the engine defines it.
fn coefficients(simulation: &Simulation, fraction: f64, stiffness: f64, inertia: &[f64]) -> Vec<f64> {
    let reduced = |i: usize| inertia[i] * inertia[i + 1] / (inertia[i] + inertia[i + 1]);
    (0..simulation.bonds()).map(|i| viscous_coefficient(fraction, reduced(i), stiffness)).collect()
}

fn axial(context: &Context) -> Result<Vec<Comparison>> {
    let theory = |simulation: &Simulation| {
        let (bar, a, n) = (simulation.bar(), simulation.engine.assembly(), simulation.bonds());
        let stiffness = bar.young * bar.area() / a.rest_length[0];
        let c = coefficients(simulation, simulation.spec.bond.damping[0], stiffness, &a.mass);
        let shape = |i: usize| first_axial_mode(i as f64 / n as f64);
        let stretch = |i: usize| (shape(i + 1) - shape(i)).powi(2);
        let dashpots: f64 = (0..n).map(|i| c[i] * stretch(i)).sum();
        let springs: f64 = (0..n).map(|i| stiffness * stretch(i)).sum();
        let mass: f64 = (0..=n).map(|i| a.mass[i] * shape(i).powi(2)).sum();
        let frequency = (springs / mass).sqrt();
        [dashpots / (2.0 * frequency * mass), frequency]
    };
    let mode = Mode {
        scene: "verify/axial-wave",
        options: vec![set("spacing", 4), set("bond.damping", "{ axial = 0.3 }")],
        periods: 8.0,
        direction: DVec3::Z,
        axis: |v| &v.z,
        shape: first_axial_mode,
        theory,
    };
    decays(context, &mode)
}

fn bending(context: &Context) -> Result<Vec<Comparison>> {
    let theory = |simulation: &Simulation| {
        let (bar, a, n) = (simulation.bar(), simulation.engine.assembly(), simulation.bonds());
        let stiffness = bar.young * bar.second_moment() / a.rest_length[0];
        let c = coefficients(simulation, simulation.spec.bond.damping[2], stiffness, &a.inertia);
        let curvature = |i: usize| first_bending_curvature((i as f64 + 0.5) / n as f64).powi(2);
        let dashpots: f64 = (0..n).map(|i| c[i] * curvature(i)).sum();
        let springs: f64 = (0..n).map(|i| stiffness * curvature(i)).sum();
        let frequency = bar.first_bending_frequency();
        [0.5 * frequency * dashpots / springs, frequency]
    };
    let mode = Mode {
        scene: "verify/free-vibration",
        options: vec![set("spacing", 3), set("bond.damping", "{ bending = 1 }")],
        periods: context.pick(4.0, 6.0),
        direction: DVec3::X,
        axis: |v| &v.x,
        shape: first_bending_mode,
        theory,
    };
    decays(context, &mode)
}
