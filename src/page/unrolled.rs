//! The unrolled map: a row per wire, layers apart, axial position before loading, coloured by true axial stress.

use super::Source;
use super::curve::told;
use super::figure::{Figure, axis, layout, literal, merged, table};
use super::source::State;
use crate::observe::tables::layer_name;
use crate::observe::units::mm;
use maud::html;
use serde_json::{Value, json};
use std::ops::Range;

/// Cells in a row at most: a screen shows no more.
const MOST_CELLS: usize = 400;
/// Height of a wire's row and of what stands above and below them all [px].
const ROW: usize = 17;
const AROUND: usize = 130;
const TALLEST: usize = 1400;

/// Neighbouring wires whose cells lie at the same places: one heat map.
struct Band {
    layer: usize,
    wires: Range<usize>,
    /// Bonds in a cell.
    group: usize,
    /// Centre of each cell before loading [mm].
    x: Vec<f64>,
}

/// The map of a run, for any of its states.
pub struct Map<'a> {
    source: &'a Source,
    bands: Vec<Band>,
}

impl<'a> Map<'a> {
    /// The map; `None` for a body without bonds.
    pub fn new(source: &'a Source) -> Option<Self> {
        let bands = bands(source);
        (!bands.is_empty()).then_some(Self { source, bands })
    }

    /// Bonds that share a cell where they share most [-].
    fn coarsest(&self) -> usize {
        self.bands.iter().map(|band| band.group).max().unwrap_or(1)
    }

    /// Stress of every cell in a state, band by band: the mean of the bonds that hold [MPa].
    pub fn stress(&self, state: &State) -> Vec<Value> {
        self.bands.iter().map(|band| self.cells(band, &state.stress)).collect()
    }

    fn cells(&self, band: &Band, stress: &[f32]) -> Value {
        let wires = band.wires.clone().map(|w| &self.source.info.wires[w]);
        let rows = wires.flat_map(|wire| stress[wire.first..wire.first + wire.len - 1].chunks(band.group)).map(mean);
        table(rows, band.wires.len(), band.x.len())
    }

    /// Places and words of the breaks, in order.
    pub fn marks(&self) -> Value {
        let ruptures = &self.source.ruptures;
        json!({
            "x": ruptures.iter().map(|r| place_of_rupture(self.source, r)).collect::<Vec<_>>(),
            "y": ruptures.iter().map(|r| row_name(r.wire)).collect::<Vec<_>>(),
            "order": ruptures.iter().map(|r| r.order).collect::<Vec<_>>(),
            "text": ruptures.iter().map(|r| told(self.source, r)).collect::<Vec<_>>(),
        })
    }

    /// The chart without stresses and marks, which come with a state.
    pub fn figure(&self) -> Figure {
        let info = &self.source.info;
        let heat = self.bands.iter().map(|band| {
            let layer = literal(layer_name(info, band.layer));
            json!({
                "type": "heatmap", "coloraxis": "coloraxis", "name": layer, "ygap": 1, "hoverongaps": false,
                "x": band.x.iter().map(|x| (x * 1e3).round() / 1e3).collect::<Vec<_>>(),
                "y": band.wires.clone().map(row_name).collect::<Vec<_>>(),
                "hovertemplate": format!("wire %{{y}}, {layer} layer<br>{} = %{{x:.2f}} mm before loading<br>true axial stress %{{z:.1f}} MPa<extra></extra>", self.letter()),
            })
        });
        let marks = json!({
            "type": "scatter", "mode": "markers", "name": "broken", "showlegend": false, "x": [], "y": [],
            "marker": { "symbol": "x", "size": 9, "color": "$signal", "line": { "color": "$paper", "width": 1 } },
            "hovertemplate": "%{text}<extra></extra>",
        });
        Figure {
            id: "map",
            height: (self.rows().len() * ROW + AROUND).min(TALLEST),
            caption: self.caption(),
            data: heat.chain([marks]).collect(),
            layout: self.layout(),
        }
    }

    fn caption(&self) -> maud::Markup {
        html! {
            "Wires unrolled, innermost layer at the bottom, coloured by the true axial stress of their bonds. Crosses are broken bonds, numbers the order in which they broke; blank cells hold nothing. "
            @if self.coarsest() > 1 { "A cell is the mean of up to " (self.coarsest()) " bonds. " }
            @if self.source.info.gauge.is_some() { "Shaded ends are held by the grips; the dotted line is mid-length." }
        }
    }

