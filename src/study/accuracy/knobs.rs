//! What trades error for time, one row each: [`KNOBS`]. A new one is a row there and a function that makes its ladder.

use crate::base::error::Result;
use crate::scene::plan::{ContactPlan, Plan};
use crate::scene::spec::{AdaptiveSpec, ContactSpec, DriveSpec, Shape, Spec, TangentialSpec};
use crate::study::select;

/// Something that can be turned.
#[derive(Debug)]
pub struct Knob {
    /// What the user calls it.
    pub name: &'static str,
    /// The scene's key.
    pub key: &'static str,
    /// What it trades.
    pub trades: &'static str,
    /// Its ladder of values for a scene, or why it has none there.
    pub ladder: fn(&Spec) -> Ladders,
}

/// A ladder, or why there is none.
pub type Ladders = std::result::Result<Ladder, String>;

/// The values of a knob that a study tries, the scene's own apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Ladder {
    /// What its differences mean.
    pub role: Role,
    /// The scene's own value.
    pub base: Value,
    /// The others.
    pub levels: Vec<Level>,
}

/// What the differences that a knob makes mean.
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

/// A value of a knob.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    /// As a number; `None` for words.
    pub number: Option<f64>,
    /// As people read it, with its unit.
    pub shown: String,
}

/// A value that is tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// The value.
    pub value: Value,
    /// The `--set` options that make it.
    pub set: Vec<String>,
    /// Steps times particles over those of the scene as it stands, roughly (-).
    pub work: f64,
    /// Whether the run is written to disk as `strandsnap run` would, frames apart.
    pub writes: bool,
}

/// All knobs, in the order of tables. What takes part in the reference comes first.
pub const KNOBS: &[Knob] = &[
    Knob {
        name: "safety",
        key: "time.safety",
        trades: "time step over the stable one: accuracy in time against steps",
        ladder: safety,
    },
    Knob {
        name: "speed",
        key: "grip.speed",
        trades: "pull speed: inertia of the strand against simulated time",
        ladder: speed,
    },
    Knob {
        name: "adaptive",
        key: "grip.adaptive",
        trades: "faster pull between the closing of layers and the first rupture: simulated time against inertia",
        ladder: adaptive,
    },
    Knob {
        name: "resolution",
        key: "time.contact_resolution",
        trades: "how finely a contact is stepped at the least: course of impacts against steps",
        ladder: resolution,
    },
    Knob {
        name: "spacing",
        key: "spacing",
        trades: "particle spacing over wire diameter: resolution along the wire against particles and steps",
        ladder: spacing,
    },
    Knob {
        name: "shape",
        key: "contact.shape",
        trades: "spheres or smooth wires, also with fewer particles",
        ladder: shape,
    },
    Knob {
        name: "inertia",
        key: "time.inertia_scale",
        trades: "factor on rotational inertia: larger steps against sluggish rotation",
        ladder: inertia,
    },
    Knob {
        name: "mass",
        key: "time.mass_scale",
        trades: "factor on mass: larger steps against inertia of the strand",
        ladder: mass,
    },
    Knob {
        name: "bond-damping",
        key: "bond.damping",
        trades: "viscous damping in bonds: quiet waves against stress that is not there",
        ladder: bond_damping,
    },
    Knob {
        name: "contact-damping",
        key: "contact.damping",
        trades: "viscous damping in contacts: quiet contacts against stress that is not there",
        ladder: contact_damping,
    },
    Knob { name: "tangential", key: "contact.tangential", trades: "law of friction", ladder: tangential },
    Knob {
        name: "skin",
        key: "contact.skin",
        trades: "skin of the neighbour list: rare rebuilds against pairs looked at in vain",
        ladder: skin,
    },
    Knob {
        name: "recording",
        key: "output.samples, output.snapshots",
        trades: "rows of the curve, and snapshots written to disk: resolution of the answer against output",
        ladder: recording,
    },
];

/// The knobs of these names, in the order of [`KNOBS`]; all of them when no name is given.
///
/// # Errors
/// A name that no knob has; the nearest is suggested.
pub fn select(names: &[String]) -> Result<Vec<&'static Knob>> {
    select::select(names, KNOBS, |knob| knob.name, "knob", "strandsnap accuracy SCENE --list")
}

/// A number without the dust of binary arithmetic: 0.30000000000000004 is 0.3.
fn tidy(value: f64) -> f64 {
    format!("{value:.10e}").parse().expect("Rust reads what it writes")
}

/// A level `key=value` with a number and a unit, empty for none.
fn level(key: &str, value: f64, unit: &str, work: f64) -> Level {
    let value = tidy(value);
    let shown = number_with(value, unit);
    Level { set: vec![format!("{key}={shown}")], value: Value { number: Some(value), shown }, work, writes: false }
}

