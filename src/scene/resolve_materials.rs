//! Materials of a scene: `[material]` with `[bond]`, the named ones, and what holds between two of them.

use super::at::{At, Range};
use super::hardening;
use super::raw::*;
use super::spec::*;
use super::suggest::nearest;
use crate::base::error::Result;
use crate::base::units::Dimension;
use std::cell::RefCell;

/// Young's modulus of annealed copper where a scene gives none (Pa).
const COPPER_YOUNG: f64 = 115e9;
/// Density of copper where a scene gives none (kg/m³).
const COPPER_DENSITY: f64 = 8960.0;
/// Poisson's ratio of copper where a scene gives none (-).
const COPPER_POISSON: f64 = 0.34;
/// Limiting contact pressure over yield stress (-) (Tabor 1951: hardness is 2.8 to 3 times the flow stress).
const HARDNESS_FACTOR: f64 = 2.8;

/// Elastic constants and density of `[material]`.
fn material(at: &At, raw: Option<&RawMaterial>) -> Result<Material> {
    let none = RawMaterial::default();
    let raw = raw.unwrap_or(&none);
    let density = at.optional("density", &raw.density, Dimension::Density, Range::Positive)?;
    let young = at.optional("young", &raw.young, Dimension::Pressure, Range::Positive)?;
    Ok(Material {
        density: density.unwrap_or(COPPER_DENSITY),
        young: young.unwrap_or(COPPER_YOUNG),
        poisson: at.ratio_or("poisson", &raw.poisson, COPPER_POISSON, Range::Poisson)?,
    })
}

/// `[bond]`.
fn bond(at: &At, raw: Option<&RawBond>, material: &Material) -> Result<BondSpec> {
    let none = RawBond::default();
    let raw = raw.unwrap_or(&none);
    bond_of(at, raw.law, raw.hardening.as_ref(), raw.rupture.as_ref(), raw.damping.as_ref(), material)
}

/// Bonds from the keys of the table at `at`.
fn bond_of(
    at: &At,
    law: Option<RawBondLaw>,
    hardening: Option<&RawHardening>,
    rupture: Option<&RawRupture>,
    damping: Option<&RawDamping>,
    material: &Material,
) -> Result<BondSpec> {
    let law = match law.unwrap_or(RawBondLaw::Elastic) {
        RawBondLaw::Elastic => {
            at.refuse("hardening", &hardening, "has no effect under the elastic bond law")?;
            BondLawSpec::Elastic
        }
        RawBondLaw::ElastoPlastic => {
            let example = "{ form = \"voce\", yield_stress = \"90 MPa\" }";
            let given = hardening.ok_or_else(|| at.missing("hardening", example))?;
            BondLawSpec::ElastoPlastic(hardening::resolve(&at.key("hardening"), given, material.young)?)
        }
    };
    let rupture = rupture.map(|raw| self::rupture(&at.key("rupture"), raw, &law)).transpose()?;
    Ok(BondSpec { damping: self::damping(at, damping)?, law, rupture })
}

fn damping(at: &At, raw: Option<&RawDamping>) -> Result<[f64; 4]> {
    match raw {
        None => Ok([0.0; 4]),
        Some(RawDamping::All(raw)) => {
            let value = at.key("damping").quantity(raw, Dimension::Ratio, Range::NotNegative)?;
            Ok([value; 4])
        }
        Some(RawDamping::Modes(raw)) => {
            let at = at.key("damping");
            let mode = |name, raw| at.ratio_or(name, raw, 0.0, Range::NotNegative);
            Ok([
                mode("axial", &raw.axial)?,
                mode("shear", &raw.shear)?,
                mode("bending", &raw.bending)?,
                mode("torsion", &raw.torsion)?,
            ])
        }
    }
}

