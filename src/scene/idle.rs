//! Keys that change nothing: a default that every layer overrides, friction without a tangential law, contacts of a body
//! that touches nothing. One that a `--set` option gives is refused, because whoever gives it expects a change; one that
//! stands in the file is told, unless resolved scenes write it too.

use super::plan::{ContactPlan, Plan};
use super::raw::{RawLayer, RawNormal, RawScene, RawStrand, RawTangential};
use super::source::SceneSource;
use super::spec::{BondLawSpec, DriveSpec, HardeningSpec, Spec, StrandSpec};
use crate::base::error::Result;
use std::fmt;

/// A key without effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Idle {
    /// Its path, such as `strand.pitch`.
    pub key: String,
    /// Why.
    pub why: &'static str,
    /// Whether it is told when it stands in the file.
    in_file: InFile,
    /// Whether an option that gives it is refused, or told.
    as_option: AsOption,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum InFile {
    Told,
    /// Resolved scenes write it too, or it does no harm there.
    Silent,
    /// Told, unless an option gives this key, which makes it idle for one run.
    ToldUnless(&'static str),
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum AsOption {
    Refused,
    /// Programs give it to every scene, such as presets of quality and studies, or it may be wanted as it is.
    Told,
}

impl fmt::Display for Idle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` has no effect: {}", self.key, self.why)
    }
}

/// The keys of a scene that have no effect and are to be told.
///
/// # Errors
/// At an option that gives such a key.
pub(super) fn check(source: &SceneSource, raw: &RawScene, spec: &Spec, plan: &Plan) -> Result<Vec<Idle>> {
    let mut told = Vec::new();
    for idle in keys(raw, spec, plan) {
        let option = source.option_below(&idle.key);
        match (option, idle.as_option, idle.in_file) {
            (Some(path), AsOption::Refused, _) => {
                let what = format!("`{path}` changes nothing: {}", idle.why);
                return Err(source.error(&path, what, "leave it out, or change what it depends on"));
            }
            (Some(_), AsOption::Told, _) | (None, _, InFile::Told) => told.push(idle),
            (None, _, InFile::ToldUnless(key)) if source.option_below(key).is_none() => told.push(idle),
            (None, ..) => {}
        }
    }
    Ok(told)
}

/// Collects keys.
#[derive(Default)]
struct Found(Vec<Idle>);

impl Found {
    fn add(&mut self, idle: bool, key: impl Into<String>, why: &'static str, in_file: InFile, as_option: AsOption) {
        if idle {
            self.0.push(Idle { key: key.into(), why, in_file, as_option });
        }
    }

    /// Refused as an option, told in the file.
    fn told(&mut self, idle: bool, key: impl Into<String>, why: &'static str) {
        self.add(idle, key, why, InFile::Told, AsOption::Refused);
    }

    /// Refused as an option, silent in the file.
    fn silent(&mut self, idle: bool, key: impl Into<String>, why: &'static str) {
        self.add(idle, key, why, InFile::Silent, AsOption::Refused);
    }
}

/// Every key that is given and has no effect.
fn keys(raw: &RawScene, spec: &Spec, plan: &Plan) -> Vec<Idle> {
    let mut found = Found::default();
    if let (Some(raw), Some(strand)) = (&raw.strand, &spec.strand) {
        of_strand(&mut found, raw, strand);
    }
    of_bonds(&mut found, raw, spec);
    of_contact(&mut found, raw, plan);
    of_grip(&mut found, raw, spec);
    of_materials(&mut found, raw, spec);
    let rupture = spec.breaks();
    let density = raw.output.rupture_density.is_some();
    found.silent(density && !rupture, "output.rupture_density", "no bond of this scene can break");
    let fixed = spec.time.step.is_some();
    let why = "time.step fixes the step";
    found.add(fixed && raw.time.safety.is_some(), "time.safety", why, InFile::Silent, AsOption::Told);
    found.silent(fixed && raw.time.contact_resolution.is_some(), "time.contact_resolution", why);
    let scatter = plan.scatter;
    let why = "nothing in this scene scatters, so that every seed gives the same run";
    found.add(raw.seed.is_some() && !scatter, "seed", why, InFile::Silent, AsOption::Told);
    found.0
}

fn of_strand(found: &mut Found, raw: &RawStrand, strand: &StrandSpec) {
    if raw.construction.is_some() {
        return;
    }
    let on_axis = |k: usize| strand.layers[k].lay_radius == Some(0.0);
    let all = |own: fn(&RawLayer) -> bool, else_idle: &dyn Fn(usize) -> bool| {
        raw.layer.iter().enumerate().all(|(k, layer)| own(layer) || else_idle(k))
    };
    let why = "every layer that is laid around the axis has its own";
    found.told(raw.pitch.is_some() && all(|layer| layer.pitch.is_some(), &on_axis), "strand.pitch", why);
    let why = "every layer has its own";
    found.told(raw.lay.is_some() && all(|layer| layer.lay.is_some(), &|_| false), "strand.lay", why);
    let own = all(|layer| layer.wire_diameter.is_some(), &|_| false);
    found.told(raw.wire_diameter.is_some() && own, "strand.wire_diameter", why);
    for (k, layer) in raw.layer.iter().enumerate() {
        let key = |name: &str| format!("strand.layer.{k}.{name}");
        let why = "a wire on the axis is straight";
        found.silent(on_axis(k) && layer.pitch.is_some(), key("pitch"), why);
        found.silent(on_axis(k) && layer.lay.is_some(), key("lay"), why);
        found.silent(on_axis(k) && layer.phase.is_some(), key("phase"), why);
        let straight = !on_axis(k) && strand.layers[k].pitch.is_infinite();
        found.silent(straight && layer.lay.is_some(), key("lay"), "the wires of this layer are straight");
    }
}

fn of_bonds(found: &mut Found, raw: &RawScene, spec: &Spec) {
    let no_bonds = spec.strand.is_none() && spec.wires.is_empty();
    let bond = raw.bond.as_ref();
    let why = "the scene has no wires";
    found.silent(no_bonds && raw.spacing.is_some(), "spacing", why);
    found.silent(no_bonds && bond.is_some_and(|bond| bond.damping.is_some()), "bond.damping", why);
    found.silent(no_bonds && bond.is_some_and(|bond| bond.rupture.is_some()), "bond.rupture", why);
    let no_saturation = matches!(
        spec.bond.law,
        BondLawSpec::ElastoPlastic(HardeningSpec::Voce { saturation, rate, .. }) if saturation == 0.0 && rate != 0.0
    );
    found.told(
        no_saturation && spec.material_name.is_none(),
        "bond.hardening.rate",
        "there is no saturation that it leads to",
    );
}

/// Materials that no body is of, and what they would say.
fn of_materials(found: &mut Found, raw: &RawScene, spec: &Spec) {
    let rigid = |name: Option<&str>| spec.rigids.iter().any(|rigid| rigid.material_name.as_deref() == name);
    let bonded = |name: Option<&str>| spec.materials().any(|one| one.name == name);
    let used = |name: Option<&str>| bonded(name) || rigid(name);
    for name in raw.materials.keys().filter(|name| !used(Some(name))) {
        found.told(true, format!("materials.{name}"), "no body is of this material");
    }
    for (name, material) in raw.materials.iter().filter(|_| spec.contact.is_none()) {
        let given = [
            ("hardness_factor", material.hardness_factor.is_some()),
            ("hardness_strain", material.hardness_strain.is_some()),
            ("limiting_pressure", material.limiting_pressure.is_some()),
        ];
        for (key, given) in given {
            let switch = InFile::ToldUnless("contact.normal");
            let why = "the scene has no contacts";
            found.add(given, format!("materials.{name}.{key}"), why, switch, AsOption::Refused);
        }
    }
    let pairs = raw.contact.iter().flat_map(|contact| contact.pair.iter().enumerate());
    for (index, pair) in pairs {
        let all = |of: &dyn Fn(Option<&str>) -> bool| pair.materials.iter().flatten().all(|name| of(Some(name)));
        let key = format!("contact.pair.{index}");
        found.told(!all(&used), &key, "no body is of one of the two materials");
        let why = "of one of the two materials is a rigid body alone, which has its own `friction`";
        found.told(all(&used) && !all(&bonded), key, why);
    }
    if bonded(None) {
        return;
    }
    let why = "every body names its material";
    found.told(raw.material.is_some() && !rigid(None), "material", why);
    if let Some(bond) = &raw.bond {
        found.told(bond.law.is_some(), "bond.law", why);
        found.told(bond.hardening.is_some(), "bond.hardening", why);
        found.told(bond.rupture.is_some(), "bond.rupture", why);
        let own = raw.materials.values().all(|material| material.damping.is_some());
        found.told(bond.damping.is_some() && own, "bond.damping", "every material has its own");
    }
    if let Some(contact) = &raw.contact {
        let named = || raw.materials.values();
        let pressure = named().all(|m| m.limiting_pressure.is_some() || m.hardness_factor.is_some());
        let why = "every material has its own limiting pressure";
        found.told(contact.limiting_pressure.is_some() && pressure, "contact.limiting_pressure", why);
    }
}

fn of_contact(found: &mut Found, raw: &RawScene, plan: &Plan) {
    let Some(contact) = &raw.contact else { return };
    if contact.normal == Some(RawNormal::None) {
        let given = [
            ("tangential", contact.tangential.is_some()),
            ("friction", contact.friction.is_some()),
            ("pair", !contact.pair.is_empty()),
            ("shape", contact.shape.is_some()),
            ("hardness_factor", contact.hardness_factor.is_some()),
            ("hardness_strain", contact.hardness_strain.is_some()),
            ("limiting_pressure", contact.limiting_pressure.is_some()),
            ("damping", contact.damping.is_some()),
            ("restitution", contact.restitution.is_some()),
            ("skin", contact.skin.is_some()),
        ];
        let switch = InFile::ToldUnless("contact.normal");
        for (name, given) in given {
            let why = "contact.normal = \"none\" leaves contacts out";
            found.add(given, format!("contact.{name}"), why, switch, AsOption::Refused);
        }
        let why = "contact.normal = \"none\" leaves contacts out, and a rigid body does nothing but touch";
        found.add(!raw.body.is_empty(), "body", why, switch, AsOption::Refused);
        return;
    }
    if plan.contacts == ContactPlan::Absent && !plan.rigid {
        found.told(true, "contact", "one straight body that never breaks touches nothing");
        return;
    }
    let frictionless = contact.tangential == Some(RawTangential::None);
    let why = "contact.tangential = \"none\" leaves friction out";
    found.silent(frictionless && contact.friction.is_some(), "contact.friction", why);
    found.silent(frictionless && !contact.pair.is_empty(), "contact.pair", why);
    for (index, _) in raw.body.iter().enumerate().filter(|(_, body)| body.friction.is_some()) {
        found.silent(frictionless, format!("body.{index}.friction"), why);
    }
}

fn of_grip(found: &mut Found, raw: &RawScene, spec: &Spec) {
    let Some(grip) = &spec.grip else { return };
    let (Some(adaptive), DriveSpec::Speed(speed)) = (&grip.adaptive, grip.drive) else { return };
    let never = spec.stop.strain.is_some_and(|end| adaptive.from >= end);
    let why = "stop.strain ends the run before";
    found.add(never, "grip.adaptive.from", why, InFile::Told, AsOption::Told);
    let why = "`fastest` is no faster than grip.speed";
    found.add(adaptive.fastest == speed, "grip.adaptive", why, InFile::Told, AsOption::Told);
    let raw = raw.grip.as_ref().and_then(|grip| grip.adaptive.as_ref());
    let passages = raw.is_some_and(|raw| raw.passages.is_some());
    let unbreakable = !spec.breaks();
    found.silent(passages && unbreakable, "grip.adaptive.passages", "no bond of this scene can break");
}