fn number_with(value: f64, unit: &str) -> String {
    if unit.is_empty() { value.to_string() } else { format!("{value} {unit}") }
}

fn base(value: f64, unit: &str) -> Value {
    Value { number: Some(tidy(value)), shown: number_with(tidy(value), unit) }
}

fn word(key: &str, value: &str, work: f64) -> Level {
    let shown = value.to_string();
    Level { set: vec![format!("{key}={value}")], value: Value { number: None, shown }, work, writes: false }
}

fn safety(spec: &Spec) -> Ladders {
    if spec.time.step.is_some() {
        return Err("the scene fixes its time step (time.step)".into());
    }
    let now = spec.time.safety;
    let finer = [0.25, 0.5].map(|factor| now * factor);
    let coarser = (now < 1.0).then_some(1.0);
    let levels = finer.into_iter().chain(coarser).map(|s| level("time.safety", s, "", now / s)).collect();
    Ok(Ladder { role: Role::Refines, base: base(now, ""), levels })
}

fn speed(spec: &Spec) -> Ladders {
    match spec.grip.as_ref().map(|grip| grip.drive) {
        Some(DriveSpec::Speed(now)) if now != 0.0 => {
            let factors = [0.25, 0.5, 2.0, 4.0];
            let levels = factors.map(|f| level("grip.speed", now * f, "m/s", 1.0 / f)).to_vec();
            Ok(Ladder { role: Role::Refines, base: base(now, "m/s"), levels })
        }
        _ => Err("no grip pulls at a constant speed".into()),
    }
}

/// The pull speeds up over nine tenths of the way or so.
fn adaptive(spec: &Spec) -> Ladders {
    let grip = spec.grip.as_ref().filter(|_| Plan::new(spec).rupture);
    let Some((now, grip)) = grip.and_then(|grip| match grip.drive {
        DriveSpec::Speed(now) if now > 0.0 => Some((now, grip)),
        _ => None,
    }) else {
        return Err("no grip pulls at a steady speed until something breaks".into());
    };
    let keys = |fastest: f64| {
        let with = |a: &AdaptiveSpec| {
            let (from, kinetic) = (number_with(tidy(100.0 * a.from), "%"), tidy(a.kinetic));
            format!("from = \"{from}\", kinetic = {kinetic}, passages = {}, ", tidy(a.passages))
        };
        let others = grip.adaptive.as_ref().map_or("from = \"5 %\", ".into(), with);
        format!("grip.adaptive={{ {others}fastest = \"{} m/s\" }}", tidy(fastest))
    };
    let own = grip.adaptive.as_ref().map_or(now, |a| a.fastest);
    let levels = [2.0, 4.0].map(|factor| factor * own).into_iter().map(|fastest| Level {
        value: Value { number: None, shown: format!("up to {} m/s", tidy(fastest)) },
        set: vec![keys(fastest)],
        work: own / fastest + 0.2,
        writes: false,
    });
    let base = grip.adaptive.as_ref().map_or("constant".into(), |a| format!("up to {} m/s", tidy(a.fastest)));
    Ok(Ladder { role: Role::Neutral, base: Value { number: None, shown: base }, levels: levels.collect() })
}

fn resolution(spec: &Spec) -> Ladders {
    touching(spec).ok_or(NO_CONTACTS)?;
    if spec.time.step.is_some() {
        return Err("the scene fixes its time step (time.step)".into());
    }
    let now = spec.time.contact_resolution;
    let levels = [0.5, 2.0, 4.0].map(|f| level("time.contact_resolution", now * f, "", (1.0 / f).max(0.9))).to_vec();
    Ok(Ladder { role: Role::Neutral, base: base(now, ""), levels })
}

/// Steps and particles both go with the inverse of the spacing.
fn spacing(spec: &Spec) -> Ladders {
    let now = spec.spacing;
    let bumpy = touching(spec).is_some_and(|contact| contact.shape == Shape::Sphere);
    let factors: &[f64] = match (bumpy, touching(spec)) {
        (true, _) => &[0.5, 0.75, 1.5],
        (_, Some(_)) => &[0.5, 1.5, 2.0, 3.0],
        _ => &[0.5, 2.0, 4.0],
    };
    // Spheres farther apart than this let a wire through, and the scene refuses them.
    let limit = if bumpy { 2.0 } else { f64::INFINITY };
    let values = factors.iter().map(|f| now * f).filter(|s| *s < limit);
    let levels = values.map(|s| level("spacing", s, "", (now / s).powi(2))).collect();
    let scatters = spec.bond.rupture.as_ref().is_some_and(|rupture| rupture.weibull_modulus.is_finite());
    let role = match (bumpy, scatters) {
        // A wire of spheres is as rough as its spacing.
        (true, _) => Role::Model,
        // Other bonds draw other strengths: the series converges only in the mean over many seeds.
        (false, true) => Role::Neutral,
        (false, false) => Role::Refines,
    };
    Ok(Ladder { role, base: base(now, ""), levels })
}

