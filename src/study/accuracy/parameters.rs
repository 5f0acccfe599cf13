//! Numerical parameters that trade error for time, one row each: [`PARAMETERS`]. A new one is a row there and a function
//! that makes its variation.

use crate::base::error::Result;
use crate::scene::Scene;
use crate::scene::plan::ContactPlan;
use crate::scene::spec::{AdaptiveSpec, ContactSpec, DriveSpec, GripSpec, Shape, Spec, TangentialSpec};
use crate::study::select;

/// A numerical parameter that can be varied.
#[derive(Debug)]
pub struct Parameter {
    /// What the user calls it.
    pub name: &'static str,
    /// The scene's key.
    pub key: &'static str,
    /// What it trades.
    pub trades: &'static str,
    /// Its values for a scene, or why it has none there.
    pub variation: fn(&Scene) -> Variations,
}

/// A variation, or why there is none.
pub type Variations = std::result::Result<Variation, String>;

/// The values of a parameter that a study tries, the scene's own apart.
#[derive(Debug, Clone)]
pub struct Variation {
    /// What the differences between them mean.
    pub role: Role,
    /// The scene's own value.
    pub base: Value,
    /// The others.
    pub levels: Vec<Level>,
}

/// What the differences that a parameter makes mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    /// An error that goes to zero with the value: the reference is extrapolated along it.
    Refines,
    /// An error everywhere but at one value, which the reference has.
    Exact(f64),
    /// An error: the result ought not to depend on it.
    Neutral,
    /// No error: another model of the same strand.
    Model,
}

impl Role {
    /// In a word or two.
    pub fn word(self) -> &'static str {
        match self {
            Role::Refines => "refines",
            Role::Exact(_) => "exact at one value",
            Role::Neutral => "should not matter",
            Role::Model => "change of model",
        }
    }
}

/// A value of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    /// As a number; `None` for words.
    pub number: Option<f64>,
    /// As people read it, with its unit.
    pub shown: String,
}

/// A value that is tried.
#[derive(Debug, Clone)]
pub struct Level {
    /// The value.
    pub value: Value,
    /// The scene with it.
    pub scene: Scene,
    /// Steps times particles over those of the scene as it stands, roughly (-).
    pub work: f64,
    /// Whether the run is written to disk as `strandsnap run` would, frames apart.
    pub writes: bool,
}

/// All parameters, in the order of tables. What takes part in the reference comes first.
pub const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "safety",
        key: "time.safety",
        trades: "time step over the stable one: accuracy in time against steps",
        variation: safety,
    },
    Parameter {
        name: "speed",
        key: "grip.speed",
        trades: "pull speed: inertia of the strand against simulated time",
        variation: speed,
    },
    Parameter {
        name: "adaptive",
        key: "grip.adaptive",
        trades: "faster pull between the closing of layers and the first rupture: simulated time against inertia",
        variation: adaptive,
    },
    Parameter {
        name: "resolution",
        key: "time.contact_resolution",
        trades: "how finely a contact is stepped at the least: course of impacts against steps",
        variation: resolution,
    },
    Parameter {
        name: "spacing",
        key: "spacing",
        trades: "particle spacing over wire diameter: resolution along the wire against particles and steps",
        variation: spacing,
    },
    Parameter {
        name: "shape",
        key: "contact.shape",
        trades: "spheres or smooth wires, also with fewer particles",
        variation: shape,
    },
    Parameter {
        name: "inertia",
        key: "time.inertia_scale",
        trades: "factor on rotational inertia: larger steps against sluggish rotation",
        variation: inertia,
    },
    Parameter {
        name: "mass",
        key: "time.mass_scale",
        trades: "factor on mass: larger steps against inertia of the strand",
        variation: mass,
    },
    Parameter {
        name: "bond-damping",
        key: "bond.damping",
        trades: "viscous damping in bonds: quiet waves against stress that is not there",
        variation: bond_damping,
    },
    Parameter {
        name: "contact-damping",
        key: "contact.damping",
        trades: "viscous damping in contacts: quiet contacts against stress that is not there",
        variation: contact_damping,
    },
    Parameter { name: "tangential", key: "contact.tangential", trades: "law of friction", variation: tangential },
    Parameter {
        name: "skin",
        key: "contact.skin",
        trades: "skin of the neighbour list: rare rebuilds against pairs looked at in vain",
        variation: skin,
    },
    Parameter {
        name: "recording",
        key: "output.samples, output.snapshots",
        trades: "rows of the curve, and snapshots written to disk: resolution of the answer against output",
        variation: recording,
    },
];

