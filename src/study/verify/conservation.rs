//! Momentum and angular momentum of free bodies, energy of undamped motion.

use super::case::VerificationCase;
use super::comparison::{Comparison, Convergence, Point};
use super::support::{Context, Simulation, set};
use crate::base::error::Result;
use crate::base::random::uniform;
use crate::engine::Engine;
use crate::strand::assembly::Assembly;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

pub const WIRE: VerificationCase = VerificationCase {
    name: "momenta-wire",
    about: "a free wire thrown and spun, undamped and damped, keeps its momenta",
    source: "Newton's third law",
    run: free_wire,
};

pub const COLLISION: VerificationCase = VerificationCase {
    name: "momenta-collision",
    about: "two wires that collide, rub and yield keep their momenta, any shape and tangential law",
    source: "Newton's third law",
    run: collision,
};

pub const STRAND: VerificationCase = VerificationCase {
    name: "momenta-strand",
    about: "an isolated strand that turns, rings, rubs and yields keeps its momenta over 10⁶ steps",
    source: "Newton's third law",
    run: isolated_strand,
};

pub const ENERGY: VerificationCase = VerificationCase {
    name: "energy-drift",
    about: "undamped swing of a few per cent of the length over 10⁶ steps: energy bounded, its trend vanishes with the step",
    source: "symplectic integration: Hairer, Lubich & Wanner, Geometric Numerical Integration, 2006, chapter IX",
    run: energy_drift,
};

/// What rounding may change of momenta (-).
const ROUNDING: f64 = 1e-11;

/// Momentum and angular momentum about the origin. Positions and velocities half a step apart give the same angular
/// momentum: the drift is along the velocity.
fn momenta(engine: &Engine) -> [DVec3; 2] {
    let s = engine.state();
    (0..s.len()).fold([DVec3::ZERO; 2], |[p, l], i| {
        let momentum = s.v.get(i) * s.mass[i];
        [p + momentum, l + s.x.get(i).cross(momentum) + s.w.get(i) * s.inertia[i]]
    })
}

/// The same with magnitudes in place of vectors: what rounding is measured by.
fn sizes(engine: &Engine) -> [f64; 2] {
    let s = engine.state();
    (0..s.len()).fold([0.0; 2], |[p, l], i| {
        let momentum = s.v.get(i).length() * s.mass[i];
        [p + momentum, l + s.x.get(i).length() * momentum + s.w.get(i).length() * s.inertia[i]]
    })
}

/// Greatest change of the momenta, over their sizes, every `interval` steps; and the greatest number of contacts.
fn follow(simulation: &mut Simulation, steps: u64, interval: u64) -> Result<([f64; 2], usize)> {
    let before = momenta(&simulation.engine);
    let (mut worst, mut touching) = ([0.0f64; 2], 0);
    simulation.run_steps(steps, |engine| {
        if engine.steps().is_multiple_of(interval) {
            touching = touching.max(engine.contact_counts().2);
            let (now, size) = (momenta(engine), sizes(engine));
            for k in 0..2 {
                worst[k] = worst[k].max((now[k] - before[k]).length() / size[k]);
            }
        }
    })?;
    Ok((worst, touching))
}

/// Change of both momenta over what the bodies carry.
fn changes(worst: [f64; 2], what: &str, simulation: Simulation) -> [Comparison; 2] {
    let spent = simulation.finish();
    let finding = |k: usize, name: &str| {
        let what = format!("change of {name} over its size{what}");
        Comparison::new(what, "-", worst[k], 0.0, spent).relative_to(1.0).within(ROUNDING)
    };
    [finding(0, "momentum"), finding(1, "angular momentum")]
}

/// The worst of each momentum.
fn worst_of_each(all: Vec<[Comparison; 2]>) -> Vec<Comparison> {
    let (p, l): (Vec<_>, Vec<_>) = all.into_iter().map(|[p, l]| (p, l)).unzip();
    vec![Comparison::worst(p), Comparison::worst(l)]
}

