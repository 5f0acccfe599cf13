//! A study as it was read: base scene, axes, points and cases.

use super::axis::{self, Axis, MOST_CASES, Merged};
use super::changes::Changes;
use super::conflicts;
use super::quantity::{self, Quantity};
use super::raw::{RawDesign, RawSeeds, RawStudy};
use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::base::wording::counted;
use crate::reference::published::{self, Published};
use crate::scene::quality::Quality;
use crate::scene::spec::Spec;
use crate::scene::suggest::nearest;
use crate::scene::{self, Scene, SceneSource};
use crate::study::runner::{CaseStore, Identity};
use crate::study::screening::{self, Model};
use crate::study::tensile::{TensileCase, definition};
use std::collections::HashMap;
use std::path::Path;

macro_rules! studies {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../../assets/studies/", $name, ".toml")))),*]
    };
}

/// Name and TOML text of the studies that come with the program.
pub const STUDIES: &[(&str, &str)] = studies![
    "pitch",
    "diameter",
    "seeds",
    "mechanism",
    "pitch-modulus-12",
    "diameter-modulus-12",
    "pitch-flat-hardening",
    "diameter-flat-hardening",
];

/// What results are compared with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct References {
    /// Published tests and simulations.
    pub published: &'static Published,
    /// Whether strand theory, calibrated on the published experiment, is compared with too.
    pub theory: bool,
}

/// How a study names strand theory in `compare`.
const STRAND_THEORY: &str = "strand-theory";

/// A study that was read.
pub struct Definition {
    /// Its name.
    pub name: String,
    /// What it asks.
    pub about: String,
    /// The base scene by name or path.
    pub base: String,
    /// What it varies.
    pub axes: Vec<Axis>,
    /// Values of axes that say the same as another.
    pub merged: Vec<Merged>,
    /// Chosen points: the level of every axis.
    pub points: Vec<Vec<usize>>,
    /// The model of effects that the points were picked for, when the study has a design.
    pub model: Option<Model>,
    /// How well the design tells the model's terms apart, over the full grid (-).
    pub efficiency: Option<f64>,
    /// Seeds; a point whose scene has no scatter is run with the first only, since the others give the same run.
    pub seeds: Vec<u64>,
    /// Accuracy against run time.
    pub quality: Quality,
    /// What is gathered.
    pub quantities: Vec<&'static Quantity>,
    /// What curves are fitted to.
    pub fits: Vec<&'static Quantity>,
    /// What results are compared with.
    pub compare: Option<References>,
    /// The scene of every point, with its own seed; or why it is refused.
    pub scenes: Vec<std::result::Result<Scene, String>>,
    /// Options of every case, before those of its point.
    common: Vec<String>,
}

impl Definition {
    /// Reads a study by built-in name or by path.
    ///
    /// # Errors
    /// An unknown name; a file that cannot be read; anything wrong in the study or in its base scene.
    pub fn load(name_or_path: &str, changes: &Changes) -> Result<Self> {
        let path = Path::new(name_or_path);
        let is_path = name_or_path.ends_with(".toml") || name_or_path.contains(std::path::is_separator);
        if !is_path {
            let text = builtin(name_or_path)?;
            return Self::parse(text, &format!("{name_or_path}.toml"), Path::new("."), changes);
        }
        let text = regular::text_if_there(path, regular::LONGEST_SCENE)?.ok_or_else(|| {
            Error::input(format!("there is no study file {}", path.display()), "give its path, or a built-in name")
        })?;
        Self::parse(&text, name_or_path, path.parent().unwrap_or(Path::new(".")), changes)
    }