/// The parameters of these names, in the order of [`PARAMETERS`]; all of them when no name is given.
///
/// # Errors
/// A name that no parameter has; the nearest is suggested.
pub fn select(names: &[String]) -> Result<Vec<&'static Parameter>> {
    select::select(names, PARAMETERS, |parameter| parameter.name, "parameter", "strandsnap accuracy SCENE --list")
}

/// A number without the dust of binary arithmetic: 0.30000000000000004 is 0.3.
fn tidy(value: f64) -> f64 {
    format!("{value:.10e}").parse().expect("Rust reads what it writes")
}

/// A level that `change` makes of a scene; `shown` is its value as people read it.
fn level(scene: &Scene, shown: impl Into<String>, work: f64, change: impl FnOnce(&mut Spec)) -> Level {
    let scene = scene.clone().changed(change);
    Level { value: Value { number: None, shown: shown.into() }, scene, work, writes: false }
}

/// A level of a number in `unit` (SI; empty for none), which `set` gives to the scene.
fn number(scene: &Scene, value: f64, unit: &str, work: f64, set: impl FnOnce(&mut Spec, f64)) -> Level {
    let value = tidy(value);
    Level { value: base(value, unit), ..level(scene, "", work, |spec| set(spec, value)) }
}

fn base(value: f64, unit: &str) -> Value {
    let value = tidy(value);
    let shown = if unit.is_empty() { value.to_string() } else { format!("{value} {unit}") };
    Value { number: Some(value), shown }
}

fn word(shown: impl Into<String>) -> Value {
    Value { number: None, shown: shown.into() }
}

fn safety(scene: &Scene) -> Variations {
    let now = scene.spec.time.safety;
    if scene.spec.time.step.is_some() {
        return Err("the scene fixes its time step (time.step)".into());
    }
    let finer = [0.25, 0.5].map(|factor| now * factor);
    let coarser = (now < 1.0).then_some(1.0);
    let levels = finer.into_iter().chain(coarser);
    let levels = levels.map(|s| number(scene, s, "", now / s, |spec, s| spec.time.safety = s)).collect();
    Ok(Variation { role: Role::Refines, base: base(now, ""), levels })
}

/// The constant speed of the pull (m/s).
pub(super) fn pull_speed(spec: &Spec) -> Option<f64> {
    match spec.grip.as_ref()?.drive {
        DriveSpec::Speed(speed) if speed != 0.0 => Some(speed),
        _ => None,
    }
}

fn grip(spec: &mut Spec) -> &mut GripSpec {
    spec.grip.as_mut().expect("a scene that is pulled has a grip")
}

fn speed(scene: &Scene) -> Variations {
    let now = pull_speed(&scene.spec).ok_or("no grip pulls at a constant speed")?;
    // An adaptive pull begins no faster than its fastest.
    let adaptive = scene.spec.grip.as_ref().and_then(|grip| grip.adaptive.as_ref());
    let fastest = adaptive.map_or(f64::INFINITY, |adaptive| adaptive.fastest);
    let factors = [0.25, 0.5, 2.0, 4.0].into_iter().filter(|factor| now * factor <= fastest);
    let set = |spec: &mut Spec, speed| grip(spec).drive = DriveSpec::Speed(speed);
    let levels = factors.map(|f| number(scene, now * f, "m/s", 1.0 / f, set)).collect();
    Ok(Variation { role: Role::Refines, base: base(now, "m/s"), levels })
}

