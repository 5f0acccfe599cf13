//! The study as people read it: two tables and what stands around them.

use super::columns::{MeanColumn, named, signed};
use super::ensemble::{self, QUANTITIES, Quantity};
use super::errors::Errors;
use super::findings::{Reference, Study};
use super::reference::{Along, refined_parameters};
use super::rows::{Row, RunStatus};
use super::subject::Subject;
use crate::base::wording::counted;
use crate::study::statistics::Statistics;
use crate::study::table::Table;
use crate::study::tensile::TensileResult;
use std::fmt::Write;

/// Columns of text at the left: parameter and value.
const LEFT: usize = 2;

/// What was asked of each row, and what it costs.
pub fn costs_and_errors(study: &Study) -> Table {
    let columns = [
        "wall_s",
        "cpu_s",
        "steps",
        "ms_per_step",
        "strength_mpa",
        "strength_error_percent",
        "elongation_percent",
        "elongation_error_percent",
        "curve_error_percent",
    ];
    table("Error against run time", study, &[], columns.map(named).as_slice(), Some("note"), |row| {
        (Vec::new(), note(study, row))
    })
}

/// What must be known of a row, scatter included.
fn note(study: &Study, row: &Row) -> String {
    let scatter = if study.scatter && !study.reference.closed_form {
        ensemble::note(row, study.seeds.len())
    } else {
        String::new()
    };
    [row.note(), scatter].into_iter().filter(|note| !note.is_empty()).collect::<Vec<_>>().join("; ")
}

/// The spread over seeds in per cent of the mean, and how it changes against the scene as it stands.
fn spread(study: &Study, row: &Row, quantity: &Quantity) -> String {
    let base = study.rows.iter().find(|row| row.parameter.is_none());
    let Some(spread) = base.and_then(|base| ensemble::spread(row, base, quantity)) else { return String::new() };
    match (row.parameter.is_some().then_some(spread.change_percent).flatten(), spread.told) {
        (Some(change), Some(true)) => format!("{:.2} ({change:+.0} %)", spread.percent),
        (Some(change), Some(false)) => format!("{:.2} ({change:+.0} %, not told)", spread.percent),
        _ => format!("{:.2}", spread.percent),
    }
}

/// What else went otherwise, and whether the run may be believed.
pub fn histories_and_checks(study: &Study) -> Table {
    let heads = ["spread of strength [%]", "of elongation [%]", "worst layer [%]", "first break"];
    let columns = [
        "plastic_work_error_percent",
        "order_tau",
        "energy_residual_percent",
        "kinetic_over_internal",
        "grip_mismatch_percent",
    ];
    let layers = study.layers();
    let title = "What else differs from the reference, and whether loading was quasi-static";
    table(title, study, &heads, columns.map(named).as_slice(), None, |row| {
        let spreads = QUANTITIES.each_ref().map(|quantity| spread(study, row, quantity));
        let cells = spreads.into_iter().chain([worst_layer(row, &layers), first_break(row)]);
        (cells.collect(), String::new())
    })
}

/// A table of the rows that were run: parameter and value, `heads` with the cells that `more` gives, `columns`, and the note that
/// it gives under the head `note`.
fn table(
    title: &str,
    study: &Study,
    heads: &[&str],
    columns: &[&MeanColumn],
    note: Option<&str>,
    more: impl Fn(&Row) -> (Vec<String>, String),
) -> Table {
    let mut last = None;
    // What was not run is told below the tables.
    let shown = || study.rows.iter().filter(|row| !row.is_missing());
    let rows = shown().map(|row| {
        let (parameter, value) = match &row.parameter {
            None => ("the scene as it stands".into(), String::new()),
            Some(parameter) if last == Some(parameter.name) => (String::new(), row.value.clone()),
            Some(parameter) => (format!("{} ({})", parameter.name, parameter.default), row.value.clone()),
        };
        last = row.parameter.as_ref().map(|parameter| parameter.name);
        let (cells, said) = more(row);
        let numbers = columns.iter().map(|column| column.cell(row));
        [parameter, value].into_iter().chain(cells).chain(numbers).chain(note.map(|_| said)).collect()
    });
    let default = shown().position(|row| row.parameter.is_none());
    let of_columns = columns.iter().map(|one| one.column.label());
    let heads = ["parameter (scene has)", "value"].iter().chain(heads).map(|head| head.to_string());
    let heads = heads.chain(of_columns).chain(note.map(str::to_owned));
    Table { title: title.into(), heads: heads.collect(), rows: rows.collect(), default, left: LEFT }
}

