//! What a page can do to a run that is going: hold it, let it go on by one state, end it.

use serde::Deserialize;
use serde_json::{Value, json};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How often a run that is held looks whether it is stopped.
const LOOK: Duration = Duration::from_millis(50);
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
    pub fn new(stop: &'static AtomicBool) -> Self {
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

    /// Why it ended, if it has.
    pub fn end(&self) -> MutexGuard<'_, Option<String>> {
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

    /// Whether it was a page that ended it.
    pub fn stopped_by_page(&self) -> bool {
        self.by_page.load(Ordering::Relaxed)
    }

    /// Takes note of how far the run has come (-).
    pub fn set_done(&self, done: f64) {
        self.done.store((done * WHOLE) as u32, Ordering::Relaxed);
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
    pub fn wait(&self, state: bool) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
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
