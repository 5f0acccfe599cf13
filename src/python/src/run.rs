//! `run` and `resume`.

use crate::error::{OrRaise, warn};
use crate::options::{self, positive, seconds};
use crate::results::PyRun;
use crate::scene::PyScene;
use crate::watch::{Ended, Teller, watch};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use strandsnap::base::error::{Error, Result};
use strandsnap::engine::view::{RunInfo, Sample};
#[cfg(feature = "frames")]
use strandsnap::explore::pictures;
use strandsnap::export;
use strandsnap::observe::Observer;
use strandsnap::observe::animation::Animation;
use strandsnap::observe::column::{Column, Value};
use strandsnap::observe::planned::PlannedEnd;
use strandsnap::observe::tables;
use strandsnap::run::drawing::Undrawn;
use strandsnap::run::{self, Resumable, RunOptions, RunSummary, cautions};
use strandsnap::scene::spec::{OutputSpec, Spec, StopSpec};

/// Runs a scene and writes its results into the folder `out`; without it, into `out/NAME`.
///
/// The interpreter is free meanwhile. `on_row` is called with every row of the curve as it comes, a dict by the names of
/// `curve.csv`, in the thread that calls `run`; the engine goes on when it returns. `progress` is `True` for a line on
/// standard error, or is called with the share that is done, from 0 to 1; its `close()`, if it has one, is called at the end.
/// Ctrl-C, an exception from a callback and `time_limit` (s) end the run cleanly: results so far and a checkpoint are kept,
/// and `resume(out)` goes on; the first two are then raised.
///
/// `threads` is how many work, or None for as many as make it faster; results are the same on any number. `device` is cpu,
/// gpu, auto or a part of an adapter's name. `frames`, `animation` (a file: .gif, .png, .mp4; `animation_width` in pixels),
/// `recording` and `live` (address of a Rerun viewer) need the features of those names in the build of this package.
/// What the command line prints as WARNING is issued as `RunWarning`.
#[pyfunction]
#[pyo3(name = "run", signature = (
    scene, out=None, *, overwrite=false, wait=false, threads=None, device="cpu", frames=false, animation=None,
    animation_width=None, recording=false, live=None, time_limit=None, progress=None, on_row=None
))]
#[expect(clippy::too_many_arguments, reason = "they are keywords")]
pub fn py_run(
    py: Python,
    scene: &PyScene,
    out: Option<PathBuf>,
    overwrite: bool,
    wait: bool,
    threads: Option<usize>,
    device: &str,
    frames: bool,
    animation: Option<PathBuf>,
    animation_width: Option<u32>,
    recording: bool,
    live: Option<String>,
    time_limit: Option<f64>,
    progress: Option<Py<PyAny>>,
    on_row: Option<Py<PyAny>>,
) -> PyResult<PyRun> {
    let scene = &scene.scene;
    let options = RunOptions {
        frames: frames || animation.is_some(),
        animation: animation.map(|file| Animation { file, width: animation_width }),
        overwrite,
        wait,
        threads: positive("threads", threads)?,
        device: options::device(device)?,
        recording,
        live,
        ..RunOptions::tables(&out.unwrap_or_else(|| Path::new("out").join(&scene.spec.name)))
    };
    if options.frames || !scene.spec.output.pictures.is_empty() {
        py.import("strandsnap._mesa")?.call_method0("quiet")?;
    }
    let limit = seconds("time_limit", time_limit)?;
    let before = py.detach(|| cautions::of_run(scene, &run::assemble(scene)?)).or_raise(py)?;
    warn(py, &before)?;
    let calls = Calls::new(py, &scene.spec.name, progress, on_row)?;
    let spec = &scene.spec;
    check_more(&options.out, &spec.output).or_raise(py)?;
    let ended = watched(py, calls, limit, &scene.spec.stop, |watchers, stop| {
        let run = || run::run_watched(scene, &options, watchers.observers(), stop);
        make_more(run::in_pool(options.threads, run)??, spec, &options.out, stop)
    })?;
    finish(py, ended, &options.out)
}

