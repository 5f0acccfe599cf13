//! Tables for people.

use super::super::Cost;
use super::super::breaks;
use super::super::definition::Definition;
use super::super::gather::{CaseResult, Gathered, construction};
use super::super::quantity::{self, Quantity};
use crate::base::wording::counted;
use crate::study::statistics::Statistics;
use crate::study::table::Table;
use crate::study::tensile::TensileResult;
use std::fmt::Write;

/// All cases with what they are expected to take.
pub fn case_list(definition: &Definition, gathered: &Gathered, costs: &[Cost]) -> Table {
    let axes = definition.axes.iter().map(|axis| axis.label());
    let heads = ["case"].map(String::from).into_iter().chain(axes);
    let heads = heads.chain(["seed", "state", "one thread [s]", "folder"].map(String::from));
    let row = |(case, cost): (&CaseResult, &Cost)| {
        let mut cells = vec![case.number.to_string()];
        cells.extend(level_names(definition, case.point));
        let takes = match cost {
            Cost::Takes(seconds) => format!("{seconds:.0}"),
            Cost::Done | Cost::Unknown => String::new(),
        };
        cells.extend([case.seed.to_string(), case.word().into(), takes, case.folder.clone()]);
        cells
    };
    Table {
        title: format!("{}: {}", definition.name, definition.about),
        heads: heads.collect(),
        rows: gathered.cases.iter().zip(costs).map(row).collect(),
        default: None,
        left: 1 + definition.axes.len(),
    }
}

/// What strands the points are made of: one line when they are all alike.
pub fn built(definition: &Definition, gathered: &Gathered) -> String {
    let all: Vec<(usize, String)> = (0..definition.points.len())
        .filter_map(|point| Some((point, construction(gathered.spec(point)?))))
        .filter(|(_, built)| !built.is_empty())
        .collect();
    let Some((_, first)) = all.first() else { return String::new() };
    if all.iter().all(|(_, built)| built == first) {
        return format!("Built: {first}.\n");
    }
    let line = |(point, built): &(usize, String)| format!("  {}: {built}\n", definition.point_name(*point));
    "Built:\n".to_string() + &all.iter().map(line).collect::<String>()
}

/// Means over seeds, point by point.
pub fn means(definition: &Definition, gathered: &Gathered) -> Table {
    let axes = definition.axes.iter().map(|axis| axis.label());
    let heads = axes.chain(["runs".to_string()]);
    let head = |quantity: &&'static Quantity| match quantity::is_frequency(quantity) {
        true => format!("{} [runs]", quantity.heading),
        false => quantity.label(),
    };
    let heads = heads.chain(definition.quantities.iter().map(head));
    let row = |point: usize| {
        let mut cells = level_names(definition, point);
        cells.push(gathered.runs(point).count().to_string());
        cells.extend(
            definition.quantities.iter().map(|quantity| with_interval(gathered.stat(point, quantity), quantity)),
        );
        cells
    };
    Table {
        title: "Means over seeds, ± the 95 % interval of the mean (± standard deviation in brackets)".into(),
        heads: heads.collect(),
        rows: (0..definition.points.len()).map(row).collect(),
        default: None,
        left: definition.axes.len(),
    }
}

/// Which layer breaks first, as frequencies over seeds and, below several points, over all of them.
pub fn breaks(definition: &Definition, gathered: &Gathered) -> Table {
    let axes = definition.axes.iter().map(|axis| axis.label());
    let heads = axes.chain(
        [
            "layer",
            "broke first [runs]",
            "order: 1st / 2nd / … / never [runs]",
            "wires broken [%]",
            "first break in the middle third [runs]",
            "from mid-length [mm]",
        ]
        .map(String::from),
    );
    let mut rows = Vec::new();
    for point in 0..definition.points.len() {
        let runs = gathered.runs(point).count();
        for (k, layer) in breaks::layers(gathered, point).iter().enumerate() {
            let names = level_names(definition, point);
            let mut cells = if k == 0 { names } else { vec![String::new(); names.len()] };
            let order: Vec<String> = layer.places.iter().chain([&layer.never]).map(usize::to_string).collect();
            let broke = runs - layer.never;
            cells.extend([
                format!("{} ({})", layer.layer, counted(layer.wires, "wire")),
                format!("{} of {runs}", layer.places[0]),
                order.join(" / "),
                mean(layer.broken_percent, 0),
                format!("{} of {broke}", layer.middle_third),
                mean(layer.off_middle_mm, 1),
            ]);
            rows.push(cells);
        }
    }
    Table {
        title: "Which layer breaks first, in which order the others follow, and where".into(),
        heads: heads.collect(),
        rows,
        default: None,
        left: 1 + definition.axes.len(),
    }
}

