//! What each factor of a design moves: tables and figures.

use super::super::definition::Definition;
use super::super::quantity::{self, Quantity};
use super::findings::{Findings, Moved, by_points};
use crate::study::plot::{Axis, Figure, Legend, Limit, Mark, Series};
use crate::study::screening::{Effects, Estimate, Interaction, Term};
use crate::study::table::Table;

/// Quantities whose effects are drawn.
const DRAWN: [&str; 2] = ["strength", "elongation"];
/// Size of a figure of effects (px of an SVG).
const SIZE: [u32; 2] = [860, 420];
/// Probability below which a term is told from scatter (-).
const SURE: f64 = 0.05;

/// Which term moves what, the means of all levels, and how effects change with other factors.
pub fn tables(definition: &Definition, findings: &Findings) -> Vec<Table> {
    if findings.effects.is_empty() {
        return Vec::new();
    }
    let mut tables = vec![shares(definition, &findings.effects), means(definition, &findings.effects)];
    let model = definition.model.as_ref().expect("effects come with a model");
    for k in 0..model.interactions.len() {
        tables.push(interaction(definition, &findings.effects, k));
    }
    tables
}

/// Quantities that have effects.
fn found(moved: &[Moved]) -> Vec<(&'static Quantity, &Effects)> {
    let known = moved.iter().filter_map(|one| Some((quantity::find(one.quantity)?, one.effects.as_ref().ok()?)));
    known.collect()
}

fn name(definition: &Definition, factors: &[usize]) -> String {
    factors.iter().map(|f| definition.axes[*f].name.as_str()).collect::<Vec<_>>().join(" × ")
}

/// Share of each term in the variance of each quantity.
fn shares(definition: &Definition, moved: &[Moved]) -> Table {
    let found = found(moved);
    let model = definition.model.as_ref().expect("effects come with a model");
    let cell = |term: Option<&Term>| match term {
        Some(term) if term.p < SURE => format!("{:.1} (p {})", term.share_percent, chance(term.p)),
        Some(term) => format!("{:.1}", term.share_percent),
        None => String::new(),
    };
    let mut rows: Vec<Vec<String>> = model
        .terms()
        .iter()
        .map(|factors| {
            let of = |effects: &Effects| cell(effects.terms.iter().find(|term| term.factors == *factors));
            [name(definition, factors)].into_iter().chain(found.iter().map(|(_, effects)| of(effects))).collect()
        })
        .collect();
    let between = |one: &Moved| match (quantity::find(one.quantity), one.effects.is_ok()) {
        (Some(quantity), true) => Some(match one.seeds_deviation {
            Some(deviation) => format!("{deviation:.*} {}", quantity.decimals.max(1), quantity.unit),
            None => String::new(),
        }),
        _ => None,
    };
    let summary = |words: &str, value: &dyn Fn(&Quantity, &Effects) -> String| {
        [words.to_string()]
            .into_iter()
            .chain(found.iter().map(|(quantity, effects)| value(quantity, effects)))
            .collect()
    };
    rows.push(summary("all terms, R²", &|_, effects| format!("{:.1}", 100.0 * effects.explained)));
    rows.push(summary("left over, standard deviation", &|quantity, effects| {
        format!("{:.*} {}", quantity.decimals.max(1), effects.residual, quantity.unit)
    }));
    let seeds = "from seed to seed, standard deviation".to_string();
    rows.push([seeds].into_iter().chain(moved.iter().filter_map(between)).collect());
    let counted = if by_points(definition, model) { "points" } else { "runs" };
    rows.push(summary(counted, &|_, effects| effects.rows.to_string()));
    let efficiency = definition.efficiency.map_or(String::new(), |e| format!("; D-efficiency of the design {e:.2}"));
    let constant: Vec<String> = moved
        .iter()
        .filter_map(|one| Some(format!("; {}: {}", quantity::find(one.quantity)?.heading, one.effects.as_ref().err()?)))
        .collect();
    Table {
        title: format!(
            "Which mechanism moves what: share of each term in the variance over {counted} [%], with p where it is told \
             from what is left over (p < {SURE}){efficiency}{}",
            constant.concat()
        ),
        heads: ["term".to_string()]
            .into_iter()
            .chain(found.iter().map(|(quantity, _)| quantity.heading.to_string()))
            .collect(),
        rows,
        default: None,
        left: 1,
    }
}

fn chance(p: f64) -> String {
    if p < 1e-3 { "< 0.001".into() } else { format!("{p:.3}") }
}

/// Mean of every level over the levels of all other factors, and its difference from the first.
fn means(definition: &Definition, moved: &[Moved]) -> Table {
    let found = found(moved);
    let mut rows = Vec::new();
    for (f, axis) in definition.axes.iter().enumerate() {
        for (l, level) in axis.levels.iter().enumerate() {
            let cell = |(quantity, effects): &(&Quantity, &Effects)| {
                let factor = effects.factors.iter().find(|factor| factor.factor == f)?;
                let mean = &factor.levels[l];
                let value = format!("{:.*}", quantity.decimals, mean.mean.value);
                Some(match &mean.from_first {
                    Some(difference) => format!("{value} ({})", signed(quantity, difference)),
                    None => value,
                })
            };
            let first = if l == 0 { axis.name.clone() } else { String::new() };
            let cells = found.iter().map(|one| cell(one).unwrap_or_default());
            rows.push([first, level.name.clone()].into_iter().chain(cells).collect());
        }
    }
    Table {
        title: "Mean of each level, averaged over the levels of all others (difference from the first level ± its 95 % interval; * where it is told from zero)".into(),
        heads: ["factor", "level"].map(String::from).into_iter().chain(found.iter().map(|(q, _)| q.label())).collect(),
        rows,
        default: None,
        left: 2,
    }
}

