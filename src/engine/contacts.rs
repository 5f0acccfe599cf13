//! What the engine asks of contacts, whatever their laws and shape, and the one place where these are chosen.

use super::bytes::Bytes;
use super::neighbours::PairList;
use super::pair::Laws;
use super::saved::{Reader, Unfit, Writer};
use super::spheres::{SecondSides, SphereContacts};
use super::state::{Partial, State};
use super::time_step::Stiffness;
use super::wires::WireContacts;
use crate::law::contact::NormalLaw;
use crate::law::contact::constants::{effective_modulus, effective_shear_modulus};
use crate::law::contact::hertz::Hertz;
use crate::law::contact::thornton::Thornton;
use crate::law::tangential::TangentialLaw;
use crate::law::tangential::mindlin::Mindlin;
use crate::law::tangential::mindlin_deresiewicz::MindlinDeresiewicz;
use crate::law::tangential::none::Frictionless;
use crate::scene::spec::{ContactSpec, Material, NormalSpec, Shape, TangentialSpec};
use crate::strand::assembly::Assembly;

/// Contacts of a run.
pub trait Contacts: Send {
    /// Takes a new list of candidates; history of pairs that stay is kept. Returns what was lost with pairs that left.
    fn rebuild(&mut self, list: &PairList, state: &State) -> Partial;
    /// Computes all contacts and adds them up per particle in `state`, but for [`Self::second_sides`]; returns the
    /// energies of the step.
    fn compute(&mut self, state: &mut State) -> Partial;
    /// What contacts do besides what they have added up.
    fn second_sides(&self) -> Option<SecondSides<'_>>;
    /// Stored elastic energy at the positions of the last call of `compute` (J).
    fn elastic_energy(&self, state: &State) -> f64;
    /// Adds to each particle the normal forces of its contacts, without regard to direction (N).
    fn add_normal_forces(&self, onto: &mut [f64]);
    /// Number of touching pairs.
    fn active(&self) -> usize;
    /// Number of candidate pairs.
    fn candidates(&self) -> usize;
    /// Stiffnesses of touching pairs for the bound on the time step, as they can become within `horizon` (s).
    fn stiffness(&self, state: &State, horizon: f64, out: &mut Stiffness);
    /// Memory of the stage, among `particles` particles.
    fn bytes(&self, particles: usize) -> Bytes;
    /// Puts in what the contacts remember, in their order.
    fn save(&self, out: &mut Writer);
    /// Takes up what [`Self::save`] has put in, of the particles as they are in `state`.
    ///
    /// # Errors
    /// [`Unfit`] when it is of other bodies or laws.
    fn restore(&mut self, from: &mut Reader, state: &State) -> Result<(), Unfit>;
}

/// By how much the gap of two bodies may close while no particle moves further than 1 (-): 2 for the way of both, the
/// rest for wires that thicken as they shorten. So a pair that is apart need not be looked at for a while.
pub fn closing(assembly: &Assembly) -> f64 {
    let largest = assembly.radius.iter().copied().fold(0.0, f64::max);
    let shortest = assembly.rest_length.iter().copied().filter(|l| *l > 0.0).fold(f64::INFINITY, f64::min);
    // Two ends of a bond that come 2 nearer raise its log strain by 2/l, and its radius by half of that times itself; a
    // bond may be half as long as at rest.
    2.0 + 2.0 * (2.0 * largest) / shortest
}

/// Chooses laws and shape, once per run.
pub fn build(spec: &ContactSpec, material: &Material, assembly: &Assembly) -> Box<dyn Contacts> {
    let (e, nu, g) = (material.young, material.poisson, material.shear());
    let effective_modulus = effective_modulus(e, nu, e, nu);
    match spec.normal {
        NormalSpec::Hertz => tangential(spec, g, nu, assembly, Hertz { effective_modulus }),
        NormalSpec::Thornton { limiting_pressure } => {
            tangential(spec, g, nu, assembly, Thornton { effective_modulus, limiting_pressure })
        }
    }
}

fn tangential<N: NormalLaw>(spec: &ContactSpec, g: f64, nu: f64, assembly: &Assembly, normal: N) -> Box<dyn Contacts> {
    let shear_modulus_star = effective_shear_modulus(g, nu, g, nu);
    let friction = spec.friction;
    match spec.tangential {
        Some(_) if friction == 0.0 => shape(spec, assembly, normal, Frictionless),
        None => shape(spec, assembly, normal, Frictionless),
        Some(TangentialSpec::Mindlin) => shape(spec, assembly, normal, Mindlin { shear_modulus_star, friction }),
        Some(TangentialSpec::MindlinDeresiewicz) => {
            shape(spec, assembly, normal, MindlinDeresiewicz { shear_modulus_star, friction })
        }
    }
}

fn shape<N: NormalLaw, T: TangentialLaw>(
    spec: &ContactSpec,
    assembly: &Assembly,
    normal: N,
    tangential: T,
) -> Box<dyn Contacts> {
    let laws = Laws { normal, tangential, damping: spec.damping };
    match spec.shape {
        Shape::Sphere => Box::new(SphereContacts::new(laws, assembly)),
        Shape::Wire => Box::new(WireContacts::new(laws, assembly)),
    }
}
