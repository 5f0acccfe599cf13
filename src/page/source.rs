//! Everything that the page is made from, read from a run's folder: also from one whose run did not end.

use super::picture::Pictures;
use super::select;
use super::study::Study;
use crate::base::error::{Error, Result};
use crate::base::finding::StopReason;
use crate::base::regular;
use crate::base::units::{mm, ms, percent};
use crate::engine::view::{BondState, RunInfo, Rupture, Sample, Snapshot};
use crate::observe::Observer;
use crate::observe::guard::{Guard, QuasiStatic};
use crate::observe::origin::Origin;
use crate::observe::partial;
use crate::observe::summary::{Closing, Cost, RunSummary, Summariser};
use crate::observe::trajectory::{Record, Trajectory};
use crate::run::folder::{SCENE, SUMMARY, TRAJECTORY};
use crate::scene::spec::Spec;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A run as its folder tells it.
pub struct Source {
    /// Which run it is.
    pub origin: Origin,
    /// What does not change during the run.
    pub info: Arc<RunInfo>,
    /// `summary.json`, or the same made from the trajectory when the run did not write one.
    pub summary: RunSummary,
    /// Whether the run wrote its summary; what it cost is not known otherwise.
    pub finished: bool,
    /// The resolved scene as text; `None` when its file is missing.
    pub scene: Option<String>,
    /// The same as read by this program; `None` when it cannot be.
    pub spec: Option<Spec>,
    /// Every row of the curve.
    pub samples: Vec<Sample>,
    /// Every rupture, in order.
    pub ruptures: Vec<Rupture>,
    /// Snapshots in the trajectory.
    pub snapshots: usize,
    /// Those of them that the page shows.
    pub states: Vec<State>,
    /// The frames.
    pub pictures: Pictures,
    /// The study of error against run time that goes with it, if there is one; it has a folder of its own, so reading the
    /// run does not find it.
    pub accuracy: Option<Study>,
    /// What is wrong with the folder, in sentences.
    pub notes: Vec<String>,
}

/// One snapshot on the page.
pub struct State {
    /// The row of the curve at this instant.
    pub sample: Sample,
    /// True axial stress of each bond slot (Pa); NaN where no bond holds.
    pub stress: Vec<f32>,
    /// Centres (m), and radii (m); empty where all of them are too much for a page.
    pub position: Vec<[f32; 3]>,
    /// See `position`.
    pub radius: Vec<f32>,
    /// What is special about it.
    pub label: Option<&'static str>,
    /// Its frame.
    pub picture: Option<PathBuf>,
}

/// What one pass over a trajectory gives.
struct Pass {
    samples: Vec<Sample>,
    ruptures: Vec<Rupture>,
    /// The step of each snapshot.
    steps: Vec<u64>,
    /// Bonds at the start.
    bonds: usize,
    summariser: Summariser,
    /// Why reading stopped before the run's end.
    cut: Option<String>,
}

/// Checks that `run` is a folder with a trajectory, without reading it.
///
/// # Errors
/// [`Error::Input`] that says what is missing.
pub fn check(run: &Path) -> Result<()> {
    trajectory_in(run).map(|_| ())
}

/// The trajectory in a run's folder; under its partial name when the run was killed or is still going.
///
/// # Errors
/// [`Error::Input`] that says what is missing.
pub fn trajectory_in(run: &Path) -> Result<PathBuf> {
    let give = "give the folder of a run, such as out/ka4";
    if !run.is_dir() {
        let what = if run.exists() { "is not a folder" } else { "does not exist" };
        return Err(Error::input(format!("{} {what}", run.display()), give));
    }
    let whole = run.join(TRAJECTORY);
    [whole.clone(), partial::name(&whole)].into_iter().find(|file| file.is_file()).ok_or_else(|| {
        Error::input(
            format!("{} holds no {TRAJECTORY}, which the page is made from", run.display()),
            format!("{give}; runs write {TRAJECTORY} themselves"),
        )
    })
}

