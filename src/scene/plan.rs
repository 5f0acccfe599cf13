//! `Plan`: what a scene needs, each component present or absent with its reason.

use super::spec::{
    BondLawSpec, BondSpec, ContactSpec, DriveSpec, GripKind, NormalSpec, OneMaterial, PathSpec, PlanMode, RuptureSpec,
    Shape, Spec, TangentialSpec,
};
use std::fmt;

/// Whether contacts are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactPlan {
    /// Never.
    Absent,
    /// From the first step.
    Present,
    /// From the first rupture on: a lone wire can only touch itself once it has snapped.
    AfterRupture,
}

/// One line of a plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// What it is.
    pub name: &'static str,
    /// Whether it runs, in a word or two.
    pub state: String,
    /// Why.
    pub reason: String,
}

/// What a run computes. The engine builds its stages from this and from nothing else.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Whether there are bonds.
    pub bonds: bool,
    /// Whether particles turn: spins, shear, bending, torsion.
    pub rotations: bool,
    /// Contacts.
    pub contacts: ContactPlan,
    /// Whether there are rigid bodies.
    pub rigid: bool,
    /// Whether bonds can break.
    pub rupture: bool,
    /// Whether each bond has its own rupture value.
    pub scatter: bool,
    /// Every component with its reason, for people.
    pub components: Vec<Component>,
}

impl Plan {
    /// Decides what `spec` needs.
    pub fn new(spec: &Spec) -> Self {
        let general = spec.plan == PlanMode::General;
        let wires = spec.strand.as_ref().map_or(0, |s| s.layers.iter().map(|l| l.wires).sum()) + spec.wires.len();
        let bodies = wires + spec.spheres.len();
        let bonds = wires > 0;
        let rupture = bonds && spec.breaks();
        let scatter = spec.ruptures().any(|r| r.weibull_modulus.is_finite());
        let contacts = contacts(spec, bodies, rupture, general);
        let rotations = rotations(spec, contacts.0, general);
        let mut components = vec![
            bond_component(spec, bonds),
            Component { name: "rotations", state: on(rotations.0), reason: rotations.1.clone() },
            plastic_component(spec, bonds),
            rupture_component(spec, rupture),
            Component {
                name: "scatter",
                state: on(scatter),
                reason: match spec.ruptures().next() {
                    Some(_) if scatter => of_each(spec, |one| {
                        let modulus = one.bond.rupture.as_ref().map_or(f64::INFINITY, |r| r.weibull_modulus);
                        if modulus.is_finite() { format!("Weibull modulus {modulus}") } else { "none".into() }
                    }),
                    Some(_) => "Weibull modulus is infinite: every bond has the stated rupture value".into(),
                    None => "bonds never break".into(),
                },
            },
            contact_component(spec, &contacts),
            tangential_component(spec, contacts.0),
            Component {
                name: "grips",
                state: on(spec.grip.is_some() || !spec.holds.is_empty()),
                reason: match &spec.grip {
                    Some(g) => match g.kind {
                        GripKind::All if spec.wires.is_empty() => "every wire is held at both ends".into(),
                        GripKind::All => "every wire is held where it reaches into a grip".into(),
                        GripKind::Jaw { pressure } => format!("outer layer clamped at {} MPa", pressure / 1e6),
                    },
                    None if spec.holds.is_empty() => "free bodies".into(),
                    None if spec.holds.len() == 1 => "a hold or load on a single body".into(),
                    None => format!("{} holds or loads on single bodies", spec.holds.len()),
                },
            },
            Component { name: "energy ledger", state: on(true), reason: "the tables ask for it".into() },
        ];
        let rigid = !spec.rigids.is_empty();
        if rigid {
            components.push(rigid_component(spec));
        }
        if spec.has_several_materials() {
            components.insert(0, material_component(spec));
        }
        Self { bonds, rotations: rotations.0, contacts: contacts.0, rigid, rupture, scatter, components }
    }
}

fn on(yes: bool) -> String {
    if yes { "runs" } else { "left out" }.into()
}

