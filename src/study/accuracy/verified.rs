//! Scenes with a closed form of their own: the verification cases. What they vary, how fast their error falls, and what
//! each level takes.

use crate::base::error::{Error, Result};
use crate::engine::REVISION;
use crate::observe::files::write_whole;
use crate::run::in_pool;
use crate::study::plot::{self, Axis, Figure, Legend, Mark, Series, Slope};
use crate::study::table::Table;
use crate::study::verify::finding::{Convergence, Finding};
use crate::study::verify::{CASES, Case, Effort, run_one};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Folder of the records within that of the study.
const FOLDER: &str = "cases";
/// Width and height of each figure (px of an SVG).
const SIZE: [u32; 2] = [760, 480];

/// The verification cases that a name means: `hertz`, `verify/hertz`, or the beginning of several, `cantilever`.
pub fn select(name: &str) -> Vec<&'static Case> {
    let name = name.strip_prefix("verify/").unwrap_or(name);
    let exact = CASES.iter().filter(|case| case.name == name);
    let family = format!("{name}-");
    let mut cases: Vec<&Case> = exact.collect();
    if cases.is_empty() {
        cases = CASES.iter().filter(|case| case.name.starts_with(&family)).collect();
    }
    cases
}

/// One quantity of a case at one or more resolutions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Level {
    /// The case.
    pub case: String,
    /// What was computed.
    pub quantity: String,
    /// What the resolution is, such as "a/L"; `None` where nothing was varied.
    pub axis: Option<String>,
    /// Spacing, step or load per particle over what it is measured by (-).
    pub resolution: Option<f64>,
    /// Relative error, signed (%); `None` where it is not a number.
    pub error_percent: Option<f64>,
    /// Order of convergence from the next coarser level to this one (-).
    pub order: Option<f64>,
    /// The one that theory knows (-).
    pub order_theory: Option<f64>,
    /// Steps.
    pub steps: u64,
    /// Wall time (s).
    pub wall_s: f64,
}

/// What became of a case, as it is kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseRecord {
    /// Version of the program.
    physics: u32,
    /// Whether fewer levels were run.
    quick: bool,
    /// The case.
    pub case: String,
    /// What it claims.
    pub about: String,
    /// Where the closed form comes from.
    pub source: String,
    /// Its levels, from coarse to fine; empty when it could not be run.
    pub levels: Vec<Level>,
    /// Why it could not be run.
    pub failed: Option<String>,
}

/// What a study of verification cases found.
pub struct Verified {
    /// What the user called it.
    pub name: String,
    /// Case by case.
    pub records: Vec<CaseRecord>,
    /// Cases that were there from before.
    pub kept: usize,
    /// Cases run now.
    pub made: usize,
    /// Whether the user stopped it.
    pub interrupted: bool,
}

