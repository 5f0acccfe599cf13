//! Rupture stage: which bonds have reached their limit. A pass of its own after the bonds, so that criteria and laws
//! do not multiply.

use super::bytes::behind;
use super::state::State;
use super::view::RuptureCause;
use crate::base::random::uniform;
use crate::law::bond::rupture::{BeamStress, fibre_strain, weibull_factor};
use crate::law::bond::{BondForce, Section};
use crate::scene::spec::{RuptureCriterion, RuptureSpec};
use crate::strand::assembly::Assembly;
use glam::DVec3;

/// Cause of a rupture as the engine books it.
pub type Criterion = RuptureCause;

/// What limits bonds, where a formula can tell that it is reached.
#[derive(Debug, Clone, Copy)]
pub enum Limit {
    /// Plastic strain.
    PlasticStrain,
    /// Stress at the outermost fibre.
    BeamStress(BeamStress),
}

/// Rupture limits of all bonds.
pub struct RuptureCheck {
    criterion: RuptureCriterion,
    /// Weibull factor per bond slot (-); empty when there is no scatter, and where `plastic_limit` has it.
    factor: Vec<f64>,
    /// Stress-free lengths (m); empty under criteria that do not ask for them.
    rest_length: Vec<f64>,
    /// Plastic strain at which each slot breaks (-); empty under criteria that look at something else.
    plastic_limit: Vec<f64>,
}

impl RuptureCheck {
    /// Limits for `assembly`; scatter is indexed by (seed, wire, bond in its wire).
    pub fn new(spec: &RuptureSpec, seed: u64, assembly: &Assembly) -> Self {
        let mut factor = Vec::new();
        if spec.weibull_modulus.is_finite() {
            factor = vec![1.0; assembly.len()];
            for (w, wire) in assembly.wires.iter().enumerate() {
                for slot in wire.bonds() {
                    let per_100_mm = 0.1 / assembly.rest_length[slot];
                    let u = uniform(seed, w as u64, (slot - wire.first) as u64);
                    factor[slot] = weibull_factor(u, spec.weibull_modulus, per_100_mm);
                }
            }
        }
        let (mut rest_length, mut plastic_limit) = (Vec::new(), Vec::new());
        match spec.criterion {
            RuptureCriterion::PlasticStrain { strain } => {
                let factor = std::mem::take(&mut factor);
                let limit = |slot: usize| strain * factor.get(slot).copied().unwrap_or(1.0);
                plastic_limit = (0..assembly.len()).map(limit).collect();
            }
            RuptureCriterion::FibreStrain { .. } => rest_length.clone_from(&assembly.rest_length),
            RuptureCriterion::BeamStress { .. } => {}
        }
        Self { criterion: spec.criterion.clone(), factor, rest_length, plastic_limit }
    }

    /// Plastic strain at which each slot breaks (-), if that is the criterion: bonds can then tell on their way whether
    /// any has reached it, and the pass over all of them is left out.
    pub fn plastic_limit(&self) -> Option<&[f64]> {
        (!self.plastic_limit.is_empty()).then_some(&self.plastic_limit)
    }

    /// What limits the bonds; `None` under the criterion that asks for the angles between them, which no formula that is
    /// recorded has.
    pub fn formula(&self) -> Option<Limit> {
        match &self.criterion {
            RuptureCriterion::PlasticStrain { .. } => Some(Limit::PlasticStrain),
            RuptureCriterion::BeamStress { tensile, shear, moment_share } => {
                let law = BeamStress { tensile: *tensile, shear: *shear, moment_share: *moment_share };
                Some(Limit::BeamStress(law))
            }
            RuptureCriterion::FibreStrain { .. } => None,
        }
    }

    /// Limit of a slot under [`Self::formula`] (-).
    pub fn limit(&self, slot: usize) -> f64 {
        *self.plastic_limit.get(slot).or(self.factor.get(slot)).unwrap_or(&1.0)
    }

    /// Slots that broke, in order, with the cause. `bond(slot)` gives (p, forces, section).
    pub fn broken(
        &self,
        whole: &[bool],
        state: &State,
        bond: impl Fn(usize) -> (f64, BondForce, Section),
    ) -> Vec<(usize, Criterion)> {
        let reached = |slot: usize| {
            let (p, force, section) = bond(slot);
            let demand = self.demand(slot, state, p, &force, &section);
            (demand.value >= demand.limit).then_some((slot, demand.cause))
        };
        (0..whole.len()).filter(|s| whole[*s]).filter_map(reached).collect()
    }

    /// Memory that it keeps (bytes).
    pub fn bytes(&self) -> usize {
        behind(&self.factor) + behind(&self.rest_length) + behind(&self.plastic_limit)
    }

    /// Share of its limit that a bond has reached (-); it breaks at 1.
    pub fn utilisation(&self, slot: usize, state: &State, p: f64, force: &BondForce, section: &Section) -> f64 {
        let demand = self.demand(slot, state, p, force, section);
        demand.value / demand.limit
    }

    /// What the criterion looks at in a bond with equivalent plastic strain `p` (-), and its limit there.
    fn demand(&self, slot: usize, state: &State, p: f64, force: &BondForce, section: &Section) -> Demand {
        let factor = self.factor.get(slot).copied().unwrap_or(1.0);
        match &self.criterion {
            RuptureCriterion::PlasticStrain { .. } => {
                Demand { value: p, limit: self.plastic_limit[slot], cause: RuptureCause::PlasticStrain }
            }
            RuptureCriterion::BeamStress { tensile, shear, moment_share } => {
                let law = BeamStress { tensile: *tensile, shear: *shear, moment_share: *moment_share };
                let [tension, shear] = law.utilisation(force, section);
                let (value, cause) =
                    if tension >= shear { (tension, RuptureCause::Tension) } else { (shear, RuptureCause::Shear) };
                Demand { value, limit: factor, cause }
            }
            RuptureCriterion::FibreStrain { strain } => {
                let d = state.x.get(slot + 1) - state.x.get(slot);
                let axial = d.length() / self.rest_length[slot] - 1.0;
                let value = fibre_strain(axial, curvature(state, slot, d), section.radius);
                Demand { value, limit: strain * factor, cause: RuptureCause::FibreStrain }
            }
        }
    }
}

/// What a criterion looks at in one bond, against its limit there, in the same unit.
struct Demand {
    value: f64,
    limit: f64,
    cause: Criterion,
}

/// Curvature of the wire at bond `slot` (1/m), counted from a straight wire: the mean over the angles with its two
/// neighbours, as far as those hold.
fn curvature(state: &State, slot: usize, d: DVec3) -> f64 {
    let turn = |a: DVec3, b: DVec3| a.cross(b).length().atan2(a.dot(b)) / (0.5 * (a.length() + b.length()));
    let mut sum = 0.0;
    let mut count = 0.0;
    if slot > 0 && state.whole[slot - 1] {
        sum += turn(state.x.get(slot) - state.x.get(slot - 1), d);
        count += 1.0;
    }
    if state.whole.get(slot + 1).is_some_and(|w| *w) {
        sum += turn(d, state.x.get(slot + 2) - state.x.get(slot + 1));
        count += 1.0;
    }
    if count > 0.0 { sum / count } else { 0.0 }
}