    fn letter(&self) -> &'static str {
        if self.source.info.gauge.is_some() { "z" } else { "s" }
    }

    /// Names of the rows from the bottom up, blank ones between layers.
    fn rows(&self) -> Vec<String> {
        let mut rows = Vec::new();
        let mut layer = None;
        for band in &self.bands {
            if layer.is_some_and(|layer| layer != band.layer) {
                // Categories must differ, also blank ones.
                rows.push(" ".repeat(rows.len() + 1));
            }
            layer = Some(band.layer);
            rows.extend(band.wires.clone().map(row_name));
        }
        rows
    }

    fn layout(&self) -> Value {
        let info = &self.source.info;
        let rows = self.rows();
        let x = if info.gauge.is_some() {
            "axial position z before loading (mm)"
        } else {
            "place s along the wire before loading (mm)"
        };
        let y = json!({
            "type": "category", "categoryorder": "array", "categoryarray": rows, "range": [-0.6, rows.len() as f64 - 0.4],
            "showgrid": false, "tickfont": { "size": 10 }, "ticks": "", "zeroline": false,
        });
        layout(
            merged(axis(x), json!({ "showgrid": false, "zeroline": false })),
            merged(axis("wire"), y),
            json!({
                "shapes": self.shapes(), "annotations": self.names(&rows), "margin": { "l": 56, "r": 24, "t": 84, "b": 48 },
                "coloraxis": {
                    "colorscale": "Viridis", "cmin": info.stress_range[0], "cmax": info.stress_range[1],
                    "colorbar": {
                        "title": { "text": "true axial stress (MPa)", "side": "top" }, "orientation": "h", "y": 1, "yanchor": "bottom", "ypad": 24,
                        "x": 1, "xanchor": "right", "len": 0.5, "thickness": 12, "outlinewidth": 0,
                    },
                },
            }),
        )
    }

    /// Layer names above the lowest row of each layer's block.
    fn names(&self, rows: &[String]) -> Vec<Value> {
        let info = &self.source.info;
        let layers =
            (0..info.layers.len()).filter_map(|layer| Some((layer, self.bands.iter().rfind(|b| b.layer == layer)?)));
        layers
            .filter_map(|(layer, band)| {
                let top = row_name(band.wires.end - 1);
                let index = rows.iter().position(|row| *row == top)?;
                Some(json!({
                    "text": format!("<b>{}</b>", literal(layer_name(info, layer))), "showarrow": false, "xref": "paper", "x": 0,
                    "xanchor": "left", "yref": "y", "y": index, "yanchor": "bottom", "yshift": 8, "font": { "size": 12 },
                }))
            })
            .collect()
    }

    /// Grips and mid-length.
    fn shapes(&self) -> Vec<Value> {
        let (Some([low, high]), Some(mid)) = (self.source.info.gauge, self.source.mid_length()) else {
            return Vec::new();
        };
        let xs = self.bands.iter().flat_map(|band| band.x.iter().copied());
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
        vec![held(first.min(f64::from(low)), f64::from(low)), held(f64::from(high), last.max(f64::from(high))), middle]
    }
}

/// Name of a wire's row: its number as people see it.
fn row_name(wire: usize) -> String {
    crate::observe::wording::wire_number(wire).to_string()
}

fn mean(bonds: &[f32]) -> f64 {
    let held = bonds.iter().filter(|stress| stress.is_finite());
    let (sum, count) = held.fold((0.0, 0), |(sum, count), stress| (sum + f64::from(*stress), count + 1));
    if count == 0 { f64::NAN } else { sum / f64::from(count) }
}

fn bands(source: &Source) -> Vec<Band> {
    let mut bands: Vec<Band> = Vec::new();
    for (number, wire) in source.info.wires.iter().enumerate().filter(|(_, wire)| wire.len > 1) {
        let group = (wire.len - 1).div_ceil(MOST_CELLS);
        let places = places(source, number);
        let x: Vec<f64> = places.chunks(group).map(|cell| cell.iter().sum::<f64>() / cell.len() as f64).collect();
        let fits = |band: &&mut Band| {
            let same = || band.x.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-3);
            band.wires.end == number && band.layer == wire.layer && band.x.len() == x.len() && same()
        };
        match bands.last_mut().filter(fits) {
            Some(band) => band.wires.end = number + 1,
            None => bands.push(Band { layer: wire.layer, wires: number..number + 1, group, x }),
        }
    }
    bands
}

/// Where the bonds of a wire are before loading [mm]: z in a body between grips; for a free one, which may lie in any
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
