//! What the bonds of a scene can carry.

use crate::base::random::uniform;
use crate::engine::view::RunInfo;
use crate::law::bond::hardening::Hardening;
use crate::law::bond::rupture::weibull_factor;
use crate::scene::spec::{BondLawSpec, DriveSpec, OneMaterial, RuptureCriterion, Spec};
use std::f64::consts::TAU;

/// Rise of stress or strain over its limit that a bond can have when its break is noticed (-), where that limit is one of
/// stress or strain: a wave of the limit's own stress passes a bond in no less than a stable step, so that it doubles at most.
const NOTICED: f64 = 2.0;

/// What bonds of one material can carry.
struct OfMaterial {
    law: BondLawSpec,
    young: f64,
    criterion: Option<RuptureCriterion>,
}

/// What the bonds of a scene can carry.
pub struct Limits {
    materials: Vec<OfMaterial>,
    /// Material of each slot in a wire.
    material_of: Vec<usize>,
    /// The body is pulled one way, so that a bond's plastic strain is what it was stretched by; pushed or to and fro, plastic
    /// strain adds up beyond that, and a section can be thicker than it was.
    one_way: bool,
    /// Factor on the rupture value of each slot (-); empty without scatter.
    factor: Vec<f64>,
    /// Most that a bond is strained by in a step (-), before anything has sprung back, and after.
    steps: [f64; 2],
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
    pub const NONE: Self = Self { pushed: f64::INFINITY, pulled: f64::INFINITY };

    /// What either of two allows.
    pub fn wider(self, other: Self) -> Self {
        Self { pushed: self.pushed.max(other.pushed), pulled: self.pulled.max(other.pulled) }
    }

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
    /// Those of `spec`, whose bodies are `info`, in steps of at most `longest_step` (s).
    pub fn new(spec: &Spec, info: &RunInfo, longest_step: f64) -> Self {
        let modulus =
            |number: usize| spec.material_at(number).bond.rupture.as_ref().map_or(f64::INFINITY, |r| r.weibull_modulus);
        let mut factor = Vec::new();
        if spec.ruptures().any(|rupture| rupture.weibull_modulus.is_finite()) {
            factor = vec![1.0; info.particles];
            for (w, wire) in info.wires.iter().enumerate() {
                let modulus = modulus(wire.material);
                if modulus.is_infinite() {
                    continue;
                }
                let bonds = info.rest_position[wire.particles()].windows(2).enumerate();
                for (k, ends) in bonds {
                    let length = glam::Vec3::from(ends[0]).as_dvec3().distance(glam::Vec3::from(ends[1]).as_dvec3());
                    let u = uniform(spec.seed, w as u64, k as u64);
                    factor[wire.first + k] = weibull_factor(u, modulus, 0.1 / length);
                }
            }
        }
        let bonds = info.wires.iter().flat_map(|wire| info.rest_position[wire.particles()].windows(2));
        let length = |ends: &[[f32; 3]]| f64::from(glam::Vec3::from(ends[0]).distance(glam::Vec3::from(ends[1])));
        let shortest = bonds.map(length).fold(f64::INFINITY, f64::min);
        let furthest = info.rest_position.iter().flatten().fold(0.0, |most: f32, x| most.max(x.abs()));
        Self {
            materials: spec
                .materials()
                .map(|one| OfMaterial {
                    law: one.bond.law.clone(),
                    young: one.material.young,
                    criterion: one.bond.rupture.as_ref().map(|r| r.criterion.clone()),
                })
                .collect(),
            material_of: info.wires.iter().flat_map(|wire| vec![wire.material; wire.len]).collect(),
            one_way: spec.grip.as_ref().is_some_and(|grip| matches!(grip.drive, DriveSpec::Speed(v) if v > 0.0)),
            factor,
            steps: speeds(spec).map(|speed| speed * longest_step / shortest),
            rounding: f64::from(furthest) * f64::from(f32::EPSILON) * 4.0,
        }
    }

