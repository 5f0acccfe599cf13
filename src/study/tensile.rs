//! Tensile runs of a study: [`TensileCase`] runs a scene that a grip pulls, and [`TensileResult`] is what is kept of it:
//! cost, strength and elongation, breaks, and histories over strain.

use super::runner::{Case, CaseStore, Identity, Record, Status};
use crate::base::error::{Error, Result};
use crate::base::finding::StopReason;
use crate::base::units::{mm, mpa};
use crate::engine::measure::MEAN_LAG;
use crate::engine::view::{RunInfo, Sample};
use crate::observe::Observer;
use crate::observe::summary::{Break, RunSummary};
use crate::run::build::build;
use crate::run::folder::{SCENE, has_checkpoint};
use crate::run::{DeviceChoice, Resumable, RunOptions, cost, lock, outputs, run_watched, summarise};
use crate::scene::spec::{PathSpec, Spec};
use crate::scene::{Scene, write};
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

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

/// What a tensile run gave.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TensileResult {
    /// From reading the geometry to the last row (s).
    pub wall_s: f64,
    /// Processor time of the same (s); `None` where the system does not tell.
    pub cpu_s: Option<f64>,
    /// Time steps until the run ended.
    pub steps: u64,
    /// Wall time in the engine over steps (ms).
    pub ms_per_step: Option<f64>,
    /// Particles of the whole body.
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
    /// Wires of the whole body.
    pub wires: usize,
    /// Layer names, inside out.
    pub layers: Vec<String>,
    /// Wires of each layer.
    pub layer_wires: Vec<usize>,
    /// Where the gauge begins and ends along z before loading (mm); `None` without grips.
    pub gauge_mm: Option<[f64; 2]>,
    /// First rupture of each wire that broke, in order.
    pub breaks: Vec<Break>,
    /// Histories over strain, one entry per row.
    pub curve: Curve,
}

impl TensileResult {
    /// From a run's summary and what was seen on its way. `None` for a run that has no strength, because
    /// nothing pulled or the body did not fail.
    pub fn new(summary: RunSummary, recorder: HistoryRecorder, cpu_s: Option<f64>) -> Option<Self> {
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
            wires: recorder.layer_wires.iter().sum(),
            layers: recorder.layers,
            layer_wires: recorder.layer_wires,
            gauge_mm: recorder.gauge_mm,
            breaks,
            curve: recorder.curve,
        })
    }
}

/// What became of a tensile run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TensileOutcome {
    /// It ran to its end.
    Ran(Box<TensileResult>),
    /// The engine or the guard stopped it, or it has no strength: why.
    Failed(String),
    /// Its scene is refused: why.
    Refused(String),
}

impl TensileOutcome {
    /// What it gave, if it ran to its end.
    pub fn result(&self) -> Option<&TensileResult> {
        match self {
            Self::Ran(result) => Some(result),
            Self::Failed(_) | Self::Refused(_) => None,
        }
    }

    /// Why it gave nothing, if it did not.
    pub fn cause(&self) -> Option<&str> {
        match self {
            Self::Failed(cause) | Self::Refused(cause) => Some(cause),
            Self::Ran(_) => None,
        }
    }
}

/// Processor time so far (s): of this thread where a run has no other, so that runs side by side are told apart.
fn cpu_time() -> Option<f64> {
    if rayon::current_num_threads() == 1 { cost::thread_cpu_time() } else { cost::cpu_time() }
}

/// A run of a scene that a grip pulls, kept in the store of its study.
pub struct TensileCase<'a> {
    /// What it is called.
    pub name: String,
    /// The scene; or why it is refused.
    pub scene: std::result::Result<&'a Scene, &'a str>,
    /// Seed of the scatter.
    pub seed: u64,
    /// Where its result is kept.
    pub store: &'a CaseStore,
    /// What it costs, in any unit that all cases share.
    pub work: f64,
    /// Whether estimates go by it.
    pub leads: bool,
    /// Whether the run is written to disk.
    pub writes: bool,
    /// Threads of the engine where the cost of the run is what is studied.
    pub threads: Option<usize>,
}

impl<'a> TensileCase<'a> {
    /// A case of which the answer is studied, and not the cost.
    pub fn new(name: String, scene: std::result::Result<&'a Scene, &'a str>, seed: u64, store: &'a CaseStore) -> Self {
        Self { name, scene, seed, store, work: 1.0, leads: false, writes: false, threads: None }
    }
}

/// A scene with another seed of the scatter.
pub fn with_seed(scene: &Scene, seed: u64) -> Scene {
    scene.clone().changed(|spec| spec.seed = seed)
}

/// The resolved scene as the text that identifies it, points of centreline files included.
pub fn definition(spec: &Spec) -> String {
    let mut text = write::to_toml(spec);
    for wire in &spec.wires {
        if let PathSpec::File { points, .. } = &wire.path {
            let _ = writeln!(text, "# {points:?}");
        }
    }
    text
}

/// The identity of a run whose answer, and not its cost, is studied.
pub fn identity(scene: &Scene, seed: u64) -> Identity {
    Identity::new(definition(&Spec { seed, ..scene.spec.clone() }), None, false)
}