/// The pull speeds up over nine tenths of the way or so.
fn adaptive(scene: &Scene) -> Variations {
    let now = pull_speed(&scene.spec).filter(|now| *now > 0.0 && scene.plan.rupture);
    let now = now.ok_or("no grip pulls at a steady speed until something breaks")?;
    let own = scene.spec.grip.as_ref().and_then(|grip| grip.adaptive.clone());
    let fastest = own.as_ref().map_or(now, |own| own.fastest);
    let shown = |fastest: f64| format!("up to {} m/s", tidy(fastest));
    let levels = [2.0, 4.0].map(|factor| {
        let faster = tidy(factor * fastest);
        let usual = || AdaptiveSpec::new(ADAPTIVE_FROM, faster);
        let adaptive = own.clone().map_or_else(usual, |own| AdaptiveSpec { fastest: faster, ..own });
        level(scene, shown(faster), fastest / faster + 0.2, |spec| grip(spec).adaptive = Some(adaptive))
    });
    let base = own.map_or("constant".into(), |own| shown(own.fastest));
    Ok(Variation { role: Role::Neutral, base: word(base), levels: levels.into() })
}

/// Strain from which a pull may speed up where the scene's own does not (-).
const ADAPTIVE_FROM: f64 = 0.05;

fn resolution(scene: &Scene) -> Variations {
    touching(scene)?;
    if scene.spec.time.step.is_some() {
        return Err("the scene fixes its time step (time.step)".into());
    }
    let now = scene.spec.time.contact_resolution;
    let set = |spec: &mut Spec, value| spec.time.contact_resolution = value;
    let levels = [0.5, 2.0, 4.0].map(|f| number(scene, now * f, "", (1.0 / f).max(0.9), set)).to_vec();
    Ok(Variation { role: Role::Neutral, base: base(now, ""), levels })
}

/// Steps and particles both go with the inverse of the spacing.
fn spacing(scene: &Scene) -> Variations {
    let now = scene.spec.spacing;
    let shape = touching(scene).map(|contact| contact.shape);
    let bumpy = shape == Ok(Shape::Sphere);
    let factors: &[f64] = match shape {
        Ok(Shape::Sphere) => &[0.5, 0.75, 1.5],
        Ok(Shape::Wire) => &[0.5, 1.5, 2.0, 3.0],
        Err(_) => &[0.5, 2.0, 4.0],
    };
    // Spheres farther apart than this let a wire through, and the scene refuses them.
    let limit = if bumpy { 2.0 } else { f64::INFINITY };
    let values = factors.iter().map(|f| now * f).filter(|s| *s < limit);
    let levels = values.map(|s| number(scene, s, "", (now / s).powi(2), |spec, s| spec.spacing = s)).collect();
    let scatters = scene.spec.ruptures().any(|rupture| rupture.weibull_modulus.is_finite());
    let role = match (bumpy, scatters) {
        // A wire of spheres is as rough as its spacing.
        (true, _) => Role::Model,
        // Other bonds draw other strengths: the series converges only in the mean over many seeds.
        (false, true) => Role::Neutral,
        (false, false) => Role::Refines,
    };
    Ok(Variation { role, base: base(now, ""), levels })
}

fn shape(scene: &Scene) -> Variations {
    let own = touching(scene)?.shape;
    let with_spacing = |name: &str, shape: Shape, spacing: f64| {
        let work = (scene.spec.spacing / spacing).powi(2);
        level(scene, format!("{name}, spacing {spacing}"), work, |spec| {
            contact(spec).shape = shape;
            spec.spacing = spacing;
        })
    };
    let (now, levels) = match own {
        Shape::Sphere => {
            let other = level(scene, "wire", 1.0, |spec| contact(spec).shape = Shape::Wire);
            let coarse = [1.5, 2.0, 3.0].map(|spacing| with_spacing("wire", Shape::Wire, spacing));
            ("sphere", std::iter::once(other).chain(coarse).collect())
        }
        // Coarse smooth wires in a scene of smooth wires belong to its spacing.
        Shape::Wire => ("wire", vec![with_spacing("sphere", Shape::Sphere, 1.0)]),
    };
    Ok(Variation { role: Role::Model, base: word(now), levels })
}

