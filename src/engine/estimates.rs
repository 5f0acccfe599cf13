//! What scene and body say before a step is taken: estimates in closed form.

use crate::scene::spec::{BondLawSpec, RuptureCriterion, Spec};
use crate::strand::assembly::Assembly;

/// Time in which an elastic wave runs along the body (s).
pub fn wave_passage(spec: &Spec, assembly: &Assembly) -> f64 {
    assembly.length / (spec.material.young / (spec.material.density * spec.time.mass_scale)).sqrt()
}

/// An energy that is nothing (J): what an elastic strain of 1e-9 everywhere would store.
pub fn negligible_energy(spec: &Spec, assembly: &Assembly) -> f64 {
    const STRAIN: f64 = 1e-9;
    let volume = assembly.mass.iter().sum::<f64>() / (spec.material.density * spec.time.mass_scale);
    0.5 * spec.material.young * STRAIN * STRAIN * volume
}

/// The strain at which bonds are expected to break (-); infinite when they never do.
pub fn rupture_strain(spec: &Spec) -> f64 {
    match spec.bond.rupture.as_ref().map(|r| &r.criterion) {
        // True plastic strain to engineering strain.
        Some(RuptureCriterion::PlasticStrain { strain }) => strain.exp_m1(),
        Some(RuptureCriterion::FibreStrain { strain }) => *strain,
        Some(RuptureCriterion::BeamStress { tensile, .. }) => tensile / spec.material.young,
        None => f64::INFINITY,
    }
}

/// Nominal axial stress of a wire strained by `strain` (-), by its bond law alone (Pa).
pub fn nominal_stress(spec: &Spec, strain: f64) -> f64 {
    let elastic = spec.material.young * strain;
    match &spec.bond.law {
        BondLawSpec::Elastic => elastic,
        // True stress over stretch, with an incompressible wire.
        BondLawSpec::ElastoPlastic(h) => elastic.min(h.stress(strain.ln_1p()) / (1.0 + strain)),
    }
}