    fn of(&self, slot: usize) -> &OfMaterial {
        &self.materials[self.material_of[slot]]
    }

    fn factor(&self, slot: usize) -> f64 {
        self.factor.get(slot).copied().unwrap_or(1.0)
    }

    /// Of a criterion that breaks what is pulled beyond `stress` (Pa), and nothing for being pushed. What is pulled one way is
    /// pushed only when it springs back, which is no more than it was pulled.
    fn in_tension(&self, stress: f64) -> Bounds {
        Bounds::new(if self.one_way { stress } else { f64::INFINITY }, stress)
    }

    /// True stress that the bond at `slot`, which is whole, can have (MPa): the hardening law's at its plastic strain `p`, the elastic law's at its
    /// log strain and rest length (m), positions being rounded.
    pub fn bond(&self, slot: usize, p: f64, [strain, rest]: [f64; 2]) -> Option<f64> {
        let OfMaterial { law, young, .. } = self.of(slot);
        Some(match law {
            BondLawSpec::Elastic => young * (strain.abs() + self.rounding / rest) * 1e-6,
            BondLawSpec::ElastoPlastic(hardening) => self.reached(hardening, p, true) * 1e-6,
        })
    }

    /// Plastic strain at which a bond breaks (-), if it breaks by that.
    pub fn plastic(&self, slot: usize) -> Option<f64> {
        match self.of(slot).criterion {
            Some(RuptureCriterion::PlasticStrain { strain }) => Some(strain * self.factor(slot)),
            Some(RuptureCriterion::BeamStress { .. } | RuptureCriterion::FibreStrain { .. }) | None => None,
        }
    }

    /// True stress of a bond that has reached the plastic strain `p` (Pa). Within a step it follows the slope that the law has
    /// at the step's beginning, and laws grow less steep: fast motion leaves a little more than the law has at the end.
    /// `sprung` says that something may have sprung back before.
    fn reached(&self, hardening: &Hardening, p: f64, sprung: bool) -> f64 {
        let from = (p - self.steps[usize::from(sprung)]).max(0.0);
        let end = hardening.stress(p);
        if from >= p {
            return end;
        }
        let (stress, slope) = hardening.evaluate(from);
        end.max(stress + slope * (p - from))
    }

    /// How far plastic strain can be beyond its limit `end` when that is noticed (-): by a step, or a hundredth of the limit.
    fn beyond(&self, end: f64, sprung: bool) -> f64 {
        end + (0.01 * end).max(self.steps[usize::from(sprung)])
    }

    /// True stress that a bond can have when it breaks, the first one to break or not; see [`Limits::beyond`] for limits of
    /// plastic strain, and [`NOTICED`] for others.
    pub fn breaking(&self, slot: usize, first: bool) -> Bounds {
        use BondLawSpec::{Elastic, ElastoPlastic};
        let OfMaterial { law, young, criterion: Some(criterion) } = self.of(slot) else { return Bounds::NONE };
        let factor = self.factor(slot);
        match (criterion, law) {
            (RuptureCriterion::PlasticStrain { strain }, ElastoPlastic(hardening)) => {
                Bounds::both(self.reached(hardening, self.beyond(strain * factor, !first), !first))
            }
            // An elastic bond has no plastic strain to break by.
            (RuptureCriterion::PlasticStrain { .. }, Elastic) => Bounds::NONE,
            (RuptureCriterion::BeamStress { tensile, .. }, Elastic | ElastoPlastic(_)) => {
                self.in_tension(NOTICED * tensile * factor)
            }
            (RuptureCriterion::FibreStrain { strain }, Elastic) => {
                self.in_tension(NOTICED * young * (strain * factor).ln_1p())
            }
            (RuptureCriterion::FibreStrain { strain }, ElastoPlastic(hardening)) if self.one_way => {
                Bounds::both(hardening.stress(NOTICED * (strain * factor).ln_1p()))
            }
            // Plastic strain adds up without stretching any fibre.
            (RuptureCriterion::FibreStrain { .. }, ElastoPlastic(_)) => Bounds::NONE,
        }
    }

