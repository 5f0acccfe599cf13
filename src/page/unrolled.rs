//! The unrolled map: a row per wire, layers apart, axial position before loading, coloured by true axial stress.

use super::Source;
use super::curve::told;
use super::figure::{Figure, axis, layout, literal, merged, numbers, table};
use super::source::State;
use crate::observe::tables::layer_name;
use crate::observe::units::mm;
use crate::observe::wording::wire_number;
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
    rows: Vec<Row>,
}

impl<'a> Map<'a> {
    /// The map; `None` for a body without bonds.
    pub fn new(source: &'a Source) -> Option<Self> {
        let rows = rows(source);
        (!rows.is_empty()).then_some(Self { source, rows })
    }

    /// Stress of every cell in a state, row by row: the mean of the bonds that hold (MPa).
    pub fn stress(&self, state: &State) -> Vec<Value> {
        let of = |row: &Row| {
            let wire = &self.source.info.wires[row.wire];
            let bonds = &state.stress[wire.first..wire.first + wire.len - 1];
            table(bonds.chunks(row.group).map(mean), 1, row.x.len())
        };
        self.rows.iter().map(of).collect()
    }

    /// Places and words of the breaks, in order.
    pub fn marks(&self) -> Value {
        let ruptures = &self.source.ruptures;
        json!({
            "x": ruptures.iter().map(|r| place_of_rupture(self.source, r)).collect::<Vec<_>>(),
            "y": ruptures.iter().map(|r| self.height_of(r.wire)).collect::<Vec<_>>(),
            "order": ruptures.iter().map(|r| r.order).collect::<Vec<_>>(),
            "text": ruptures.iter().map(|r| told(self.source, r)).collect::<Vec<_>>(),
        })
    }

    fn height_of(&self, wire: usize) -> Option<usize> {
        self.rows.iter().find(|row| row.wire == wire).map(|row| row.y)
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
        let layer = literal(layer_name(&self.source.info, self.source.info.wires[row.wire].layer));
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
                    "colorscale": "Viridis", "cmin": info.stress_range[0], "cmax": info.stress_range[1],
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
        let top = |layer| self.rows.iter().filter(|row| info.wires[row.wire].layer == layer).map(|row| row.y).max();
        let layers = (0..info.layers.len()).filter_map(|layer| Some((layer, top(layer)?)));
        layers
            .map(|(layer, y)| {
                json!({
                    "text": format!("<b>{} layer</b>", literal(layer_name(info, layer))), "showarrow": false, "xref": "paper", "x": 0,
                    "xanchor": "left", "yref": "y", "y": y, "yanchor": "bottom", "yshift": 8, "font": { "size": 12 },
                })
            })
            .collect()
    }

    /// Grips and mid-length.
    fn shapes(&self) -> Vec<Value> {
        let (Some([low, high]), Some(mid)) = (self.source.info.gauge, self.source.mid_length()) else {
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
        vec![
            held(first.min(f64::from(low)) - CELL, f64::from(low)),
            held(f64::from(high), last.max(f64::from(high)) + CELL),
            middle,
        ]
    }
}

fn rows(source: &Source) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    let wires = &source.info.wires;
    for (wire, of) in wires.iter().enumerate().filter(|(_, wire)| wire.len > 1) {
        let y = rows.last().map_or(0, |below| below.y + if wires[below.wire].layer == of.layer { 1 } else { 2 });
        let group = (of.len - 1).div_ceil(MOST_CELLS);
        let places = places(source, wire);
        let x = places.chunks(group).map(|cell| cell.iter().sum::<f64>() / cell.len() as f64).collect();
        rows.push(Row { wire, y, group, x });
    }
    rows
}

fn mean(bonds: &[f32]) -> f64 {
    let held = bonds.iter().filter(|stress| stress.is_finite());
    let (sum, count) = held.fold((0.0, 0), |(sum, count), stress| (sum + f64::from(*stress), count + 1));
    if count == 0 { f64::NAN } else { sum / f64::from(count) }
}

/// Where the bonds of a wire are before loading (mm): z in a body between grips; for a free one, which may lie in any
/// direction, the length along the wire.
fn places(source: &Source, wire: usize) -> Vec<f64> {
    let of = &source.info.wires[wire];
    let particles = &source.info.rest_position[of.first..of.first + of.len];
    if source.info.gauge.is_some() {
        return particles.windows(2).map(|pair| 0.5 * f64::from(pair[0][2] + pair[1][2])).collect();
    }
    let lengths =
        particles.windows(2).map(|pair| (0..3).map(|k| f64::from(pair[1][k] - pair[0][k]).powi(2)).sum::<f64>().sqrt());
    lengths
        .scan(0.0, |so_far, length| {
            let centre = *so_far + 0.5 * length;
            *so_far += length;
            Some(centre)
        })
        .collect()
}

fn place_of_rupture(source: &Source, rupture: &crate::engine::view::Rupture) -> f64 {
    match source.info.gauge {
        Some(_) => mm(rupture.rest_z),
        None => places(source, rupture.wire).get(rupture.bond_in_wire).copied().unwrap_or(0.0),
    }
}
