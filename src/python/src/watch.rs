//! Work that goes on without the interpreter, while the thread that asked for it hears of it and of Ctrl-C.

use pyo3::prelude::*;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Time between two looks for a signal.
const LOOK: Duration = Duration::from_millis(50);

/// Tells of events, and waits until each was heard: a callback that raises ends the work at what it was told of.
pub struct Teller<E> {
    lane: Mutex<(Sender<E>, Receiver<()>)>,
}

impl<E> Teller<E> {
    /// Tells of an event.
    pub fn tell(&self, event: E) {
        let lane = self.lane.lock().unwrap_or_else(PoisonError::into_inner);
        if lane.0.send(event).is_ok() {
            // Without an answer nobody listens any more.
            let _ = lane.1.recv();
        }
    }
}

/// Work that has ended.
pub struct Ended<T> {
    /// What it gave.
    pub output: T,
    /// What a signal or a callback raised, which has stopped it.
    pub raised: Option<PyErr>,
}

impl<T> Ended<T> {
    /// What it gave, unless something was raised.
    pub fn or_raised(self) -> PyResult<T> {
        self.raised.map_or(Ok(self.output), Err)
    }
}

/// Does `work` on a thread of its own. This one, which is the interpreter's own where Python's main thread calls, lets `hear`
/// have what it tells, looks for signals, and sets `stop` when either raises, or `limit` has passed.
pub fn watch<E: Send, T: Send>(
    py: Python,
    stop: &AtomicBool,
    limit: Option<Duration>,
    work: impl FnOnce(&Teller<E>) -> T + Send,
    mut hear: impl FnMut(Python, E) -> PyResult<()> + Send,
) -> Ended<T> {
    let began = Instant::now();
    py.detach(move || {
        let (tell, heard) = channel();
        let (answer, answered) = channel();
        let teller = Teller { lane: Mutex::new((tell, answered)) };
        thread::scope(move |scope| {
            let worker = scope.spawn(move || work(&teller));
            let mut raised = None;
            loop {
                let event = heard.recv_timeout(LOOK);
                if matches!(event, Err(RecvTimeoutError::Disconnected)) {
                    break;
                }
                let event = event.ok();
                let waits = event.is_some();
                if raised.is_none() {
                    let well = Python::attach(|py| {
                        event.map_or(Ok(()), |event| hear(py, event))?;
                        py.check_signals()
                    });
                    raised = well.err();
                }
                if raised.is_some() || limit.is_some_and(|limit| began.elapsed() >= limit) {
                    stop.store(true, Ordering::Relaxed);
                }
                if waits {
                    let _ = answer.send(());
                }
            }
            let output = worker.join().unwrap_or_else(|panic| resume_unwind(panic));
            Ended { output, raised }
        })
    })
}