    /// Nominal stress that any wire of material `material` can have. A law of plasticity has the same stress on both
    /// sides, on a section that thins when it is pulled and thickens when it is pushed.
    pub fn wire(&self, material: usize) -> Bounds {
        use BondLawSpec::{Elastic, ElastoPlastic};
        let OfMaterial { law, young, criterion: Some(criterion) } = &self.materials[material] else {
            return Bounds::NONE;
        };
        let own = self.material_of.iter().enumerate().filter(|(_, of)| **of == material);
        let most = own.map(|(slot, _)| self.factor(slot)).fold(0.0, f64::max);
        match (criterion, law) {
            (RuptureCriterion::PlasticStrain { strain }, ElastoPlastic(hardening)) => {
                Bounds::both(self.greatest_nominal(hardening, self.beyond(strain * most, true)))
            }
            (RuptureCriterion::PlasticStrain { .. }, Elastic) => Bounds::NONE,
            (RuptureCriterion::BeamStress { tensile, .. }, Elastic | ElastoPlastic(_)) => {
                self.in_tension(NOTICED * tensile * most)
            }
            (RuptureCriterion::FibreStrain { strain }, Elastic) => {
                self.in_tension(NOTICED * young * (strain * most).ln_1p())
            }
            (RuptureCriterion::FibreStrain { strain }, ElastoPlastic(hardening)) if self.one_way => {
                Bounds::both(self.greatest_nominal(hardening, 1.01 * NOTICED * (strain * most).ln_1p()))
            }
            // Plastic strain adds up without stretching any fibre.
            (RuptureCriterion::FibreStrain { .. }, ElastoPlastic(_)) => Bounds::NONE,
        }
    }

    /// Greatest nominal stress of a bond whose plastic strain goes up to `end` (Pa).
    fn greatest_nominal(&self, hardening: &Hardening, end: f64) -> f64 {
        let stretched = if self.one_way { -1.0 } else { 1.0 };
        let nominal = |p: f64| self.reached(hardening, p, true) * (stretched * p).exp();
        (0..=2000).map(|k| nominal(end * f64::from(k) / 2000.0)).fold(0.0, f64::max)
    }
}

/// Greatest speed at which the drive moves the ends of a bond against each other, without and with what springs back after a
/// break (m/s). A pull begins as an even field; a grip that swings sends waves, which meet, and are thrown back at twice
/// their speed. What springs back from a stress σ moves at σ/(ρc), from either side.
fn speeds(spec: &Spec) -> [f64; 2] {
    let driven = spec.grip.as_ref().map_or(0.0, |grip| match (grip.drive, &grip.adaptive) {
        (_, Some(adaptive)) => adaptive.fastest,
        (DriveSpec::Speed(speed), None) => speed.abs(),
        (DriveSpec::Cyclic { amplitude, frequency }, None) => 4.0 * (TAU * frequency * amplitude).abs(),
    });
    let sprung = |one: OneMaterial| {
        let strain = match one.bond.rupture.as_ref().map(|rupture| &rupture.criterion) {
            Some(RuptureCriterion::PlasticStrain { strain }) => *strain,
            Some(RuptureCriterion::BeamStress { .. } | RuptureCriterion::FibreStrain { .. }) | None => 0.0,
        };
        let stress = match &one.bond.law {
            BondLawSpec::ElastoPlastic(hardening) => hardening.stress(strain),
            BondLawSpec::Elastic => 0.0,
        };
        2.0 * stress / (one.material.young * one.material.density * spec.time.mass_scale).sqrt()
    };
    [driven, driven + spec.materials().map(sprung).fold(0.0, f64::max)]
}