/// Goes on with a run that was interrupted or killed, from the last checkpoint in its folder, to the same bits; where only
/// pictures are missing, draws them. `on_row` is also called with the rows from before. See `run`.
#[pyfunction]
#[pyo3(signature = (folder, *, threads=None, device=None, time_limit=None, progress=None, on_row=None))]
pub fn resume(
    py: Python,
    folder: PathBuf,
    threads: Option<usize>,
    device: Option<&str>,
    time_limit: Option<f64>,
    progress: Option<Py<PyAny>>,
    on_row: Option<Py<PyAny>>,
) -> PyResult<PyRun> {
    let device = device.map(options::device).transpose()?;
    let threads = positive("threads", threads)?;
    let limit = seconds("time_limit", time_limit)?;
    if let Some(undrawn) = py.detach(|| Undrawn::find(&folder)).or_raise(py)? {
        py.import("strandsnap._mesa")?.call_method0("quiet")?;
        let calls = Calls::new(py, "pictures", None, None)?;
        let spec = undrawn.scene().spec.clone();
        check_more(&folder, &spec.output).or_raise(py)?;
        let ended = watched(py, calls, limit, &StopSpec::default(), |_, stop| {
            let mut drawing = undrawn.begin()?;
            drawing.replay.show(&mut *drawing.writer, stop)?;
            make_more(drawing.end()?, &spec, &folder, stop)
        })?;
        return finish(py, ended, &folder);
    }
    let resumable = py.detach(|| Resumable::open(&folder, threads, device)).or_raise(py)?;
    let calls = Calls::new(py, &resumable.scene.spec.name, progress, on_row)?;
    let spec = resumable.scene.spec.clone();
    check_more(&folder, &spec.output).or_raise(py)?;
    let ended = watched(py, calls, limit, &spec.stop, |watchers, stop| {
        // The notes say from which step it goes on, which the first row that is new tells.
        let run = || resumable.go_on(&|_| {}, watchers.observers(), stop);
        make_more(run::in_pool(threads, run)??, &spec, &folder, stop)
    })?;
    finish(py, ended, &folder)
}

/// Checks, before the simulation, that what [`make_more`] makes after it can be made.
fn check_more(run: &Path, output: &OutputSpec) -> Result<()> {
    export::check_also(run, &output.also)?;
    #[cfg(feature = "frames")]
    pictures::check(run, output)?;
    #[cfg(not(feature = "frames"))]
    if !output.pictures.is_empty() {
        return Err(run::outputs::built_without("pictures of a view", "frames", "leave out output.picture"));
    }
    Ok(())
}

/// Makes what `output.picture` and `output.also` ask for; what `stop` leaves out is among the warnings.
fn make_more(mut summary: RunSummary, spec: &Spec, run: &Path, stop: &AtomicBool) -> Result<RunSummary> {
    #[cfg(feature = "frames")]
    let (left_out, left) = {
        let drawn =
            if pictures::are_due(&summary) { pictures::draw(run, spec, stop)? } else { pictures::Drawn::default() };
        let left = if drawn.stopped { vec![pictures::command(run)] } else { Vec::new() };
        (drawn.left_out, left)
    };
    #[cfg(not(feature = "frames"))]
    let (left_out, left) = (Vec::new(), Vec::new());
    let also = export::also(run, &summary, &spec.output.also, stop)?;
    summary.warnings.extend(left_out);
    summary
        .warnings
        .extend(left.iter().chain(&also.left).map(|command: &String| format!("still to be made: {command}")));
    Ok(summary)
}

/// The run in a folder, with its warnings issued; or what ended it, with a word on what is kept.
fn finish(py: Python, ended: Ended<Result<RunSummary>>, folder: &Path) -> PyResult<PyRun> {
    if let Some(raised) = ended.raised {
        if run::checkpoint::latest(folder).is_ok() {
            let kept = format!("results so far are in {0}; strandsnap.resume({0:?}) goes on", folder.display());
            // Python before 3.11 has no notes.
            let _ = raised.value(py).call_method1("add_note", (kept,));
        }
        return Err(raised);
    }
    let summary = ended.output.or_raise(py)?;
    warn(py, &summary.warnings)?;
    Ok(PyRun::of(folder))
}

/// What is called in Python while something goes on.
pub struct Calls {
    progress: Option<Py<PyAny>>,
    on_row: Option<Py<PyAny>>,
}

