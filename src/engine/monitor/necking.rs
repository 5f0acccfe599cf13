//! Strain that localises (Considère 1885): past the maximum load of a bond, dσ/dp ≤ σ, it alone goes on and the others
//! unload. How far, depends on its length.

use crate::engine::step_view::StepView;
use crate::scene::caution;
use crate::scene::spec::{BondLawSpec, OneMaterial, Spec};
use serde::{Deserialize, Serialize};

/// Bonds between two looks at necking: those that flow at less than this share of the one that flows most have
/// stopped (-).
const STOPPED: f64 = 0.1;
/// A neck stands out from its wire by this plastic strain (-): less may be a wave that passes.
const STANDS_OUT: f64 = 0.005;
/// A wire of fewer free bonds has no surroundings that a neck could stand out from.
const FEWEST: usize = 8;

/// Looks for a bond that necks.
#[derive(Serialize, Deserialize)]
pub struct Necking {
    /// Plastic strain at the maximum load of a bond (-).
    pub from: f64,
    /// Plastic strain of every bond at the last look (-).
    before: Vec<f64>,
}

/// A bond that necks.
pub struct Neck {
    pub slot: usize,
    /// Plastic strain at its maximum load (-).
    pub from: f64,
    /// Its plastic strain, and the mean of the half of its wire's bonds that flow least (-).
    pub strain: f64,
    pub others: f64,
}

impl Necking {
    /// Before the first step, among `particles` slots; `None` where bonds have no maximum load.
    pub fn new(spec: &Spec, particles: usize) -> Option<Self> {
        caution::considere(spec, f64::INFINITY).map(|from| Self { from, before: vec![0.0; particles] })
    }

    /// The first bond that necks since the last look.
    pub fn look(&mut self, view: &StepView) -> Option<Neck> {
        let bonds = view.bonds?;
        let several = view.spec.has_several_materials();
        let from_of = |one: OneMaterial| match several {
            true => caution::considere_of(one.bond, f64::INFINITY).unwrap_or(f64::INFINITY),
            false => self.from,
        };
        let from: Vec<f64> = view.spec.materials().map(from_of).collect();
        let state = view.state;
        let mut found = None;
        // (growth since the last look, plastic strain, slot) of the free bonds of a wire
        let mut flow: Vec<(f64, f64, usize)> = Vec::new();
        for wire in &view.assembly.wires {
            flow.clear();
            for slot in wire.bonds() {
                let p = bonds.plastic_strain(slot);
                let grown = p - std::mem::replace(&mut self.before[slot], p);
                let held = state.fixed[slot] != 0 && state.fixed[slot + 1] != 0;
                if state.whole[slot] && !held {
                    flow.push((grown, p, slot));
                }
            }
            if found.is_some() || flow.len() < FEWEST {
                continue;
            }
            let middle = flow.len() / 2;
            let (_, median, _) = flow.select_nth_unstable_by(middle, |a, b| a.0.total_cmp(&b.0));
            let growth = median.0;
            let others = flow[..=middle].iter().map(|f| f.1).sum::<f64>() / (middle + 1) as f64;
            let most = flow[middle..].iter().max_by(|a, b| a.0.total_cmp(&b.0));
            let Some((grown, p, slot)) = most.copied() else { continue };
            // In tension: a hinge that bends is no neck.
            let BondLawSpec::ElastoPlastic(hardening) = &view.spec.material_at(wire.material).bond.law else {
                continue;
            };
            let pulled = bonds.stress(slot) > 0.5 * hardening.stress(p);
            let from = from[wire.material];
            if p >= from && p - others > STANDS_OUT && growth < STOPPED * grown && pulled {
                found = Some(Neck { slot, from, strain: p, others });
            }
        }
        found
    }
}
