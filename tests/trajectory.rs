//! The trajectory, read back.

mod synthetic;

use std::path::{Path, PathBuf};
use strandsnap::base::error::Error;
use strandsnap::observe::origin::Origin;
use strandsnap::observe::trajectory::{Record, Trajectory, TrajectoryWriter};
use synthetic::{Event, Run};

fn written(run: &Run, folder: &Path) -> PathBuf {
    let file = folder.join("trajectory.bin");
    run.show(&mut TrajectoryWriter::new(&file, Origin::default()).unwrap()).unwrap();
    file
}

fn record(event: &Event) -> Record {
    match event {
        Event::Sample(sample) => Record::Sample(sample.clone()),
        Event::Snapshot(snapshot) => Record::Snapshot(snapshot.as_ref().clone()),
        Event::Rupture(rupture) => Record::Rupture(rupture.clone()),
    }
}

#[test]
fn what_is_written_is_read() {
    let (run, folder) = (Run::new(12), tempfile::tempdir().unwrap());
    let file = written(&run, folder.path());
    let trajectory = Trajectory::open(&file).unwrap();
    assert_eq!(trajectory.info(), &run.info);
    let read: Vec<_> = trajectory.map(Result::unwrap).collect();
    assert_eq!(read.len(), run.events.len());
    assert!(read.iter().zip(&run.events).all(|(read, event)| *read == record(event)));
    assert!(!folder.path().join("trajectory.bin.partial").exists());
    let raw = run.info.particles * 12 * (12 + 4 + 4 + 1 + 4 + 4);
    let size = std::fs::metadata(&file).unwrap().len();
    println!("{size} bytes for {raw} raw");
    assert!((size as usize) < 2 * raw);
}

#[test]
fn a_run_that_was_not_finished_gives_what_it_has_and_then_an_error() {
    let (run, folder) = (Run::new(6), tempfile::tempdir().unwrap());
    let file = written(&run, folder.path());
    let bytes = std::fs::read(&file).unwrap();
    std::fs::write(&file, &bytes[..bytes.len() * 3 / 4]).unwrap();
    let mut read: Vec<_> = Trajectory::open(&file).unwrap().collect();
    let last = read.pop().unwrap().unwrap_err();
    assert!(last.to_string().contains("was not finished"), "{last}");
    assert!(read.len() > 10 && read.len() < run.events.len(), "{}", read.len());
    assert!(read.iter().zip(&run.events).all(|(read, event)| *read.as_ref().unwrap() == record(event)));
}

#[test]
fn the_end_is_missed_even_where_a_record_ends() {
    let (run, folder) = (Run::new(2), tempfile::tempdir().unwrap());
    let file = folder.path().join("trajectory.bin");
    let mut writer = TrajectoryWriter::new(&file, Origin::default()).unwrap();
    run.show_unfinished(&mut writer).unwrap();
    drop(writer);
    assert!(!file.exists());
    let last = Trajectory::open(&folder.path().join("trajectory.bin.partial")).unwrap().last().unwrap();
    assert!(matches!(last, Err(Error::Io { .. })));
}

#[test]
fn damage_is_noticed() {
    let (run, folder) = (Run::new(6), tempfile::tempdir().unwrap());
    let file = written(&run, folder.path());
    let mut bytes = std::fs::read(&file).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle..middle + 64].fill(0xA5);
    std::fs::write(&file, &bytes).unwrap();
    let read: Vec<_> = Trajectory::open(&file).unwrap().collect();
    let same = read.iter().zip(&run.events).all(|(read, event)| read.as_ref().is_ok_and(|r| *r == record(event)));
    assert!(!same, "the damage went unnoticed");
    assert!(read.last().unwrap().is_err(), "the damage was read as if it were data");
}

#[test]
fn another_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("curve.csv");
    for text in ["", "strain,stress\n0.0,0.0\n0.1,200.0\n"] {
        std::fs::write(&file, text).unwrap();
        let error = Trajectory::open(&file).err().unwrap();
        assert!(matches!(error, Error::Input { .. }), "{error}");
        assert!(error.to_string().contains("is not a trajectory"), "{error}");
    }
    assert!(matches!(Trajectory::open(&folder.path().join("none.bin")), Err(Error::Io { .. })));
}

#[test]
fn a_trajectory_in_the_units_of_an_earlier_version_is_refused() {
    let (run, folder) = (Run::new(2), tempfile::tempdir().unwrap());
    let file = written(&run, folder.path());
    let mut bytes = std::fs::read(&file).unwrap();
    // Up to version 4 lengths were in mm and stresses in MPa.
    bytes[12..16].copy_from_slice(&4u32.to_le_bytes());
    std::fs::write(&file, &bytes).unwrap();
    let error = Trajectory::open(&file).err().unwrap();
    assert!(matches!(error, Error::Input { .. }), "{error}");
    assert!(error.to_string().contains("version 4; this program reads version 7"), "{error}");
}
