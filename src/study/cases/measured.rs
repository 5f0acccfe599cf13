//! What a study keeps of a run: its cost, its answer and its histories over strain.

use crate::base::error::Result;
use crate::base::units::{mm, mpa};
use crate::engine::measure::MEAN_LAG;
use crate::engine::view::{RunInfo, Sample};
use crate::observe::Observer;
use crate::observe::summary::{Break, RunSummary};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Histories over strain, one entry per row of the curve.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Curve {
    /// Strain of the body (-), rising.
    pub strain: Vec<f64>,
    /// Nominal stress (MPa).
    pub stress_mpa: Vec<f64>,
    /// Plastic work so far, bonds and contacts (J).
    pub plastic_work_j: Vec<f64>,
    /// Mean nominal stress of each layer at mid-gauge (MPa), layer by layer: the force on the layer over its copper.
    pub layer_stress_mpa: Vec<Vec<f64>>,
}

impl Curve {
    /// Strain up to which there are rows (-).
    pub fn end(&self) -> f64 {
        self.strain.last().copied().unwrap_or(0.0)
    }

    /// A history at `strain` (-), linear between rows; its end beyond them. `history` must belong to this curve.
    pub fn at(&self, history: &[f64], strain: f64) -> f64 {
        let upper = self.strain.partition_point(|e| *e <= strain);
        match upper {
            0 => history.first().copied().unwrap_or(0.0),
            _ if upper == self.strain.len() => history[upper - 1],
            _ => {
                let (e0, e1) = (self.strain[upper - 1], self.strain[upper]);
                let (h0, h1) = (history[upper - 1], history[upper]);
                h0 + (h1 - h0) * (strain - e0) / (e1 - e0)
            }
        }
    }

    /// Takes a row; one at a strain that was passed before (a strand that springs back) is left out.
    fn push(&mut self, sample: &Sample, plastic_work: f64) {
        if self.strain.last().is_some_and(|last| sample.strain <= *last) {
            return;
        }
        self.strain.push(sample.strain);
        self.stress_mpa.push(mpa(sample.stress));
        self.plastic_work_j.push(plastic_work);
        self.layer_stress_mpa.resize_with(sample.layer_stress.len(), Vec::new);
        for (history, stress) in self.layer_stress_mpa.iter_mut().zip(&sample.layer_stress) {
            history.push(mpa(*stress));
        }
    }
}

/// All plastic work in bonds and contacts (J).
fn plastic_work(sample: &Sample) -> f64 {
    let energy = &sample.energy;
    energy.plastic_bonds + energy.plastic_contacts + energy.plastic_thinning
}

/// One run as a study sees it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Measured {
    /// From reading the geometry to the last row (s).
    pub wall_s: f64,
    /// Processor time of the same (s); `None` where the system does not tell.
    pub cpu_s: Option<f64>,
    /// Steps.
    pub steps: u64,
    /// Wall time in the engine over steps (ms).
    pub ms_per_step: Option<f64>,
    /// Particles.
    pub particles: usize,
    /// Greatest nominal stress of a body that failed (MPa).
    pub strength_mpa: f64,
    /// Strain at the peak (%).
    pub elongation_percent: f64,
    /// Strain at which stress has fallen 20 % below its peak (%); `None` when it never did.
    pub drop_percent: Option<f64>,
    /// Greatest share of the energy that the ledger does not account for (%).
    pub energy_residual_percent: Option<f64>,
    /// Greatest kinetic over internal energy before the first rupture (-).
    pub kinetic_over_internal: Option<f64>,
    /// Greatest difference of the two grip forces before the first rupture, over the peak force (%).
    pub grip_mismatch_percent: Option<f64>,
    /// Wires.
    pub wires: usize,
    /// Layer names, inside out.
    pub layers: Vec<String>,
    /// Wires of each layer.
    pub layer_wires: Vec<usize>,
    /// Where the gauge begins and ends along z before loading (mm); `None` without grips.
    pub gauge_mm: Option<[f64; 2]>,
    /// First rupture of each wire that broke, in order.
    pub breaks: Vec<Break>,
    /// Histories.
    pub curve: Curve,
}

impl Measured {
    /// From a run's summary and what was seen on its way. `None` for a run that has no strength, because
    /// nothing pulled or the body did not fail.
    pub fn new(summary: RunSummary, watcher: Watcher, cpu_s: Option<f64>) -> Option<Self> {
        let mut breaks: Vec<Break> = summary.breaks_by_layer.into_values().flatten().collect();
        breaks.sort_by_key(|b| b.order);
        Some(Self {
            wall_s: summary.cost.wall_s,
            cpu_s,
            steps: summary.cost.steps,
            ms_per_step: summary.cost.ms_per_step,
            particles: summary.particles,
            strength_mpa: summary.tensile_strength_mpa?,
            elongation_percent: summary.fracture_elongation_percent?,
            drop_percent: summary.elongation_at_20_percent_drop_percent,
            energy_residual_percent: summary.energy_residual_percent,
            kinetic_over_internal: summary.quasi_static.kinetic_over_internal_max,
            grip_mismatch_percent: summary.quasi_static.grip_force_mismatch_percent,
            wires: watcher.layer_wires.iter().sum(),
            layers: watcher.layers,
            layer_wires: watcher.layer_wires,
            gauge_mm: watcher.gauge_mm,
            breaks,
            curve: watcher.curve,
        })
    }
}

/// Keeps the histories of a run.
#[derive(Debug, Default)]
pub struct Watcher {
    curve: Curve,
    layers: Vec<String>,
    layer_wires: Vec<usize>,
    gauge_mm: Option<[f64; 2]>,
    /// By how much the strain of a row is older than its energies (s).
    lag: f64,
    /// Time (s) and plastic work (J) of the row before.
    before: Option<[f64; 2]>,
}

impl Observer for Watcher {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        let mut layer_wires = vec![0; info.layers.len()];
        info.wires.iter().for_each(|wire| layer_wires[wire.layer] += 1);
        let gauge_mm = info.gauge.map(|ends| ends.map(mm));
        let lag = MEAN_LAG * info.wave_passage;
        *self = Self { layers: info.layers.clone(), layer_wires, gauge_mm, lag, ..Self::default() };
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        // Energies are those of the instant; between two rows plastic work grows evenly.
        let work = plastic_work(sample);
        let rate =
            self.before.map_or(0.0, |[time, before]| (work - before) / (sample.time - time).max(f64::MIN_POSITIVE));
        self.before = Some([sample.time, work]);
        self.curve.push(sample, (work - rate * self.lag).max(0.0));
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn histories_are_linear_between_rows_and_flat_beyond() {
        let curve = Curve { strain: vec![0.0, 0.1, 0.3], stress_mpa: vec![0.0, 10.0, 20.0], ..Curve::default() };
        for (strain, stress) in [(-1.0, 0.0), (0.05, 5.0), (0.1, 10.0), (0.2, 15.0), (0.3, 20.0), (0.4, 20.0)] {
            assert!((curve.at(&curve.stress_mpa, strain) - stress).abs() < 1e-12, "{strain}");
        }
    }

    #[test]
    fn a_strand_that_springs_back_keeps_its_history_rising() {
        let mut curve = Curve::default();
        for strain in [0.0, 0.1, 0.09, 0.2] {
            curve.push(&Sample { strain, layer_stress: vec![1e6], ..Sample::default() }, 0.0);
        }
        assert_eq!(curve.strain, [0.0, 0.1, 0.2]);
        assert_eq!(curve.layer_stress_mpa, [[1.0, 1.0, 1.0]]);
    }
}
