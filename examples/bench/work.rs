//! Floating-point operations of each stage: those of bonds counted by running the formulas with numbers that count,
//! those of contacts and of motion counted by hand in the sources named.

use crate::counted::{Counted, Operations, count};
use strandsnap::engine::Engine;
use strandsnap::engine::bonds::trial::Trial;
use strandsnap::law::bond::elastic::Elastic;
use strandsnap::law::bond::elasto_plastic::ElastoPlastic;
use strandsnap::law::bond::{BondLaw, Moduli};
use strandsnap::scene::spec::{BondLawSpec, ContactSpec, NormalSpec, Spec, TangentialSpec};

const fn operations(simple: u32, divisions: u32, roots: u32) -> Operations {
    Operations { simple: simple as f64, divisions: divisions as f64, roots: roots as f64 }
}

/// A candidate whose surfaces are apart: two squares and a comparison, and nothing to add up but zeros.
const CANDIDATE: Operations = operations(11 + GATHER, 0, 0);
/// Adding a contact to its two particles: force, and its twist times a lever arm.
const GATHER: u32 = 2 * 13;
/// Geometry and motion of a touching pair, thinning, normal dashpot, force and twist (engine/spheres, engine/pair).
const TOUCH: Operations = operations(89 - 11, 2, 2);
/// Force, stiffness and contact radius (law/contact/hertz).
const HERTZ: Operations = operations(6, 0, 1);
/// The same on the curve of unloading, the cheaper branch: what is counted must be a lower bound (law/contact/thornton).
const THORNTON: Operations = operations(11, 0, 1);
/// Turning the pull, the two caps where nothing slides, spring, work and energy (law/tangential/mindlin).
const MINDLIN: Operations = operations(68, 3, 1);
/// Kick, drift, greatest displacement and gathering one bond on either side, per three axes (engine/integrate).
const MOTION: Operations = operations(9 + 11 + 6, 0, 0);
/// The same for spins and torques.
const SPIN: Operations = operations(9 + 6, 0, 0);
/// Displacement against the affine stretch, and adding force and torque of contacts.
const BESIDE_CONTACTS: Operations = operations(12 + 6, 0, 0);
/// Radius as the mean over two bonds.
const THINNING: Operations = operations(3, 1, 0);

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
        let per_contact = spec.contact.as_ref().map_or(Operations::default(), contact);
        Self {
            integrate: motion.times(particles),
            bonds: if plan.bonds {
                bond(spec, plan.rotations, engine.strain()).times(particles)
            } else {
                motion.times(0)
            },
            contacts: CANDIDATE.times(candidates as usize).plus(per_contact.times(active as usize)),
        }
    }
}

/// What a touching pair does more than a candidate.
fn contact(contact: &ContactSpec) -> Operations {
    let normal = match contact.normal {
        NormalSpec::Hertz => HERTZ,
        NormalSpec::Thornton { .. } => THORNTON,
    };
    let tangential = match contact.tangential {
        // Partial slip does at least what no slip does.
        Some(TangentialSpec::Mindlin | TangentialSpec::MindlinDeresiewicz) if contact.friction > 0.0 => MINDLIN,
        _ => Operations::default(),
    };
    TOUCH.plus(normal).plus(tangential)
}

/// Operations of one bond at `strain` [-].
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
