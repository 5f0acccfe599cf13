//! `RunSummary`: what a run found, as written to `summary.json`.

use super::Observer;
use super::bodies::{BodyLoads, Gathered};
use super::guard::QuasiStatic;
use super::limits::Limits;
use super::materials::{GreatestForce, Shares, of_wire};
use super::peaks::{Monitor, Peaks};
use super::stiffness::{Rows, Stiffness};
use super::tables::{cause, layer_name};
use super::timings::Timings;
use super::wording::OneDraw;
use crate::base::error::Result;
use crate::base::finding::{Failure, Finding, Instant, Notice, StopReason, Stopped};
use crate::base::units::{mm, mpa, percent};
use crate::base::worst::renew;
use crate::engine::view::{Energy, RunInfo, Rupture, Sample, WireInfo};
use crate::scene::spec::{DriveSpec, Spec};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The result of a run. Quantities that the scene does not have (strength of free bodies) are `None`, `null` in JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunSummary {
    /// Scene name.
    pub scene: String,
    /// Why the run ended.
    pub stopped: StopReason,
    /// The same in words.
    pub stopped_because: String,
    /// Greatest nominal stress of all steps (MPa), of a body that failed: a bond broke, and stress fell 20 % below its peak.
    /// `None` for any other, whose strength the run does not know, however it ended.
    pub tensile_strength_mpa: Option<f64>,
    /// The same as a force: that of the upper grip (N).
    #[serde(default)]
    pub breaking_force_n: Option<f64>,
    /// Strain at the tensile strength (%); `None` without one.
    pub fracture_elongation_percent: Option<f64>,
    /// Strain at which the stress has fallen 20 % below its peak (%); `None` when it never did.
    pub elongation_at_20_percent_drop_percent: Option<f64>,
    /// Greatest nominal stress of all steps (MPa), whether the body failed or not; `None` unless it was pulled.
    pub greatest_stress_mpa: Option<f64>,
    /// The same as a force: that of the upper grip (N).
    #[serde(default)]
    pub greatest_force_n: Option<f64>,
    /// Strain at the greatest stress (%).
    pub strain_at_greatest_stress_percent: Option<f64>,
    /// Least nominal stress of all steps (MPa), tension positive, so that it is negative; `None` unless the body was pushed.
    pub compressive_peak_mpa: Option<f64>,
    /// Strain at the compressive peak (%), negative where the body was shortened.
    pub strain_at_compressive_peak_percent: Option<f64>,
    /// The first rupture; `None` when nothing broke.
    pub first_rupture: Option<Break>,
    /// Broken wires and wires in all, by layer.
    pub wires_broken_by_layer: BTreeMap<String, BrokenOf>,
    /// First rupture of each wire that broke, in order, by layer.
    pub breaks_by_layer: BTreeMap<String, Vec<Break>>,
    /// Wires broken in all.
    pub wires_broken: usize,
    /// Bonds broken in all.
    pub bonds_broken: usize,
    /// Strain of the body at the end (%).
    pub final_strain_percent: Option<f64>,
    /// Nominal stress at the end (MPa).
    pub residual_stress_mpa: Option<f64>,
    /// Initial stiffness beside strand theory; `None` where that has nothing to say.
    #[serde(default)]
    pub stiffness: Option<Stiffness>,
    /// Who carried how much in the row of the greatest force, those within two passages of a wave after a rupture left out; `None`
    /// where wires are of one material.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shares_at_greatest_stress: Option<Shares>,
    /// Loads on rigid bodies, where there are any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<BodyLoads>,
    /// Energy ledger at the end (J).
    pub energy: Energy,
    /// What the ledger does not account for, over the work done (%); `None` when the work is negligible.
    pub energy_residual_percent: Option<f64>,
    /// How far loading was from quasi-static.
    #[serde(flatten)]
    pub quasi_static: QuasiStatic,
    /// How near the run came to the limits of its model.
    #[serde(flatten)]
    pub limits: Limits,
    /// Factor on particle mass (-).
    pub mass_scale: f64,
    /// Factor on rotational inertia (-).
    pub inertia_scale: f64,
    /// Seed of the scatter (-).
    pub seed: u64,
    /// The draw that this strand is, where bonds scatter: its first wire, layer and place say nothing of other strands.
    /// `None` where every bond is as strong as the other.
    #[serde(default)]
    pub one_draw: Option<OneDraw>,
    /// Particles, free spheres included.
    pub particles: usize,
    /// Bonds.
    pub bonds: usize,
    /// What the run cost and with what it was made.
    #[serde(flatten)]
    pub cost: Cost,
    /// What lies in the run's folder besides; `None` where nothing was written, or by a program that did not tell.
    #[serde(default)]
    pub written: Option<OutputFiles>,
    /// What must be known before believing the run, in words: an error that ended it, then the findings in their order;
    /// empty when there is nothing.
    pub warnings: Vec<String>,
    /// The findings as facts: the failure that ended the run, then the others in the order of their steps, each kind once,
    /// at its worst.
    pub findings: Vec<Found>,
}