fn free_wire(context: &Context) -> Result<Vec<Comparison>> {
    let mut all = Vec::new();
    for damping in [0.0, 0.1] {
        let mut simulation = context.simulation("verify/free-wire", &[set("bond.damping", damping)])?;
        let (worst, _) = follow(&mut simulation, context.pick(20_000, 100_000), 10)?;
        all.push(changes(worst, "", simulation));
    }
    Ok(worst_of_each(all))
}

fn collision(context: &Context) -> Result<Vec<Comparison>> {
    let (mut all, mut fewest) = (Vec::new(), usize::MAX);
    for shape in ["sphere", "wire"] {
        for law in ["mindlin", "mindlin-deresiewicz", "none"] {
            let options = [set("contact.shape", shape), set("contact.tangential", law)];
            let mut simulation = context.simulation("verify/crossing-wires", &options)?;
            let steps = (0.3e-3 / simulation.engine.time_step()) as u64;
            let (worst, touching) = follow(&mut simulation, steps, 1)?;
            fewest = fewest.min(touching);
            all.push(changes(worst, ", worst of 6", simulation));
        }
    }
    let mut comparisons = worst_of_each(all);
    comparisons.push(touched(fewest, 1, &comparisons[0]));
    Ok(comparisons)
}

/// That bodies touched at all, or the case says nothing about contacts.
fn touched(count: usize, least: usize, like: &Comparison) -> Comparison {
    Comparison::at_least("contacts at once", "-", count as f64, least as f64, like.spent)
}

/// Seven helical wires, each thrown on its own way on top of the strand's: they ring, rub, yield, and hold each other by
/// their lay. A quarter of the default step resolves their first impacts, so that the ledger closes.
fn isolated_strand(context: &Context) -> Result<Vec<Comparison>> {
    let steps = context.pick(100_000, 1_000_000);
    let mut simulation = context.changed("verify/free-strand", &[set("time.safety", 0.2)], throw)?;
    let (worst, touching) = follow(&mut simulation, steps, 100)?;
    let energy = simulation.engine.energy();
    let yielded = energy.plastic_bonds > 0.0 && energy.plastic_contacts > 0.0 && energy.friction > 0.0;
    let mut comparisons = Vec::from(changes(worst, &format!(", {steps} steps"), simulation));
    comparisons.push(touched(touching, 6, &comparisons[0]));
    let lost = Comparison::new(
        "bonds and contacts yield and rub (1: all do)",
        "-",
        f64::from(yielded),
        1.0,
        comparisons[0].spent,
    );
    comparisons.push(lost);
    Ok(comparisons)
}

/// A common velocity and spin of the whole strand, and waves of random direction up to 5 m/s in every wire.
fn throw(a: &mut Assembly) {
    let (common, spin) = (DVec3::new(1.0, -0.5, 2.0), DVec3::new(100.0, 50.0, 1000.0));
    for i in 0..a.len() {
        let wave = |number: u64| {
            let random = |axis: u64| 2.0 * uniform(number, axis, u64::from(a.wire_of[i])) - 1.0;
            let phase = number as f64 * PI * a.position.z[i] / a.length;
            DVec3::new(random(0), random(1), random(2)) * (5.0 * phase.cos())
        };
        let own = (wave(1) + wave(2) + wave(3)) / 3.0;
        let turned = spin.cross(a.position.get(i));
        a.velocity.set(i, common + turned + own);
    }
}

/// How the energy of one undamped run moves, over its start.
struct Drift {
    /// Greatest change (-).
    worst: f64,
    /// Rise of a straight line through the means of [`WINDOWS`] windows over the run, and its standard error (-).
    trend: (f64, f64),
    point: Point,
}

const WINDOWS: u64 = 50;

