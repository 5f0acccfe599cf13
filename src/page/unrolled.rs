//! The unrolled map: a row per wire, layers apart, axial position before loading, coloured by true axial stress.

use super::abscissa::Abscissa;
use super::curve::told;
use super::figure::{Figure, axis, layout, literal, merged, numbers, table};
use super::source::Source;
use super::source::State;
use crate::base::units::mpa;
use crate::engine::view::WireInfo;
use crate::observe::unrolled::{Unrolled, bonds, place};
use crate::observe::wording::{layer_label, wire_number};
use maud::html;
use serde_json::{Value, json};

/// Cells in a row at most: a screen shows no more.
const MOST_CELLS: usize = 400;
/// Height of a wire's row and of what stands above and below them all (px).
const ROW: usize = 17;
const AROUND: usize = 146;
const TALLEST: usize = 1400;
/// Room for half a cell at the ends of the strand (mm).
const CELL: f64 = 0.5;

/// A wire's row: one heat map of one line, because wires differ in where their bonds are.
struct Row {
    wire: usize,
    /// Height of its middle in the chart: one for each row, with one free between layers (-).
    y: usize,
    /// Bonds in a cell.
    group: usize,
    /// Centre of each cell before loading (mm).
    x: Vec<f64>,
}

/// The map of a run, for any of its states.
pub struct Map<'a> {
    source: &'a Source,
    map: Unrolled,
    rows: Vec<Row>,
}

impl<'a> Map<'a> {
    /// The map; `None` for a body without bonds.
    pub fn new(source: &'a Source) -> Option<Self> {
        let map = Unrolled::new(&source.info, 1.0, 0..source.info.layers.len());
        let rows = rows(source, &map);
        (!rows.is_empty()).then_some(Self { source, map, rows })
    }

    /// Stress of every cell in a state, row by row: the mean of the bonds that hold (MPa).
    pub fn stress(&self, state: &State) -> Vec<Value> {
        let of = |row: &Row| {
            let bonds = &state.stress[self.source.info.wires[row.wire].bonds()];
            table(bonds.chunks(row.group).map(mean), 1, row.x.len())
        };
        self.rows.iter().map(of).collect()
    }

    /// Places, moments and words of the breaks, in order, and the row of each wire.
    pub fn marks(&self) -> Value {
        let abscissa = Abscissa::of(self.source);
        let ruptures = &self.source.ruptures;
        json!({
            "x": ruptures.iter().map(|r| place(&self.source.info, r)).collect::<Vec<_>>(),
            "y": ruptures.iter().map(|r| height(&self.map, r.wire)).collect::<Vec<_>>(),
            "order": ruptures.iter().map(|r| r.order).collect::<Vec<_>>(),
            "text": ruptures.iter().map(|r| told(self.source, r)).collect::<Vec<_>>(),
            "wire": ruptures.iter().map(|r| r.wire).collect::<Vec<_>>(),
            "at": ruptures.iter().map(|r| abscissa.at(r)).collect::<Vec<_>>(),
            "row": (0..self.source.info.wires.len()).map(|wire| height(&self.map, wire)).collect::<Vec<_>>(),
        })
    }

    /// The chart without stresses and marks, which come with a state.
    pub fn figure(&self) -> Figure {
        let heat = self.rows.iter().map(|row| self.heat(row));
        let marks = json!({
            "type": "scatter", "mode": "markers", "name": "broken", "showlegend": false, "x": [], "y": [],
            "marker": { "symbol": "x", "size": 9, "color": "$signal", "line": { "color": "$paper", "width": 1 } },
            "hovertemplate": "%{text}<extra></extra>",
        });
        Figure {
            id: "map",
            height: (self.top() * ROW + AROUND).min(TALLEST),
            caption: self.caption(),
            data: heat.chain([marks]).collect(),
            layout: self.layout(),
        }
    }

    fn heat(&self, row: &Row) -> Value {
        let layer = literal(&layer_label(&self.source.info, self.source.info.wires[row.wire].layer));
        json!({
            "type": "heatmap", "coloraxis": "coloraxis", "ygap": 1, "hoverongaps": false,
            "x": numbers(row.x.iter().copied()), "y": [row.y],
            "hovertemplate": format!(
                "<b>wire {}</b>, {layer} layer<br>{} = %{{x:.2f}} mm before loading<br>true axial stress %{{z:.1f}} MPa<extra></extra>",
                wire_number(row.wire),
                if self.source.info.gauge.is_some() { "z" } else { "s" },
            ),
        })
    }

    /// Height above all rows.
    fn top(&self) -> usize {
        self.rows.iter().map(|row| row.y + 1).max().unwrap_or(0)
    }

