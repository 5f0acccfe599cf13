//! Tables beside the paper and strand theory.

use super::super::beside::{PointBeside, QUANTITIES, Trend};
use super::super::definition::Definition;
use super::Findings;
use crate::study::cases::stat::Stat;
use crate::study::table::Table;

/// Ours beside the paper's and theory's, point by point, and the trends; empty when the study compares with nothing.
pub fn tables(definition: &Definition, findings: &Findings) -> Vec<Table> {
    let known = findings.beside.iter().any(|beside| beside.paper.is_some() || beside.theory.is_some());
    if !known {
        return Vec::new();
    }
    let mut tables = vec![values(definition, &findings.beside)];
    if !findings.trends.is_empty() {
        tables.push(trends(definition, &findings.trends));
    }
    tables
}

fn values(definition: &Definition, beside: &[PointBeside]) -> Table {
    let axes = definition.axes.iter().map(|axis| axis.label());
    let of = |name: &str, unit: &str| {
        [
            format!("{name} [{unit}]"),
            format!("paper [{unit}]"),
            "off by [%]".into(),
            format!("theory [{unit}]"),
            "off by [%]".into(),
        ]
    };
    let heads = axes.chain(of(QUANTITIES[0], "MPa")).chain(of(QUANTITIES[1], "%"));
    let row = |beside: &PointBeside| {
        let mut cells: Vec<String> = definition.levels(beside.point).map(|(_, level)| level.name.clone()).collect();
        for k in 0..QUANTITIES.len() {
            let value = |other: Option<[f64; 2]>| other.map_or(String::new(), |other| format!("{:.2}", other[k]));
            let error = |other| beside.error(k, other).map_or(String::new(), |error| format!("{error:+.2}"));
            cells.extend([
                beside.ours[k].map_or(String::new(), with_interval),
                value(beside.paper),
                error(beside.paper),
                value(beside.theory),
                error(beside.theory),
            ]);
        }
        cells
    };
    Table {
        title: "Beside the paper's simulations and strand theory, both engine and theory calibrated on the experiment at 39 mm"
            .into(),
        heads: heads.collect(),
        rows: beside.iter().map(row).collect(),
        default: None,
        left: definition.axes.len(),
    }
}

fn trends(definition: &Definition, trends: &[Trend]) -> Table {
    let axis = definition.abscissa().expect("trends run over an axis");
    let heads = ["quantity", "this engine", "paper", "strand theory", "same sign as the paper", "as theory"];
    let row = |trend: &Trend| {
        let value = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:+.2}"));
        let ours = match trend.interval_95 {
            Some(half) => format!("{:+.2} ± {half:.2}", trend.ours),
            None => format!("{:+.2}", trend.ours),
        };
        vec![
            trend.quantity.to_string(),
            ours,
            value(trend.paper),
            value(trend.theory),
            verdict(trend, trend.paper),
            verdict(trend, trend.theory),
        ]
    };
    Table {
        title: format!(
            "From {} {} to {}: change of strength [MPa] and elongation [points]",
            axis.name,
            axis.levels[0].name,
            axis.levels[axis.levels.len() - 1].name
        ),
        heads: heads.map(String::from).to_vec(),
        rows: trends.iter().map(row).collect(),
        default: None,
        left: 1,
    }
}

/// Whether a trend has another's sign; a trend within its own interval of zero has none.
fn verdict(trend: &Trend, other: Option<f64>) -> String {
    let Some(other) = other else { return String::new() };
    match trend.interval_95 {
        Some(half) if trend.ours.abs() <= half => "within scatter of none".into(),
        _ if trend.ours * other > 0.0 => "yes".into(),
        _ => "no".into(),
    }
}

fn with_interval(stat: Stat) -> String {
    match stat.interval_95 {
        Some(half) => format!("{:.2} ± {half:.2}", stat.mean),
        None => format!("{:.2}", stat.mean),
    }
}