    /// Reads a study from its text. `file_name` is shown in errors, and its stem names the study; a base scene that is a
    /// path is taken from `folder`.
    ///
    /// # Errors
    /// Anything wrong in the study or in its base scene.
    pub fn parse(text: &str, file_name: &str, folder: &Path, changes: &Changes) -> Result<Self> {
        let (raw, source): (RawStudy, SceneSource) = scene::read(text, file_name, "a study")?;
        let missing = |key: &str, help: &str| source.error("", format!("`{key}` is missing"), help);
        let about = raw.about.clone().ok_or_else(|| missing("about", "say in a sentence what the study asks"))?;
        let base = raw.base.as_ref().ok_or_else(|| missing("base", "add it, for example base = \"ka4\""))?;
        let base = base_scene(base, folder);
        let (axes, merged) = axis::axes(&raw.axis, &source)?;
        conflicts::check(&axes, &raw, changes, &source)?;
        let quality = changes.quality.or(raw.quality).unwrap_or_default();
        let own = scene::load(&base, &[])?;
        let seeds = match changes.seeds.is_empty() {
            true => seeds(raw.seeds.as_ref(), own.spec.seed, &source)?,
            false => changes.seeds.clone(),
        };
        let common: Vec<String> = raw.set.into_iter().chain(changes.set.iter().cloned()).collect();
        let design = raw.design.as_ref();
        let model = design.map(|design| model(&design.interactions, &axes, &source)).transpose()?;
        let points = points(&axes, model.as_ref(), raw.design.as_ref(), &source)?;
        if points.len() * seeds.len() > MOST_CASES {
            let what = format!(
                "{} and {} are more than {MOST_CASES} cases",
                counted(points.len(), "point"),
                counted(seeds.len(), "seed")
            );
            return Err(source.error("axis", what, "vary less, or pick points with [design]"));
        }
        let stem = Path::new(file_name).file_stem().map_or_else(|| "study".into(), |stem| stem.to_string_lossy());
        let mut definition = Self {
            name: stem.into_owned(),
            about,
            base,
            efficiency: model.as_ref().map(|model| screening::efficiency(model, &points)),
            quantities: match &raw.quantities {
                None => quantity::ALL.iter().collect(),
                Some(names) => quantities(names, "quantities", &source)?,
            },
            fits: fits(&raw.fits, &axes, &source)?,
            compare: references(&raw.compare, &source)?,
            axes,
            merged,
            points,
            model,
            seeds,
            quality,
            scenes: Vec::new(),
            common,
        };
        definition.resolve()?;
        definition.compare_points(&source)?;
        Ok(definition)
    }

    /// Resolves the scene of every point.
    ///
    /// # Errors
    /// The first refusal, when every point is refused; what the file system refuses.
    fn resolve(&mut self) -> Result<()> {
        let mut first = None;
        for point in 0..self.points.len() {
            let loaded = scene::load(&self.base, &self.overrides(point)).and_then(|mut scene| {
                self.quality.apply(&mut scene)?;
                Ok(scene)
            });
            let scene = match loaded {
                Ok(scene) => Ok(scene),
                Err(error @ (Error::Scene(_) | Error::Input { .. })) => {
                    let cause = error.to_string();
                    first = first.or(Some(error));
                    Err(cause)
                }
                Err(error) => return Err(error),
            };
            self.scenes.push(scene);
        }
        match first {
            Some(error) if self.scenes.iter().all(|scene| scene.is_err()) => Err(error),
            _ => Ok(()),
        }
    }

    /// Refuses two points with the same scene, between which what is varied changes nothing.
    ///
    /// # Errors
    /// At the first axis in which they differ.
    fn compare_points(&self, source: &SceneSource) -> Result<()> {
        let mut seen: HashMap<String, usize> = HashMap::new();
        for (point, scene) in self.scenes.iter().enumerate() {
            let Ok(scene) = scene else { continue };
            // A name or a sentence makes no other run.
            let bare = Spec { name: String::new(), about: String::new(), ..scene.spec.clone() };
            if let Some(before) = seen.insert(Identity::new(definition(&bare), None, false).name(), point) {
                let [one, other] = [before, point].map(|point| self.point_name(point));
                let what = format!("`{one}` and `{other}` are the same scene, so that they would be one run twice");
                let key = format!("axis.{}", self.differs(before, point));
                return Err(source.error(
                    &key,
                    what,
                    "what the axis changes has no effect in this scene: vary another key",
                ));
            }
        }
        Ok(())
    }

    /// The first axis in which two points differ, as it is numbered in the study file where no axis zips.
    fn differs(&self, a: usize, b: usize) -> usize {
        (0..self.axes.len()).find(|k| self.points[a][*k] != self.points[b][*k]).unwrap_or(0)
    }

    /// Options of a point, in the order in which they win: the study's, the axes'.
    fn overrides(&self, point: usize) -> Vec<String> {
        let of_axes = self.levels(point).flat_map(|(_, level)| level.set.iter().cloned());
        self.common.iter().cloned().chain(of_axes).collect()
    }