fn shape(spec: &Spec) -> Ladders {
    let contact = touching(spec).ok_or(NO_CONTACTS)?;
    let with_spacing = |shape: &str, spacing: f64| {
        let mut level = word("contact.shape", shape, (spec.spacing / spacing).powi(2));
        level.set.push(format!("spacing={spacing}"));
        level.value.shown = format!("{shape}, spacing {spacing}");
        level
    };
    let coarse = [1.5, 2.0, 3.0].into_iter().map(|spacing| with_spacing("wire", spacing));
    let (now, other) = match contact.shape {
        Shape::Sphere => ("sphere", word("contact.shape", "wire", 1.0)),
        Shape::Wire => ("wire", with_spacing("sphere", 1.0)),
    };
    // Coarse smooth wires in a scene of smooth wires belong to its spacing.
    let levels = match contact.shape {
        Shape::Sphere => std::iter::once(other).chain(coarse).collect(),
        Shape::Wire => vec![other],
    };
    Ok(Ladder { role: Role::Model, base: Value { number: None, shown: now.into() }, levels })
}

fn inertia(spec: &Spec) -> Ladders {
    if !Plan::new(spec).rotations {
        return Err("nothing turns in this scene".into());
    }
    let now = spec.time.inertia_scale;
    let values = [1.0, 4.0, 16.0, 64.0].into_iter().filter(|v| *v != now);
    // Where bending or torsion limits the step, a factor makes it longer; how much is not known beforehand.
    let levels = values.map(|v| level("time.inertia_scale", v, "", if v < now { 1.5 } else { 1.0 })).collect();
    Ok(Ladder { role: Role::Exact(1.0), base: base(now, ""), levels })
}

fn mass(spec: &Spec) -> Ladders {
    let now = spec.time.mass_scale;
    let values = [1.0, 4.0, 16.0].into_iter().filter(|v| *v != now);
    let levels = values.map(|v| level("time.mass_scale", v, "", (now / v).sqrt())).collect();
    Ok(Ladder { role: Role::Exact(1.0), base: base(now, ""), levels })
}

fn bond_damping(spec: &Spec) -> Ladders {
    if !Plan::new(spec).bonds {
        return Err("there are no bonds".into());
    }
    let [axial, shear, bending, torsion] = spec.bond.damping;
    let now = axial;
    if [shear, bending, torsion].iter().all(|mode| *mode == axial) {
        let values = around(now, 0.02);
        let levels = values.into_iter().map(|v| level("bond.damping", v, "", 1.0)).collect();
        return Ok(Ladder { role: Role::Neutral, base: base(now, ""), levels });
    }
    let scaled = |factor: f64| {
        let [a, s, b, t] = spec.bond.damping.map(|mode| tidy(mode * factor));
        let set = format!("bond.damping={{ axial = {a}, shear = {s}, bending = {b}, torsion = {t} }}");
        let value = Value { number: Some(factor), shown: format!("all × {factor}") };
        Level { value, set: vec![set], work: 1.0, writes: false }
    };
    let levels = [0.0, 0.5, 2.0, 5.0].map(scaled).to_vec();
    Ok(Ladder { role: Role::Neutral, base: Value { number: Some(1.0), shown: "by mode".into() }, levels })
}

/// None, half, twice and five times a value; the usual one and five times it where there is none.
fn around(now: f64, usual: f64) -> Vec<f64> {
    if now == 0.0 { vec![usual, 5.0 * usual] } else { [0.0, 0.5, 2.0, 5.0].map(|factor| now * factor).to_vec() }
}

fn contact_damping(spec: &Spec) -> Ladders {
    let now = touching(spec).ok_or(NO_CONTACTS)?.damping;
    let levels = around(now, 0.1).into_iter().map(|v| level("contact.damping", v, "", 1.0)).collect();
    Ok(Ladder { role: Role::Neutral, base: base(now, ""), levels })
}

fn tangential(spec: &Spec) -> Ladders {
    let contact = touching(spec).ok_or(NO_CONTACTS)?;
    let now = match contact.tangential {
        Some(TangentialSpec::Mindlin) => "mindlin",
        Some(TangentialSpec::MindlinDeresiewicz) => "mindlin-deresiewicz",
        None => "none",
    };
    let others = ["mindlin", "mindlin-deresiewicz", "none"].into_iter().filter(|law| *law != now);
    let levels = others.map(|law| word("contact.tangential", law, 1.0)).collect();
    Ok(Ladder { role: Role::Model, base: Value { number: None, shown: now.into() }, levels })
}