fn rupture(at: &At, raw: &RawRupture, law: &BondLawSpec) -> Result<RuptureSpec> {
    let form = raw.criterion.ok_or_else(|| at.missing("criterion", "\"plastic-strain\""))?;
    let beam = form == RawCriterion::BeamStress;
    if beam {
        at.refuse(
            "strain",
            &raw.strain,
            "does not belong to beam-stress, which takes tensile, shear and moment_share",
        )?;
    } else {
        let why = "belongs to beam-stress only; this criterion takes strain";
        at.refuse("tensile", &raw.tensile, why)?;
        at.refuse("shear", &raw.shear, why)?;
        at.refuse("moment_share", &raw.moment_share, why)?;
    }
    if form == RawCriterion::PlasticStrain && *law == BondLawSpec::Elastic {
        let help = "set bond.law = \"elasto-plastic\", or take beam-stress or fibre-strain";
        return Err(at.key("criterion").error("plastic-strain never holds under the elastic bond law", help));
    }
    let strain = || at.required("strain", &raw.strain, Dimension::Ratio, Range::Positive);
    let stress = |name, raw| at.required(name, raw, Dimension::Pressure, Range::Positive);
    let criterion = match form {
        RawCriterion::PlasticStrain => RuptureCriterion::PlasticStrain { strain: strain()? },
        RawCriterion::FibreStrain => RuptureCriterion::FibreStrain { strain: strain()? },
        RawCriterion::BeamStress => RuptureCriterion::BeamStress {
            tensile: stress("tensile", &raw.tensile)?,
            shear: stress("shear", &raw.shear)?,
            moment_share: at.ratio_or("moment_share", &raw.moment_share, 1.0, Range::UnitInterval)?,
        },
    };
    let modulus = at.ratio_or("weibull_modulus", &raw.weibull_modulus, f64::INFINITY, Range::PositiveOrInfinite)?;
    Ok(RuptureSpec { criterion, weibull_modulus: modulus })
}

/// What a table says of the limiting pressure.
#[derive(Clone, Copy, Default)]
pub(super) struct GivenHardness {
    /// Pressure over flow stress (-).
    factor: Option<f64>,
    /// Plastic strain at which the flow stress is taken (-).
    strain: Option<f64>,
    /// The pressure itself (Pa).
    pressure: Option<f64>,
}

impl GivenHardness {
    /// What `[contact]` says.
    pub fn of_contact(at: &At, raw: &RawContact) -> Result<Self> {
        Self::read(at, &raw.hardness_factor, &raw.hardness_strain, &raw.limiting_pressure)
    }

    fn read(at: &At, factor: &Option<Scalar>, strain: &Option<Scalar>, pressure: &Option<Scalar>) -> Result<Self> {
        Ok(Self {
            factor: at.optional("hardness_factor", factor, Dimension::Ratio, Range::Positive)?,
            strain: at.optional("hardness_strain", strain, Dimension::Ratio, Range::NotNegative)?,
            pressure: at.optional("limiting_pressure", pressure, Dimension::Pressure, Range::Positive)?,
        })
    }

    fn refuse_rule(&self, at: &At, why: &str) -> Result<()> {
        at.refuse("hardness_factor", &self.factor, why)?;
        at.refuse("hardness_strain", &self.strain, why)
    }

    fn is_rule(&self) -> bool {
        self.factor.is_some() || self.strain.is_some()
    }
}

/// The materials of a scene, and which of them bodies have named so far.
pub(super) struct Materials<'a> {
    root: At<'a>,
    /// That of `[material]` and `[bond]`.
    unnamed: MaterialSpec,
    /// The named ones, in the order of their names, with what each says of its limiting pressure.
    named: Vec<(MaterialSpec, GivenHardness)>,
    /// Those that bodies are of, by their place in `named`; `None` stands for the unnamed one.
    used: RefCell<Vec<Option<usize>>>,
}