/// What a greatest or least stress of a run is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExtremeKind {
    /// The greatest of a body that failed.
    Strength,
    /// The greatest of a body that did not fail, or not yet.
    Greatest,
    /// The least of a body that was pushed.
    Compressive,
}

impl ExtremeKind {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Strength => "strength",
            Self::Greatest => "greatest stress",
            Self::Compressive => "compressive peak",
        }
    }
}

/// A greatest or least stress of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// What it is.
    pub kind: ExtremeKind,
    /// Nominal stress, tension positive (MPa).
    pub stress_mpa: f64,
    /// Strain at it (%).
    pub strain_percent: f64,
}

impl RunSummary {
    /// Whether the body failed under tension: only then its greatest stress is its strength.
    pub fn failed(&self) -> bool {
        self.tensile_strength_mpa.is_some()
    }

    /// What is said of the greatest stresses of the run.
    pub fn extremes(&self) -> impl Iterator<Item = Extreme> {
        let of = |kind, stress: Option<f64>, strain: Option<f64>| {
            let both = stress.zip(strain);
            both.map(|(stress_mpa, strain_percent)| Extreme { kind, stress_mpa, strain_percent })
        };
        let kind = if self.failed() { ExtremeKind::Strength } else { ExtremeKind::Greatest };
        let tension = of(kind, self.greatest_stress_mpa, self.strain_at_greatest_stress_percent);
        let compression =
            of(ExtremeKind::Compressive, self.compressive_peak_mpa, self.strain_at_compressive_peak_percent);
        tension.into_iter().chain(compression)
    }
}

/// A finding with its place in the run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// Step.
    pub step: u64,
    /// Simulated time (s).
    pub time_s: f64,
    /// Strain of the body (%); `None` without grips.
    pub strain_percent: Option<f64>,
    /// What was found: its `kind` and values in SI units.
    #[serde(flatten)]
    pub finding: Finding,
}

/// How a run ended, and what was judged about it as a whole.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Closing {
    /// Why it ended.
    pub stopped: StopReason,
    /// The error that ended it, unless it is a failure of the simulation, which is a finding.
    pub error: Option<String>,
    /// How far loading was from quasi-static.
    pub quasi_static: QuasiStatic,
    /// How near it came to the limits of the model.
    pub limits: Limits,
    /// What it cost.
    pub cost: Cost,
    /// What it wrote.
    pub written: Option<OutputFiles>,
}

/// What a run writes besides tables, summary and trajectory.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct OutputFiles {
    /// Numbered frames, one per snapshot.
    pub frames: bool,
    /// A recording.
    pub recording: bool,
    /// The animation of the frames: its name in the run's folder, or all of its path where it lies elsewhere.
    pub animation: Option<String>,
}

/// Broken wires of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct BrokenOf {
    /// Wires with at least one broken bond.
    pub broken: usize,
    /// Wires.
    pub of: usize,
}

/// A rupture for people.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Break {
    /// Order among all ruptures, from 1.
    pub order: usize,
    /// Wire, from 1.
    pub wire: usize,
    /// Layer.
    pub layer: String,
    /// Material of the wire, where wires are of several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Where it broke, stretched (mm).
    pub z_mm: f64,
    /// Where that was before loading (mm).
    pub rest_z_mm: f64,
    /// Strain of the body (%).
    pub strain_percent: f64,
    /// True axial stress of the bond just before (MPa).
    pub stress_mpa: f64,
    /// Cause.
    pub cause: String,
}

/// What a run cost and with what it was made.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Cost {
    /// Steps.
    pub steps: u64,
    /// Simulated time (s).
    pub simulated_s: f64,
    /// From the start of the run to the writing of the summary, output included (s).
    pub wall_s: f64,
    /// Processor time of the whole program in that span, all threads (s); `None` where the system does not tell.
    pub cpu_s: Option<f64>,
    /// Wall time in the engine over steps, output not included (ms).
    pub ms_per_step: Option<f64>,
    /// Threads that the engine worked with, at the end where it chose them itself.
    pub threads: usize,
    /// Threads that it could choose from.
    #[serde(default)]
    pub threads_available: usize,
    /// The graphics adapter that did the steps; `None` where the processor did them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adapter: Option<String>,
    /// Why the processor did them, or the last ones, where a graphics adapter would have been taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub not_on_adapter: Option<String>,
    /// Where the time of the frames went; `None` when none were drawn.
    pub frames: Option<Timings>,
    /// Versions of this program and of what its output depends on.
    pub versions: BTreeMap<String, String>,
}

