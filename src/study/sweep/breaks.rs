//! Which layer breaks first, in which order the layers follow, and where: as frequencies over seeds.

use super::gather::Gathered;
use super::quantity::off_middle;
use crate::study::statistics::Statistics;
use crate::study::tensile::TensileResult;
use serde::Serialize;

/// What became of one layer over the runs of a point.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LayerBreaks {
    /// Name of the layer.
    pub layer: String,
    /// Its wires.
    pub wires: usize,
    /// Runs in which it was the first, second, … layer to break.
    pub places: Vec<usize>,
    /// Runs in which it did not break.
    pub never: usize,
    /// Its wires that broke (%).
    pub broken_percent: Option<Statistics>,
    /// Runs in which its first break lay in the middle third of the gauge.
    pub middle_third: usize,
    /// Distance of its first break from mid-gauge, before loading (mm).
    pub off_middle_mm: Option<Statistics>,
}

/// The layers of a point, from the inside out; empty where no case ran.
pub fn layers(gathered: &Gathered, point: usize) -> Vec<LayerBreaks> {
    let runs: Vec<&TensileResult> = gathered.runs(point).collect();
    let Some(first) = runs.first() else { return Vec::new() };
    (0..first.layers.len()).map(|k| layer(&runs, k)).collect()
}

fn layer(runs: &[&TensileResult], k: usize) -> LayerBreaks {
    let (name, wires, layers) = (&runs[0].layers[k], runs[0].layer_wires[k], runs[0].layers.len());
    let mut places = vec![0; layers];
    let (mut never, mut middle_third) = (0, 0);
    let (mut off, mut broken) = (Vec::new(), Vec::new());
    for run in runs {
        match order(run).iter().position(|other| other == name) {
            Some(place) => places[place] += 1,
            None => never += 1,
        }
        let mut own = run.breaks.iter().filter(|one| one.layer == *name);
        broken.push(100.0 * own.clone().count() as f64 / wires as f64);
        if let Some((first, [lower, upper])) = own.next().zip(run.gauge_mm)
            && let Some(distance) = off_middle(run, first.rest_z_mm)
        {
            off.push(distance.abs());
            middle_third += usize::from(distance.abs() <= (upper - lower) / 6.0);
        }
    }
    LayerBreaks {
        layer: name.clone(),
        wires,
        places,
        never,
        broken_percent: Statistics::of(&broken),
        middle_third,
        off_middle_mm: Statistics::of(&off),
    }
}

/// Layers in the order in which each first broke.
pub fn order(run: &TensileResult) -> Vec<String> {
    let mut order: Vec<String> = Vec::new();
    for one in &run.breaks {
        if !order.contains(&one.layer) {
            order.push(one.layer.clone());
        }
    }
    order
}
