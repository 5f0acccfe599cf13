//! Chooses the laws by which rigid bodies touch, once per run.

use super::bodies::{Part, Rigids};
use super::body::Body;
use super::stage::RigidBodies;
use crate::engine::contact::pair::Laws;
use crate::engine::contact::stage::closing;
use crate::engine::contact::wires::SPREAD;
use crate::engine::contact::wires::chains::Chains;
use crate::engine::neighbours::apart;
use crate::engine::state::{CHUNK, Deepest};
use crate::law::contact::NormalLaw;
use crate::law::contact::constants::{effective_modulus, effective_shear_modulus};
use crate::law::contact::hertz::Hertz;
use crate::law::contact::line::LineStiffness;
use crate::law::contact::thornton::Thornton;
use crate::law::tangential::TangentialLaw;
use crate::law::tangential::mindlin::Mindlin;
use crate::law::tangential::mindlin_deresiewicz::MindlinDeresiewicz;
use crate::law::tangential::none::Frictionless;
use crate::scene::rigid::RigidSpec;
use crate::scene::spec::{ContactSpec, NormalSpec, Shape, Spec, TangentialSpec};
use crate::strand::assembly::Assembly;

/// The rigid bodies of a scene; `None` where it has none.
pub fn build(spec: &Spec, assembly: &Assembly) -> Option<Box<dyn RigidBodies>> {
    let contact = spec.contact.as_ref().filter(|_| !spec.rigids.is_empty())?;
    let choice = Choice { spec, contact, assembly };
    let modulus = |rigid: &RigidSpec, material: usize| {
        let [a, b] = [&rigid.material, spec.material_at(material).material];
        effective_modulus(a.young, a.poisson, b.young, b.poisson)
    };
    // Bodies do not yield.
    let limit = |material: usize| spec.material_at(material).limiting_pressure.unwrap_or(f64::INFINITY);
    Some(match contact.normal {
        NormalSpec::Hertz => choice.tangential(|body, k| Hertz { effective_modulus: modulus(body, k) }),
        NormalSpec::Thornton { .. } => {
            choice.tangential(|body, k| Thornton { effective_modulus: modulus(body, k), limiting_pressure: limit(k) })
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
    fn tangential<N: NormalLaw>(&self, normal: impl Fn(&RigidSpec, usize) -> N) -> Box<dyn RigidBodies> {
        let modulus = |rigid: &RigidSpec, material: usize| {
            let [a, b] = [&rigid.material, self.spec.material_at(material).material];
            effective_shear_modulus(a.shear(), a.poisson, b.shear(), b.poisson)
        };
        let smooth = self.spec.rigids.iter().all(|rigid| rigid.friction == 0.0);
        match self.contact.tangential.filter(|_| !smooth) {
            None => self.bodies(normal, |_, _| Frictionless),
            Some(TangentialSpec::Mindlin) => {
                self.bodies(normal, |body, k| Mindlin { shear_modulus_star: modulus(body, k), friction: body.friction })
            }
            Some(TangentialSpec::MindlinDeresiewicz) => self.bodies(normal, |body, k| MindlinDeresiewicz {
                shear_modulus_star: modulus(body, k),
                friction: body.friction,
            }),
        }
    }

    fn bodies<N: NormalLaw, T: TangentialLaw>(
        &self,
        normal: impl Fn(&RigidSpec, usize) -> N,
        tangential: impl Fn(&RigidSpec, usize) -> T,
    ) -> Box<dyn RigidBodies> {
        let (assembly, damping) = (self.assembly, self.contact.damping);
        let law = |body: &RigidSpec, k| Laws { normal: normal(body, k), tangential: tangential(body, k), damping };
        let body = |spec| Body::new(spec, (0..self.spec.materials().len()).map(|k| law(spec, k)).collect());
        let bodies: Vec<Body<N, T>> = self.spec.rigids.iter().map(body).collect();
        let mut material_of = Vec::new();
        if self.spec.has_several_materials() {
            material_of = (0..assembly.len()).map(|particle| assembly.material_of(particle) as u32).collect();
        }
        let largest = assembly.radius.iter().copied().fold(0.0, f64::max);
        let smooth = self.contact.shape == Shape::Wire;
        Box::new(Rigids {
            parts: (0..assembly.len().div_ceil(CHUNK)).map(|_| Part::new(bodies.len())).collect(),
            bodies,
            line: LineStiffness::default(),
            chains: Chains::new(assembly, apart(assembly)),
            smooth,
            material_of,
            restitution: self.contact.restitution.is_some(),
            damping,
            skin: self.contact.skin * 2.0 * largest,
            // That of two bodies counts both.
            closing: 0.5 * closing(assembly) * if smooth { SPREAD } else { 1.0 },
            deepest: Deepest::default(),
        })
    }
}
