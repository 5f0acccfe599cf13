//! Presets of accuracy against run time: `--quality draft|standard|fine`. A preset turns the keys of its table by a
//! factor from what the scene says; `--set` wins over it. Draft pulls twice as fast at every strain, and so does an
//! adaptive pull; fine half as fast, with half the time step.

use super::Scene;
use super::resolve_drive::slower_than_the_drive;
use super::spec::{AdaptiveSpec, DriveSpec, Spec};
use crate::base::error::Result;
use serde::Deserialize;

/// A preset.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
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
    /// Unit in which the change is told.
    unit: &'static str,
    /// Factors on the scene's own value (-).
    draft: f64,
    fine: f64,
    /// The greatest value that the key allows.
    greatest: f64,
    /// The scene's own value, SI; `None` where the scene has no such key.
    value: fn(&mut Spec) -> Option<&mut f64>,
}

/// All keys that presets turn.
const TABLE: &[Entry] = &[
    Entry {
        key: "time.safety",
        unit: "",
        draft: 1.25,
        fine: 0.5,
        greatest: 1.0,
        value: |spec| spec.time.step.is_none().then_some(&mut spec.time.safety),
    },
    Entry {
        key: "grip.speed",
        unit: " m/s",
        draft: 2.0,
        fine: 0.5,
        greatest: f64::INFINITY,
        value: |spec| match &mut spec.grip.as_mut()?.drive {
            DriveSpec::Speed(speed) if *speed != 0.0 => Some(speed),
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
        value: |spec| adaptive(spec).map(|adaptive| &mut adaptive.fastest),
    },
    Entry {
        key: "grip.adaptive.kinetic",
        unit: "",
        draft: 4.0,
        fine: 0.25,
        greatest: 1.0,
        value: |spec| adaptive(spec).map(|adaptive| &mut adaptive.kinetic),
    },
    Entry {
        key: "grip.adaptive.passages",
        unit: "",
        draft: 0.5,
        fine: 2.0,
        greatest: f64::INFINITY,
        value: |spec| adaptive(spec).map(|adaptive| &mut adaptive.passages),
    },
];

fn adaptive(spec: &mut Spec) -> Option<&mut AdaptiveSpec> {
    spec.grip.as_mut()?.adaptive.as_mut()
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

    /// Gives a scene this quality. Keys that a `--set` option gives, and those that the scene does not have, are left
    /// alone. Returns what it changed, each as `key=value`.
    ///
    /// # Errors
    /// At `grip.adaptive`, when an option and the preset together let the pull begin faster than its fastest.
    pub fn apply(self, scene: &mut Scene) -> Result<Vec<String>> {
        let mut changed = Vec::new();
        for entry in TABLE {
            let factor = match self {
                Quality::Draft => entry.draft,
                Quality::Standard => continue,
                Quality::Fine => entry.fine,
            };
            if scene.source.is_set(entry.key) {
                continue;
            }
            if let Some(value) = (entry.value)(&mut scene.spec) {
                *value = (*value * factor).min(entry.greatest);
                changed.push(format!("{}={value}{}", entry.key, entry.unit));
            }
        }
        let wrong =
            scene.spec.grip.as_ref().and_then(|grip| slower_than_the_drive(grip.adaptive.as_ref()?, grip.drive));
        match wrong {
            Some((what, help)) => Err(scene.source.error("grip.adaptive.fastest", what, help)),
            None => Ok(changed),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    /// A scene with options at a quality, and what that changed.
    fn changed(quality: Quality, name: &str, options: &[&str]) -> Result<(Spec, Vec<String>)> {
        let options: Vec<String> = options.iter().map(|option| option.to_string()).collect();
        let mut scene = scene::load(name, &options)?;
        let changed = quality.apply(&mut scene)?;
        Ok((scene.spec, changed))
    }

    fn with(quality: Quality, name: &str) -> Spec {
        changed(quality, name, &[]).unwrap().0
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
        let adaptive = |quality| adaptive(&mut with(quality, "ka4")).cloned().unwrap();
        let [draft, own, fine] = Quality::ALL.map(adaptive);
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} is not {b}");
        for (turned, factor) in [(&draft, 2.0), (&fine, 0.5)] {
            close(turned.fastest, factor * own.fastest);
            close(turned.kinetic, factor * factor * own.kinetic);
            close(turned.passages, own.passages / factor);
            assert_eq!(turned.from, own.from);
        }
        let (_, constant) = changed(Quality::Fine, "strand-1x7", &[]).unwrap();
        assert_eq!(constant, ["time.safety=0.4", "grip.speed=2.5 m/s"]);
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
        assert!(changed(Quality::Draft, "cantilever", &["time.step=10 ns"]).unwrap().1.is_empty());
    }

    /// An option wins over the preset, whether it gives the key or the table that holds it; together they must make sense.
    #[test]
    fn options_win_over_presets() {
        let (draft, changes) = changed(Quality::Draft, "ka4", &["grip.speed=3 m/s"]).unwrap();
        assert!(speed(&draft) == 3.0 && changes.iter().all(|change| !change.starts_with("grip.speed")), "{changes:?}");
        let table = "grip.adaptive={ from = \"5 %\", fastest = \"21 m/s\" }";
        let (draft, _) = changed(Quality::Draft, "ka4", &[table]).unwrap();
        assert_eq!(draft.grip.unwrap().adaptive.unwrap().fastest, 21.0);
        let slow = changed(Quality::Draft, "ka4", &["grip.adaptive.fastest=6 m/s"]).unwrap_err();
        assert!(slow.to_string().contains("the pull begins at `speed`"), "{slow}");
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
