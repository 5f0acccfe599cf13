//! Choosing from a finished run, on one that was not simulated.

mod synthetic;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use strandsnap::base::error::{Error, Result};
use strandsnap::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use strandsnap::observe::Observer;
use strandsnap::observe::origin::Origin;
use strandsnap::observe::trajectory::TrajectoryWriter;
use strandsnap::run::replay::{Replay, Selection};
use synthetic::Run;

/// Strains of the snapshots shown, each with how many bonds had broken by then, and the rows seen.
#[derive(Default)]
struct Seen {
    snapshots: Vec<(f64, usize)>,
    broken: usize,
    rows: usize,
    finished: usize,
}

impl Observer for Seen {
    fn start(&mut self, _info: &Arc<RunInfo>) -> Result<()> {
        Ok(())
    }
    fn sample(&mut self, _sample: &Sample) -> Result<()> {
        self.rows += 1;
        Ok(())
    }
    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        self.snapshots.push((snapshot.sample.strain, self.broken));
        Ok(())
    }
    fn rupture(&mut self, _rupture: &Rupture) -> Result<()> {
        self.broken += 1;
        Ok(())
    }
    fn finish(&mut self) -> Result<()> {
        self.finished += 1;
        Ok(())
    }
}

fn written(run: &Run, folder: &Path) {
    run.show(&mut TrajectoryWriter::new(&folder.join("trajectory.bin"), Origin::default()).unwrap()).unwrap();
}

fn shown(folder: &Path, selection: Selection) -> Seen {
    let mut seen = Seen::default();
    let replay = Replay::open(folder, &selection).unwrap();
    let count = replay.show(&mut seen, &AtomicBool::new(false)).unwrap();
    assert_eq!((count, replay.count()), (seen.snapshots.len(), seen.snapshots.len()));
    assert_eq!(seen.finished, 1);
    seen
}

#[test]
fn every_row_and_rupture_is_shown_whatever_is_selected() {
    let (run, folder) = (Run::new(40), tempfile::tempdir().unwrap());
    written(&run, folder.path());
    let seen = shown(folder.path(), Selection::default());
    assert_eq!((seen.snapshots.len(), seen.rows, seen.broken), (40, 400, 6));
    let some = shown(folder.path(), Selection { every: 7, ..Selection::default() });
    assert_eq!((some.snapshots.len(), some.rows, some.broken), (6, 400, 6));
}

#[test]
fn events_show_the_strand_before_and_after_each_rupture() {
    let (run, folder) = (Run::new(120), tempfile::tempdir().unwrap());
    written(&run, folder.path());
    let seen = shown(folder.path(), Selection { events: true, ..Selection::default() });
    let all: Vec<f64> = run.snapshots().iter().map(|s| s.sample.strain).collect();
    let strains: Vec<f64> = seen.snapshots.iter().map(|(strain, _)| *strain).collect();
    for rupture in run.ruptures() {
        let after = all.iter().position(|strain| *strain >= rupture.strain).unwrap();
        assert!(strains.contains(&all[after]) && strains.contains(&all[after - 1]), "{rupture:?}");
    }
    assert_eq!((strains[0], strains[strains.len() - 1]), (all[0], all[119]));
    assert!(strains.len() <= 2 + 2 * 6, "{strains:?}");
    let broken: Vec<usize> = seen.snapshots.iter().map(|(_, broken)| *broken).collect();
    assert!((1..=6).all(|n| broken.contains(&n)), "every number of broken wires is seen: {broken:?}");
}

#[test]
fn a_range_with_nothing_in_it_is_refused() {
    let (run, folder) = (Run::new(10), tempfile::tempdir().unwrap());
    written(&run, folder.path());
    let range = Selection { strain: [0.9, 1.0], ..Selection::default() };
    let error = Replay::open(folder.path(), &range).err().unwrap();
    assert!(matches!(error, Error::Input { .. }), "{error}");
}

#[test]
fn a_run_that_was_killed_is_shown_as_far_as_it_got() {
    let (run, folder) = (Run::new(12), tempfile::tempdir().unwrap());
    written(&run, folder.path());
    let file = folder.path().join("trajectory.bin");
    let bytes = std::fs::read(&file).unwrap();
    std::fs::write(folder.path().join("trajectory.bin.partial"), &bytes[..bytes.len() / 2]).unwrap();
    std::fs::remove_file(&file).unwrap();
    let replay = Replay::open(folder.path(), &Selection::default()).unwrap();
    assert!(replay.cut_off().unwrap().to_string().contains("cut off"));
    let mut seen = Seen::default();
    let count = replay.show(&mut seen, &AtomicBool::new(false)).unwrap();
    assert!((3..9).contains(&count) && count == replay.count(), "{count} of 12");
    assert_eq!(seen.finished, 1);
}

#[test]
fn a_run_that_is_whole_is_not_said_to_be_cut_off() {
    let (run, folder) = (Run::new(3), tempfile::tempdir().unwrap());
    written(&run, folder.path());
    assert!(Replay::open(folder.path(), &Selection::default()).unwrap().cut_off().is_none());
}

#[test]
fn stopping_finishes_what_was_shown() {
    let (run, folder) = (Run::new(3), tempfile::tempdir().unwrap());
    written(&run, folder.path());
    let mut seen = Seen::default();
    let replay = Replay::open(folder.path(), &Selection::default()).unwrap();
    assert_eq!(replay.show(&mut seen, &AtomicBool::new(true)).unwrap(), 0);
    assert_eq!(seen.finished, 1);
}