/// Collects what the summary needs while the run goes.
#[derive(Default)]
pub struct Summariser {
    info: Option<Arc<RunInfo>>,
    notices: Vec<Notice>,
    /// Sees the rows alone: all that there is of a run that was killed.
    rows: Monitor,
    /// What was seen at every step.
    peaks: Option<Peaks>,
    /// Who carried how much in the row of the greatest force so far, and which that is.
    shares: Option<Shares>,
    greatest_force: GreatestForce,
    /// Loads on rigid bodies.
    bodies: Gathered,
    /// Rows that tell the initial stiffness.
    elastic: Rows,
    last: Sample,
    ruptures: Vec<Rupture>,
}

impl Summariser {
    /// A summariser that has seen nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// The summary of what was seen.
    pub fn summary(&self, spec: &Spec, bonds: usize, closing: Closing) -> RunSummary {
        let gripped = self.info.as_ref().is_some_and(|info| info.is_pulled());
        let measured = |value: Option<f64>| value.filter(|_| gripped);
        let loading = Loading::of(spec);
        let peaks = self.peaks.as_ref().unwrap_or(self.rows.peaks());
        let tension = peaks.tension.filter(|_| gripped && loading.tension);
        let compression = peaks.compression.filter(|_| gripped && loading.compression);
        let drop = peaks.drop.filter(|_| tension.is_some());
        let strength = tension.filter(|_| drop.is_some());
        let energy = self.last.energy;
        let negligible = self.info.as_ref().map_or(0.0, |info| info.negligible_energy);
        let firsts = self.first_breaks();
        let area: f64 = self.info.iter().flat_map(|info| &info.wires).map(WireInfo::area).sum();
        let stiffness = self.elastic.stiffness(spec);
        let off = stiffness.as_ref().and_then(|s| s.finding(spec));
        let at = Instant { step: self.last.step, time: self.last.time, strain: gripped.then_some(self.last.strain) };
        let mut notices = self.notices.clone();
        notices.extend(off.map(|finding| Notice { at, finding }));
        notices.sort_by_key(|notice| (failure(notice).is_none(), notice.at.step));
        let said = notices.iter().map(Notice::to_string);
        RunSummary {
            scene: spec.name.clone(),
            stopped: closing.stopped,
            stopped_because: because(&closing, notices.first()),
            tensile_strength_mpa: strength.map(|peak| mpa(peak.stress)),
            breaking_force_n: strength.map(|peak| peak.stress * area),
            fracture_elongation_percent: strength.map(|peak| percent(peak.strain)),
            elongation_at_20_percent_drop_percent: drop.map(percent),
            greatest_stress_mpa: tension.map(|peak| mpa(peak.stress)),
            greatest_force_n: tension.map(|peak| peak.stress * area),
            strain_at_greatest_stress_percent: tension.map(|peak| percent(peak.strain)),
            compressive_peak_mpa: compression.map(|peak| mpa(peak.stress)),
            strain_at_compressive_peak_percent: compression.map(|peak| percent(peak.strain)),
            first_rupture: self.ruptures.first().map(|r| self.for_people(r)),
            wires_broken_by_layer: self.broken_by_layer(&firsts),
            wires_broken: firsts.len(),
            breaks_by_layer: by_layer(firsts),
            bonds_broken: self.ruptures.len(),
            final_strain_percent: measured(Some(percent(self.last.strain))),
            residual_stress_mpa: measured(Some(mpa(self.last.stress))),
            stiffness,
            shares_at_greatest_stress: self.shares.clone().filter(|_| tension.is_some()),
            bodies: self.info.as_ref().map_or_else(Vec::new, |info| self.bodies.loads(info, &self.last)),
            energy,
            energy_residual_percent: (energy.work.abs() > negligible).then(|| percent(energy.residual() / energy.work)),
            quasi_static: closing.quasi_static,
            limits: closing.limits,
            mass_scale: spec.time.mass_scale,
            inertia_scale: spec.time.inertia_scale,
            seed: spec.seed,
            one_draw: OneDraw::of(spec),
            particles: self.info.as_ref().map_or(0, |info| info.particles),
            bonds,
            cost: closing.cost,
            written: closing.written,
            warnings: closing.error.into_iter().chain(said).collect(),
            findings: notices.into_iter().map(found).collect(),
        }
    }

