//! Repeated loading of an elastoplastic contact.

use super::case::VerificationCase;
use super::comparison::Comparison;
use super::support::Context;
use crate::base::error::Result;
use crate::reference::hertz::Pair;
use crate::reference::thornton;
use crate::scene::spec::{DriveSpec, NormalSpec};
use std::f64::consts::TAU;

pub const REPEATED: VerificationCase = VerificationCase {
    name: "thornton-repeated",
    about: "an elastoplastic contact is loaded, unloaded and loaded again, deeper each time: force and lost energy",
    source: "Thornton, J. Appl. Mech. 64 (1997) 383",
    run: repeated,
};

/// The overlap is prescribed, v t + A sin ωt: the force is compared at every step, the energy after every cycle.
fn repeated(context: &Context) -> Result<Vec<Comparison>> {
    let mut simulation = context.simulation("verify/repeated", &[])?;
    let NormalSpec::Thornton { limiting_pressure } = simulation.spec.contact.as_ref().expect("it touches").normal
    else {
        unreachable!("the scene is elastoplastic")
    };
    let Some(DriveSpec::Cyclic { amplitude, frequency }) = simulation.spec.grip.as_ref().map(|g| g.drive) else {
        unreachable!("the scene swings")
    };
    let speed = -simulation.spec.holds[0].velocity.z;
    let (m, sphere) = (simulation.spec.material, simulation.engine.state().len() - 1);
    let radii = [sphere - 1, sphere].map(|p| simulation.engine.state().radius[p]);
    let pair = Pair {
        radius: 1.0 / (1.0 / radii[0] + 1.0 / radii[1]),
        ..Pair::equal_spheres(1.0, m.young, m.poisson, m.density)
    };
    let cycles = context.pick(3.0, 6.0);
    let (mut greatest, mut strongest, mut worst) = (0.0f64, 0.0f64, [0.0f64; 2]);
    let mut energies = Vec::new();
    simulation.run_to(cycles / frequency, |engine| {
        let time = engine.time();
        let overlap = speed * time + amplitude * (TAU * frequency * time).sin();
        greatest = greatest.max(overlap);
        let exact = thornton::force(&pair, limiting_pressure, greatest, overlap);
        let force = engine.state().force.z[sphere];
        strongest = strongest.max(exact);
        if (force - exact).abs() >= (worst[0] - worst[1]).abs() {
            worst = [force, exact];
        }
        if time * frequency >= (energies.len() + 1) as f64 - 1e-9 {
            let lost = thornton::dissipated(&pair, limiting_pressure, greatest);
            energies.push([engine.energy().plastic_contacts, lost]);
        }
    })?;
    let spent = simulation.finish();
    let per_cycle = |k: usize, side: usize| energies[k][side] - if k > 0 { energies[k - 1][side] } else { 0.0 };
    let lost = (0..energies.len())
        .map(|k| {
            let what = format!("energy lost in cycle {}", k + 1);
            Comparison::new(what, "J", per_cycle(k, 0), per_cycle(k, 1), spent).within(1e-3)
        })
        .collect();
    let what = format!("force, furthest off in {cycles} cycles");
    Ok(vec![
        Comparison::new(what, "N", worst[0], worst[1], spent).relative_to(strongest).within(1e-6),
        Comparison { spent, ..Comparison::worst(lost) },
    ])
}