/// The layer whose mean error over seeds is greatest.
fn worst_layer(row: &Row, layers: &[String]) -> String {
    let of_layer = |k: usize| row.of_errors(|errors| errors.layers_percent.get(k).copied().flatten());
    let known = (0..layers.len()).filter_map(|k| Some((k, of_layer(k)?)));
    let worst = known.max_by(|a, b| a.1.mean.total_cmp(&b.1.mean));
    worst.map_or(String::new(), |(k, stat)| format!("{:.3} {}", stat.mean, layers[k]))
}

fn first_break(row: &Row) -> String {
    let known: Vec<&Errors> =
        row.ran().filter_map(|run| run.errors.as_ref()).filter(|errors| errors.same_first_wire.is_some()).collect();
    match &known[..] {
        [] => String::new(),
        [one] => {
            let place = one.first_break_off_mm.map_or(String::new(), |off| match format!("{off:+.1}").as_str() {
                "+0.0" | "-0.0" => ", same place".into(),
                off => format!(", {off} mm"),
            });
            let wire = if one.same_first_wire == Some(true) { "same wire" } else { "other wire" };
            format!("{wire}{place}")
        }
        several => {
            let same = several.iter().filter(|errors| errors.same_first_wire == Some(true)).count();
            format!("{same} of {} same wire", several.len())
        }
    }
}

/// The parameters of a scene, what each trades and its values, and the parameters that it has not.
pub fn list(subject: &Subject) -> String {
    let mut text = String::new();
    for varied in &subject.varied {
        let variation = &varied.variation;
        let values: Vec<&str> = variation.levels.iter().map(|level| level.value.shown.as_str()).collect();
        let _ = writeln!(text, "{:16}{}", varied.parameter.name, varied.parameter.trades);
        let _ = writeln!(text, "{:16}{}: {}", "", varied.parameter.key, variation.role.word());
        let _ =
            writeln!(text, "{:16}{} as the scene stands; would try {}", "", variation.base.shown, values.join(" | "));
    }
    for (parameter, reason) in &subject.absent {
        let _ = writeln!(text, "{parameter:16}not here: {reason}");
    }
    text
}

/// What scatter leaves open of the study, in a sentence; `None` where there is none.
pub fn scatter(study: &Study) -> Option<String> {
    if !study.scatter || study.reference.closed_form {
        return None;
    }
    if let [seed] = study.seeds[..] {
        return Some(format!(
            "One draw of the scatter (seed {seed}): a difference of strength, elongation or first wire may be another draw's \
             as well; --seeds judges means and spread."
        ));
    }
    let [strength, elongation] = study.reference.over_seeds;
    let words = |stat: Option<Statistics>| {
        let (half, deviation) = stat.and_then(|stat| stat.interval_95.zip(stat.standard_deviation))?;
        let mean = stat?.mean;
        Some(format!("{:.2} % (standard deviation {:.2} %)", 100.0 * half / mean, 100.0 * deviation / mean))
    };
    Some(format!(
        "Errors are those of the mean over {} seeds, the same in every row, ± 95 %; what lies within that is not told from \
         scatter. The mean over strands of all seeds is known to ± {} in strength and ± {} in elongation.",
        study.seeds.len(),
        words(strength)?,
        words(elongation)?
    ))
}

/// What the runs are compared with.
pub fn reference(reference: &Reference, seeds: usize) -> String {
    let Reference { words, value, refined, uncertainty_percent: sure, closed_form, .. } = reference;
    let mean = if seeds > 1 { format!(", mean of {seeds} seeds") } else { String::new() };
    let mut text = format!("Reference: {words}.\n");
    if *closed_form {
        let _ = writeln!(text, "  strength {:.3} MPa, elongation {:.4} %{mean}, exact", value[0], value[1]);
        let off = [0, 1].map(|k| 100.0 * (refined[k] / value[k] - 1.0));
        if !reference.along.is_empty() {
            let _ = writeln!(
                text,
                "  refinement alone would have given {:.3} MPa ({:+.3} % off, {:.3} % believed) and {:.4} % ({:+.3} % off, \
                 {:.3} % believed)",
                refined[0], off[0], sure[0], refined[1], off[1], sure[1]
            );
        }
    } else {
        let _ = writeln!(
            text,
            "  strength {:.3} MPa ± {:.3} %, elongation {:.4} % ± {:.3} %{mean}",
            value[0], sure[0], value[1], sure[1]
        );
    }
    for line in along(&reference.along) {
        let _ = writeln!(text, "  {line}");
    }
    text
}