/// Runs `cases` one by one, each on one thread; those with a record in `folder` are not run again unless `fresh`. `tell`
/// hears the name of each before it begins.
///
/// # Errors
/// When the folder cannot be written.
pub fn study(
    name: &str,
    cases: &[&'static Case],
    quick: bool,
    folder: &Path,
    fresh: bool,
    stop: &AtomicBool,
    tell: &dyn Fn(&str),
) -> Result<Verified> {
    let kept_in = folder.join(FOLDER);
    std::fs::create_dir_all(&kept_in).map_err(|e| Error::io("cannot make the folder", &kept_in, e))?;
    let mut found = Verified { name: name.into(), records: Vec::new(), kept: 0, made: 0, interrupted: false };
    for case in cases {
        tell(case.name);
        let path = kept_in.join(format!("verify-{}{}.json", case.name, if quick { "-quick" } else { "" }));
        if let Some(record) = kept(&path, case, quick).filter(|_| !fresh) {
            found.records.push(record);
            found.kept += 1;
            continue;
        }
        let effort = if quick { Effort::Quick } else { Effort::Full };
        let report = in_pool(Some(1), || run_one(case, effort, stop))?;
        if stop.load(Ordering::Relaxed) {
            found.interrupted = true;
            break;
        }
        let (levels, failed) = match &report.result {
            Ok(findings) => (findings.iter().flat_map(|finding| levels(case, finding)).collect(), None),
            Err(error) => (Vec::new(), Some(error.to_string())),
        };
        let (about, source) = (case.about.into(), case.source.into());
        let record = CaseRecord { physics: REVISION, quick, case: case.name.into(), about, source, levels, failed };
        let text = serde_json::to_string_pretty(&record).expect("a record holds nothing that JSON lacks");
        write_whole(&path, &text)?;
        found.records.push(kept(&path, case, quick).unwrap_or(record));
        found.made += 1;
    }
    Ok(found)
}

/// The record of a case; one that is damaged, or of another revision of the physics, is none.
fn kept(path: &Path, case: &Case, quick: bool) -> Option<CaseRecord> {
    let record: CaseRecord = serde_json::from_str(&std::fs::read_to_string(path).ok()?).ok()?;
    (record.physics == REVISION && record.case == case.name && record.quick == quick).then_some(record)
}

/// The levels of a finding: one for each resolution, or one alone.
fn levels(case: &Case, finding: &Finding) -> Vec<Level> {
    let finite = |value: f64| value.is_finite().then_some(value);
    let level = |axis: Option<&str>, resolution, error: f64, order, steps, wall_s| Level {
        case: case.name.into(),
        quantity: finding.what.clone(),
        axis: axis.map(str::to_string),
        resolution,
        error_percent: finite(100.0 * error),
        order,
        order_theory: finding.order.map(|order| order.theory),
        steps,
        wall_s,
    };
    let Some(Convergence { axis, points }) = &finding.convergence else {
        return vec![level(None, None, finding.error(), None, finding.spent.steps, finding.spent.wall_s)];
    };
    let orders = finding.convergence.as_ref().map(Convergence::orders).unwrap_or_default();
    let before = |k: usize| k.checked_sub(1).and_then(|k| finite(orders[k]));
    let at = points.iter().enumerate();
    at.map(|(k, p)| level(Some(axis), Some(p.resolution), p.error, before(k), p.spent.steps, p.spent.wall_s)).collect()
}

impl Verified {
    fn levels(&self) -> impl Iterator<Item = &Level> {
        self.records.iter().flat_map(|record| &record.levels)
    }

    /// The levels for people.
    pub fn table(&self) -> Table {
        let heads = [
            "case",
            "quantity",
            "resolution",
            "run time [s]",
            "steps",
            "ms/step",
            "error [%]",
            "order [-]",
            "theory [-]",
        ];
        let mut last = [String::new(), String::new()];
        let rows = self.levels().map(|level| {
            let names = [level.case.clone(), level.quantity.clone()];
            let shown = if names == last { [String::new(), String::new()] } else { names.clone() };
            last = names;
            let number = |value: Option<f64>, decimals: usize| {
                value.map_or(String::new(), |value| format!("{value:.decimals$}"))
            };
            let resolution =
                level.resolution.zip(level.axis.as_ref()).map_or(String::new(), |(r, axis)| format!("{axis} = {r:.4}"));
            let ms = (level.steps > 0).then(|| 1e3 * level.wall_s / level.steps as f64);
            shown
                .into_iter()
                .chain([
                    resolution,
                    format!("{:.3}", level.wall_s),
                    level.steps.to_string(),
                    number(ms, 4),
                    level.error_percent.map_or("not a number".into(), percent),
                    number(level.order, 2),
                    number(level.order_theory, 2),
                ])
                .collect()
        });
        let rows = rows.collect();
        Table {
            title: format!("{}: error against run time, closed forms as references", self.name),
            heads: heads.iter().map(|head| head.to_string()).collect(),
            rows,
            default: None,
            left: 2,
        }
    }

    /// Writes `accuracy.csv`, `accuracy.json` and, where something was varied, `accuracy.svg` and `accuracy.png`. Gives
    /// the files.
    ///
    /// # Errors
    /// When the folder cannot be written.
    pub fn write(&self, command: &str, folder: &Path) -> Result<Vec<PathBuf>> {
        let mut files = vec![folder.join("accuracy.csv"), folder.join("accuracy.json")];
        let refuse = |e: csv::Error| Error::io("cannot write", folder, std::io::Error::other(e));
        let mut writer = csv::Writer::from_writer(Vec::new());
        self.levels().try_for_each(|level| writer.serialize(level)).map_err(refuse)?;
        let bytes = writer.into_inner().map_err(|e| Error::io("cannot write", folder, e.into_error()))?;
        write_whole(&files[0], &bytes)?;
        let document = serde_json::json!({
            "scene": self.name,
            "command": command,
            "physics": REVISION,
            "interrupted": self.interrupted,
            "reference": { "kind": "closed-form" },
            "cases": self.records,
            "summary": self.summary(),
            "tables": [self.table()],
        });
        let text = serde_json::to_string_pretty(&document).expect("the study holds nothing that JSON lacks");
        write_whole(&files[1], &(text + "\n"))?;
        let figures = self.figures();
        if !figures.is_empty() {
            for extension in ["svg", "png"] {
                files.push(folder.join(format!("accuracy.{extension}")));
                plot::write(&figures, 1, &folder.join(format!("accuracy.{extension}")))?;
            }
        }
        Ok(files)
    }

    /// What the cases are compared with, and what failed.
    pub fn summary(&self) -> String {
        let mut text = String::new();
        for record in &self.records {
            text += &format!("{}: {}.\n  Reference: closed form, {}.\n", record.case, record.about, record.source);
            if let Some(cause) = &record.failed {
                text += &format!("  FAILED: {cause}\n");
            }
        }
        text
    }

    /// Error over run time and over resolution, with the order that theory knows; none where nothing was varied.
    fn figures(&self) -> Vec<Figure> {
        let error = || Axis::log("|relative error| [%]");
        let mut by_time =
            Figure::new(format!("{}: error against run time", self.name), Axis::log("run time [s]"), error());
        let title = format!("{}: order of convergence", self.name);
        let mut by_resolution = Figure::new(title, Axis::log("resolution [-]"), error());
        for record in &self.records {
            let mut quantities: Vec<&str> = record.levels.iter().map(|level| level.quantity.as_str()).collect();
            quantities.dedup();
            for quantity in quantities {
                let levels: Vec<&Level> =
                    record.levels.iter().filter(|l| l.quantity == quantity && l.resolution.is_some()).collect();
                let Some(finest) = levels.last() else { continue };
                let points = |x: fn(&Level) -> f64| -> Vec<[f64; 2]> {
                    levels.iter().map(|level| [x(level), level.error_percent.map_or(f64::NAN, f64::abs)]).collect()
                };
                let axis = finest.axis.clone().unwrap_or_default();
                let over_time = points(|level| level.wall_s);
                let over_resolution = points(|level| level.resolution.unwrap_or(f64::NAN));
                if let (Some(order), Some(through)) = (finest.order_theory, over_resolution.last()) {
                    let name = format!("order {order:.2} (theory)");
                    by_resolution.slopes.push(Slope { order, through: *through, name });
                }
                let name = format!("{} ({axis})", record.case);
                by_time.series.push(Series::new(&name, Mark::LineAndPoints, over_time));
                by_resolution.series.push(Series::new(&name, Mark::LineAndPoints, over_resolution));
            }
        }
        if by_time.series.is_empty() {
            return Vec::new();
        }
        let figures = [by_time, by_resolution];
        figures.into_iter().map(|figure| Figure { legend: Legend::Beside, size: SIZE, ..figure }).collect()
    }
}

fn percent(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if size >= 1e-3 => format!("{value:+.4}"),
        _ => format!("{value:+.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_mean_cases_or_families_of_them() {
        let names = |name: &str| select(name).iter().map(|case| case.name).collect::<Vec<_>>();
        assert_eq!(names("verify/hertz"), ["hertz"]);
        assert_eq!(names("cantilever"), ["cantilever-tip", "cantilever-stocky", "cantilever-shared"]);
        assert!(names("ka4").is_empty());
    }

    /// A cantilever under a spread load converges with order one, and its record is as good as its run.
    #[test]
    fn levels_show_the_order_of_convergence_and_are_kept() {
        let folder = tempfile::tempdir().unwrap();
        let run = || {
            let stop = AtomicBool::new(false);
            study("cantilever-shared", &select("cantilever-shared"), true, folder.path(), false, &stop, &|_| {})
                .unwrap()
        };
        let first = run();
        let orders: Vec<f64> = first.levels().filter_map(|level| level.order).collect();
        assert!(orders.len() >= 2 && orders.iter().all(|order| (order - 1.0).abs() < 0.1), "{orders:?}");
        let second = run();
        assert_eq!((first.made, second.made, second.kept), (1, 0, 1));
        assert_eq!(first.records, second.records);
    }
}
