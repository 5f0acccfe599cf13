//! Contacts: one folder per shape of bodies (`spheres`, `wires`), what a touching pair does ([`pair`]), and the one
//! place where laws and shape are chosen; rigid bodies stand apart (`rigid`).

pub mod formula;
mod law_table;
pub mod pair;
pub mod rigid;
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
use crate::scene::spec::{ContactSpec, NormalSpec, Shape, Spec, TangentialSpec};
use crate::strand::assembly::Assembly;
use law_table::LawTable;
use pair::Laws;
use spheres::SphereContacts;
use wires::WireContacts;

/// Chooses laws and shape, once per run; `None` where the scene has no contacts.
pub fn build(spec: &Spec, assembly: &Assembly) -> Option<Box<dyn Contacts>> {
    let contact = spec.contact.as_ref()?;
    let modulus = |a: usize, b: usize| {
        let [a, b] = [a, b].map(|number| spec.material_at(number).material);
        effective_modulus(a.young, a.poisson, b.young, b.poisson)
    };
    // The softer of the two gives way.
    let softer = |a: usize, b: usize| {
        let [a, b] = [a, b].map(|number| spec.material_at(number).limiting_pressure.unwrap_or(f64::INFINITY));
        a.min(b)
    };
    let choice = Choice { spec, contact, assembly };
    Some(match contact.normal {
        NormalSpec::Hertz => choice.tangential(|a, b| Hertz { effective_modulus: modulus(a, b) }),
        NormalSpec::Thornton { .. } => {
            choice.tangential(|a, b| Thornton { effective_modulus: modulus(a, b), limiting_pressure: softer(a, b) })
        }
    })
}

/// What laws are chosen by.
struct Choice<'a> {
    spec: &'a Spec,
    contact: &'a ContactSpec,
    assembly: &'a Assembly,
}

impl Choice<'_> {
    fn tangential<N: NormalLaw>(&self, normal: impl Fn(usize, usize) -> N) -> Box<dyn Contacts> {
        let modulus = |a: usize, b: usize| {
            let [a, b] = [a, b].map(|number| self.spec.material_at(number).material);
            effective_shear_modulus(a.shear(), a.poisson, b.shear(), b.poisson)
        };
        let friction = |a: usize, b: usize| self.contact.friction_between(a, b);
        match self.contact.tangential {
            Some(_) if self.contact.is_smooth(self.spec.materials().len()) => self.shape(normal, |_, _| Frictionless),
            None => self.shape(normal, |_, _| Frictionless),
            Some(TangentialSpec::Mindlin) => {
                self.shape(normal, |a, b| Mindlin { shear_modulus_star: modulus(a, b), friction: friction(a, b) })
            }
            Some(TangentialSpec::MindlinDeresiewicz) => self.shape(normal, |a, b| MindlinDeresiewicz {
                shear_modulus_star: modulus(a, b),
                friction: friction(a, b),
            }),
        }
    }

    fn shape<N: NormalLaw, T: TangentialLaw>(
        &self,
        normal: impl Fn(usize, usize) -> N,
        tangential: impl Fn(usize, usize) -> T,
    ) -> Box<dyn Contacts> {
        let damping = self.contact.damping;
        let laws = |a, b| Laws { normal: normal(a, b), tangential: tangential(a, b), damping };
        let laws = LawTable::new(self.spec.materials().len(), self.assembly, laws)
            .with_restitution(self.contact.restitution.is_some());
        match self.contact.shape {
            Shape::Sphere => Box::new(SphereContacts::new(laws, self.assembly)),
            Shape::Wire => Box::new(WireContacts::new(laws, self.assembly)),
        }
    }
}
