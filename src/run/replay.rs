//! Shows a finished run to an observer again, from its trajectory, without simulating.

use super::folder::TRAJECTORY;
use super::identity::Doubt;
use crate::base::digest::Digest;
use crate::base::error::{Error, Result};
use crate::engine::view::{RunInfo, Rupture};
use crate::observe::origin::Origin;
use crate::observe::trajectory::{Record, Trajectory};
use crate::observe::{Observer, partial};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What the name of a run gets that was not finished, and of one whose files were changed.
const CUT_OFF: &str = "run not finished";
const DOUBTED: &str = "files changed since the run";

/// Which snapshots of a run to show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Selection {
    /// Strain of the body, from and to, both included (-).
    pub strain: [f64; 2],
    /// Of those, only the last one before and the first one after each rupture, the first and the last.
    pub events: bool,
    /// Of those, every how many; 1 is all.
    pub every: usize,
}

impl Default for Selection {
    fn default() -> Self {
        Self { strain: [f64::NEG_INFINITY, f64::INFINITY], events: false, every: 1 }
    }
}

/// What a selection needs to know of a snapshot.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Moment {
    /// Strain of the body (-).
    strain: f64,
    /// A bond broke since the snapshot before.
    broke: bool,
}

impl Selection {
    /// Whether each of a run's snapshots is shown.
    fn of(&self, moments: &[Moment]) -> Vec<bool> {
        let [from, to] = self.strain;
        let inside = |i: usize| (from..=to).contains(&moments[i].strain);
        let all = 0..moments.len();
        let (first, last) = (all.clone().find(|i| inside(*i)), all.clone().rev().find(|i| inside(*i)));
        let event = |i: usize| {
            let breaks_next = moments.get(i + 1).is_some_and(|next| next.broke);
            moments[i].broke || breaks_next || Some(i) == first || Some(i) == last
        };
        let mut wanted = 0;
        all.map(|i| {
            let want = inside(i) && (!self.events || event(i));
            wanted += usize::from(want);
            want && (wanted - 1).is_multiple_of(self.every.max(1))
        })
        .collect()
    }
}

/// A run whose snapshots were looked through and chosen from.
pub struct Replay {
    file: PathBuf,
    origin: Origin,
    shown: Vec<bool>,
    /// Records that can be read: all, unless the run was cut off.
    records: usize,
    /// Why the trajectory ends before its run did.
    cut_off: Option<Error>,
    /// Every rupture, in order.
    ruptures: Vec<Rupture>,
    /// Files of the run are not believed.
    doubted: bool,
}

impl Replay {
    /// Looks through the trajectory of a run, given its folder or the file itself. That of a program that was killed
    /// is good up to where it was cut off.
    ///
    /// # Errors
    /// [`Error::Input`] when there is none or nothing in it is selected; [`Error::Io`] when it is damaged.
    pub fn open(run: &Path, selection: &Selection) -> Result<Self> {
        let file = trajectory_of(run)?;
        let (mut moments, mut records, mut cut_off, mut broke) = (Vec::new(), 0, None, false);
        let mut ruptures = Vec::new();
        let trajectory = Trajectory::open(&file)?;
        let origin = trajectory.origin();
        for record in trajectory {
            match record {
                Ok(Record::Rupture(rupture)) => {
                    broke = true;
                    ruptures.push(rupture);
                }
                Ok(Record::Snapshot(snapshot)) => {
                    moments.push(Moment { strain: snapshot.sample.strain, broke: std::mem::take(&mut broke) });
                }
                Ok(Record::Sample(_) | Record::Notice(_) | Record::Peaks(_)) => {}
                Err(error) if is_cut_off(&error) => cut_off = Some(error),
                Err(error) => return Err(error),
            }
            records += usize::from(cut_off.is_none());
        }
        let shown = selection.of(&moments);
        if !shown.contains(&true) {
            return Err(match cut_off {
                Some(error) if moments.is_empty() => error,
                _ => Error::input(
                    format!("no snapshot of {} lies in that range of strain", run.display()),
                    "widen --strain-range",
                ),
            });
        }
        Ok(Self { file, origin, shown, records, cut_off, ruptures, doubted: false })
    }

    /// Says with everything that is shown that files of the run are doubtful, if there are such `doubts`.
    pub fn doubting(self, doubts: &[Doubt]) -> Self {
        Self { doubted: !doubts.is_empty(), ..self }
    }

    /// The run as it is shown: its name says what must be known of it.
    fn info(&self, own: &Arc<RunInfo>) -> Arc<RunInfo> {
        let marks = [(self.cut_off.is_some(), CUT_OFF), (self.doubted, DOUBTED)];
        let marks: Vec<&str> = marks.into_iter().filter(|(holds, _)| *holds).map(|(_, mark)| mark).collect();
        match marks.is_empty() {
            true => own.clone(),
            false => Arc::new(RunInfo { name: format!("{} ({})", own.name, marks.join(", ")), ..own.as_ref().clone() }),
        }
    }

