//! All files of a run, read once.

use super::finding::Search;
use super::limits::Limits;
use super::maker::{Maker, Remade};
use super::tables::Table;
use crate::base::error::{Error, Result};
use crate::base::finding::Notice;
use crate::base::regular;
use crate::engine::Engine;
use crate::engine::view::{BondState, RunInfo, Rupture, Sample, Snapshot};
use crate::observe::bodies::BODIES;
use crate::observe::origin::Origin;
use crate::observe::trajectory::{Record, Trajectory};
use crate::observe::{partial, tables};
use crate::run::RunSummary;
use crate::run::folder::{SCENE, SUMMARY, TRAJECTORY, has_checkpoint};
use crate::run::identity::{self, Doubt, Seal};
use crate::run::lock;
use crate::scene::spec::Spec;
use crate::strand::assembly::Assembly;
use crate::strand::held::Gripped;
use crate::strand::theory::Theory;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Columns of `curve.csv` that every run has, but for those of layers.
pub const CURVE: [&str; 22] = [
    "step",
    "time_s",
    "strain_percent",
    "stress_mpa",
    "grip_force_lower_n",
    "grip_force_upper_n",
    "torque_n_mm",
    "wires_broken",
    "bonds_broken",
    "contacts",
    "time_step_s",
    "work_j",
    "kinetic_j",
    "elastic_bonds_j",
    "elastic_contacts_j",
    "plastic_bonds_j",
    "plastic_contacts_j",
    "plastic_thinning_j",
    "friction_j",
    "damping_j",
    "released_j",
    "residual_j",
];

/// The terms of a row's ledger (J), in the order of [`CURVE`].
pub fn energies(row: &Sample) -> Vec<f64> {
    let e = &row.energy;
    vec![
        e.work,
        e.kinetic,
        e.elastic_bonds,
        e.elastic_contacts,
        e.plastic_bonds,
        e.plastic_contacts,
        e.plastic_thinning,
        e.friction,
        e.damping,
        e.released,
    ]
}

const WIRES: [&str; 10] = [
    "wire",
    "layer",
    "diameter_mm",
    "greatest_stress_mpa",
    "strain_at_greatest_stress_percent",
    "broken",
    "first_rupture_z_mm",
    "first_rupture_strain_percent",
    "first_rupture_order",
    "first_rupture_cause",
];
const RUPTURES: [&str; 12] = [
    "order",
    "step",
    "time_s",
    "strain_percent",
    "wire",
    "layer",
    "bond",
    "z_mm",
    "rest_z_mm",
    "cause",
    "stress_mpa",
    "body_stress_mpa",
];

/// A run as its files tell it.
pub struct Folder {
    /// The folder.
    pub path: PathBuf,
    /// What says that its files are not of one run.
    pub doubts: Vec<Doubt>,
    /// The scene.
    pub spec: Spec,
    /// Strand theory of its bodies, whatever loads them.
    pub theory: Option<Theory>,
    /// What does not change of its bodies, made anew from the scene.
    pub made: RunInfo,
    /// Length between the last particles that one grip holds and those that the other does (m); `None` without grips.
    pub free_length: Option<f64>,
    /// `summary.json`.
    pub summary: RunSummary,
    /// The same as it stands there, its seal included.
    pub summary_as_written: Value,
    /// Its seal, if it is whole.
    pub seal: Option<Seal>,
    /// `curve.csv`.
    pub curve: Table,
    /// `wires.csv`.
    pub wires: Table,
    /// `ruptures.csv`.
    pub ruptures: Table,
    /// `bodies.csv`, where there are rigid bodies.
    pub bodies: Option<Table>,
    /// What the trajectory holds besides snapshots.
    pub trajectory: History,
    /// What was looked for in each snapshot: they are too many to be kept.
    pub snapshots: Snapshots,
    /// Mass that moves with the drive's speed in the even field of a pull, Σ m s², s a particle's share of that speed (kg).
    pub affine_mass: f64,
    /// Tables and summary as the program makes them of scene and trajectory.
    pub anew: Remade,
}