/// What holds of each material: once where it is the same of all, else with the name of each.
fn of_each(spec: &Spec, words: impl Fn(OneMaterial<'_>) -> String) -> String {
    let all: Vec<String> = spec.materials().map(&words).collect();
    if all.iter().all(|one| *one == all[0]) {
        return all[0].clone();
    }
    let named = spec.materials().zip(&all).map(|(one, words)| format!("{}: {words}", one.label()));
    named.collect::<Vec<_>>().join("; ")
}

/// Which bodies are of which material.
fn material_component(spec: &Spec) -> Component {
    let layers = spec.strand.iter().flat_map(|strand| &strand.layers);
    let of_layers = layers.map(|layer| (layer.material, format!("layer {}", layer.name)));
    let wires = spec.wires.iter().map(|wire| (wire.material, "single wires".to_owned()));
    let spheres = spec.spheres.iter().map(|sphere| (sphere.material, "spheres".to_owned()));
    let bodies: Vec<(usize, String)> = of_layers.chain(wires).chain(spheres).collect();
    let words = spec.materials().enumerate().map(|(number, one)| {
        let mut own: Vec<&str> = bodies.iter().filter(|(of, _)| *of == number).map(|(_, what)| what.as_str()).collect();
        own.dedup();
        format!("{}: {}", one.label(), own.join(", "))
    });
    let reason = words.collect::<Vec<_>>().join("; ");
    Component { name: "materials", state: spec.materials().len().to_string(), reason }
}

/// Which rigid bodies touch wires and spheres, and which of them move.
fn rigid_component(spec: &Spec) -> Component {
    let words = spec.rigids.iter().map(|rigid| {
        let moves = if rigid.motion.moves() { "moves" } else { "stands still" };
        format!("{} ({}) {moves}", rigid.name, rigid.shape.word())
    });
    let reason = words.collect::<Vec<_>>().join(", ");
    Component { name: "rigid bodies", state: on(true), reason }
}

fn is_plastic(bond: &BondSpec) -> bool {
    matches!(bond.law, BondLawSpec::ElastoPlastic(_))
}

fn bond_component(spec: &Spec, bonds: bool) -> Component {
    let law = of_each(spec, |one| if is_plastic(one.bond) { "elasto-plastic".into() } else { "elastic".into() });
    let reason = match (bonds, law.contains(':')) {
        (false, _) => "no wires".into(),
        (true, false) => format!("wires with the {law} law"),
        (true, true) => format!("wires with the law of their material; {law}"),
    };
    Component { name: "bonds", state: on(bonds), reason }
}

fn plastic_component(spec: &Spec, bonds: bool) -> Component {
    let plastic = bonds && spec.materials().any(|one| is_plastic(one.bond));
    let reason = if plastic {
        "bonds harden and thin"
    } else if bonds {
        "the elastic law has no history"
    } else {
        "no wires"
    };
    Component { name: "plastic state", state: on(plastic), reason: reason.into() }
}

fn rupture_component(spec: &Spec, rupture: bool) -> Component {
    let reason = match spec.ruptures().next() {
        Some(_) if rupture => of_each(spec, |one| one.bond.rupture.as_ref().map_or("never".into(), criterion)),
        Some(_) => "no wires".into(),
        None => "the scene states no rupture criterion".into(),
    };
    Component { name: "rupture", state: on(rupture), reason }
}

/// A strain (-) in per cent, without the rounding of the factor.
fn per_cent(strain: f64) -> f64 {
    (1e12 * strain).round() / 1e10
}

fn criterion(rupture: &RuptureSpec) -> String {
    use super::spec::RuptureCriterion as C;
    match rupture.criterion {
        C::PlasticStrain { strain } => format!("plastic-strain at {} %", per_cent(strain)),
        C::BeamStress { tensile, shear, .. } => {
            format!("beam-stress at {} MPa tension, {} MPa shear", tensile / 1e6, shear / 1e6)
        }
        C::FibreStrain { strain } => format!("fibre-strain at {} %", per_cent(strain)),
    }
}

fn contacts(spec: &Spec, bodies: usize, rupture: bool, general: bool) -> (ContactPlan, String) {
    let straight = spec.strand.is_none() && spec.wires.iter().all(|w| matches!(w.path, PathSpec::Straight { .. }))
        || spec.strand.as_ref().is_some_and(|s| s.layers.iter().all(|l| l.pitch.is_infinite()));
    if spec.contact.is_none() {
        (ContactPlan::Absent, "the scene has no contact law".into())
    } else if general {
        (ContactPlan::Present, "plan = \"general\"".into())
    } else if bodies > 1 {
        (ContactPlan::Present, format!("{bodies} bodies can touch"))
    } else if !straight || bends(spec) {
        (ContactPlan::Present, "a wire that is curved or bends can touch itself".into())
    } else if rupture {
        (ContactPlan::AfterRupture, "one straight wire; its pieces can touch once it has snapped".into())
    } else {
        let nothing = if spec.rigids.is_empty() { "nothing" } else { "nothing but rigid bodies" };
        (ContactPlan::Absent, format!("one straight body that never breaks touches {nothing}"))
    }
}

fn contact_component(spec: &Spec, contacts: &(ContactPlan, String)) -> Component {
    let state = match contacts.0 {
        ContactPlan::Absent => "left out",
        ContactPlan::Present => "runs",
        ContactPlan::AfterRupture => "from the first rupture on",
    };
    let law = spec.contact.as_ref().map(|c| {
        let shape = match c.shape {
            Shape::Sphere => "spheres",
            Shape::Wire => "smooth wires",
        };
        match c.normal {
            NormalSpec::Hertz => format!("; {shape}, hertz"),
            NormalSpec::Thornton { .. } => {
                let limits = of_each(spec, |one| format!("{:.4} MPa", one.limiting_pressure.unwrap_or_default() / 1e6));
                format!("; {shape}, thornton with limiting pressure {limits}")
            }
        }
    });
    Component { name: "contacts", state: state.into(), reason: format!("{}{}", contacts.1, law.unwrap_or_default()) }
}

fn tangential_component(spec: &Spec, contacts: ContactPlan) -> Component {
    let law = spec.contact.as_ref().and_then(|c| c.tangential);
    let none = contacts == ContactPlan::Absent && spec.rigids.is_empty();
    let rigids = spec.rigids.iter().any(|rigid| rigid.friction > 0.0);
    let even = |c: &ContactSpec| contacts == ContactPlan::Absent || c.is_smooth(spec.materials().len());
    let smooth = !rigids && spec.contact.as_ref().is_some_and(|c| c.tangential.is_some() && even(c));
    let runs = !none && law.is_some() && !smooth;
    let reason: String = match law {
        _ if none => "no contacts".into(),
        Some(_) if smooth => "the coefficient of friction is 0".into(),
        Some(TangentialSpec::Mindlin) => format!("mindlin{}", pairs(spec)),
        Some(TangentialSpec::MindlinDeresiewicz) => format!("mindlin-deresiewicz{}", pairs(spec)),
        None => "frictionless".into(),
    };
    Component { name: "friction", state: on(runs), reason }
}

/// The pairs of materials that have a coefficient of their own.
fn pairs(spec: &Spec) -> String {
    let pairs = spec.contact.iter().flat_map(|contact| &contact.pairs);
    let words = pairs.map(|pair| {
        let [a, b] = pair.materials.map(|number| spec.material_at(number).label().to_owned());
        format!("; {a} on {b}: coefficient {}", pair.friction)
    });
    words.collect()
}

/// Whether anything turns or pushes the bodies sideways.
fn bends(spec: &Spec) -> bool {
    let grip = spec.grip.as_ref().is_some_and(|g| {
        let pushes = match g.drive {
            DriveSpec::Speed(speed) => speed < 0.0,
            DriveSpec::Cyclic { .. } => true,
        };
        pushes || g.rotation_rate != 0.0 || g.free_rotation || matches!(g.kind, GripKind::Jaw { .. })
    });
    let wire = spec.wires.iter().any(|w| w.velocity.length() > 0.0 || w.spin.length() > 0.0);
    grip || wire || !spec.holds.is_empty() || touches_rigids(spec)
}

/// Whether there are wires beside rigid bodies.
fn touches_rigids(spec: &Spec) -> bool {
    !spec.rigids.is_empty() && (spec.strand.is_some() || !spec.wires.is_empty())
}

/// Whether there is a law of friction.
fn is_rubbed(spec: &Spec) -> bool {
    spec.contact.as_ref().is_some_and(|contact| contact.tangential.is_some())
}

fn rotations(spec: &Spec, contacts: ContactPlan, general: bool) -> (bool, String) {
    let along_z = |w: &super::spec::WireSpec| match &w.path {
        PathSpec::Straight { from, to } => from.x == to.x && from.y == to.y,
        PathSpec::File { .. } => false,
    };
    let straight = spec.wires.iter().all(along_z)
        && spec.strand.as_ref().is_none_or(|s| s.layers.iter().all(|l| l.pitch.is_infinite()));
    let spins = spec.spheres.iter().any(|s| s.spin.length() > 0.0);
    let friction = spec.contact.as_ref().is_some_and(|c| !c.is_smooth(spec.materials().len()));
    if general {
        (true, "plan = \"general\"".into())
    } else if !straight {
        (true, "wires are curved: they bend and twist".into())
    } else if touches_rigids(spec) {
        (true, "rigid bodies can bend and turn wires".into())
    } else if bends(spec) {
        (true, "holds, loads or drives can bend or turn the bodies".into())
    } else if spec.rigids.iter().any(|rigid| rigid.friction > 0.0) && is_rubbed(spec) {
        (true, "friction on rigid bodies can turn spheres".into())
    } else if contacts == ContactPlan::Present && (friction || spec.breaks() || !spec.wires.is_empty()) {
        (true, "contacts can turn particles".into())
    } else if spins {
        (true, "bodies spin".into())
    } else {
        (false, "straight bodies under axial load: nothing turns".into())
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for c in &self.components {
            writeln!(f, "  {:<14} {:<26} {}", c.name, c.state, c.reason)?;
        }
        Ok(())
    }
}
