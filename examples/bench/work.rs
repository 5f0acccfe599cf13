//! Floating-point operations of each stage: those of the laws of bonds and contacts counted by running the formulas with
//! numbers that count, those of the geometry of contacts and of motion counted by hand in the sources named.

use crate::counted::{Counted, Operations, count};
use strandsnap::base::triple::Triple;
use strandsnap::engine::Engine;
use strandsnap::engine::bonds::trial::Trial;
use strandsnap::engine::contact::pair::{ContactKinematics, History, Laws, contact_response};
use strandsnap::law::bond::elastic::Elastic;
use strandsnap::law::bond::elasto_plastic::ElastoPlastic;
use strandsnap::law::bond::{BondLaw, Moduli};
use strandsnap::law::contact::NormalLaw;
use strandsnap::law::contact::constants::{effective_modulus, effective_shear_modulus};
use strandsnap::law::contact::hertz::Hertz;
use strandsnap::law::contact::thornton::Thornton;
use strandsnap::law::tangential::TangentialLaw;
use strandsnap::law::tangential::mindlin::Mindlin;
use strandsnap::law::tangential::none::Frictionless;
use strandsnap::scene::spec::{BondLawSpec, ContactSpec, NormalSpec, Spec};

const fn operations(simple: u32) -> Operations {
    Operations { simple: simple as f64, divisions: 0.0, roots: 0.0 }
}

/// Geometry and motion of a touching pair, force and torque of its two sides, and adding them up (engine/contact/spheres): the
/// distance and its inverse, overlap, lever arms, relative velocity, products, sums of energies.
const GEOMETRY: Operations = operations(3 + 3 + 15 + 4 + 5 + 3 + 6 + 9 + 9 + 6 + 12 + 4);
/// Kick, drift, greatest displacement and gathering one bond on either side, per three axes (engine/integrate).
const MOTION: Operations = operations(9 + 11 + 6);
/// The same for spins and torques.
const SPIN: Operations = operations(9 + 6);
/// Displacement against the affine stretch, and adding force and torque of contacts.
const BESIDE_CONTACTS: Operations = operations(12 + 6);
/// Radius as the mean over two bonds.
const THINNING: Operations = operations(4);

/// Operations of one step by stage.
#[derive(Debug, Clone, Copy, Default)]
pub struct Work {
    /// Motion.
    pub integrate: Operations,
    /// Bonds.
    pub bonds: Operations,
    /// Contacts.
    pub contacts: Operations,
}

impl Work {
    /// Of the engine as it is now, with so many candidates and closed contacts.
    pub fn of(spec: &Spec, engine: &Engine, candidates: f64, active: f64) -> Self {
        let plan = engine.plan();
        let particles = engine.assembly().len();
        let mut motion = MOTION;
        if plan.rotations {
            motion = motion.plus(SPIN);
        }
        if candidates > 0.0 {
            motion = motion.plus(BESIDE_CONTACTS);
        }
        if matches!(spec.bond.law, BondLawSpec::ElastoPlastic(_)) {
            motion = motion.plus(THINNING);
        }
        Self {
            integrate: motion.times(particles),
            bonds: if plan.bonds {
                bond(spec, plan.rotations, engine.strain()).times(particles)
            } else {
                motion.times(0)
            },
            // Pairs that are apart rest most of the time.
            contacts: contact(spec).times(active as usize),
        }
    }
}

/// Operations of a touching pair.
fn contact(spec: &Spec) -> Operations {
    let Some(contact) = &spec.contact else { return Operations::default() };
    let (e, nu, g) = (spec.material.young, spec.material.poisson, spec.material.shear());
    let effective_modulus = effective_modulus(e, nu, e, nu);
    match contact.normal {
        NormalSpec::Hertz => rubbing(contact, g, nu, Hertz { effective_modulus }),
        NormalSpec::Thornton { limiting_pressure } => {
            rubbing(contact, g, nu, Thornton { effective_modulus, limiting_pressure })
        }
    }
}

/// Partial slip is counted as no slip, which it does at the least: its branches are taken one by one.
fn rubbing<N: NormalLaw>(contact: &ContactSpec, g: f64, nu: f64, normal: N) -> Operations {
    let (damping, friction) = (contact.damping, contact.friction);
    if contact.tangential.is_some() && friction > 0.0 {
        let tangential = Mindlin { shear_modulus_star: effective_shear_modulus(g, nu, g, nu), friction };
        meeting(&Laws { normal, tangential, damping })
    } else {
        meeting(&Laws { normal, tangential: Frictionless, damping })
    }
}

/// One more step of a contact that loads.
fn meeting<N: NormalLaw, T: TangentialLaw>(laws: &Laws<N, T>) -> Operations {
    let (zero, one) = (Counted(0.0), Counted(1.0));
    let mut history = History::<N, T, Counted>::of(Counted(1e-4), |_| zero);
    let at = |overlap: f64| ContactKinematics {
        normal: Triple { x: one, y: zero, z: zero },
        overlap: Counted(overlap),
        thinner: zero,
        velocity: Triple { x: Counted(-1e-3), y: Counted(1e-3), z: zero },
        viscosity: one,
        dt: Counted(1e-7),
    };
    contact_response(laws, &mut history, &at(1e-6));
    GEOMETRY.plus(count(|| {
        contact_response(laws, &mut history, &at(1.001e-6));
    }))
}

/// Operations of one bond at `strain` (-).
pub fn bond(spec: &Spec, turn: bool, strain: f64) -> Operations {
    let moduli = Moduli::new(spec.material.young, spec.material.poisson);
    let damped = spec.bond.damping.iter().any(|d| *d > 0.0);
    match &spec.bond.law {
        BondLawSpec::Elastic => stretched(Elastic { moduli }, turn, damped, strain),
        BondLawSpec::ElastoPlastic(h) => {
            stretched(ElastoPlastic { moduli, hardening: h.clone() }, turn, damped, strain)
        }
    }
}

/// One small step of a bond that was stretched to `strain` in many.
fn stretched<L: BondLaw>(law: L, turn: bool, damped: bool, strain: f64) -> Operations {
    const STEPS: u32 = 1000;
    let mut trial = Trial::new(law, Counted(1.0), turn, damped);
    for k in 0..=STEPS {
        trial.step(1.0 + strain * f64::from(k) / f64::from(STEPS));
    }
    count(|| {
        trial.step(1.0 + strain * (1.0 + 1.0 / f64::from(STEPS)));
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_bond_does_more_costs_more() {
        let spec = |name: &str| strandsnap::scene::load(name, &[]).unwrap().spec;
        let (elastic, plastic) = (spec("cantilever"), spec("ka4"));
        let all = |turn, spec, strain| bond(spec, turn, strain).simple;
        assert!(all(false, &elastic, 1e-4) < all(true, &elastic, 1e-4));
        assert!(all(true, &elastic, 1e-4) < all(true, &plastic, 1e-5), "before yield");
        assert!(all(true, &plastic, 1e-5) < all(true, &plastic, 0.06), "the return to the yield surface");
    }
}
