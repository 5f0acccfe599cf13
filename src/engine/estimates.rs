//! What scene and body say before a step is taken: estimates in closed form.

use crate::scene::spec::{BondLawSpec, OneMaterial, RuptureCriterion, Spec};
use crate::strand::assembly::Assembly;

/// Time in which an elastic wave runs along the body (s).
pub fn wave_passage(spec: &Spec, assembly: &Assembly) -> f64 {
    passage(spec, assembly.length)
}

/// Time in which an elastic wave runs along `length` (m) of the material in which it is slowest (s).
pub fn passage(spec: &Spec, length: f64) -> f64 {
    let of = |one: OneMaterial| length / (one.material.young / (one.material.density * spec.time.mass_scale)).sqrt();
    spec.materials().map(of).fold(0.0, f64::max)
}

/// An energy that is nothing (J): what an elastic strain of 1e-9 everywhere would store.
pub fn negligible_energy(spec: &Spec, assembly: &Assembly) -> f64 {
    const STRAIN: f64 = 1e-9;
    let of = |one: OneMaterial, mass: f64| {
        let volume = mass / (one.material.density * spec.time.mass_scale);
        0.5 * one.material.young * STRAIN * STRAIN * volume
    };
    if !spec.has_several_materials() {
        return of(spec.material_at(0), assembly.mass.iter().sum::<f64>());
    }
    let mut mass = vec![0.0; spec.materials().len()];
    (0..assembly.len()).for_each(|particle| mass[assembly.material_of(particle)] += assembly.mass[particle]);
    spec.materials().zip(mass).map(|(one, mass)| of(one, mass)).sum()
}

/// The strain at which the first bonds are expected to break (-); infinite when none ever does.
pub fn rupture_strain(spec: &Spec) -> f64 {
    spec.materials().map(rupture_strain_of).fold(f64::INFINITY, f64::min)
}

/// The strain at which bonds of the last material are expected to break (-); infinite where those of one never do.
pub fn last_rupture_strain(spec: &Spec) -> f64 {
    spec.materials().map(rupture_strain_of).fold(0.0, f64::max)
}

/// The strain at which bonds of a material are expected to break (-); infinite when they never do.
pub fn rupture_strain_of(one: OneMaterial) -> f64 {
    match one.bond.rupture.as_ref().map(|r| &r.criterion) {
        // True plastic strain to engineering strain.
        Some(RuptureCriterion::PlasticStrain { strain }) => strain.exp_m1(),
        Some(RuptureCriterion::FibreStrain { strain }) => *strain,
        Some(RuptureCriterion::BeamStress { tensile, .. }) => tensile / one.material.young,
        None => f64::INFINITY,
    }
}

/// Nominal axial stress of a wire of a material strained by `strain` (-), by its bond law alone (Pa).
pub fn nominal_stress(one: OneMaterial, strain: f64) -> f64 {
    let elastic = one.material.young * strain;
    match &one.bond.law {
        BondLawSpec::Elastic => elastic,
        // True stress over stretch, with an incompressible wire.
        BondLawSpec::ElastoPlastic(h) => elastic.min(h.stress(strain.ln_1p()) / (1.0 + strain)),
    }
}

/// Nominal stress of the body (Pa) whose wires are all strained by `strain` (-), by their bond laws alone.
pub fn body_stress(spec: &Spec, assembly: &Assembly, strain: f64) -> f64 {
    if !spec.has_several_materials() {
        return nominal_stress(spec.material_at(0), strain);
    }
    let of =
        |wire: &crate::strand::assembly::Wire| nominal_stress(spec.material_at(wire.material), strain) * wire.area();
    assembly.wires.iter().map(of).sum::<f64>() / assembly.area
}
