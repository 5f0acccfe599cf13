//! Scenes with a closed form of their own: the verification cases. What they vary, how fast their error falls, and what
//! each level takes.

use crate::base::error::Result;
use crate::engine::REVISION;
use crate::observe::files::write_whole;
use crate::run::DeviceChoice;
use crate::run::build::build;
use crate::study::column::{self, Column};
use crate::study::plot::{self, Axis, Figure, Legend, Mark, Series, Slope};
use crate::study::runner::{Case, CaseRunner, CaseStore, Identity, Status};
use crate::study::table::Table;
use crate::study::verify::comparison::{Comparison, Convergence};
use crate::study::verify::{self, CASES, Effort, run_one};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Width and height of each figure (px of an SVG).
const SIZE: [u32; 2] = [760, 480];

/// The verification cases that a name means: `hertz`, `verify/hertz`, or the beginning of several, `cantilever`.
pub fn select(name: &str) -> Vec<&'static verify::VerificationCase> {
    let name = name.strip_prefix("verify/").unwrap_or(name);
    let exact = CASES.iter().filter(|case| case.name == name);
    let family = format!("{name}-");
    let mut cases: Vec<&verify::VerificationCase> = exact.collect();
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
    /// Steps of all runs behind the level.
    pub steps: u64,
    /// Wall time (s).
    pub wall_s: f64,
}

/// What a verification case gave, level by level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseLevels {
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

/// A verification case whose levels are kept.
struct KeptCase<'a> {
    case: &'static verify::VerificationCase,
    effort: Effort,
    store: &'a CaseStore,
    identity: Identity,
}

impl Case for KeptCase<'_> {
    type Output = CaseLevels;

    fn name(&self) -> String {
        self.case.name.into()
    }

    fn kept(&self) -> Option<CaseLevels> {
        self.store.find(&self.identity).map(|record| record.result)
    }

    fn run(&self, stop: &AtomicBool) -> Result<CaseLevels> {
        let verify::VerificationCase { name, about, source, .. } = self.case;
        let (levels, failed) = match run_one(self.case, self.effort, &DeviceChoice::Processor, stop)?.result {
            Ok(comparisons) => (comparisons.iter().flat_map(|found| levels(self.case, found)).collect(), None),
            Err(error) => (Vec::new(), Some(error.to_string())),
        };
        let [case, about, source] = [name, about, source].map(|text| text.to_string());
        let result = CaseLevels { case, about, source, levels, failed };
        self.store.keep(&self.identity, "case.txt", result).map(|record| record.result)
    }
}

/// What a study of verification cases found.
pub struct Verified {
    /// What the user called it.
    pub name: String,
    /// Case by case.
    pub cases: Vec<CaseLevels>,
    /// Cases that were there from before.
    pub kept: usize,
    /// Whether the user stopped it.
    pub interrupted: bool,
}

/// Runs `cases`; those that are kept in `store` are not run again.
///
/// # Errors
/// When the folder cannot be written.
pub fn study(
    name: &str,
    cases: &[&'static verify::VerificationCase],
    effort: Effort,
    store: &CaseStore,
    runner: &CaseRunner,
) -> Result<Verified> {
    let build = build();
    let kept_case = |case: &&'static verify::VerificationCase| {
        // A case is code, scenes and options included, so another build may be another case.
        let definition = format!("verification case {}, {effort:?}, build {build}", case.name);
        KeptCase { case, effort, store, identity: Identity::new(definition, Some(1), false) }
    };
    let statuses = runner.run(&cases.iter().map(kept_case).collect::<Vec<_>>())?;
    Ok(Verified {
        name: name.into(),
        cases: statuses.iter().filter_map(Status::output).cloned().collect(),
        kept: statuses.iter().filter(|status| matches!(status, Status::Kept(_))).count(),
        interrupted: statuses.iter().any(|status| matches!(status, Status::Interrupted)),
    })
}

