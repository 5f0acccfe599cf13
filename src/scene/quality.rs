//! Presets of accuracy against run time: `--quality draft|standard|fine`. A preset turns the keys of its table by a
//! factor from what the scene says; `--set` wins over it. Draft pulls twice as fast at every strain, and so does an
//! adaptive pull; fine half as fast, with half the time step.

use super::spec::{AdaptiveSpec, DriveSpec, Spec};

/// A preset.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Quality {
    /// Fast, for a first look.
    Draft,
    /// The scene as it is written.
    #[default]
    Standard,
    /// Slow, to see whether a result holds.
    Fine,
}

/// What a preset does to a key.
struct Entry {
    key: &'static str,
    /// Unit in which the scene is told.
    unit: &'static str,
    /// Factors on the scene's own value (-).
    draft: f64,
    fine: f64,
    /// The greatest value that the key allows.
    greatest: f64,
    /// The scene's own value in that unit; `None` where the scene has no such key.
    own: fn(&Spec) -> Option<f64>,
}

/// All keys that presets turn.
const TABLE: &[Entry] = &[
    Entry {
        key: "time.safety",
        unit: "",
        draft: 1.25,
        fine: 0.5,
        greatest: 1.0,
        own: |spec| spec.time.step.is_none().then_some(spec.time.safety),
    },
    Entry {
        key: "grip.speed",
        unit: " m/s",
        draft: 2.0,
        fine: 0.5,
        greatest: f64::INFINITY,
        own: |spec| match spec.grip.as_ref()?.drive {
            DriveSpec::Speed(speed) if speed != 0.0 => Some(speed),
            _ => None,
        },
    },
    // An adaptive pull takes the least of what its three keys allow: all of them turn, or the least of them would decide
    // what the preset does. Kinetic energy goes with the square of the speed.
    Entry {
        key: "grip.adaptive.fastest",
        unit: " m/s",
        draft: 2.0,
        fine: 0.5,
        greatest: f64::INFINITY,
        own: |spec| adaptive(spec).map(|adaptive| adaptive.fastest),
    },
    Entry {
        key: "grip.adaptive.kinetic",
        unit: "",
        draft: 4.0,
        fine: 0.25,
        greatest: 1.0,
        own: |spec| adaptive(spec).map(|adaptive| adaptive.kinetic),
    },
    Entry {
        key: "grip.adaptive.passages",
        unit: "",
        draft: 0.5,
        fine: 2.0,
        greatest: f64::INFINITY,
        own: |spec| adaptive(spec).map(|adaptive| adaptive.passages),
    },
];

fn adaptive(spec: &Spec) -> Option<&AdaptiveSpec> {
    spec.grip.as_ref()?.adaptive.as_ref()
}

impl Quality {
    /// All of them.
    pub const ALL: [Quality; 3] = [Quality::Draft, Quality::Standard, Quality::Fine];

    /// Its name.
    pub fn word(self) -> &'static str {
        match self {
            Quality::Draft => "draft",
            Quality::Standard => "standard",
            Quality::Fine => "fine",
        }
    }

    /// The `--set` options that give `spec` this quality; keys that the scene does not have are left alone.
    pub fn overrides(self, spec: &Spec) -> Vec<String> {
        let factor = |entry: &Entry| match self {
            Quality::Draft => entry.draft,
            Quality::Standard => 1.0,
            Quality::Fine => entry.fine,
        };
        let changed = TABLE.iter().filter(|entry| factor(entry) != 1.0);
        let set = changed.filter_map(|entry| {
            let value = ((entry.own)(spec)? * factor(entry)).min(entry.greatest);
            Some(format!("{}={value}{}", entry.key, entry.unit))
        });
        set.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    fn with(quality: Quality, name: &str) -> Spec {
        let own = scene::load(name, &[]).unwrap().spec;
        scene::load(name, &quality.overrides(&own)).unwrap().spec
    }

    fn speed(spec: &Spec) -> f64 {
        let Some(DriveSpec::Speed(speed)) = spec.grip.as_ref().map(|grip| grip.drive) else { panic!() };
        speed
    }

    #[test]
    fn presets_turn_what_the_scene_says_by_a_factor() {
        let own = scene::load("strand-1x7", &[]).unwrap().spec;
        let [draft, standard, fine] = Quality::ALL.map(|quality| with(quality, "strand-1x7"));
        assert_eq!(standard, own);
        assert!(speed(&draft) > speed(&own) && speed(&fine) < speed(&own));
        assert!(draft.time.safety >= own.time.safety && draft.time.safety <= 1.0);
        assert!(fine.time.safety < own.time.safety);
    }

    /// What an adaptive pull allows itself is turned with its slowest speed.
    #[test]
    fn an_adaptive_pull_is_turned_as_a_whole() {
        let adaptive = |quality| adaptive(&with(quality, "ka4")).cloned().unwrap();
        let [draft, own, fine] = Quality::ALL.map(adaptive);
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} is not {b}");
        for (turned, factor) in [(&draft, 2.0), (&fine, 0.5)] {
            close(turned.fastest, factor * own.fastest);
            close(turned.kinetic, factor * factor * own.kinetic);
            close(turned.passages, own.passages / factor);
            assert_eq!(turned.from, own.from);
        }
        let constant = scene::load("strand-1x7", &[]).unwrap().spec;
        assert!(Quality::Fine.overrides(&constant).iter().all(|option| !option.contains("adaptive")));
    }

    #[test]
    fn scenes_without_a_grip_get_what_applies() {
        let own = scene::load("cantilever", &[]).unwrap().spec;
        let fine = with(Quality::Fine, "cantilever");
        assert_eq!(fine.grip, None);
        assert!(fine.time.safety < own.time.safety);
    }

    #[test]
    fn a_step_that_is_fixed_stays() {
        let fixed = scene::load("cantilever", &["time.step=10 ns".to_string()]).unwrap().spec;
        assert!(Quality::Draft.overrides(&fixed).is_empty());
    }

    /// Every scene that comes with the program loads at every quality.
    #[test]
    fn every_scene_has_every_quality() {
        for (name, _) in scene::builtin::list() {
            for quality in Quality::ALL {
                with(quality, name);
            }
        }
    }
}