fn inertia(scene: &Scene) -> Variations {
    if !scene.plan.rotations {
        return Err("nothing turns in this scene".into());
    }
    let now = scene.spec.time.inertia_scale;
    let values = [1.0, 4.0, 16.0, 64.0].into_iter().filter(|v| *v != now);
    // Where bending or torsion limits the step, a factor makes it longer; how much is not known beforehand.
    let work = |value: f64| if value < now { 1.5 } else { 1.0 };
    let levels = values.map(|v| number(scene, v, "", work(v), |spec, v| spec.time.inertia_scale = v)).collect();
    Ok(Variation { role: Role::Exact(1.0), base: base(now, ""), levels })
}

fn mass(scene: &Scene) -> Variations {
    let now = scene.spec.time.mass_scale;
    let values = [1.0, 4.0, 16.0].into_iter().filter(|v| *v != now);
    let levels = values.map(|v| number(scene, v, "", (now / v).sqrt(), |spec, v| spec.time.mass_scale = v)).collect();
    Ok(Variation { role: Role::Exact(1.0), base: base(now, ""), levels })
}

fn bond_damping(scene: &Scene) -> Variations {
    if !scene.plan.bonds {
        return Err("there are no bonds".into());
    }
    let now = scene.spec.bond.damping[0];
    if scene.spec.materials().all(|one| one.bond.damping == [now; 4]) {
        let set = |spec: &mut Spec, value| spec.bonds_mut().for_each(|bond| bond.damping = [value; 4]);
        let levels = around(now, 0.02).into_iter().map(|v| number(scene, v, "", 1.0, set)).collect();
        return Ok(Variation { role: Role::Neutral, base: base(now, ""), levels });
    }
    let scaled = |factor: f64| {
        let value = Value { number: Some(factor), shown: format!("all × {factor}") };
        let scale = |spec: &mut Spec| {
            spec.bonds_mut().for_each(|bond| bond.damping = bond.damping.map(|mode| tidy(mode * factor)));
        };
        Level { value, ..level(scene, "", 1.0, scale) }
    };
    let levels = [0.0, 0.5, 2.0, 5.0].map(scaled).to_vec();
    Ok(Variation { role: Role::Neutral, base: Value { number: Some(1.0), shown: "by mode".into() }, levels })
}

/// None, half, twice and five times a value; the usual one and five times it where there is none.
fn around(now: f64, usual: f64) -> Vec<f64> {
    if now == 0.0 { vec![usual, 5.0 * usual] } else { [0.0, 0.5, 2.0, 5.0].map(|factor| now * factor).to_vec() }
}

fn contact_damping(scene: &Scene) -> Variations {
    let now = touching(scene)?.damping;
    let set = |spec: &mut Spec, value| {
        let contact = contact(spec);
        (contact.damping, contact.restitution) = (value, None);
    };
    let levels = around(now, 0.1).into_iter().map(|v| number(scene, v, "", 1.0, set)).collect();
    Ok(Variation { role: Role::Neutral, base: base(now, ""), levels })
}

fn tangential(scene: &Scene) -> Variations {
    let now = touching(scene)?.tangential;
    let laws = [
        ("mindlin", Some(TangentialSpec::Mindlin)),
        ("mindlin-deresiewicz", Some(TangentialSpec::MindlinDeresiewicz)),
        ("none", None),
    ];
    let (own, others): (Vec<_>, Vec<_>) = laws.into_iter().partition(|(_, law)| *law == now);
    let levels =
        others.into_iter().map(|(name, law)| level(scene, name, 1.0, |spec| contact(spec).tangential = law)).collect();
    Ok(Variation { role: Role::Model, base: word(own[0].0), levels })
}

fn skin(scene: &Scene) -> Variations {
    let now = touching(scene)?.skin;
    let set = |spec: &mut Spec, value| contact(spec).skin = value;
    let levels = [0.25, 0.5, 2.0, 4.0].map(|factor| number(scene, now * factor, "", 1.0, set)).to_vec();
    Ok(Variation { role: Role::Neutral, base: base(now, ""), levels })
}