/// The trajectory without its snapshots.
pub struct History {
    /// What does not change.
    pub info: Arc<RunInfo>,
    /// Rows.
    pub samples: Vec<Sample>,
    /// Ruptures.
    pub ruptures: Vec<Rupture>,
    /// Notices.
    pub notices: Vec<Notice>,
    /// Which run it is of.
    pub origin: Origin,
    /// Steps of its snapshots.
    pub snapshots: Vec<u64>,
    /// The last of them.
    pub last: Option<Snapshot>,
}

/// What is looked for in snapshots.
pub struct Snapshots {
    /// Their rows against the curve's of the same step; 1 where they differ.
    pub rows: Search,
    /// Stress of broken bonds (MPa).
    pub silent: Search,
    /// Stress of whole bonds over what their law allows, less 1 (-).
    pub law: Search,
    /// Plastic strain of whole bonds over that at which they break, less 1 (-).
    pub rupture: Search,
}

impl Folder {
    /// Reads the folder `run`.
    ///
    /// # Errors
    /// [`Error::Input`] when it is no folder of a run, of one that did not end, or a file in it is damaged or of another
    /// run; [`Error::Io`] when the file system refuses.
    pub fn read(run: &Path) -> Result<Self> {
        check_files(run)?;
        let text = |name: &str| regular::text(&run.join(name), regular::LONGEST_TABLE);
        let scene = crate::scene::parse(&text(SCENE)?, SCENE, run, &[])?;
        let assembly = crate::run::assemble(&scene)?;
        let (bonds, made) = (assembly.bond_count(), Engine::new(&scene.spec, &scene.plan, assembly.clone())?.info());
        let affine_mass = affine_mass(&assembly, &made);
        let spec = scene.spec;
        let damaged = |e: serde_json::Error| {
            Error::input(
                format!("{} is damaged or of another version of strandsnap: {e}", run.join(SUMMARY).display()),
                "run the scene again with this program",
            )
        };
        let written = text(SUMMARY)?;
        let summary: RunSummary = serde_json::from_str(&written).map_err(damaged)?;
        let summary_as_written = serde_json::from_str(&written).map_err(damaged)?;
        let [curve, wires, ruptures] = tables::FILES;
        let (trajectory, snapshots, maker) =
            told(&run.join(TRAJECTORY), &spec, summary.limits.greatest_time_step.seconds)?;
        let free = spec.grip.as_ref().map(|grip| Gripped::of(grip, &assembly).free_length());
        Ok(Self {
            path: run.into(),
            doubts: identity::doubts(run)?,
            theory: Theory::of(&spec),
            free_length: free.filter(|length| *length > 0.0),
            affine_mass,
            anew: maker.end(&spec, &summary, bonds)?,
            made,
            summary,
            summary_as_written,
            seal: identity::unsealed(&written),
            curve: Table::read(run, curve, &CURVE)?,
            wires: Table::read(run, wires, &WIRES)?,
            ruptures: Table::read(run, ruptures, &RUPTURES)?,
            bodies: (!spec.rigids.is_empty()).then(|| Table::read(run, BODIES, &[])).transpose()?,
            trajectory,
            snapshots,
            spec,
        })
    }

    /// Whether grips strain a body, so that there is a stress and a strain.
    pub fn is_gripped(&self) -> bool {
        self.trajectory.info.gauge.is_some()
    }

    /// Whether the run drew frames, all of them: those of one that an error ended may be fewer.
    pub fn drew_frames(&self) -> bool {
        let told = self.summary.written.as_ref().map_or(self.summary.cost.frames.is_some(), |written| written.frames);
        told && self.summary.warnings.len() <= self.summary.findings.len()
    }