    /// Which run it is.
    pub fn origin(&self) -> Origin {
        self.origin
    }

    /// What is shown: of which run, which of its snapshots, and with which marks.
    pub fn digest(&self) -> Digest {
        let marks = [self.cut_off.is_some(), self.doubted];
        Digest::of(format!("{} {:?} {} {marks:?}", self.origin.run, self.shown, self.records))
    }

    /// How many snapshots are selected.
    pub fn count(&self) -> usize {
        self.shown.iter().filter(|shown| **shown).count()
    }

    /// Every rupture of the run, in order, whichever of its snapshots are shown.
    pub fn ruptures(&self) -> &[Rupture] {
        &self.ruptures
    }

    /// Why the trajectory ends before its run did, if so.
    pub fn cut_off(&self) -> Option<&Error> {
        self.cut_off.as_ref()
    }

    /// Shows the selected snapshots, and every row and rupture, to `observer` until `stop` is set. Returns how many
    /// snapshots it showed.
    ///
    /// # Errors
    /// What the trajectory or the observer says. The observer is finished in any case, once it was started.
    pub fn show(&self, observer: &mut dyn Observer, stop: &AtomicBool) -> Result<usize> {
        let trajectory = Trajectory::open(&self.file)?;
        observer.start(&self.info(trajectory.info()))?;
        let shown = self.pass_on(trajectory, observer, stop);
        observer.finish_unless(stop)?;
        shown
    }

    fn pass_on(&self, trajectory: Trajectory, observer: &mut dyn Observer, stop: &AtomicBool) -> Result<usize> {
        let (mut shown, mut selected) = (0, self.shown.iter());
        for record in trajectory.take(self.records) {
            if stop.load(Ordering::Relaxed) {
                break;
            }
            match record? {
                Record::Sample(sample) => observer.sample(&sample)?,
                Record::Rupture(rupture) => observer.rupture(&rupture)?,
                Record::Notice(notice) => observer.notice(&notice)?,
                Record::Peaks(peaks) => observer.peaks(&peaks)?,
                Record::Snapshot(snapshot) => {
                    if selected.next() == Some(&true) {
                        observer.snapshot(&Arc::new(snapshot))?;
                        shown += 1;
                    }
                }
            }
        }
        Ok(shown)
    }
}

/// The trajectory of a run, given its folder or the file itself; under its partial name when the run was killed.
fn trajectory_of(run: &Path) -> Result<PathBuf> {
    let file = if run.is_dir() { run.join(TRAJECTORY) } else { run.to_path_buf() };
    let partial = partial::name(&file);
    let found = [file, partial].into_iter().find(|file| file.is_file());
    found.ok_or_else(|| {
        Error::input(
            format!("there is no trajectory at {}", run.display()),
            "give the folder of a run, such as out/ka4, or its trajectory.bin",
        )
    })
}

fn is_cut_off(error: &Error) -> bool {
    matches!(error, Error::Io { cause, .. } if cause.kind() == ErrorKind::UnexpectedEof)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Strains 0, 0.1, … with ruptures before the given snapshots.
    fn moments(count: usize, broke: &[usize]) -> Vec<Moment> {
        (0..count).map(|i| Moment { strain: 0.1 * i as f64, broke: broke.contains(&i) }).collect()
    }

    fn numbers(selection: Selection, moments: &[Moment]) -> Vec<usize> {
        selection.of(moments).iter().enumerate().filter(|(_, shown)| **shown).map(|(i, _)| i).collect()
    }

    #[test]
    fn events_are_the_states_around_each_rupture_and_both_ends() {
        let events = Selection { events: true, ..Selection::default() };
        assert_eq!(numbers(events, &moments(12, &[4, 5, 9])), [0, 3, 4, 5, 8, 9, 11]);
        assert_eq!(numbers(events, &moments(3, &[])), [0, 2]);
        assert_eq!(numbers(events, &moments(3, &[0, 2])), [0, 1, 2]);
        assert_eq!(numbers(events, &moments(1, &[])), [0]);
    }

    #[test]
    fn every_counts_what_the_other_options_leave() {
        let part = Selection { strain: [0.15, 0.75], ..Selection::default() };
        assert_eq!(numbers(part, &moments(12, &[])), [2, 3, 4, 5, 6, 7]);
        assert_eq!(numbers(Selection { every: 3, ..part }, &moments(12, &[])), [2, 5]);
        assert_eq!(numbers(Selection { events: true, ..part }, &moments(12, &[5])), [2, 4, 5, 7]);
        assert_eq!(numbers(Selection { events: true, every: 2, ..part }, &moments(12, &[5])), [2, 5]);
        assert!(numbers(Selection { strain: [3.0, 4.0], ..part }, &moments(12, &[])).is_empty());
    }
}