impl Calls {
    /// `progress` is `True` for a line that is headed `name`, a callable, or nothing.
    pub fn new(py: Python, name: &str, progress: Option<Py<PyAny>>, on_row: Option<Py<PyAny>>) -> PyResult<Self> {
        let line = |given: Py<PyAny>| match given.extract::<bool>(py) {
            Ok(true) => Ok(Some(py.import("strandsnap._progress")?.getattr("Line")?.call1((name,))?.unbind())),
            Ok(false) => Ok(None),
            Err(_) => Ok::<_, PyErr>(Some(given)),
        };
        Ok(Self { progress: progress.map(line).transpose()?.flatten(), on_row })
    }

    /// Tells the share that is done.
    pub fn share(&self, py: Python, share: f64) -> PyResult<()> {
        self.progress.as_ref().map_or(Ok(()), |progress| progress.call1(py, (share,)).map(drop))
    }

    /// No more will be told.
    pub fn close(&self, py: Python) -> PyResult<()> {
        let Some(progress) = self.progress.as_ref().map(|progress| progress.bind(py)) else { return Ok(()) };
        if progress.hasattr("close")? { progress.call_method0("close").map(drop) } else { Ok(()) }
    }
}

/// What is told of a run.
enum Event {
    /// It begins; the names of a row's values.
    Begins(Vec<String>),
    /// A row, and the share that is done; without values where nobody asks for them.
    Row(Option<Vec<Value>>, f64),
}

/// What watches a run for Python, if anything is to be called.
struct Watchers<'a>(Option<Rows<'a>>);

impl Watchers<'_> {
    fn observers(&mut self) -> Vec<&mut dyn Observer> {
        self.0.iter_mut().map(|rows| rows as &mut dyn Observer).collect()
    }
}

struct Rows<'a> {
    teller: &'a Teller<Event>,
    stop: &'a StopSpec,
    end: PlannedEnd,
    columns: Vec<Column<'static, Sample>>,
    wanted: bool,
}

impl Observer for Rows<'_> {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        self.end = PlannedEnd::new(self.stop, info.strain_end);
        if self.wanted {
            self.columns = tables::curve(info);
        }
        self.teller.tell(Event::Begins(self.columns.iter().map(|column| column.name.to_string()).collect()));
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        let share = self.end.fraction(sample.strain, sample.time, sample.step).min(1.0);
        let row = self.wanted.then(|| self.columns.iter().map(|column| column.value(sample)).collect());
        self.teller.tell(Event::Row(row, share));
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Does what makes a run, and calls what Python wants to hear of it.
fn watched(
    py: Python,
    calls: Calls,
    limit: Option<Duration>,
    end: &StopSpec,
    work: impl FnOnce(&mut Watchers, &AtomicBool) -> Result<RunSummary> + Send,
) -> PyResult<Ended<Result<RunSummary>>> {
    let stop = AtomicBool::new(false);
    let [wants_rows, wants_share] = [calls.on_row.is_some(), calls.progress.is_some()];
    let mut names: Vec<Py<PyString>> = Vec::new();
    let hear = |py: Python, event: Event| match event {
        Event::Begins(columns) => {
            names = columns.iter().map(|name| PyString::intern(py, name).unbind()).collect();
            Ok(())
        }
        Event::Row(row, share) => {
            if let Some((call, row)) = calls.on_row.as_ref().zip(row) {
                let dict = PyDict::new(py);
                names.iter().zip(row).try_for_each(|(name, value)| set(&dict, name.bind(py), value))?;
                call.call1(py, (dict,))?;
            }
            calls.share(py, share)
        }
    };
    let mut ended = watch(
        py,
        &stop,
        limit,
        |teller| {
            let rows = Rows { teller, stop: end, end: PlannedEnd::default(), columns: Vec::new(), wanted: wants_rows };
            work(&mut Watchers((wants_rows || wants_share).then_some(rows)), &stop)
        },
        hear,
    );
    calls.close(py)?;
    // Only where nothing was raised here: someone else has set the flag.
    if ended.raised.is_none() && matches!(ended.output, Err(Error::Interrupted)) {
        ended.raised = Some(PyKeyboardInterrupt::new_err("interrupted"));
    }
    Ok(ended)
}

fn set(row: &Bound<PyDict>, name: &Bound<PyString>, value: Value) -> PyResult<()> {
    match value {
        Value::Missing => row.set_item(name, row.py().None()),
        Value::Number(number) => row.set_item(name, number),
        Value::Count(count) => row.set_item(name, count),
        Value::Flag(holds) => row.set_item(name, holds),
        text @ (Value::Text(_) | Value::Json(_)) => row.set_item(name, text.in_csv()),
    }
}