    /// The longest step of the run (s).
    pub fn longest_step(&self) -> f64 {
        self.summary.limits.greatest_time_step.seconds
    }

    /// Step of the first rupture; none: beyond all.
    pub fn first_rupture(&self) -> u64 {
        self.trajectory.ruptures.first().map_or(u64::MAX, |r| r.step)
    }

    /// Section of all wires before loading (m²).
    pub fn area(&self) -> f64 {
        // The scene has the diameters in double precision.
        let laid = self.spec.strand.iter().flat_map(|s| &s.layers).map(|l| l.wires as f64 * l.wire_diameter.powi(2));
        let single = self.spec.wires.iter().map(|w| w.diameter.powi(2));
        std::f64::consts::FRAC_PI_4 * laid.chain(single).sum::<f64>()
    }

    /// Bonds of wire `w` whose mean is its stress: those within a fortieth of the gauge around its middle, or the nearest.
    pub fn middle(&self, w: usize) -> Vec<usize> {
        let info = &self.trajectory.info;
        let wire = &info.wires[w];
        let Some([low, high]) = info.gauge.filter(|[low, high]| high > low) else { return Vec::new() };
        let z = |slot: usize| 0.5 * f64::from(info.rest_position[slot][2] + info.rest_position[slot + 1][2]);
        let off = |slot: usize| (z(slot) - 0.5 * (low + high)).abs();
        let bonds = wire.first..(wire.first + wire.len).saturating_sub(1);
        // Positions are in single precision here: bonds on the edge, and those as near as the nearest, are taken in, so that
        // all of them must be broken.
        let least = bonds.clone().map(off).fold(f64::INFINITY, f64::min);
        let within = (0.025 * (high - low)).max(least) + 1e-4 * (high - low);
        bonds.filter(|slot| off(*slot) <= within).collect()
    }
}

/// See [`Folder::affine_mass`].
fn affine_mass(assembly: &Assembly, info: &RunInfo) -> f64 {
    let Some([low, high]) = info.gauge else { return 0.0 };
    let share = |z: f64| ((z - low) / (high - low)).clamp(0.0, 1.0);
    assembly.mass.iter().zip(&assembly.position.z).map(|(mass, z)| mass * share(*z).powi(2)).sum()
}

/// Every file that a whole run writes must be there under its own name.
fn check_files(run: &Path) -> Result<()> {
    let give = "give the folder of a run, such as out/ka4";
    if !run.is_dir() {
        let what = if run.exists() { "is not a folder" } else { "does not exist" };
        return Err(Error::input(format!("{} {what}", run.display()), give));
    }
    let needed: Vec<&str> = [SCENE, SUMMARY, TRAJECTORY].into_iter().chain(tables::FILES).collect();
    let partial: Vec<&str> = needed.iter().copied().filter(|name| partial::name(&run.join(name)).exists()).collect();
    if !partial.is_empty() {
        let are = if partial.len() == 1 { "is" } else { "are" };
        return Err(Error::input(
            format!("{}: the run has not ended, {} {are} unfinished", run.display(), listed(&partial)),
            how_to_go_on(run),
        ));
    }
    let missing: Vec<&str> = needed.into_iter().filter(|name| !run.join(name).is_file()).collect();
    if missing.is_empty() {
        return Ok(());
    }
    Err(Error::input(format!("{} holds no {}", run.display(), missing.join(", no ")), give))
}

/// What to do about a run that has not ended.
fn how_to_go_on(run: &Path) -> String {
    if let Some(by) = lock::holder(run) {
        return format!("wait for its end: process {by} writes into it");
    }
    match has_checkpoint(run) {
        true => format!("go on with it: strandsnap resume {}", run.display()),
        false => "it has kept no checkpoint: run the scene again".into(),
    }
}

/// Names in a row: "a, b and c".
fn listed(names: &[&str]) -> String {
    match names {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        _ => names.join(", "),
    }
}