fn recording(scene: &Scene) -> Variations {
    let (rows, snapshots) = (scene.spec.output.samples, scene.spec.output.snapshots);
    let sampled = |rows: usize| level(scene, format!("{rows} rows"), 1.0, |spec| spec.output.samples = rows);
    let written = |snapshots: usize| Level {
        writes: true,
        ..level(scene, format!("{snapshots} snapshots written"), 1.1, |spec| spec.output.snapshots = snapshots)
    };
    let levels =
        vec![sampled((rows / 8).max(2)), sampled(4 * rows), written(snapshots.max(1)), written(4 * snapshots.max(1))];
    Ok(Variation { role: Role::Neutral, base: word(format!("{rows} rows")), levels })
}

const NO_CONTACTS: &str = "nothing touches in this scene";

/// The contacts of a scene in which something touches before the first rupture.
fn touching(scene: &Scene) -> std::result::Result<&ContactSpec, &'static str> {
    let present = scene.plan.contacts == ContactPlan::Present;
    scene.spec.contact.as_ref().filter(|_| present).ok_or(NO_CONTACTS)
}

fn contact(spec: &mut Spec) -> &mut ContactSpec {
    spec.contact.as_mut().expect("something touches in this scene")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::error::Error;
    use crate::scene;

    fn load(name: &str, options: &[&str]) -> Scene {
        let options: Vec<String> = options.iter().map(|text| text.to_string()).collect();
        scene::load(name, &options).unwrap()
    }

    /// Every level of every parameter is a scene that can be written and read, and another one than the scene itself.
    #[test]
    fn every_level_is_a_scene_of_its_own() {
        for (name, options) in [
            ("ka4", &[][..]),
            ("strand-1x7", &["contact.shape=wire", "time.inertia_scale=4", "bond.rupture.weibull_modulus=inf"]),
            ("single-wire", &["bond.damping={ axial = 0.1, bending = 0.05 }"]),
            ("single-wire", &["bond.damping=0"]),
        ] {
            let base = load(name, options);
            for parameter in PARAMETERS {
                for level in (parameter.variation)(&base).map(|variation| variation.levels).unwrap_or_default() {
                    let text = crate::scene::write::to_toml(&level.scene.spec);
                    let read = scene::parse(&text, "level.toml", std::path::Path::new("."), &[]);
                    let place = format!("{name} {} {}", parameter.name, level.value.shown);
                    assert_eq!(read.unwrap_or_else(|e| panic!("{place}: {e}")).spec, level.scene.spec, "{place}");
                    assert!(level.scene.spec != base.spec || level.writes, "{place}");
                    assert!(level.work > 0.0);
                }
            }
        }
    }

    #[test]
    fn variations_follow_the_scene() {
        let shown = |variation: Variations| -> Vec<String> {
            variation.unwrap().levels.into_iter().map(|level| level.value.shown).collect()
        };
        assert_eq!(shown(safety(&load("ka4", &[]))), ["0.2", "0.4", "1"]);
        assert_eq!(shown(speed(&load("ka4", &["grip.adaptive.fastest=6 m/s"]))), ["0.625 m/s", "1.25 m/s", "5 m/s"]);
        let slow = &speed(&load("single-wire", &[])).unwrap().levels[0].scene;
        assert_eq!(pull_speed(&slow.spec), Some(1.25));
        assert!(speed(&load("cantilever", &[])).is_err());
        assert_eq!(skin(&load("single-wire", &[])).unwrap_err(), NO_CONTACTS);
        assert!(inertia(&load("single-wire", &[])).is_err());
    }

    /// A rougher wire is another wire; a wire of fewer bonds with drawn strengths is another sample.
    #[test]
    fn spacing_means_what_the_scene_makes_it_mean() {
        let role = |name: &str, options: &[&str]| spacing(&load(name, options)).unwrap().role;
        assert_eq!(role("ka4", &[]), Role::Model);
        assert_eq!(role("ka4", &["contact.shape=wire"]), Role::Neutral);
        let even = "bond.rupture.weibull_modulus=inf";
        assert_eq!(role("ka4", &["contact.shape=wire", even]), Role::Refines);
    }

    #[test]
    fn an_unknown_parameter_is_refused_and_the_nearest_named() {
        let error = select(&["saftey".to_string()]).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let Error::Input { help: Some(help), .. } = error else { panic!() };
        assert!(help.contains("did you mean `safety`?"), "{help}");
        assert_eq!(select(&[]).unwrap().len(), PARAMETERS.len());
    }
}
