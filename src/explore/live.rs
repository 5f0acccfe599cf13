//! A run that is watched while it goes on: an observer that shows it at an address, and what a page can do to it.
//!
//! The observer hands over what it is told and goes on; pages draw from it in threads of their own. Nothing of what the run
//! computes or writes depends on whether anybody looks.

use super::record::{Record, Told};
use super::server::{Gate, Options, Server};
use super::shared::{Pane, Shared};
use crate::base::error::Result;
use crate::base::finding::Notice;
use crate::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use crate::observe::Observer;
use crate::observe::planned::PlannedEnd;
use crate::observe::wording::OneDraw;
use crate::scene::spec::{Spec, StopSpec};
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// How often a run that is held looks whether it is stopped.
const LOOK: Duration = Duration::from_millis(50);
/// How long the address stays when the run is over and the last page has gone: a page that is loaded again comes back.
const LEAVING: Duration = Duration::from_secs(5);
/// Resolution of how far a run has come.
const WHOLE: f64 = 1e6;

/// How a run goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pace {
    /// By itself.
    Going,
    /// To its next state, then it is held.
    Step,
    /// Not at all, until it is let go or stopped.
    Held,
}

/// What a page can do to a run that is going.
pub struct Control {
    pace: Mutex<Pace>,
    changed: Condvar,
    /// Ends the run cleanly.
    stop: &'static AtomicBool,
    /// It was a page that set it.
    by_page: AtomicBool,
    /// How far the run has come, of [`WHOLE`].
    done: AtomicU32,
    /// Why it ended.
    end: Mutex<Option<String>>,
}

impl Control {
    fn new(stop: &'static AtomicBool) -> Self {
        Self {
            pace: Mutex::new(Pace::Going),
            changed: Condvar::new(),
            stop,
            by_page: AtomicBool::new(false),
            done: AtomicU32::new(0),
            end: Mutex::new(None),
        }
    }

    fn pace(&self) -> MutexGuard<'_, Pace> {
        self.pace.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn end(&self) -> MutexGuard<'_, Option<String>> {
        self.end.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Holds the run, lets it go, or lets it go to its next state.
    pub fn set(&self, pace: Pace) {
        *self.pace() = pace;
        self.changed.notify_all();
    }

    /// Ends the run as Ctrl-C does: its results so far are kept.
    pub fn stop(&self) {
        if self.end().is_none() && !self.stop.swap(true, Ordering::Relaxed) {
            self.by_page.store(true, Ordering::Relaxed);
        }
        self.changed.notify_all();
    }

    /// What a page is told of how the run goes on.
    pub fn state(&self) -> Value {
        let word = match *self.pace() {
            Pace::Going => "going",
            Pace::Step => "step",
            Pace::Held => "held",
        };
        let done = f64::from(self.done.load(Ordering::Relaxed)) / WHOLE;
        json!({ "pace": word, "done": done, "stopping": self.stop.load(Ordering::Relaxed), "end": *self.end() })
    }