impl Case for TensileCase<'_> {
    type Output = Record<TensileOutcome>;

    fn name(&self) -> String {
        self.name.clone()
    }

    fn kept(&self) -> Option<Self::Output> {
        self.store.find(&self.identity())
    }

    fn run(&self, stop: &AtomicBool) -> Result<Self::Output> {
        let identity = self.identity();
        // Another process may be at the same case.
        let unfinished = self.store.unfinished(&identity);
        lock::wait(&unfinished, stop);
        if stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted);
        }
        if let Some(record) = self.store.find(&identity) {
            return Ok(record);
        }
        let scene = match self.scene {
            Ok(scene) => with_seed(scene, self.seed),
            // Nothing was run, so nothing is kept.
            Err(cause) => {
                return Ok(Record { identity, build: build(), result: TensileOutcome::Refused(cause.into()) });
            }
        };
        let outcome = match self.measure(&scene, &unfinished, stop) {
            Ok(Some(result)) => TensileOutcome::Ran(Box::new(result)),
            Ok(None) => TensileOutcome::Failed(NO_STRENGTH.into()),
            Err(error @ (Error::Scene(_) | Error::Input { .. } | Error::Simulation(_)))
                if lock::holder(&unfinished).is_none() =>
            {
                TensileOutcome::Failed(error.to_string())
            }
            Err(error) => return Err(error),
        };
        let record = self.store.keep(&identity, SCENE, outcome)?;
        self.store.drop_unfinished(&unfinished)?;
        Ok(record)
    }

    fn work(&self) -> f64 {
        self.work
    }

    fn leads(&self) -> bool {
        self.leads
    }

    fn wall_s(&self, output: &Self::Output) -> Option<f64> {
        output.result.result().map(|result| result.wall_s)
    }
}

/// Why a run that came to its end may have no strength.
const NO_STRENGTH: &str =
    "the run has no strength: nothing pulled, or it ended before stress had fallen 20 % below its peak after a rupture";

impl TensileCase<'_> {
    fn identity(&self) -> Identity {
        let text = self.scene.map_or_else(str::to_owned, |s| definition(&Spec { seed: self.seed, ..s.spec.clone() }));
        Identity::new(text, self.threads, self.writes).on(self.store.device())
    }

    /// Runs the scene; `None` when it has no strength.
    fn measure(&self, scene: &Scene, unfinished: &Path, stop: &AtomicBool) -> Result<Option<TensileResult>> {
        let mut recorder = HistoryRecorder::default();
        let begin = cpu_time();
        let (summary, resumed) = if self.writes {
            let folder = self.store.folder();
            let out = tempfile::tempdir_in(folder).map_err(|e| Error::io("cannot write into", folder, e))?;
            // Everything that `strandsnap run` writes but pictures, which cost what they cost whatever the engine does.
            let options = RunOptions { recording: outputs::HAS_RECORD, ..RunOptions::tables(out.path()) };
            (run_watched(scene, &options, vec![&mut recorder], stop)?, false)
        } else if self.threads.is_some() {
            // Nothing but the engine may cost here.
            (summarise(scene, vec![&mut recorder], stop)?, false)
        } else {
            resumably(scene, unfinished, self.store.device(), &mut recorder, stop)?
        };
        if summary.stopped == StopReason::Interrupted {
            return Err(Error::Interrupted);
        }
        // That of an earlier process is not known.
        let cpu = cpu_time().zip(begin).map(|(now, begin)| now - begin).filter(|_| !resumed);
        Ok(TensileResult::new(summary, recorder, cpu))
    }
}

/// Runs a scene in a folder of its own, or goes on where an earlier process was ended: the summary, and whether it went on.
/// A checkpoint that cannot be used is no loss but of time.
fn resumably(
    scene: &Scene,
    out: &Path,
    device: &DeviceChoice,
    recorder: &mut HistoryRecorder,
    stop: &AtomicBool,
) -> Result<(RunSummary, bool)> {
    // Of states only the checkpoints are needed.
    let scene = scene.clone().changed(|spec| spec.output.snapshots = 1);
    let usable = |run: &Resumable| run.check_scene(&scene).is_ok();
    if has_checkpoint(out)
        && let Some(run) = Resumable::open(out, None, None).ok().filter(usable)
    {
        match run.go_on(&|_| (), vec![recorder], stop) {
            // What it needs beside the checkpoint is damaged.
            Err(Error::Input { .. }) => {}
            done => return done.map(|summary| (summary, true)),
        }
    }
    let options = RunOptions { overwrite: true, device: device.clone(), ..RunOptions::tables(out) };
    Ok((run_watched(&scene, &options, vec![recorder], stop)?, false))
}

/// How many of the runs were kept from before, and how many of those another build of the same revision had made.
pub fn count_kept(statuses: &[Status<Record<TensileOutcome>>]) -> [usize; 2] {
    let build = build();
    let kept = statuses.iter().filter_map(|status| match status {
        Status::Kept(record) => Some(record),
        _ => None,
    });
    let other = kept.clone().filter(|record| record.build != build).count();
    [kept.count(), other]
}

/// Keeps the histories of a run.
#[derive(Debug, Default)]
pub struct HistoryRecorder {
    curve: Curve,
    layers: Vec<String>,
    layer_wires: Vec<usize>,
    gauge_mm: Option<[f64; 2]>,
    /// By how much the strain of a row is older than its energies (s).
    lag: f64,
    /// Time (s) and plastic work (J) of the row before.
    before: Option<[f64; 2]>,
}

impl Observer for HistoryRecorder {
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
