//! Tables of the comparison with published results and strand theory.

use super::super::comparison::{PointComparison, QUANTITIES, Trend};
use super::super::definition::Definition;
use super::findings::Findings;
use crate::study::table::Table;

/// Computed values beside published ones and theory's, point by point, and the trends; empty when the study compares with
/// nothing.
pub fn tables(definition: &Definition, findings: &Findings) -> Vec<Table> {
    let known = findings.comparison.iter().any(|one| one.simulation.is_some() || one.theory.is_some());
    if !known {
        return Vec::new();
    }
    let mut tables = vec![values(definition, &findings.comparison)];
    if !findings.trends.is_empty() {
        tables.push(trends(definition, &findings.trends));
    }
    tables
}

fn values(definition: &Definition, points: &[PointComparison]) -> Table {
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
    let row = |one: &PointComparison| {
        let mut cells: Vec<String> = definition.levels(one.point).map(|(_, level)| level.name.clone()).collect();
        for k in 0..QUANTITIES.len() {
            let value = |other: Option<[f64; 2]>| other.map_or(String::new(), |other| format!("{:.2}", other[k]));
            let error = |other| one.error(k, other).map_or(String::new(), |error| format!("{error:+.2}"));
            cells.extend([
                one.computed[k].map_or(String::new(), |stat| stat.with_interval(2)),
                value(one.simulation),
                error(one.simulation),
                value(one.theory),
                error(one.theory),
            ]);
        }
        cells
    };
    Table {
        title: "Beside the paper's simulations and strand theory, both engine and theory calibrated on the experiment at 39 mm"
            .into(),
        heads: heads.collect(),
        rows: points.iter().map(row).collect(),
        default: None,
        left: definition.axes.len(),
    }
}

fn trends(definition: &Definition, trends: &[Trend]) -> Table {
    let axis = definition.abscissa().expect("trends run over an axis");
    let heads = ["quantity", "this engine", "paper", "strand theory", "same sign as the paper", "as theory"];
    let row = |trend: &Trend| {
        let value = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:+.2}"));
        let computed = match trend.interval_95 {
            Some(half) => format!("{:+.2} ± {half:.2}", trend.computed),
            None => format!("{:+.2}", trend.computed),
        };
        vec![
            trend.quantity.to_string(),
            computed,
            value(trend.simulation),
            value(trend.theory),
            verdict(trend, trend.simulation),
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
        Some(half) if trend.computed.abs() <= half => "within scatter of none".into(),
        _ if trend.computed * other > 0.0 => "yes".into(),
        _ => "no".into(),
    }
}