impl<'a> Materials<'a> {
    /// Those of `raw`, of which there are no bodies yet.
    pub fn new(root: &At<'a>, raw: &RawScene) -> Result<Self> {
        let material = material(&root.key("material"), raw.material.as_ref())?;
        let bond = bond(&root.key("bond"), raw.bond.as_ref(), &material)?;
        let all = root.key("materials");
        let named = raw.materials.iter().map(|(name, raw)| named(&all, name, raw, bond.damping));
        let named = named.collect::<Result<_>>()?;
        let unnamed = MaterialSpec { name: None, material, bond, limiting_pressure: None, hardness: None };
        Ok(Self { root: root.clone(), unnamed, named, used: RefCell::default() })
    }

    /// Number of the material that a body at `at` names, which is its place among those named so far.
    pub fn number(&self, at: &At, name: Option<&String>) -> Result<usize> {
        let wanted = name.map(|name| self.place(&at.key("material"), name)).transpose()?;
        let mut used = self.used.borrow_mut();
        let number = used.iter().position(|known| *known == wanted);
        Ok(number.unwrap_or_else(|| {
            used.push(wanted);
            used.len() - 1
        }))
    }

    /// Place of a name among the named ones.
    fn place(&self, at: &At, name: &str) -> Result<usize> {
        let names = || self.named.iter().filter_map(|(material, _)| material.name.as_deref());
        names().position(|known| known == name).ok_or_else(|| {
            let all = names().collect::<Vec<_>>().join(", ");
            let help = match (nearest(name, names()), self.named.is_empty()) {
                (Some(near), _) => format!("did you mean \"{near}\"? named materials: {all}"),
                (None, true) => format!("add [materials.{name}] with density, young and poisson"),
                (None, false) => format!("named materials: {all}"),
            };
            at.error(format!("no material is named {name:?}"), help)
        })
    }

    /// The elastic constants that a rigid body at `at` names, which makes no material that bonds are of.
    pub fn elastic(&self, at: &At, name: Option<&String>) -> Result<(Option<String>, Material)> {
        let place = name.map(|name| self.place(&at.key("material"), name)).transpose()?;
        let spec = place.map_or(&self.unnamed, |k| &self.named[k].0);
        Ok((spec.name.clone(), spec.material))
    }

    /// The materials that bodies are of, by number.
    pub fn of_bodies(&self) -> Vec<MaterialSpec> {
        let one = |place: &Option<usize>| place.map_or(&self.unnamed, |k| &self.named[k].0).clone();
        self.used.borrow().iter().map(one).collect()
    }

    /// Resolves `[[contact.pair]]`; those of materials that no body is of are left out.
    pub fn pairs(&self, at: &At, raw: &[RawContactPair]) -> Result<Vec<PairSpec>> {
        let (mut pairs, mut known): (Vec<PairSpec>, Vec<[usize; 2]>) = (Vec::new(), Vec::new());
        for (index, raw) in raw.iter().enumerate() {
            let here = at.element(index);
            let names = raw.materials.as_ref().ok_or_else(|| here.missing("materials", "[\"steel\", \"copper\"]"))?;
            let names_at = here.key("materials");
            if names.len() != 2 {
                let what = format!("a pair is of two materials, and here are {}", names.len());
                return Err(names_at.error(
                    what,
                    "name two, such as [\"steel\", \"copper\"]; the same one twice for two bodies of it",
                ));
            }
            let (a, b) = (self.place(&names_at.element(0), &names[0])?, self.place(&names_at.element(1), &names[1])?);
            let friction = here.required("friction", &raw.friction, Dimension::Ratio, Range::NotNegative)?;
            let places = [a.min(b), a.max(b)];
            if known.contains(&places) {
                let what = format!("the pair of {:?} and {:?} is there twice", names[0], names[1]);
                return Err(names_at.error(what, "the order of the two says nothing; remove one"));
            }
            known.push(places);
            let used = self.used.borrow();
            let number = |place: usize| used.iter().position(|known| *known == Some(place));
            if let (Some(a), Some(b)) = (number(a), number(b)) {
                pairs.push(PairSpec { materials: [a.min(b), a.max(b)], friction });
            }
        }
        pairs.sort_by_key(|pair| pair.materials);
        Ok(pairs)
    }