/// How often what the paper reports happens, over all runs of the study, in a sentence; empty when nothing broke.
pub fn frequencies(gathered: &Gathered) -> String {
    let runs: Vec<&TensileResult> = gathered.cases.iter().filter_map(CaseResult::result).collect();
    let broken: Vec<&&TensileResult> =
        runs.iter().filter(|run| !run.breaks.is_empty() && run.layers.len() > 1).collect();
    if broken.is_empty() {
        return String::new();
    }
    let count = |holds: &dyn Fn(&TensileResult) -> bool| broken.iter().filter(|run| holds(run)).count();
    let first = |wanted: &dyn Fn(usize, usize) -> bool| {
        count(&|run| quantity::first_layer(run).is_some_and(|layer| wanted(layer, run.layers.len() - 1)))
    };
    let middle = |run: &TensileResult| {
        let off = quantity::off_middle(run, run.breaks[0].rest_z_mm);
        off.zip(run.gauge_mm).is_some_and(|(off, [lower, upper])| off.abs() <= (upper - lower) / 6.0)
    };
    let (outer, below) = (quantity::outer_broken, quantity::below_broken);
    format!(
        "Over {} in which wires of several layers broke, the first was in the outermost layer in {}, in the innermost in \
         {}, between in {}; in the middle third of the gauge in {}. At their ends all outer wires were broken in {}, all \
         wires below them in {}, all outer ones with some below still whole in {}, and some outer ones whole with all below \
         broken in {}.\n",
        counted(broken.len(), "run"),
        first(&|layer, last| layer == last),
        first(&|layer, _| layer == 0),
        first(&|layer, last| layer > 0 && layer < last),
        count(&middle),
        count(&|run| outer(run) == Some(100.0)),
        count(&|run| below(run) == Some(100.0)),
        count(&|run| outer(run) == Some(100.0) && below(run) < Some(100.0)),
        count(&|run| outer(run) < Some(100.0) && below(run) == Some(100.0)),
    )
}

/// Cases that failed, with their causes, and how many there are of each kind.
pub fn state(definition: &Definition, gathered: &Gathered) -> String {
    let mut text = String::new();
    for case in &gathered.cases {
        if let Some(cause) = case.cause() {
            let name = definition.case_name(case.point, case.seed);
            let _ = writeln!(text, "case {} ({name}) {}: {cause}", case.number, case.word());
        }
    }
    let count = |word: &str| gathered.cases.iter().filter(|case| case.word() == word).count();
    let kinds: Vec<String> =
        [("ran", "ran"), ("failed", "failed"), ("refused", "have scenes that are refused"), ("missing", "are missing")]
            .iter()
            .filter(|(word, _)| count(word) > 0)
            .map(|(word, words)| format!("{} {words}", count(word)))
            .collect();
    let _ = writeln!(
        text,
        "{} at {} quality: {}.",
        counted(gathered.cases.len(), "case"),
        definition.quality.word(),
        kinds.join(", ")
    );
    if gathered.cases.iter().any(|case| case.outcome.is_none()) {
        let _ = writeln!(
            text,
            "What is missing is made by the same command without --collect, or case by case with --case."
        );
    }
    if gathered.other_build > 0 {
        let _ = writeln!(
            text,
            "Run by another build with the same physics, until --fresh: {}.",
            counted(gathered.other_build, "case")
        );
    }
    text
}

fn level_names(definition: &Definition, point: usize) -> Vec<String> {
    definition.levels(point).map(|(_, level)| level.name.clone()).collect()
}

fn mean(stat: Option<Statistics>, decimals: usize) -> String {
    stat.map_or(String::new(), |stat| format!("{:.decimals$}", stat.mean))
}

fn with_interval(stat: Option<Statistics>, quantity: &Quantity) -> String {
    let Some(stat) = stat else { return String::new() };
    if quantity::is_frequency(quantity) {
        return format!("{:.0} of {}", 0.01 * stat.mean * stat.count as f64, stat.count);
    }
    stat.within(quantity::limits(quantity), quantity.decimals)
}