fn signed(quantity: &Quantity, estimate: &Estimate) -> String {
    let decimals = quantity.decimals;
    let star = if estimate.is_told_from_zero() { " *" } else { "" };
    format!("{:+.decimals$} ± {:.decimals$}{star}", estimate.value, estimate.interval_95)
}

/// How the effect of one factor changes with another.
fn interaction(definition: &Definition, moved: &[Moved], k: usize) -> Table {
    let found = found(moved);
    let [of, with] = definition.model.as_ref().expect("effects come with a model").interactions[k];
    let (axis, other) = (&definition.axes[of], &definition.axes[with]);
    let here = |effects: &'_ Effects| -> Option<usize> {
        effects.interactions.iter().position(|one: &Interaction| (one.of, one.with) == (of, with))
    };
    let mut rows = Vec::new();
    for l in 1..axis.levels.len() {
        for (at, level) in other.levels.iter().enumerate() {
            let cell = |(quantity, effects): &(&Quantity, &Effects)| {
                let one = &effects.interactions[here(effects)?];
                let found = one.effects.iter().find(|effect| (effect.level, effect.at) == (l, at))?;
                Some(signed(quantity, &found.effect))
            };
            let change = format!("{} instead of {}", axis.levels[l].name, axis.levels[0].name);
            let cells = found.iter().map(|one| cell(one).unwrap_or_default());
            let first = if at == 0 { change } else { String::new() };
            rows.push([first, level.name.clone()].into_iter().chain(cells).collect());
        }
    }
    Table {
        title: format!(
            "Effect of {} at each level of {} (± its 95 % interval; * where it is told from zero)",
            axis.name, other.name
        ),
        heads: [axis.name.clone(), other.name.clone()]
            .into_iter()
            .chain(found.iter().map(|(q, _)| q.label()))
            .collect(),
        rows,
        default: None,
        left: 2,
    }
}

/// Means of all levels, and the effect of the first factor at each level of the others, of strength and elongation.
pub fn figures(definition: &Definition, findings: &Findings) -> Vec<(&'static str, Vec<Figure>)> {
    let found = found(&findings.effects);
    let drawn: Vec<_> = found.iter().filter(|(quantity, _)| DRAWN.contains(&&*quantity.name)).collect();
    if drawn.is_empty() {
        return Vec::new();
    }
    let mut sheets =
        vec![("effects", drawn.iter().map(|(quantity, effects)| levels(definition, quantity, effects)).collect())];
    let trends: Vec<Figure> =
        drawn.iter().filter_map(|(quantity, effects)| trend(definition, quantity, effects)).collect();
    if !trends.is_empty() {
        sheets.push(("interactions", trends));
    }
    sheets
}

/// Means of the levels of all factors, side by side.
fn levels(definition: &Definition, quantity: &Quantity, effects: &Effects) -> Figure {
    let mut names = Vec::new();
    let mut series = Vec::new();
    for factor in &effects.factors {
        let axis = &definition.axes[factor.factor];
        let (mut points, mut errors) = (Vec::new(), Vec::new());
        for level in &factor.levels {
            points.push([names.len() as f64, level.mean.value]);
            errors.push(level.mean.interval_95);
            names.push(axis.levels[level.level].name.clone());
        }
        series.push(Series::new(axis.name.clone(), Mark::LineAndPoints, points).with_errors(errors));
    }
    let title = format!("{}: {}, mean of each level over all others", definition.name, quantity.heading);
    let mut figure = Figure::new(title, Axis::named("", names), Axis::linear(quantity.label()));
    figure.series = series;
    figure.legend = Legend::Beside;
    figure.size = [SIZE[0] + 360, SIZE[1]];
    figure
}

/// Effect of the first factor at each level of those that it interacts with; `None` when there are none, or it has more
/// than two levels.
fn trend(definition: &Definition, quantity: &Quantity, effects: &Effects) -> Option<Figure> {
    let axis = definition.axes.first().filter(|axis| axis.levels.len() == 2)?;
    let (mut names, mut series) = (Vec::new(), Vec::new());
    for one in effects.interactions.iter().filter(|one| one.of == 0) {
        let other = &definition.axes[one.with];
        let (mut points, mut errors) = (Vec::new(), Vec::new());
        for effect in &one.effects {
            points.push([names.len() as f64, effect.effect.value]);
            errors.push(effect.effect.interval_95);
            names.push(other.levels[effect.at].name.clone());
        }
        series.push(Series::new(other.name.clone(), Mark::LineAndPoints, points).with_errors(errors));
    }
    if series.is_empty() {
        return None;
    }
    let [first, second] = [0, 1].map(|k: usize| &axis.levels[k].name);
    let title = format!("{}: {} at {} {second} less {first}", definition.name, quantity.heading, axis.name);
    let label = format!("change of {} [{}]", quantity.heading, quantity.unit);
    let mut figure = Figure::new(title, Axis::named("", names), Axis::linear(label));
    figure.series = series;
    figure.limits.push(Limit { y: 0.0, name: String::new() });
    figure.legend = Legend::Beside;
    figure.size = [SIZE[0] + 360, SIZE[1]];
    Some(figure)
}