/// What refinement along each parameter adds, mean over seeds.
fn along(all: &[(u64, Along)]) -> Vec<String> {
    let parameters = refined_parameters(all);
    let line = |parameter: &&str| {
        let here = || all.iter().map(|(_, along)| along).filter(|along| along.parameter == *parameter);
        let stat = |value: &dyn Fn(&Along) -> f64| Statistics::of(&here().map(value).collect::<Vec<_>>());
        let orders = |k: usize| {
            let known: Vec<f64> = here().filter_map(|along| along.order[k]).collect();
            match Statistics::of(&known) {
                Some(order) if known.len() == here().count() => format!("order {:.2}", order.mean),
                Some(order) => {
                    format!("order {:.2} in {} of {}", order.mean, known.len(), counted(here().count(), "seed"))
                }
                None => "no order observed".into(),
            }
        };
        let quantity = |name: &str, k: usize| {
            let means = [stat(&|along| along.correction_percent[k]), stat(&|along| along.uncertainty_percent[k])];
            let [correction, sure] = means.map(|stat| stat.map_or(0.0, |stat| stat.mean));
            // Neither shows in three decimals.
            if correction.abs().max(sure) < 5e-4 {
                return format!("{name} unchanged");
            }
            let interval = means[0].and_then(|stat| stat.interval_95);
            let correction = signed(correction) + &interval.map_or(String::new(), |half| format!(" ± {half:.3}"));
            let sure = format!("{sure:.3}");
            format!("{name} {correction} % (uncertain by {sure} %, {})", orders(k))
        };
        format!("towards the limit in {parameter}: {}, {}", quantity("strength", 0), quantity("elongation", 1))
    };
    parameters.iter().map(line).collect()
}

/// What was not run because the budget had no room for it, parameter by parameter, with what it would have taken.
pub fn left_out(study: &Study) -> Vec<String> {
    let mut by_parameter: Vec<(&str, Vec<String>, f64)> = Vec::new();
    for row in &study.rows {
        let parameter = row.parameter.as_ref().map_or("", |parameter| parameter.name);
        for run in &row.runs {
            let RunStatus::LeftOut(seconds) = run.outcome else { continue };
            let seed = if study.seeds.len() > 1 { format!(" (seed {})", run.seed) } else { String::new() };
            let value = format!("{}{seed}", row.value);
            match by_parameter.last_mut().filter(|(last, ..)| *last == parameter) {
                Some((_, values, sum)) => {
                    values.push(value);
                    *sum += seconds;
                }
                None => by_parameter.push((parameter, vec![value], seconds)),
            }
        }
    }
    let line = |(parameter, values, sum): (&str, Vec<String>, f64)| {
        format!("{parameter}: {} (about {sum:.0} s)", values.join(" | "))
    };
    by_parameter.into_iter().map(line).collect()
}

/// What failed, with its cause.
pub fn failed(study: &Study) -> Vec<String> {
    let of_row = |row: &Row| {
        let parameter = row.parameter.as_ref().map_or("the scene as it stands", |parameter| parameter.name).to_string();
        let value = row.value.clone();
        let failed: Vec<(u64, String)> =
            row.runs.iter().filter_map(|run| Some((run.seed, run.cause()?.to_owned()))).collect();
        failed.into_iter().map(move |(seed, cause)| format!("{parameter} {value} failed: {cause} (seed {seed})"))
    };
    study.rows.iter().flat_map(of_row).collect()
}

/// What must be known of the run times; `None` when there is nothing.
pub fn caution(study: &Study) -> Option<String> {
    let starved =
        |run: &TensileResult| study.threads == 1 && run.cpu_s.is_some_and(|cpu| cpu < LEAST_SHARE * run.wall_s);
    let runs = || study.rows.iter().flat_map(|row| row.ran().map(|run| &*run.result));
    let count = runs().filter(|run| starved(run)).count();
    (count > 0).then(|| {
        format!(
            "The machine was busy: {count} of {} runs got less than {:.0} % of a core, so their run times say little; \
             the plot shows processor time.",
            runs().count(),
            100.0 * LEAST_SHARE
        )
    })
}

/// Processor time over run time on one thread below which the machine was busy with something else (-).
const LEAST_SHARE: f64 = 0.9;
