//! The run as a library: what observers are told, and in which order.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use strandsnap::base::error::{Error, Result};
use strandsnap::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use strandsnap::observe::Observer;
use strandsnap::run::{self, StopReason};
use strandsnap::scene;

/// Writes down what it is told; refuses row number `refuse`.
#[derive(Default)]
struct Diary {
    lines: Vec<(&'static str, u64)>,
    rows: usize,
    refuse: Option<usize>,
}

impl Diary {
    fn count(&self, word: &str) -> usize {
        self.lines.iter().filter(|(w, _)| *w == word).count()
    }
}

impl Observer for Diary {
    fn start(&mut self, _info: &Arc<RunInfo>) -> Result<()> {
        self.lines.push(("start", 0));
        Ok(())
    }
    fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.rows += 1;
        if Some(self.rows) == self.refuse {
            return Err(Error::io("cannot write", "curve.csv", std::io::ErrorKind::StorageFull.into()));
        }
        self.lines.push(("row", sample.step));
        Ok(())
    }
    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        self.lines.push(("snapshot", snapshot.sample.step));
        Ok(())
    }
    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.lines.push(("rupture", rupture.step));
        Ok(())
    }
    fn finish(&mut self) -> Result<()> {
        self.lines.push(("finish", 0));
        Ok(())
    }
}

fn pull(overrides: &[&str], observers: &mut [&mut dyn Observer], stop: bool) -> Result<run::Outcome> {
    let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
    let scene = scene::load("single-wire", &overrides)?;
    let assembly = run::assemble(&scene)?;
    run::simulate(&scene.spec, &scene.plan, assembly, observers, &AtomicBool::new(stop))
}

const SHORT: [&str; 3] = ["stop.steps=300", "output.samples=30", "output.snapshots=3"];

#[test]
fn first_and_last_state_are_shown_and_the_rest_is_spread_evenly() {
    let mut diary = Diary::default();
    let outcome = pull(&SHORT, &mut [&mut diary], false).unwrap();
    assert_eq!(outcome.reason, StopReason::Steps { limit: 300, reached: 300 });
    let steps =
        |word: &str| -> Vec<u64> { diary.lines.iter().filter(|(w, _)| *w == word).map(|(_, step)| *step).collect() };
    assert_eq!(steps("snapshot"), [0, 100, 200, 300]);
    assert_eq!(steps("row"), (0..=30).map(|i| 10 * i).collect::<Vec<u64>>());
    assert_eq!(diary.lines.first().unwrap().0, "start");
    assert_eq!(diary.lines.last().unwrap().0, "finish");
}

#[test]
fn a_rupture_comes_before_its_row_and_brings_a_snapshot() {
    let mut diary = Diary::default();
    let outcome = pull(&["output.samples=200", "output.snapshots=10"], &mut [&mut diary], false).unwrap();
    assert!(matches!(outcome.reason, StopReason::StressFraction { .. }), "{:?}", outcome.reason);
    let broke = diary.lines.iter().position(|(word, _)| *word == "rupture").expect("the wire snaps");
    let step = diary.lines[broke].1;
    let shown = diary.lines[broke..].iter().find(|(word, _)| *word == "snapshot").unwrap();
    assert!(shown.1 >= step && shown.1 <= step + 2_000, "rupture at {step}, shown at {}", shown.1);
    // The state at the last row before it was kept, and is shown first.
    let last_row = diary.lines[..broke].iter().rfind(|(word, _)| *word == "row").unwrap();
    assert_eq!(diary.lines[broke - 1], ("snapshot", last_row.1));
    assert!(last_row.1 < step, "rupture at {step}, last row before it at {}", last_row.1);
    assert!(diary.lines.windows(2).all(|pair| pair[0].0 != "row" || pair[1].0 != "rupture" || pair[0].1 <= pair[1].1));
}

#[test]
fn a_run_that_is_stopped_is_finished() {
    let mut diary = Diary::default();
    let outcome = pull(&SHORT, &mut [&mut diary], true).unwrap();
    assert_eq!((outcome.reason, outcome.steps), (StopReason::Interrupted, 0));
    assert_eq!((diary.count("snapshot"), diary.count("finish")), (1, 1));
}

#[test]
fn an_observer_that_fails_ends_the_run_but_the_others_are_finished() {
    let (mut before, mut after) = (Diary::default(), Diary::default());
    let mut failing = Diary { refuse: Some(5), ..Diary::default() };
    let error = pull(&SHORT, &mut [&mut before, &mut failing, &mut after], false).unwrap_err();
    assert!(matches!(error, Error::Io { .. }), "{error:?}");
    assert_eq!((before.count("row"), failing.count("row"), after.count("row")), (5, 4, 4));
    for diary in [before, failing, after] {
        assert_eq!(diary.count("finish"), 1);
    }
}

#[test]
fn a_failure_is_an_error_after_everything_was_finished() {
    let mut diary = Diary::default();
    let error = pull(&["time.step=4 us"], &mut [&mut diary], false).unwrap_err();
    assert_eq!(error.exit_code(), 4, "{error:?}");
    assert_eq!(diary.count("finish"), 1);
}