fn skin(spec: &Spec) -> Ladders {
    let now = touching(spec).ok_or(NO_CONTACTS)?.skin;
    let levels = [0.25, 0.5, 2.0, 4.0].map(|factor| level("contact.skin", now * factor, "", 1.0)).to_vec();
    Ok(Ladder { role: Role::Neutral, base: base(now, ""), levels })
}

fn recording(spec: &Spec) -> Ladders {
    let (rows, snapshots) = (spec.output.samples, spec.output.snapshots);
    let rows_level = |rows: usize| {
        let mut level = word("output.samples", &rows.to_string(), 1.0);
        level.value.shown = format!("{rows} rows");
        level
    };
    let written = |snapshots: usize| {
        let mut level = word("output.snapshots", &snapshots.to_string(), 1.1);
        level.value.shown = format!("{snapshots} snapshots written");
        level.writes = true;
        level
    };
    let levels = vec![
        rows_level((rows / 8).max(2)),
        rows_level(4 * rows),
        written(snapshots.max(1)),
        written(4 * snapshots.max(1)),
    ];
    Ok(Ladder { role: Role::Neutral, base: Value { number: None, shown: format!("{rows} rows") }, levels })
}

const NO_CONTACTS: &str = "nothing touches in this scene";

/// The contacts of a scene in which something touches before the first rupture.
fn touching(spec: &Spec) -> Option<&ContactSpec> {
    spec.contact.as_ref().filter(|_| Plan::new(spec).contacts == ContactPlan::Present)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::error::Error;
    use crate::scene;

    fn spec(name: &str, options: &[&str]) -> Spec {
        let options: Vec<String> = options.iter().map(|text| text.to_string()).collect();
        scene::load(name, &options).unwrap().spec
    }

    /// Every level of every knob is a scene that loads, and another one than the scene itself.
    #[test]
    fn every_level_is_a_scene_of_its_own() {
        for (name, options) in [
            ("ka4", &[][..]),
            ("strand-1x7", &["contact.shape=wire", "time.inertia_scale=4", "bond.rupture.weibull_modulus=inf"]),
            ("single-wire", &["bond.damping={ axial = 0.1, bending = 0.05 }"]),
            ("single-wire", &["bond.damping=0"]),
        ] {
            let base = spec(name, options);
            for knob in KNOBS {
                for level in (knob.ladder)(&base).map(|ladder| ladder.levels).unwrap_or_default() {
                    let all: Vec<&str> = options.iter().copied().chain(level.set.iter().map(String::as_str)).collect();
                    let changed = spec(name, &all);
                    assert!(changed != base || level.writes, "{name} {} {level:?}", knob.name);
                    assert!(level.work > 0.0);
                }
            }
        }
    }

    #[test]
    fn ladders_follow_the_scene() {
        let ladder = safety(&spec("ka4", &[])).unwrap();
        let shown: Vec<&str> = ladder.levels.iter().map(|level| level.value.shown.as_str()).collect();
        assert_eq!(shown, ["0.2", "0.4", "1"]);
        assert_eq!(speed(&spec("single-wire", &[])).unwrap().levels[0].set, ["grip.speed=1.25 m/s"]);
        assert!(speed(&spec("cantilever", &[])).is_err());
        assert_eq!(skin(&spec("single-wire", &[])).unwrap_err(), NO_CONTACTS);
        assert!(inertia(&spec("single-wire", &[])).is_err());
    }

    /// A rougher wire is another wire; a wire of fewer bonds with drawn strengths is another sample.
    #[test]
    fn spacing_means_what_the_scene_makes_it_mean() {
        let role = |name: &str, options: &[&str]| spacing(&spec(name, options)).unwrap().role;
        assert_eq!(role("ka4", &[]), Role::Model);
        assert_eq!(role("ka4", &["contact.shape=wire"]), Role::Neutral);
        let even = "bond.rupture.weibull_modulus=inf";
        assert_eq!(role("ka4", &["contact.shape=wire", even]), Role::Refines);
    }

    #[test]
    fn an_unknown_knob_is_refused_and_the_nearest_named() {
        let error = select(&["saftey".to_string()]).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let Error::Input { help: Some(help), .. } = error else { panic!() };
        assert!(help.contains("did you mean `safety`?"), "{help}");
        assert_eq!(select(&[]).unwrap().len(), KNOBS.len());
    }
}
