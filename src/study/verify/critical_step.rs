//! The stable step: where runs really explode, against 2/ω_max and against the engine's bound.

use super::case::VerificationCase;
use super::comparison::{Comparison, Spent};
use super::support::{Context, set};
use crate::base::error::{Error, Result};
use crate::reference::stability::critical_step;

pub const CHAIN: VerificationCase = VerificationCase {
    name: "critical-step-chain",
    about: "axial chain between two walls: the step at which it explodes, and the engine's bound",
    source: "2/ω_max: Belytschko, Liu & Moran, Nonlinear Finite Elements, section 6.2",
    run: chain,
};

pub const CANTILEVER: VerificationCase = VerificationCase {
    name: "critical-step-cantilever",
    about: "cantilever in all its modes: the engine's bound lies below the step that explodes, within 20 %",
    source: "bisection on the engine itself",
    run: cantilever,
};

pub const FREE_WIRE: VerificationCase = VerificationCase {
    name: "critical-step-free-wire",
    about: "free wire in all its modes: the engine's bound lies below the step that explodes, within 20 %",
    source: "bisection on the engine itself",
    run: free_wire,
};

pub const DAMPED: VerificationCase = VerificationCase {
    name: "critical-step-damped",
    about: "damped cantilever: the engine's bound lies below the step that explodes",
    source: "bisection on the engine itself",
    run: damped,
};

/// Steps that a run must stay within bounds for.
const STEPS: u64 = 4000;
/// Ratio of two steps that bisection need not tell apart.
const RESOLUTION: f64 = 1.00005;

/// Greatest step at which a scene stays within bounds, and the engine's bound.
struct Edge {
    step: f64,
    bound: f64,
    spent: Spent,
}

impl Edge {
    /// The bound against the edge: below it by at most `share` (-).
    fn bound_below(&self, what: impl Into<String>, share: f64) -> Comparison {
        Comparison::new(what, "s", self.bound, self.step, self.spent).between(-share, 0.0)
    }
}

/// Bisection between 0.5 and 2 times the bound; without an edge there, the edge is NaN.
fn edge(context: &Context, scene: &str, options: &[String]) -> Result<Edge> {
    let bound = context.simulation(scene, options)?.engine.time_step_bound();
    let mut spent = Spent::default();
    let mut explodes = |step: f64| {
        let mut options = options.to_vec();
        options.push(set("time.step", format!("{step:e} s")));
        let mut simulation = context.simulation(scene, &options)?;
        let result = simulation.run_steps(STEPS, |_| {});
        spent = spent + simulation.spent();
        match result {
            Ok(()) => Ok(false),
            Err(Error::Simulation(_)) => Ok(true),
            Err(other) => Err(other),
        }
    };
    let (mut low, mut high) = (0.5 * bound, 2.0 * bound);
    if explodes(low)? || !explodes(high)? {
        return Ok(Edge { step: f64::NAN, bound, spent });
    }
    while high / low > RESOLUTION {
        let middle = 0.5 * (low + high);
        if explodes(middle)? { high = middle } else { low = middle }
    }
    Ok(Edge { step: low, bound, spent })
}

fn chain(context: &Context) -> Result<Vec<Comparison>> {
    let still = context.simulation("verify/chain", &[])?;
    let (a, bar) = (still.engine.assembly(), still.bar());
    let exact = critical_step(a.wires[0].len - 2, bar.young * bar.area() / a.rest_length[0], a.mass[1]);
    let edge = edge(context, "verify/chain", &[])?;
    Ok(vec![
        Comparison::new("greatest stable step", "s", edge.step, exact, edge.spent).within(5e-4),
        Comparison::new("the engine's bound", "s", edge.bound, exact, edge.spent).between(-0.2, 0.0),
    ])
}

/// Which mode limits changes with the spacing.
fn cantilever(context: &Context) -> Result<Vec<Comparison>> {
    let mut comparisons = Vec::new();
    for spacing in context.pick(&[0.5, 2.0][..], &[0.5, 1.0, 2.0, 3.0]) {
        let options =
            [set("spacing", spacing), set("wire.0.to", r#"["0 mm", "0 mm", "6 mm"]"#), set("stop.time", "1 s")];
        let edge = edge(context, "verify/free-vibration", &options)?;
        comparisons.push(edge.bound_below(format!("the engine's bound, worst spacing: {spacing} d"), 0.2));
    }
    Ok(vec![Comparison::worst(comparisons)])
}

/// Its end particles have half the mass. A gentle throw: turning fast, the wire would be pulled stiffer than the bound
/// knows at the start.
fn free_wire(context: &Context) -> Result<Vec<Comparison>> {
    let mut comparisons = Vec::new();
    for spacing in [1.0, 2.0] {
        let options = [set("spacing", spacing), set("wire.0.spin", r#"["2 rad/s", "1 rad/s", "-1 rad/s"]"#)];
        let edge = edge(context, "verify/free-wire", &options)?;
        comparisons.push(edge.bound_below(format!("the engine's bound, worst spacing: {spacing} d"), 0.2));
    }
    Ok(vec![Comparison::worst(comparisons)])
}

fn damped(context: &Context) -> Result<Vec<Comparison>> {
    [0.05, 0.3]
        .into_iter()
        .map(|damping| {
            let options =
                [set("bond.damping", damping), set("wire.0.to", r#"["0 mm", "0 mm", "6 mm"]"#), set("spacing", 1)];
            let edge = edge(context, "verify/free-vibration", &options)?;
            let finding = edge.bound_below(format!("the engine's bound at {damping} of critical damping"), 1.0);
            Ok(finding.note("the bound counts every bond's damping at its worst, and may lie well below"))
        })
        .collect()
}