/// The levels of a finding: one for each resolution, or one alone.
fn levels(case: &verify::VerificationCase, finding: &Comparison) -> Vec<Level> {
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
        self.cases.iter().flat_map(|case| &case.levels)
    }

    /// The levels for people.
    pub fn table(&self) -> Table {
        let levels: Vec<&Level> = self.levels().collect();
        let mut table = column::table(
            format!("{}: error against run time, closed forms as references", self.name),
            &columns(),
            &levels,
            2,
        );
        // Case and quantity stand in the first of their rows.
        for (k, pair) in levels.windows(2).enumerate().rev() {
            if (&pair[0].case, &pair[0].quantity) == (&pair[1].case, &pair[1].quantity) {
                table.rows[k + 1][..2].fill(String::new());
            }
        }
        table
    }

    /// Writes `accuracy.csv`, `accuracy.json` and, where something was varied, `accuracy.svg` and `accuracy.png`. Gives
    /// the files.
    ///
    /// # Errors
    /// When the folder cannot be written.
    pub fn write(&self, command: &str, folder: &Path) -> Result<Vec<PathBuf>> {
        let mut files = vec![folder.join("accuracy.csv"), folder.join("accuracy.json")];
        column::write_csv(&columns(), &self.levels().collect::<Vec<_>>(), &files[0])?;
        let document = serde_json::json!({
            "scene": self.name,
            "command": command,
            "physics": REVISION,
            "interrupted": self.interrupted,
            "reference": { "kind": "closed-form" },
            "cases": self.cases,
            "summary": self.summary(),
            "tables": [self.table()],
        });
        let text = serde_json::to_string_pretty(&document).expect("the study holds nothing that JSON lacks");
        write_whole(&files[1], &(text + "\n"))?;
        let figures = self.figures();
        if !figures.is_empty() {
            files.extend(plot::write_pair(&figures, 1, folder, "accuracy")?);
        }
        Ok(files)
    }

    /// What the cases are compared with, and what failed.
    pub fn summary(&self) -> String {
        let mut text = String::new();
        for record in &self.cases {
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
        for record in &self.cases {
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

/// The columns of a level, in files and for people.
fn columns<'a>() -> Vec<Column<'static, &'a Level>> {
    let resolution = |level: &&Level| match (level.resolution, &level.axis) {
        (Some(resolution), Some(axis)) => format!("{axis} = {resolution:.4}"),
        _ => String::new(),
    };
    vec![
        Column::new("case", "case", "", 0, |level: &&'a Level| &*level.case),
        Column::new("quantity", "quantity", "", 0, |level: &&'a Level| &*level.quantity),
        Column::in_files("axis", |level: &&'a Level| level.axis.as_deref()),
        Column::new("resolution", "resolution", "", 4, |level: &&'a Level| level.resolution).shown_as(resolution),
        Column::new("wall_s", "run time", "s", 3, |level: &&'a Level| level.wall_s),
        Column::new("steps", "steps", "", 0, |level: &&'a Level| level.steps),
        Column::new("ms_per_step", "ms/step", "", 4, |level: &&'a Level| {
            (level.steps > 0).then(|| 1e3 * level.wall_s / level.steps as f64)
        }),
        Column::new("error_percent", "error", "%", 4, |level: &&'a Level| level.error_percent)
            .shown_as(|level: &&Level| level.error_percent.map_or("not a number".into(), percent)),
        Column::new("order", "order", "-", 2, |level: &&'a Level| level.order),
        Column::new("order_theory", "theory", "-", 2, |level: &&'a Level| level.order_theory),
    ]
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
        let store = CaseStore::open(folder.path(), false).unwrap();
        let stop = AtomicBool::new(false);
        let runner = CaseRunner { jobs: 1, threads: Some(1), budget: None, stop: &stop, tell: &|_| {} };
        let cases = select("cantilever-shared");
        let run = || study("cantilever-shared", &cases, Effort::Quick, &store, &runner).unwrap();
        let first = run();
        let orders: Vec<f64> = first.levels().filter_map(|level| level.order).collect();
        assert!(orders.len() >= 2 && orders.iter().all(|order| (order - 1.0).abs() < 0.1), "{orders:?}");
        let second = run();
        assert_eq!((first.kept, second.kept), (0, 1));
        assert_eq!(first.cases, second.cases);
    }
}