    fn for_people(&self, rupture: &Rupture) -> Break {
        let layer = self.info.as_ref().map_or("", |info| layer_name(info, rupture.layer));
        Break {
            order: rupture.order,
            wire: rupture.wire + 1,
            layer: layer.to_string(),
            material: self.info.as_ref().and_then(|info| of_wire(info, rupture.wire)).map(str::to_owned),
            z_mm: mm(rupture.position[2]),
            rest_z_mm: mm(rupture.rest_z),
            strain_percent: percent(rupture.strain),
            stress_mpa: mpa(rupture.stress),
            cause: cause(rupture.cause).to_string(),
        }
    }

    /// First rupture of each wire, in order.
    fn first_breaks(&self) -> Vec<Break> {
        let mut seen = std::collections::BTreeSet::new();
        let first = self.ruptures.iter().filter(|r| seen.insert(r.wire));
        first.map(|r| self.for_people(r)).collect()
    }

    fn broken_by_layer(&self, firsts: &[Break]) -> BTreeMap<String, BrokenOf> {
        let mut layers: BTreeMap<String, BrokenOf> = BTreeMap::new();
        if let Some(info) = &self.info {
            for wire in &info.wires {
                layers.entry(layer_name(info, wire.layer).into()).or_default().of += 1;
            }
        }
        for broken in firsts {
            layers.entry(broken.layer.clone()).or_default().broken += 1;
        }
        layers
    }
}

/// The failure that a notice tells of.
fn failure(notice: &Notice) -> Option<&Failure> {
    match &notice.finding {
        Finding::Failed { failure } => Some(failure),
        _ => None,
    }
}

/// Why a run ended, in words; of an error or a failure, which is the `first` of all notices, what it was.
fn because(closing: &Closing, first: Option<&Notice>) -> String {
    let stopped = || {
        let notice = first?;
        Some(Stopped { at: notice.at, failure: failure(notice)?.clone(), kept: None })
    };
    match (&closing.error, stopped()) {
        (Some(error), _) => format!("an error ended it: {error}"),
        (None, Some(stopped)) => format!("{} at step {}: {}", closing.stopped, stopped.at.step, stopped.why()),
        (None, None) => closing.stopped.to_string(),
    }
}

fn found(Notice { at, finding }: Notice) -> Found {
    Found { step: at.step, time_s: at.time, strain_percent: at.strain.map(percent), finding }
}

fn by_layer(breaks: Vec<Break>) -> BTreeMap<String, Vec<Break>> {
    let mut layers: BTreeMap<String, Vec<Break>> = BTreeMap::new();
    for one in breaks {
        layers.entry(one.layer.clone()).or_default().push(one);
    }
    layers
}

/// What a body was loaded towards.
struct Loading {
    tension: bool,
    compression: bool,
}

impl Loading {
    /// A body that is pulled springs back into compression when it breaks, and one that is pushed rings into tension: neither
    /// is what it was loaded for.
    fn of(spec: &Spec) -> Self {
        match spec.grip.as_ref().map(|grip| grip.drive) {
            Some(DriveSpec::Speed(speed)) => Self { tension: speed >= 0.0, compression: speed < 0.0 },
            Some(DriveSpec::Cyclic { .. }) => Self { tension: true, compression: true },
            None => Self { tension: false, compression: false },
        }
    }
}

impl Observer for Summariser {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        *self = Self { info: Some(info.clone()), ..Self::default() };
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.rows.see(sample.strain, sample.stress, sample.wire_stress.iter().copied());
        self.elastic.add(sample);
        self.bodies.see(sample);
        let info = self.info.as_ref().filter(|info| info.has_several_materials());
        let greatest = &mut self.greatest_force;
        if let Some(info) = info.filter(|info| greatest.see(info, sample)) {
            self.shares = Shares::of(info, sample);
        }
        self.last = sample.clone();
        Ok(())
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.rows.rupture();
        self.ruptures.push(rupture.clone());
        Ok(())
    }

    fn notice(&mut self, notice: &Notice) -> Result<()> {
        renew(&mut self.notices, notice);
        Ok(())
    }

    fn peaks(&mut self, peaks: &Peaks) -> Result<()> {
        self.peaks = Some(peaks.clone());
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests;
