//! What the bonds of a scene can carry.

use crate::base::random::uniform;
use crate::engine::view::RunInfo;
use crate::law::bond::hardening::Hardening;
use crate::law::bond::rupture::weibull_factor;
use crate::scene::spec::{BondLawSpec, DriveSpec, RuptureCriterion, Spec};

/// Rise of stress or strain over its limit that a bond can have when its break is noticed (-), where that limit is one of
/// stress or strain: a wave of the limit's own stress passes a bond in no less than a stable step, so that it doubles at most.
const NOTICED: f64 = 2.0;

/// What the bonds of a scene can carry.
pub struct Limits {
    law: BondLawSpec,
    young: f64,
    criterion: Option<RuptureCriterion>,
    /// The body is pulled one way, so that a bond's plastic strain is what it was stretched by; pushed or to and fro, plastic
    /// strain adds up beyond that, and a section can be thicker than it was.
    one_way: bool,
    /// Factor on the rupture value of each slot (-); empty without scatter.
    factor: Vec<f64>,
    /// Error of a position in a snapshot (m).
    rounding: f64,
}

/// How much can be carried (MPa), pushed and pulled; infinite where nothing limits it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Greatest pressure.
    pub pushed: f64,
    /// Greatest tension.
    pub pulled: f64,
}

impl Bounds {
    /// Of two stresses (Pa).
    fn new(pushed: f64, pulled: f64) -> Self {
        Self { pushed: pushed * 1e-6, pulled: pulled * 1e-6 }
    }

    /// Of a law that takes no notice of the sign.
    fn both(stress: f64) -> Self {
        Self::new(stress, stress)
    }

    /// Nothing limits it.
    const NONE: Self = Self { pushed: f64::INFINITY, pulled: f64::INFINITY };

    /// What bounds a stress of this sign (MPa).
    pub fn of(self, stress: f64) -> f64 {
        if stress < 0.0 { self.pushed } else { self.pulled }
    }

    /// How far beyond them a stress (MPa) is, over the bound (-); −1 where nothing limits it.
    pub fn over(self, stress: f64) -> f64 {
        let bound = self.of(stress);
        if bound.is_finite() { stress.abs() / bound - 1.0 } else { -1.0 }
    }

    /// Whether there is a limit at all.
    pub fn limits(self) -> bool {
        self.pushed.is_finite() || self.pulled.is_finite()
    }
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
            one_way: spec.grip.as_ref().is_some_and(|grip| matches!(grip.drive, DriveSpec::Speed(v) if v > 0.0)),
            factor,
            rounding: f64::from(furthest) * f64::from(f32::EPSILON) * 4.0,
        }
    }

    fn factor(&self, slot: usize) -> f64 {
        self.factor.get(slot).copied().unwrap_or(1.0)
    }

    /// Of a criterion that breaks what is pulled beyond `stress` (Pa), and nothing for being pushed. What is pulled one way is
    /// pushed only when it springs back, which is no more than it was pulled.
    fn in_tension(&self, stress: f64) -> Bounds {
        Bounds::new(if self.one_way { stress } else { f64::INFINITY }, stress)
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
            Some(RuptureCriterion::BeamStress { .. } | RuptureCriterion::FibreStrain { .. }) | None => None,
        }
    }

    /// True stress that a bond can have when it breaks. Stress hardly changes while plastic strain goes past its limit, for
    /// which a hundredth is plenty; see [`NOTICED`] for other limits.
    pub fn breaking(&self, slot: usize) -> Bounds {
        use BondLawSpec::{Elastic, ElastoPlastic};
        let Some(criterion) = &self.criterion else { return Bounds::NONE };
        let factor = self.factor(slot);
        match (criterion, &self.law) {
            (RuptureCriterion::PlasticStrain { strain }, ElastoPlastic(hardening)) => {
                Bounds::both(hardening.stress(1.01 * strain * factor))
            }
            // An elastic bond has no plastic strain to break by.
            (RuptureCriterion::PlasticStrain { .. }, Elastic) => Bounds::NONE,
            (RuptureCriterion::BeamStress { tensile, .. }, Elastic | ElastoPlastic(_)) => {
                self.in_tension(NOTICED * tensile * factor)
            }
            (RuptureCriterion::FibreStrain { strain }, Elastic) => {
                self.in_tension(NOTICED * self.young * (strain * factor).ln_1p())
            }
            (RuptureCriterion::FibreStrain { strain }, ElastoPlastic(hardening)) if self.one_way => {
                Bounds::both(hardening.stress(NOTICED * (strain * factor).ln_1p()))
            }
            // Plastic strain adds up without stretching any fibre.
            (RuptureCriterion::FibreStrain { .. }, ElastoPlastic(_)) => Bounds::NONE,
        }
    }

    /// Nominal stress that any wire can have, of all of the body's `slots`. A law of plasticity has the same stress on both
    /// sides, on a section that thins when it is pulled and thickens when it is pushed.
    pub fn wire(&self, slots: usize) -> Bounds {
        use BondLawSpec::{Elastic, ElastoPlastic};
        let Some(criterion) = &self.criterion else { return Bounds::NONE };
        let most = (0..slots.max(1)).map(|slot| self.factor(slot)).fold(0.0, f64::max);
        match (criterion, &self.law) {
            (RuptureCriterion::PlasticStrain { strain }, ElastoPlastic(hardening)) => {
                Bounds::both(self.greatest_nominal(hardening, strain * most))
            }
            (RuptureCriterion::PlasticStrain { .. }, Elastic) => Bounds::NONE,
            (RuptureCriterion::BeamStress { tensile, .. }, Elastic | ElastoPlastic(_)) => {
                self.in_tension(NOTICED * tensile * most)
            }
            (RuptureCriterion::FibreStrain { strain }, Elastic) => {
                self.in_tension(NOTICED * self.young * (strain * most).ln_1p())
            }
            (RuptureCriterion::FibreStrain { strain }, ElastoPlastic(hardening)) if self.one_way => {
                Bounds::both(self.greatest_nominal(hardening, NOTICED * (strain * most).ln_1p()))
            }
            // Plastic strain adds up without stretching any fibre.
            (RuptureCriterion::FibreStrain { .. }, ElastoPlastic(_)) => Bounds::NONE,
        }
    }

    /// Greatest nominal stress of a bond whose plastic strain goes up to `end` (Pa).
    fn greatest_nominal(&self, hardening: &Hardening, end: f64) -> f64 {
        let stretched = if self.one_way { -1.0 } else { 1.0 };
        let nominal = |p: f64| hardening.stress(p) * (stretched * p).exp();
        (0..=2000).map(|k| nominal(1.01 * end * f64::from(k) / 2000.0)).fold(0.0, f64::max)
    }
}
