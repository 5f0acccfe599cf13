//! What a study says twice: keys that its axes vary and that something else sets, seeds on an axis.

use super::axis::Axis;
use super::changes::Changes;
use super::raw::RawStudy;
use crate::base::error::{Error, Result};
use crate::scene::SceneSource;

/// Key of an option `key=value`, its parts trimmed.
fn key_of(option: &str) -> String {
    let key = option.split_once('=').map_or(option, |(key, _)| key);
    key.split('.').map(str::trim).collect::<Vec<_>>().join(".")
}

/// Whether every level of an axis sets this key or a table that holds it, so that an option before it is lost.
fn varies(axis: &Axis, key: &str) -> bool {
    let sets = |option: &String| {
        let own = key_of(option);
        key == own || key.starts_with(&format!("{own}."))
    };
    axis.levels.iter().all(|level| level.set.iter().any(sets))
}

/// Refuses seeds that are given other than by `seeds`, and options on keys that an axis varies.
///
/// # Errors
/// At the axis, the element of `set`, or the option that has no effect.
pub(super) fn check(axes: &[Axis], raw: &RawStudy, changes: &Changes, source: &SceneSource) -> Result<()> {
    const SEEDS: &str = "every case has its seed from `seeds`: give seeds = [1, 2], or --seeds 1,2";
    for (index, axis) in raw.axis.iter().enumerate() {
        if axis.key.as_deref().is_some_and(|key| key_of(key) == "seed") {
            let what = "an axis varies `seed`, which `seeds` gives to every case";
            return Err(source.error(&format!("axis.{index}.key"), what, SEEDS));
        }
        for (k, level) in axis.levels.iter().flatten().enumerate() {
            if level.set.iter().any(|option| key_of(option) == "seed") {
                let what = "a level sets `seed`, which `seeds` gives to every case";
                return Err(source.error(&format!("axis.{index}.levels.{k}.set"), what, SEEDS));
            }
        }
    }
    let trouble = |option: &String| {
        let key = key_of(option);
        if key == "seed" {
            return Some((format!("`{option}` has no effect in a study"), SEEDS.to_owned()));
        }
        let axis = axes.iter().find(|axis| varies(axis, &key))?;
        let what = format!("`{option}` has no effect: the axis `{}` varies that key", axis.name);
        Some((what, "leave it out, or take the axis out of the study".into()))
    };
    for (k, option) in raw.set.iter().enumerate() {
        if let Some((what, help)) = trouble(option) {
            return Err(source.error(&format!("set.{k}"), what, help));
        }
    }
    match changes.set.iter().find_map(trouble) {
        Some((what, help)) => Err(Error::input(format!("--set {what}"), help)),
        None => Ok(()),
    }
}