/// `steps` steps at the default step over `finer`.
fn drift(context: &Context, finer: u64, steps: u64) -> Result<Drift> {
    let options = [
        set("wire.0.velocity", r#"["1 m/s", "0.5 m/s", "0 m/s"]"#),
        set("time.safety", context.simulation("verify/free-vibration", &[])?.spec.time.safety / finer as f64),
    ];
    let mut simulation = context.simulation("verify/free-vibration", &options)?;
    let (start, steps) = (simulation.engine.energy().work, steps * finer);
    let window = steps / WINDOWS;
    let (mut means, mut sum, mut count, mut worst) = (Vec::new(), 0.0, 0, 0.0f64);
    simulation.run_steps(steps, |engine| {
        if engine.steps().is_multiple_of(10) {
            let energy = engine.energy();
            let error = (energy.kinetic + energy.elastic_bonds) / start - 1.0;
            worst = worst.max(error.abs());
            sum += error;
            count += 1;
        }
        if engine.steps().is_multiple_of(window) {
            means.push(sum / f64::from(count));
            (sum, count) = (0.0, 0);
        }
    })?;
    let period = TAU / simulation.bar().first_bending_frequency();
    let resolution = simulation.engine.time_step() / period;
    let trend = trend(&means);
    Ok(Drift { worst, trend, point: Point { resolution, error: trend.0, spent: simulation.finish() } })
}

/// The same time is run again with finer steps, so that a trend shows where it comes from.
fn energy_drift(context: &Context) -> Result<Vec<Comparison>> {
    let steps = context.pick(100_000, 1_000_000);
    let mut drifts = Vec::new();
    for finer in context.pick(&[1][..], &[1, 2, 4]) {
        drifts.push(drift(context, *finer, steps)?);
    }
    let Drift { worst, trend: (rise, _), point } = &drifts[0];
    let over = |what: &str, value: f64| {
        Comparison::new(format!("{what} over {steps} steps"), "-", value, 0.0, point.spent).relative_to(1.0)
    };
    let rises: Vec<String> = drifts.iter().map(|d| format!("{:.1e} ± {:.1e}", d.trend.0, 2.0 * d.trend.1)).collect();
    let mut comparisons = vec![
        over("greatest change of energy", *worst).within(1e-3),
        over("trend of energy", *rise).within(1e-5).note(format!(
            "rise of a straight line through means of {WINDOWS} windows, ± two standard errors, each at half the step of \
             the one before: {}",
            rises.join(", ")
        )),
    ];
    if let [_, .., Drift { trend: (rise, _), point, .. }] = &drifts[..] {
        let part = drifts[0].point.resolution / point.resolution;
        let what = format!("trend of energy over the same time at 1/{part:.0} of that step");
        let mut finest = Comparison::new(what, "-", *rise, 0.0, point.spent).relative_to(1.0).within(1e-6);
        finest.convergence =
            Some(Convergence { axis: "dt/T".into(), points: drifts.iter().map(|d| d.point).collect() });
        comparisons.push(finest);
    }
    Ok(comparisons)
}

/// Rise of the straight line through equally spaced values, from the first to the last, and its standard error (least
/// squares).
fn trend(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let x = |i: usize| i as f64 / (n - 1.0) - 0.5;
    let sxx: f64 = (0..values.len()).map(|i| x(i).powi(2)).sum();
    let slope = values.iter().enumerate().map(|(i, v)| x(i) * (v - mean)).sum::<f64>() / sxx;
    let rest: f64 = values.iter().enumerate().map(|(i, v)| (v - mean - slope * x(i)).powi(2)).sum();
    (slope, (rest / (n - 2.0) / sxx).sqrt())
}

#[cfg(test)]
mod tests {
    use super::trend;

    #[test]
    fn trend_is_the_rise_from_first_to_last() {
        let (rise, error) = trend(&[1.0, 1.5, 2.0, 2.5, 3.0]);
        assert!((rise - 2.0).abs() < 1e-12 && error < 1e-12);
        let (rise, error) = trend(&[1.0, -1.0, -1.0, 1.0]);
        assert!(rise.abs() < 1e-12 && error > 0.5);
    }
}