    /// Refuses what named materials say of limiting pressures.
    pub fn refuse_hardness(&self, why: &str) -> Result<()> {
        self.each_named().try_for_each(|(at, given)| {
            given.refuse_rule(&at, why)?;
            at.refuse("limiting_pressure", &given.pressure, why)
        })
    }

    fn each_named(&self) -> impl Iterator<Item = (At<'a>, &GivenHardness)> {
        self.named.iter().map(|(material, given)| (self.at(material.name.as_deref()), given))
    }

    fn at(&self, name: Option<&str>) -> At<'a> {
        match name {
            Some(name) => self.root.key("materials").key(name),
            None => self.root.key("bond"),
        }
    }

    /// Thornton's p_y of the materials in `used`: each its own, or by its own rule, or as `[contact]` at `contact` says.
    pub fn limit_pressures(&self, contact: &At, given: &GivenHardness, used: &mut [MaterialSpec]) -> Result<()> {
        const BESIDE: &str = "has no effect beside limiting_pressure";
        if given.pressure.is_some() {
            given.refuse_rule(contact, BESIDE)?;
        }
        for (at, own) in self.each_named() {
            if own.pressure.is_some() {
                own.refuse_rule(&at, BESIDE)?;
            }
        }
        for material in used {
            let place = self.named.iter().find(|(named, _)| named.name == material.name);
            let own = place.map(|(_, own)| *own).unwrap_or_default();
            let pressure = if own.is_rule() { own.pressure } else { own.pressure.or(given.pressure) };
            if pressure.is_some() {
                material.limiting_pressure = pressure;
                continue;
            }
            let at = if material.name.is_some() { &self.at(material.name.as_deref()) } else { contact };
            let BondLawSpec::ElastoPlastic(law) = &material.bond.law else {
                let example = "\"600 MPa\" (under an elastic bond law there is no yield stress)";
                return Err(at.missing("limiting_pressure", example));
            };
            let hardness = Hardness {
                factor: own.factor.or(given.factor).unwrap_or(HARDNESS_FACTOR),
                strain: own.strain.or(given.strain).unwrap_or(0.0),
            };
            material.limiting_pressure = Some(hardness.limiting_pressure(law));
            material.hardness = Some(hardness);
        }
        Ok(())
    }
}

/// The first of the materials that bodies are of, and the others.
pub(super) fn in_order(mut used: Vec<MaterialSpec>) -> (MaterialSpec, Vec<MaterialSpec>) {
    let further = used.split_off(1);
    (used.remove(0), further)
}

/// `[materials.NAME]`, where `damping` holds unless it gives its own.
fn named(all: &At, name: &str, raw: &RawNamedMaterial, damping: [f64; 4]) -> Result<(MaterialSpec, GivenHardness)> {
    let at = all.key(name);
    let allowed = |c: char| c.is_alphanumeric() || "-_.+".contains(c);
    if name.is_empty() || !name.chars().all(allowed) || name == OneMaterial::UNNAMED {
        let help = format!(
            "use letters, digits, - and _; \"{}\" is what bodies without a material are said to be of",
            OneMaterial::UNNAMED
        );
        return Err(at.error(format!("{name:?} cannot name a material"), help));
    }
    let material = Material {
        density: at.required("density", &raw.density, Dimension::Density, Range::Positive)?,
        young: at.required("young", &raw.young, Dimension::Pressure, Range::Positive)?,
        poisson: at.required("poisson", &raw.poisson, Dimension::Ratio, Range::Poisson)?,
    };
    let mut bond =
        bond_of(&at, raw.law, raw.hardening.as_ref(), raw.rupture.as_ref(), raw.damping.as_ref(), &material)?;
    if raw.damping.is_none() {
        bond.damping = damping;
    }
    let given = GivenHardness::read(&at, &raw.hardness_factor, &raw.hardness_strain, &raw.limiting_pressure)?;
    let spec = MaterialSpec { name: Some(name.to_owned()), material, bond, limiting_pressure: None, hardness: None };
    Ok((spec, given))
}
