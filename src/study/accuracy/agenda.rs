//! Which runs a study consists of, and in which order: what is worth most for its cost comes first, so that a budget is
//! well spent.

use super::knobs::{Knob, Ladder, Role};
use crate::scene::spec::Spec;
use crate::study::cases::workshop::Case;

/// A knob that this scene has.
pub struct Turned {
    /// The knob.
    pub knob: &'static Knob,
    /// Its values here.
    pub ladder: Ladder,
}

/// The knobs that a scene has, and the others with the reason.
pub fn turn(knobs: &[&'static Knob], spec: &Spec) -> (Vec<Turned>, Vec<(&'static str, String)>) {
    let (mut turned, mut absent) = (Vec::new(), Vec::new());
    for knob in knobs {
        match (knob.ladder)(spec) {
            Ok(ladder) => turned.push(Turned { knob, ladder }),
            Err(reason) => absent.push((knob.name, reason)),
        }
    }
    (turned, absent)
}

/// A run that is to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Item {
    /// Number of the knob among those turned and of its level; `None` for the scene as it stands.
    pub place: Option<[usize; 2]>,
    /// Seed of the scatter.
    pub seed: u64,
    /// What it is called.
    pub name: String,
    /// Options beyond those of the scene.
    pub set: Vec<String>,
    /// What it will cost over the scene as it stands (-).
    pub work: f64,
    /// Whether it is written to disk.
    pub writes: bool,
    /// Lower comes first.
    tier: usize,
}

impl Item {
    /// The run, of a scene with these options.
    pub fn case(&self, overrides: &[String]) -> Case {
        Case {
            name: self.name.clone(),
            overrides: overrides.iter().chain(&self.set).cloned().collect(),
            work: self.work,
            writes: self.writes,
            leads: self.place.is_none(),
        }
    }
}

/// All runs, in the order in which they are made.
pub fn items(turned: &[Turned], seeds: &[u64]) -> Vec<Item> {
    let mut items = Vec::new();
    for seed in seeds {
        let option = format!("seed={seed}");
        let named = |text: String| if seeds.len() > 1 { format!("{text}, seed {seed}") } else { text };
        let base = Item {
            place: None,
            seed: *seed,
            name: named("the scene as it stands".into()),
            set: vec![option.clone()],
            work: 1.0,
            writes: false,
            tier: 0,
        };
        items.push(base);
        for (k, Turned { knob, ladder }) in turned.iter().enumerate() {
            for (l, level) in ladder.levels.iter().enumerate() {
                items.push(Item {
                    place: Some([k, l]),
                    seed: *seed,
                    name: named(format!("{} {}", knob.name, level.value.shown)),
                    set: level.set.iter().cloned().chain([option.clone()]).collect(),
                    work: level.work,
                    writes: level.writes,
                    tier: tier(ladder, l),
                });
            }
        }
    }
    // Stable, so that seeds keep their order and cheap ones come first among equals.
    items.sort_by(|a, b| a.tier.cmp(&b.tier).then(a.work.total_cmp(&b.work)));
    items
}

/// The reference needs the exact value and the nearest finer levels; then what is faster, then what should not matter
/// and other models, output last.
fn tier(ladder: &Ladder, level: usize) -> usize {
    let level = &ladder.levels[level];
    let (Some(value), Some(base)) = (level.value.number, ladder.base.number) else {
        return if level.writes { 6 } else { 5 };
    };
    match ladder.role {
        Role::Exact(exact) if value == exact => 1,
        Role::Refines if value < base => {
            let numbers = ladder.levels.iter().filter_map(|other| other.value.number);
            1 + numbers.filter(|other| value < *other && *other < base).count()
        }
        Role::Refines | Role::Exact(_) => 4,
        Role::Neutral | Role::Model => 5,
    }
}

#[cfg(test)]
mod tests {
    use super::super::knobs::select;
    use super::*;
    use crate::scene;

    #[test]
    fn the_scene_comes_first_then_what_the_reference_needs_cheap_before_dear() {
        let spec = scene::load("strand-1x7", &["time.inertia_scale=4".to_string()]).unwrap().spec;
        let names = ["safety", "speed", "inertia", "skin"].map(String::from);
        let (turned, absent) = turn(&select(&names).unwrap(), &spec);
        assert!(absent.is_empty());
        let items = items(&turned, &[1, 2]);
        let order: Vec<&str> = items.iter().filter(|item| item.seed == 1).map(|item| item.name.as_str()).collect();
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
        assert_eq!(items[1].name, "the scene as it stands, seed 2");
        assert_eq!(items[2].set, ["time.inertia_scale=1", "seed=1"]);
    }
}
