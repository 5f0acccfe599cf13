//! What can be known to go wrong before a run begins: [`of_scene`] for those who check, [`of_run`] for those who run.

use crate::base::error::Result;
use crate::engine::Engine;
use crate::scene::Scene;
use crate::scene::caution;
use crate::scene::plan::Plan;
use crate::scene::spec::{BondLawSpec, DriveSpec, OneMaterial, Spec};
use crate::strand;
use crate::strand::assembly::Assembly;

/// Energy that contacts hold before the first step over what the load stores in bonds, from which it is told (-).
const STORED: f64 = 0.01;

/// All that is known of a scene and its geometry.
///
/// # Errors
/// What [`Engine::new`] refuses.
pub fn of_scene(scene: &Scene, assembly: &Assembly) -> Result<Vec<String>> {
    let mut all = caution::cautions(&scene.spec);
    all.extend(of_run(scene, assembly)?);
    Ok(all)
}

/// What a run does not find out on its way: keys without effect, wires that are not held, wires that leave the points
/// given, bodies that press on each other from the start.
///
/// # Errors
/// What [`Engine::new`] refuses.
pub fn of_run(scene: &Scene, assembly: &Assembly) -> Result<Vec<String>> {
    let mut all: Vec<String> = scene.idle.iter().map(ToString::to_string).collect();
    all.extend(strand::caution::cautions(&scene.spec, assembly));
    all.extend(stored(&scene.spec, &scene.plan, assembly)?);
    Ok(all)
}

/// Says when bodies that overlap from the start hold energy that counts beside what the load stores.
fn stored(spec: &Spec, plan: &Plan, assembly: &Assembly) -> Result<Option<String>> {
    if spec.contact.is_none() {
        return Ok(None);
    }
    let engine = Engine::new(spec, plan, assembly.clone())?;
    let energy = engine.sample().energy;
    let contacts = energy.elastic_contacts + energy.plastic_contacts;
    let strain = end_strain(spec, assembly, engine.info().strain_end);
    let Some(load) = strain.map(|strain| elastic_energy(spec, assembly, strain)).filter(|load| *load > 0.0) else {
        return Ok(None);
    };
    Ok((contacts > STORED * load).then(|| {
        format!(
            "bodies press on each other before the load begins: contacts hold {contacts:.2e} J, {:.0} % of the most that \
             the load will store in bonds ({load:.2e} J), and stress, torque and stiffness are off by it. {}",
            100.0 * contacts / load,
            capitalised(&strand::caution::remedy(spec, assembly))
        )
    }))
}

/// Greatest strain of the body that is foreseen (-).
fn end_strain(spec: &Spec, assembly: &Assembly, foreseen: Option<f64>) -> Option<f64> {
    match spec.grip.as_ref()?.drive {
        DriveSpec::Speed(_) => foreseen.map(f64::abs),
        DriveSpec::Cyclic { amplitude, .. } => {
            let grip = spec.grip.as_ref()?;
            let free = strand::held::Gripped::of(grip, assembly).free_length();
            (free > 0.0).then_some(amplitude / free)
        }
    }
}

/// Elastic energy in wires that are all strained as the body is (J): the most that the load can store.
fn elastic_energy(spec: &Spec, assembly: &Assembly, strain: f64) -> f64 {
    let of = |(number, one): (usize, OneMaterial)| {
        let young = one.material.young;
        let elastic = young * strain;
        let stress = match &one.bond.law {
            BondLawSpec::Elastic => elastic,
            BondLawSpec::ElastoPlastic(law) => elastic.min(law.stress(strain.ln_1p())),
        };
        let wires = assembly.wires.iter().filter(|wire| wire.material == number);
        let volume = wires.map(|wire| wire.area() * wire.bonds().map(|slot| assembly.rest_length[slot]).sum::<f64>());
        0.5 * stress * stress / young * volume.sum::<f64>()
    };
    spec.materials().enumerate().map(of).sum()
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().collect::<String>() + letters.as_str())
}
