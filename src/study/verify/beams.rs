//! Static cantilever and torsion bar.

use super::case::VerificationCase;
use super::comparison::{Comparison, Point, Spent};
use super::support::{Context, set};
use crate::base::error::Result;
use crate::engine::Engine;
use crate::reference::beam::RoundBar;

pub const CANTILEVER: VerificationCase = VerificationCase {
    name: "cantilever-tip",
    about: "cantilever under a force at its tip: deflection at any spacing",
    source: "Timoshenko & Gere, Mechanics of Materials: P L³/(3 E I) + P L/(κ G A)",
    run: cantilever_tip,
};

pub const STOCKY: VerificationCase = VerificationCase {
    name: "cantilever-stocky",
    about: "cantilever of four diameters: shear gives 3.5 % of the deflection",
    source: "Timoshenko & Gere, Mechanics of Materials; κ of Cowper 1966",
    run: cantilever_stocky,
};

pub const SHARED: VerificationCase = VerificationCase {
    name: "cantilever-shared",
    about: "cantilever under a load spread over its length: converges in the spacing",
    source: "Timoshenko & Gere, Mechanics of Materials: q L⁴/(8 E I) + q L²/(2 κ G A)",
    run: cantilever_shared,
};

pub const TORSION: VerificationCase = VerificationCase {
    name: "torsion-bar",
    about: "bar under a torque at its end: angle at any spacing",
    source: "Saint-Venant: T L/(G J)",
    run: torsion_bar,
};

/// Diameters over the length of the wires in these scenes (-).
const LENGTH: f64 = 20.0;
/// Load of the scenes (N).
const LOAD: f64 = 6e-3;

fn tip(engine: &Engine) -> f64 {
    let a = engine.assembly();
    let end = a.wires[0].len - 1;
    engine.state().x.x[end] - a.position.x[end]
}

/// Tip deflection (m) after the ramp; the window holds several periods of the first mode.
fn settled_tip(context: &Context, scene: &str, options: &[String]) -> Result<(RoundBar, f64, Spent)> {
    let mut simulation = context.simulation(scene, options)?;
    let from = simulation.spec.holds.iter().map(|h| h.ramp).fold(0.0, f64::max);
    let to = simulation.spec.stop.time.unwrap_or(from);
    let deflection = simulation.settled(from, to, tip)?;
    Ok((simulation.bar(), deflection, simulation.finish()))
}

/// A bond is Timoshenko's beam, exact between its ends: a force at the tip gives the exact deflection at any spacing.
fn cantilever_tip(context: &Context) -> Result<Vec<Comparison>> {
    let mut comparisons = Vec::new();
    for spacing in context.pick(&[20.0, 5.0, 2.0][..], &[20.0, 10.0, 5.0, 2.0, 1.0]) {
        let (bar, deflection, spent) = settled_tip(context, "verify/tip-load", &[set("spacing", spacing)])?;
        let what = format!("tip deflection, worst: a/L = {}", spacing / LENGTH);
        comparisons.push(Comparison::new(what, "m", deflection, bar.cantilever_tip(LOAD), spent).within(1e-4));
    }
    Ok(vec![Comparison::worst(comparisons)])
}

fn cantilever_stocky(context: &Context) -> Result<Vec<Comparison>> {
    let options =
        [set("wire.0.to", r#"["0 mm", "0 mm", "1.6 mm"]"#), set("hold.1.ramp", "100 us"), set("stop.time", "400 us")];
    let (bar, deflection, spent) = settled_tip(context, "verify/tip-load", &options)?;
    let bending = LOAD * bar.length.powi(3) / (3.0 * bar.young * bar.second_moment());
    let exact = bar.cantilever_tip(LOAD);
    Ok(vec![
        Comparison::new("tip deflection", "m", deflection, exact, spent).within(1e-4),
        Comparison::new("share of shear in it", "m", deflection - bending, exact - bending, spent).within(5e-3),
    ])
}

/// A load shared equally by n + 1 particles is that of the continuum up to order a/L: the end particles stand for half
/// a spacing and carry a whole share. The model's own sum over its particles is met at every spacing.
fn cantilever_shared(context: &Context) -> Result<Vec<Comparison>> {
    let (mut sums, mut points, mut tips) = (Vec::new(), Vec::new(), Vec::new());
    let mut exact = f64::NAN;
    for spacing in context.pick(&[2.0, 1.0, 0.5][..], &[4.0, 2.0, 1.0, 0.5, 0.25]) {
        let (bar, deflection, spent) = settled_tip(context, "verify/shared-load", &[set("spacing", spacing)])?;
        let n = (LENGTH / spacing) as usize;
        let (l, share) = (bar.length, LOAD / (n + 1) as f64);
        let stiffness = bar.young * bar.second_moment();
        let shear = bar.cantilever_tip(1.0) / l - l * l / (3.0 * stiffness);
        let at = |x: f64| share * (x * x * (3.0 * l - x) / (6.0 * stiffness) + x * shear);
        let sum: f64 = (1..=n).map(|i| at(l * i as f64 / n as f64)).sum();
        let what = "tip deflection, against the sum over particles";
        sums.push(Comparison::new(what, "m", deflection, sum, spent).within(1e-4));
        exact = LOAD * l * (l * l / (8.0 * stiffness) + shear / 2.0);
        points.push(Point { resolution: spacing / LENGTH, error: deflection / exact - 1.0, spent });
        tips.push(deflection);
    }
    let [.., coarse, fine] = tips[..] else { unreachable!("there are several spacings") };
    let limit = Comparison::new(
        "tip deflection as a → 0 (Richardson)",
        "m",
        2.0 * fine - coarse,
        exact,
        Spent::default(),
    )
    .within(5e-3)
    .converging("a/L", points, 1.0, 0.1)
    .note(
        "touching spheres lump the load at particles: the end stands for half a spacing, so the error is of order a/L",
    );
    Ok(vec![Comparison::worst(sums), limit])
}

/// The angle is the spin summed up, as the bonds do.
fn torsion_bar(context: &Context) -> Result<Vec<Comparison>> {
    let mut comparisons = Vec::new();
    for spacing in context.pick(&[10.0, 2.0][..], &[10.0, 2.0, 1.0]) {
        let mut simulation = context.simulation("verify/torque", &[set("spacing", spacing)])?;
        let end = simulation.bonds();
        let mut angle = 0.0;
        let mean = simulation.settled(100e-6, 500e-6, |engine| {
            angle += engine.state().w.z[end] * engine.state().dt;
            angle
        })?;
        let exact = simulation.bar().twist(0.12e-3);
        let what = format!("angle of the end, worst: a/L = {}", spacing / LENGTH);
        comparisons.push(Comparison::new(what, "rad", mean, exact, simulation.finish()).within(1e-4));
    }
    Ok(vec![Comparison::worst(comparisons)])
}