    /// A case as a runner takes it; `work` is what it costs, in any unit that all share.
    pub fn case<'a>(&'a self, (point, seed): (usize, u64), work: f64, store: &'a CaseStore) -> TensileCase<'a> {
        let scene = self.scenes[point].as_ref().map_err(String::as_str);
        TensileCase { work, ..TensileCase::new(self.case_name(point, seed), scene, seed, store) }
    }

    /// The level of every axis at a point.
    pub fn levels(&self, point: usize) -> impl Iterator<Item = (&Axis, &axis::Level)> {
        self.axes.iter().zip(&self.points[point]).map(|(axis, level)| (axis, &axis.levels[*level]))
    }

    /// A point as people read it.
    pub fn point_name(&self, point: usize) -> String {
        let names: Vec<String> =
            self.levels(point).map(|(axis, level)| format!("{} {}", axis.name, level.name)).collect();
        if names.is_empty() { "the scene as it stands".into() } else { names.join(", ") }
    }

    /// A case as people read it.
    pub fn case_name(&self, point: usize, seed: u64) -> String {
        format!("{}, seed {seed}", self.point_name(point))
    }

    /// Point and seed of all cases in the order in which they are run: all points with the first seed, so that a study that
    /// is cut short has been everywhere, then those in which scatter makes a difference, or whose scene is refused, with
    /// the next.
    pub fn cases(&self) -> Vec<(usize, u64)> {
        let scatters: Vec<bool> =
            self.scenes.iter().map(|s| s.as_ref().map_or(true, |scene| scene.plan.scatter)).collect();
        let scatters = &scatters;
        let of_seed = |(k, seed): (usize, &u64)| {
            let seed = *seed;
            (0..self.points.len()).filter(move |point| k == 0 || scatters[*point]).map(move |point| (point, seed))
        };
        self.seeds.iter().enumerate().flat_map(of_seed).collect()
    }

    /// The axis that curves run over: the only one, when it is numeric.
    pub fn abscissa(&self) -> Option<&Axis> {
        match &self.axes[..] {
            [axis] if axis.is_numeric() => Some(axis),
            _ => None,
        }
    }
}

/// The text of a built-in study.
fn builtin(name: &str) -> Result<&'static str> {
    if let Some((_, text)) = STUDIES.iter().find(|(known, _)| *known == name) {
        return Ok(text);
    }
    let names: Vec<&str> = STUDIES.iter().map(|(name, _)| *name).collect();
    let all = format!("built-in studies: {}; a file is given by its path", names.join(", "));
    let help = match nearest(name, names.iter().copied()) {
        Some(near) => format!("did you mean `{near}`? {all}"),
        None => all,
    };
    Err(Error::input(format!("there is no built-in study `{name}`"), help))
}

/// A scene file is given from the study's folder, a built-in scene by its name.
fn base_scene(base: &str, folder: &Path) -> String {
    if base.ends_with(".toml") { folder.join(base).to_string_lossy().into_owned() } else { base.to_owned() }
}

fn seeds(raw: Option<&RawSeeds>, own: u64, source: &SceneSource) -> Result<Vec<u64>> {
    let wrong = |key: &str, what: String| source.error(key, what, "for example seeds = 3, or seeds = [1, 2, 3]");
    match raw {
        None => Ok(vec![own]),
        Some(RawSeeds::Count(count)) if *count < 1 => {
            Err(wrong("seeds", format!("`seeds` is {count}, but there must be at least one")))
        }
        Some(RawSeeds::Count(count)) if *count as usize > MOST_CASES => {
            Err(wrong("seeds", format!("{count} seeds are more than {MOST_CASES} cases")))
        }
        Some(RawSeeds::Count(count)) => Ok((1..=*count as u64).collect()),
        Some(RawSeeds::List(list)) if list.is_empty() => Err(wrong("seeds", "`seeds` lists none".into())),
        Some(RawSeeds::List(list)) => {
            let mut seeds = Vec::with_capacity(list.len());
            for (k, seed) in list.iter().enumerate() {
                let key = format!("seeds.{k}");
                let number = u64::try_from(*seed).map_err(|_| wrong(&key, format!("{seed} is no seed")))?;
                if seeds.contains(&number) {
                    return Err(wrong(&key, format!("seed {number} is listed twice")));
                }
                seeds.push(number);
            }
            Ok(seeds)
        }
    }
}

