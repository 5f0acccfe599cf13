//! A study as it is written: serde tables, nothing checked but names and kinds of values. This is also the reference of
//! all its keys.

use crate::scene::quality::Quality;
use serde::Deserialize;

/// A whole study file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawStudy {
    /// What the study asks, one or more sentences. Required.
    pub about: Option<String>,
    /// The scene that every case starts from: a built-in name, or a path from the study's folder. Required.
    pub base: Option<String>,
    /// Changes to the scene in every case, each written like a `--set` option: "stop.strain=40 %".
    #[serde(default)]
    pub set: Vec<String>,
    /// `draft`, `standard` (default) or `fine`; `--quality` wins over it.
    pub quality: Option<Quality>,
    /// Seeds of the scatter: how many, counted from 1, or a list. Default: the scene's own.
    pub seeds: Option<RawSeeds>,
    /// `[[axis]]`: what is varied. Several make a grid.
    #[serde(default)]
    pub axis: Vec<RawAxis>,
    /// Only some points of the grid, and an analysis of effects. Absent: the full grid.
    pub design: Option<RawDesign>,
    /// Which quantities are gathered, by name. Default: all.
    pub quantities: Option<Vec<String>>,
    /// Quantities that curves are fitted to, over the only axis.
    #[serde(default)]
    pub fits: Vec<String>,
    /// What the results are compared with: a data set of `assets/reference/` by name, such as "zhao-2025", and
    /// "strand-theory", which is calibrated on its experiment.
    #[serde(default)]
    pub compare: Vec<String>,
}

/// `seeds`.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged, expecting = "expected a number of seeds, or a list of them such as [1, 2, 3]")]
pub(super) enum RawSeeds {
    /// How many seeds, counted from 1.
    Count(i64),
    /// The seeds one by one.
    List(Vec<i64>),
}

/// `[[axis]]`: `key` with `values`, or with `from`, `to` and `points`; or `levels` that each change several keys.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawAxis {
    /// What it is called in tables and plots. Default: the last part of `key`.
    pub name: Option<String>,
    /// Key of the scene, as in `--set`.
    pub key: Option<String>,
    /// Its values.
    pub values: Option<Vec<toml::Value>>,
    /// First value of an even range, with its unit.
    pub from: Option<toml::Value>,
    /// Last value, in the same unit.
    pub to: Option<toml::Value>,
    /// Number of values, both ends included.
    pub points: Option<i64>,
    /// `[[axis.levels]]`, instead of all the above but the name.
    pub levels: Option<Vec<RawLevel>>,
    /// Goes along with the axis before it, value by value, instead of making a grid with it. Default false.
    #[serde(default)]
    pub zip: bool,
}

/// A level of an axis that changes several keys.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawLevel {
    /// What it is called. Required.
    pub name: Option<String>,
    /// What it changes, each written like a `--set` option; nothing for the scene as it stands.
    #[serde(default)]
    pub set: Vec<String>,
}

/// `[design]`: the points of the grid that tell most of main effects and chosen interactions (D-optimal).
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawDesign {
    /// Number of points. Required.
    pub points: Option<i64>,
    /// Pairs of axes, by name, whose interaction is wanted beside the main effects.
    #[serde(default)]
    pub interactions: Vec<[String; 2]>,
}