    fn caption(&self) -> maud::Markup {
        let coarsest = self.rows.iter().map(|row| row.group).max().unwrap_or(1);
        html! {
            "Wires unrolled, innermost layer at the bottom, coloured by the true axial stress of their bonds. Crosses are broken bonds, numbers the order in which they broke; blank cells hold nothing. "
            @if coarsest > 1 { "A cell is the mean of up to " (coarsest) " bonds. " }
            @if self.source.info.gauge.is_some() { "Shaded ends are held by the grips; the dotted line is mid-length." }
        }
    }

    fn layout(&self) -> Value {
        let info = &self.source.info;
        let along = if info.gauge.is_some() {
            "axial position z before loading (mm)"
        } else {
            "place s along the wire before loading (mm)"
        };
        // Names of rows only where they have room.
        let named: Vec<&Row> = self.rows.iter().step_by(self.rows.len().div_ceil(TALLEST / ROW)).collect();
        let y = json!({
            "range": [-0.6, self.top() as f64 - 0.4], "showgrid": false, "zeroline": false, "ticks": "", "tickfont": { "size": 10 },
            "tickvals": named.iter().map(|row| row.y).collect::<Vec<_>>(),
            "ticktext": named.iter().map(|row| wire_number(row.wire).to_string()).collect::<Vec<_>>(),
        });
        layout(
            merged(axis(along), json!({ "showgrid": false, "zeroline": false })),
            merged(axis("wire"), y),
            json!({
                "shapes": self.shapes(), "annotations": self.names(), "margin": { "l": 56, "r": 24, "t": 72, "b": 48 },
                "coloraxis": {
                    "colorscale": "Viridis", "cmin": mpa(info.stress_range[0]), "cmax": mpa(info.stress_range[1]),
                    "colorbar": {
                        "title": { "text": "true axial stress (MPa)", "side": "top" }, "orientation": "h", "y": 1, "yanchor": "bottom",
                        "x": 1, "xanchor": "right", "len": 0.5, "thickness": 12, "outlinewidth": 0,
                    },
                },
            }),
        )
    }

    /// Layer names above the rows of each layer.
    fn names(&self) -> Vec<Value> {
        let info = &self.source.info;
        self.map
            .layers
            .iter()
            .map(|of| {
                json!({
                    "text": format!("<b>{} layer</b>", literal(&layer_label(info, of.layer))), "showarrow": false, "xref": "paper", "x": 0,
                    "xanchor": "left", "yref": "y", "y": height(&self.map, of.wires[1]), "yanchor": "bottom", "yshift": 8, "font": { "size": 12 },
                })
            })
            .collect()
    }

    /// Grips and mid-length.
    fn shapes(&self) -> Vec<Value> {
        let (Some([low, high]), Some(mid)) = (self.map.grips, self.source.mid_length()) else {
            return Vec::new();
        };
        let xs = self.rows.iter().flat_map(|row| row.x.iter().copied());
        let (first, last) = xs.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
        let held = |from: f64, to: f64| {
            json!({
                "type": "rect", "x0": from, "x1": to, "y0": 0, "y1": 1, "yref": "paper", "line": { "width": 0 },
                "fillcolor": "$held", "layer": "above",
            })
        };
        let middle = json!({
            "type": "line", "x0": mid, "x1": mid, "y0": 0, "y1": 1, "yref": "paper", "layer": "above",
            "line": { "color": "$paper", "width": 1, "dash": "dot" },
        });
        vec![held(first.min(low) - CELL, low), held(high, last.max(high) + CELL), middle]
    }
}

fn rows(source: &Source, map: &Unrolled) -> Vec<Row> {
    let wires = source.info.wires.iter().enumerate().filter(|(_, wire)| wire.len > 1);
    let row = |(wire, of): (usize, &WireInfo)| {
        let group = (of.len - 1).div_ceil(MOST_CELLS);
        let places = bonds(&source.info, wire);
        let x = places.chunks(group).map(|cell| cell.iter().sum::<f64>() / cell.len() as f64).collect();
        Row { wire, y: height(map, wire), group, x }
    };
    wires.map(row).collect()
}

/// Height of a wire's row in the chart.
fn height(map: &Unrolled, wire: usize) -> usize {
    (map.row[wire] - 0.5) as usize
}

/// Mean of the bonds that hold (MPa).
fn mean(bonds: &[f32]) -> f64 {
    let held = bonds.iter().filter(|stress| stress.is_finite());
    let (sum, count) = held.fold((0.0, 0), |(sum, count), stress| (sum + f64::from(*stress), count + 1));
    if count == 0 { f64::NAN } else { mpa(sum / f64::from(count)) }
}
