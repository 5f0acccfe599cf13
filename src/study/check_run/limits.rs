//! What the bonds of a scene can carry.

use crate::base::random::uniform;
use crate::engine::view::RunInfo;
use crate::law::bond::rupture::weibull_factor;
use crate::scene::spec::{BondLawSpec, RuptureCriterion, Spec};

/// Rise of stress or strain over its limit that a bond can have when its break is noticed (-), where that limit is one of
/// stress or strain: a wave of the limit's own stress passes a bond in no less than a stable step, so that it doubles at most.
const NOTICED: f64 = 2.0;

/// What the bonds of a scene can carry.
pub struct Limits {
    law: BondLawSpec,
    young: f64,
    criterion: Option<RuptureCriterion>,
    /// Factor on the rupture value of each slot (-); empty without scatter.
    factor: Vec<f64>,
    /// Error of a position in a snapshot (m).
    rounding: f64,
}

impl Limits {
    /// Those of `spec`, whose bodies are `info`.
    pub fn new(spec: &Spec, info: &RunInfo) -> Self {
        let modulus = spec.bond.rupture.as_ref().map_or(f64::INFINITY, |r| r.weibull_modulus);
        let mut factor = Vec::new();
        if modulus.is_finite() {
            factor = vec![1.0; info.particles];
            for (w, wire) in info.wires.iter().enumerate() {
                let bonds = info.rest_position[wire.first..wire.first + wire.len].windows(2).enumerate();
                for (k, ends) in bonds {
                    let length = glam::Vec3::from(ends[0]).as_dvec3().distance(glam::Vec3::from(ends[1]).as_dvec3());
                    let u = uniform(spec.seed, w as u64, k as u64);
                    factor[wire.first + k] = weibull_factor(u, modulus, 0.1 / length);
                }
            }
        }
        let furthest = info.rest_position.iter().flatten().fold(0.0, |most: f32, x| most.max(x.abs()));
        Self {
            law: spec.bond.law.clone(),
            young: spec.material.young,
            criterion: spec.bond.rupture.as_ref().map(|r| r.criterion.clone()),
            factor,
            rounding: f64::from(furthest) * f64::from(f32::EPSILON) * 4.0,
        }
    }

    fn factor(&self, slot: usize) -> f64 {
        self.factor.get(slot).copied().unwrap_or(1.0)
    }

    /// True stress that a whole bond can have (MPa): the hardening law's at its plastic strain `p`, the elastic law's at its
    /// log strain and rest length (m), positions being rounded.
    pub fn bond(&self, p: f64, [strain, rest]: [f64; 2]) -> Option<f64> {
        Some(match &self.law {
            BondLawSpec::Elastic => self.young * (strain.abs() + self.rounding / rest) * 1e-6,
            BondLawSpec::ElastoPlastic(hardening) => hardening.stress(p) * 1e-6,
        })
    }

    /// Plastic strain at which a bond breaks (-), if it breaks by that.
    pub fn plastic(&self, slot: usize) -> Option<f64> {
        match self.criterion {
            Some(RuptureCriterion::PlasticStrain { strain }) => Some(strain * self.factor(slot)),
            _ => None,
        }
    }

    /// True stress that a bond can have when it breaks (MPa); `None` when only its history tells. Stress hardly changes while
    /// plastic strain goes past its limit, for which a hundredth is plenty; see [`NOTICED`] for other limits.
    pub fn breaking(&self, slot: usize) -> Option<f64> {
        let factor = self.factor(slot);
        let limit = match (&self.criterion, &self.law) {
            (Some(RuptureCriterion::PlasticStrain { strain }), BondLawSpec::ElastoPlastic(hardening)) => {
                hardening.stress(1.01 * strain * factor)
            }
            (Some(RuptureCriterion::BeamStress { tensile, .. }), _) => NOTICED * tensile * factor,
            (Some(RuptureCriterion::FibreStrain { strain }), BondLawSpec::Elastic) => {
                NOTICED * self.young * (strain * factor).ln_1p()
            }
            (Some(RuptureCriterion::FibreStrain { strain }), BondLawSpec::ElastoPlastic(hardening)) => {
                hardening.stress(NOTICED * (strain * factor).ln_1p())
            }
            _ => return None,
        };
        Some(limit * 1e-6)
    }

    /// Nominal stress that any wire can have (MPa); `None` when nothing limits it.
    pub fn wire(&self, slots: usize) -> Option<f64> {
        let most = (0..slots.max(1)).map(|slot| self.factor(slot)).fold(0.0, f64::max);
        let top = |hardening: &crate::law::bond::hardening::Hardening, end: f64| {
            // Nominal stress is true stress on a section that thins.
            let nominal = |p: f64| hardening.stress(p) * (-p).exp();
            (0..=2000).map(|k| nominal(1.01 * end * f64::from(k) / 2000.0)).fold(0.0, f64::max)
        };
        let limit = match (&self.criterion, &self.law) {
            (Some(RuptureCriterion::BeamStress { tensile, .. }), _) => NOTICED * tensile * most,
            (Some(RuptureCriterion::FibreStrain { strain }), BondLawSpec::Elastic) => {
                NOTICED * self.young * (strain * most).ln_1p()
            }
            (Some(RuptureCriterion::FibreStrain { strain }), BondLawSpec::ElastoPlastic(h)) => {
                top(h, NOTICED * (strain * most).ln_1p())
            }
            (Some(RuptureCriterion::PlasticStrain { strain }), BondLawSpec::ElastoPlastic(h)) => top(h, strain * most),
            _ => return None,
        };
        Some(limit * 1e-6)
    }
}