impl Source {
    /// Reads a run's folder as far as it goes. What is missing but not needed is told in `notes`.
    ///
    /// # Errors
    /// [`Error::Input`] when the folder holds no trajectory, or a damaged one or a damaged summary;
    /// [`Error::Io`] when the file system refuses.
    pub fn read(run: &Path) -> Result<Self> {
        let trajectory = trajectory_in(run)?;
        let opened = open(&trajectory)?;
        let (origin, info) = (opened.origin(), opened.info().clone());
        let pass = first_pass(opened)?;
        if pass.samples.is_empty() {
            return Err(Error::input(
                format!("{} holds no state of the run", trajectory.display()),
                "the run ended before its first step; run it again",
            ));
        }
        let mut notes = Vec::new();
        if let Some(cut) = &pass.cut {
            notes.push(format!(
                "The run did not end properly: this page shows it up to {}. ({cut})",
                last(&pass, &info)
            ));
        }
        let (scene, spec) = read_scene(run, &mut notes)?;
        let (summary, finished) = summary(run, &pass, &info, spec.as_ref(), &mut notes)?;
        let pictures = Pictures::find(run, pass.steps.len())?;
        let chosen = select::states(&pass.samples, &pass.ruptures, &pass.steps, info.is_pulled());
        let states = second_pass(open(&trajectory)?, &chosen, &pictures)?;
        Ok(Self {
            origin,
            info,
            summary,
            finished,
            scene,
            spec,
            snapshots: pass.steps.len(),
            samples: pass.samples,
            ruptures: pass.ruptures,
            states,
            pictures,
            accuracy: None,
            notes,
        })
    }

    /// Shows none of the pictures, as if the run had none.
    pub fn leave_out_pictures(&mut self) {
        self.pictures = Pictures::default();
        self.states.iter_mut().for_each(|state| state.picture = None);
    }

    /// How many states have a picture.
    pub fn pictures_shown(&self) -> usize {
        self.states.iter().filter(|state| state.picture.is_some()).count()
    }

    /// z of mid-length before loading: half-way between the grips (mm). `None` for free bodies.
    pub fn mid_length(&self) -> Option<f64> {
        self.info.gauge.map(|[low, high]| mm(0.5 * (low + high)))
    }

    /// The step of the first rupture.
    pub fn first_rupture_step(&self) -> Option<u64> {
        self.ruptures.first().map(|rupture| rupture.step)
    }

    /// Whether somebody or something ended the run before its own conditions did.
    pub fn cut_short(&self) -> bool {
        !self.finished || self.summary.stopped.cut_short()
    }
}

/// Damage in a file's head is bad input, as damage anywhere else is; a file that may not be read is not.
fn open(path: &Path) -> Result<Trajectory> {
    use std::io::ErrorKind::{InvalidData, UnexpectedEof};
    Trajectory::open(path).map_err(|error| match error {
        Error::Io { path, cause, .. } if [InvalidData, UnexpectedEof].contains(&cause.kind()) => {
            Error::input(format!("{} is damaged: {cause}", path.display()), "run the scene again")
        }
        other => other,
    })
}

fn first_pass(trajectory: Trajectory) -> Result<Pass> {
    let mut pass = Pass {
        samples: Vec::new(),
        ruptures: Vec::new(),
        steps: Vec::new(),
        bonds: 0,
        summariser: Summariser::new(),
        cut: None,
    };
    pass.summariser.start(trajectory.info())?;
    for record in trajectory {
        match record {
            Ok(Record::Sample(sample)) => {
                pass.summariser.sample(&sample)?;
                pass.samples.push(sample);
            }
            Ok(Record::Rupture(rupture)) => {
                pass.summariser.rupture(&rupture)?;
                pass.ruptures.push(rupture);
            }
            Ok(Record::Snapshot(snapshot)) => {
                if pass.steps.is_empty() {
                    pass.bonds = snapshot.bond_state.iter().filter(|s| **s != BondState::Absent).count();
                }
                pass.steps.push(snapshot.sample.step);
            }
            Ok(Record::Notice(notice)) => pass.summariser.notice(&notice)?,
            Ok(Record::Peaks(peaks)) => pass.summariser.peaks(&peaks)?,
            Err(error) => pass.cut = Some(error.to_string()),
        }
    }
    Ok(pass)
}

/// The chosen snapshots, in order; one at a time is in memory.
fn second_pass(trajectory: Trajectory, chosen: &[select::SelectedSnapshot], pictures: &Pictures) -> Result<Vec<State>> {
    let mut wanted = chosen.iter().peekable();
    let mut states = Vec::new();
    let snapshots = trajectory.filter_map(|record| match record {
        Ok(Record::Snapshot(snapshot)) => Some(snapshot),
        _ => None,
    });
    for (number, snapshot) in snapshots.enumerate() {
        if let Some(one) = wanted.next_if(|one| one.number == number) {
            let picture = pictures.of(number);
            let stress = held(&snapshot);
            let (position, radius) = if select::places_fit(stress.len(), chosen.len()) {
                (snapshot.position, snapshot.radius)
            } else {
                Default::default()
            };
            states.push(State { stress, position, radius, sample: snapshot.sample, label: one.label, picture });
        }
    }
    Ok(states)
}