fn told(path: &Path, spec: &Spec, longest_step: f64) -> Result<(History, Snapshots, Maker)> {
    let damaged = |e: Error| Error::input(format!("{} is damaged: {e}", path.display()), "run the scene again");
    let trajectory = Trajectory::open(path).map_err(damaged)?;
    let info = trajectory.info().clone();
    let limits = Limits::new(spec, &info, longest_step);
    let mut made = Maker::new(&info)?;
    let mut told = History {
        info,
        samples: Vec::new(),
        ruptures: Vec::new(),
        notices: Vec::new(),
        origin: trajectory.origin(),
        snapshots: Vec::new(),
        last: None,
    };
    let mut seen = Snapshots { rows: Search::new(), silent: Search::new(), law: Search::new(), rupture: Search::new() };
    let mut broken: BTreeMap<usize, u64> = BTreeMap::new();
    for record in trajectory {
        let record = record.map_err(damaged)?;
        made.take(&record)?;
        match record {
            Record::Sample(sample) => told.samples.push(sample),
            Record::Rupture(rupture) => {
                broken.entry(rupture.bond).or_insert(rupture.step);
                told.ruptures.push(rupture);
            }
            Record::Notice(notice) => told.notices.push(notice),
            Record::Peaks(_) => {}
            Record::Snapshot(snapshot) => {
                seen.snapshot(&snapshot, &told, &broken, &limits);
                told.snapshots.push(snapshot.sample.step);
                told.last = Some(snapshot);
            }
        }
    }
    Ok((told, seen, made))
}

impl Snapshots {
    fn snapshot(&mut self, now: &Snapshot, told: &History, broken: &BTreeMap<usize, u64>, limits: &Limits) {
        let step = now.sample.step;
        // The snapshot comes after its row, at times after later ones: it may have been kept until the next rupture.
        let row = told.samples.iter().rev().find(|row| row.step <= step);
        self.rows.add(f64::from(u8::from(row != Some(&now.sample))), || format!("snapshot at step {step}"));
        for (slot, state) in now.bond_state.iter().enumerate() {
            let place = || format!("{} at step {step}", bond(&told.info, slot));
            let stress = f64::from(now.bond_stress[slot]) * 1e-6;
            let broke = broken.get(&slot).is_some_and(|at| *at <= step);
            if broke || *state == BondState::Broken {
                self.silent.add(stress.abs(), || format!("{}: {stress} MPa", place()));
            } else if *state != BondState::Absent {
                let p = f64::from(now.plastic_strain[slot]);
                if let Some(allowed) = limits.bond(slot, p, stretch(now, &told.info, slot)) {
                    self.law.add(stress.abs() / allowed - 1.0, || {
                        format!("{}: {stress:.2} MPa, its law allows {allowed:.2}", place())
                    });
                }
                if let Some(limit) = limits.plastic(slot) {
                    self.rupture.add(p / limit - 1.0, || format!("{}: p = {p:.5}, breaks at {limit:.5}", place()));
                }
            }
        }
    }
}

/// Log strain of a bond by the positions of its particles, and its rest length (m).
fn stretch(now: &Snapshot, info: &RunInfo, slot: usize) -> [f64; 2] {
    let length = |x: &[[f32; 3]]| {
        let [a, b] = [x[slot], x[slot + 1]];
        (0..3).map(|k| (f64::from(b[k]) - f64::from(a[k])).powi(2)).sum::<f64>().sqrt()
    };
    let rest = length(&info.rest_position);
    [(length(&now.position) / rest).ln(), rest]
}

/// A bond for people.
pub fn bond(info: &RunInfo, slot: usize) -> String {
    let wire = info.wires.iter().position(|w| (w.first..w.first + w.len).contains(&slot));
    wire.map_or_else(|| format!("slot {slot}"), |w| format!("wire {}, bond {}", w + 1, slot - info.wires[w].first + 1))
}
