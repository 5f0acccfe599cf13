//! Contacts: one folder per shape of bodies (`spheres`, `wires`), what a touching pair does ([`pair`]), and the one
//! place where laws and shape are chosen.

pub mod formula;
pub mod pair;
pub(super) mod spheres;
mod stage;
mod wires;

pub use spheres::meeting::ENERGIES as PAIR_SUMS;
pub use stage::{Contacts, Elsewhere};

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
use pair::Laws;
use spheres::SphereContacts;
use wires::WireContacts;

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
