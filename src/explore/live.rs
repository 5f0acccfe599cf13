//! A run that is watched while it goes on: an observer that shows it at an address.
//!
//! The observer hands over what it is told and goes on; pages draw from it in threads of their own. Nothing of what the run
//! computes or writes depends on whether anybody looks.

use super::control::Control;
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
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

/// How often to look whether the last page has gone.
const LOOK: Duration = Duration::from_millis(50);
/// How long the address stays when the run is over and the last page has gone: a page that is loaded again comes back.
const LEAVING: Duration = Duration::from_secs(5);
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
        self.control.stopped_by_page()
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
        self.control.set_done(done);
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