fn held(snapshot: &Snapshot) -> Vec<f32> {
    let slots = snapshot.bond_stress.iter().zip(&snapshot.bond_state);
    slots.map(|(stress, state)| if state.holds() { *stress } else { f32::NAN }).collect()
}

fn last(pass: &Pass, info: &RunInfo) -> String {
    let sample = &pass.samples[pass.samples.len() - 1];
    if info.is_pulled() {
        format!("step {} at {:.2} % strain", sample.step, percent(sample.strain))
    } else {
        format!("step {} at {:.4} ms", sample.step, ms(sample.time))
    }
}

/// The text of a file; `None` when there is none.
fn text(path: &Path) -> Result<Option<String>> {
    regular::text_if_there(path, regular::LONGEST_TABLE)
}

fn read_scene(run: &Path, notes: &mut Vec<String>) -> Result<(Option<String>, Option<Spec>)> {
    let path = run.join(SCENE);
    let Some(text) = text(&path)? else {
        notes.push(format!("{SCENE} is missing from the folder: the scene and its limits are not known."));
        return Ok((None, None));
    };
    match crate::scene::parse(&text, SCENE, run, &[]) {
        Ok(scene) => Ok((Some(text), Some(scene.spec))),
        Err(error) => {
            notes.push(format!("{SCENE} cannot be read by this program, so the run's limits are not known: {error}."));
            Ok((Some(text), None))
        }
    }
}

/// How far from quasi-static loading was, judged again from the rows.
fn quasi_static(pass: &Pass, info: &RunInfo, spec: &Spec) -> QuasiStatic {
    let mut guard = Guard::new(&spec.time);
    guard.start(info);
    let mut ruptures = pass.ruptures.iter().peekable();
    for sample in &pass.samples {
        while let Some(rupture) = ruptures.next_if(|rupture| rupture.step <= sample.step) {
            guard.rupture(rupture);
        }
        if guard.row(sample).is_err() {
            // The ledger is open: the run has said so, in its own notices.
            break;
        }
    }
    guard.quasi_static()
}

/// The summary, and whether the run itself wrote it.
fn summary(
    run: &Path,
    pass: &Pass,
    info: &RunInfo,
    spec: Option<&Spec>,
    notes: &mut Vec<String>,
) -> Result<(RunSummary, bool)> {
    let path = run.join(SUMMARY);
    if let Some(text) = text(&path)? {
        let summary: RunSummary = serde_json::from_str(&text).map_err(|e| {
            Error::input(
                format!("{} is damaged or of another version of strandsnap: {e}", path.display()),
                "run the scene again with this program",
            )
        })?;
        let (rows, ruptures) = (pass.samples.last().map(|s| s.step), pass.ruptures.len());
        // A run that failed may have gone on after its last row, which would not have been finite.
        let went_on = summary.stopped == StopReason::Failed && rows.is_some_and(|row| row < summary.cost.steps);
        let same = (went_on || rows == Some(summary.cost.steps)) && ruptures == summary.bonds_broken;
        if pass.cut.is_none() && !same {
            return Err(Error::input(
                format!(
                    "{SUMMARY} and {TRAJECTORY} in {} are not of one run: {} steps and {} broken bonds against {} and {}",
                    run.display(),
                    summary.cost.steps,
                    summary.bonds_broken,
                    rows.unwrap_or(0),
                    ruptures
                ),
                "run the scene again into an empty folder",
            ));
        }
        return Ok((summary, true));
    }
    let Some(spec) = spec else {
        return Err(Error::input(
            format!("{} holds neither {SUMMARY} nor a {SCENE} to make it from", run.display()),
            "give the folder of a run as strandsnap wrote it",
        ));
    };
    if pass.cut.is_none() {
        notes.push(format!("{SUMMARY} is missing: the numbers here are made from the trajectory."));
    }
    let last = &pass.samples[pass.samples.len() - 1];
    let cost = Cost { steps: last.step, simulated_s: last.time, ..Cost::default() };
    let closing = Closing { quasi_static: quasi_static(pass, info, spec), cost, ..Closing::default() };
    Ok((pass.summariser.summary(spec, pass.bonds, closing), false))
}
