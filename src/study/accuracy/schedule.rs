//! The runs of a study and their order: what is worth most for its cost comes first, so that a budget is
//! well spent.

use super::parameters::{Parameter, Role, Variation};
use crate::scene::Scene;

/// A parameter that a scene has.
pub struct Varied {
    /// The parameter.
    pub parameter: &'static Parameter,
    /// Its values here.
    pub variation: Variation,
}

/// The parameters that a scene has, and the others with the reason.
pub fn vary(parameters: &[&'static Parameter], scene: &Scene) -> (Vec<Varied>, Vec<(&'static str, String)>) {
    let (mut varied, mut absent) = (Vec::new(), Vec::new());
    for parameter in parameters {
        match (parameter.variation)(scene) {
            Ok(variation) => varied.push(Varied { parameter, variation }),
            Err(reason) => absent.push((parameter.name, reason)),
        }
    }
    (varied, absent)
}

/// A run that is to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRun {
    /// Number of the parameter among those varied and of its level; `None` for the scene as it stands.
    pub place: Option<[usize; 2]>,
    /// Seed of the scatter.
    pub seed: u64,
    /// What it is called.
    pub name: String,
    /// What it will cost over the scene as it stands (-).
    pub work: f64,
    /// Whether it is written to disk.
    pub writes: bool,
    /// Lower comes first.
    tier: usize,
}

/// All runs, in the order in which they are made.
pub fn runs(varied: &[Varied], seeds: &[u64]) -> Vec<PlannedRun> {
    let mut runs = Vec::new();
    for seed in seeds.iter().copied() {
        let named = |text: String| if seeds.len() > 1 { format!("{text}, seed {seed}") } else { text };
        let name = named("the scene as it stands".into());
        runs.push(PlannedRun { place: None, seed, name, work: 1.0, writes: false, tier: 0 });
        for (k, Varied { parameter, variation }) in varied.iter().enumerate() {
            for (l, level) in variation.levels.iter().enumerate() {
                runs.push(PlannedRun {
                    place: Some([k, l]),
                    seed,
                    name: named(format!("{} {}", parameter.name, level.value.shown)),
                    work: level.work,
                    writes: level.writes,
                    tier: tier(variation, l),
                });
            }
        }
    }
    // Stable, so that seeds keep their order and cheap ones come first among equals.
    runs.sort_by(|a, b| a.tier.cmp(&b.tier).then(a.work.total_cmp(&b.work)));
    runs
}

/// The reference needs the exact value and the nearest finer levels; then what is faster, then what should not matter
/// and other models, output last.
fn tier(variation: &Variation, level: usize) -> usize {
    let level = &variation.levels[level];
    let (Some(value), Some(base)) = (level.value.number, variation.base.number) else {
        return if level.writes { 6 } else { 5 };
    };
    match variation.role {
        Role::Exact(exact) if value == exact => 1,
        Role::Refines if value < base => {
            let numbers = variation.levels.iter().filter_map(|other| other.value.number);
            1 + numbers.filter(|other| value < *other && *other < base).count()
        }
        Role::Refines | Role::Exact(_) => 4,
        Role::Neutral | Role::Model => 5,
    }
}

#[cfg(test)]
mod tests {
    use super::super::parameters::select;
    use super::*;
    use crate::scene;

    #[test]
    fn the_scene_comes_first_then_what_the_reference_needs_cheap_before_dear() {
        let scene = scene::load("strand-1x7", &["time.inertia_scale=4".to_string()]).unwrap();
        let names = ["safety", "speed", "inertia", "skin"].map(String::from);
        let (varied, absent) = vary(&select(&names).unwrap(), &scene);
        assert!(absent.is_empty());
        let runs = runs(&varied, &[1, 2]);
        let order: Vec<&str> = runs.iter().filter(|run| run.seed == 1).map(|run| run.name.as_str()).collect();
        let expected = [
            "the scene as it stands, seed 1",
            "inertia 1, seed 1",
            "safety 0.4, seed 1",
            "speed 1.25 m/s, seed 1",
            "safety 0.2, seed 1",
            "speed 0.625 m/s, seed 1",
            "speed 10 m/s, seed 1",
            "speed 5 m/s, seed 1",
            "safety 1, seed 1",
        ];
        assert_eq!(order[..expected.len()], expected);
        assert_eq!(runs[1].name, "the scene as it stands, seed 2");
    }
}