    /// Returns when the run may go on; `state`: it has come to a new one.
    fn wait(&self, state: bool) {
        let mut pace = self.pace();
        if state && *pace == Pace::Step {
            *pace = Pace::Held;
        }
        while *pace == Pace::Held && !self.stop.load(Ordering::Relaxed) {
            let waited = self.changed.wait_timeout(pace, LOOK);
            pace = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

/// Shows a run at an address while it goes on.
pub struct Watcher {
    run: PathBuf,
    control: Arc<Control>,
    stop: StopSpec,
    end: PlannedEnd,
    one_draw: bool,
    /// Listens until there is something to show.
    gate: Option<Gate>,
    address: String,
    record: Option<Record>,
    shown: Option<Shown>,
}

/// A run that is shown.
struct Shown {
    server: Arc<Server>,
    quit: Arc<AtomicBool>,
    thread: Option<JoinHandle<Result<()>>>,
}

impl Watcher {
    /// Listens, and makes sure that there is an adapter. `stop` is what ends the run cleanly; pages may set it. `run` is the
    /// folder of its results.
    ///
    /// # Errors
    /// When there is no graphics adapter, or the address is taken.
    pub fn open(options: Options, run: PathBuf, spec: &Spec, stop: &'static AtomicBool) -> Result<Self> {
        crate::render::check()?;
        let gate = Gate::open(Options { keep: true, ..options })?;
        Ok(Self {
            run,
            control: Arc::new(Control::new(stop)),
            stop: spec.stop.clone(),
            end: PlannedEnd::default(),
            one_draw: OneDraw::of(spec).is_some(),
            address: gate.address(),
            gate: Some(gate),
            record: None,
            shown: None,
        })
    }

    /// The address to open, with the token in it.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// Whether the run was stopped by a page.
    pub fn stopped_by_page(&self) -> bool {
        self.control.by_page.load(Ordering::Relaxed)
    }

    /// Whether a page is open.
    pub fn is_looked_at(&self) -> bool {
        self.shown.as_ref().is_some_and(|shown| shown.server.is_looked_at(LEAVING))
    }

    /// Tells pages why the run ended.
    pub fn tell_end(&self, why: &str) {
        *self.control.end() = Some(why.to_owned());
    }

    /// Goes on showing it until the last page has been closed or `stop` is set.
    pub fn stay(&self, stop: &AtomicBool) {
        while self.is_looked_at() && !stop.load(Ordering::Relaxed) {
            std::thread::sleep(LOOK);
        }
    }

    fn tell(&mut self, told: Told) {
        match (&self.shown, &mut self.record) {
            (Some(shown), _) => shown.server.tell(told),
            (None, Some(record)) => record.hear(told),
            (None, None) => {}
        }
    }

    /// Begins to show what there is: a state at least.
    fn show(&mut self) -> Result<()> {
        let (Some(gate), Some(record)) = (self.gate.take(), self.record.take()) else { return Ok(()) };
        let shared = Shared::new(Pane::of(record, &self.run)?, None)?.going(self.control.clone());
        let (server, quit) = (Arc::new(gate.show(shared)), Arc::new(AtomicBool::new(false)));
        let (serving, flag) = (server.clone(), quit.clone());
        let thread = std::thread::spawn(move || serving.serve(&flag));
        self.shown = Some(Shown { server, quit, thread: Some(thread) });
        Ok(())
    }
}

impl Observer for Watcher {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        self.end = PlannedEnd::new(&self.stop, info.strain_end);
        self.record = Some(Record::begin(info.clone(), self.one_draw));
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        let done = self.end.fraction(sample.strain, sample.time, sample.step).min(1.0);
        self.control.done.store((done * WHOLE) as u32, Ordering::Relaxed);
        self.tell(Told::Row(sample.clone()));
        self.control.wait(false);
        Ok(())
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        self.tell(Told::State(snapshot.clone()));
        self.show()?;
        self.control.wait(true);
        Ok(())
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.tell(Told::Rupture(rupture.clone()));
        Ok(())
    }

    fn notice(&mut self, notice: &Notice) -> Result<()> {
        self.tell(Told::Notice(notice.clone()));
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}

impl Drop for Watcher {
    fn drop(&mut self) {
        if let Some(shown) = &mut self.shown {
            shown.quit.store(true, Ordering::Relaxed);
            // What became of the address matters no more.
            drop(shown.thread.take().map(JoinHandle::join));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;

    #[test]
    fn a_held_run_waits_a_step_lets_one_state_by_and_a_stop_ends_the_waiting() {
        static STOP: AtomicBool = AtomicBool::new(false);
        let control = Arc::new(Control::new(&STOP));
        control.set(Pace::Held);
        let (send, passed) = channel();
        let waiting = control.clone();
        let thread = std::thread::spawn(move || {
            for number in 0.. {
                // A row, then the state that goes with it, as runs have them.
                waiting.wait(false);
                waiting.wait(true);
                if send.send(number).is_err() || STOP.load(Ordering::Relaxed) {
                    break;
                }
            }
        });
        let soon = Duration::from_millis(200);
        assert!(passed.recv_timeout(soon).is_err(), "a held run goes on");
        control.set(Pace::Step);
        // The state is held as soon as it is there: what comes after it does not pass.
        assert!(passed.recv_timeout(soon).is_err());
        assert_eq!(control.state()["pace"], "held");
        control.set(Pace::Step);
        assert_eq!(passed.recv_timeout(Duration::from_secs(10)), Ok(0));
        assert!(passed.recv_timeout(soon).is_err(), "one step was asked for");
        control.stop();
        assert!(passed.recv_timeout(Duration::from_secs(10)).is_ok());
        drop(passed);
        thread.join().unwrap();
        assert!(control.by_page.load(Ordering::Relaxed) && control.state()["stopping"] == true);
    }
}