/// The model with the interactions that `[design]` names.
fn model(pairs: &[[String; 2]], axes: &[Axis], source: &SceneSource) -> Result<Model> {
    let place = |k: usize, name: &String| {
        axes.iter().position(|axis| axis.name == *name).ok_or_else(|| {
            let names: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
            let key = format!("design.interactions.{k}");
            source.error(&key, format!("no axis is called `{name}`"), format!("axes: {}", names.join(", ")))
        })
    };
    let pair = |(k, [a, b]): (usize, &[String; 2])| {
        let pair = [place(k, a)?, place(k, b)?];
        if pair[0] == pair[1] {
            let key = format!("design.interactions.{k}");
            return Err(source.error(&key, format!("`{a}` cannot interact with itself"), "name two axes"));
        }
        Ok(pair)
    };
    let interactions = pairs.iter().enumerate().map(pair).collect::<Result<Vec<_>>>()?;
    Ok(Model { levels: axes.iter().map(|axis| axis.levels.len()).collect(), interactions })
}

/// Points of the study: those of its design, or the full grid with the last axis running fastest.
fn points(
    axes: &[Axis],
    model: Option<&Model>,
    design: Option<&RawDesign>,
    source: &SceneSource,
) -> Result<Vec<Vec<usize>>> {
    let (Some(model), Some(design)) = (model, design) else {
        let mut points = vec![Vec::new()];
        for axis in axes {
            if points.len() * axis.levels.len() > MOST_CASES {
                let what = format!("the axes make more than {MOST_CASES} points");
                return Err(source.error("axis", what, "vary less, or pick points with [design]"));
            }
            let further = |point: &Vec<usize>| {
                let point = point.clone();
                (0..axis.levels.len()).map(move |level| point.iter().copied().chain([level]).collect())
            };
            points = points.iter().flat_map(further).collect();
        }
        return Ok(points);
    };
    let Some(count) = design.points else {
        return Err(source.error("design", "`design` has no `points`", "say how many, for example points = 32"));
    };
    let count = usize::try_from(count).unwrap_or(0);
    screening::d_optimal(model, count).map_err(|e| source.error("design.points", e.to_string(), ""))
}

fn quantities(names: &[String], key: &str, source: &SceneSource) -> Result<Vec<&'static Quantity>> {
    let one = |(k, name): (usize, &String)| {
        quantity::find(name).ok_or_else(|| {
            let known: Vec<&str> = quantity::ALL.iter().map(|quantity| &*quantity.name).collect();
            let all = format!("known: {}", known.join(", "));
            let help = match nearest(name, known.iter().copied()) {
                Some(near) => format!("did you mean `{near}`? {all}"),
                None => all,
            };
            source.error(&format!("{key}.{k}"), format!("there is no quantity `{name}`"), help)
        })
    };
    names.iter().enumerate().map(one).collect()
}

fn fits(names: &[String], axes: &[Axis], source: &SceneSource) -> Result<Vec<&'static Quantity>> {
    let curves = matches!(axes, [axis] if axis.is_numeric());
    if !names.is_empty() && !curves {
        let what = "curves are fitted over one axis of numbers, and this study has another kind of axes";
        return Err(source.error("fits", what, "remove `fits`, or vary one key only"));
    }
    quantities(names, "fits", source)
}

/// The data set and the theory that `compare` names.
fn references(names: &[String], source: &SceneSource) -> Result<Option<References>> {
    let mut published = None;
    for (k, name) in names.iter().enumerate().filter(|(_, name)| *name != STRAND_THEORY) {
        let at = format!("compare.{k}");
        let found = published::find(name).ok_or_else(|| {
            let known: Vec<&str> = published::names().chain([STRAND_THEORY]).collect();
            let help = format!("one of: {}", known.join(", "));
            source.error(&at, format!("`{name}` is nothing to compare with"), help)
        })?;
        if published.replace(found).is_some() {
            return Err(source.error(&at, "results are compared with one publication at a time", "name one"));
        }
    }
    let theory = names.iter().any(|name| name == STRAND_THEORY);
    match published {
        None if theory => {
            let known: Vec<&str> = published::names().collect();
            let help = format!("name its publication too: {}", known.join(", "));
            Err(source.error("compare", "strand theory is calibrated on an experiment", help))
        }
        published => Ok(published.map(|published| References { published, theory })),
    }
}
